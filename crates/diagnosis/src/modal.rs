//! Hypotheses compared by modes, the model's own error a part of the likelihood.
//!
//! No model of a real structure is exact: its natural frequencies are off by some tenths of a per cent, its
//! shapes and damping by some per cent, and against the noise of the FRFs every name is refuted. What decides
//! is which name leaves the smallest error of the model, and how much smaller than no name. So the error is a
//! part of the likelihood, common to all hypotheses, its sizes estimated for each
//! ([`jointscope_model_error`]): a name wins by making it smaller.
//!
//! * [`again`]: what was found in the whole of a recording, in a part of it;
//! * [`along`]: what is known of an effect along the ridge that its place and sizes share;
//! * [`at_sizes`]: a fitted hypothesis where the sizes of error are given;
//! * [`changes`]: the modes of two states side by side;
//! * [`elsewhere`]: where else along its body an effect explains the modes;
//! * [`features`]: a recording as its modes tell it;
//! * [`problem`]: the modes of a hypothesis, paired with the recorded ones;
//! * [`descent`]: its parameters fitted at given sizes of error;
//! * [`fit`]: one hypothesis at its most probable parameters and sizes of error;
//! * [`errors_on_lines`]: what errors of modes make of the lines;
//! * [`evidence`]: how probable it makes what was recorded;
//! * [`turns`]: how its sizes of error go on from round to round;
//! * [`prior`]: what is known of parameters beforehand;
//! * [`sizes`]: what is known of the sizes of error, and what a fit says of them;
//! * [`known`]: what a search of a part of a recording may choose from;
//! * [`needs`]: which effects modes need that were found on lines;
//! * [`searcher`]: what all steps of a search share;
//! * [`starts`]: where fits set out;
//! * [`every_joint`]: what a model leaves out of every joint alike;
//! * [`extended`]: fits of what a search has, with one effect more or with fewer;
//! * [`search`]: every candidate, alone and beside others;
//! * [`compared`]: a fixture compared with a recording, or with what has changed;
//! * [`judgement`]: the outcome: names with their probabilities and intervals, and errors;
//! * [`judge`]: verdict, probabilities and errors;
//! * [`places`]: where along its body a finding may sit;
//! * [`beside_lines`]: what modes leave to the lines;
//! * [`predicting`]: models that are to predict where nobody measured;
//! * [`uncertainty`]: what errors of the model leave uncertain of what lines have found.

mod again;
mod along;
mod at_sizes;
mod beside_lines;
mod changes;
mod compared;
mod descent;
mod elsewhere;
mod errors_on_lines;
mod every_joint;
mod evidence;
mod extended;
mod features;
mod fit;
mod judge;
mod judgement;
mod known;
mod needs;
mod places;
mod predicting;
mod prior;
mod problem;
mod repetition;
mod search;
mod searcher;
mod sizes;
mod starts;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
mod turns;
mod uncertainty;

pub(crate) use beside_lines::Explaining;
pub(crate) use compared::fixture_by_modes;
pub(crate) use features::{Features, modes_options, recorded};
pub(crate) use judgement::ModalJudgement;
pub(crate) use known::Known;
pub(crate) use needs::without_imitations;
pub use sizes::{ErrorIntervals, ModelError};
