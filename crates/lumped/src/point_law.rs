//! What one thing adds to the dynamic stiffness where it acts.

use crate::lanes::Lines;

/// The dynamic stiffness that one thing adds through one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PointLaw {
    /// k + s c.
    Spring {
        /// k, N/m or N·m/rad.
        stiffness: f64,
        /// c, N·s/m or N·m·s/rad.
        damping: f64,
    },
    /// s² m.
    Mass(f64),
    /// k sᵅ, between a spring and a dashpot.
    Springpot {
        /// k.
        stiffness: f64,
        /// α.
        exponent: f64,
    },
    /// A mass on a spring: s² m (ω_a² + 2ζω_a s)/(s² + 2ζω_a s + ω_a²).
    Resonator {
        /// m, kg.
        mass: f64,
        /// ω_a, rad/s.
        omega: f64,
        /// ζ.
        ratio: f64,
    },
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

/// sτ/(1 + sτ): what relaxes in a time τ holds nothing of a slow motion and all of a fast one.
#[inline(always)]
pub(crate) fn relaxed<T: Lines>(s: T, time: f64) -> T {
    let turned = s * time;
    turned * (T::ONE + turned).reciprocal()
}
