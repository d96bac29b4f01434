//! FRFs of all levels from the fixture with a change across one joint, against what was measured.

use super::balance::equivalent;
use super::least_squares::{deviations, minimum};
use super::level::{Held, SteppedLevel};
use super::location::{LineModel, Location};
use crate::RestoringLaw;
use crate::settings::level_fit::{GAIN_SCALE, LAW_SCALE};
use crate::settings::level_model::{FOUND, GAIN_FOUND, GAIN_TURNS, TURNS};
use jointscope_spectra::Dof;
use num_complex::Complex64;

/// A component of a joint with the levels measured.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    pub joint: String,
    pub dof: Dof,
    /// Static relative displacement by a force of 1 across the joint, m/N or rad/(N·m).
    pub yields: f64,
    pub levels: Vec<Level>,
    /// ln of the gain common to all levels, each with its own δ.
    log_gain: f64,
    /// Root mean square over the levels of the relative errors that no law could take away.
    pub floor: f64,
    /// Whether laws are read at the motions that the levels' own δ give, whatever they do to d themselves.
    frozen: bool,
}

/// A level as measured, and what the fixture with a complex stiffness δ across the joint makes of it.
#[derive(Debug, Clone)]
pub(crate) struct Level {
    pub measured: SteppedLevel,
    lines: Vec<LineModel>,
    /// FRF after FRF: one over the level's √Σ|H|², or over each value's deviation.
    weights: Vec<f64>,
    /// The δ beyond the fixture's that the level asks for.
    pub delta: Complex64,
    /// Amplitude of d by line, with that δ.
    motions: Vec<f64>,
}

/// What is added across the joint: gain of the fixture's FRFs, base stiffness and loss beyond the fixture's,
/// laws.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Change {
    pub log_gain: f64,
    pub base: Complex64,
    pub laws: Vec<RestoringLaw>,
}

/// Parameters of a change before those of its laws.
pub(crate) const BASE: usize = 3;

impl Change {
    /// What a fit moves: gain, base stiffness and loss, then the laws' parameters, by their logarithms where
    /// they are positive.
    pub(super) fn parameters(&self) -> Vec<f64> {
        let of_law = |law: &RestoringLaw| {
            let positive = law.is_positive();
            law.values().into_iter().map(move |value| if positive { value.ln() } else { value })
        };
        [self.log_gain, self.base.re, self.base.im]
            .into_iter()
            .chain(self.laws.iter().flat_map(of_law))
            .collect()
    }

    /// The change of this form at the parameters `x`.
    pub(super) fn at(&self, x: &[f64]) -> Self {
        let mut rest = x[BASE..].iter();
        let of_law = |law: &RestoringLaw| {
            let positive = law.is_positive();
            let own = rest.by_ref().take(law.values().len());
            law.with_values(&own.map(|x| if positive { x.exp() } else { *x }).collect::<Vec<f64>>())
        };
        let laws = self.laws.iter().map(of_law).collect();
        Change { log_gain: x[0], base: Complex64::new(x[1], x[2]), laws }
    }

    /// The complex stiffness across the joint at an amplitude of its motion.
    pub(super) fn delta(&self, motion: f64, yields: f64) -> Complex64 {
        self.base + self.laws.iter().map(|law| equivalent(law, motion, yields)).sum::<Complex64>()
    }
}

fn sum_of_squares(residual: &[f64]) -> f64 {
    residual.iter().map(|r| r * r).sum()
}

fn finite(residual: Vec<f64>) -> Option<Vec<f64>> {
    residual.iter().all(|r| r.is_finite()).then_some(residual)
}

impl Level {
    fn new(measured: &SteppedLevel, lines: Vec<LineModel>) -> Self {
        let values = measured.frfs.all_values();
        let power: f64 = values.iter().map(|v| v.norm_sqr()).sum();
        let weights = vec![power.sqrt().recip(); values.len()];
        Level { measured: measured.clone(), lines, weights, delta: Complex64::ZERO, motions: Vec::new() }
    }

    /// One over the deviation of every value; `None` where values carry none.
    fn weights_by_noise(&self) -> Option<Vec<f64>> {
        let frfs = &self.measured.frfs;
        let of_frf = |frf: usize| Some(frfs.variance(frf)?.iter().map(|v| v.sqrt().recip()));
        let weights = (0..frfs.pairs().len()).map(of_frf).collect::<Option<Vec<_>>>()?;
        finite(weights.into_iter().flatten().collect())
    }

    /// The noise stated of the level's values, relative to them; zero where they carry none.
    fn noise(&self) -> f64 {
        let frfs = &self.measured.frfs;
        let of_frf = |frf: usize| frfs.variance(frf).map_or(0.0, |variance| variance.iter().sum::<f64>());
        let power: f64 = frfs.all_values().iter().map(|value| value.norm_sqr()).sum();
        ((0..frfs.pairs().len()).map(of_frf).sum::<f64>() / power).sqrt()
    }

