//! Simulated against recorded responses, in spectra weighted by their noise.

use super::parameters::Parameters;
use super::records::Record;
use super::spectra::{Transform, smooth_length};
use crate::time::kernel::{Stepper, Steps};
use crate::time::oversampling::oversampled_for_lines;
use crate::time::structure::{Reading, Structure};
use jointscope_fixture::Fixture;
use jointscope_spectra::Channel;
use num_complex::Complex64;
use rayon::prelude::*;

/// A look at some of the records: how much of each, how finely stepped.
pub(crate) struct View<'a> {
    traces: Vec<Trace<'a>>,
    within: usize,
    halvings: usize,
    highest_hz: f64,
}

/// The part of a record that is compared.
struct Trace<'a> {
    record: &'a Record,
    /// Force at every step.
    force: Vec<f64>,
    samples: usize,
    /// Weight of each sample before the transform.
    window: Vec<f64>,
    transform: Transform,
    lines: std::ops::RangeInclusive<usize>,
    /// √2 over the noise's standard deviation, line by line, a row a response.
    weights: Vec<Vec<f64>>,
    /// Σ|recorded|² in the band, a response each, for relative errors.
    power: Vec<f64>,
}

/// How a view looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Focus {
    /// Decay of the window's weight, 1/s; zero for all alike.
    pub decay: f64,
    /// Band compared, Hz.
    pub band: (f64, f64),
    /// Steps within a sampling interval.
    pub within: usize,
    /// Halvings of a step with an event.
    pub halvings: usize,
}

/// Departure of every line that is not held against a model: what sampling, sensors and steps leave of it, relative to the line.
const INEXACT: f64 = 2e-3;
/// e^{−at} at which a windowed record is cut off.
const CUT: f64 = 6.0;

/// (simulated − recorded)·weight, trace by trace.
pub(crate) type Residuals = Vec<Vec<Complex64>>;

/// Derivatives of the residuals, trace by trace, a column a coordinate.
pub(crate) struct Jacobian {
    columns: Vec<Vec<Vec<Complex64>>>,
    /// JᵀJ, row-major.
    pub matrix: Vec<f64>,
}

