//! From hits to FRFs, with coherence and variances, and what was left out.

use jointscope_frf::noise::{of_lines, smoothed};
use jointscope_hits::{Hit, MeasuredMotion};
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

use crate::average::{Averaged, Pair, averaged, variance_of_unequal_hits, weights_by_noise};
use crate::band::last_usable;
use crate::conditioned::{Conditioned, Spectra, Transform, mark_cut_off_alike, prepared};
use crate::hum::Hum;
use crate::remarks::Remarks;
use crate::settings::force_noise::MOST_NOISE_OF_FORCE;
use crate::settings::hits::{FEWEST_SAMPLES, SAME_INTERVAL};
use crate::settings::windows::{LEFT_BY_WINDOW, LOWEST_SPACINGS, MOST_LEFT_OUT};
use crate::{
    Baseline, EstimateError, EstimateOptions, Estimator, Excitation, ForceWindow, HitReport, Remark,
    ResponseWindow, Weighting,
};

/// FRFs of a hammer test, and what was seen on the way to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Accelerances of every response to every struck point, on all lines from 0 Hz to half the sampling
    /// rate, with coherence and averages, and with variances where every struck point has two hits or more.
    /// On lines without force, and at 0 Hz, value and coherence are zero. Responses come in the order of the
    /// hits, references under each.
    pub frfs: FrfSet,
    /// The hits, in the order they were given.
    pub hits: Vec<HitReport>,
    /// What the hammer put in, struck point by struck point.
    pub excitations: Vec<Excitation>,
    /// Decay δ of the exponential window, 1/s; 0 without one. The FRFs are those at s = δ + iω.
    pub decay: f64,
    /// What a reader of the FRFs should know.
    pub remarks: Vec<Remark>,
    /// Neighbouring lines that tell as much as one line whose noise is its own.
    alike: f64,
    /// Hum that was taken off the hits, and what else.
    hum: Option<Hum>,
    baseline: Baseline,
}

impl Estimate {
    /// Estimates FRFs from hits. Hits with faults are rejected unless `options.keep` names them.
    ///
    /// # Errors
    /// See [`EstimateError`].
    pub fn of(hits: &[Hit], options: &EstimateOptions) -> Result<Self, EstimateError> {
        check(hits, options)?;
        let hum = if options.baseline == Baseline::Keep { None } else { Hum::of(hits) };
        let mut all = Conditioned::all(hits, hum.as_ref(), options.baseline);
        mark_cut_off_alike(&mut all);
        let reports: Vec<HitReport> = all.iter().map(|hit| report(hit, options)).collect();
        let used: Vec<&Conditioned> =
            all.iter().zip(&reports).filter(|(_, report)| report.used).map(|(hit, _)| hit).collect();
        if used.is_empty() {
            return Err(EstimateError::AllRejected(all_rejected(&reports)));
        }
        let decay = decay(&used, options.response_window);
        let samples = hits.iter().map(Hit::samples).max().unwrap_or(0);
        let mut transform = Transform::new(samples * options.zero_padding.max(1) as usize);
        let spectra: Vec<Spectra> =
            used.iter().map(|hit| hit.spectra(&mut transform, options.force_window, decay)).collect();
        let step = 1.0 / (hits[0].interval() * transform.length() as f64);
        let lines = SpectralLines::even(0.0, step, transform.length() / 2 + 1)?;
        let alike = lines_alike(samples, transform.length(), decay * hits[0].interval());
        let force_noise = used.iter().map(|hit| hit.force_noise(options.force_window, decay)).collect();
        let test = Test { used: &used, spectra: &spectra, force_noise, lines: &lines, alike, options };
        let excitations: Vec<Excitation> = test.struck().map(|struck| test.excitation(struck)).collect();
        let mut remarks = Remarks::of_hits(&all, &reports, options, decay);
        remarks.of_hum(hum.as_ref());
        let frfs = test.frfs(&excitations, &mut remarks)?;
        remarks.of_frfs(&frfs, &excitations, options);
        let baseline = options.baseline;
        Ok(Estimate { frfs, hits: reports, excitations, decay, remarks: remarks.all, alike, hum, baseline })
    }

    /// The hits that it was made of as it took them, hum and baselines off: for whatever else is made of them.
    pub fn prepared(&self, hits: &[Hit]) -> Vec<Hit> {
        prepared(hits, self.hum.as_ref(), self.baseline)
    }

