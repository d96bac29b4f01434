//! Joints whose stiffness or damping depends on amplitude: their motion over time, and what hits of several
//! strengths tell of them.
//!
//! * [`simulate`]: accelerations of a fixture under recorded forces, its cubic springs, friction and gaps
//!   included. The linear part is propagated exactly; events of contact and slip are confined to short steps;
//! * [`NonlinearDiagnosis`]: do FRFs change with the strength of the hits ([`Homogeneity`], no model needed)?
//!   If they do, every law at every joint and degree of freedom is simulated under the recorded forces and
//!   fitted together with the fixture's tolerances, and judged on hits that no fit saw;
//! * [`SteppedDiagnosis`]: stepped-sine FRFs at several levels: frequency and damping of the resonance by
//!   level, the joint's equivalent stiffness and loss against the amplitude of its motion by harmonic
//!   balance, which law follows them, and up to which level;
//! * [`pooled`]: one set of FRFs of levels that are alike, for analyses that know of no amplitude;
//! * [`ForceStateMap`]: what a joint bore against how it was moved, from the measured motion of its bodies;
//! * [`RestoringLaw`]: the laws themselves.
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_hits::Hit;
//! use jointscope_nonlinear::simulate;
//! use jointscope_spectra::Channel;
//!
//! // Two storeys that touch after a tenth of a millimetre.
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 } },
//!   "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e5, 0], [0, 0]] } },
//!   "physics": [ { "kind": "gap", "place": "J", "dof": "translation", "clearance": 1e-4, "stiffness": 5e6 } ] }"#)?;
//! let blow = |peak: f64| {
//!     let force = (0..512).map(|i| if i < 8 { peak * (0.4 * i as f64).sin() } else { 0.0 }).collect();
//!     Hit::new(1, 1e-4, 0.0, Channel::transverse("1"), force, Vec::new())
//! };
//! let peak = |hit: Hit| -> Result<f64, Box<dyn std::error::Error>> {
//!     let simulated = simulate(&fixture, &[hit], &[Channel::transverse("2")])?;
//!     Ok(simulated.hits[0].responses()[0].values.iter().fold(0.0, |most: f64, a| a.abs().max(most)))
//! };
//! // A hundred times the force gives more than a hundred times the response: the gap has closed.
//! assert!(peak(blow(1000.0)?)? > 150.0 * peak(blow(10.0)?)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod estimates;
mod force_state;
mod identification;
mod settings;
mod spectra;
mod stepped;
mod time;

pub use error::{ChannelError, DiagnoseError, ForceStateError, SimulationError, SteppedError};
pub use force_state::{ForceState, ForceStateMap, MotionSource};
pub use identification::diagnosis::{NonlinearDiagnosis, NonlinearOptions, Reach};
pub use identification::homogeneity::{HitLevel, Homogeneity};
pub use identification::judge::{FittedQuantity, HitEvidence, HitFinding, ModelFit};
pub use jointscope_findings::{Estimate, HeldOut, Verdict};
pub use stepped::course::{DampingCourse, FrequencyCourse};
pub use stepped::diagnosis::{LevelResult, SteppedDiagnosis};
pub use stepped::level::{Held, SteppedLevel};
pub use stepped::naming::{LevelEvidence, LevelFinding, TriedForm};
pub use stepped::pooled::pooled;
pub use stepped::resonance::Resonance;
pub use time::law::RestoringLaw;
pub use time::simulation::{Simulation, simulate};
