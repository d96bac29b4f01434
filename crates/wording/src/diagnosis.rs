//! A diagnosis in sentences: what is left out, or where what has no name sits and how it goes with frequency.

use crate::departures::departed;
use crate::finding::{found, it, with_fitted_size};
use crate::format::fixed;
use crate::misfit::{sits, varies};
use crate::numbers::{apart, figures, listed, significant};
use crate::places::quantity_name;
use crate::{Remarks, Says, model_error};
use jointscope_diagnosis::{Diagnosis, Observation, OddRecord, Tried};
use jointscope_findings::Verdict;
use jointscope_frf::noise::NoiseSource;

/// The verdict: what it is, and what to do about it. What the test itself did goes before everything else,
/// then what the stated quantities would have to be.
impl Says for Diagnosis {
    fn says(&self) -> String {
        let verdict = match &self.model_error {
            Some(errors) => model_error::verdict(self, errors),
            None => by_noise(self),
        };
        let drifted = self.drift.as_ref().map_or_else(String::new, |drift| format!("{} ", drift.says()));
        format!("{drifted}{}{}{verdict}", odd(self).unwrap_or_default(), departed(self))
    }
}

/// The one record that no place of a structure makes another multiple than the others.
fn odd(diagnosis: &Diagnosis) -> Option<String> {
    let OddRecord { frf, factor, others: [least, largest] } = diagnosis.odd_record()?;
    Some(format!(
        "FRF {frf} is {} times what the fixture makes of it, the others {} to {} times: look at its unit, range and sign first, or state that the gain of each record is unsure \
         (`channels`, `\"*\"`), and it is named. ",
        significant(factor, 3),
        significant(least, 3),
        significant(largest, 3)
    ))
}

/// The verdict where the noise of the FRFs decides.
fn by_noise(diagnosis: &Diagnosis) -> String {
    let [nominal, refitted, repaired] = diagnosis.chi2_per_dof();
    let [_, error_refitted, error_repaired] = diagnosis.nrmse();
    match diagnosis.verdict {
        Verdict::Unexplained if diagnosis.is_only_departed() => format!(
            "No effect is needed besides: the fixture so changed explains the FRFs down to their noise (χ² per degree of freedom {}, {} \
             before the refit).",
            figures(refitted),
            figures(nominal)
        ),
        Verdict::Consistent if refitted < 0.5 * nominal => format!(
            "Nothing is left out: within its stated tolerances the fixture explains the FRFs down to their noise (χ² per degree of \
             freedom {}, {} before the refit).",
            figures(refitted),
            figures(nominal)
        ),
        Verdict::Consistent => format!(
            "Nothing is left out: the fixture explains the FRFs down to their noise (χ² per degree of freedom {}).",
            figures(refitted)
        ),
        Verdict::Explained => {
            let [with, without] = apart([repaired, refitted], 3);
            let [error_with, error_without] = apart([100.0 * error_repaired, 100.0 * error_refitted], 2);
            format!(
                "The fixture leaves out {}; with {} the FRFs are explained down to their noise (χ² per degree of freedom {with}; without \
                 {without}{}; error {error_with} %, without {error_without} %).",
                found(diagnosis),
                it(diagnosis),
                farthest_quantity(diagnosis)
            )
        }
        Verdict::PartlyExplained if diagnosis.is_unnamed() => format!(
            "Something is left out that none of the effects known here accounts for: the closest, {}, takes χ² per degree of freedom from {} \
             to {} only, and what is left sits {}{}.",
            found(diagnosis),
            figures(refitted),
            figures(repaired),
            sits(diagnosis, &diagnosis.search.repaired),
            varies(diagnosis, &diagnosis.search.repaired)
        ),
        Verdict::PartlyExplained if diagnosis.beside_modes.is_some() => {
            let [error_with, error_without] = apart([100.0 * error_repaired, 100.0 * error_refitted], 2);
            format!(
                "The fixture leaves out {}; with {} the FRFs are explained but for {error_with} % of them (without {error_without} %). No structure's modes explain them to better than {} %.",
                found(diagnosis),
                it(diagnosis),
                significant(100.0 * diagnosis.beside_modes.unwrap_or_default(), 2)
            )
        }
        Verdict::PartlyExplained => format!(
            "The fixture leaves out {}, but that is not all: χ² per degree of freedom falls from {} to {}, and what is left sits {}{}.",
            found(diagnosis),
            figures(refitted),
            figures(repaired),
            sits(diagnosis, &diagnosis.search.repaired),
            varies(diagnosis, &diagnosis.search.repaired)
        ),
        Verdict::Unexplained => format!(
            "Something is left out that none of the effects known here accounts for (χ² per degree of freedom {}): it sits {}{}.",
            figures(refitted),
            sits(diagnosis, &diagnosis.search.refitted),
            varies(diagnosis, &diagnosis.search.refitted)
        ),
    }
}

