//! FRFs of all levels from the fixture with a change across one joint, against what was measured.

use super::balance::equivalent;
use super::least_squares::{Minimum, minimum};
use super::level::SteppedLevel;
use super::seat::Seat;
use crate::RestoringLaw;
use jointscope_spectra::Dof;
use num_complex::Complex64;

/// A seat with the levels measured, and the complex stiffness that each level asks for there.
#[derive(Debug, Clone)]
pub(crate) struct Subject {
    pub seat: Seat,
    pub levels: Vec<SteppedLevel>,
    /// By level and value, FRF after FRF: one over the level's √Σ|H|², or over each value's deviation.
    weights: Vec<Vec<f64>>,
    /// ln of the gain common to all levels, with each level's δ.
    pub free: (f64, Vec<Complex64>),
    /// Root mean square over the levels of each one's relative error, each with its δ.
    pub floor: f64,
    /// Amplitude of d by level and line.
    motions: Vec<Vec<f64>>,
    /// Whether laws are read at these amplitudes, whatever they do to d themselves.
    frozen: bool,
}

/// What is added across the joint: gain of the fixture's FRFs, base stiffness and loss beyond the fixture's, laws.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Change {
    pub log_gain: f64,
    pub base: Complex64,
    pub laws: Vec<RestoringLaw>,
}

impl Change {
    pub fn parameters(&self) -> Vec<f64> {
        let mut x = vec![self.log_gain, self.base.re, self.base.im];
        for law in &self.laws {
            match *law {
                RestoringLaw::Cubic { stiffness3 } => x.push(stiffness3),
                RestoringLaw::Friction { slip_force, stiffness } => {
                    x.extend([slip_force.ln(), stiffness.ln()])
                }
                RestoringLaw::Gap { clearance, stiffness } => x.extend([clearance.ln(), stiffness.ln()]),
            }
        }
        x
    }

    /// Which of the parameters are cubic stiffnesses.
    pub fn cubic_places(&self) -> Vec<usize> {
        let mut next = 3;
        let mut places = Vec::new();
        for law in &self.laws {
            match law {
                RestoringLaw::Cubic { .. } => {
                    places.push(next);
                    next += 1;
                }
                _ => next += 2,
            }
        }
        places
    }

    /// The change of this form at the parameters `x`.
    pub fn at(&self, x: &[f64]) -> Self {
        let mut rest = x[3..].iter();
        let mut next = || rest.next().copied().unwrap_or(f64::NAN);
        let laws = self.laws.iter().map(|law| match law {
            RestoringLaw::Cubic { .. } => RestoringLaw::Cubic { stiffness3: next() },
            RestoringLaw::Friction { .. } => {
                RestoringLaw::Friction { slip_force: next().exp(), stiffness: next().exp() }
            }
            RestoringLaw::Gap { .. } => {
                RestoringLaw::Gap { clearance: next().exp(), stiffness: next().exp() }
            }
        });
        Change { log_gain: x[0], base: Complex64::new(x[1], x[2]), laws: laws.collect() }
    }

    /// The complex stiffness across the joint at an amplitude of its motion.
    pub fn delta(&self, motion: f64, yields: f64) -> Complex64 {
        self.base + self.laws.iter().map(|law| equivalent(law, motion, yields)).sum::<Complex64>()
    }
}

impl Subject {
    /// `None` where no δ follows the levels.
    pub fn new(seat: Seat, levels: &[SteppedLevel]) -> Option<Self> {
        let power = |level: &SteppedLevel| level.frfs.all_values().iter().map(|v| v.norm_sqr()).sum::<f64>();
        let relative =
            |level: &SteppedLevel| vec![power(level).sqrt().recip(); level.frfs.all_values().len()];
        let weights = levels.iter().map(relative).collect();
        let mut subject = Subject {
            motions: vec![Vec::new(); levels.len()],
            seat,
            levels: levels.to_vec(),
            weights,
            free: (0.0, Vec::new()),
            frozen: false,
            floor: f64::NAN,
        };
        subject.free = subject.each_level_free()?;
        subject.motions = subject.motions_of_each_free();
        let squares =
            (0..levels.len()).map(|l| subject.error(l, subject.free.0, &|_| subject.free.1[l]).powi(2));
        subject.floor = (squares.sum::<f64>() / levels.len() as f64).sqrt();
        let sound =
            subject.floor.is_finite() && subject.motions.iter().flatten().all(|d| d.is_finite() && *d > 0.0);
        sound.then_some(subject)
    }

