//! Mains hum in the signals of hits, and its removal.
//!
//! Hum is told from the structure's ringing by cause and effect: it is there before the blow. What the quiet
//! end of a record shows at the mains' frequency and its multiples is continued back to the samples before
//! the blow; where it explains them it is hum, whatever mode lies beside it, and is taken off the whole
//! record. What repeats itself with every blow, as strong as the blow and at the same time after it, is the
//! structure's answer all the same: a record may be a period of a periodic one.
//!
//! Left in, hum is spread by a window over the lines about it, and its phase, which differs from hit to hit,
//! passes for a structure that changes with the strength of the blow.

use std::f64::consts::{PI, TAU};

use jointscope_hits::{Fourier, Hit};
use jointscope_spectra::Channel;
use num_complex::Complex64;

use crate::pulse::Pulse;
use crate::settings::baseline::FEWEST_BEFORE;
use crate::settings::hum::{
    ASIDE, BELOW_FILTER, EXPLAINS, FEWEST_PERIODS_AFTER, FINER, HARMONICS, HIGHEST_HZ, LEAST_BEFORE_S,
    MAINS_HZ, PADDING, SAME_AFTER_BLOW, STANDS_OUT, STEPS_IN_LINE, WANDERS,
};
use crate::{Baseline, Signal, baseline};

/// Hum of a test's hits: one frequency of the mains, phases of their own in every signal.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hum {
    /// The mains' frequency, Hz.
    pub hz: f64,
    /// Signals that have it, and the largest share of their peak that it is.
    pub signals: Vec<(Signal, f64)>,
    /// Tones of each signal of each hit, the force first.
    tones: Vec<Vec<Vec<Tone>>>,
}

/// A sinusoid Re(a·e^(iωt)), t from the middle of a record's end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tone {
    /// Radians a sample.
    step: f64,
    /// The sample at which t is zero.
    middle: f64,
    amplitude: Complex64,
}

impl Tone {
    fn at(&self, sample: usize) -> f64 {
        (self.amplitude * Complex64::cis(self.step * (sample as f64 - self.middle))).re
    }
}

impl Hum {
    /// The hum of all hits; `None` where no signal has any that shows before the blow.
    pub(crate) fn of(hits: &[Hit]) -> Option<Self> {
        let traces: Vec<Trace> = hits.iter().enumerate().flat_map(|(i, hit)| Trace::all(i, hit)).collect();
        if traces.is_empty() {
            return None;
        }
        let endings: Vec<Ending> = traces.iter().map(Ending::of).collect();
        let finest = endings.iter().map(|ending| ending.resolution).fold(f64::INFINITY, f64::min);
        let best = |all: &mut dyn Iterator<Item = f64>| {
            let found = all.map(|hz| Found::at(hz, &traces, &endings));
            found.max_by(|a, b| a.explained.total_cmp(&b.explained))
        };
        let step = finest / STEPS_IN_LINE;
        let coarse = best(&mut MAINS_HZ.iter().flat_map(|mains| {
            let steps = (WANDERS * mains / step).ceil() as i32;
            (-steps..=steps).map(move |i| mains + f64::from(i) * step)
        }))?;
        let fine = step / FINER;
        let found = best(&mut (-(FINER as i32)..=FINER as i32).map(|i| coarse.hz + f64::from(i) * fine))?;
        if found.tones.iter().all(Vec::is_empty) {
            return None;
        }
        let mut tones: Vec<Vec<Vec<Tone>>> =
            hits.iter().map(|hit| vec![Vec::new(); hit.responses().len() + 1]).collect();
        let mut signals: Vec<(Signal, f64)> = Vec::new();
        for (trace, own) in traces.iter().zip(found.tones) {
            if own.is_empty() {
                continue;
            }
            let amplitude = own.iter().map(|tone| tone.amplitude.norm_sqr()).sum::<f64>().sqrt();
            let share = amplitude / trace.values.iter().map(|v| v.abs()).fold(f64::MIN_POSITIVE, f64::max);
            match signals.iter_mut().find(|(signal, _)| *signal == trace.signal) {
                Some((_, most)) => *most = most.max(share),
                None => signals.push((trace.signal.clone(), share)),
            }
            tones[trace.hit][trace.index] = own;
        }
        Some(Hum { hz: found.hz, signals, tones })
    }

