//! What cases have in common whose model is a little wrong everywhere: a quiet test, names that are true, their scores.
//!
//! Against noise of a quarter of a per cent no fixture explains such a recording. What is hidden has to be told from the model's own error, and
//! whatever is named has to be true of the structure.

mod judged;
mod names;
mod score;

pub use names::TrueName;
pub(super) use score::{Route, score};

use crate::generate::between;
use crate::{Evidence, Judgeable};
use jointscope_fixture::Effect;
use jointscope_rig::HammerTest;
use rand::Rng;

/// What is true of a case whose model is a little wrong everywhere.
pub trait Erring: Judgeable {
    /// What is hidden, sizes in closed form; nothing or one thing.
    fn concealed(&self) -> Option<&Effect> {
        self.effects().first()
    }
    /// Whether physics that everybody knows of was left unstated.
    fn is_gap(&self) -> bool;
    /// Whether an effect by another name says the same of the recording as what is hidden.
    fn stands_for(&self, found: &Effect, evidence: &Evidence) -> bool;
    /// Whether an effect that was found is in the structure although it is not hidden.
    fn is_true(&self, found: &Effect) -> bool;
    /// Whether what is hidden shows beside the model's own error.
    fn shows(&self, evidence: &Evidence) -> bool;
}

/// Hits averaged, and their noise: that of the force, alike on all lines, makes 0.25 % of the average.
const AVERAGES: u32 = 8;
const NOISE_FORCE: f64 = 0.007;
/// That of the response, against its rms, which resonances make.
const NOISE_RESPONSE: f64 = 0.0007;
/// Frequencies at which a hit's force has fallen to 70 %, Hz.
const CORNER: [f64; 2] = [1500.0, 2000.0];

/// A test with so little noise that the model's own error is what is left.
pub(super) fn quiet_hammer(random: &mut impl Rng, seed: u64) -> HammerTest {
    HammerTest {
        averages: AVERAGES,
        noise_response: NOISE_RESPONSE,
        noise_force: NOISE_FORCE,
        corner: between(random, CORNER),
        spread: 0.25,
        common_hits: false,
        seed,
    }
}
