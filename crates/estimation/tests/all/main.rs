//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod common;
mod faults;
mod hum;
mod variance;
mod windows;
