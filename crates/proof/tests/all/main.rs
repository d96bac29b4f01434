//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod baselines;
mod cases;
mod common;
mod concealed;
mod features;
mod one_route;
mod routes;
mod scoring;
mod sizes;
mod struck_frfs;
