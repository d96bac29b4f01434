//! D on one line as the FRFs give it, with its noise.

use super::line::{LineCompliance, Spread};
use crate::JointSpectrum;
use crate::inertia::inertia_of_ends;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
use num_complex::Complex64;

/// Real weights of D11, D12, D21, D22.
type Weights = [f64; 4];

/// D12 − D21, which is zero.
const ASYMMETRY: Weights = [0.0, 1.0, -1.0, 0.0];

/// t, r₂ and r₃ over a joint of this length, m.
fn weights_of_interfaces(length: f64) -> [Weights; 3] {
    let (arm, turn) = (0.5 * length, 0.5 / length);
    [[1.0, -arm, -arm, 0.0], [0.0, turn, turn, 0.0], [0.0, -turn, -turn, 1.0]]
}

fn combined(left: ComplexMatrix2, weights: Weights) -> Complex64 {
    (0..4).map(|e| left.at(e / 2, e % 2) * weights[e]).sum()
}

/// t, r₂ and r₃ behind a D without noise, over a joint of this length, m.
pub(crate) fn interfaces_behind(left: ComplexMatrix2, length: f64) -> [Complex64; 3] {
    weights_of_interfaces(length).map(|weights| combined(left, weights))
}

/// D on a line; `None` where it is not finite.
pub(super) fn left_over_on(
    spectrum: &JointSpectrum,
    line: usize,
    beam: RealMatrix2,
    mass: f64,
) -> Option<LeftOver> {
    let held = held_by_joint(spectrum, line, mass)?;
    let value = held.compliance - beam.to_complex();
    let covariance = spectrum.h41.covariance.as_ref();
    let noise = covariance.map(|covariance| Noise { by: held, covariance: covariance[line] });
    value.is_finite().then_some(LeftOver { value, noise })
}

/// E[δf δḡ] of two combinations of H41's elements.
fn covariance_of(f: [Complex64; 4], g: [Complex64; 4], covariance: &[[f64; 4]; 4]) -> Complex64 {
    let mut sum = Complex64::ZERO;
    for m in 0..4 {
        for n in 0..4 {
            sum += f[m] * g[n].conj() * covariance[m][n];
        }
    }
    sum
}

/// A joint's compliance on one line, and how an error of H41 reaches it: δ(k⁻¹) = `left` δH `right`.
struct Held {
    compliance: ComplexMatrix2,
    left: ComplexMatrix2,
    right: ComplexMatrix2,
    /// δ ln det X = −tr(`determinant` δH) of the X whose inverse the compliance is made of.
    determinant: ComplexMatrix2,
}

/// The compliance k⁻¹ of a joint that has a `mass` (kg, uniform over its length) besides; `None` where a
/// matrix is singular.
///
/// The mass adds s²M to the ends, so that their receptances without the joint's stiffness are G = (diag(α22,
/// β33)⁻¹ + s²M)⁻¹. With T = [−R, I] and X = (k⁻¹ + T G Tᵀ)⁻¹ the motion at the ends is G − G Tᵀ X T G times
/// the loads there, and β33 β43⁻¹ H41 α21⁻¹ α22 = G₃₂ − (G Tᵀ)₃ X (T G)₂, which is solved for X. Without a
/// mass it is the exact relation.
fn held_by_joint(spectrum: &JointSpectrum, line: usize, mass: f64) -> Option<Held> {
    let sides = &spectrum.sides;
    let (alpha22, beta33) = (sides.alpha22[line], sides.beta33[line]);
    let s = Complex64::new(spectrum.decay, spectrum.h41.lines.omega(line));
    let inertia = inertia_of_ends(mass, sides.length, s);
    // The inverse by blocks, the far end eliminated first.
    let far = (beta33.inverse()? + inertia[1][1]).inverse()?;
    let g22 = (alpha22.inverse()? + inertia[0][0] - inertia[0][1] * far * inertia[1][0]).inverse()?;
    let g32 = ComplexMatrix2::zero() - far * inertia[1][0] * g22;
    let g23 = ComplexMatrix2::zero() - g22 * inertia[0][1] * far;
    let g33 = far - g32 * inertia[0][1] * far;
    let across = spectrum.relation.transport(sides.length);
    let back = across.transpose();
    let (to_far, to_near) = (g33 - g32 * back, g32 - across * g22);
    let both = across * g22 * back - across * g23 - g32 * back + g33;
    let p = to_far.inverse()? * beta33 * sides.beta43[line].inverse()?;
    let q = sides.alpha21[line].inverse()? * alpha22 * to_near.inverse()?;
    let direct = to_far.inverse()? * g32 * to_near.inverse()?;
    let inverse = (direct - p * spectrum.h41.values[line] * q).inverse()?;
    Some(Held {
        compliance: inverse - both,
        left: inverse * p,
        right: q * inverse,
        determinant: q * inverse * p,
    })
}

