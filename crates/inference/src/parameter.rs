//! A parameter of a fit: the coordinate that moves it, its bounds, and its prior in units of its deviation.

/// How a physical quantity follows the coordinate by which a fit moves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transform {
    /// It stays.
    Fixed,
    /// centre + scale·coordinate.
    Linear {
        /// Value at coordinate zero.
        centre: f64,
        /// Change for one unit of the coordinate.
        scale: f64,
    },
    /// centre·exp(scale·coordinate): positive, so that what trades against a factor of something else does so
    /// along a straight line.
    Logarithmic {
        /// Value at coordinate zero.
        centre: f64,
        /// Relative change for one small unit of the coordinate.
        scale: f64,
    },
}

impl Transform {
    /// The value at a coordinate; `None` where the quantity stays.
    pub fn value(&self, coordinate: f64) -> Option<f64> {
        match self {
            Transform::Fixed => None,
            Transform::Linear { centre, scale } => Some(centre + coordinate * scale),
            Transform::Logarithmic { centre, scale } => Some(centre * (coordinate * scale).exp()),
        }
    }

    /// The coordinate of a value, of the smallest positive number where a logarithm has none; `None` where
    /// the quantity stays.
    pub fn coordinate(&self, value: f64) -> Option<f64> {
        match self {
            Transform::Fixed => None,
            Transform::Linear { centre, scale } => Some((value - centre) / scale),
            Transform::Logarithmic { centre, scale } => {
                Some((value / centre).max(f64::MIN_POSITIVE).ln() / scale)
            }
        }
    }

    /// d(value)/d(coordinate) at a value; zero where the quantity stays.
    pub fn slope(&self, value: f64) -> f64 {
        match self {
            Transform::Fixed => 0.0,
            Transform::Linear { scale, .. } => *scale,
            Transform::Logarithmic { scale, .. } => value * scale,
        }
    }
}

/// A parameter of a fit: its transform, its bounds and what was known of it before, as a normal distribution
/// of its coordinate about zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// From coordinate to value.
    pub transform: Transform,
    /// Lowest coordinate.
    pub low: f64,
    /// Highest coordinate.
    pub high: f64,
    /// Precision of the prior, 1/variance of the coordinate; zero where nothing was known.
    pub precision: f64,
}

impl Parameter {
    /// Unbounded, with nothing known before.
    pub fn new(transform: Transform) -> Self {
        Parameter { transform, low: f64::NEG_INFINITY, high: f64::INFINITY, precision: 0.0 }
    }

    /// The same between bounds of the coordinate.
    pub fn between(self, low: f64, high: f64) -> Self {
        Parameter { low, high, ..self }
    }

    /// The same with a prior.
    pub fn with_precision(self, precision: f64) -> Self {
        Parameter { precision, ..self }
    }

    /// Whether a fit moves it.
    pub fn is_free(&self) -> bool {
        self.transform != Transform::Fixed
    }

    /// The nearest coordinate within the bounds; a bound that is no number bounds nothing, and of bounds that
    /// exclude each other the one that is passed holds.
    pub fn clamp(&self, coordinate: f64) -> f64 {
        if coordinate < self.low {
            self.low
        } else if coordinate > self.high {
            self.high
        } else {
            coordinate
        }
    }

    /// (departure/std)²: what the prior adds to the objective.
    pub fn squared_departure(&self, coordinate: f64) -> f64 {
        self.precision * coordinate * coordinate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bounds_that_exclude_each_other_or_are_no_numbers_stop_no_program() {
        let free = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
        assert_eq!(free.between(2.0, 1.0).clamp(1.5), 2.0);
        assert_eq!(free.between(f64::NAN, 1.0).clamp(5.0), 1.0);
        assert_eq!(free.between(-1.0, 1.0).clamp(-3.0), -1.0);
        assert!(free.between(-1.0, 1.0).clamp(f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn a_value_comes_back_from_its_coordinate_and_the_slope_is_the_derivative(
            centre in 0.1f64..10.0, scale in 0.01f64..2.0, coordinate in -3.0f64..3.0
        ) {
            for transform in [Transform::Linear { centre, scale }, Transform::Logarithmic { centre, scale }] {
                let value = transform.value(coordinate).unwrap();
                prop_assert!((transform.coordinate(value).unwrap() - coordinate).abs() < 1e-9);
                let difference = (transform.value(coordinate + 1e-6).unwrap() - transform.value(coordinate - 1e-6).unwrap()) / 2e-6;
                prop_assert!((difference - transform.slope(value)).abs() < 1e-6 * (1.0 + difference.abs()));
            }
        }
    }
}
