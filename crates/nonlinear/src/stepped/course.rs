//! How a resonance goes with level, beyond the scatter of the fits.

use super::diagnosis::{LevelResult, SteppedDiagnosis};
use super::naming::TriedForm;
use crate::settings::levels::{DAMPING_DIFFERS, FREQUENCIES_DIFFER};
use crate::settings::naming::EXPLAINED_BY_TWO;

/// How the natural frequency goes from the lowest level to the highest.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FrequencyCourse<'a> {
    /// No change beyond scatter.
    Stays,
    /// It falls.
    Falls,
    /// It rises.
    Rises,
    /// It falls down to this level and rises again.
    Dips(&'a LevelResult),
    /// It rises up to this level and falls again.
    Peaks(&'a LevelResult),
}

/// How the damping ratio goes from the lowest level to the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DampingCourse {
    /// No change beyond scatter.
    Stays,
    /// It grows.
    Grows,
    /// It falls.
    Falls,
}

impl SteppedDiagnosis {
    /// How the natural frequency goes with level.
    pub fn frequency_course(&self) -> FrequencyCourse<'_> {
        let (Some(first), Some(last)) = (self.levels.first(), self.levels.last()) else {
            return FrequencyCourse::Stays;
        };
        let hz = |level: &LevelResult| level.resonance.frequency.0;
        let least = self.levels.iter().min_by(|a, b| hz(a).total_cmp(&hz(b))).unwrap_or(first);
        let most = self.levels.iter().max_by(|a, b| hz(a).total_cmp(&hz(b))).unwrap_or(last);
        let differ = |one: &LevelResult, other: &LevelResult| {
            let scatter = one.resonance.frequency.1.hypot(other.resonance.frequency.1);
            (hz(one) - hz(other)).abs() > FREQUENCIES_DIFFER * scatter
        };
        let turns = |at: &LevelResult| {
            at.held != first.held && at.held != last.held && differ(at, first) && differ(at, last)
        };
        match () {
            () if turns(least) => FrequencyCourse::Dips(least),
            () if turns(most) => FrequencyCourse::Peaks(most),
            () if !differ(first, last) => FrequencyCourse::Stays,
            () if hz(last) < hz(first) => FrequencyCourse::Falls,
            () => FrequencyCourse::Rises,
        }
    }

    /// How the damping ratio goes with level.
    pub fn damping_course(&self) -> DampingCourse {
        let (Some(first), Some(last)) = (self.levels.first(), self.levels.last()) else {
            return DampingCourse::Stays;
        };
        let (first, last) = (first.resonance.damping_ratio, last.resonance.damping_ratio);
        match last.0 - first.0 {
            change if change.abs() < DAMPING_DIFFERS * first.1.hypot(last.1) => DampingCourse::Stays,
            change if change > 0.0 => DampingCourse::Grows,
            _ => DampingCourse::Falls,
        }
    }

    /// Two laws at one joint that would explain the change with level where no more than one is named: with
    /// as many parameters they follow so few levels whatever the truth is.
    pub fn unproved_pair(&self) -> Option<&TriedForm> {
        let two = self.tried.iter().find(|tried| tried.form.contains('+') && tried.share >= EXPLAINED_BY_TWO);
        two.filter(|_| self.findings.len() <= 1)
    }
}
