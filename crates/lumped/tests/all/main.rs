//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod against_direct_solution;
mod recorded_and_perfect;
mod state_space;
mod tangents;
mod vicinity;