    /// The FRFs on the lines above 0 Hz that the hammer excites at every struck point; under a window without
    /// the lowest ones, on which what is left of a baseline shows and passes for something that holds the
    /// structure, or for AC coupling. Of lines that share their noise, under a window or by zero padding, one
    /// stands for its neighbours: whoever weighs each for itself would be too sure by the root of their number.
    pub fn usable(&self) -> Option<FrfSet> {
        let to = self.excitations.iter().map(|e| e.usable_to).fold(f64::INFINITY, f64::min);
        let hz = self.frfs.lines().hz();
        let spacing = hz.get(1).map_or(0.0, |second| second - hz[0]);
        let windowed = LOWEST_SPACINGS * spacing + self.decay / std::f64::consts::PI;
        let from = if self.decay > 0.0 { windowed.min(MOST_LEFT_OUT * to) } else { 0.0 };
        let every = self.alike.max(1.0) as usize;
        self.frfs.on_lines(|line| hz[line] > from && hz[line] <= to && line % every == 0)
    }
}

fn check(hits: &[Hit], options: &EstimateOptions) -> Result<(), EstimateError> {
    let first = hits.first().ok_or(EstimateError::NoHits)?;
    if hits.iter().all(|hit| hit.responses().is_empty()) {
        return Err(EstimateError::NoResponses);
    }
    let differs = |hit: &&Hit| (hit.interval() - first.interval()).abs() > SAME_INTERVAL * first.interval();
    if let Some(other) = hits.iter().find(differs) {
        return Err(EstimateError::Interval {
            first: first.number(),
            first_interval: first.interval(),
            second: other.number(),
            second_interval: other.interval(),
        });
    }
    for (what, numbers) in [("keep", &options.keep), ("reject", &options.reject)] {
        if let Some(&number) = numbers.iter().find(|n| hits.iter().all(|hit| hit.number() != **n)) {
            let hits: Vec<String> = hits.iter().map(|hit| hit.number().to_string()).collect();
            return Err(EstimateError::NoSuchHit { number, what, hits: hits.join(", ") });
        }
    }
    match options.force_window {
        ForceWindow::Length(value) if !(value.is_finite() && value > 0.0) => {
            return Err(EstimateError::Window { what: "a force window", value, unit: "seconds" });
        }
        _ => {}
    }
    match options.response_window {
        ResponseWindow::Decay(value) if !(value.is_finite() && value > 0.0) => {
            return Err(EstimateError::Window { what: "a decay of the response window", value, unit: "1/s" });
        }
        _ => {}
    }
    match hits.iter().map(Hit::samples).find(|samples| *samples < FEWEST_SAMPLES) {
        Some(samples) => Err(EstimateError::TooShort(samples)),
        None => Ok(()),
    }
}

fn report(hit: &Conditioned, options: &EstimateOptions) -> HitReport {
    let number = hit.hit.number();
    let rejected_by_hand = options.reject.contains(&number);
    HitReport {
        number,
        struck: hit.hit.struck().clone(),
        peak_force: hit.pulse.map_or(0.0, |pulse| pulse.peak),
        width: hit.pulse.map_or(0.0, |pulse| pulse.width() as f64 * hit.hit.interval()),
        faults: hit.faults.clone(),
        rejected_by_hand,
        used: !rejected_by_hand && (hit.faults.is_empty() || options.keep.contains(&number)),
    }
}

/// Why no hit is used, each reason once with its hits.
fn all_rejected(reports: &[HitReport]) -> String {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (why, number) in reports.iter().filter_map(|report| Some((report.why()?, report.number.to_string())))
    {
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, hits)) => hits.push(number),
            None => reasons.push((why, vec![number])),
        }
    }
    let told = |(why, hits): (String, Vec<String>)| {
        format!("{} {}: {why}", if hits.len() == 1 { "hit" } else { "hits" }, hits.join(", "))
    };
    reasons.into_iter().map(told).collect::<Vec<_>>().join("; ")
}

/// The decay of the window that is asked for, 1/s.
fn decay(used: &[&Conditioned], window: ResponseWindow) -> f64 {
    match window {
        ResponseWindow::None => 0.0,
        ResponseWindow::Decay(decay) => decay,
        ResponseWindow::Auto => used
            .iter()
            .flat_map(|hit| hit.responses.iter().map(move |signal| (hit, signal)))
            .filter(|(_, signal)| signal.left > LEFT_BY_WINDOW)
            .map(|(hit, signal)| {
                let begin = hit.pulse.map_or(0, |pulse| pulse.begin);
                let length = (hit.hit.samples() - begin).max(1) as f64 * hit.hit.interval();
                (signal.left / LEFT_BY_WINDOW).ln() / length
            })
            .fold(0.0, f64::max),
    }
}

