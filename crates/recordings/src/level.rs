//! Levels of a stepped-sine test: the amplitude of force or response that was held, from ID line 4.

use std::fmt;

use crate::unit::{Dimension, Unit};

/// The amplitude that a stepped-sine test held, read from ID line 4: `force 0.5 N` or `response 20 m/s^2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeldAmplitude {
    /// Amplitude of the exciting force, N.
    Force(f64),
    /// Amplitude of the response's acceleration, m/s².
    Response(f64),
}

impl HeldAmplitude {
    /// Reads an ID line; `None` for one that speaks of something else.
    pub fn parse(id_line: &str) -> Option<Self> {
        let mut words = id_line.split_whitespace();
        let quantity = words.next()?.to_lowercase();
        let amplitude: f64 = words.next()?.parse().ok()?;
        let unit = Unit::parse(words.next()?)?;
        let value = amplitude * unit.si;
        if words.next().is_some() || !value.is_finite() || value <= 0.0 {
            return None;
        }
        match quantity.as_str() {
            "force" if unit.dimension == Dimension::FORCE => Some(HeldAmplitude::Force(value)),
            "response" if unit.dimension == Dimension::motion(2, false) => {
                Some(HeldAmplitude::Response(value))
            }
            _ => None,
        }
    }

    /// Sorts forces before responses and small before large.
    pub(crate) fn key(self) -> (u8, u64) {
        // Bits of positive numbers ascend with them.
        match self {
            HeldAmplitude::Force(value) => (1, value.to_bits()),
            HeldAmplitude::Response(value) => (2, value.to_bits()),
        }
    }
}

impl fmt::Display for HeldAmplitude {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            HeldAmplitude::Force(value) => write!(f, "force {value} N"),
            HeldAmplitude::Response(value) => write!(f, "response {value} m/s^2"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_amplitudes_are_read_and_other_id_lines_left_alone() {
        assert_eq!(HeldAmplitude::parse("force 0.52 N"), Some(HeldAmplitude::Force(0.52)));
        assert_eq!(HeldAmplitude::parse("response 5 m/s^2"), Some(HeldAmplitude::Response(5.0)));
        assert_eq!(HeldAmplitude::parse(" Response  2 g "), Some(HeldAmplitude::Response(2.0 * 9.80665)));
        for other in
            ["NONE", "", "force", "force 1", "force 1 m", "response 1 N", "force -1 N", "force 1 N at 3"]
        {
            assert_eq!(HeldAmplitude::parse(other), None, "`{other}`");
        }
    }
}
