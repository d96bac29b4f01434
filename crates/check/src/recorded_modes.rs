//! The recording's modes beside the fixture's.

use crate::settings::recorded_modes::{DEVIATIONS, FURTHER_ORDERS, SUSPENSION};
use crate::settings::work::MOST_VALUES;
use crate::{Figure, ModelModes};
use jointscope_fixture::Fixture;
use jointscope_modes::{ModalAnalysis, ModesError, ModesOptions};
use jointscope_pipeline::measured_damping;
use jointscope_spectra::FrfSet;
use serde::Serialize;

/// A mode of the recording and the fixture's that it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModePair {
    /// Natural frequency of the recording, Hz.
    pub frequency: f64,
    /// Its standard deviation, Hz.
    pub std: f64,
    /// Its damping ratio.
    pub damping_ratio: f64,
    /// Natural frequency of the fixture's mode, Hz; `None` where none is alike.
    pub fixture: Option<f64>,
    /// Correlation of their shapes, 0 to 1, where they bend the assembly.
    pub mac: Option<f64>,
    /// Whether the assembly moves as rigid on its supports in it: by the frequency alone.
    pub on_supports: bool,
}

/// The recording's modes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordedModes {
    /// Each with the fixture's that it is.
    pub modes: Vec<ModePair>,
    /// Elastic modes of the fixture in the band that the recording does not show, Hz.
    pub missing: Vec<f64>,
}

/// The modes of accelerances, under an exponential window of `window_decay` (1/s; 0 without one).
///
/// # Errors
/// Why there are none, in a sentence.
pub(crate) fn of(
    fixture: &Fixture,
    (frfs, window_decay): (&FrfSet, f64),
    model: &ModelModes,
) -> Result<RecordedModes, String> {
    if frfs.all_values().len() > MOST_VALUES {
        return Err("there are too many FRFs and lines for a quick look at their modes: `jointscope modes` takes its time".to_owned());
    }
    let last = frfs.lines().hz()[frfs.lines().len() - 1];
    let expected = model.modes.iter().filter(|mode| mode.frequency.value <= last).count();
    // No more than the model may have, and some: with all orders that a chart can have, ripples of the noise
    // are looked at one by one.
    let orders = Some((2, 2 * expected + FURTHER_ORDERS));
    let quick = ModalAnalysis::of(frfs, &ModesOptions { orders, ..ModesOptions::default() });
    let analysis = match quick {
        Err(ModesError::Orders { .. }) => ModalAnalysis::of(frfs, &ModesOptions::default()),
        quick => quick,
    };
    let analysis = analysis.map_err(|error| error.to_string())?.without_window(window_decay);
    let matched = measured_damping(fixture, &analysis);
    let pairs = |index: usize| {
        let matched = matched.as_ref().ok()?;
        let pair = matched.matches.pairs.iter().find(|pair| pair.measured == index)?;
        Some((matched.elastic[pair.expected], pair.mac))
    };
    let mut modes: Vec<ModePair> = analysis
        .modes
        .iter()
        .enumerate()
        .map(|(index, mode)| ModePair {
            frequency: mode.frequency,
            std: mode.frequency_std,
            damping_ratio: mode.damping_ratio,
            fixture: pairs(index).map(|pair| pair.0),
            mac: pairs(index).map(|pair| pair.1),
            on_supports: false,
        })
        .collect();
    pair_on_supports(&mut modes, model);
    let hz = analysis.lines().hz();
    let within = |f: &f64| *f >= hz[0] && *f <= hz[hz.len() - 1];
    let missing = match &matched {
        Ok(matched) => {
            let others = matched.matches.other_expected.iter().map(|e| matched.elastic[*e]);
            others.filter(within).collect()
        }
        Err(_) => Vec::new(),
    };
    Ok(RecordedModes { modes, missing })
}

/// Pairs what no elastic mode is with the modes in which the fixture moves as rigid on its supports, in their
/// order: foam that is softer than stated lowers all of them.
fn pair_on_supports(modes: &mut [ModePair], model: &ModelModes) {
    let suspended: Vec<Figure> =
        model.modes.iter().filter(|mode| mode.on_supports).map(|mode| mode.frequency).collect();
    let open: Vec<usize> = (0..modes.len()).filter(|&m| modes[m].fixture.is_none()).collect();
    let apart = |m: usize, s: usize| (modes[m].frequency / suspended[s].value).ln().abs();
    // The fewer along the more of them.
    let count = open.len().min(suspended.len());
    let beside = |skipped: usize| -> Vec<(usize, usize)> {
        let (first_open, first) = if open.len() > count { (skipped, 0) } else { (0, skipped) };
        (0..count).map(|k| (open[first_open + k], first + k)).collect()
    };
    let distance = |pairs: &Vec<(usize, usize)>| -> f64 { pairs.iter().map(|&(m, s)| apart(m, s)).sum() };
    let all = (0..=open.len().max(suspended.len()) - count).map(beside);
    let Some(nearest) = all.min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return };
    let is_near = |&(m, s): &(usize, usize)| {
        let Figure { value, std, .. } = suspended[s];
        apart(m, s) < SUSPENSION.max(DEVIATIONS * std.unwrap_or(0.0) / value)
    };
    let paired: Vec<(usize, usize)> = nearest.into_iter().filter(is_near).collect();
    for (m, s) in paired {
        (modes[m].fixture, modes[m].on_supports) = (Some(suspended[s].value), true);
    }
}
