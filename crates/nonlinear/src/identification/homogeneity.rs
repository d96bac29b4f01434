//! The test of homogeneity: do FRFs change with the strength of the hits beyond noise?
//!
//! No model of the structure enters. Force and response are multiplied by e^{−at}, which moves the spectra of both to s = a + iω: for a linear
//! structure Y = H(s)·F holds exactly, whatever still rings at the end of the record. Per line one H for all hits at
//! a point is compared with one H a level; what the levels gain is measured by the scatter of hits alike.

use super::records::Record;
use super::spectra::Transform;
use crate::distribution::{chi_squared_tail, f_tail};
use jointscope_spectra::Channel;
use num_complex::Complex64;

/// What the comparison of levels came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Homogeneity {
    /// Probability of a difference as large by chance, of a linear structure.
    pub p_value: f64,
    /// How much FRFs of different levels differ, against their noise: near 1 for a linear structure.
    pub ratio: f64,
    /// Band in Hz in which they differ the most.
    pub band: (f64, f64),
    /// Levels compared: peak force in N, from the weakest, with the number of hits.
    pub levels: Vec<(f64, usize)>,
    /// Whether the noise was measured by hits alike; without, by the ends of the records.
    pub from_repeats: bool,
}

/// p-value below which FRFs are said to change with level.
pub const CHANGED: f64 = 2e-3;

/// e^{−aT} of the window over the record.
const WINDOW: f64 = 10.0;
/// Error of every spectral value relative to itself, beside its noise: what sampling and the end of the record leave of a hit's exact instant. It is
/// alike on many lines, and no difference as small tells anything of a joint.
const INEXACT: f64 = 3e-3;
/// Force lines below this share of the strongest are left out.
const WEAK: f64 = 0.03;
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
        if self.within_degrees < 8.0 {
            let degrees = share * self.between_degrees;
            return (between, chi_squared_tail(between * degrees / NOISE_DOUBT, degrees));
        }
        // Hits alike may scatter more than their noise says, but not less.
        let within = (self.within / self.within_degrees).max(1.0);
        let ratio = between / within;
        (ratio, f_tail(ratio, share * self.between_degrees, share * self.within_degrees))
    }
}

/// How far the noise at a record's end may be from that of all of it.
const NOISE_DOUBT: f64 = 1.25;

pub(crate) fn homogeneity(records: &[Record], highest_hz: f64) -> Homogeneity {
    let mut bands = [Sums::default(); BANDS];
    let mut share: f64 = 1.0;
    let mut struck: Vec<&Channel> = records.iter().map(Record::struck).collect();
    struck.sort();
    struck.dedup();
    for channel in struck {
        let group: Vec<&Record> = records.iter().filter(|r| r.struck() == channel).collect();
        let Some(first) = group.first() else { continue };
        let samples = group.iter().map(|r| r.hit.samples()).min().unwrap_or(0);
        let decay = WINDOW / (samples as f64 * first.hit.interval());
        let windowed = Windowed::new(samples, first.hit.interval(), decay);
        share = share.min(windowed.independent);
        for reading in &first.readings {
            let columns: Vec<(&Record, usize)> = group
                .iter()
                .filter(|r| (r.hit.interval() - first.hit.interval()).abs() < 1e-9 * first.hit.interval())
                .filter_map(|r| r.readings.iter().position(|other| other == reading).map(|c| (*r, c)))
                .collect();
            windowed.compare(&columns, highest_hz, &mut bands);
        }
    }
    let mut all = Sums::default();
    bands.iter().for_each(|band| all.add(band));
    let (ratio, mut p_value) = all.judged(share);
    let (mut best, mut worst) = (0, f64::INFINITY);
    for (b, sums) in bands.iter().enumerate() {
        let (_, p) = sums.judged(share);
        if p < worst {
            (best, worst) = (b, p);
        }
    }
    // All lines together and each band were looked at.
    p_value = ((BANDS + 1) as f64 * p_value.min(worst)).min(1.0);
    let edge = |b: usize| highest_hz * b as f64 / BANDS as f64;
    Homogeneity {
        p_value,
        ratio,
        band: (edge(best), edge(best + 1)),
        levels: levels(records),
        from_repeats: all.within_degrees >= 8.0,
    }
}

fn levels(records: &[Record]) -> Vec<(f64, usize)> {
    let count = records.iter().map(|r| r.level + 1).max().unwrap_or(0);
    let of = |level: usize| {
        let peaks: Vec<f64> =
            records.iter().filter(|r| r.level == level).map(|r| r.hit.peak_force()).collect();
        (peaks.iter().sum::<f64>() / peaks.len().max(1) as f64, peaks.len())
    };
    (0..count).map(of).collect()
}

