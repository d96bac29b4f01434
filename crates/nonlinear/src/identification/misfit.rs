//! Simulated against recorded responses, in spectra weighted by their noise.

use super::hypothesis::Hypothesis;
use super::records::Record;
use crate::settings::band::BEYOND_BAND;
use crate::settings::misfit::{ABOVE_NOISE, CUT, DECAY_BLOCK, FADING_SHARE, FORCE_ABOVE_NOISE, LINE_ERROR};
use crate::spectra::{Compared, Windowed, oversampled_for_lines, smooth_length};
use crate::time::kernel::{Stepper, Steps};
use crate::time::structure::Structure;
use jointscope_inference::{dot, each};
use jointscope_linalg::Uniform;
use num_complex::Complex64;
use std::ops::Range;

/// Some of the records as they are compared: how much of each, how finely stepped.
pub(crate) struct View<'a> {
    traces: Vec<Trace<'a>>,
    /// One record of each set-up: those of one set-up are followed by one stepper.
    setups: Vec<&'a Record>,
    focus: Focus<'a>,
}

/// The part of a record that is compared.
struct Trace<'a> {
    record: &'a Record,
    setup: usize,
    /// Force at every step.
    force: Vec<f64>,
    /// Samples as they count, before the transform.
    windowed: Windowed,
    lines: Range<usize>,
    /// √2 over the noise's standard deviation, line by line, a row a response.
    weights: Vec<Vec<f64>>,
    /// Σ|recorded|² in the band, over all responses, for relative errors.
    power: f64,
}

/// How records are compared.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Focus<'a> {
    /// Decay of the window's weight, 1/s; zero for all alike.
    pub decay: f64,
    /// Lines compared.
    pub lines: Compared<'a>,
    /// Steps within a sampling interval.
    pub within: usize,
    /// Halvings of a step with an event.
    pub halvings: usize,
}

/// (simulated − recorded)·weight, trace by trace, real and imaginary parts side by side.
pub(crate) type Residuals = Vec<Vec<f64>>;

/// Derivatives of the residuals.
pub(crate) struct Jacobian {
    /// Trace by trace, a column a coordinate.
    columns: Vec<Vec<Vec<f64>>>,
    /// JᵀJ, row-major.
    pub information: Vec<f64>,
}

