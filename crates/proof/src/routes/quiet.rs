//! A test with so little noise that a model's own error is what is left.

use crate::random::between;
use jointscope_rig::HammerSetup;
use rand::Rng;

/// Hits averaged, and their noise: that of the force, alike on all lines, makes 0.25 % of the average.
const AVERAGES: u32 = 8;
const NOISE_FORCE: f64 = 0.007;
/// That of the response, against its rms, which resonances make.
const NOISE_RESPONSE: f64 = 0.0007;
/// Frequencies at which a hit's force has fallen to 70 %, Hz.
const CORNER: [f64; 2] = [1500.0, 2000.0];

/// A test with so little noise that the model's own error is what is left.
pub(super) fn quiet_hammer(random: &mut impl Rng, seed: u64) -> HammerSetup {
    HammerSetup {
        averages: AVERAGES,
        noise_response: NOISE_RESPONSE,
        noise_force: NOISE_FORCE,
        corner: between(random, CORNER),
        spread: 0.25,
        common_hits: false,
        seed,
    }
}
