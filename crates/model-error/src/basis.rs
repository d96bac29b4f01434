//! What one mode and the residual terms contribute to an accelerance.

use num_complex::Complex64;

/// Natural frequency (rad/s) and damping ratio of a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pole {
    /// Natural frequency |λ|, rad/s.
    pub omega: f64,
    /// Damping ratio −Re λ/|λ|.
    pub damping_ratio: f64,
}

impl Pole {
    /// The mode of the pole λ in the upper half of the plane.
    pub fn of(lambda: Complex64) -> Self {
        let omega = lambda.norm();
        Pole { omega, damping_ratio: -lambda.re / omega }
    }

    /// λ = ω(−ζ + i√(1 − ζ²)).
    pub fn lambda(&self) -> Complex64 {
        let Pole { omega, damping_ratio } = *self;
        Complex64::new(-damping_ratio * omega, omega * (1.0 - damping_ratio * damping_ratio).max(0.0).sqrt())
    }

    /// s²/(s² + 2ζωs + ω²) at s = iω: the accelerance of a mode of modal mass one.
    pub fn accelerance(&self, s: Complex64) -> Complex64 {
        s * s / self.denominator(s)
    }

    /// The derivative of [`Pole::accelerance`] by ln ω.
    pub(crate) fn by_frequency(&self, s: Complex64) -> Complex64 {
        let Pole { omega, damping_ratio } = *self;
        let denominator = self.denominator(s);
        -(s * 2.0 * damping_ratio * omega + 2.0 * omega * omega) * s * s / (denominator * denominator)
    }

    /// The derivative of [`Pole::accelerance`] by ln ζ.
    pub(crate) fn by_damping(&self, s: Complex64) -> Complex64 {
        let denominator = self.denominator(s);
        -(s * 2.0 * self.damping_ratio * self.omega) * s * s / (denominator * denominator)
    }

    fn denominator(&self, s: Complex64) -> Complex64 {
        s * s + s * (2.0 * self.damping_ratio * self.omega) + self.omega * self.omega
    }
}

/// Residual terms of an accelerance, by the power of frequency: the mass line (0), the upper residual (2),
/// what modes below (−2) and far above (4) the band and phase errors (1) add; then those that modes close to
/// the ends of the band need.
const POWERS: [i32; 8] = [0, 2, -2, 1, 4, 6, -4, 8];
/// Residual terms to begin with, and at the most.
pub(crate) const TERMS: (usize, usize) = (5, POWERS.len());
/// Place of the mass line and of the upper residual among them.
pub(crate) const MASS_LINE: usize = 0;
pub(crate) const UPPER: usize = 1;

/// The power of frequency of a residual term.
pub(crate) fn power_of_term(term: usize) -> i32 {
    POWERS[term]
}

/// The values of all modes' accelerances and of the first `terms` residual terms at a line, those in powers
/// of ω/`reference`.
pub(crate) fn row(
    poles: &[Pole],
    terms: usize,
    omega: f64,
    reference: f64,
) -> impl Iterator<Item = Complex64> + '_ {
    let s = Complex64::new(0.0, omega);
    let powers = POWERS[..terms].iter().map(move |&power| Complex64::from((omega / reference).powi(power)));
    poles.iter().map(move |pole| pole.accelerance(s)).chain(powers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn derivatives_of_an_accelerance_are_those_of_differences(
            omega in 10.0..1e4f64, damping_ratio in 1e-3..0.5f64, relative in 0.2..5.0f64,
        ) {
            let pole = Pole { omega, damping_ratio };
            let s = Complex64::new(0.0, relative * omega);
            let step = 1e-5f64;
            let at = |by_frequency: f64, by_damping: f64| {
                Pole { omega: omega * by_frequency.exp(), damping_ratio: damping_ratio * by_damping.exp() }.accelerance(s)
            };
            let largest = pole.accelerance(s).norm_sqr().max(1.0) / damping_ratio;
            let by_frequency = (at(step, 0.0) - at(-step, 0.0)) / (2.0 * step);
            prop_assert!((pole.by_frequency(s) - by_frequency).norm() < 1e-5 * largest, "by ln ω: {} of {by_frequency}", pole.by_frequency(s));
            let by_damping = (at(0.0, step) - at(0.0, -step)) / (2.0 * step);
            prop_assert!((pole.by_damping(s) - by_damping).norm() < 1e-5 * largest, "by ln ζ: {} of {by_damping}", pole.by_damping(s));
        }
    }

    #[test]
    fn a_mode_is_a_spring_far_below_its_frequency_and_a_mass_far_above() {
        let pole = Pole { omega: 100.0, damping_ratio: 0.01 };
        let below = pole.accelerance(Complex64::new(0.0, 1.0));
        let above = pole.accelerance(Complex64::new(0.0, 1e4));
        assert!((below + 1e-4).norm() < 1e-7, "−ω²/ω_r² expected, found {below}");
        assert!((above - 1.0).norm() < 1e-3, "1 expected, found {above}");
    }
}
