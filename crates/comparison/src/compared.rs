//! Which of its estimates stands for each joint.

use crate::Decomposed;

/// Which of its estimates stands for each joint: the first one that all of them have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compared {
    /// The joint from all FRFs, the fixture's quantities moving within their tolerances.
    AllFrfs,
    /// The maximum-likelihood joint from the FRFs across it.
    Likelihood,
    /// Averages over each joint's band.
    Average,
}

impl Compared {
    pub(crate) fn of(relation: &str, joints: &[Decomposed]) -> Self {
        // Fits are of the exact relation.
        let fits = relation == "exact";
        if fits && joints.iter().all(|joint| Compared::AllFrfs.is_had_by(joint)) {
            Compared::AllFrfs
        } else if fits && joints.iter().all(|joint| Compared::Likelihood.is_had_by(joint)) {
            Compared::Likelihood
        } else {
            Compared::Average
        }
    }

    pub(crate) fn is_had_by(self, joint: &Decomposed) -> bool {
        match self {
            Compared::AllFrfs => joint.fitted.is_some(),
            Compared::Likelihood => joint.likelihood.is_some(),
            Compared::Average => joint.average.is_some(),
        }
    }

    /// As `comparison.json` writes it.
    pub fn name(self) -> &'static str {
        match self {
            Compared::AllFrfs => "all_frfs",
            Compared::Likelihood => "maximum_likelihood",
            Compared::Average => "average",
        }
    }
}
