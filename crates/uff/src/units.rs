//! Dataset 164: the unit system of the datasets that follow it.

/// How the temperatures of a file are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TemperatureMode {
    /// From absolute zero: kelvin, degrees Rankine.
    Absolute,
    /// From the scale's own zero: degrees Celsius, Fahrenheit.
    Relative,
}

/// Unit system of a file (dataset 164), valid for all datasets after it.
///
/// The rule of the specification: **values in file units are divided by the factor to become SI**. In feet,
/// the length factor is 3.28084 (feet per metre).
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    /// Units code: 1 metre and newton, 2 foot and pound-force, 3 metre and kilogram-force, 4 foot and
    /// poundal, 5 mm and mN, 6 cm and cN, 7 inch and pound-force, 8 mm and kilogram-force, 9 user-defined,
    /// 10 mm and newton.
    pub code: i32,
    /// Description, for people only; at most 20 characters.
    pub description: String,
    /// How temperatures are counted.
    pub temperature_mode: TemperatureMode,
    /// File length units per metre.
    pub length_factor: f64,
    /// File force units per newton.
    pub force_factor: f64,
    /// File temperature units per kelvin.
    pub temperature_factor: f64,
    /// Absolute temperature, in file units, of the relative scale's zero.
    pub temperature_offset: f64,
}

impl Units {
    /// Metre, newton, kelvin.
    pub fn si() -> Self {
        Units {
            code: 1,
            description: "SI: Meter (newton)".to_owned(),
            temperature_mode: TemperatureMode::Absolute,
            length_factor: 1.0,
            force_factor: 1.0,
            temperature_factor: 1.0,
            temperature_offset: 273.15,
        }
    }

    /// What a quantity with the given exponents of length, force and temperature is multiplied by to become
    /// SI. Temperatures count as differences here.
    pub fn si_per_unit(&self, exponents: [i32; 3]) -> f64 {
        let [length, force, temperature] = exponents;
        1.0 / (self.length_factor.powi(length)
            * self.force_factor.powi(force)
            * self.temperature_factor.powi(temperature))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    /// Factors of the example printed in the specification of dataset 164.
    fn foot_and_pound_force() -> Units {
        Units {
            code: 2,
            description: "Foot (pound f)".to_owned(),
            temperature_mode: TemperatureMode::Relative,
            length_factor: 3.280839895013123,
            force_factor: 0.2248089430997105,
            temperature_factor: 1.8,
            temperature_offset: 459.67,
        }
    }

    fn check(expected: f64, got: f64) {
        assert!((got - expected).abs() <= 1e-6 * expected.abs(), "expected {expected}, got {got}");
    }

    #[test]
    fn values_are_divided_by_their_factor_to_become_si() {
        let units = foot_and_pound_force();
        check(0.3048, units.si_per_unit([1, 0, 0]));
        check(4.448222, units.si_per_unit([0, 1, 0]));
        check(5.0 / 9.0, units.si_per_unit([0, 0, 1]));
    }

    #[test]
    fn an_accelerance_in_feet_and_pounds_becomes_si() {
        let units = foot_and_pound_force();
        let acceleration = |direction| units.si_per_unit(Axis::acceleration().unit_exponents(direction));
        let force = |direction| units.si_per_unit(Axis::excitation_force().unit_exponents(direction));
        check(0.3048 / 4.448222, acceleration(2) / force(-2));
        check(1.0 / (4.448222 * 0.3048), acceleration(6) / force(6));
    }
}
