//! What the test of homogeneity leads to: whether anything depends on amplitude.

use crate::{Answer, MeasuredFrfs};

/// What the test of homogeneity leads to.
pub(crate) enum Homogeneity {
    /// Something changes with amplitude.
    Changes(Box<Answer>),
    /// Nothing does, with the probability by chance, or it was not judged: the FRFs to be diagnosed.
    Linear(Box<MeasuredFrfs>, Option<f64>),
}

/// The note on a test of homogeneity that failed.
pub(crate) fn not_judged(why: &dyn std::error::Error) -> String {
    format!("whether anything depends on amplitude could not be judged: {why}")
}
