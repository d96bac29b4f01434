//! What a reader of the FRFs should know, in sentences.

use std::collections::{BTreeMap, BTreeSet};

use jointscope_spectra::{Channel, FrfSet};

use crate::band::dips;
use crate::baseline::Drift;
use crate::conditioned::Conditioned;
use crate::plausibility::implausible;
use crate::{Baseline, EstimateOptions, Estimator, Excitation, HitReport};

/// Sentences, in the order in which they were found.
#[derive(Debug, Default)]
pub(crate) struct Remarks {
    pub texts: Vec<String>,
    /// Largest ratio of the hits' noise, and whether it was left unweighed.
    noise_ratio: f64,
    is_plain: bool,
    /// FRFs whose hits scatter beyond their noise, and by how much at the most.
    scatter: Vec<String>,
    worst_scatter: f64,
}

/// What may be left of a response at its record's end without a remark.
const LEFT_UNNOTICED: f64 = 3e-3;
/// Deviations of a baseline's slope from none at which it is called a drift.
const DRIFTS: f64 = 30.0;
/// Ringing before a hit relative to its loudest response.
const RINGS_BEFORE: f64 = 0.01;
/// Ratio of powers from which hits disagree by more than their noise.
const DISAGREE: f64 = 4.0;
/// Bias of H1 that is worth a word.
const BIASED: f64 = 1e-3;

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
                Some(why) if !report.used => self.texts.push(format!("hit {number} rejected: {why}")),
                Some(why) => self.texts.push(format!("hit {number} used as `--keep` says, though: {why}")),
                None => {}
            }
        }
        let points: BTreeSet<&Channel> = reports.iter().map(|report| &report.struck).collect();
        for point in points {
            match reports.iter().filter(|report| report.used && report.struck == *point).count() {
                0 => self.texts.push(format!("no hit at {point} is left: there are no FRFs to it")),
                1 => self.texts.push(format!(
                    "one hit at {point}: it has no coherence, so the noise is estimated from the scatter over the lines, which sees neither hits \
                     that differ nor anything that repeats; three hits or more tell"
                )),
                _ => {}
            }
        }
    }

    fn of_lengths(&mut self, used: &[&Conditioned], options: &EstimateOptions) {
        let samples = || used.iter().map(|hit| hit.hit.samples());
        if let (Some(short), Some(long)) = (samples().min(), samples().max())
            && short < long
        {
            self.texts.push(format!(
                "records of {short} to {long} samples: the shorter ones are filled with zeros, which adds nothing to what has died away"
            ));
        }
        if options.zero_padding > 1 {
            let times = options.zero_padding;
            self.texts.push(format!(
                "records filled with zeros to {times} times their length: of {times} neighbouring lines one is new, the rest follow from the others"
            ));
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
        let named: Vec<String> =
            left.iter().map(|(channel, left)| format!("{} % at {channel}", percent(*left))).collect();
        match (named.is_empty(), decay > 0.0) {
            (true, false) => {}
            (true, true) => self.texts.push(window(decay)),
            (false, true) => self.texts.push(format!(
                "responses still ring when their records end ({} of their loudest part): {}",
                named.join(", "),
                window(decay)
            )),
            (false, false) => self.texts.push(format!(
                "responses still ring when their records end ({} of their loudest part), which bends peaks and fills antiresonances by about as \
                 much, the same way in every hit, so that no coherence shows it: record longer, or take `--response-window auto`",
                named.join(", ")
            )),
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
            if share > RINGS_BEFORE && before > 9.0 * quiet {
                let worst = ringing.entry(number).or_default();
                *worst = worst.max(share);
            }
        }
        if !ringing.is_empty() {
            let hits: Vec<String> = ringing
                .iter()
                .map(|(number, share)| format!("hit {number} ({} % of the peak)", percent(*share)))
                .collect();
            self.texts.push(format!(
                "the structure still rings from the hit before in {}: that counts as noise; wait longer between hits",
                hits.join(", ")
            ));
        }
    }

    fn of_drift(&mut self, used: &[&Conditioned], baseline: Baseline) {
        if baseline == Baseline::Drift {
            return;
        }
        let mut drifting: BTreeSet<String> = BTreeSet::new();
        for hit in used {
            let drifts = |drift: &Drift, values: &[f64]| drift.significance > DRIFTS && shows(drift, values);
            if drifts(&hit.force_drift, &hit.force) {
                drifting.insert("the force".to_owned());
            }
            let signals = hit.responses.iter().filter(|signal| drifts(&signal.drift, &signal.values));
            drifting.extend(signals.map(|signal| format!("the response at {}", signal.response.channel)));
        }
        if !drifting.is_empty() {
            let names: Vec<String> = drifting.into_iter().collect();
            self.texts.push(format!(
                "the baseline of {} drifts, which shows in the lowest lines: `--detrend drift` takes a straight line off",
                names.join(", ")
            ));
        }
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
            self.scatter.push(format!("{response}/{struck}"));
            self.worst_scatter = self.worst_scatter.max(ratio.sqrt());
        }
    }

    /// What only the finished FRFs tell.
    pub(crate) fn of_frfs(&mut self, frfs: &FrfSet, excitations: &[Excitation], estimator: Estimator) {
        if self.noise_ratio > 1.0 {
            let ratio = two_digits(self.noise_ratio);
            self.texts.push(match self.is_plain {
                false => format!(
                    "the noise of the hits differs by a factor of up to {ratio}: in the averages each hit counts inversely to the power of its noise \
                     (`--weights plain` takes the textbook's average)"
                ),
                true => format!(
                    "the noise of the hits differs by a factor of up to {ratio}: the variances here know of it, but coherence and averages state less noise \
                     than a plain average has (`--weights auto` mends that)"
                ),
            });
        }
        if !self.scatter.is_empty() {
            self.texts.push(format!(
                "the hits disagree by up to {} times the noise that precedes them ({}): they fell on different places, or the structure does not answer \
                 in proportion, or it still rang",
                two_digits(self.worst_scatter),
                self.scatter.join(", ")
            ));
        }
        let biased = excitations.iter().filter(|e| e.h1_bias > BIASED && estimator == Estimator::H1);
        let biased: Vec<String> =
            biased.map(|e| format!("{} % to {}", percent(e.h1_bias), e.struck)).collect();
        if !biased.is_empty() {
            self.texts.push(format!(
                "the force's noise makes H1 read low by up to {} where the force is weakest: a force window lessens it",
                biased.join(", ")
            ));
        }
        for excitation in excitations {
            self.of_dips(excitation, frfs.lines().hz());
        }
        self.texts.extend(implausible(frfs, excitations));
    }
}

