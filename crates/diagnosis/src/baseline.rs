//! The state of a structure that a change is told from.

use crate::settings::statements::baseline::MORE_THAN_NOISE;
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
