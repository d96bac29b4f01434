//! The state of a structure that a change is told from.

use crate::settings::statements::baseline::{ALIKE, FEWEST_ALIKE, MORE_THAN_NOISE};
use crate::{Fit, Observation};
use serde::Serialize;

/// A recording of the structure as it was known to be right, and what the fixture calibrated on it makes of
/// it.
#[derive(Debug, Clone)]
pub struct Baseline {
    /// FRFs and noise of that recording.
    pub observation: Observation,
    /// The fixture with its quantities where that recording puts them.
    pub calibrated: Fit,
    /// The modes then and now, ascending in frequency.
    pub modes: Vec<ModeChange>,
}

impl Baseline {
    /// ln of the ratio by which all natural frequencies have changed, where three or more have changed by the
    /// same and by more than noise explains: every modulus lower alike, every mass heavier.
    pub fn common_change(&self) -> Option<f64> {
        let both = |mode: &ModeChange| Some((mode.change?.frequency, mode.change_std?.frequency));
        let all: Vec<(f64, f64)> = self.modes.iter().filter_map(both).collect();
        if all.len() < FEWEST_ALIKE || self.modes.iter().any(|mode| mode.change.is_none()) {
            return None;
        }
        let mean = all.iter().map(|(change, _)| change).sum::<f64>() / all.len() as f64;
        let is_alike = |&(change, std): &(f64, f64)| {
            let noise = MORE_THAN_NOISE * std;
            change.abs() > noise && (change - mean).abs() <= noise.max(ALIKE * mean.abs())
        };
        all.iter().all(is_alike).then_some(mean)
    }
}

/// Natural frequency and damping ratio of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModeState {
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// A mode then and now.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModeChange {
    /// On the baseline, where that shows it.
    pub baseline: Option<ModeState>,
    /// On the recording that was diagnosed, where that shows it.
    pub now: Option<ModeState>,
    /// ln of the ratios of now to then, where both show it.
    pub change: Option<ModeState>,
    /// Standard deviations of these by the noise of both recordings.
    pub change_std: Option<ModeState>,
    /// The same ratios by the model with the findings; absent without any.
    pub predicted: Option<ModeState>,
}

impl ModeChange {
    /// Whether its frequency or damping ratio has changed by more than noise explains.
    pub fn has_changed(&self) -> bool {
        let beyond = |change: f64, std: f64| change.abs() > MORE_THAN_NOISE * std;
        self.change.zip(self.change_std).is_some_and(|(change, std)| {
            beyond(change.frequency, std.frequency) || beyond(change.damping_ratio, std.damping_ratio)
        })
    }
}
