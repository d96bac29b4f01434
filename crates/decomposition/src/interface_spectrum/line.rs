//! What one line tells of an interface: a complex compliance, and one over it where noise allows.

use crate::settings::interfaces::{BEYOND_NOISE, NEIGHBOURS, STATED_SHARE};
use num_complex::Complex64;

/// A complex compliance on one spectral line, m/N or rad/(N·m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineCompliance {
    /// The compliance.
    pub value: Complex64,
    /// Standard deviation of its real and of its imaginary part by noise, which are independent; `None` where
    /// the FRFs carry no variances.
    pub std: Option<f64>,
    /// What the fixture's tolerances and the joint's mass leave uncertain.
    pub tolerance: Spread,
}

/// Variances and covariance of the real and the imaginary part of a complex number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    real: f64,
    imaginary: f64,
    both: f64,
}

/// A spring with a dashpot beside it: one over a compliance, K + sC.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSpring {
    /// K = Re(1/D), under an exponential window less δC: N/m or N·m/rad.
    pub stiffness: f64,
    /// C = Im(1/D)/ω: N·s/m or N·m·s/rad.
    pub damping: f64,
    /// Standard deviations of K and C by noise, to first order; `None` where the FRFs carry no variances.
    pub std: Option<(f64, f64)>,
    /// Standard deviations of K and C by the fixture's tolerances and the joint's mass, to first order.
    pub std_fixture: (f64, f64),
}

impl LineCompliance {
    /// Standard deviations of the real and the imaginary part by tolerances.
    pub fn std_fixture(&self) -> [f64; 2] {
        [self.tolerance.real.sqrt(), self.tolerance.imaginary.sqrt()]
    }

    /// Standard deviations of the real and the imaginary part by noise and tolerances together; `None` where
    /// neither is known.
    pub fn std_of_both(&self) -> Option<[f64; 2]> {
        let known = self.std.is_some() || self.tolerance != Spread::default();
        known.then(|| self.std_fixture().map(|std| std.hypot(self.std.unwrap_or(0.0))))
    }

    /// The larger of the two.
    fn largest_std(&self) -> Option<f64> {
        self.std_of_both().map(|[real, imaginary]| real.max(imaginary))
    }
}

impl LineSpring {
    /// Standard deviations of K and C by noise and tolerances together; `None` where neither is known.
    pub fn std_of_both(&self) -> Option<(f64, f64)> {
        let (noise, fixture) = (self.std.unwrap_or_default(), self.std_fixture);
        (self.std.is_some() || fixture != (0.0, 0.0))
            .then(|| (noise.0.hypot(fixture.0), noise.1.hypot(fixture.1)))
    }
}

impl Spread {
    /// With one more error, independent of those before.
    pub(super) fn with(self, error: Complex64) -> Self {
        Spread {
            real: self.real + error.re * error.re,
            imaginary: self.imaginary + error.im * error.im,
            both: self.both + error.re * error.im,
        }
    }

    /// Of the number times a factor.
    fn times(self, by: Complex64) -> Self {
        let (a, b) = (by.re, by.im);
        Spread {
            real: a * a * self.real - 2.0 * a * b * self.both + b * b * self.imaginary,
            imaginary: b * b * self.real + 2.0 * a * b * self.both + a * a * self.imaginary,
            both: a * b * (self.real - self.imaginary) + (a * a - b * b) * self.both,
        }
    }
}

/// Magnitude of the real part that the lines beside this one show, a mean weighted with one over the
/// variance; the line's own without neighbours or variances.
fn size_nearby(compliances: &[LineCompliance], at: usize) -> f64 {
    let near = at.saturating_sub(NEIGHBOURS)..compliances.len().min(at + NEIGHBOURS + 1);
    let (mut sum, mut weights) = (0.0, 0.0);
    for beside in near.filter(|&beside| beside != at) {
        if let Some(std) = compliances[beside].largest_std() {
            let weight = std.powi(-2);
            if weight.is_finite() {
                sum += compliances[beside].value.re * weight;
                weights += weight;
            }
        }
    }
    if weights > 0.0 { (sum / weights).abs() } else { compliances[at].value.re.abs() }
}

/// K and C of a dynamic stiffness K + sC.
pub(crate) fn stiffness_and_damping(dynamic: Complex64, s: Complex64) -> (f64, f64) {
    let damping = dynamic.im / s.im;
    (dynamic.re - s.re * damping, damping)
}

/// One over a compliance at s; `None` where its real part cannot be told from zero well enough for the
/// first-order deviations to hold.
///
/// Its noise is held against what the lines beside it show. Held against its own value, those lines would be
/// stated on which noise happens to make it large, and their intervals would miss. The real part alone
/// counts: losses of the beam by themselves make an imaginary one, and no spring.
pub(super) fn spring(compliances: &[LineCompliance], at: usize, s: Complex64) -> Option<LineSpring> {
    let compliance = compliances[at];
    let size = compliance.value.norm();
    let within = |std: f64| {
        std > STATED_SHARE * size_nearby(compliances, at) || BEYOND_NOISE * std > compliance.value.re.abs()
    };
    if size == 0.0 || compliance.largest_std().is_some_and(within) {
        return None;
    }
    let dynamic = compliance.value.inv();
    let (stiffness, damping) = stiffness_and_damping(dynamic, s);
    // δ(1/D) = −δD/D²; of noise, which is circular, only the magnitude counts.
    let part = compliance.std.map(|std| std / (size * size));
    let tolerance = compliance.tolerance.times(-dynamic * dynamic);
    let windowed = s.re / s.im;
    let of_stiffness =
        tolerance.real - 2.0 * windowed * tolerance.both + windowed * windowed * tolerance.imaginary;
    Some(LineSpring {
        stiffness,
        damping,
        std: part.map(|std| (std * windowed.hypot(1.0), std / s.im)),
        std_fixture: (of_stiffness.max(0.0).sqrt(), tolerance.imaginary.max(0.0).sqrt() / s.im),
    })
}