    /// Takes it off a signal of a hit, of which the force is number 0.
    pub(crate) fn take_off(&self, hit: usize, signal: usize, values: &mut [f64]) {
        for tone in self.tones.get(hit).and_then(|signals| signals.get(signal)).into_iter().flatten() {
            values.iter_mut().enumerate().for_each(|(i, value)| *value -= tone.at(i));
        }
    }
}

/// A signal with enough samples on both sides of the blow.
struct Trace<'a> {
    hit: usize,
    index: usize,
    signal: Signal,
    values: &'a [f64],
    interval: f64,
    /// Point of the blow, and its largest force.
    struck: &'a Channel,
    peak: f64,
    /// First sample of the blow.
    onset: usize,
    /// Samples before the blow.
    before: usize,
    /// First sample of the quiet end.
    tail: usize,
}

impl<'a> Trace<'a> {
    fn all(number: usize, hit: &'a Hit) -> Vec<Self> {
        let mut force = hit.force().to_vec();
        baseline::remove(&mut force, Baseline::Offset, 0);
        let Some(pulse) = Pulse::of(&force) else { return Vec::new() };
        let (before, samples, interval) = (pulse.before(), hit.samples(), hit.interval());
        let tail = (samples / 2).max(pulse.end);
        let after_s = (samples - tail) as f64 * interval;
        if before < FEWEST_BEFORE
            || before as f64 * interval < LEAST_BEFORE_S
            || after_s * MAINS_HZ[0] < FEWEST_PERIODS_AFTER
        {
            return Vec::new();
        }
        let (struck, peak, onset) = (hit.struck(), pulse.peak, pulse.begin);
        let trace = |index, signal, values| Trace {
            hit: number,
            index,
            signal,
            values,
            interval,
            struck,
            peak,
            onset,
            before,
            tail,
        };
        let responses = hit.responses().iter().enumerate().map(|(i, response)| {
            trace(i + 1, Signal::Response(response.channel.clone()), response.values.as_slice())
        });
        std::iter::once(trace(0, Signal::Force, hit.force())).chain(responses).collect()
    }
}

fn about_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| value - mean).collect()
}

/// The end of a signal under a Hann window, on lines much closer than its length resolves.
struct Ending {
    lines: Vec<Complex64>,
    /// Hz.
    line_spacing: f64,
    /// What its length resolves, Hz.
    resolution: f64,
    /// Sampling interval, s.
    interval: f64,
    /// Its middle, in samples from the record's first.
    middle: f64,
    /// Samples before the blow, about their mean.
    quiet: Vec<f64>,
}

impl Ending {
    fn of(trace: &Trace) -> Self {
        let mut tail = about_mean(&trace.values[trace.tail..]);
        let length = tail.len();
        let hann = |i: usize| (PI * (i as f64 + 0.5) / length as f64).sin().powi(2);
        tail.iter_mut().enumerate().for_each(|(i, value)| *value *= hann(i));
        tail.resize(PADDING * length, 0.0);
        let mut lines = Fourier::new(tail.len()).lines(&mut tail);
        let resolution = 1.0 / (length as f64 * trace.interval);
        let line_spacing = resolution / PADDING as f64;
        lines.truncate(((HIGHEST_HZ + ASIDE[ASIDE.len() - 1] * resolution) / line_spacing) as usize + 2);
        // A tone of amplitude 1 comes to half the sum of the window, seen from its middle.
        let (unit, half) = (0.25 * length as f64, 0.5 * (length - 1) as f64);
        for (line, value) in lines.iter_mut().enumerate() {
            let turn = TAU * line as f64 * half / (PADDING * length) as f64;
            *value *= Complex64::cis(turn) / unit;
        }
        let middle = trace.tail as f64 + half;
        let quiet = about_mean(&trace.values[..trace.before]);
        Ending { lines, line_spacing, resolution, interval: trace.interval, middle, quiet }
    }