    /// Amplitude of d at the peak.
    pub(super) fn motion(&self) -> f64 {
        self.motions[self.peak_line()]
    }

    fn peak_line(&self) -> usize {
        let values = self.measured.frfs.values(self.measured.watched());
        (0..values.len())
            .fold(0, |top, line| if values[line].norm() > values[top].norm() { line } else { top })
    }

    /// Amplitude of d on a line from the amplitude measured at the watched response, and δ there; `delta` is
    /// δ by d, `near` where d is looked for.
    fn motion_on(&self, line: usize, near: f64, delta: &dyn Fn(f64) -> Complex64) -> (f64, Complex64) {
        let watched = self.measured.watched();
        let response = match self.measured.held {
            Held::Response(amplitude) => amplitude,
            Held::Force(amplitude) => amplitude * self.measured.frfs.values(watched)[line].norm(),
        };
        let (mut motion, mut found) = (near, delta(near));
        // ln of the motion before and of what δ there made of it: from the second turn on the secant through
        // the last two.
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..TURNS {
            let made = response * self.lines[line].motion_per_response(watched, found);
            if motion <= 0.0 {
                (motion, found) = (made, delta(made));
                continue;
            }
            let off = (made / motion).ln();
            let step = match last {
                Some((before, off_before)) if off != off_before && off.is_finite() => {
                    off * (before - motion.ln()) / (off - off_before)
                }
                _ => off,
            };
            last = Some((motion.ln(), off));
            motion *= step.clamp(-1.0, 1.0).exp();
            found = delta(motion);
            if step.abs() <= FOUND {
                break;
            }
        }
        (motion, found)
    }

    /// δ on every line under a change, at the motion that goes with it there.
    fn deltas(&self, change: &Change, yields: f64, frozen: bool) -> Vec<Complex64> {
        if change.laws.is_empty() {
            return vec![change.base; self.lines.len()];
        }
        let delta = |motion: f64| change.delta(motion, yields);
        let on_line = |(line, motion): (usize, &f64)| match frozen {
            true => delta(*motion),
            false => self.motion_on(line, *motion, &delta).1,
        };
        self.motions.iter().enumerate().map(on_line).collect()
    }

    /// Real and imaginary parts of measured less modelled, weighted.
    fn residual(&self, log_gain: f64, delta: &dyn Fn(usize) -> Complex64) -> Vec<f64> {
        let gain = log_gain.exp();
        let deltas: Vec<Complex64> = (0..self.lines.len()).map(delta).collect();
        let mut all = Vec::with_capacity(2 * self.weights.len());
        for (frf, line, value, weight) in self.values() {
            let left = (value - gain * self.lines[line].accelerance(frf, deltas[line])) * weight;
            all.extend([left.re, left.im]);
        }
        all
    }

    /// The same with one δ on all lines.
    fn residual_of(&self, log_gain: f64, delta: Complex64) -> Option<Vec<f64>> {
        finite(self.residual(log_gain, &|_| delta))
    }

    /// FRF, line, value measured and weight, FRF after FRF.
    fn values(&self) -> impl Iterator<Item = (usize, usize, Complex64, f64)> {
        let lines = self.lines.len();
        let values = self.measured.frfs.all_values().iter().zip(&self.weights).enumerate();
        values.map(move |(i, (value, weight))| (i / lines, i % lines, *value, *weight))
    }

    /// The δ that the level asks for with a gain, from one close by.
    fn own_delta(&self, log_gain: f64) -> Option<Complex64> {
        let size = self.delta.norm().max(f64::MIN_POSITIVE);
        let residual = |x: &[f64]| self.residual_of(log_gain, Complex64::new(x[0], x[1]));
        let fit = minimum(&residual, &[self.delta.re, self.delta.im], &[size; 2])?;
        Some(Complex64::new(fit.x[0], fit.x[1]))
    }

    /// δ and gain that the level asks for by itself, from δ on the line of the peak.
    fn own_delta_and_gain(&self) -> Option<(Complex64, f64)> {
        let (watched, line) = (self.measured.watched(), self.peak_line());
        let start = self.lines[line].delta(watched, self.measured.frfs.values(watched)[line]);
        let size = start.norm().max(f64::MIN_POSITIVE);
        let residual = |x: &[f64]| self.residual_of(x[2], Complex64::new(x[0], x[1]));
        let fit = minimum(&residual, &[start.re, start.im, 0.0], &[size, size, GAIN_SCALE])?;
        Some((Complex64::new(fit.x[0], fit.x[1]), fit.x[2]))
    }
}

