//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod common;
mod geometry;
mod hostile_bytes;
mod layouts_in_circulation;
mod malformed_files;
mod recordings;
mod round_trip;