    /// The same component in another fixture, close to this one.
    pub fn in_another(&self, seat: Seat) -> Option<Self> {
        let mut other = Subject { seat, ..self.clone() };
        other.free = other.each_level_free()?;
        other.motions = other.motions_of_each_free();
        Some(other)
    }

    /// A change fitted to another subject, moved by what the levels' own stiffnesses and the gain differ by.
    pub fn carried_from(&self, other: &Subject, change: &Change) -> Change {
        let pairs = self.free.1.iter().zip(&other.free.1);
        let moved = pairs.map(|(here, there)| here - there).sum::<Complex64>() / self.free.1.len() as f64;
        Change {
            log_gain: change.log_gain + self.free.0 - other.free.0,
            base: change.base + moved,
            laws: change.laws.clone(),
        }
    }

    fn motions_of_each_free(&self) -> Vec<Vec<f64>> {
        let of =
            |l: usize, line: usize| self.seat.motion((l, line), &self.levels[l], 0.0, &|_| self.free.1[l]).0;
        let levels = self.seat.lines.iter().enumerate();
        levels.map(|(l, lines)| (0..lines.len()).map(|line| of(l, line)).collect()).collect()
    }

    /// δ on every line of a level under a change, at the motion that goes with it there.
    fn deltas(&self, level: usize, change: &Change) -> Vec<Complex64> {
        let count = self.seat.lines[level].len();
        if change.laws.is_empty() {
            return vec![change.base; count];
        }
        let yields = self.seat.yields;
        let delta = |motion: f64| change.delta(motion, yields);
        if self.frozen {
            return self.motions[level].iter().map(|motion| delta(*motion)).collect();
        }
        let of = |line: usize| {
            self.seat.motion((level, line), &self.levels[level], self.motions[level][line], &delta).1
        };
        (0..count).map(of).collect()
    }

    /// The subject with laws read at the motions that the levels' own stiffnesses give: close, and four times as fast.
    pub fn frozen(&self) -> Self {
        Subject { frozen: true, ..self.clone() }
    }

    /// The first `count` levels alone.
    pub fn up_to(&self, count: usize) -> Option<Self> {
        let mut seat = self.seat.clone();
        seat.lines.truncate(count);
        Subject::new(seat, &self.levels[..count])
    }

    /// All levels but one.
    pub fn without(&self, left_out: usize) -> Self {
        let mut less = self.clone();
        less.seat.lines.remove(left_out);
        less.levels.remove(left_out);
        less.weights.remove(left_out);
        less.motions.remove(left_out);
        less.free.1.remove(left_out);
        less
    }

    pub fn dof(&self) -> Dof {
        self.seat.dof
    }

    /// Amplitude of d at the peak of a level.
    pub fn motion(&self, level: usize) -> f64 {
        let peak = self.peak_line(level);
        self.motions[level][peak]
    }

    fn peak_line(&self, level: usize) -> usize {
        let of = &self.levels[level];
        let values = of.frfs.values(of.watched());
        (0..values.len())
            .fold(0, |top, line| if values[line].norm() > values[top].norm() { line } else { top })
    }

    /// Real and imaginary parts of measured less modelled on a level, over its √Σ|H|².
    fn residual(&self, level: usize, log_gain: f64, delta: &dyn Fn(usize) -> Complex64) -> Vec<f64> {
        let of = &self.levels[level];
        let gain = log_gain.exp();
        let lines = &self.seat.lines[level];
        let deltas: Vec<Complex64> = (0..lines.len()).map(delta).collect();
        let mut all = Vec::with_capacity(2 * of.frfs.all_values().len());
        for frf in 0..of.frfs.pairs().len() {
            for (line, value) in of.frfs.values(frf).iter().enumerate() {
                let left = (value - gain * lines[line].accelerance(frf, deltas[line]))
                    * self.weights[level][frf * lines.len() + line];
                all.extend([left.re, left.im]);
            }
        }
        all
    }

