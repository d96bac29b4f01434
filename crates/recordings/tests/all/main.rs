//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod channels;
mod common;
mod datasets;
mod geometry;
mod hits;
mod sets;
mod shared;
mod units;
