//! How it is found what a reader of the FRFs should know.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_spectra::{Channel, FrfPair, FrfSet};

use crate::band::dips;
use crate::baseline::Drift;
use crate::conditioned::Conditioned;
use crate::hum::Hum;
use crate::plausibility::implausible;
use crate::settings::remarks::{
    BIASED, DISAGREE, DRIFT_OF_FIRST_LINE, DRIFTS, LEFT_UNNOTICED, PULSE, RINGS_BEFORE, RINGS_OVER_QUIETEST,
};
use crate::{Baseline, EstimateOptions, Estimator, Excitation, HitReport, Remark, Signal};

/// Remarks, in the order in which they were found.
#[derive(Debug, Default)]
pub(crate) struct Remarks {
    pub all: Vec<Remark>,
    /// Largest ratio of the hits' noise, and whether it was left unweighed.
    noise_ratio: f64,
    is_plain: bool,
    /// FRFs whose hits scatter beyond their noise, and by how much at the most.
    scatter: Vec<FrfPair>,
    worst_scatter: f64,
}

impl Remarks {
    pub(crate) fn of_hits(
        all: &[Conditioned],
        reports: &[HitReport],
        options: &EstimateOptions,
        decay: f64,
    ) -> Self {
        let mut remarks = Remarks::default();
        remarks.of_rejections(reports);
        let used: Vec<&Conditioned> =
            all.iter().zip(reports).filter(|(_, report)| report.used).map(|(hit, _)| hit).collect();
        remarks.of_lengths(&used, options);
        remarks.of_ends(&used, decay);
        remarks.of_ringing_before(&used);
        remarks.of_drift(&used, options.baseline);
        remarks
    }

    fn of_rejections(&mut self, reports: &[HitReport]) {
        for report in reports {
            let (number, why) = (report.number, report.why());
            match why {
                Some(why) if !report.used => self.all.push(Remark::Rejected { hit: number, why }),
                Some(why) => self.all.push(Remark::Kept { hit: number, why }),
                None => {}
            }
        }
        let points: BTreeSet<&Channel> = reports.iter().map(|report| &report.struck).collect();
        for point in points {
            match reports.iter().filter(|report| report.used && report.struck == *point).count() {
                0 => self.all.push(Remark::NoHit(point.clone())),
                1 => self.all.push(Remark::OneHit(point.clone())),
                _ => {}
            }
        }
    }

    fn of_lengths(&mut self, used: &[&Conditioned], options: &EstimateOptions) {
        let samples = || used.iter().map(|hit| hit.hit.samples());
        if let (Some(short), Some(long)) = (samples().min(), samples().max())
            && short < long
        {
            self.all.push(Remark::Lengths { short, long });
        }
        if options.zero_padding > 1 {
            self.all.push(Remark::ZeroPadding(options.zero_padding));
        }
    }

    /// Responses that have not died away when their records end.
    fn of_ends(&mut self, used: &[&Conditioned], decay: f64) {
        let mut left: BTreeMap<&Channel, f64> = BTreeMap::new();
        for signal in used.iter().flat_map(|hit| &hit.responses) {
            let largest = left.entry(&signal.response.channel).or_default();
            *largest = largest.max(signal.left);
        }
        left.retain(|_, left| *left > LEFT_UNNOTICED);
        let left: Vec<(Channel, f64)> =
            left.into_iter().map(|(channel, left)| (channel.clone(), left)).collect();
        let window = (decay > 0.0).then_some(decay);
        if !left.is_empty() {
            self.all.push(Remark::StillRinging { left, window });
        } else if let Some(decay) = window {
            self.all.push(Remark::Window(decay));
        }
    }

    /// Responses that ring from the hit before.
    fn of_ringing_before(&mut self, used: &[&Conditioned]) {
        let mut quietest: BTreeMap<&Channel, f64> = BTreeMap::new();
        let signals = || used.iter().flat_map(|hit| hit.responses.iter().map(move |s| (hit.hit.number(), s)));
        for (_, signal) in signals() {
            if let Some(before) = signal.before {
                let quiet = quietest.entry(&signal.response.channel).or_insert(f64::INFINITY);
                *quiet = quiet.min(before);
            }
        }
        let mut ringing: BTreeMap<u32, f64> = BTreeMap::new();
        for (number, signal) in signals() {
            let channel = &signal.response.channel;
            let (Some(before), Some(quiet)) = (signal.before, quietest.get(channel)) else { continue };
            let peak = signal.values.iter().map(|v| v.abs()).fold(0.0, f64::max);
            let share = before.sqrt() / peak;
            if share > RINGS_BEFORE && before > RINGS_OVER_QUIETEST * quiet {
                let worst = ringing.entry(number).or_default();
                *worst = worst.max(share);
            }
        }
        if !ringing.is_empty() {
            self.all.push(Remark::RingingBefore(ringing.into_iter().collect()));
        }
    }

