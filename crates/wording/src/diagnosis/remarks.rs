//! What to know besides of a diagnosis: what the test was like, and what follows for how sure it is.

use crate::effects::effect_name;
use crate::finding::with_fitted_size;
use crate::format::significant;
use crate::numbers::listed;
use crate::{Remarks, Says};
use jointscope_diagnosis::{Diagnosis, Observation, RecordEnd, Tried};
use jointscope_frf::noise::NoiseSource;

/// What the reader must know of the test itself: too few FRFs, noise that had to be estimated.
impl Remarks for Diagnosis {
    fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        remarks.extend(only_one_frf(self));
        remarks.extend(of_noise(&self.observation));
        remarks.extend(lines_left_out(self));
        remarks.extend(sensors_off(self));
        remarks.extend(self.early_end.map(|end| end.says()));
        remarks.extend(self.drift.as_ref().filter(|drift| drift.taken_out).map(Says::says));
        remarks.extend(falls_short(self));
        remarks.extend(beside_modes(self));
        remarks.extend(swapped_points(self));
        remarks.extend(ended_at_its_limit(self));
        remarks.extend(nearest(self));
        remarks.extend(of_observation(&self.observation));
        remarks.extend(correlated_residuals(self));
        remarks
    }
}

fn only_one_frf(diagnosis: &Diagnosis) -> Option<String> {
    let [only] = diagnosis.observation.pairs() else { return None };
    Some(format!(
        "There is one FRF only, {only}: it shows whether the fixture explains it, and which laws would; it cannot say where \
         something sits, for one free value a line at any place explains one FRF, and no FRF can be held out. Record at least \
         one more response or reference point."
    ))
}

/// Stated sensors that were taken off the FRFs.
fn sensors_off(diagnosis: &Diagnosis) -> Option<String> {
    let sensors: Vec<String> = diagnosis
        .sensors_off
        .iter()
        .map(|sensor| format!("{} ({} g)", effect_name(sensor), significant(1e3 * sensor.value(0), 3)))
        .collect();
    (!sensors.is_empty()).then(|| {
        format!(
            "Natural frequencies differ from response to response as the stated {} makes them differ, which moves with the sensor: it was taken off the FRFs, and what follows is \
             of the structure without it.",
            listed(&sensors)
        )
    })
}

/// Lines that contradict all others.
fn lines_left_out(diagnosis: &Diagnosis) -> Option<String> {
    if diagnosis.contradictory.is_empty() {
        return None;
    }
    let band = |(from, to): &(f64, f64)| match from == to {
        true => format!("{} Hz", significant(*from, 4)),
        false => format!("{} to {} Hz", significant(*from, 4), significant(*to, 4)),
    };
    let bands: Vec<String> = diagnosis.contradictory.iter().map(band).collect();
    Some(format!(
        "Lines that contradict all others were left out: {}. No structure's modes make such a break in its FRFs; mains hum, a tone from elsewhere or \
         an overload does: look at the time signals there.",
        listed(&bands)
    ))
}

impl Says for RecordEnd {
    fn says(&self) -> String {
        format!(
            "Records ended {} s after the blow, when {} % of the loudest mode's motion was left: what was cut off is in no structure's FRFs, and was added from the modes \
             of the recording itself. Records that are longer by half, or an exponential window over force and responses, need no such help.",
            significant(self.after, 3),
            significant(100.0 * self.left, 2)
        )
    }
}

/// Noise of the force, which H1 takes for a larger force.
fn falls_short(diagnosis: &Diagnosis) -> Option<String> {
    let share = diagnosis.falls_short?;
    Some(format!(
        "Noise of the force made the FRFs too small where the blow is weak, as it does to H1, by up to {} %: they were corrected by what explains them best. A harder \
         tip, or FRFs estimated as Hv, tell more there.",
        significant(100.0 * share, 2)
    ))
}

/// What no modes explain, and counts as noise.
fn beside_modes(diagnosis: &Diagnosis) -> Option<String> {
    let share = diagnosis.beside_modes?;
    Some(format!(
        "No modes explain the recording to better than {} % of its FRFs, whatever the structure: so much counts as noise here. Leakage, a filter or strikes beside the point leave \
         such a rest.",
        significant(100.0 * share, 2)
    ))
}

