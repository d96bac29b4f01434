//! Sentences: results as the user is told them.
//!
//! Results are typed facts; this crate alone turns them into words, for files, pages and the terminal alike.
//! It decides nothing: what is doubtful, white, settled or not determined stands in the results.
//!
//! * [`Says`]: a result, a finding or a place in one plain sentence or a few words;
//! * [`Remarks`]: what a reader should know besides;
//! * [`Summary`]: what was found, a line each, for a terminal;
//! * [`comparison`], [`models`], [`decomposition`]: joints side by side, models over measurements, and one by
//!   itself;
//! * [`format`](mod@format), [`unit`](mod@unit): numbers with their deviations and units;
//! * [`effect_name`]: an effect's kind and place in a few words;
//! * [`place_and_sizes`]: another place of a finding, and its sizes there;
//! * [`error_in_words`]: how wrong a model is, beside what is usual.
//!
//! ```
//! use jointscope_fixture::{Effect, EffectKind, Place};
//! use jointscope_wording::effect_name;
//!
//! let effect = Effect::new(EffectKind::JointMass, Place::Joint("J".into()), None, &[0.05]);
//! assert_eq!(effect_name(&effect), "mass of joint J");
//! ```

mod amplitude;
pub mod comparison;
pub mod decomposition;
mod departures;
mod diagnosis;
mod drift;
mod effects;
pub mod element;
mod estimate;
mod estimation;
mod finding;
pub mod format;
mod hits;
mod joint;
mod levels;
mod misfit;
mod model_error;
pub mod models;
mod modes;
mod numbers;
mod places;
mod ratio;
mod summary;
pub mod unit;

pub use effects::{advice, effect_name};
pub use finding::{place_and_sizes, with_fitted_size};
pub use model_error::{ErrorInWords, error_in_words};
pub use numbers::{capitalised, counted, listed};
pub use places::held_out_part;

/// Something that can be said in one plain sentence, or in a few words.
pub trait Says {
    /// The sentence.
    fn says(&self) -> String;
}

/// A result that is told on a terminal.
pub trait Summary {
    /// Verdict, findings with their probabilities, errors of the models, remarks: a line each.
    fn summary(&self) -> Vec<String>;
}

/// A result that a reader should know more of.
pub trait Remarks {
    /// One plain sentence each.
    fn remarks(&self) -> Vec<String>;
}
