//! Why files are no recording of a fixture, and why a recording gets no answer: the errors of the crates
//! below, in one sentence each.

use jointscope_decomposition::{DecompositionError, SeveralError};
use jointscope_diagnosis::DiagnosisError;
use jointscope_estimation::EstimateError;
use jointscope_fixture::FixtureError;
use jointscope_nonlinear::{Held, SteppedError};
use jointscope_recordings::{HitsError, RecordingError};
use jointscope_screening::{Implausible, ScreeningError};

/// Why files are no recording of a fixture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasurementError {
    /// They hold no FRFs or hits that suit the fixture, or the channel map suits neither.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Their time histories are no hits.
    #[error(transparent)]
    Hits(HitsError),
}

impl From<HitsError> for MeasurementError {
    fn from(error: HitsError) -> Self {
        match error {
            HitsError::Map(error) => MeasurementError::Recording(error),
            error => MeasurementError::Hits(error),
        }
    }
}

/// Why a measurement got no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// FRFs at several levels, of which the amplitude is not stated for all.
    #[error(transparent)]
    Levels(#[from] RecordingError),
    /// No FRFs can be estimated from the hits.
    #[error("{0}{remedy}", remedy = remedy_of_estimate(.0))]
    Estimate(#[from] EstimateError),
    /// Numbers of the fixture that belong to no structure together.
    #[error(transparent)]
    Implausible(#[from] Implausible),
    /// The FRFs hold nothing.
    #[error(transparent)]
    Screening(#[from] ScreeningError),
    /// The hammer excites no line.
    #[error("the hits excite no spectral line; record harder or longer ones")]
    NothingExcited,
    /// Band and excluded bands leave no line.
    #[error(
        "`--band` and `--exclude` leave no spectral line of the recording, which runs from {} to {} Hz; choose them anew",
        jointscope_spectra::in_text(*first),
        jointscope_spectra::in_text(*last)
    )]
    NoLineInUse {
        /// First line of the recording, Hz.
        first: f64,
        /// Its last line, Hz.
        last: f64,
    },
    /// Lines from which no mode and no misfit can be told.
    #[error(
        "has too few lines: {lines} in use, and a diagnosis needs {needed}; record or export more spectral lines, or choose `--band` and `--exclude` anew"
    )]
    TooFewLines {
        /// Lines in use.
        lines: usize,
        /// Lines that are needed.
        needed: usize,
    },
    /// Excluded bands leave no line of a level.
    #[error("`--exclude` leaves no spectral line of level {0}; choose it anew")]
    NoLineOfLevel(Held),
    /// The levels cannot be diagnosed.
    #[error(transparent)]
    Stepped(#[from] SteppedError),
    /// The FRFs cannot be diagnosed.
    #[error("{0}{remedy}", remedy = remedy_of_diagnosis(.0))]
    Linear(#[from] DiagnosisError),
    /// The joint cannot be found.
    #[error(transparent)]
    Decomposition(#[from] DecompositionError),
    /// The joints cannot be found at once.
    #[error(transparent)]
    Joints(#[from] SeveralError),
    /// Several joints, where an answer holds one.
    #[error(
        "has {count} joints, and a row of the table holds one: choose it with `--joint`, or decompose this case by itself"
    )]
    SeveralJoints {
        /// Joints of the fixture.
        count: usize,
    },
    /// The fixture cannot have the window or the effects found beside its own.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
}

/// What an error is about: the file to name before its sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Concern {
    /// The fixture.
    Fixture,
    /// The recording.
    Recording,
    /// The options alone.
    Options,
}

impl Error {
    /// What the error is about.
    pub fn concern(&self) -> Concern {
        match self {
            Error::Fixture(_)
            | Error::Implausible(_)
            | Error::SeveralJoints { .. }
            | Error::Decomposition(DecompositionError::Sides(_) | DecompositionError::Model(_))
            | Error::Stepped(SteppedError::Model(_))
            | Error::Linear(DiagnosisError::Model(_)) => Concern::Fixture,
            Error::Joints(
                SeveralError::NothingRecorded | SeveralError::Noise(_) | SeveralError::Undetermined { .. },
            ) => Concern::Recording,
            Error::Joints(_) => Concern::Fixture,
            Error::Estimate(EstimateError::Window { .. }) => Concern::Options,
            _ => Concern::Recording,
        }
    }
}

fn remedy_of_estimate(error: &EstimateError) -> &'static str {
    match error {
        EstimateError::NoSuchHit { .. } => "; give `--keep` and `--reject` numbers of these",
        _ => "",
    }
}

fn remedy_of_diagnosis(error: &DiagnosisError) -> &'static str {
    match error {
        DiagnosisError::Baseline => {
            "; give `--baseline` a recording of the same FRFs over the same band, as the structure was before"
        }
        DiagnosisError::HoldOut(_) => {
            "; name FRFs of the recording with `--hold-out`, and leave one at the least"
        }
        _ => "",
    }
}