impl Problem {
    /// `None` where no δ follows the levels.
    pub(super) fn new(location: Location, measured: &[&SteppedLevel]) -> Option<Self> {
        let Location { joint, dof, lines, yields } = location;
        let levels = measured.iter().zip(lines).map(|(level, lines)| Level::new(level, lines)).collect();
        let (log_gain, floor, frozen) = (0.0, f64::NAN, false);
        Problem { joint, dof, yields, levels, log_gain, floor, frozen }.with_own_deltas()
    }

    /// δ of each level, the gain common to all, and the motions that follow: each level has a gain of its own
    /// first, later ones share their mean.
    fn with_own_deltas(mut self) -> Option<Self> {
        let mut gains = 0.0;
        for level in &mut self.levels {
            let (delta, log_gain) = level.own_delta_and_gain()?;
            level.delta = delta;
            gains += log_gain;
        }
        self.log_gain = gains / self.levels.len() as f64;
        let mut problem = self.with_one_gain()?;
        for level in &mut problem.levels {
            let motion = |line: usize| level.motion_on(line, 0.0, &|_| level.delta).0;
            level.motions = (0..level.lines.len()).map(motion).collect();
        }
        problem.floor = problem.beyond_laws();
        let mut motions = problem.levels.iter().flat_map(|level| &level.motions);
        let sound = problem.floor.is_finite() && motions.all(|d| d.is_finite() && *d > 0.0);
        sound.then_some(problem)
    }

    /// Root mean square over the levels of the relative errors that no law could take away. Where the force was
    /// held each line moves by an amplitude of its own, and what one δ leaves of the level is the law's doing:
    /// then no more counts than what the gentlest level leaves, or noise.
    fn beyond_laws(&self) -> f64 {
        let gentlest = self.levels.iter().min_by(|a, b| a.motion().total_cmp(&b.motion()));
        let gentlest = gentlest.map_or(0.0, |level| self.own_error(level));
        self.mean(|level| match level.measured.held {
            Held::Response(_) => self.own_error(level),
            Held::Force(_) => self.own_error(level).min(gentlest.max(level.noise())),
        })
    }

    /// δ of each level and the gain common to all, from values close by.
    fn with_one_gain(mut self) -> Option<Self> {
        for _ in 0..GAIN_TURNS {
            let log_gain = self.log_gain;
            for level in &mut self.levels {
                level.delta = level.own_delta(log_gain)?;
            }
            self.log_gain = self.best_gain();
            let moved = (self.log_gain - log_gain).abs();
            if moved.is_nan() || moved <= GAIN_FOUND {
                break;
            }
        }
        self.log_gain.is_finite().then_some(self)
    }

    /// The gain that suits all levels, each with its δ.
    fn best_gain(&self) -> f64 {
        let (mut along, mut power) = (0.0, 0.0);
        for level in &self.levels {
            for (frf, line, value, weight) in level.values() {
                let model = level.lines[line].accelerance(frf, level.delta);
                along += weight.powi(2) * (model.conj() * value).re;
                power += weight.powi(2) * model.norm_sqr();
            }
        }
        (along / power).ln()
    }

    /// The problem with laws read at the motions that the levels' own δ give: close, and four times as fast.
    pub(super) fn frozen(&self) -> Self {
        Problem { frozen: true, ..self.clone() }
    }

    /// The first `count` levels alone.
    pub(super) fn up_to(&self, count: usize) -> Option<Self> {
        Problem { levels: self.levels[..count].to_vec(), ..self.clone() }.with_own_deltas()
    }

    /// All levels but one.
    pub(super) fn without(&self, left_out: usize) -> Self {
        let mut less = self.clone();
        less.levels.remove(left_out);
        less
    }

    /// The problem with every value weighed by its own deviation, and the levels' δ that follow; `None` where
    /// values carry none.
    pub(super) fn by_noise(&self) -> Option<Self> {
        let mut other = self.clone();
        for level in &mut other.levels {
            level.weights = level.weights_by_noise()?;
        }
        other.with_one_gain()
    }

    /// A change without laws: base stiffness and gain that suit the levels' own δ less what `laws` make of
    /// them, with these laws.
    pub(super) fn begun(&self, laws: Vec<RestoringLaw>) -> Change {
        let mut change = Change { log_gain: self.log_gain, laws, ..Change::default() };
        let rest = |level: &Level| level.delta - change.delta(level.motion(), self.yields);
        change.base = self.levels.iter().map(rest).sum::<Complex64>() / self.levels.len() as f64;
        change
    }