/// Whether a drift makes up a tenth of the first line: a straight line over n samples has n/2π times its rise there, a pulse about the sum of
/// its samples.
fn shows(drift: &Drift, values: &[f64]) -> bool {
    let first_line = drift.over_record.abs() * values.len() as f64 / std::f64::consts::TAU;
    let peak = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let pulse: f64 = values.iter().map(|v| v.abs()).filter(|v| *v > PULSE * peak).sum();
    first_line > 0.1 * pulse
}

/// Share of the peak that is part of the pulse or of the loudest ringing.
const PULSE: f64 = 0.1;

impl Remarks {
    /// Narrow dips of the force's spectrum, where FRFs rest on little.
    fn of_dips(&mut self, excitation: &Excitation, hz: &[f64]) {
        const TOLD: usize = 5;
        let power: Vec<f64> = excitation.spectrum.iter().map(|force| force * force).collect();
        let last = hz.iter().rposition(|hz| *hz <= excitation.usable_to).unwrap_or(0);
        let dips: Vec<String> = dips(&power, last).iter().map(|&line| format!("{:.1}", hz[line])).collect();
        if dips.is_empty() {
            return;
        }
        let more = if dips.len() > TOLD { " and elsewhere" } else { "" };
        self.texts.push(format!(
            "the force's spectrum at {} dips near {} Hz{more}: do not trust the FRFs there, however high their coherence",
            excitation.struck,
            dips[..dips.len().min(TOLD)].join(", ")
        ));
    }
}

fn window(decay: f64) -> String {
    format!(
        "an exponential window of decay {decay:.4} 1/s lies on force and responses, so the FRFs are those at s = {decay:.4} 1/s + iω and look more damped \
         than the structure is"
    )
}

fn percent(share: f64) -> String {
    two_digits(100.0 * share)
}

/// Two significant digits, without an exponent.
fn two_digits(value: f64) -> String {
    if !(value.is_finite() && value > 0.0) {
        return value.to_string();
    }
    let decimals = (1 - value.log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_told_with_two_digits() {
        assert_eq!([0.0123, 0.5, 0.1, 0.00034].map(percent), ["1.2", "50", "10", "0.034"]);
        assert_eq!(two_digits(14.96), "15");
    }
}
