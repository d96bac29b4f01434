//! The test of homogeneity: do FRFs change with the strength of the hits beyond noise?
//!
//! No model of the structure enters. Force and response are multiplied by e^{−at}, which moves the spectra of
//! both to s = a + iω: for a linear structure Y = H(s)·F holds exactly, whatever still rings at the end of
//! the record. Per line one H for all hits at a point is compared with one H a level; what the levels gain is
//! measured by the scatter of hits alike.

use super::records::{Record, struck_channels};
use crate::settings::homogeneity::{
    BLOCKS_AROUND, FEWEST_WITHIN, INDEPENDENT_IN_BLOCK, NOISE_DOUBT, SAMPLING_ERROR, WEAK_FORCE, WINDOW,
};
use crate::spectra::{Compared, Windowed};
use jointscope_inference::{chi_squared_above, fisher_above};
use num_complex::Complex64;
use serde::Serialize;
use std::collections::BTreeSet;

/// What the comparison of levels came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Homogeneity {
    /// Probability of a difference as large by chance, of a linear structure.
    pub p_value: f64,
    /// How much FRFs of different levels differ, against their noise: near 1 for a linear structure.
    #[serde(rename = "variance_ratio")]
    pub ratio: f64,
    /// Band in Hz in which they differ the most.
    #[serde(rename = "most_in_band")]
    pub band: (f64, f64),
    /// Whether the noise was measured by hits alike; without, by the ends of the records.
    #[serde(rename = "noise_from_repeats")]
    pub from_repeats: bool,
    /// Levels compared, from the weakest.
    pub levels: Vec<HitLevel>,
}

/// Hits of about one strength.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HitLevel {
    /// Mean peak force, N.
    pub peak_force: f64,
    /// Number of hits.
    pub hits: usize,
}

/// Bands in which the levels are compared, beside all lines together.
const BANDS: usize = 12;

/// χ² between and within levels of some lines.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    between: f64,
    within: f64,
    between_degrees: f64,
    within_degrees: f64,
}

impl Sums {
    fn of(all: &[Sums]) -> Self {
        let mut sum = Sums::default();
        all.iter().for_each(|own| sum.add(own));
        sum
    }

    fn add(&mut self, other: &Sums) {
        self.between += other.between;
        self.within += other.within;
        self.between_degrees += other.between_degrees;
        self.within_degrees += other.within_degrees;
    }

    /// Ratio of variances and its probability by chance, `share` of the degrees of freedom being independent.
    fn judged(&self, share: f64) -> (f64, f64) {
        if self.between_degrees == 0.0 {
            return (1.0, 1.0);
        }
        let between = self.between / self.between_degrees;
        if self.within_degrees < FEWEST_WITHIN {
            let degrees = share * self.between_degrees;
            return (between, chi_squared_above(between * degrees / NOISE_DOUBT, degrees));
        }
        // Hits alike may scatter more than their noise says, but not less.
        let within = (self.within / self.within_degrees).max(1.0);
        let ratio = between / within;
        (ratio, fisher_above(ratio, share * self.between_degrees, share * self.within_degrees))
    }
}

/// What hits tell of every band, and of how many of their lines are independent.
#[derive(Debug, Clone, Copy, Default)]
struct Told {
    bands: [Sums; BANDS],
    /// How far scatter differs from block to block of lines, against what independent lines make, summed.
    spread: f64,
    blocks: f64,
}

impl Told {
    fn add(&mut self, other: &Told) {
        self.bands.iter_mut().zip(&other.bands).for_each(|(own, other)| own.add(other));
        self.spread += other.spread;
        self.blocks += other.blocks;
    }

    /// Share of the lines that are independent, as the scatter shows it; one where it shows nothing.
    fn independent(&self) -> f64 {
        if self.blocks == 0.0 { 1.0 } else { (self.blocks / self.spread).min(1.0) }
    }
}

