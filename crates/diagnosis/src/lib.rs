//! What physics a fixture leaves out, told from the recordings that disagree with it.
//!
//! The questions are kept apart as in the physics. *Is there anything?* The fixture is refitted within its
//! tolerances, as priors, and only what is left against the noise is a mismatch. *What, and where?* Every
//! effect of the fixture file at every legal place ([`catalogue`]) is tried with the tolerances linearised,
//! the promising ones are fitted in full together with them, the best is kept if it earns its price, what is
//! left is searched again, effects are exchanged and dropped ([`Search`]). *How sure?* Every finding is
//! replaced by every other name in the company of the rest; names that serve as well are alternatives with
//! probabilities. *Is it better?* The search goes first without two bands and one FRF, which are then
//! predicted; the whole recording continues from what was found.
//!
//! No model of a real structure is right to the noise. Where the fixture as refitted leaves more, modes are
//! compared before lines, the model's own error a part of the likelihood ([`ModelError`]): what explains the
//! modes without any error is confirmed on lines, down to their noise; otherwise the name wins that makes the
//! error smaller. With a [baseline](DiagnosisOptions::baseline) what is diagnosed is what has changed since.
//!
//! * [`Observation`]: the FRFs on the lines in use, each value with its weight;
//! * [`Hypothesis`]: quantities of the fixture that may move, and effects with free parameters;
//! * [`Fit`]: a hypothesis at its maximum of likelihood and prior;
//! * [`Search`]: nominal, refitted and repaired model;
//! * [`locate`], [`measure`]: the place of a mismatch with no law assumed, and the δ(ω) found there;
//! * [`TestDrift`]: a structure that changed while it was tested: told from the poles of the references,
//!   before any physics is named;
//! * [`Diagnosis`]: verdict, findings with intervals and alternatives, mismatch by FRF and band, the held-out
//!   judgement.
//!
//! ```no_run
//! use jointscope_diagnosis::{Diagnosis, DiagnosisOptions};
//! # fn example(fixture: jointscope_fixture::Fixture, frfs: jointscope_spectra::FrfSet) -> Result<(), Box<dyn std::error::Error>> {
//! let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default())?;
//! for finding in &diagnosis.findings {
//!     println!("{} at {}: {:.2}", finding.effect.kind.name(), finding.effect.place, finding.probability);
//! }
//! # Ok(()) }
//! ```

mod along_body;
mod alternatives;
mod baseline;
mod bodies;
mod candidate;
mod catalogue;
mod contradiction;
mod default_settings;
mod departures;
mod diagnosis;
mod drift;
mod elsewhere;
mod estimates;
mod evidence;
mod facts;
mod finding;
mod fit;
mod fitter;
mod force_noise;
mod held_out;
mod hypothesis;
mod idle;
mod linearisation;
mod location;
mod mismatch;
mod modal;
mod moved_sensor;
mod named;
mod observation;
mod odd_record;
mod options;
mod parameter_transforms;
mod penalty;
mod prediction;
mod quantities;
mod ranking;
mod rarity;
mod record_end;
mod recorded_lines;
mod routes;
mod scan;
mod search;
mod searched_frfs;
mod settings;
#[cfg(test)]
mod simulated;
mod together;
mod usable;
mod watch;
mod work;

pub use alternatives::Alternative;
pub use baseline::{Baseline, ModeChange, ModeState};
pub use candidate::Candidate;
pub use catalogue::catalogue;
pub use contradiction::contradictory_lines;
pub use departures::Departure;
pub use diagnosis::Diagnosis;
pub use drift::{ModeDrift, ReferenceChange, TestDrift};
pub use facts::{EndErrors, FrfMisfit, Phase, Trend, Variation};
pub use finding::{Elsewhere, Finding, FrfEvidence, Tried};
pub use fit::Fit;
pub use hypothesis::Hypothesis;
pub use idle::{as_known, with_idle_points_exact};
pub use jointscope_findings::{Estimate, HeldOut, Verdict};
pub use jointscope_model_error::RecordEnd;
pub use jointscope_tolerances::Tolerance;
pub use linearisation::Linearisation;
pub use location::{BandMisfit, LawFit, LawParameter, LineEstimate, Location, Site, locate, measure};
pub use mismatch::{BandShare, FrfMismatch};
pub use modal::{ErrorIntervals, ModelError};
pub use observation::Observation;
pub use odd_record::OddRecord;
pub use options::{DiagnosisError, DiagnosisOptions};
pub use prediction::PredictionError;
pub use record_end::restored;
pub use search::Search;
pub use settings::evidence::unlisted::MOST_UNLISTED;
pub use settings::{
    EvidenceSettings, FitSettings, LawSettings, LocationSettings, ModalSettings, RankingSettings,
    SelectionSettings, Settings,
};
pub use watch::{Step, Watch};
