//! How stiff and how damped a welded, glued or bolted joint is, from hammer tests on two blocks.
//!
//! This crate is the short way to what its parts do at length. A [`Fixture`] says what is believed about the assembly, a
//! recording holds the FRFs between its points, and [`Analysis`] finds the joint between them:
//!
//! ```
//! use jointscope::{Analysis, AnalysisOptions, Fixture};
//!
//! let fixture = Fixture::from_json(include_str!("../../../fixtures/glued-joint/fixture.json"))?;
//! let recording = jointscope::read(&fixture, include_bytes!("../../../fixtures/glued-joint/hammer-test.uff"))?;
//! let analysis = Analysis::of(&fixture, recording.frfs()?, &AnalysisOptions::default())?;
//! let joint = analysis.likelihood?;
//! assert!(joint.stiffness.at(0, 0) < 0.6 * analysis.nominal_stiffness.at(0, 0), "glue is soft");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The other way round, [`synthesize`] gives the FRFs that a fixture should show:
//!
//! ```
//! use jointscope::{Fixture, FrfPair, Instrument, SpectralLines, synthesize};
//!
//! let fixture = Fixture::from_json(include_str!("../../../fixtures/glued-joint/fixture.json"))?;
//! let lines = SpectralLines::even(2.5, 2.5, 400)?;
//! let frfs = synthesize(&fixture, &[FrfPair::transverse("4", "1")], &lines, Instrument::Perfect)?;
//! // Far below the first resonance both blocks and the beam move as one rigid body.
//! assert!(frfs.values(0)[0].im.abs() < 1e-3 * frfs.values(0)[0].re.abs());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The parts are crates of their own, re-exported as modules for what this page leaves out: [`uff`], [`recordings`],
//! [`fixture`], [`spectra`], [`frf`], [`beam`], [`damping`], [`lumped`], [`averaging`], [`decomposition`].

pub use jointscope_averaging as averaging;
pub use jointscope_beam as beam;
pub use jointscope_damping as damping;
pub use jointscope_decomposition as decomposition;
pub use jointscope_diagnosis as diagnosis;
pub use jointscope_fixture as fixture;
pub use jointscope_frf as frf;
pub use jointscope_linalg as linalg;
pub use jointscope_lumped as lumped;
pub use jointscope_recordings as recordings;
pub use jointscope_spectra as spectra;
pub use jointscope_uff as uff;

pub use jointscope_averaging::Band;
pub use jointscope_decomposition::{Analysis, AnalysisOptions, DecompositionError, Relation};
pub use jointscope_fixture::{Fixture, FixtureError};
pub use jointscope_lumped::{Instrument, LumpedError, synthesize};
pub use jointscope_recordings::{ReadOptions, Recording, RecordingError};
pub use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};

mod stiffness_file;

pub use stiffness_file::stiffness_file;

/// Why the bytes of a universal file are no recording of a fixture.
#[derive(Debug)]
pub enum ReadError {
    /// They are no universal file.
    Uff(jointscope_uff::ReadError),
    /// What they hold does not suit the fixture.
    Recording(Box<RecordingError>),
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ReadError::Uff(error) => error.fmt(f),
            ReadError::Recording(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}

/// Reads one universal file as a recording of `fixture`: node numbers are point names, directions ±2 are ±y.
///
/// For several files, other names or missing units see [`Recording::of`].
///
/// # Errors
/// See [`ReadError`].
pub fn read(fixture: &Fixture, bytes: &[u8]) -> Result<Recording, ReadError> {
    let file = jointscope_uff::read(bytes).map_err(ReadError::Uff)?;
    let source = jointscope_recordings::Source { name: "the recording".into(), file };
    Recording::of(&[source], fixture, &ReadOptions::default())
        .map_err(|error| ReadError::Recording(Box::new(error)))
}

/// The README's examples, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