pub(crate) fn homogeneity(records: &[Record], lines: Compared) -> Homogeneity {
    let highest_hz = lines.band.1;
    let mut told = Told::default();
    let mut share: f64 = 1.0;
    for channel in struck_channels(records) {
        let group: Vec<&Record> = records.iter().filter(|r| *r.struck() == channel).collect();
        let Some(first) = group.first() else { continue };
        let samples = group.iter().map(|r| r.hit.samples()).min().unwrap_or(0);
        let comparison = Comparison::new(samples, first.hit.interval(), lines);
        share = share.min(comparison.independent);
        let alike =
            |r: &&Record| (r.hit.interval() - first.hit.interval()).abs() < 1e-9 * first.hit.interval();
        for reading in &first.readings {
            let column = |r: &Record| r.readings.iter().position(|other| other == reading);
            let alike = group.iter().copied().filter(alike);
            let signals: Vec<Signal> = alike.filter_map(|r| Some(comparison.signal(r, column(r)?))).collect();
            told.add(&comparison.told(&signals));
        }
    }
    let share = share.min(told.independent());
    let (bands, all) = (told.bands, Sums::of(&told.bands));
    let (ratio, p_value) = all.judged(share);
    let by_band = bands.iter().map(|sums| sums.judged(share).1).enumerate();
    let (most, least_p) = by_band.fold(
        (0, f64::INFINITY),
        |(most, least), (b, p)| {
            if p < least { (b, p) } else { (most, least) }
        },
    );
    let edge = |b: usize| highest_hz * b as f64 / BANDS as f64;
    Homogeneity {
        // All lines together and each band were looked at.
        p_value: ((BANDS + 1) as f64 * p_value.min(least_p)).min(1.0),
        ratio,
        band: (edge(most), edge(most + 1)),
        levels: levels(records),
        from_repeats: all.within_degrees >= FEWEST_WITHIN,
    }
}

fn levels(records: &[Record]) -> Vec<HitLevel> {
    let count = records.iter().map(|r| r.level + 1).max().unwrap_or(0);
    let of = |level: usize| {
        let peaks: Vec<f64> =
            records.iter().filter(|r| r.level == level).map(|r| r.hit.peak_force()).collect();
        HitLevel { peak_force: peaks.iter().sum::<f64>() / peaks.len().max(1) as f64, hits: peaks.len() }
    };
    (0..count).map(of).collect()
}

/// Force and response of one hit, line by line.
struct Signal<'a> {
    record: &'a Record,
    force: Vec<Complex64>,
    response: Vec<Complex64>,
    /// Variance of the response's noise in a sample.
    variance: f64,
    /// Magnitude of the force below which a line is left out.
    weakest: f64,
}

/// Hits at one point under one window.
struct Comparison<'a> {
    windowed: Windowed,
    power: f64,
    /// Share of the lines that are independent.
    independent: f64,
    compared: Compared<'a>,
}

impl<'a> Comparison<'a> {
    fn new(samples: usize, interval: f64, compared: Compared<'a>) -> Self {
        let decay = WINDOW / (samples as f64 * interval);
        let window = (0..samples).map(|i| (-decay * interval * i as f64).exp()).collect();
        let windowed = Windowed::new(window, interval);
        let power = windowed.power();
        let fourth: f64 = windowed.window.iter().map(|w| w.powi(4)).sum();
        Comparison { power, independent: power * power / (samples as f64 * fourth), windowed, compared }
    }

