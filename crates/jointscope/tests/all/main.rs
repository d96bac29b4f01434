//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::panic, clippy::unwrap_used)] // helpers of tests fail as tests do

mod against_the_rig;
mod below_the_modes;
mod common;
mod comparison;
mod diagnosis;
mod drift;
mod files;
mod fuzzed;
mod joint_fit;
mod joint_of_hits;
mod joints_fit;
mod laws;
mod layers;
mod links;
mod location;
mod model_error;
mod modes;
mod real_beam;
mod record_end;
mod slips;
mod stated;
mod stated_sensors;
mod where_along;
mod wrong_quantities;
