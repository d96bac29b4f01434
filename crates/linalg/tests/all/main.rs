//! The tests of this crate, in one program and all of public functions: within the crate, they would have it
//! compiled a second time.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

#[cfg(feature = "sparse")]
mod chains;
mod cholesky;
mod eigen;
mod exponential;
mod general_eigen;
mod least_squares;
mod lu;
mod matrix2;
mod products;
mod singular_values;
#[cfg(feature = "sparse")]
mod sparse;
#[cfg(feature = "sparse")]
mod sparse_cholesky;
#[cfg(feature = "sparse")]
mod sparse_inertia;
#[cfg(feature = "sparse")]
mod sparse_modes;