    fn signal<'r>(&self, record: &'r Record, column: usize) -> Signal<'r> {
        let force = self.windowed.lines(record.hit.force());
        let strongest = force.iter().map(|line| line.norm()).fold(0.0, f64::max);
        let response = self.windowed.lines(&record.hit.responses()[column].values);
        let variance = record.noise[column].powi(2);
        Signal { record, force, response, variance, weakest: WEAK_FORCE * strongest }
    }

    /// What these hits tell of every band. Nothing says that the noise is what the end of a record shows: under
    /// an exponential window it dies away with the signal, and a preamplifier's is not white. So lines count
    /// by the scatter of hits alike on the lines around them, where that is more than their noise.
    fn told(&self, signals: &[Signal]) -> Told {
        let mut told = Told::default();
        let count = signals.iter().map(|s| s.force.len()).min().unwrap_or(0);
        let highest_hz = self.compared.band.1;
        let within = |line: &usize| self.windowed.frequency_hz(*line) <= highest_hz;
        let of_line = |line: usize| {
            if !self.compared.has(self.windowed.frequency_hz(line)) {
                return Sums::default();
            }
            let used: Vec<&Signal> = signals.iter().filter(|s| s.force[line].norm() > s.weakest).collect();
            self.line(&used, line).unwrap_or_default()
        };
        let lines: Vec<Sums> = (2..count).take_while(within).map(of_line).collect();
        let length = (INDEPENDENT_IN_BLOCK / self.independent).ceil() as usize;
        let blocks: Vec<Sums> = lines.chunks(length).map(Sums::of).collect();
        for (index, block) in blocks.iter().enumerate() {
            let around = index.saturating_sub(BLOCKS_AROUND)..(index + BLOCKS_AROUND + 1).min(blocks.len());
            let around = Sums::of(&blocks[around]);
            let enough = self.independent * around.within_degrees >= FEWEST_WITHIN;
            let scatter = if enough { around.within / around.within_degrees } else { 1.0 };
            let times = scatter.max(1.0);
            if enough && block.within_degrees > 0.0 && scatter > 0.0 {
                let own = block.within / block.within_degrees / scatter;
                told.spread += (own - 1.0).powi(2) * block.within_degrees / 2.0;
                told.blocks += 1.0;
            }
            for (line, sums) in lines.iter().enumerate().skip(index * length).take(length) {
                let part = self.windowed.frequency_hz(line + 2) / highest_hz;
                let band = ((part * BANDS as f64) as usize).min(BANDS - 1);
                let scaled = Sums { between: sums.between / times, within: sums.within / times, ..*sums };
                told.bands[band].add(&scaled);
            }
        }
        told
    }

    /// One line: χ² of one H for all hits beyond that of one H a level, and the latter.
    fn line(&self, signals: &[&Signal], line: usize) -> Option<Sums> {
        // The noise of the force counts through H, which is known well enough from the unweighted ratio.
        let ratio = |s: &&Signal| s.response[line] * s.force[line].conj() / s.force[line].norm_sqr();
        let gain = match signals.len() {
            0 => 0.0,
            count => (signals.iter().map(ratio).sum::<Complex64>() / count as f64).norm_sqr(),
        };
        let weight = |s: &Signal| {
            let noise = s.variance + gain * s.record.force_noise.powi(2);
            2.0 / (noise * self.power + SAMPLING_ERROR * SAMPLING_ERROR * s.response[line].norm_sqr())
        };
        let misfit = |level: Option<usize>| {
            let (mut cross, mut force, mut square, mut count) = (Complex64::ZERO, 0.0, 0.0, 0usize);
            for s in signals.iter().filter(|s| level.is_none_or(|level| s.record.level == level)) {
                let (f, y, w) = (s.force[line], s.response[line], weight(s));
                cross += w * y * f.conj();
                force += w * f.norm_sqr();
                square += w * y.norm_sqr();
                count += 1;
            }
            (if count > 0 { square - cross.norm_sqr() / force } else { 0.0 }, count)
        };
        let (together, count) = misfit(None);
        let levels: BTreeSet<usize> = signals.iter().map(|s| s.record.level).collect();
        if levels.len() < 2 || !together.is_finite() {
            return None;
        }
        let within: f64 = levels.iter().map(|level| misfit(Some(*level)).0).sum();
        Some(Sums {
            within,
            between: (together - within).max(0.0),
            between_degrees: 2.0 * (levels.len() - 1) as f64,
            within_degrees: 2.0 * (count - levels.len()) as f64,
        })
    }
}
