//! A first guess at a law's parameters from a site's free scalars, by generalised least squares.
//!
//! The scalars z were found with the tolerances at their best; a law that wants other tolerances may have them, at the price of the
//! information that the recordings hold about them: minimised is Σ w |ẑ + S Δq − z(law)|² + Δqᵀ N Δq,
//! with a linear term where the tolerances had not quite converged. Residuals are taken in z, which the noise
//! enters linearly, never in δ, which near a resonance it does not. All of it is linear in the tolerances: a guess, from which the law is fitted
//! to the FRFs themselves.

use super::laws::{Law, Line};
use super::pattern::Inversion;
use super::yielded::Yielded;
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;

/// Starts fitted in full after a scan, and Gauss–Newton steps for each.
const FRONT: usize = 2;
const STEPS: usize = 12;
/// Share of a component's size that its course is known to at best, for a start.
const SOFT: f64 = 0.1;
/// Relative step of the parameters' differences.
const DIFFERENCE: f64 = 1e-5;

/// A site's scalars ready for laws.
pub(super) struct Measured<'a> {
    yielded: &'a Yielded,
    lines: Vec<Line>,
    /// N + Σ w SᵀS, the tolerances' part of every law's normal matrix.
    own: Vec<f64>,
    /// Information about the scalars, a share of their size counted as noise.
    weights: Vec<f64>,
}

/// Parameters of a law and the tolerances' departures (in units of the coordinates), with what they leave.
#[derive(Clone)]
pub(super) struct Guess {
    pub parameters: Vec<f64>,
    pub departures: Vec<f64>,
    pub left: f64,
}

impl<'a> Measured<'a> {
    pub fn new(yielded: &'a Yielded, omegas: &[f64], softness: f64) -> Self {
        let n = yielded.order;
        let softened = |(weight, z): (&f64, &Complex64)| {
            if *weight > 0.0 { 1.0 / (1.0 / weight + softness * softness * z.norm_sqr()) } else { 0.0 }
        };
        let weights: Vec<f64> = yielded.weights.iter().zip(&yielded.state.scalars).map(softened).collect();
        let mut own = yielded.information.clone();
        for (row, weight) in yielded.sensitivities.chunks_exact(n.max(1)).zip(&weights) {
            for a in 0..n {
                for b in 0..n {
                    own[a * n + b] += weight * (row[a].conj() * row[b]).re;
                }
            }
        }
        let inversions = &yielded.state.inversions;
        let lines =
            omegas.iter().zip(inversions).map(|(&omega, i)| Line { omega, driving: i.driving }).collect();
        Measured { yielded, lines, own, weights }
    }

    /// The law at its best; `None` where no start leads anywhere.
    pub fn guess(&self, law: &Law) -> Option<Guess> {
        let (low, high) = (self.lines.first()?.omega, self.lines.last()?.omega);
        let mut starts: Vec<(f64, Vec<f64>)> = (law.starts)(low, high)
            .into_iter()
            .filter_map(|start| {
                let start = if law.proportional { self.amplified(law, start)? } else { start };
                Some((self.left(law, &start, &[])?, start))
            })
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let front = if starts.len() > 1 { FRONT } else { 1 };
        let fits = starts.into_iter().take(front).filter_map(|(_, start)| self.improved(law, start));
        fits.min_by(|a, b| a.left.total_cmp(&b.left))
    }

    /// The start with its amplitude at the mean of the component over the law. Lines count by what is known of them, at best by a tenth of
    /// their size: a start should follow the course, not the few lines that are known best.
    fn amplified(&self, law: &Law, start: Vec<f64>) -> Option<Vec<f64>> {
        let mut unit = start;
        unit[0] = 1.0;
        let (mut size, mut along) = (0.0, 0.0);
        for (line, inversion, z, weight) in self.scalars() {
            let component = inversion.delta(z);
            let slope = inversion.scalar_slope(component);
            let variance = 1.0 / (weight * slope.norm_sqr()) + SOFT * SOFT * component.norm_sqr();
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
        let state = &self.yielded.state;
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
        let state = &self.yielded.state;
        let n = self.yielded.order;
        let moved: Complex64 =
            self.yielded.sensitivities[index * n..].iter().zip(departures).map(|(s, d)| s * d).sum();
        let modelled = state.inversions[index].scalar((law.value)(self.lines[index], parameters));
        state.scalars[index] + moved - modelled
    }

    fn left(&self, law: &Law, parameters: &[f64], departures: &[f64]) -> Option<f64> {
        let n = self.yielded.order;
        let mut left = 0.0;
        for (index, weight) in self.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            left += weight * self.residual(law, index, parameters, departures).norm_sqr();
        }
        for (a, x) in departures.iter().enumerate() {
            let row = &self.yielded.information[a * n..(a + 1) * n];
            left += x
                * (row.iter().zip(departures).map(|(m, y)| m * y).sum::<f64>() - 2.0 * self.yielded.pull[a]);
        }
        left.is_finite().then_some(left)
    }

