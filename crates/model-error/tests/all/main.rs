//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod calibration;
mod closed_form;
mod common;
mod effects;
mod evidence;
mod pairing;
mod record_end;
mod strikes;
mod structural;