    fn of_drift(&mut self, used: &[&Conditioned], baseline: Baseline) {
        if baseline == Baseline::Drift {
            return;
        }
        let mut drifting: BTreeSet<Signal> = BTreeSet::new();
        for hit in used {
            let drifts = |drift: &Drift, values: &[f64]| drift.significance > DRIFTS && shows(drift, values);
            if drifts(&hit.force_drift, &hit.force) {
                drifting.insert(Signal::Force);
            }
            let signals = hit.responses.iter().filter(|signal| drifts(&signal.drift, &signal.values));
            drifting.extend(signals.map(|signal| Signal::Response(signal.response.channel.clone())));
        }
        if !drifting.is_empty() {
            self.all.push(Remark::DriftingBaselines(drifting.into_iter().collect()));
        }
    }

    /// What hum was taken off.
    pub(crate) fn of_hum(&mut self, hum: Option<&Hum>) {
        self.all.extend(hum.map(|hum| Remark::Hum { hz: hum.hz, signals: hum.signals.clone() }));
    }

    /// How differently the hits of an FRF count.
    pub(crate) fn of_weights(&mut self, weights: &[f64], is_plain: bool) {
        self.is_plain = is_plain;
        let (low, high) =
            weights.iter().fold((f64::INFINITY, 0.0f64), |(low, high), w| (low.min(*w), high.max(*w)));
        self.noise_ratio = self.noise_ratio.max((high / low).sqrt());
    }

    /// By how much the hits of an FRF scatter beyond the noise before them.
    pub(crate) fn of_scatter(&mut self, response: &Channel, struck: &Channel, ratio: Option<f64>) {
        if let Some(ratio) = ratio.filter(|ratio| *ratio > DISAGREE) {
            self.scatter.push(FrfPair::new(response.clone(), struck.clone()));
            self.worst_scatter = self.worst_scatter.max(ratio.sqrt());
        }
    }

    /// What only the finished FRFs tell.
    pub(crate) fn of_frfs(&mut self, frfs: &FrfSet, excitations: &[Excitation], options: &EstimateOptions) {
        if self.noise_ratio > 1.0 {
            self.all.push(Remark::UnequalNoise { ratio: self.noise_ratio, is_plain: self.is_plain });
        }
        if !self.scatter.is_empty() {
            let frfs = std::mem::take(&mut self.scatter);
            self.all.push(Remark::Disagreement { ratio: self.worst_scatter, frfs });
        }
        let biased = excitations.iter().filter(|e| e.h1_bias > BIASED && options.estimator == Estimator::H1);
        let biased: Vec<(Channel, f64)> = biased.map(|e| (e.struck.clone(), e.h1_bias)).collect();
        if !biased.is_empty() {
            self.all.push(Remark::SmallH1 { struck: biased, taken_off: options.unbiased });
        }
        for excitation in excitations {
            self.of_dips(excitation, frfs.lines().hz());
        }
        self.all.extend(implausible(frfs, excitations));
    }
}

/// Whether a drift makes up a tenth of the first line: a straight line over n samples has n/2π times its rise
/// there, a pulse about the sum of its samples.
fn shows(drift: &Drift, values: &[f64]) -> bool {
    let first_line = drift.over_record.abs() * values.len() as f64 / std::f64::consts::TAU;
    let peak = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let pulse: f64 = values.iter().map(|v| v.abs()).filter(|v| *v > PULSE * peak).sum();
    first_line > DRIFT_OF_FIRST_LINE * pulse
}

impl Remarks {
    /// Narrow dips of the force's spectrum, where FRFs rest on little.
    fn of_dips(&mut self, excitation: &Excitation, hz: &[f64]) {
        let power: Vec<f64> = excitation.spectrum.iter().map(|force| force * force).collect();
        let last = hz.iter().rposition(|hz| *hz <= excitation.usable_to).unwrap_or(0);
        let dips: Vec<f64> = dips(&power, last).iter().map(|&line| hz[line]).collect();
        if !dips.is_empty() {
            self.all.push(Remark::ForceDips { struck: excitation.struck.clone(), hz: dips });
        }
    }
}
