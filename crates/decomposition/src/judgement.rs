//! What the best estimate of a joint is worth: the verdict and its grounds.

use crate::MatrixElement;
use crate::settings::estimates::CONTRADICTED;
use serde::Serialize;

/// How an analysis may be used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Use {
    /// As it stands; it agrees with the fixture.
    Sound,
    /// With the remarks in mind: it departs from the fixture, or the model does not explain the test in full.
    WithCare,
    /// Not at all: k₁₁ is not determined, there is no fit, or fit and means exclude each other.
    #[default]
    Unusable,
}

/// An element on which the fit to the FRFs and the weighted mean over lines do not agree, for all their
/// uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contradiction {
    /// The element of k that differs most.
    pub element: MatrixElement,
    /// What the fit makes of it, SI.
    pub fit: f64,
    /// What the mean makes of it, SI.
    pub mean: f64,
    /// Share of √(k_ii k_jj) by which they differ.
    pub relative: f64,
}

impl Contradiction {
    /// Whether it leaves neither of the two of any use.
    pub fn excludes_use(&self) -> bool {
        self.relative > CONTRADICTED
    }
}

/// What the best estimate of a joint is worth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Judgement {
    /// How the estimate may be used, all in all.
    pub verdict: Use,
    /// χ² per degree of freedom of the fit, where one constant k and c does not explain the FRFs.
    pub poor_fit: Option<f64>,
    /// Where fit and means do not agree.
    pub contradiction: Option<Contradiction>,
    /// χ² per degree of freedom of the blocks' rigid motion, where surplus FRFs contradict each other.
    pub not_rigid: Option<f64>,
    /// Whether every element of K agrees with the fixture's within both uncertainties, at 95 %.
    pub agrees_with_fixture: bool,
    /// Whether c is held at the limit of what a passive joint can do.
    pub damping_at_limit: bool,
}
