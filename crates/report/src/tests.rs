//! The parts of a page.
#![allow(clippy::expect_used, clippy::unwrap_used)] // helpers of tests fail as tests do

mod drawing;
mod gallery;
mod page;
