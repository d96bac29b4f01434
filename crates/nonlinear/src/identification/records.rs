//! The hits of a test as the diagnosis uses them: noise, levels, what is held out.

use crate::DiagnoseError;
use crate::settings::hits::{
    BEFORE_BLOW, BLOW_BEGINS, FEWEST_SAMPLES, FEWEST_TO_HOLD_OUT, HELD_OUT_EVERY, LEAST_NOISE, LEVELS_APART,
    LEVELS_WITHOUT_GAPS, TELLING,
};
use crate::spectra::noise;
use crate::time::structure::{Reading, station};
use jointscope_fixture::{Fixture, Side};
use jointscope_hits::Hit;
use jointscope_spectra::Channel;
use std::collections::BTreeSet;

/// A hit with the noise of its signals.
#[derive(Debug, Clone)]
pub(crate) struct Record {
    pub hit: Hit,
    /// What each response reads.
    pub readings: Vec<Reading>,
    /// Standard deviation of each response's noise, in its unit.
    pub noise: Vec<f64>,
    /// Standard deviation of the force's noise, N.
    pub force_noise: f64,
    /// First sample of the blow.
    pub onset: usize,
    /// Index of its level among those of its test, from the weakest.
    pub level: usize,
}

impl Record {
    fn new(hit: &Hit) -> Self {
        let peak = hit.peak_force();
        let onset = hit.force().iter().position(|f| f.abs() > BLOW_BEGINS * peak).unwrap_or(0);
        // A signal without any noise (of a simulation) still is not known beyond its rounding.
        let floor = |values: &[f64]| {
            LEAST_NOISE * (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
        };
        Record {
            readings: hit.responses().iter().map(|r| (r.channel.clone(), r.motion)).collect(),
            noise: hit.responses().iter().map(|r| noise(&r.values).max(floor(&r.values))).collect(),
            force_noise: noise(hit.force()).max(floor(hit.force())),
            onset: onset.saturating_sub(BEFORE_BLOW),
            level: 0,
            hit: hit.clone(),
        }
    }

    pub(crate) fn struck(&self) -> &Channel {
        self.hit.struck()
    }

    /// Whether another hit was struck, read and sampled alike.
    pub(crate) fn has_setup_of(&self, other: &Record) -> bool {
        let interval = |record: &Record| record.hit.interval().to_bits();
        (self.struck(), &self.readings, interval(self)) == (other.struck(), &other.readings, interval(other))
    }

    /// Whether another hit is of the same strength at the same point.
    pub(crate) fn is_like(&self, other: &Record) -> bool {
        self.struck() == other.struck() && self.level == other.level
    }
}

/// The records of a test, checked, with their levels.
///
/// # Errors
/// Hits without force or response, hits that are all alike.
pub(crate) fn records(fixture: &Fixture, hits: &[Hit]) -> Result<Vec<Record>, DiagnoseError> {
    if hits.is_empty() {
        return Err(DiagnoseError::NoHits);
    }
    hits.iter().try_for_each(|hit| check(fixture, hit))?;
    let mut records: Vec<Record> = hits.iter().map(Record::new).collect();
    let ratio = set_levels(&mut records);
    if ratio < TELLING {
        return Err(DiagnoseError::OneLevel { hits: hits.len(), ratio });
    }
    Ok(records)
}

/// Refuses a hit of which nothing follows.
fn check(fixture: &Fixture, hit: &Hit) -> Result<(), DiagnoseError> {
    let number = hit.number();
    if hit.peak_force() == 0.0 {
        return Err(DiagnoseError::NoForce(number));
    }
    if hit.responses().is_empty() {
        return Err(DiagnoseError::NoResponse(number));
    }
    if let Some(silent) = hit.responses().iter().find(|r| r.values.iter().all(|v| *v == 0.0)) {
        return Err(DiagnoseError::SilentResponse { hit: number, channel: silent.channel.to_string() });
    }
    if hit.samples() < FEWEST_SAMPLES {
        let (samples, needed) = (hit.samples(), FEWEST_SAMPLES);
        return Err(DiagnoseError::TooShort { hit: number, samples, needed });
    }
    let responses = hit.responses().iter().map(|r| (&r.channel, Side::Response));
    let mut channels = responses.chain([(hit.struck(), Side::Reference)]);
    channels
        .try_for_each(|(channel, side)| station(fixture, channel, side).map(drop))
        .map_err(|error| DiagnoseError::Channel(number, error))
}

/// Numbers the levels of the hits at each struck point; answers with the ratio of strongest to weakest at the
/// point where it is largest.
fn set_levels(records: &mut [Record]) -> f64 {
    let mut widest: f64 = 1.0;
    for channel in struck_channels(records) {
        let mut group: Vec<usize> = (0..records.len()).filter(|&i| *records[i].struck() == channel).collect();
        group.sort_by(|a, b| records[*a].hit.peak_force().total_cmp(&records[*b].hit.peak_force()));
        let peak = |i: usize| records[i].hit.peak_force();
        let ratio = peak(group[group.len() - 1]) / peak(group[0]);
        widest = widest.max(ratio);
        let mut levels = vec![0; group.len()];
        for k in 1..group.len() {
            levels[k] = levels[k - 1] + usize::from(peak(group[k]) > LEVELS_APART * peak(group[k - 1]));
        }
        if levels[group.len() - 1] == 0 && ratio >= TELLING {
            // Strengths without gaps: thirds of the hits.
            let count = group.len().min(LEVELS_WITHOUT_GAPS);
            (0..group.len()).for_each(|k| levels[k] = k * count / group.len());
        }
        for (k, i) in group.iter().enumerate() {
            records[*i].level = levels[k];
        }
    }
    widest
}

/// Every channel that was struck, in order.
pub(crate) fn struck_channels(records: &[Record]) -> BTreeSet<Channel> {
    records.iter().map(|r| r.struck().clone()).collect()
}

/// Indices of the hits to hold out: the last of each group of two or more alike; every third where there are
/// no such groups but six or more hits.
pub(crate) fn held_out(records: &[Record]) -> Vec<usize> {
    let last = |i: &usize| {
        let (before, after) = (&records[..*i], &records[i + 1..]);
        let alike = |other: &Record| records[*i].is_like(other);
        before.iter().any(alike) && !after.iter().any(alike)
    };
    let held: Vec<usize> = (0..records.len()).filter(last).collect();
    match held.is_empty() && records.len() >= FEWEST_TO_HOLD_OUT {
        true => (0..records.len()).filter(|i| i % HELD_OUT_EVERY == 1).collect(),
        false => held,
    }
}
