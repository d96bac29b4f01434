//! What an axis holds: records 8 to 11, and the unit exponents that go with a data type.

/// Specific data types of an axis (records 8 to 11, field 1).
pub mod data_type {
    /// Unknown, or the axis is not used.
    pub const UNKNOWN: i32 = 0;
    /// General: the exponents in the record say what it is.
    pub const GENERAL: i32 = 1;
    /// Stress.
    pub const STRESS: i32 = 2;
    /// Strain.
    pub const STRAIN: i32 = 3;
    /// Temperature.
    pub const TEMPERATURE: i32 = 5;
    /// Heat flux.
    pub const HEAT_FLUX: i32 = 6;
    /// Displacement (rotation in a rotational direction).
    pub const DISPLACEMENT: i32 = 8;
    /// Reaction force (moment in a rotational direction).
    pub const REACTION_FORCE: i32 = 9;
    /// Velocity.
    pub const VELOCITY: i32 = 11;
    /// Acceleration.
    pub const ACCELERATION: i32 = 12;
    /// Excitation force (moment in a rotational direction).
    pub const EXCITATION_FORCE: i32 = 13;
    /// Pressure.
    pub const PRESSURE: i32 = 15;
    /// Mass (moment of inertia in a rotational direction).
    pub const MASS: i32 = 16;
    /// Time.
    pub const TIME: i32 = 17;
    /// Frequency.
    pub const FREQUENCY: i32 = 18;
    /// Revolutions per minute.
    pub const RPM: i32 = 19;
    /// Order.
    pub const ORDER: i32 = 20;
}

/// One axis of a function: abscissa, ordinate (numerator), ordinate denominator or z-axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// Specific data type, see [`data_type`].
    pub data_type: i32,
    /// Exponents of length, force and temperature as stored. They count only for [`data_type::GENERAL`] and
    /// for scalar directions; see [`Axis::unit_exponents`].
    pub exponents: [i32; 3],
    /// Axis label, at most 20 characters; `NONE` if not used.
    pub label: String,
    /// Units label, at most 20 characters; `NONE` if not used.
    pub units: String,
}

impl Default for Axis {
    /// An axis that is not used.
    fn default() -> Self {
        Axis::new(data_type::UNKNOWN, "NONE", "NONE")
    }
}

impl Axis {
    /// An axis of a [`data_type`] with its labels, exponents left to the data type.
    pub fn new(data_type: i32, label: &str, units: &str) -> Self {
        Axis { data_type, exponents: [0; 3], label: label.to_owned(), units: units.to_owned() }
    }

    /// Frequency in Hz.
    pub fn frequency() -> Self {
        Axis::new(data_type::FREQUENCY, "Frequency", "Hz")
    }

    /// Time in s.
    pub fn time() -> Self {
        Axis::new(data_type::TIME, "Time", "s")
    }

    /// Displacement in m.
    pub fn displacement() -> Self {
        Axis::new(data_type::DISPLACEMENT, "Displacement", "m")
    }

    /// Velocity in m/s.
    pub fn velocity() -> Self {
        Axis::new(data_type::VELOCITY, "Velocity", "m/s")
    }

    /// Acceleration in m/s².
    pub fn acceleration() -> Self {
        Axis::new(data_type::ACCELERATION, "Acceleration", "m/s^2")
    }

    /// Excitation force in N.
    pub fn excitation_force() -> Self {
        Axis::new(data_type::EXCITATION_FORCE, "Excitation Force", "N")
    }

    /// Exponents of length, force and temperature in this quantity along `direction` (±1 to ±3 translation,
    /// ±4 to ±6 rotation, 0 scalar): the table of the specification's Addendum A, or the stored exponents
    /// where that table leaves them to the record. Time never enters: all unit systems share the second.
    pub fn unit_exponents(&self, direction: i32) -> [i32; 3] {
        let rotational = match direction.unsigned_abs() {
            1..=3 => false,
            4..=6 => true,
            _ => return self.exponents,
        };
        match (self.data_type, rotational) {
            (data_type::GENERAL, _) => self.exponents,
            (data_type::STRESS | data_type::PRESSURE, false) => [-2, 1, 0],
            (data_type::STRESS | data_type::PRESSURE, true) => [-1, 1, 0],
            (data_type::TEMPERATURE, _) => [0, 0, 1],
            (data_type::HEAT_FLUX, _) => [1, 1, 0],
            (data_type::DISPLACEMENT | data_type::VELOCITY | data_type::ACCELERATION, false) => [1, 0, 0],
            (data_type::REACTION_FORCE | data_type::EXCITATION_FORCE, false) => [0, 1, 0],
            (data_type::REACTION_FORCE | data_type::EXCITATION_FORCE, true) => [1, 1, 0],
            (data_type::MASS, false) => [-1, 1, 0],
            (data_type::MASS, true) => [1, 1, 0],
            _ => [0, 0, 0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_translation_is_a_length_and_a_rotation_is_none() {
        assert_eq!(Axis::acceleration().unit_exponents(-2), [1, 0, 0]);
        assert_eq!(Axis::acceleration().unit_exponents(6), [0, 0, 0]);
        assert_eq!(Axis::excitation_force().unit_exponents(2), [0, 1, 0]);
        assert_eq!(Axis::excitation_force().unit_exponents(-6), [1, 1, 0]);
    }

    #[test]
    fn a_general_axis_keeps_the_exponents_of_its_record() {
        let energy = Axis { exponents: [1, 1, 0], ..Axis::new(data_type::GENERAL, "Energy", "J") };
        assert_eq!(energy.unit_exponents(2), [1, 1, 0]);
        assert_eq!(energy.unit_exponents(0), [1, 1, 0]);
    }
}