/// What the reader must know of the test itself: too few FRFs, noise that had to be estimated.
impl Remarks for Diagnosis {
    fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let pairs = self.observation.pairs();
        if let [only] = pairs {
            remarks.push(format!(
                "There is one FRF only, {only}: it shows whether the fixture explains it, and which laws would; it cannot say where \
                 something sits, for one free value a line at any place explains one FRF, and nothing can be held out. Record at least \
                 one more response or reference point."
            ));
        }
        remarks.extend(of_noise(&self.observation));
        if !self.contradictory.is_empty() {
            let band = |(from, to): &(f64, f64)| match from == to {
                true => format!("{} Hz", significant(*from, 4)),
                false => format!("{} to {} Hz", significant(*from, 4), significant(*to, 4)),
            };
            let bands: Vec<String> = self.contradictory.iter().map(band).collect();
            remarks.push(format!(
                "Lines that contradict all others were left out: {}. No structure's modes make such a break in its FRFs; mains hum, a tone from elsewhere or \
                 an overload does: look at the time signals there.",
                listed(&bands)
            ));
        }
        if let Some(share) = self.falls_short {
            remarks.push(format!(
                "Noise of the force made the FRFs too small where the blow is weak, as it does to H1, by up to {} %: they were corrected by what explains them best. A harder \
                 tip, or FRFs estimated as Hv, tell more there.",
                significant(100.0 * share, 2)
            ));
        }
        if let Some(share) = self.beside_modes {
            remarks.push(format!(
                "No modes explain the recording to better than {} % of its FRFs, whatever the structure: so much counts as noise here. Leakage, a filter or strikes beside the point leave \
                 such a rest.",
                significant(100.0 * share, 2)
            ));
        }
        remarks.extend(self.swapped_points().iter().map(|[a, b]| {
            format!(
                "Points {a} and {b} have each other's place: their channels are swapped, in the cables or in the node numbers of the file."
            )
        }));
        if !self.stopped.is_empty() {
            let names: Vec<String> = self.stopped.iter().map(|name| (*name).to_owned()).collect();
            remarks.push(format!(
                "The search ended at its limit; what it did not come to any more: {}. A narrower band, or fewer FRFs or quantities with a \
                 standard deviation, let it come farther.",
                listed(&names)
            ));
        }
        remarks.extend(nearest(self));
        remarks.extend(of_observation(&self.observation));
        // Among modes correlation is a part of the likelihood.
        if self.model_error.is_none() && !self.is_white() {
            remarks.push(format!(
                "What the best model leaves is not white (neighbouring lines correlate by {:.2}): gains count for that much less \
                 and intervals are wider, as far as that is all there is to it.",
                self.residual_correlation
            ));
        }
        remarks
    }
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

/// Effects that are told of those that were tried in vain.
const RANKED: usize = 3;

/// What came nearest where nothing was found to explain the recording.
pub(crate) fn ranked(diagnosis: &Diagnosis) -> Option<String> {
    let all = Some(diagnosis.tried_in_vain()).filter(|all| !all.is_empty())?;
    let told = |tried: &Tried| format!("{} {}", with_fitted_size(&tried.effect), fixed(tried.ln_gain, 1));
    let nearest: Vec<String> = all.iter().take(RANKED).map(told).collect();
    Some(format!(
        "tried in vain, with what it gains in ln p of the modes over the fixture alone: {}{}",
        nearest.join(", "),
        if all.len() > RANKED {
            format!("; {} more in the result", all.len() - RANKED)
        } else {
            String::new()
        }
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

/// `, and the mass of A would have to be 33 standard deviations off`, where the refit without effects takes a
/// quantity that far.
fn farthest_quantity(diagnosis: &Diagnosis) -> String {
    diagnosis.farthest_quantity().map_or_else(String::new, |(path, deviations)| {
        let quantity = quantity_name(path);
        format!(", and {quantity} would have to be {} standard deviations off", significant(deviations, 2))
    })
}
