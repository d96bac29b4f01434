//! Lines that could not be solved, as `stiffness.json` lists them with the reason.

use serde::Serialize;

/// A line that could not be solved, Hz.
#[derive(Serialize)]
pub(super) struct MaskedLine {
    pub(super) frequency: f64,
    pub(super) why: &'static str,
}
