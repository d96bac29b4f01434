//! Where the page of a proof comes from.

/// Where the page comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProofContext {
    /// The program and its version.
    pub program: String,
    /// The command line.
    pub command: String,
    /// Which cases these are, in a line.
    pub cases: String,
    /// SHA-256 of the sealed truths.
    pub sealed: String,
    /// Whether `cases/NNN/report.html` lie beside the page.
    pub pages: bool,
}
