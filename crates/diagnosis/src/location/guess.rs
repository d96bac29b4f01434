//! A first guess at a law's parameters from a site's free scalars, by generalised least squares.
//!
//! The scalars z were found with the tolerances at their best; a law that wants other tolerances may have
//! them, at the cost of the information that the recordings hold about them: minimised is Σ w |ẑ + S Δq −
//! z(law)|² + Δqᵀ N Δq, with a linear term where the tolerances had not quite converged. Residuals are taken
//! in z, which the noise enters linearly, never in δ, which near a resonance it does not. All of it is linear
//! in the tolerances: a guess, from which the law is fitted to the FRFs themselves.

use super::free_scalars::FreeScalars;
use super::laws::{Law, Line};
use super::pattern::Inversion;
use crate::settings::LawSettings;
use crate::settings::location::differences::PARAMETER_STEP;
use crate::settings::location::guess::CONVERGENCE;
use jointscope_inference::{DerivativePrecision, LeastSquares, NormalEquations, Settings, descend};
use num_complex::Complex64;

/// A site's scalars ready for laws.
pub(super) struct Measured<'a> {
    free_scalars: &'a FreeScalars,
    lines: Vec<Line>,
    /// N + Σ w SᵀS, the tolerances' part of every law's normal matrix.
    own: Vec<f64>,
    /// Information about the scalars, a share of their size counted as noise.
    weights: Vec<f64>,
    settings: &'a LawSettings,
}

/// Parameters of a law and the tolerances' departures (in units of the coordinates), with what they leave.
#[derive(Clone)]
pub(super) struct Guess {
    pub parameters: Vec<f64>,
    pub departures: Vec<f64>,
    pub left: f64,
}

impl<'a> Measured<'a> {
    pub(super) fn new(free_scalars: &'a FreeScalars, omegas: &[f64], settings: &'a LawSettings) -> Self {
        let n = free_scalars.order;
        let share = settings.relative_noise;
        // A weight is that of a real part here, of variance 1/weight.
        let inflated = |(weight, z): (&f64, &Complex64)| {
            if *weight > 0.0 { 1.0 / (1.0 / weight + share * share * z.norm_sqr()) } else { 0.0 }
        };
        let weights: Vec<f64> =
            free_scalars.weights.iter().zip(&free_scalars.state.scalars).map(inflated).collect();
        let mut own = free_scalars.information.clone();
        for (row, weight) in free_scalars.sensitivities.chunks_exact(n.max(1)).zip(&weights) {
            for a in 0..n {
                for b in 0..n {
                    own[a * n + b] += weight * (row[a].conj() * row[b]).re;
                }
            }
        }
        let inversions = &free_scalars.state.inversions;
        let lines =
            omegas.iter().zip(inversions).map(|(&omega, i)| Line { omega, driving: i.driving }).collect();
        Measured { free_scalars, lines, own, weights, settings }
    }

    /// The law at its best; `None` where no start leads anywhere.
    pub(super) fn guess(&self, law: &Law) -> Option<Guess> {
        let (low, high) = (self.lines.first()?.omega, self.lines.last()?.omega);
        let mut starts: Vec<(f64, Vec<f64>)> = (law.starts)(low, high)
            .into_iter()
            .filter_map(|start| {
                let start = if law.proportional { self.amplified(law, start)? } else { start };
                Some((self.left(law, &start, &[])?, start))
            })
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (most, _) = self.settings.guesses;
        let front = if starts.len() > 1 { most } else { 1 };
        let fits = starts.into_iter().take(front).filter_map(|(_, start)| self.improved(law, start));
        fits.min_by(|a, b| a.left.total_cmp(&b.left))
    }

    /// The start with its amplitude at the mean of the component over the law. Lines count by what is known
    /// of them, at best by a tenth of their size: a start should follow the trend, not the few lines that are
    /// known best.
    fn amplified(&self, law: &Law, start: Vec<f64>) -> Option<Vec<f64>> {
        let mut unit = start;
        unit[0] = 1.0;
        let (mut size, mut along) = (0.0, 0.0);
        for (line, inversion, z, weight) in self.scalars() {
            let component = inversion.delta(z);
            let slope = inversion.scalar_slope(component);
            let variance = 1.0 / (weight * slope.norm_sqr())
                + self.settings.relative_noise.powi(2) * component.norm_sqr();
            let value = (law.value)(line, &unit);
            if variance.is_finite() && variance > 0.0 && value.is_finite() {
                size += value.norm_sqr() / variance;
                along += (value.conj() * component).re / variance;
            }
        }
        unit[0] = along / size;
        (unit[0].is_finite() && unit[0] != 0.0).then_some(unit)
    }

    fn scalars(&self) -> impl Iterator<Item = (Line, &Inversion, Complex64, f64)> {
        let state = &self.free_scalars.state;
        self.lines
            .iter()
            .zip(&state.inversions)
            .zip(&state.scalars)
            .zip(&self.weights)
            .map(|(((line, inversion), z), weight)| (*line, inversion, *z, *weight))
            .filter(|(.., weight)| *weight > 0.0)
    }