fn swapped_points(diagnosis: &Diagnosis) -> Vec<String> {
    let swapped = diagnosis.swapped_points();
    let remark = |[a, b]: &[&str; 2]| {
        format!(
            "Points {a} and {b} have each other's place: their channels are swapped, in the cables or in the node numbers of the file."
        )
    };
    swapped.iter().map(remark).collect()
}

fn ended_at_its_limit(diagnosis: &Diagnosis) -> Option<String> {
    if diagnosis.stopped.is_empty() {
        return None;
    }
    let names: Vec<String> = diagnosis.stopped.iter().map(|name| (*name).to_owned()).collect();
    Some(format!(
        "The search ended at its limit; what it did not come to any more: {}. A narrower band, or fewer FRFs or quantities with a \
         standard deviation, let it come farther.",
        listed(&names)
    ))
}

/// Residuals of the best model that correlate from line to line.
fn correlated_residuals(diagnosis: &Diagnosis) -> Option<String> {
    // Among modes correlation is a part of the likelihood.
    if diagnosis.model_error.is_some() || diagnosis.is_white() {
        return None;
    }
    Some(format!(
        "What the best model leaves is not white (neighbouring lines correlate by {:.2}): gains count for that much less \
         and intervals are wider, as far as that is all there is to it.",
        diagnosis.residual_correlation
    ))
}

/// From what the noise of the FRFs had to be estimated where no coherence over a stated number of averages
/// tells it.
fn of_noise(observation: &Observation) -> Vec<String> {
    let mut remarks = Vec::new();
    let pairs = observation.pairs();
    let noise = observation.noise().iter().zip(pairs);
    let scatter: Vec<String> = noise
        .filter(|(source, _)| **source == NoiseSource::Scatter)
        .map(|(_, pair)| pair.to_string())
        .collect();
    if observation.noise().contains(&NoiseSource::CoherenceAlone) {
        remarks.push(
            "The number of averages is not stated: it was taken from the scatter over neighbouring lines, and with it the noise from the \
             coherence. State it by --averages, and χ² and intervals are more certain."
                .to_owned(),
        );
    }
    if !scatter.is_empty() {
        remarks.push(format!(
            "The noise of {} was estimated from the scatter over neighbouring lines, for want of coherence over several averages: χ² \
             and intervals are that much less certain.",
            if scatter.len() == pairs.len() { "all FRFs".to_owned() } else { listed(&scatter) }
        ));
    }
    remarks
}

/// What came nearest to a finding where nothing is needed, if that says anything.
fn nearest(diagnosis: &Diagnosis) -> Option<String> {
    let (Tried { effect, .. }, by_chance) = diagnosis.nearest_by_chance()?;
    let names = diagnosis.search.candidates.len();
    Some(format!(
        "Nearest to a finding came {}, which is too little to be named: among {names} names one explains as much by chance in up to {} % of tests. If \
         that may be, test it first: another channel, another sensor, or a quantity known more narrowly would tell.",
        with_fitted_size(effect),
        significant(100.0 * by_chance, 2)
    ))
}

/// What the reader must know of the lines and the noise.
fn of_observation(observation: &Observation) -> Vec<String> {
    let mut remarks = Vec::new();
    let used = observation.lines().len();
    if observation.recorded_lines() > used {
        remarks.push(format!(
            "Of {} lines {used} are used: all that tell one resonance from another, ever fewer with the distance from them, and evenly \
             spread ones. χ², errors and drawings are of these; the noise was estimated on all of them.",
            observation.recorded_lines()
        ));
    }
    if let Some(drift) = observation.drift() {
        let changes: Vec<String> = drift
            .resonances
            .iter()
            .map(|(hz, deviation, ratio)| {
                format!(
                    "{} Hz by {:.1} parts in 100,000 ({:.0} % of its half-width)",
                    significant(*hz, 4),
                    1e5 * deviation,
                    100.0 * deviation / ratio.max(f64::MIN_POSITIVE)
                )
            })
            .collect();
        remarks.push(format!(
            "The resonances moved between the FRFs, by more than their noise and more than any structure that stays the same could \
             make them: {} (standard deviations among FRFs of one response). That much is taken as noise about each resonance; no \
             model is asked to follow it.",
            changes.join(", ")
        ));
    }
    remarks
}