    /// Complex amplitude of a tone at `hz`.
    fn amplitude(&self, hz: f64) -> Complex64 {
        let line = (hz / self.line_spacing).round();
        // What the Hann window lets pass so far beside a line.
        let off = (hz / self.line_spacing - line) / PADDING as f64;
        let passed = if off == 0.0 { 1.0 } else { (PI * off).sin() / (PI * off) / (1.0 - off * off) };
        self.lines.get(line as usize).copied().unwrap_or_default() / passed
    }

    /// The tone at `hz`, where it stands out of what lies beside it.
    fn tone(&self, hz: f64) -> Option<Tone> {
        if hz * self.interval > BELOW_FILTER {
            return None;
        }
        let amplitude = self.amplitude(hz);
        let beside = |lines: &f64| {
            let aside = lines * self.resolution;
            self.amplitude(hz - aside).norm().max(self.amplitude(hz + aside).norm())
        };
        let floor = ASIDE.iter().map(beside).fold(0.0, f64::max);
        let (step, middle) = (TAU * hz * self.interval, self.middle);
        (amplitude.norm() > STANDS_OUT * floor).then_some(Tone { step, middle, amplitude })
    }
}

/// What one frequency of the mains comes to.
struct Found {
    hz: f64,
    /// By how much it makes what was recorded before the blows more probable, in logarithms.
    explained: f64,
    /// Tones of each trace.
    tones: Vec<Vec<Tone>>,
}

impl Found {
    fn at(hz: f64, traces: &[Trace], endings: &[Ending]) -> Self {
        let mut found = Found { hz, explained: 0.0, tones: vec![Vec::new(); traces.len()] };
        let mut signals: Vec<&Signal> = traces.iter().map(|trace| &trace.signal).collect();
        signals.sort();
        signals.dedup();
        for signal in signals {
            let own: Vec<usize> = (0..traces.len()).filter(|i| traces[*i].signal == *signal).collect();
            let mut left: Vec<Vec<f64>> = own.iter().map(|i| endings[*i].quiet.clone()).collect();
            // One multiple after the other, in all hits together.
            for k in 1..=HARMONICS {
                let mut explained = 0.0;
                let mut without = Vec::new();
                for (place, &i) in own.iter().enumerate() {
                    let Some(tone) = endings[i].tone(k as f64 * hz) else { continue };
                    let quiet = &left[place];
                    let rest: Vec<f64> = quiet.iter().enumerate().map(|(n, v)| v - tone.at(n)).collect();
                    let rest = about_mean(&rest);
                    explained += 0.5 * quiet.len() as f64 * (square(quiet) / square(&rest)).ln();
                    without.push((place, tone, rest));
                }
                let blows = without.iter().map(|(place, tone, _)| (&traces[own[*place]], *tone));
                if explained > EXPLAINS && !repeats(&blows.collect::<Vec<_>>()) {
                    found.explained += explained;
                    for (place, tone, rest) in without {
                        found.tones[own[place]].push(tone);
                        left[place] = rest;
                    }
                }
            }
        }
        found
    }
}

/// Whether a tone of one signal is the same after every blow at a point, as a multiple of its force: where at
/// some point there is more than one blow, and so at every such point.
fn repeats(blows: &[(&Trace, Tone)]) -> bool {
    let after_blow = |(trace, tone): &(&Trace, Tone)| {
        tone.amplitude * Complex64::cis(tone.step * (trace.onset as f64 - tone.middle)) / trace.peak
    };
    let mut points: Vec<&Channel> = blows.iter().map(|(trace, _)| trace.struck).collect();
    points.sort();
    points.dedup();
    let groups = points.into_iter().map(|point| {
        let own = blows.iter().filter(|(trace, _)| trace.struck == point);
        own.map(after_blow).collect::<Vec<Complex64>>()
    });
    let groups: Vec<Vec<Complex64>> = groups.filter(|group| group.len() > 1).collect();
    let is_one = |group: &Vec<Complex64>| {
        let mean = group.iter().sum::<Complex64>() / group.len() as f64;
        group.iter().all(|of_blow| (of_blow - mean).norm() < SAME_AFTER_BLOW * mean.norm())
    };
    !groups.is_empty() && groups.iter().all(is_one)
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum()
}
