//! FRFs in the neighbourhood of a line: a rational function with one pole, which follows even a sharp peak
//! between few lines.
//!
//! Over a few lines an FRF is one mode and a smooth rest, H ≈ (b₀ + b₁x + b₂x²)/(1 + a x) with x the distance
//! from the line. What the FRF departs from that by is noise; its derivative and its pole are those of the
//! structure.

use jointscope_linalg::LuWorkspace;
use num_complex::Complex64;
use std::ops::Add;

/// Unknowns of the function.
const UNKNOWNS: usize = 4;
/// Passes with weights from the pass before.
const PASSES: usize = 3;

/// The function about one line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalRational {
    numerator: [Complex64; 3],
    pole: Complex64,
    /// Departure of the line itself from the function.
    pub residual: Complex64,
    /// What share of the line's own noise the function follows.
    pub leverage: f64,
    /// Variance E|ε|² of a value, from all lines used.
    pub variance: f64,
    /// Variance of `pole` for a noise of that variance.
    pole_variance: f64,
}

/// What the lines beside a line say of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Expected {
    pub value: Complex64,
    /// Variance of that value for noise of variance 1.
    pub leverage: f64,
    /// Variance E|ε|² of the lines beside it about the function.
    pub variance: f64,
}

/// b₀, b₁, b₂ and a of values over their `level`, at distances in a `unit` of Hz.
struct Scaled {
    unit: f64,
    level: f64,
    solution: [Complex64; UNKNOWNS],
}

/// Fits one line after another without allocation.
#[derive(Debug, Clone, Default)]
pub(crate) struct LocalRationalFit {
    lu: LuWorkspace,
    columns: Vec<Complex64>,
}

impl LocalRationalFit {
    pub(crate) fn new() -> Self {
        LocalRationalFit { lu: LuWorkspace::new(), columns: Vec::new() }
    }

    /// The function about `line` from the lines within `half` of it (moved inwards at the ends); the distance
    /// x is 1 at `half` lines. `None` where there are too few lines, or they do not determine it.
    pub(crate) fn about(
        &mut self,
        hz: &[f64],
        values: &[Complex64],
        line: usize,
        half: usize,
    ) -> Option<LocalRational> {
        let n = values.len();
        if n < 2 * half + 1 || 2 * half < UNKNOWNS {
            return None;
        }
        let from = line.saturating_sub(half).min(n - 2 * half - 1);
        let used = from..from + 2 * half + 1;
        let Scaled { unit, level, solution: [b0, b1, b2, pole] } =
            self.scaled(hz, values, (line, half), used.clone())?;
        // Two columns of the inverse: of the value at the line itself, and of the pole.
        self.columns.clear();
        self.columns.resize(2 * UNKNOWNS, Complex64::ZERO);
        self.columns[0] = Complex64::ONE;
        self.columns[2 * UNKNOWNS - 1] = Complex64::ONE;
        self.lu.solve_columns_in_place(transposed(&mut self.columns), 2);
        let found = LocalRational {
            numerator: [b0 * level, b1 * level / unit, b2 * level / (unit * unit)],
            pole: pole / unit,
            residual: Complex64::ZERO,
            leverage: self.columns[0].re.clamp(0.0, 1.0),
            variance: 0.0,
            pole_variance: 0.0,
        };
        let misfit = used.map(|i| (values[i] - found.at(hz[i] - hz[line])).norm_sqr()).fold(0.0, Add::add);
        let variance = misfit / (2 * half + 1 - UNKNOWNS) as f64;
        let pole_variance =
            self.columns[2 * UNKNOWNS - 1].re.max(0.0) * variance / (level * level * unit * unit);
        let residual = values[line] - found.at(0.0);
        (variance.is_finite() && residual.is_finite()).then_some(LocalRational {
            residual,
            variance,
            pole_variance,
            ..found
        })
    }
}