    /// dz/d(parameters) on line `index`.
    fn slopes(&self, law: &Law, index: usize, parameters: &[f64], slopes: &mut [Complex64]) {
        let line = self.lines[index];
        let factor = self.yielded.state.inversions[index].scalar_slope((law.value)(line, parameters));
        let mut moved = [0.0; 4];
        moved[..parameters.len()].copy_from_slice(parameters);
        for (p, slope) in slopes.iter_mut().enumerate() {
            let step = DIFFERENCE * parameters[p].abs().max(1e-9);
            moved[p] = parameters[p] + step;
            let up = (law.value)(line, &moved[..parameters.len()]);
            moved[p] = parameters[p] - step;
            let down = (law.value)(line, &moved[..parameters.len()]);
            moved[p] = parameters[p];
            *slope = factor * (up - down) / (2.0 * step);
        }
    }

    /// Normal matrix of (parameters, departures), whole, and right side.
    fn normal(&self, law: &Law, at: &Guess) -> (Vec<f64>, Vec<f64>) {
        let (p, n) = (at.parameters.len(), self.yielded.order);
        let order = p + n;
        let mut matrix = vec![0.0; order * order];
        let mut right = vec![0.0; order];
        let mut slopes = vec![Complex64::ZERO; p];
        for (index, weight) in self.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            self.slopes(law, index, &at.parameters, &mut slopes);
            let residual = self.residual(law, index, &at.parameters, &at.departures);
            let sensitivities = &self.yielded.sensitivities[index * n..(index + 1) * n];
            for a in 0..p {
                let weighted = slopes[a].conj() * *weight;
                right[a] += (weighted * residual).re;
                for b in 0..=a {
                    matrix[a * order + b] += (weighted * slopes[b]).re;
                }
                for (b, s) in sensitivities.iter().enumerate() {
                    matrix[(p + b) * order + a] -= (weighted * s).re;
                }
            }
            for (b, s) in sensitivities.iter().enumerate() {
                right[p + b] -= weight * (s.conj() * residual).re;
            }
        }
        for a in 0..n {
            right[p + a] += self.yielded.pull[a];
            for b in 0..n {
                matrix[(p + a) * order + p + b] = self.own[a * n + b];
                right[p + a] -= self.yielded.information[a * n + b] * at.departures[b];
            }
        }
        for a in 0..order {
            for b in a + 1..order {
                matrix[a * order + b] = matrix[b * order + a];
            }
        }
        (matrix, right)
    }

    fn improved(&self, law: &Law, start: Vec<f64>) -> Option<Guess> {
        let departures = vec![0.0; self.yielded.order];
        let left = self.left(law, &start, &departures)?;
        let mut at = Guess { parameters: start, departures, left };
        let mut damping = 1e-6;
        for _ in 0..STEPS {
            let (matrix, right) = self.normal(law, &at);
            let order = right.len();
            let mut next = None;
            while next.is_none() && damping < 1e8 {
                let (mut damped, mut step) = (matrix.clone(), right.clone());
                (0..order).for_each(|a| damped[a * order + a] *= 1.0 + damping);
                if solve_positive_definite(&mut damped, &mut step) {
                    let (own, tolerances) = step.split_at(at.parameters.len());
                    let add =
                        |x: &[f64], dx: &[f64]| x.iter().zip(dx).map(|(x, d)| x + d).collect::<Vec<_>>();
                    let (parameters, departures) =
                        (add(&at.parameters, own), add(&at.departures, tolerances));
                    let left = self.left(law, &parameters, &departures);
                    next = left.filter(|left| *left < at.left).map(|left| Guess {
                        parameters,
                        departures,
                        left,
                    });
                }
                damping *= if next.is_some() { 0.1 } else { 10.0 };
            }
            let Some(next) = next else { break };
            let gain = at.left - next.left;
            at = next;
            if gain < 1e-4 {
                break;
            }
        }
        Some(at)
    }
}
