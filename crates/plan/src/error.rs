//! When there is nothing to plan, or what a question names does not exist.

use jointscope_diagnosis::PredictionError;

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Nothing was found that could have another name.
    #[error(
        "the diagnosis found nothing that could have another name; for a joint's stiffness ask with `--interval JOINT/k11=1%`"
    )]
    NothingFound,
    /// What was found has no other name.
    #[error(
        "no other name is left for what was found ({0}): there is nothing to separate; for a joint's stiffness ask with `--interval JOINT/k11=1%`"
    )]
    NoAlternatives(String),
    /// There is no such finding.
    #[error("there is no finding {asked}: the diagnosis has {count}")]
    NoSuchFinding {
        /// The number asked for, from 1.
        asked: usize,
        /// Number of findings.
        count: usize,
    },
    /// A point that the fixture does not have.
    #[error("the fixture has no point `{point}` (it has {known})")]
    UnknownPoint {
        /// The point.
        point: String,
        /// The points there are.
        known: String,
    },
    /// A joint that the fixture does not have.
    #[error("the fixture has no joint `{joint}` (it has {known})")]
    UnknownJoint {
        /// The joint.
        joint: String,
        /// The joints there are.
        known: String,
    },
    /// A dashpot of a joint that has none.
    #[error(
        "joint `{0}` states no dashpots, so that there is no interval of one; state `damping` beside its `stiffness`"
    )]
    NoDashpot(String),
    /// An element that is zero.
    #[error("the fixture states zero where the interval is wanted: {0}; state a value that is not zero")]
    NoElement(String),
    /// A fixture that predicts nothing.
    #[error(transparent)]
    Prediction(#[from] PredictionError),
    /// Names that cannot be compared: a fit or a covariance has no finite value.
    #[error(
        "the remaining names cannot be compared: {0} predicts nothing that could be fitted to the recording"
    )]
    NotComparable(String),
}