impl LocalRationalFit {
    /// The value of `line` as `half` lines on either side of it have it, without itself. `None` nearer to the
    /// ends than that, or where they do not determine it.
    pub(crate) fn beside(
        &mut self,
        hz: &[f64],
        values: &[Complex64],
        line: usize,
        half: usize,
    ) -> Option<Expected> {
        if line < half || line + half >= values.len() || 2 * half <= UNKNOWNS {
            return None;
        }
        let used = (line - half..line).chain(line + 1..line + half + 1);
        let Scaled { unit, level, solution: [b0, b1, b2, pole] } =
            self.scaled(hz, values, (line, half), used.clone())?;
        self.columns.clear();
        self.columns.resize(UNKNOWNS, Complex64::ZERO);
        self.columns[0] = Complex64::ONE;
        self.lu.solve_columns_in_place(&mut self.columns, 1);
        let at = |x: f64| level * (b0 + (b1 + b2 * x) * x) / (1.0 + pole * x);
        let misfit: f64 = used.map(|i| (values[i] - at((hz[i] - hz[line]) / unit)).norm_sqr()).sum();
        let variance = misfit / (2 * half - UNKNOWNS) as f64;
        let (value, leverage) = (at(0.0), self.columns[0].re.max(0.0));
        (value.is_finite() && variance.is_finite()).then_some(Expected { value, leverage, variance })
    }

    /// The function about `line` from the lines `used`, within `half` of it; `None` where they hold nothing.
    fn scaled(
        &mut self,
        hz: &[f64],
        values: &[Complex64],
        (line, half): (usize, usize),
        used: impl Iterator<Item = usize> + Clone,
    ) -> Option<Scaled> {
        let unit = unit(hz, line, half)?;
        let level = used.clone().map(|i| values[i].norm_sqr()).fold(0.0, f64::max).sqrt();
        if level <= 0.0 || !level.is_finite() {
            return None;
        }
        let solution = self.solved(used.map(|i| ((hz[i] - hz[line]) / unit, values[i] / level)))?;
        Some(Scaled { unit, level, solution })
    }

    /// b₀, b₁, b₂ and a from values at their distances, weighted by the denominator of the pass before;
    /// leaves the last matrix factorised.
    fn solved(
        &mut self,
        values: impl Iterator<Item = (f64, Complex64)> + Clone,
    ) -> Option<[Complex64; UNKNOWNS]> {
        let mut solution = [Complex64::ZERO; UNKNOWNS];
        for pass in 0..PASSES {
            let mut matrix = [Complex64::ZERO; UNKNOWNS * UNKNOWNS];
            let mut right = [Complex64::ZERO; UNKNOWNS];
            for (x, value) in values.clone() {
                let row = [Complex64::ONE, x.into(), (x * x).into(), -value * x];
                let denominator = 1.0 + solution[3] * x;
                let weight = if pass == 0 { 1.0 } else { 1.0 / denominator.norm_sqr().max(1e-12) };
                for j in 0..UNKNOWNS {
                    let conjugate = row[j].conj() * weight;
                    right[j] += conjugate * value;
                    for k in 0..UNKNOWNS {
                        matrix[j * UNKNOWNS + k] += conjugate * row[k];
                    }
                }
            }
            self.lu.factorize(UNKNOWNS, |to| to.copy_from_slice(&matrix)).ok()?;
            solution = right;
            self.lu.solve_in_place(&mut solution);
        }
        Some(solution)
    }
}

/// The step of x: `half` lines about `line`, Hz.
fn unit(hz: &[f64], line: usize, half: usize) -> Option<f64> {
    let (low, high) = (line.saturating_sub(half), (line + half).min(hz.len() - 1));
    let unit = 0.5 * (hz[high] - hz[low]);
    (unit > 0.0).then_some(unit)
}

/// From two columns after each other to rows of two.
fn transposed(columns: &mut [Complex64]) -> &mut [Complex64] {
    let mut rows = [Complex64::ZERO; 2 * UNKNOWNS];
    for k in 0..UNKNOWNS {
        rows[2 * k] = columns[k];
        rows[2 * k + 1] = columns[UNKNOWNS + k];
    }
    columns.copy_from_slice(&rows);
    columns
}