impl<'a> View<'a> {
    /// The records, each up to its own end or to where it has died away.
    pub fn new(records: &[&'a Record], focus: &Focus, ends: &[usize]) -> Self {
        let end = |i: usize| ends.get(i).copied().unwrap_or(usize::MAX);
        let traces = records.par_iter().enumerate().map(|(i, r)| Trace::new(r, focus, end(i))).collect();
        View { traces, within: focus.within, halvings: focus.halvings, highest_hz: 2.0 * focus.band.1 }
    }

    /// What every response of every record reads in the model, under the recorded force and `disturbance` times its noise; nothing for
    /// parameters without a finite motion.
    pub fn histories(&self, parameters: &Parameters, disturbance: f64) -> Option<Vec<Vec<Vec<f64>>>> {
        let model = ViewModel::of(self, &parameters.to_fixture().ok()?)?;
        let history = |trace: &Trace| {
            let record = trace.record;
            let disturbed = if disturbance != 0.0 {
                let noise = disturbance * record.force_noise;
                let noisy = record.hit.force().iter().zip(white(record.hit.samples()));
                let noisy: Vec<f64> = noisy.map(|(force, one)| force + noise * one).collect();
                oversampled_for_lines(&noisy, self.within)
            } else {
                trace.force.clone()
            };
            Some(model.stepper(record)?.run(&disturbed, trace.samples).outputs)
        };
        self.traces.par_iter().map(history).collect()
    }

    /// Number of real values compared.
    pub fn degrees(&self) -> f64 {
        let of = |t: &Trace| (2 * t.weights.len() * t.lines.clone().count()) as f64;
        self.traces.iter().map(of).sum()
    }

    /// χ² of the data; `None` for parameters without a finite motion.
    pub fn chi2(&self, parameters: &Parameters) -> Option<f64> {
        self.residuals(parameters).map(|residuals| sum_of_squares(&residuals))
    }

    /// χ² of the data and the priors.
    pub fn objective(&self, parameters: &Parameters) -> Option<f64> {
        self.chi2(parameters).map(|chi2| chi2 + parameters.penalty())
    }

    /// The residuals; `None` for parameters without a finite motion.
    pub fn residuals(&self, parameters: &Parameters) -> Option<Residuals> {
        let model = ViewModel::of(self, &parameters.to_fixture().ok()?)?;
        self.traces.par_iter().map(|trace| trace.residuals(&model)).collect()
    }

    /// √(Σ|simulated − recorded|²/Σ|recorded|²) in the band, over all responses.
    pub fn nrmse(&self, parameters: &Parameters) -> Option<f64> {
        let model = ViewModel::of(self, &parameters.to_fixture().ok()?)?;
        let each: Vec<(f64, f64)> = self
            .traces
            .par_iter()
            .map(|trace| {
                let residuals = trace.residuals(&model)?;
                let mut difference = 0.0;
                for (row, weights) in residuals.chunks_exact(trace.weights[0].len()).zip(&trace.weights) {
                    difference += row.iter().zip(weights).map(|(r, w)| r.norm_sqr() / (w * w)).sum::<f64>();
                }
                Some((difference, trace.power.iter().sum()))
            })
            .collect::<Option<_>>()?;
        let (difference, power) = each.iter().fold((0.0, 0.0), |(a, b), (d, p)| (a + d, b + p));
        Some((difference / power).sqrt())
    }

    /// Derivatives of the residuals with respect to every coordinate, by differences.
    pub fn jacobian(&self, parameters: &Parameters, residuals: &Residuals) -> Option<Jacobian> {
        let count = parameters.coordinates.len();
        let steps: Vec<f64> = (0..count).map(|i| parameters.step(i)).collect();
        let moved: Vec<ViewModel> = (0..count)
            .map(|i| ViewModel::of(self, &parameters.moved(i, steps[i]).to_fixture().ok()?))
            .collect::<Option<_>>()?;
        let derivative = |trace: &Trace, base: &[Complex64], i: usize| {
            let mut column = trace.residuals(&moved[i])?;
            let factor = 1.0 / steps[i];
            column.iter_mut().zip(base).for_each(|(c, r)| *c = (*c - r) * factor);
            Some(column)
        };
        let columns: Vec<Vec<Vec<Complex64>>> = self
            .traces
            .par_iter()
            .zip(residuals)
            .map(|(trace, base)| (0..count).map(|i| derivative(trace, base, i)).collect())
            .collect::<Option<_>>()?;
        let each: Vec<Vec<f64>> = columns.par_iter().map(|columns| gram(columns)).collect();
        let mut matrix = vec![0.0; count * count];
        for one in &each {
            matrix.iter_mut().zip(one).for_each(|(sum, value)| *sum += value);
        }
        matrix.iter().all(|e| e.is_finite()).then_some(Jacobian { columns, matrix })
    }
}

impl Jacobian {
    /// −Jᵀr.
    pub fn descent(&self, residuals: &Residuals) -> Vec<f64> {
        let mut right = vec![0.0; self.columns.first().map_or(0, Vec::len)];
        for (columns, r) in self.columns.iter().zip(residuals) {
            right.iter_mut().zip(columns).for_each(|(sum, column)| *sum -= dot(column, r));
        }
        right
    }
}

pub(crate) fn sum_of_squares(residuals: &Residuals) -> f64 {
    residuals.iter().map(|r| dot(r, r)).sum()
}

fn dot(a: &[Complex64], b: &[Complex64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.re * b.re + a.im * b.im).sum()
}

fn gram(columns: &[Vec<Complex64>]) -> Vec<f64> {
    let n = columns.len();
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let value = dot(&columns[i], &columns[j]);
            (matrix[i * n + j], matrix[j * n + i]) = (value, value);
        }
    }
    matrix
}

/// The model stepped, for every kind of trace.
struct ViewModel {
    steppers: Vec<(Channel, Vec<Reading>, u64, Stepper)>,
}

impl ViewModel {
    fn of(view: &View, fixture: &Fixture) -> Option<Self> {
        let structure = Structure::new(fixture, view.highest_hz).ok()?;
        let mut steppers: Vec<(Channel, Vec<Reading>, u64, Stepper)> = Vec::new();
        for trace in &view.traces {
            let (struck, readings) = (trace.record.struck(), &trace.record.readings);
            let interval = trace.record.hit.interval();
            if steppers.iter().any(|(s, r, i, _)| s == struck && r == readings && *i == interval.to_bits()) {
                continue;
            }
            let system = structure.system(struck, readings).ok()?;
            let steps = Steps { interval, within: view.within, halvings: view.halvings };
            steppers.push((
                struck.clone(),
                readings.clone(),
                interval.to_bits(),
                Stepper::new(&system, steps)?,
            ));
        }
        Some(ViewModel { steppers })
    }

    fn stepper(&self, record: &Record) -> Option<&Stepper> {
        let interval = record.hit.interval().to_bits();
        let fits = |(s, r, i, _): &&(Channel, Vec<Reading>, u64, Stepper)| {
            s == record.struck() && *r == record.readings && *i == interval
        };
        self.steppers.iter().find(fits).map(|(.., stepper)| stepper)
    }
}

