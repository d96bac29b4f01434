//! What one thing adds to the dynamic stiffness where it acts.

use crate::lanes::Lines;

/// The dynamic stiffness that one thing adds through one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PointLaw {
    /// k + s c.
    Spring { stiffness: f64, damping: f64 },
    /// s² m.
    Mass(f64),
    /// k sᵅ, between a spring and a dashpot.
    Springpot { stiffness: f64, exponent: f64 },
    /// A mass on a spring: s² m (ω_a² + 2ζω_a s)/(s² + 2ζω_a s + ω_a²).
    Resonator { mass: f64, omega: f64, ratio: f64 },
}

impl PointLaw {
    #[inline(always)]
    pub(crate) fn at<T: Lines>(&self, s: T) -> T {
        match *self {
            PointLaw::Spring { stiffness, damping } => T::ONE * stiffness + s * damping,
            PointLaw::Mass(mass) => s * s * mass,
            PointLaw::Springpot { stiffness, exponent } => {
                let mut value = T::ZERO;
                for line in 0..T::COUNT {
                    value.set_line(line, stiffness * s.line(line).powf(exponent));
                }
                value
            }
            PointLaw::Resonator { mass, omega, ratio } => {
                let spring = T::ONE * (omega * omega) + s * (2.0 * ratio * omega);
                let squared = s * s;
                squared * mass * spring * (squared + spring).reciprocal()
            }
        }
    }
}
