//! What the laboratory refuses: structures that cannot exist, and hammers that cannot strike.

use jointscope_fixture::FixtureError;
use jointscope_linalg::EigenError;
use jointscope_spectra::SpectraError;

/// Why a structure cannot be built or shaken.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StructureError {
    /// A channel names a point that the fixture does not have.
    #[error("there is no point `{0}` to measure at: name one of the fixture's points")]
    UnknownPoint(String),
    /// An effect makes FRFs depend on the amplitude.
    #[error(
        "`{kind}` at {place} is non-linear: it has no FRFs, leave it out or strike the structure in time"
    )]
    Nonlinear {
        /// The effect's kind.
        kind: &'static str,
        /// The effect's place.
        place: String,
    },
    /// The effect does not apply to its place.
    #[error("`{kind}` does not apply to {place}: {why}")]
    Misplaced {
        /// The effect's kind.
        kind: &'static str,
        /// The effect's place.
        place: String,
        /// What is missing there.
        why: &'static str,
    },
    /// A length, a stiffness or an inertia that a structure cannot have.
    #[error("{what} of {value} is impossible: {needed} is needed")]
    Impossible {
        /// The quantity.
        what: &'static str,
        /// Its value, SI.
        value: f64,
        /// Which values are possible.
        needed: &'static str,
    },
    /// The structure does not resist at a spectral line: an undamped resonance, or a free structure at 0 Hz.
    #[error("the dynamic stiffness is singular at {frequency} Hz: leave that line out")]
    Singular {
        /// The line, Hz.
        frequency: f64,
    },
    /// Under a stepped sine no steady motion was found.
    #[error("no steady motion was found at {frequency} Hz: shake less hard, or in smaller steps")]
    Unsettled {
        /// The line, Hz.
        frequency: f64,
    },
    /// The modes that the damping refers to could not be found.
    #[error("the modes of the assembly could not be found: {0}")]
    Modes(#[from] EigenError),
    /// The FRFs do not form a set.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
    /// The fixture is not possible.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
}

/// Why a hammer test cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HammerError {
    /// One hit leaves no coherence.
    #[error("{0} averages leave no coherence: at least 2 are needed")]
    TooFewAverages(u32),
    /// A noise level, corner frequency or spread that no hammer test has.
    #[error("{what} of {value} is impossible: a finite number, zero or above, is needed")]
    Impossible {
        /// The setting.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The FRFs do not form a set.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
}