impl<'a> Trace<'a> {
    fn new(record: &'a Record, focus: &Focus, end: usize) -> Self {
        let hit = &record.hit;
        let interval = hit.interval();
        let wanted = match focus.decay > 0.0 {
            true => record.onset + (CUT / (focus.decay * interval)).ceil() as usize,
            false => died_away(record),
        };
        let samples = smooth_length(wanted.min(end).min(hit.samples()), hit.samples());
        let weight = |i: usize| {
            let decay = (-focus.decay * interval * i.saturating_sub(record.onset) as f64).exp();
            decay * fading(i, record.onset, end)
        };
        let window: Vec<f64> = (0..samples).map(weight).collect();
        let spacing = 1.0 / (samples as f64 * interval);
        let last = ((focus.band.1 / spacing) as usize).min(samples / 2);
        let first = ((focus.band.0 / spacing).ceil() as usize).clamp(1, last.max(1));
        let mut trace = Trace {
            force: oversampled_for_lines(hit.force(), focus.within),
            samples,
            transform: Transform::new(samples),
            lines: first..=last.max(first),
            weights: Vec::new(),
            power: Vec::new(),
            window,
            record,
        };
        trace.weigh();
        trace
    }

    /// Noise of a response and, through the FRF that the hit itself shows, of the force; and what no model is exact to.
    fn weigh(&mut self) {
        let energy: f64 = self.window.iter().map(|w| w * w).sum();
        let force = self.spectrum(self.record.hit.force());
        let force_noise = self.record.force_noise.powi(2) * energy;
        for (response, noise) in self.record.hit.responses().iter().zip(&self.record.noise) {
            let lines = self.spectrum(&response.values);
            let own = noise * noise * energy;
            let variance = |(y, f): (&Complex64, &Complex64)| {
                let through =
                    if f.norm_sqr() > 25.0 * force_noise { y.norm_sqr() / f.norm_sqr() } else { 0.0 };
                own + through * force_noise + INEXACT * INEXACT * y.norm_sqr()
            };
            self.weights.push(lines.iter().zip(&force).map(variance).map(|v| (2.0 / v).sqrt()).collect());
            self.power.push(lines.iter().map(|y| y.norm_sqr()).sum());
        }
    }

    fn spectrum(&self, values: &[f64]) -> Vec<Complex64> {
        let mut windowed: Vec<f64> = values.iter().zip(&self.window).map(|(v, w)| v * w).collect();
        let mut lines = self.transform.of(&mut windowed);
        lines.truncate(self.lines.end() + 1);
        lines.drain(..*self.lines.start());
        lines
    }

    /// (simulated − recorded)·weight, response after response.
    fn residuals(&self, model: &ViewModel) -> Option<Vec<Complex64>> {
        let run = model.stepper(self.record)?.run(&self.force, self.samples);
        let mut all = Vec::with_capacity(self.weights.len() * self.lines.clone().count());
        for ((simulated, response), weights) in
            run.outputs.iter().zip(self.record.hit.responses()).zip(&self.weights)
        {
            let difference: Vec<f64> = simulated.iter().zip(&response.values).map(|(s, r)| s - r).collect();
            all.extend(self.spectrum(&difference).iter().zip(weights).map(|(d, w)| d * *w));
        }
        all.iter().all(|r| r.is_finite()).then_some(all)
    }
}

/// 1 well before `end`, 0 from there on; half a cosine over the last part of the way from `onset`.
fn fading(sample: usize, onset: usize, end: usize) -> f64 {
    const PART: f64 = 0.2;
    let length = PART * end.saturating_sub(onset) as f64;
    let left = (end.saturating_sub(sample) as f64 / length.max(1.0)).min(1.0);
    0.5 - 0.5 * (std::f64::consts::PI * left).cos()
}

/// White noise of unit variance, the same every time: it asks what the noise of a force may do, and is no draw of it.
fn white(samples: usize) -> impl Iterator<Item = f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    // The sum of twelve has a variance of one.
    (0..samples).map(move |_| (0..12).map(|_| uniform()).sum())
}

/// Samples until every response has sunk into its noise, with a tenth on top.
fn died_away(record: &Record) -> usize {
    let samples = record.hit.samples();
    const BLOCK: usize = 64;
    let mut last = record.onset + BLOCK;
    for (response, noise) in record.hit.responses().iter().zip(&record.noise) {
        for (block, values) in response.values.chunks(BLOCK).enumerate() {
            let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
            if square > 1.5 * noise * noise {
                last = last.max((block + 1) * BLOCK);
            }
        }
    }
    (last + last / 10).min(samples)
}
