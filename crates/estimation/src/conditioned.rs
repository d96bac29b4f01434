//! A hit made ready: hum and baselines off, faults found, windows on, spectra taken.

use jointscope_hits::{Fourier, Hit, MeasuredMotion, Response};
use num_complex::Complex64;

use crate::baseline::Drift;
use crate::decay::left_at_end;
use crate::hum::Hum;
use crate::pulse::Pulse;
use crate::settings::baseline::FEWEST_BEFORE;
use crate::settings::overload::SAME_VALUE;
use crate::settings::pulse::FILTER_RINGING;
use crate::settings::windows::{FORCE_WINDOW_WIDTHS, TAPER_PARTS};
use crate::{Baseline, Fault, ForceWindow, baseline, fault};

/// A hit without hum and baselines, and what was seen in it.
#[derive(Debug, Clone)]
pub(crate) struct Conditioned<'a> {
    pub hit: &'a Hit,
    pub pulse: Option<Pulse>,
    pub faults: Vec<Fault>,
    pub force: Vec<f64>,
    pub responses: Vec<Signal<'a>>,
    /// How the force's baseline drifts.
    pub force_drift: Drift,
}

/// Marks the hits whose force reaches the very value at which another hit's is cut off: one sample at the top
/// of a short blow tells nothing by itself.
pub(crate) fn mark_cut_off_alike(hits: &mut [Conditioned]) {
    let cut_off = |fault: &Fault| match fault {
        Fault::Overload { signal: fault::Signal::Force, at } => Some(*at),
        _ => None,
    };
    let values: Vec<f64> = hits.iter().flat_map(|hit| hit.faults.iter().filter_map(cut_off)).collect();
    for hit in hits.iter_mut().filter(|hit| !hit.faults.iter().any(|fault| cut_off(fault).is_some())) {
        let reaches = |at: &&f64| hit.hit.force().iter().any(|f| (f - **at).abs() <= SAME_VALUE * at.abs());
        let within = |at: &&f64| hit.hit.peak_force() <= (1.0 + SAME_VALUE) * at.abs();
        if let Some(at) = values.iter().find(|at| reaches(at) && within(at)) {
            hit.faults.push(Fault::Overload { signal: fault::Signal::Force, at: *at });
        }
    }
}

/// The same hits with this hum and baselines off.
pub(crate) fn prepared(hits: &[Hit], hum: Option<&Hum>, baseline: Baseline) -> Vec<Hit> {
    let prepared = |Conditioned { hit, force, responses, .. }: Conditioned| {
        let responses =
            responses.into_iter().map(|signal| Response { values: signal.values, ..signal.response.clone() });
        let (number, interval, start) = (hit.number(), hit.interval(), hit.start());
        // As many finite values as before.
        Hit::new(number, interval, start, hit.struck().clone(), force, responses.collect())
            .unwrap_or_else(|_| hit.clone())
    };
    Conditioned::all(hits, hum, baseline).into_iter().map(prepared).collect()
}

/// One response of a hit without hum and baseline.
#[derive(Debug, Clone)]
pub(crate) struct Signal<'a> {
    pub response: &'a Response,
    pub values: Vec<f64>,
    /// How its baseline drifts.
    pub drift: Drift,
    /// Mean square before the hit, where there are samples enough.
    pub before: Option<f64>,
    /// Amplitude left at the record's end, relative to the loudest part.
    pub left: f64,
}

impl<'a> Conditioned<'a> {
    /// All hits of a test, the hum that they have taken off.
    pub(crate) fn all(hits: &'a [Hit], hum: Option<&Hum>, kind: Baseline) -> Vec<Self> {
        let without_hum = |index: usize, signal: usize, values: &[f64]| {
            let mut values = values.to_vec();
            if let Some(hum) = hum {
                hum.take_off(index, signal, &mut values);
            }
            values
        };
        let of = |(index, hit): (usize, &'a Hit)| {
            let responses = hit.responses().iter().enumerate();
            let responses = responses.map(|(i, response)| without_hum(index, i + 1, &response.values));
            Conditioned::of(hit, without_hum(index, 0, hit.force()), responses.collect(), kind)
        };
        hits.iter().enumerate().map(of).collect()
    }

    /// A hit whose signals without hum are `force` and `responses`.
    fn of(hit: &'a Hit, mut force: Vec<f64>, responses: Vec<Vec<f64>>, kind: Baseline) -> Self {
        let force_drift = baseline::remove(&mut force, kind, 0);
        let pulse = Pulse::of(&force);
        let faults = fault::faults(hit, &force, pulse.as_ref());
        let (begin, before) = pulse.map_or((0, 0), |pulse| (pulse.begin, pulse.before()));
        let signal = |(response, mut values): (&'a Response, Vec<f64>)| {
            let drift = baseline::remove(&mut values, kind, before);
            let quiet = &values[..before.min(values.len())];
            let power = quiet.iter().map(|v| v * v).sum::<f64>() / quiet.len().max(1) as f64;
            let before = (quiet.len() >= FEWEST_BEFORE).then_some(power);
            let left = left_at_end(&values, begin, before);
            Signal { response, values, drift, before, left }
        };
        Conditioned {
            hit,
            pulse,
            faults,
            responses: hit.responses().iter().zip(responses).map(signal).collect(),
            force,
            force_drift,
        }
    }