/// Signals of one length under one window.
struct Windowed {
    window: Vec<f64>,
    power: f64,
    transform: Transform,
    spacing_hz: f64,
    /// Share of the lines that are independent.
    independent: f64,
}

impl Windowed {
    fn new(samples: usize, interval: f64, decay: f64) -> Self {
        let window: Vec<f64> = (0..samples).map(|i| (-decay * interval * i as f64).exp()).collect();
        let power: f64 = window.iter().map(|w| w * w).sum();
        let fourth: f64 = window.iter().map(|w| w.powi(4)).sum();
        Windowed {
            transform: Transform::new(samples),
            spacing_hz: 1.0 / (samples as f64 * interval),
            independent: power * power / (samples as f64 * fourth),
            window,
            power,
        }
    }

    fn spectrum(&self, values: &[f64]) -> Vec<Complex64> {
        let mut windowed: Vec<f64> = values.iter().zip(&self.window).map(|(v, w)| v * w).collect();
        self.transform.of(&mut windowed)
    }

    fn compare(&self, columns: &[(&Record, usize)], highest_hz: f64, bands: &mut [Sums; BANDS]) {
        let levels = columns.iter().map(|(r, _)| r.level + 1).max().unwrap_or(0);
        if levels < 2 {
            return;
        }
        let forces: Vec<Vec<Complex64>> = columns.iter().map(|(r, _)| self.spectrum(r.hit.force())).collect();
        let responses: Vec<Vec<Complex64>> =
            columns.iter().map(|(r, c)| self.spectrum(&r.hit.responses()[*c].values)).collect();
        let strongest: Vec<f64> =
            forces.iter().map(|f| f.iter().map(|line| line.norm()).fold(0.0, f64::max)).collect();
        let last = ((highest_hz / self.spacing_hz) as usize).min(forces[0].len().saturating_sub(1));
        for line in 2..=last {
            let usable: Vec<usize> =
                (0..columns.len()).filter(|&i| forces[i][line].norm() > WEAK * strongest[i]).collect();
            let band = ((line as f64 * self.spacing_hz / highest_hz * BANDS as f64) as usize).min(BANDS - 1);
            let lines: Vec<(usize, Complex64, Complex64)> =
                usable.iter().map(|&i| (i, forces[i][line], responses[i][line])).collect();
            if let Some(sums) = self.line(columns, &lines, levels) {
                bands[band].add(&sums);
            }
        }
    }

    /// One line: χ² of one H for all hits beyond that of one H a level, and the latter.
    fn line(
        &self,
        columns: &[(&Record, usize)],
        lines: &[(usize, Complex64, Complex64)],
        levels: usize,
    ) -> Option<Sums> {
        let mut gain = 0.0;
        // The noise of the force counts through H, which is known well enough from the unweighted ratio.
        let (cross, force) = lines.iter().fold((Complex64::ZERO, 0.0), |(cross, force), (_, f, y)| {
            (cross + y * f.conj() / f.norm_sqr(), force + 1.0)
        });
        if force > 0.0 {
            gain = (cross / force).norm_sqr();
        }
        let weights: Vec<f64> = lines
            .iter()
            .map(|(i, _, y)| {
                let (record, channel) = columns[*i];
                let noise = record.noise[channel].powi(2) + gain * record.force_noise.powi(2);
                2.0 / (noise * self.power + INEXACT * INEXACT * y.norm_sqr())
            })
            .collect();
        let fitted = |level: Option<usize>| {
            let (mut cross, mut force, mut square, mut count) = (Complex64::ZERO, 0.0, 0.0, 0usize);
            for ((i, f, y), w) in lines.iter().zip(&weights) {
                if level.is_none_or(|level| columns[*i].0.level == level) {
                    cross += *w * y * f.conj();
                    force += w * f.norm_sqr();
                    square += w * y.norm_sqr();
                    count += 1;
                }
            }
            (if count > 0 { square - cross.norm_sqr() / force } else { 0.0 }, count)
        };
        let (together, count) = fitted(None);
        let mut sums = Sums::default();
        let mut present = 0;
        for level in 0..levels {
            let (chi2, hits) = fitted(Some(level));
            sums.within += chi2;
            present += usize::from(hits > 0);
        }
        if present < 2 || !together.is_finite() {
            return None;
        }
        sums.between = (together - sums.within).max(0.0);
        sums.between_degrees = 2.0 * (present - 1) as f64;
        sums.within_degrees = 2.0 * (count - present) as f64;
        Some(sums)
    }
}
