//! Departures that are larger than chance makes them.

use statrs::function::gamma::gamma_ur;

/// Probability below which departures are no chance.
const NO_CHANCE: f64 = 0.01;

/// Birge's ratio: squared departures of quantities from what is stated, in standard deviations, per what
/// chance makes of them; 1 where chance explains them.
///
/// What deviations rest on these statements is to be multiplied by its root.
pub fn birge_ratio(squares: f64, expected: f64) -> f64 {
    let ratio = squares / expected;
    if !(expected > 0.0 && ratio > 1.0) {
        return 1.0;
    }
    let by_chance = gamma_ur(0.5 * expected, 0.5 * squares);
    if by_chance < NO_CHANCE { ratio } else { 1.0 }
}