impl<'a> View<'a> {
    /// The records, each up to its own end or to where it has died away.
    pub(crate) fn new(records: &[&'a Record], focus: &Focus<'a>, ends: &[usize]) -> Self {
        let mut setups: Vec<&Record> = Vec::new();
        for record in records {
            if !setups.iter().any(|other| other.has_setup_of(record)) {
                setups.push(record);
            }
        }
        let setup = |record: &Record| setups.iter().position(|other| other.has_setup_of(record)).unwrap_or(0);
        let end = |i: usize| ends.get(i).copied().unwrap_or(usize::MAX);
        let numbered: Vec<(usize, &'a Record)> = records.iter().copied().enumerate().collect();
        let traces = each(&numbered, |&(i, record)| Trace::new(record, setup(record), focus, end(i)));
        View { traces, setups, focus: *focus }
    }

    /// The model ready to be stepped, for each set-up.
    fn steppers(&self, hypothesis: &Hypothesis) -> Option<Vec<Stepper>> {
        let fixture = hypothesis.to_fixture().ok()?;
        let structure = Structure::new(&fixture, BEYOND_BAND * self.focus.lines.band.1).ok()?;
        let stepper = |record: &&Record| {
            let load = structure.load(record.struck()).ok()?;
            let system = structure.system(load, &record.readings, &[]).ok()?;
            let Focus { within, halvings, .. } = self.focus;
            Stepper::new(&system, Steps { interval: record.hit.interval(), within, halvings })
        };
        self.setups.iter().map(stepper).collect()
    }

    /// What every response of every record reads in the model, under the recorded force and `disturbance`
    /// times its noise; nothing for a hypothesis without a finite motion.
    pub(crate) fn histories(&self, hypothesis: &Hypothesis, disturbance: f64) -> Option<Vec<Vec<Vec<f64>>>> {
        let steppers = self.steppers(hypothesis)?;
        let history = |trace: &Trace| {
            let hit = &trace.record.hit;
            let noise = disturbance * trace.record.force_noise;
            let disturbed = (disturbance != 0.0).then(|| {
                let noisy = hit.force().iter().zip(white(hit.samples())).map(|(f, one)| f + noise * one);
                oversampled_for_lines(&noisy.collect::<Vec<f64>>(), self.focus.within)
            });
            steppers[trace.setup].run(disturbed.as_ref().unwrap_or(&trace.force), trace.samples())
        };
        Some(each(&self.traces, history))
    }

    /// Number of real values compared.
    pub(crate) fn degrees(&self) -> f64 {
        let weights = self.traces.iter().flat_map(|trace| trace.weights.iter().flatten());
        2.0 * weights.filter(|weight| **weight > 0.0).count() as f64
    }

    /// χ² of the data; `None` for a hypothesis without a finite motion.
    pub(crate) fn chi2(&self, hypothesis: &Hypothesis) -> Option<f64> {
        self.residuals(hypothesis).map(|residuals| sum_of_squares(&residuals))
    }

    /// χ² of the data and the priors.
    pub(crate) fn objective(&self, hypothesis: &Hypothesis) -> Option<f64> {
        self.chi2(hypothesis).map(|chi2| chi2 + hypothesis.squared_departures())
    }

    /// The residuals; `None` for a hypothesis without a finite motion.
    pub(crate) fn residuals(&self, hypothesis: &Hypothesis) -> Option<Residuals> {
        let steppers = self.steppers(hypothesis)?;
        each(&self.traces, |trace| trace.residuals(&steppers)).into_iter().collect()
    }

    /// √(Σ|simulated − recorded|²/Σ|recorded|²) in the band, over all responses.
    pub(crate) fn nrmse(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let residuals = self.residuals(hypothesis)?;
        let (mut difference, mut power) = (0.0, 0.0);
        for (trace, residuals) in self.traces.iter().zip(residuals) {
            let weighted = residuals.chunks_exact(2).zip(trace.weights.iter().flatten());
            let square = |(r, w): (&[f64], &f64)| (r[0] * r[0] + r[1] * r[1]) / (w * w);
            difference += weighted.filter(|(_, w)| **w > 0.0).map(square).sum::<f64>();
            power += trace.power;
        }
        Some((difference / power).sqrt())
    }

    /// Derivatives of the residuals with respect to every coordinate, by differences.
    pub(crate) fn jacobian(&self, hypothesis: &Hypothesis, residuals: &Residuals) -> Option<Jacobian> {
        let count = hypothesis.coordinates.len();
        let steps: Vec<f64> = (0..count).map(|i| hypothesis.difference(i)).collect();
        let moved: Vec<Vec<Stepper>> =
            (0..count).map(|i| self.steppers(&hypothesis.moved(i, steps[i]))).collect::<Option<_>>()?;
        let derivatives = |&(trace, base): &(&Trace, &Vec<f64>)| {
            let column = |i: usize| {
                let mut column = trace.residuals(&moved[i])?;
                let factor = 1.0 / steps[i];
                column.iter_mut().zip(base).for_each(|(c, r)| *c = (*c - r) * factor);
                Some(column)
            };
            (0..count).map(column).collect::<Option<Vec<_>>>()
        };
        let traces: Vec<(&Trace, &Vec<f64>)> = self.traces.iter().zip(residuals).collect();
        let columns: Vec<_> = each(&traces, derivatives).into_iter().collect::<Option<_>>()?;
        let by_trace: Vec<Vec<f64>> = each(&columns, |columns| products(columns));
        let entry = |k: usize| by_trace.iter().map(|one| one[k]).sum();
        let information: Vec<f64> = (0..count * count).map(entry).collect();
        information.iter().all(|e| e.is_finite()).then_some(Jacobian { columns, information })
    }
}

impl Jacobian {
    /// −Jᵀr.
    pub(crate) fn descent(&self, residuals: &Residuals) -> Vec<f64> {
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

/// Products of all pairs of columns, row-major.
pub(crate) fn products(columns: &[Vec<f64>]) -> Vec<f64> {
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

impl<'a> Trace<'a> {
    fn new(record: &'a Record, setup: usize, focus: &Focus, end: usize) -> Self {
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
        let spacing = 1.0 / (samples as f64 * interval);
        let last = ((focus.lines.band.1 / spacing) as usize).min(samples / 2);
        let first = ((focus.lines.band.0 / spacing).ceil() as usize).clamp(1, last.max(1));
        let mut trace = Trace {
            force: oversampled_for_lines(hit.force(), focus.within),
            windowed: Windowed::new((0..samples).map(weight).collect(), interval),
            lines: first..last.max(first) + 1,
            weights: Vec::new(),
            power: 0.0,
            record,
            setup,
        };
        trace.weigh(&focus.lines);
        trace
    }

    fn samples(&self) -> usize {
        self.windowed.window.len()
    }

    /// Noise of a response and, through the FRF that the hit itself shows, of the force; and what no model is
    /// exact to.
    fn weigh(&mut self, compared: &Compared) {
        let energy = self.windowed.power();
        let force = self.spectrum(self.record.hit.force());
        let force_noise = self.record.force_noise.powi(2) * energy;
        let counts: Vec<bool> =
            self.lines.clone().map(|line| compared.has(self.windowed.frequency_hz(line))).collect();
        for (response, noise) in self.record.hit.responses().iter().zip(&self.record.noise) {
            let lines = self.spectrum(&response.values);
            let own = noise * noise * energy;
            let variance = |(y, f): (&Complex64, &Complex64)| {
                let through = if f.norm_sqr() > FORCE_ABOVE_NOISE * force_noise {
                    y.norm_sqr() / f.norm_sqr()
                } else {
                    0.0
                };
                own + through * force_noise + LINE_ERROR * LINE_ERROR * y.norm_sqr()
            };
            let weights = lines.iter().zip(&force).map(variance).map(|v| (2.0 / v).sqrt());
            self.weights
                .push(weights.zip(&counts).map(|(w, counts)| if *counts { w } else { 0.0 }).collect());
            self.power +=
                lines.iter().zip(&counts).filter(|(_, c)| **c).map(|(y, _)| y.norm_sqr()).sum::<f64>();
        }
    }

    fn spectrum(&self, values: &[f64]) -> Vec<Complex64> {
        self.windowed.band(values, &self.lines)
    }

    /// (simulated − recorded)·weight, response after response.
    fn residuals(&self, steppers: &[Stepper]) -> Option<Vec<f64>> {
        let run = steppers[self.setup].run(&self.force, self.samples());
        let mut all = Vec::with_capacity(2 * self.weights.len() * self.lines.len());
        for ((simulated, response), weights) in run.iter().zip(self.record.hit.responses()).zip(&self.weights)
        {
            let difference: Vec<f64> = simulated.iter().zip(&response.values).map(|(s, r)| s - r).collect();
            all.extend(
                self.spectrum(&difference).iter().zip(weights).flat_map(|(d, w)| [d.re * w, d.im * w]),
            );
        }
        all.iter().all(|r| r.is_finite()).then_some(all)
    }
}

/// 1 well before `end`, 0 from there on; half a cosine over the last part of the way from `onset`.
fn fading(sample: usize, onset: usize, end: usize) -> f64 {
    let length = FADING_SHARE * end.saturating_sub(onset) as f64;
    let left = (end.saturating_sub(sample) as f64 / length.max(1.0)).min(1.0);
    0.5 - 0.5 * (std::f64::consts::PI * left).cos()
}

/// White noise of unit variance, the same every time: it asks what the noise of a force may do, and is no
/// draw of it.
fn white(samples: usize) -> impl Iterator<Item = f64> {
    let mut uniform = Uniform::from_state(0x9E37_79B9_7F4A_7C15);
    // The sum of twelve has a variance of one.
    (0..samples).map(move |_| (0..12).map(|_| uniform.next_number() - 0.5).sum())
}

/// Samples until every response has sunk into its noise, with a tenth on top.
fn died_away(record: &Record) -> usize {
    let samples = record.hit.samples();
    let mut last = record.onset + DECAY_BLOCK;
    for (response, noise) in record.hit.responses().iter().zip(&record.noise) {
        for (block, values) in response.values.chunks(DECAY_BLOCK).enumerate() {
            let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
            if square > ABOVE_NOISE * noise * noise {
                last = last.max((block + 1) * DECAY_BLOCK);
            }
        }
    }
    (last + last / 10).min(samples)
}
