//! What every diagnosis answers with, linear or not: a [`Verdict`], [`Finding`]s with an [`Estimate`] of each
//! parameter, the judgement on [`HeldOut`] data.
//!
//! All of it serialises as `diagnosis.json` has it.
//!
//! ```
//! use jointscope_findings::Estimate;
//! use jointscope_fixture::EffectKind;
//!
//! let mass = EffectKind::JointMass.spec().parameters[0];
//! let unknown = Estimate::of(mass, None, 0.077);
//! assert_eq!(unknown.interval, None);
//! assert!(unknown.within(0.002).is_positive());
//! ```

mod estimate;
mod finding;
mod serialization;
mod verdict;

pub use estimate::Estimate;
pub use finding::Finding;
pub use serialization::{alternatives, by_model, effect_name, parameters, with_std};
pub use verdict::{HeldOut, Verdict};