/// The noise of H41 on one line, and how it reaches D.
pub(super) struct Noise {
    by: Held,
    /// E[δh δh̄ᵀ] of the elements (11, 12, 21, 22), real.
    covariance: [[f64; 4]; 4],
}

impl Noise {
    /// Standard deviation of ln det X: the share of the determinant that is noise, whatever the units.
    pub(super) fn share_of_determinant(&self) -> f64 {
        // The element (a, b) of H weighs as (b, a) of the matrix in the trace.
        let weights: [Complex64; 4] = std::array::from_fn(|e| self.by.determinant.at(e % 2, e / 2));
        covariance_of(weights, weights, &self.covariance).re.max(0.0).sqrt()
    }

    /// What a combination of D's elements weighs those of H41 by.
    fn weights(&self, of: Weights) -> [Complex64; 4] {
        std::array::from_fn(|element| {
            let (a, b) = (element / 2, element % 2);
            let by = |i: usize, j: usize| self.by.left.at(i, a) * self.by.right.at(b, j) * of[2 * i + j];
            by(0, 0) + by(0, 1) + by(1, 0) + by(1, 1)
        })
    }

    /// E[δf δḡ] of two combinations of D's elements.
    fn covariance(&self, f: Weights, g: Weights) -> Complex64 {
        covariance_of(self.weights(f), self.weights(g), &self.covariance)
    }
}

/// D on one line as the FRFs give it, with its noise.
pub(super) struct LeftOver {
    value: ComplexMatrix2,
    pub(super) noise: Option<Noise>,
}

impl LeftOver {
    /// A combination of D's elements by least squares under D12 = D21, weighted with the covariance of the
    /// noise: f − cov(f, e)/var(e)·e with e = D12 − D21. Its variance is smaller by |cov(f, e)|²/var(e).
    pub(super) fn reciprocal(&self, weights: Weights) -> LineCompliance {
        let (value, tolerance) = (combined(self.value, weights), Spread::default());
        let Some(noise) = &self.noise else { return LineCompliance { value, std: None, tolerance } };
        let own = noise.covariance(weights, weights).re;
        let surplus = noise.covariance(ASYMMETRY, ASYMMETRY).re;
        if surplus <= 0.0 {
            return LineCompliance { value, std: Some((0.5 * own.max(0.0)).sqrt()), tolerance };
        }
        let shared = noise.covariance(weights, ASYMMETRY);
        let variance = own - shared.norm_sqr() / surplus;
        LineCompliance {
            value: value - shared / surplus * combined(self.value, ASYMMETRY),
            std: Some((0.5 * variance.max(0.0)).sqrt()),
            tolerance,
        }
    }

    /// t, r₂ and r₃ over a joint of this length, m.
    pub(super) fn interfaces(&self, length: f64) -> [LineCompliance; 3] {
        weights_of_interfaces(length).map(|weights| self.reciprocal(weights))
    }

    pub(super) fn asymmetry(&self) -> Option<f64> {
        let variance = self.noise.as_ref()?.covariance(ASYMMETRY, ASYMMETRY).re;
        let left = combined(self.value, ASYMMETRY).norm_sqr();
        (variance > 0.0).then(|| 2.0 * left / variance)
    }
}
