//! Inputs made up by libFuzzer, on what must hold for any: see [`targets`]. `run.sh` beside this crate runs
//! them for as long as one likes.

pub mod json;
pub mod targets;
