//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod bad_inputs;
mod check;
mod common;
mod compare;
mod decompose;
mod diagnose;
mod estimate;
mod export;
mod faults;
mod fem;
mod formats;
mod guide;
mod hits;
mod init;
mod levels;
mod many;
mod modes;
mod pages;
mod plan;
mod prove;
mod prove_floors;
mod prove_recordings;
mod reference;
mod refusals;
mod results;
mod shared_inputs;
mod streams;
mod synthesize;
mod tables;
