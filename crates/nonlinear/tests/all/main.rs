//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod force_state;
mod hits;
mod homogeneity;
mod stepped;