/// Neighbouring lines that tell as much about white noise as one line whose noise is its own, under a window
/// of this decay per sample: the sum of the squared correlations of a line's noise with all others',
/// L·∫e^(−4δt)/(∫e^(−2δt))² over the `samples` of a record in a transform of length L.
fn lines_alike(samples: usize, length: usize, decay: f64) -> f64 {
    let (samples, length) = (samples as f64, length as f64);
    let across = decay * samples;
    if across < 1e-3 { length / samples } else { length * decay / across.tanh() }
}

/// The hits in use and their spectra.
struct Test<'a> {
    used: &'a [&'a Conditioned<'a>],
    spectra: &'a [Spectra],
    /// Power that the force's noise adds to every line of each hit, N².
    force_noise: Vec<f64>,
    lines: &'a SpectralLines,
    /// Neighbouring lines whose noise tells as much as one line's of its own.
    alike: f64,
    options: &'a EstimateOptions,
}

/// A response among those of the hits, and what it measures.
#[derive(Clone, PartialEq)]
struct Sensor {
    channel: Channel,
    motion: MeasuredMotion,
}

impl<'a> Test<'a> {
    /// The struck points, as they come.
    fn struck(&self) -> impl Iterator<Item = &'a Channel> {
        let used = self.used;
        (0..used.len())
            .filter(move |&i| used[..i].iter().all(|hit| hit.hit.struck() != used[i].hit.struck()))
            .map(move |i| used[i].hit.struck())
    }

    /// One sensor per channel, the highest derivative where there are several.
    fn sensors(&self) -> Vec<Sensor> {
        let mut sensors: Vec<Sensor> = Vec::new();
        for response in self.used.iter().flat_map(|hit| hit.hit.responses()) {
            match sensors.iter_mut().find(|sensor| sensor.channel == response.channel) {
                Some(sensor) => sensor.motion = sensor.motion.max(response.motion),
                None => sensors.push(Sensor { channel: response.channel.clone(), motion: response.motion }),
            }
        }
        sensors
    }

    fn hits_at(&self, struck: &Channel) -> Vec<usize> {
        (0..self.used.len()).filter(|&i| self.used[i].hit.struck() == struck).collect()
    }

    fn excitation(&self, struck: &Channel) -> Excitation {
        let hits = self.hits_at(struck);
        let count = hits.len() as f64;
        let power: Vec<f64> = (0..self.lines.len())
            .map(|line| hits.iter().map(|&i| self.spectra[i].force[line].norm_sqr()).sum::<f64>() / count)
            .collect();
        let noise = hits.iter().map(|&i| self.force_noise[i]).sum::<f64>() / count;
        let last = last_usable(&power);
        let weakest = power[1.min(last)..=last].iter().copied().fold(f64::INFINITY, f64::min);
        let interval = self.used[hits[0]].hit.interval();
        Excitation {
            struck: struck.clone(),
            hits: hits.iter().map(|&i| self.used[i].hit.number()).collect(),
            spectrum: power.iter().map(|power| interval * power.sqrt()).collect(),
            noise: interval * noise.sqrt(),
            usable_to: self.lines.hz()[last],
            h1_bias: if weakest > 0.0 { (noise / weakest).min(1.0) } else { 1.0 },
        }
    }

    fn frfs(&self, excitations: &[Excitation], remarks: &mut Remarks) -> Result<FrfSet, EstimateError> {
        let n = self.lines.len();
        let (mut pairs, mut values, mut variances) = (Vec::new(), Vec::new(), Vec::new());
        let mut quality = Vec::new();
        for sensor in self.sensors() {
            for excitation in excitations {
                let Some(found) = self.frf(&sensor, excitation, remarks) else { continue };
                pairs.push(FrfPair::new(sensor.channel.clone(), excitation.struck.clone()));
                if found.averages > 1 {
                    let Found { values, variance, coherence, force, .. } = &found;
                    // Two hits leave one degree of freedom a line, whose small values a wider fit follows:
                    // 1.48 in χ² in place of 1.23.
                    let alike = if found.averages > 2 { self.alike } else { 1.0 };
                    variances.extend(smoothed(values, variance, coherence, force, alike));
                }
                values.extend(found.values);
                quality.push((found.coherence, found.averages));
            }
        }
        let all_have_variances = variances.len() == values.len();
        let mut frfs = FrfSet::new(self.lines.clone(), FrfForm::Accelerance, pairs, values)?;
        for (index, (coherence, averages)) in quality.into_iter().enumerate() {
            debug_assert_eq!(coherence.len(), n);
            if averages > 1 {
                frfs.set_coherence(index, coherence)?;
            }
            frfs.set_averages(index, Some(averages));
        }
        Ok(if all_have_variances { frfs.with_variance(variances)? } else { frfs })
    }

    /// One FRF; `None` where no hit at that point has the response.
    fn frf(&self, sensor: &Sensor, excitation: &Excitation, remarks: &mut Remarks) -> Option<Found> {
        let place = |i: usize| {
            let responses = self.used[i].hit.responses();
            responses.iter().position(|r| r.channel == sensor.channel && r.motion == sensor.motion)
        };
        let hits: Vec<(usize, usize)> =
            self.hits_at(&excitation.struck).into_iter().filter_map(|i| Some((i, place(i)?))).collect();
        if hits.is_empty() {
            return None;
        }
        let spectra =
            |&(i, r): &(usize, usize)| -> Pair { (&self.spectra[i].force, &self.spectra[i].responses[r]) };
        let pairs: Vec<Pair> = hits.iter().map(spectra).collect();
        let n = self.lines.len();
        let last = self.lines.hz().iter().rposition(|hz| *hz <= excitation.usable_to).unwrap_or(0);
        let by_noise = weights_by_noise(&pairs, 1..last + 1);
        let equal = vec![1.0; pairs.len()];
        let is_plain = self.options.weighting == Weighting::Plain;
        let weights = if is_plain { &equal } else { &by_noise };
        let sums: Vec<Averaged> = (0..n).map(|line| averaged(&pairs, weights, line)).collect();
        let mut found = Found {
            values: vec![Complex64::ZERO; n],
            coherence: vec![0.0; n],
            variance: Vec::new(),
            force: sums.iter().map(|sum| sum.force).collect(),
            averages: hits.len() as u32,
        };
        // At 0 Hz the baseline's own value is all there is.
        for line in 1..n {
            if let Some(value) = sums[line].frf(self.options.estimator) {
                found.values[line] = value;
                found.coherence[line] = sums[line].coherence();
            }
        }
        let unequal_but_plain = is_plain && by_noise != equal;
        found.variance = match unequal_but_plain {
            true => (0..n).map(|line| variance_of_unequal_hits(&pairs, &equal, line)).collect(),
            false => of_lines(&found.values, &found.coherence, found.averages),
        };
        if self.options.unbiased && self.options.estimator == Estimator::H1 {
            // A ratio of single spectra is right in the mean, and of n hits each is one in n of its own sum.
            let shared = 1.0 - 1.0 / hits.len() as f64;
            let noise: f64 = hits.iter().zip(weights).map(|(&(i, _), w)| w * self.force_noise[i]).sum();
            let noise = shared * noise;
            for line in 1..n {
                let factor = 1.0 / (1.0 - (noise / sums[line].force).min(MOST_NOISE_OF_FORCE));
                found.values[line] *= factor;
                found.variance[line] *= factor * factor;
            }
        }
        remarks.of_weights(&by_noise, is_plain);
        if hits.len() > 1 {
            let scatter = self.scatter_over_noise(&hits, weights, &sums[..=last]);
            remarks.of_scatter(&sensor.channel, &excitation.struck, scatter);
        }
        Some(found)
    }

    /// Median over the lines of how much more power the residuals have than the noise before the hits
    /// explains; `None` where no samples before the hits tell it.
    fn scatter_over_noise(&self, hits: &[(usize, usize)], weights: &[f64], sums: &[Averaged]) -> Option<f64> {
        let n = hits.len() as f64;
        let (mut response_noise, mut force_noise) = (0.0, 0.0);
        for (&(i, r), weight) in hits.iter().zip(weights) {
            let signal = &self.used[i].responses[r];
            if signal.response.motion != MeasuredMotion::Acceleration {
                return None;
            }
            response_noise += weight * signal.before? * signal.values.len() as f64;
            force_noise += weight * self.force_noise[i];
        }
        let ratio = |sum: &Averaged| {
            let size = sum.cross.norm_sqr() / (sum.force * sum.force);
            let expected = (n - 1.0) / n * (response_noise + size * force_noise);
            ((1.0 - sum.coherence()) * sum.response) / expected
        };
        let mut ratios: Vec<f64> = sums.iter().skip(1).map(ratio).filter(|r| r.is_finite()).collect();
        if ratios.is_empty() {
            return None;
        }
        let middle = ratios.len() / 2;
        Some(*ratios.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

/// One FRF with what it rests on.
struct Found {
    values: Vec<Complex64>,
    coherence: Vec<f64>,
    /// Variance of each value, not smoothed.
    variance: Vec<f64>,
    /// Power of the force by line.
    force: Vec<f64>,
    averages: u32,
}
