//! The four things that a diagnosis can conclude, and the judgement on data that no fit saw.

use serde::Serialize;

/// What a diagnosis concludes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing beyond noise and the stated tolerances; of a test for amplitude, nothing changes with it.
    Consistent,
    /// The effects found explain the recordings within noise and tolerances.
    Explained,
    /// The effects found are needed, and something is left.
    PartlyExplained,
    /// A mismatch that no effect accounts for.
    Unexplained,
}

impl Verdict {
    /// The word used in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Consistent => "consistent",
            Verdict::Explained => "explained",
            Verdict::PartlyExplained => "partly_explained",
            Verdict::Unexplained => "unexplained",
        }
    }
}

/// Data that no fit saw, and how well they were predicted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldOut {
    /// Bands (Hz), FRFs or hits: `band 180:240`, `frf 4/2`, `hit 3`.
    pub what: Vec<String>,
    /// Error of the refitted fixture there, relative to what was measured.
    pub nrmse_refitted: f64,
    /// Error of the repaired one.
    pub nrmse_repaired: f64,
    /// Whether the search without the held-out data found the same effects; `None` where it was not repeated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub same_findings: Option<bool>,
}