impl LocalRational {
    /// The function `distance` Hz from its line.
    pub(crate) fn at(&self, distance: f64) -> Complex64 {
        let [b0, b1, b2] = self.numerator;
        (b0 + (b1 + b2 * distance) * distance) / (1.0 + self.pole * distance)
    }

    /// The pole: its distance from the line and its half-width, Hz, and the variance of the distance, Hz².
    pub(crate) fn resonance(&self) -> (f64, f64, f64) {
        let place = -self.pole.inv();
        (place.re, place.im.abs(), 0.5 * self.pole_variance * self.pole.inv().norm_sqr().powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;

    /// One mode at 20.3 Hz of half-width 0.9 Hz and a smooth rest, on lines 0.5 Hz apart.
    fn frf(hz: f64) -> Complex64 {
        let pole = Complex64::new(hz - 20.3, 0.9);
        Complex64::new(2.0, 1.0) / pole + Complex64::new(0.3, 0.1) + 0.02 * hz
    }

    fn lines() -> Vec<f64> {
        (0..80).map(|line| 0.5 * line as f64).collect()
    }

    #[test]
    fn a_mode_and_a_straight_rest_are_met_from_every_line_with_their_pole() {
        let hz = lines();
        let values: Vec<Complex64> = hz.iter().map(|&hz| frf(hz)).collect();
        let mut fit = LocalRationalFit::new();
        for line in 30..50 {
            let found = fit.about(&hz, &values, line, 8).unwrap();
            let (place, width, _) = found.resonance();
            assert!((hz[line] + place - 20.3).abs() < 1e-6 && (width - 0.9).abs() < 1e-6, "{place} {width}");
            assert!((found.at(1.3) - frf(hz[line] + 1.3)).norm() < 1e-7);
            assert!(found.residual.norm() < 1e-9 && found.variance < 1e-15);
        }
        // Beside the ends the lines are the nearest ones: the same function.
        for (line, same) in [(0, 8), (2, 8), (79, 71), (73, 71)] {
            let (end, inside) =
                (fit.about(&hz, &values, line, 8).unwrap(), fit.about(&hz, &values, same, 8).unwrap());
            let off = end.at(0.4) - inside.at(hz[line] - hz[same] + 0.4);
            assert!(off.norm() < 1e-6, "{line}: {off}");
        }
    }

    #[test]
    fn too_few_lines_or_nothing_on_them_have_no_function() {
        let hz = lines();
        let values: Vec<Complex64> = hz.iter().map(|&hz| frf(hz)).collect();
        let mut fit = LocalRationalFit::new();
        assert!(fit.about(&hz[..17], &values[..17], 8, 8).is_some());
        assert!(fit.about(&hz[..16], &values[..16], 8, 8).is_none());
        assert!(fit.about(&hz, &values, 40, 2).is_some() && fit.about(&hz, &values, 40, 1).is_none());
        assert!(fit.about(&hz, &[Complex64::ZERO; 80], 40, 8).is_none());
    }

    #[test]
    fn noise_is_told_by_what_is_left_and_moves_the_pole_as_far_as_is_said() {
        let (hz, noise, runs) = (lines(), 1e-3, 400);
        let mut random = Noise::from_state(3);
        let mut fit = LocalRationalFit::new();
        let [mut places, mut stated, mut variance, mut left] = [0.0; 4];
        for _ in 0..runs {
            let values: Vec<Complex64> = hz.iter().map(|&hz| frf(hz) + random.complex(noise)).collect();
            let found = fit.about(&hz, &values, 41, 8).unwrap();
            let (place, _, of_place) = found.resonance();
            places += (hz[41] + place - 20.3).powi(2) / f64::from(runs);
            stated += of_place / f64::from(runs);
            variance += found.variance / f64::from(runs);
            left += found.residual.norm_sqr() / (1.0 - found.leverage) / f64::from(runs);
        }
        assert!((variance / noise - 1.0).abs() < 0.05, "{variance}");
        assert!((left / noise - 1.0).abs() < 0.2, "{left}");
        assert!((stated / places - 1.0).abs() < 0.2, "{stated} for {places}");
    }
}