    /// Relative error of a level.
    fn error(&self, level: usize, log_gain: f64, delta: &dyn Fn(usize) -> Complex64) -> f64 {
        self.residual(level, log_gain, delta).iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Relative error of a level under a change.
    pub fn error_of(&self, level: usize, change: &Change) -> f64 {
        let deltas = self.deltas(level, change);
        self.error(level, change.log_gain, &|line| deltas[line])
    }

    /// Relative error of a level with a δ and gain of its own seat's free fit.
    pub fn free_error(&self, level: usize) -> f64 {
        self.error(level, self.free.0, &|_| self.free.1[level])
    }

    /// Root mean square over the levels of the relative errors under a change.
    pub fn nrmse(&self, change: &Change) -> f64 {
        let sum: f64 = (0..self.levels.len()).map(|l| self.error_of(l, change).powi(2)).sum();
        (sum / self.levels.len() as f64).sqrt()
    }

    /// The subject with every value weighed by its own deviation, and the levels' δ that follow; `None` where values carry none.
    pub fn by_noise(&self) -> Option<Self> {
        let of_level = |level: &SteppedLevel| -> Option<Vec<f64>> {
            let mut weights = Vec::with_capacity(level.frfs.all_values().len());
            for frf in 0..level.frfs.pairs().len() {
                weights.extend(level.frfs.variance(frf)?.iter().map(|v| v.sqrt().recip()));
            }
            weights.iter().all(|w| w.is_finite()).then_some(weights)
        };
        let weights = self.levels.iter().map(of_level).collect::<Option<_>>()?;
        let mut other = Subject { weights, ..self.clone() };
        other.free = other.with_one_gain(self.free.0, self.free.1.clone())?;
        Some(other)
    }

    /// χ² per degree of freedom under a change, of a subject that is weighed by its noise; `None` where it is not finite.
    pub fn chi2_per_dof(&self, change: &Change, fitted: usize) -> Option<f64> {
        let squares = (0..self.levels.len()).map(|l| self.error_of(l, change).powi(2));
        // The noise of a complex value has half of its variance in each part.
        let chi2 = 2.0 * squares.sum::<f64>() / (self.count().max(fitted + 1) - fitted) as f64;
        chi2.is_finite().then_some(chi2)
    }

    /// All levels' residuals under a change, each level times its factor.
    pub fn residuals(&self, change: &Change, factors: Option<&[f64]>) -> Option<Vec<f64>> {
        let mut all = Vec::new();
        for level in 0..self.levels.len() {
            let deltas = self.deltas(level, change);
            let part = self.residual(level, change.log_gain, &|line| deltas[line]);
            let factor = factors.map_or(1.0, |f| f[level]);
            all.extend(part.iter().map(|r| r * factor));
        }
        all.iter().all(|r| r.is_finite()).then_some(all)
    }

    /// How much the levels' δ differ.
    pub fn span(&self) -> f64 {
        let deltas = &self.free.1;
        let apart = deltas.iter().flat_map(|a| deltas.iter().map(move |b| (a - b).norm()));
        let size = deltas.iter().fold(0.0, |most: f64, d| d.norm().max(most));
        apart.fold(1e-6 * size, f64::max).max(f64::MIN_POSITIVE)
    }

    /// Fits the change from `start`.
    pub fn fitted(&self, start: &Change, factors: Option<&[f64]>) -> Option<(Change, f64)> {
        let scale = self.scales(start);
        let residual = |x: &[f64]| self.residuals(&start.at(x), factors);
        let Minimum { x, cost } = minimum(&residual, &start.parameters(), &scale)?;
        Some((start.at(&x), cost))
    }

    /// Steps in which the parameters of a change are measured.
    pub fn scales(&self, change: &Change) -> Vec<f64> {
        let span = self.span();
        let most = (0..self.levels.len()).fold(0.0, |most: f64, l| self.motion(l).max(most));
        let mut all = vec![0.05, span, span];
        for law in &change.laws {
            match law {
                RestoringLaw::Cubic { .. } => all.push(span / (most * most)),
                _ => all.extend([0.3, 0.3]),
            }
        }
        all
    }

    /// δ of each level and the gain common to all: δ from the line of the peak first, then level by level, the gain between.
    fn each_level_free(&self) -> Option<(f64, Vec<Complex64>)> {
        let at_peak = |l: usize| {
            let (of, line) = (&self.levels[l], self.peak_line(l));
            self.seat.lines[l][line].delta(of.watched(), of.frfs.values(of.watched())[line])
        };
        let own = |(l, start): (usize, Complex64)| {
            let size = start.norm().max(f64::MIN_POSITIVE);
            let residual = |x: &[f64]| {
                let all = self.residual(l, x[2], &|_| Complex64::new(x[0], x[1]));
                all.iter().all(|r| r.is_finite()).then_some(all)
            };
            let fit = minimum(&residual, &[start.re, start.im, 0.0], &[size, size, 0.05])?;
            Some((Complex64::new(fit.x[0], fit.x[1]), fit.x[2]))
        };
        // The first pass gives every level a gain of its own; later ones share their mean.
        let fits: Vec<_> = (0..self.levels.len()).map(at_peak).enumerate().map(own).collect::<Option<_>>()?;
        let log_gain = fits.iter().map(|f| f.1).sum::<f64>() / fits.len() as f64;
        self.with_one_gain(log_gain, fits.iter().map(|f| f.0).collect())
    }

    /// δ of each level and the gain common to all, from values close by.
    fn with_one_gain(&self, mut log_gain: f64, mut deltas: Vec<Complex64>) -> Option<(f64, Vec<Complex64>)> {
        for _ in 0..12 {
            deltas =
                (0..deltas.len()).map(|l| self.free_delta(l, log_gain, deltas[l])).collect::<Option<_>>()?;
            let better = self.best_gain(&deltas);
            let moved = (better - log_gain).abs();
            log_gain = better;
            if moved.is_nan() || moved <= 1e-7 {
                break;
            }
        }
        log_gain.is_finite().then_some((log_gain, deltas))
    }

    fn free_delta(&self, level: usize, log_gain: f64, start: Complex64) -> Option<Complex64> {
        let size = start.norm().max(f64::MIN_POSITIVE);
        let residual = |x: &[f64]| {
            let all = self.residual(level, log_gain, &|_| Complex64::new(x[0], x[1]));
            all.iter().all(|r| r.is_finite()).then_some(all)
        };
        let fit = minimum(&residual, &[start.re, start.im], &[size, size])?;
        Some(Complex64::new(fit.x[0], fit.x[1]))
    }

    /// The gain that suits all levels, each with its δ.
    fn best_gain(&self, deltas: &[Complex64]) -> f64 {
        let (mut along, mut power) = (0.0, 0.0);
        for (l, of) in self.levels.iter().enumerate() {
            for frf in 0..of.frfs.pairs().len() {
                for (line, value) in of.frfs.values(frf).iter().enumerate() {
                    let model = self.seat.lines[l][line].accelerance(frf, deltas[l]);
                    let weight = self.weights[l][frf * self.seat.lines[l].len() + line].powi(2);
                    along += weight * (model.conj() * value).re;
                    power += weight * model.norm_sqr();
                }
            }
        }
        (along / power).ln()
    }

    /// Standard deviations of a level's δ, from what its own fit leaves.
    pub fn deviation(&self, level: usize) -> Option<[f64; 2]> {
        let delta = self.free.1[level];
        let scale = [self.span(), self.span()];
        let residual = |x: &[f64]| Some(self.residual(level, self.free.0, &|_| Complex64::new(x[0], x[1])));
        let left = residual(&[delta.re, delta.im])?;
        let variance = left.iter().map(|r| r * r).sum::<f64>() / (left.len().max(3) - 2) as f64;
        let std = super::least_squares::deviations(&residual, &[delta.re, delta.im], &scale, variance)?;
        Some([std[0], std[1]])
    }

    /// Number of real values measured.
    pub fn count(&self) -> usize {
        2 * self.levels.iter().map(|l| l.frfs.all_values().len()).sum::<usize>()
    }
}
