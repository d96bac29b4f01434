//! Departures that are larger than chance makes them.

use crate::chi_squared_above;

/// Probability below which departures are no chance.
const NO_CHANCE: f64 = 0.01;

/// Birge's ratio: squared departures of quantities from what is stated, in standard deviations, per what
/// chance makes of them; 1 where chance explains them.
///
/// What deviations rest on these statements is to be multiplied by its root. Of less than one degree of
/// freedom chance makes as much of it as of one: where data tell a thousandth of one quantity, its square is a
/// thousandth of χ² of one degree.
pub fn birge_ratio(squares: f64, expected: f64) -> f64 {
    let ratio = squares / expected;
    if !(expected > 0.0 && ratio > 1.0) {
        return 1.0;
    }
    let degrees = expected.max(1.0);
    let by_chance = chi_squared_above(ratio * degrees, degrees);
    if by_chance < NO_CHANCE { ratio } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_data_tell_a_thousandth_of_departs_no_farther_than_chance_takes_it() {
        // A thousandth of χ² of one degree of freedom: four is chance, a hundred is not.
        assert_eq!(birge_ratio(4e-3, 1e-3), 1.0);
        assert_eq!(birge_ratio(0.1, 1e-3), 100.0);
    }

    #[test]
    fn departures_are_held_against_chi_squared_of_what_chance_makes_of_them() {
        // The 99 % quantile of χ² of four degrees of freedom is 13.28.
        assert_eq!(birge_ratio(13.2, 4.0), 1.0);
        assert!((birge_ratio(13.4, 4.0) - 3.35).abs() < 1e-12);
        assert_eq!(birge_ratio(1.0, 0.0), 1.0);
    }
}