    /// Where the exponential window begins: before the onset, so that it holds all of what a filter makes of
    /// the pulse.
    fn window_begin(&self) -> usize {
        self.pulse.map_or(0, |pulse| pulse.begin.saturating_sub(FILTER_RINGING))
    }

    /// Takes the windowed spectra of the force and of every response, the latter as accelerations.
    ///
    /// The exponential window lies on force and responses alike: e^(−δt) on both turns Y = H·X at s = iω into
    /// the same relation at s = δ + iω, whatever the pulse's length. There an acceleration is s or s² times
    /// the velocity or displacement.
    pub(crate) fn spectra(
        &self,
        transform: &mut Transform,
        force_window: ForceWindow,
        decay: f64,
    ) -> Spectra {
        let interval = self.hit.interval();
        let exponential = |i: usize| self.exponential(i, decay);
        let window = self.force_window(force_window);
        let force = (0..self.force.len()).map(|i| self.force[i] * faded(window, i) * exponential(i));
        let force = transform.of(force);
        let responses = self.responses.iter().map(|signal| {
            let mut spectrum =
                transform.of(signal.values.iter().enumerate().map(|(i, v)| v * exponential(i)));
            let order = match signal.response.motion {
                MeasuredMotion::Acceleration => 0,
                MeasuredMotion::Velocity => 1,
                MeasuredMotion::Displacement => 2,
            };
            if order > 0 {
                let step = std::f64::consts::TAU / (interval * transform.length() as f64);
                let s = |line: usize| Complex64::new(decay, step * line as f64);
                spectrum.iter_mut().enumerate().for_each(|(line, value)| *value *= s(line).powi(order));
            }
            spectrum
        });
        let responses = responses.collect();
        Spectra { force, responses }
    }

    /// Last sample of the force window's flat part and samples of its taper.
    fn force_window(&self, window: ForceWindow) -> Option<(usize, usize)> {
        let pulse = self.pulse?;
        let flat = match window {
            ForceWindow::None => return None,
            ForceWindow::Auto => (pulse.end - pulse.begin) * FORCE_WINDOW_WIDTHS,
            ForceWindow::Length(seconds) => (seconds / self.hit.interval()).round() as usize,
        };
        // Beyond the record's end nothing is left to window.
        let flat = flat.min(self.force.len());
        Some((pulse.begin + flat, (flat / TAPER_PARTS).max(1)))
    }

    /// Exponential window of a decay, 1/s, at a sample.
    fn exponential(&self, i: usize, decay: f64) -> f64 {
        match i.checked_sub(self.window_begin()) {
            Some(after) if decay > 0.0 => (-decay * self.hit.interval() * after as f64).exp(),
            _ => 1.0,
        }
    }

    /// Power that the force's noise adds to every line of its spectrum under these windows, N².
    pub(crate) fn force_noise(&self, window: ForceWindow, decay: f64) -> f64 {
        let deviation = self.pulse.map_or(0.0, |pulse| pulse.noise);
        let window = self.force_window(window);
        let passed = (0..self.force.len()).map(|i| (faded(window, i) * self.exponential(i, decay)).powi(2));
        deviation * deviation * passed.sum::<f64>()
    }
}

/// The force window, which has its flat part's last sample and the samples of its taper, at a sample.
fn faded(window: Option<(usize, usize)>, i: usize) -> f64 {
    window.map_or(1.0, |(end, taper)| one_then_cosine(i, end, taper))
}

/// 1 up to `end`, then half a cosine over `taper` samples down to 0.
fn one_then_cosine(i: usize, end: usize, taper: usize) -> f64 {
    match i.checked_sub(end) {
        None => 1.0,
        Some(over) if over >= taper => 0.0,
        Some(over) => 0.5 + 0.5 * (std::f64::consts::PI * over as f64 / taper as f64).cos(),
    }
}

/// Spectra of one hit's signals, Σ x e^(−iωt) without the interval: their ratios are FRFs.
#[derive(Debug, Clone)]
pub(crate) struct Spectra {
    pub force: Vec<Complex64>,
    pub responses: Vec<Vec<Complex64>>,
}

/// Fourier transforms of one length.
pub(crate) struct Transform {
    fourier: Fourier,
    input: Vec<f64>,
}

impl Transform {
    /// Transforms of records filled with zeros to `length` samples.
    pub(crate) fn new(length: usize) -> Self {
        let fourier = Fourier::new(length);
        Transform { input: vec![0.0; fourier.length()], fourier }
    }

    pub(crate) fn length(&self) -> usize {
        self.input.len()
    }

    fn of(&mut self, values: impl Iterator<Item = f64>) -> Vec<Complex64> {
        self.input.fill(0.0);
        self.input.iter_mut().zip(values).for_each(|(to, value)| *to = value);
        self.fourier.lines(&mut self.input)
    }
}
