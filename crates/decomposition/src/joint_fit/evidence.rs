//! The evidence of a law whose losses, change of stiffness and mass may be of any size.
//!
//! Loss factors of joints lie anywhere between 10⁻⁴ and some tenths. One prior width for all of them charges
//! a small one as if it had been expected to be large: a law with three more elements then loses to one
//! without them although the FRFs show these. So the width σ of each kind of elements is itself unknown, as
//! likely between 1 and 2 as between 10 and 20 within its limits, and the evidence is the mean over σ. A mass
//! is not negative: its prior is the half of a normal distribution, and what of the posterior lies below zero
//! does not count.
//!
//! About the optimum a of a fit under one prior P, −2 ln(likelihood × prior) is quadratic with the
//! information A. With another prior P + Δ its minimum lies at a + y, (A + Δ) y = r − Δa, and is lower by (r
//! − Δa)ᵀy − aᵀΔa, r being what pulls at a coordinate that stands at its bound.

use super::law::{Dynamics, Form};
use crate::settings::priors::{CHANGE_RANGE, LOSS_RANGE, MASS_RANGE, WIDTHS};
use jointscope_inference::{NormalEquations, Parameter, normal_above};
use jointscope_linalg::Cholesky;
use std::ops::Range;

/// Coordinates with one unknown width.
struct Block {
    coordinates: Range<usize>,
    sizes: [f64; 2],
}

/// What a fit's evidence is made of.
pub(super) struct Fit<'a> {
    pub objective: f64,
    pub at: &'a [f64],
    pub equations: &'a NormalEquations,
    pub parameters: &'a [Parameter],
}

impl Fit<'_> {
    /// Logarithm of the marginal likelihood of this law, whose coordinates begin at `first`, with the
    /// coordinate of a mass where there is one. `variances` are those of all priors, of what nothing is known
    /// of too. `None` where the FRFs leave it undetermined.
    pub(super) fn evidence(
        &self,
        (first, law): (usize, &Dynamics),
        mass: Option<usize>,
        variances: &[f64],
    ) -> Option<f64> {
        let damping = first + law.stiffness.count();
        let change = damping + law.damping.count();
        let block = |form: Form, from: usize, sizes: [f64; 2]| {
            let coordinates = from..from + form.count();
            (form != Form::Zero).then_some(Block { coordinates, sizes })
        };
        let of_mass = mass.map(|index| Block { coordinates: index..index + 1, sizes: MASS_RANGE });
        let blocks =
            [block(law.damping, damping, LOSS_RANGE), block(law.change, change, CHANGE_RANGE), of_mass];
        let blocks: Vec<Block> = blocks.into_iter().flatten().collect();
        let count = WIDTHS.pow(blocks.len() as u32);
        let mut all = Vec::with_capacity(count);
        for place in 0..count {
            let mut variances = variances.to_vec();
            let mut rest = place;
            for block in &blocks {
                let width = width(block.sizes, rest % WIDTHS);
                rest /= WIDTHS;
                block.coordinates.clone().for_each(|index| variances[index] = width * width);
            }
            all.push(self.under(&variances, mass)?);
        }
        let most = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = all.iter().map(|one| (one - most).exp()).sum();
        Some(most + (sum / count as f64).ln())
    }

    /// The same under priors of these variances.
    fn under(&self, variances: &[f64], mass: Option<usize>) -> Option<f64> {
        let n = self.equations.order;
        let mut information = self.equations.information.clone();
        let mut gradient = vec![0.0; n];
        let mut objective = self.objective;
        for (index, parameter) in self.parameters.iter().enumerate() {
            // What nothing is known of keeps its precision of zero.
            let precision = if parameter.precision > 0.0 { 1.0 / variances[index] } else { 0.0 };
            let change = precision - parameter.precision;
            information[index * n + index] += change;
            gradient[index] = -change * self.at[index];
            objective += change * self.at[index] * self.at[index];
        }
        if let Some(index) = mass.filter(|&index| self.at[index] <= 0.0) {
            // Elsewhere the gradient vanishes at an optimum.
            gradient[index] += self.equations.right[index].min(0.0);
        }
        let factor = Cholesky::of(n, &information)?;
        let mut step = gradient.clone();
        factor.solve_in_place(&mut step);
        objective -= gradient.iter().zip(&step).map(|(gradient, step)| gradient * step).sum::<f64>();
        let widths: f64 = variances.iter().map(|variance| variance.ln()).sum();
        let positive = mass.map_or(0.0, |index| {
            let mut unit = vec![0.0; n];
            unit[index] = 1.0;
            factor.solve_in_place(&mut unit);
            ln_twice_above_zero(self.at[index] + step[index], unit[index].sqrt())
        });
        Some(-0.5 * (objective + factor.ln_determinant() + widths) + positive)
    }
}