    /// A change fitted to another problem, moved by what the levels' own δ and the gain differ by.
    pub(super) fn carried_from(&self, other: &Problem, change: &Change) -> Change {
        let pairs = self.levels.iter().zip(&other.levels);
        let moved = pairs.map(|(here, there)| here.delta - there.delta).sum::<Complex64>();
        Change {
            log_gain: change.log_gain + self.log_gain - other.log_gain,
            base: change.base + moved / self.levels.len() as f64,
            laws: change.laws.clone(),
        }
    }

    fn residual(&self, level: &Level, change: &Change) -> Vec<f64> {
        let deltas = level.deltas(change, self.yields, self.frozen);
        level.residual(change.log_gain, &|line| deltas[line])
    }

    /// All levels' residuals under a change.
    pub(super) fn residuals(&self, change: &Change) -> Option<Vec<f64>> {
        finite(self.levels.iter().flat_map(|level| self.residual(level, change)).collect())
    }

    /// Relative error of a level under a change.
    pub(super) fn error(&self, level: &Level, change: &Change) -> f64 {
        sum_of_squares(&self.residual(level, change)).sqrt()
    }

    /// Relative error of a level with its own δ.
    pub(super) fn own_error(&self, level: &Level) -> f64 {
        sum_of_squares(&level.residual(self.log_gain, &|_| level.delta)).sqrt()
    }

    /// Root mean square over the levels of their relative errors, each with its own δ.
    pub(super) fn own_errors(&self) -> f64 {
        self.mean(|level| self.own_error(level))
    }

    /// Root mean square of an error over the levels.
    pub(super) fn mean(&self, error: impl Fn(&Level) -> f64) -> f64 {
        (self.levels.iter().map(|level| error(level).powi(2)).sum::<f64>() / self.levels.len() as f64).sqrt()
    }

    /// Root mean square over the levels of the relative errors under a change.
    pub(super) fn nrmse(&self, change: &Change) -> f64 {
        self.mean(|level| self.error(level, change))
    }

    /// χ² per degree of freedom under a change, of a problem that is weighed by its noise; `None` where it is
    /// not finite.
    pub(super) fn chi2_per_dof(&self, change: &Change, fitted: usize) -> Option<f64> {
        let squares = self.levels.iter().map(|level| self.error(level, change).powi(2));
        // The noise of a complex value has half of its variance in each part.
        let chi2 = 2.0 * squares.sum::<f64>() / (self.count().max(fitted + 1) - fitted) as f64;
        chi2.is_finite().then_some(chi2)
    }

    /// Fits the change from `start`; what is left of the squared residuals beside it.
    pub(super) fn fitted(&self, start: &Change) -> Option<(Change, f64)> {
        let residual = |x: &[f64]| self.residuals(&start.at(x));
        let fit = minimum(&residual, &start.parameters(), &self.scales(start))?;
        Some((start.at(&fit.x), fit.cost))
    }

    /// Standard deviations of a change's parameters by the scatter of the lines.
    pub(super) fn deviations(&self, change: &Change) -> Option<Vec<f64>> {
        let x = change.parameters();
        let degrees = self.count().max(x.len() + 1) - x.len();
        deviations(&|x: &[f64]| self.residuals(&change.at(x)), &x, &self.scales(change), degrees)
    }

    /// Standard deviations of a level's δ, from what its own fit leaves.
    pub(super) fn delta_deviations(&self, level: &Level) -> Option<Vec<f64>> {
        let residual = |x: &[f64]| level.residual_of(self.log_gain, Complex64::new(x[0], x[1]));
        let degrees = (2 * level.weights.len()).max(3) - 2;
        deviations(&residual, &[level.delta.re, level.delta.im], &[self.span(); 2], degrees)
    }

    /// Steps in which the parameters of a change are measured.
    fn scales(&self, change: &Change) -> Vec<f64> {
        let span = self.span();
        let most = self.levels.iter().fold(0.0, |most: f64, level| level.motion().max(most));
        let of_law = |law: &RestoringLaw| {
            let scale = if law.is_positive() { LAW_SCALE } else { span / (most * most) };
            vec![scale; law.values().len()]
        };
        [GAIN_SCALE, span, span].into_iter().chain(change.laws.iter().flat_map(of_law)).collect()
    }

    /// How much the levels' δ differ.
    pub(super) fn span(&self) -> f64 {
        let deltas = || self.levels.iter().map(|level| level.delta);
        let apart = deltas().flat_map(|a| deltas().map(move |b| (a - b).norm()));
        let size = deltas().fold(0.0, |most: f64, d| d.norm().max(most));
        apart.fold(1e-6 * size, f64::max).max(f64::MIN_POSITIVE)
    }

    /// Number of real values measured.
    pub(super) fn count(&self) -> usize {
        2 * self.levels.iter().map(|level| level.weights.len()).sum::<usize>()
    }
}
