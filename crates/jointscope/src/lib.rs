//! What a model of an assembly leaves out, and how stiff and damped its joints are, from hammer tests.
//!
//! This crate is the short way to what its parts do at length. A [`Fixture`] says what is believed about the
//! assembly, a recording holds the FRFs between its points, and [`Analysis`] finds the joint between them:
//!
//! ```
//! use jointscope::{Analysis, AnalysisOptions, Fixture};
//!
//! let fixture = Fixture::from_json(include_str!("../../../fixtures/glued-joint/fixture.json"))?;
//! let recording = jointscope::read(&fixture, include_bytes!("../../../fixtures/glued-joint/hammer-test.uff"))?;
//! let analysis = Analysis::of(&fixture, recording.frfs()?, &AnalysisOptions::default())?;
//! let joint = analysis.joint_fit?;
//! assert!(joint.stiffness.at(0, 0) < 0.6 * analysis.nominal_stiffness.at(0, 0), "glue is soft");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Where the recordings do not suit the fixture, [`diagnose`] tells what physics was left out: is there
//! anything, where, what, how sure. FRFs, hits over time and stepped levels go the same way, as a
//! [`Measurement`]. Here a recording whose response 4 reads a tenth low:
//!
//! ```
//! use jointscope::pipeline::Options;
//! use jointscope::{
//!     Fixture, FrfPair, FrfSet, Instrument, Measurement, Outcome, Says, SpectralLines, Verdict, diagnose, effect_name, synthesize,
//! };
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": {"value": 2.0, "std": 0.002}, "rotates": false },
//!               "B": { "mass": {"value": 3.0, "std": 0.003}, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 }, "4": { "body": "B", "x": 0.1 } },
//!   "joints": { "J": { "from": "1", "to": "4", "stiffness": [[{"value": 5e6, "std": 5e4}, 0], [0, 0]] } },
//!   "damping": { "modal_ratios": [0.02] } }"#)?;
//! let pairs = [FrfPair::transverse("1", "1"), FrfPair::transverse("4", "1")];
//! let lines = SpectralLines::even(20.0, 20.0, 30)?;
//! let true_frfs = synthesize(&fixture, &pairs, &lines, Instrument::Perfect)?;
//! let mut values = true_frfs.all_values().to_vec();
//! values[30..].iter_mut().for_each(|value| *value *= 0.9);
//! let variance = values.iter().map(|value| 1e-4 * value.norm_sqr()).collect();
//! let recorded = FrfSet::new(lines, true_frfs.form(), pairs.to_vec(), values)?.with_variance(variance)?;
//!
//! let answer = diagnose(&fixture, &Measurement::from(recorded), &Options::default(), |_| ())?;
//! let Outcome::Linear(diagnosis) = &answer.outcome else { unreachable!("FRFs of one level tell nothing of amplitude") };
//! assert_eq!(diagnosis.verdict, Verdict::Explained);
//! assert_eq!(effect_name(&diagnosis.findings[0].effect), "gain of response 4");
//! assert_eq!(answer.repaired.physics().len(), 1);
//! println!("{}", diagnosis.says());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`answer_file`] writes it as `diagnosis.json`, [`answer_report`](report::answer_report) makes its page.
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
//! The parts are crates of their own, re-exported as modules for what this page leaves out: [`uff`],
//! [`import`], [`recordings`], [`fixture`], [`schema`], [`draft`], [`spectra`], [`frf`], [`hits`],
//! [`estimation`], [`beam`], [`damping`], [`lumped`], [`modes`], [`averaging`], [`linalg`], [`screening`],
//! [`wording`], [`decomposition`], [`diagnosis`], [`nonlinear`], [`findings`], [`pipeline`], [`plan`],
//! [`check`], [`cases`], [`fem`], [`comparison`], [`export`], [`tables`], [`rig`], [`proof`], [`report`].

pub use jointscope_averaging as averaging;
pub use jointscope_beam as beam;
pub use jointscope_cases as cases;
pub use jointscope_check as check;
pub use jointscope_comparison as comparison;
pub use jointscope_damping as damping;
pub use jointscope_decomposition as decomposition;
pub use jointscope_diagnosis as diagnosis;
pub use jointscope_draft as draft;
pub use jointscope_estimation as estimation;
pub use jointscope_export as export;
pub use jointscope_fem as fem;
pub use jointscope_findings as findings;
pub use jointscope_fixture as fixture;
pub use jointscope_frf as frf;
pub use jointscope_hits as hits;
pub use jointscope_import as import;
pub use jointscope_linalg as linalg;
pub use jointscope_lumped as lumped;
pub use jointscope_modes as modes;
pub use jointscope_nonlinear as nonlinear;
pub use jointscope_pipeline as pipeline;
pub use jointscope_plan as plan;
pub use jointscope_proof as proof;
pub use jointscope_recordings as recordings;
pub use jointscope_report as report;
pub use jointscope_rig as rig;
pub use jointscope_schema as schema;
pub use jointscope_screening as screening;
pub use jointscope_spectra as spectra;
pub use jointscope_tables as tables;
pub use jointscope_uff as uff;
pub use jointscope_wording as wording;

pub use jointscope_averaging::Band;
pub use jointscope_decomposition::{Analysis, AnalysisOptions, DecompositionError, Relation};
pub use jointscope_diagnosis::{Diagnosis, DiagnosisError, DiagnosisOptions, Finding, Verdict};
pub use jointscope_fixture::{Fixture, FixtureError};
pub use jointscope_lumped::{Instrument, LumpedError, synthesize};
pub use jointscope_modes::{ModalAnalysis, ModesError, ModesOptions};
pub use jointscope_pipeline::{
    Answer, Decomposition, MeasuredDamping, MeasuredDampingError, Measurement, Outcome, decompose, diagnose,
    measured_damping,
};
pub use jointscope_recordings::{ReadOptions, Recording, RecordingError};
pub use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
pub use jointscope_wording::{Remarks, Says, effect_name};

mod answer_file;
mod check_file;
mod comparison_file;
mod diagnosis_file;
mod file;
mod frf_files;
mod modes_file;
mod nonlinear_file;
mod plan_file;
mod stepped_file;
mod stiffness_file;

pub use answer_file::answer_file;
pub use check_file::check_file;
pub use comparison_file::comparison_file;
pub use diagnosis_file::diagnosis_file;
pub use frf_files::{checked_frfs, fitted_frfs, model_frfs, rebuilt_frfs};
pub use modes_file::modes_file;
pub use plan_file::{plan_file, weighed_file};
pub use stiffness_file::{joint_file, joints_file, stiffness_file};

/// Why the bytes of a file are no recording of a fixture.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// They are no universal file, table or MATLAB file that can be read.
    #[error(transparent)]
    Import(#[from] jointscope_import::ImportError),
    /// What they hold does not suit the fixture.
    #[error(transparent)]
    Recording(Box<RecordingError>),
}

/// Reads one file as a recording of `fixture`: node numbers are point names, directions ±2 are ±y. Universal
/// files, tables and MATLAB files are told apart by their bytes, see [`import`].
///
/// For several files, other names or missing units see [`Recording::of`].
///
/// # Errors
/// See [`ReadError`].
pub fn read(fixture: &Fixture, bytes: &[u8]) -> Result<Recording, ReadError> {
    let name = "the recording".to_owned();
    let file = import::read(bytes, &name, &import::ColumnMap::default())?.file;
    let source = jointscope_recordings::Source { name, file };
    Recording::of(&[source], fixture, &ReadOptions::default())
        .map_err(|error| ReadError::Recording(Box::new(error)))
}

/// The README's examples, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