/// One of the widths of a block, evenly spaced in its logarithm.
fn width([least, largest]: [f64; 2], place: usize) -> f64 {
    least * (largest / least).powf(place as f64 / (WIDTHS - 1) as f64)
}

/// ln(2·P(x > 0)) of a normal x.
fn ln_twice_above_zero(mean: f64, std: f64) -> f64 {
    match -mean / std {
        // P(x > z) → e^(−z²/2)/(z√(2π)).
        z if z > 28.0 => -0.5 * z * z - (z * std::f64::consts::FRAC_PI_2.sqrt()).ln(),
        z => (2.0 * normal_above(z)).ln(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::LawKind;
    use super::*;
    use jointscope_inference::Transform;
    use jointscope_linalg::RealMatrix2;

    fn parameter(std: f64) -> Parameter {
        Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 }).with_precision(1.0 / (std * std))
    }

    /// A scalar viscous joint whose k and c are read off with deviations of 0.01 and `noise`, fitted under a
    /// prior of 0.1 for c; and perhaps a mass.
    fn evidence(datum: f64, noise: f64, mass: Option<f64>) -> f64 {
        let unit = RealMatrix2::new(1.0, 1.0, 1.0, 1.0);
        let law = Dynamics::new(LawKind::Viscous, unit, 100.0, true);
        let stds = [2.0, 0.1, 1.0];
        let data = [(0.9, 0.01), (datum, noise), (mass.unwrap_or(0.0), 0.3)];
        let n = if mass.is_some() { 3 } else { 2 };
        let parameters: Vec<Parameter> = stds[..n].iter().map(|std| parameter(*std)).collect();
        let mut equations = NormalEquations::zero(n);
        let (mut at, mut objective) = (vec![0.0; n], 0.0);
        for (index, (y, sigma)) in data[..n].iter().enumerate() {
            let (data, prior) = (1.0 / (sigma * sigma), parameters[index].precision);
            at[index] = data * y / (data + prior);
            if index == 2 {
                at[index] = at[index].max(0.0);
            }
            objective += data * (y - at[index]).powi(2) + prior * at[index] * at[index];
            equations.information[index * n + index] = data + prior;
            equations.right[index] = data * (y - at[index]) - prior * at[index];
        }
        let fit = Fit { objective, at: &at, equations: &equations, parameters: &parameters };
        let variances: Vec<f64> = stds[..n].iter().map(|std| std * std).collect();
        fit.evidence((0, &law), mass.map(|_| 2), &variances).unwrap()
    }

    /// ln of the density of a datum of this noise whose mean is normal of this width, up to what does not
    /// depend on the width: 1/√2π and the noise's own 1/σ.
    fn of_width(y: f64, sigma: f64, width: f64) -> f64 {
        let variance = sigma * sigma + width * width;
        -0.5 * (y * y / variance + (variance / (sigma * sigma)).ln())
    }

    #[test]
    fn the_evidence_is_the_mean_over_the_sizes_that_losses_may_have() {
        for (datum, noise) in [(0.002, 0.0001), (0.05, 0.001), (0.0, 0.01), (-0.02, 0.03)] {
            let mean: f64 =
                (0..WIDTHS).map(|place| of_width(datum, noise, width(LOSS_RANGE, place)).exp()).sum::<f64>()
                    / WIDTHS as f64;
            let expected = mean.ln() + of_width(0.9, 0.01, 2.0);
            let found = evidence(datum, noise, None);
            assert!((found - expected).abs() < 1e-8, "{datum}: {found} for {expected}");
        }
    }

    #[test]
    fn a_mass_counts_as_far_as_it_is_positive_on_its_bound_too() {
        for datum in [2.0, 0.1, -0.4] {
            let by_width = |place: usize| {
                // ∫₀^∞ N(y; m, σ²) 2 N(m; 0, w²) dm, by small steps.
                let (w, sigma) = (width(MASS_RANGE, place), 0.3_f64);
                let steps = 200_000;
                let h = 8.0 * w / f64::from(steps);
                let sum: f64 = (0..steps)
                    .map(|i| {
                        let m = (f64::from(i) + 0.5) * h;
                        (-0.5 * ((datum - m) / sigma).powi(2) - 0.5 * (m / w).powi(2)).exp()
                    })
                    .sum();
                2.0 * sum * h / (w * (2.0 * std::f64::consts::PI).sqrt())
            };
            let mean = (0..WIDTHS).map(by_width).sum::<f64>() / WIDTHS as f64;
            let expected = evidence(0.01, 0.001, None) + mean.ln();
            let found = evidence(0.01, 0.001, Some(datum));
            assert!((found - expected).abs() < 1e-4, "{datum}: {found} for {expected}");
        }
    }
}
