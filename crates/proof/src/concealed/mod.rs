//! The diagnosis on real recordings: something is concealed relative to a fixture that explains them, and
//! must be found in real noise.
//!
//! No fixture fits a real recording to its noise by itself. [`Explained`] is the fixture that does: the given
//! one, or what a first diagnosis repairs it to. A [`ConcealmentPlan`] then deletes an entry of that fixture,
//! misstates one, or alters a channel of the recording; some cases stay as they are, as controls. As with
//! simulated cases the diagnosis is handed a [`Case`](crate::Case) and nothing else, and the [`Concealed`]
//! truths come out of their seal against the answers to all cases. [`ConcealmentScores`] then lays both side
//! by side.
//!
//! Case 0 is always a control: what is found in it is the recording's own, and no false alarm elsewhere.
//!
//! Nothing here is built of the diagnosis' own parts or of the model: cases are edits of a fixture's entries
//! and of recorded values. Only [`ConcealmentScores`] evaluates objectives.
//!
//! ```
//! use jointscope_proof::concealed::{ConcealmentPlan, ConcealmentScores};
//! use jointscope_proof::{Answers, NoAnswer};
//! # use jointscope_fixture::Fixture;
//! # use jointscope_rig::{Instrument, frfs};
//! # use jointscope_spectra::{FrfPair, SpectralLines};
//! # let explaining = Fixture::from_json(r#"{
//! #   "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
//! #   "points": { "1": { "body": "A", "x": 0.0 }, "2": { "body": "B", "x": 0.1 } },
//! #   "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e6, 0.0], [0.0, 0.0]] } } }"#)?;
//! # let lines = SpectralLines::even(50.0, 5.0, 80)?;
//! # let recorded = frfs(&explaining, &[FrfPair::transverse("2", "1")], &lines, Instrument::Perfect)?;
//! let plan = ConcealmentPlan { cases: 4, seed: 1, ..ConcealmentPlan::default() };
//! let (cases, sealed) = plan.conceal(&explaining, &recorded)?;
//! // Somebody who never answers, in place of `Answers::by(&cases, 1, |_| (), Answer::of)`.
//! let answers = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
//! let truths = sealed.open(&answers).ok_or("answers are missing")?;
//! let scores = ConcealmentScores::of(&cases, truths, &answers, 1);
//! assert_eq!((scores.share("found").of, scores.share("found").all), (0, 3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod base_test;
mod error;
mod explained;
mod fixture_edit;
mod outcome;
mod plan;
mod recording_edit;
mod scores;
mod table;
mod truth;

pub use error::ConcealmentError;
pub use explained::Explained;
pub use outcome::Outcome;
pub use plan::ConcealmentPlan;
pub use scores::{ConcealmentScores, ScoredConcealment};
pub use truth::{Concealed, ConcealmentKind, Expected};
