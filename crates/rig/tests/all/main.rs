//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::expect_used, clippy::unwrap_used)] // helpers of tests fail as tests do

mod blows;
mod closed_forms;
mod common;
mod families;
mod glued_joint;
mod hammer;
mod modal_errors;
mod open_cases;
mod outside;
