//! The tests of this crate's public functions, in one program: linking is what costs time.
#![allow(clippy::expect_used, clippy::unwrap_used)] // helpers of tests fail as tests do

mod decomposition_page;
mod diagnosis_page;
mod proof_page;
