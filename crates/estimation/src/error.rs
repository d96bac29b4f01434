//! What hits lack where no FRFs can be estimated of them.

use jointscope_spectra::SpectraError;

use crate::settings::hits::FEWEST_SAMPLES;

/// Why no FRFs can be made of hits.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EstimateError {
    /// No hits were given.
    #[error("there are no hits to estimate FRFs from")]
    NoHits,
    /// No hit has a response.
    #[error(
        "no hit has a response: record at least one acceleration, velocity or displacement beside the force"
    )]
    NoResponses,
    /// An option names a hit that is not there.
    #[error("there is no hit {number} to {what}; the hits are {hits}")]
    NoSuchHit {
        /// The number asked for.
        number: u32,
        /// `keep` or `reject`.
        what: &'static str,
        /// The hits there are.
        hits: String,
    },
    /// Hits that were sampled differently.
    #[error(
        "hit {first} was sampled every {first_interval} s and hit {second} every {second_interval} s: give hits of one sampling rate"
    )]
    Interval {
        /// One hit.
        first: u32,
        /// Its interval, s.
        first_interval: f64,
        /// Another.
        second: u32,
        /// Its interval, s.
        second_interval: f64,
    },
    /// No hit is fit for use.
    #[error("every hit is rejected: {0}; record the test again, or use hits all the same with `--keep`")]
    AllRejected(String),
    /// Too few samples for a spectrum.
    #[error("a record of {0} samples is too short for an FRF: {needed} are needed at the least", needed = FEWEST_SAMPLES)]
    TooShort(usize),
    /// A window of no length, or a decay that is none.
    #[error("{what} of {value} makes no sense: a positive number of {unit} is needed")]
    Window {
        /// Which.
        what: &'static str,
        /// What was given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// The FRFs are no valid set.
    #[error("the FRFs do not make a set: {0}")]
    Spectra(#[from] SpectraError),
}