    /// ẑ + S Δq − z(law) of line `index`.
    fn residual(&self, law: &Law, index: usize, parameters: &[f64], departures: &[f64]) -> Complex64 {
        let state = &self.free_scalars.state;
        let n = self.free_scalars.order;
        let moved: Complex64 =
            self.free_scalars.sensitivities[index * n..].iter().zip(departures).map(|(s, d)| s * d).sum();
        let modelled = state.inversions[index].scalar((law.value)(self.lines[index], parameters));
        state.scalars[index] + moved - modelled
    }

    fn left(&self, law: &Law, parameters: &[f64], departures: &[f64]) -> Option<f64> {
        let n = self.free_scalars.order;
        let mut left = 0.0;
        for (index, weight) in self.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            left += weight * self.residual(law, index, parameters, departures).norm_sqr();
        }
        for (a, x) in departures.iter().enumerate() {
            let row = &self.free_scalars.information[a * n..(a + 1) * n];
            left += x
                * (row.iter().zip(departures).map(|(m, y)| m * y).sum::<f64>()
                    - 2.0 * self.free_scalars.pull[a]);
        }
        left.is_finite().then_some(left)
    }

    /// dz/d(parameters) on line `index`.
    fn slopes(&self, law: &Law, index: usize, parameters: &[f64], slopes: &mut [Complex64]) {
        let line = self.lines[index];
        let factor = self.free_scalars.state.inversions[index].scalar_slope((law.value)(line, parameters));
        let mut moved = [0.0; 4];
        moved[..parameters.len()].copy_from_slice(parameters);
        for (p, slope) in slopes.iter_mut().enumerate() {
            let step = PARAMETER_STEP * parameters[p].abs().max(1e-9);
            moved[p] = parameters[p] + step;
            let up = (law.value)(line, &moved[..parameters.len()]);
            moved[p] = parameters[p] - step;
            let down = (law.value)(line, &moved[..parameters.len()]);
            moved[p] = parameters[p];
            *slope = factor * (up - down) / (2.0 * step);
        }
    }

    fn improved(&self, law: &Law, start: Vec<f64>) -> Option<Guess> {
        let departures = vec![0.0; self.free_scalars.order];
        let left = self.left(law, &start, &departures)?;
        let settings =
            Settings { steps: self.settings.guesses.1, convergence: CONVERGENCE, ..Settings::default() };
        let start = Guess { parameters: start, departures, left };
        descend(&Guessing { measured: self, law }, start, None, &settings).map(|end| end.point)
    }
}

/// A law guessed from a site's scalars, in coordinates (parameters, departures of the tolerances).
struct Guessing<'a> {
    measured: &'a Measured<'a>,
    law: &'a Law,
}

impl LeastSquares for Guessing<'_> {
    type Point = Guess;
    type Weights = ();
    type Derivatives = ();
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Guess) {}

    fn objective(&self, at: &Guess, _: &()) -> f64 {
        at.left
    }

    fn derivatives(&self, _: &Guess, _: DerivativePrecision) -> Option<()> {
        Some(())
    }

    fn equations(&self, at: &Guess, _: &(), _: &()) -> NormalEquations {
        let Measured { free_scalars, weights, own, .. } = self.measured;
        let (p, n) = (at.parameters.len(), free_scalars.order);
        let order = p + n;
        let mut equations = NormalEquations::zero(order);
        let mut derivatives = vec![Complex64::ZERO; p];
        for (index, weight) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            self.measured.slopes(self.law, index, &at.parameters, &mut derivatives);
            let residual = self.measured.residual(self.law, index, &at.parameters, &at.departures);
            let sensitivities = &free_scalars.sensitivities[index * n..(index + 1) * n];
            let NormalEquations { information, right, .. } = &mut equations;
            for a in 0..p {
                let weighted = derivatives[a].conj() * *weight;
                right[a] += (weighted * residual).re;
                for b in 0..p {
                    information[a * order + b] += (weighted * derivatives[b]).re;
                }
                for (b, s) in sensitivities.iter().enumerate() {
                    information[(p + b) * order + a] -= (weighted * s).re;
                }
            }
            for (b, s) in sensitivities.iter().enumerate() {
                right[p + b] -= weight * (s.conj() * residual).re;
            }
        }
        for a in 0..n {
            equations.right[p + a] += free_scalars.pull[a];
            for b in 0..n {
                equations.information[(p + a) * order + p + b] = own[a * n + b];
                equations.right[p + a] -= free_scalars.information[a * n + b] * at.departures[b];
            }
            for b in 0..p {
                equations.information[b * order + p + a] = equations.information[(p + a) * order + b];
            }
        }
        equations
    }

    fn stepped(&self, at: &Guess, equations: &NormalEquations, damping: f64) -> Option<Guess> {
        let step = equations.step(damping)?;
        let (own, tolerances) = step.split_at(at.parameters.len());
        let add = |x: &[f64], dx: &[f64]| x.iter().zip(dx).map(|(x, d)| x + d).collect::<Vec<_>>();
        let (parameters, departures) = (add(&at.parameters, own), add(&at.departures, tolerances));
        let left = self.measured.left(self.law, &parameters, &departures)?;
        Some(Guess { parameters, departures, left })
    }
}
