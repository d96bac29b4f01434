//! One route from a test to what the fixture leaves out, and one to its joints. The program, the facade and
//! `prove` all take them, so that what is scored is what is used.
//!
//! ```text
//! recording              homogeneity                         answer
//!
//! FRFs of one level ───────────────────────────────────────► linear diagnosis of the FRFs
//!
//! FRFs at several ─────► do they change     no, or cannot ─► linear diagnosis of their mean
//! levels                 with level?        be judged
//!                                           yes ───────────► law of a joint, from the levels
//!
//! hits over time ──────► FRFs estimated; do  no, or cannot ─► linear diagnosis of the FRFs estimated
//!                        they change with    be judged
//!                        strength?           yes ──────────► law of a joint, from the hits
//! ```
//!
//! * [`Measurement`]: what a test recorded, read from universal files;
//! * [`MeasuredFrfs`]: its FRFs at one level, recorded as such or estimated from its hits ([`HammerTest`]),
//!   for analyses of their own;
//! * [`diagnose`] with [`Options`]: the route above;
//! * [`Alike`]: how a baseline and a recording are to be estimated from their hits, so that what differs is the
//!   structure;
//! * [`decompose`]: the way to the joint in a measurement, or to all joints ([`Decomposition`]);
//! * [`Answer`]: which way it went ([`Outcome`]), the refitted and the repaired fixture, notes for the
//!   reader;
//! * [`measured_damping`]: a fixture with the damping ratios of measured modes.
//!
//! Two rules hold on every branch. A test of homogeneity that fails (hits all alike, levels too close) does
//! not end the diagnosis: the FRFs are diagnosed, and a note says what could not be judged. Fixtures that are
//! handed back keep the effects of the fixture that was given; an exponential window and what was found are
//! added.
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_pipeline::{Measurement, Options, Outcome, diagnose};
//! use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
//! use num_complex::Complex64;
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": {"value": 2.0, "std": 0.002}, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 } } }"#)?;
//! // A block of 2.5 kg, and 1 % noise: what is found is added to the fixture.
//! let lines = SpectralLines::even(10.0, 10.0, 40)?;
//! let values = (0..40).map(|line| Complex64::from(if line % 2 == 0 { 0.404 } else { 0.396 })).collect();
//! let frfs = FrfSet::new(lines, FrfForm::Accelerance, vec![FrfPair::transverse("1", "1")], values)?.with_variance(vec![1.6e-5; 40])?;
//!
//! let answer = diagnose(&fixture, &Measurement::from(frfs), &Options::default(), |_| ())?;
//! let Outcome::Linear(diagnosis) = &answer.outcome else { unreachable!("one level tells nothing of amplitude") };
//! assert_eq!(answer.repaired.physics().len(), diagnosis.findings.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod decompose;
mod error;
mod frfs;
mod hammer_test;
mod hits;
mod homogeneity;
mod levels;
mod measurement;
mod modal_damping;
mod options;
mod route;
mod two_states;

pub use answer::{Answer, Outcome};
pub use decompose::{DecomposeOptions, Decomposition, Joints, decompose};
pub use error::{Concern, Error, MeasurementError};
pub use frfs::MeasuredFrfs;
pub use hammer_test::HammerTest;
pub use measurement::Measurement;
pub use modal_damping::{MeasuredDamping, MeasuredDampingError, measured_damping};
pub use options::Options;
pub use route::{Progress, diagnose};
pub use two_states::Alike;
