//! Modes of each reference's FRFs, and of each FRF, as a free fit has them.

use super::table::{Cell, Table, chance};
use crate::modal::recorded;
use crate::settings::drift::poles::{KNOWN_SHARE, MOST_DAMPING_FACTOR, MOST_MOVED};
use crate::{Hypothesis, Observation};
use jointscope_inference::each;
use jointscope_model_error::{RecordedMode, RecordedModes};
use jointscope_spectra::Channel;

/// The recording's references, in its order.
pub(crate) fn references(observation: &Observation) -> Vec<Channel> {
    distinct(observation.pairs().iter().map(|pair| &pair.reference))
}

/// Channels, each once, in the order in which they come.
pub(crate) fn distinct<'a>(channels: impl Iterator<Item = &'a Channel>) -> Vec<Channel> {
    let mut all: Vec<Channel> = Vec::new();
    for channel in channels {
        if !all.contains(channel) {
            all.push(channel.clone());
        }
    }
    all
}

/// One reference's FRFs and the modes of a free fit of them.
pub(super) struct ReferenceModes {
    part: Observation,
    modes: RecordedModes,
}

/// The FRFs of each reference by themselves; `None` where they have no modes.
pub(super) fn by_reference(
    observation: &Observation,
    nominal: &Hypothesis,
    references: &[Channel],
) -> Vec<Option<ReferenceModes>> {
    each(references, |reference| {
        let part = observation.reduced(|_| true, |pair| pair.reference == *reference)?;
        let modes = recorded(&part, nominal)?;
        Some(ReferenceModes { part, modes })
    })
}

/// Whether a free fit of some reference leaves χ² per degree of freedom between these.
pub(super) fn leaves_between(struck: &[Option<ReferenceModes>], (least, most): (f64, f64)) -> bool {
    struck.iter().flatten().any(|own| (least..most).contains(&own.modes.chi2_per_dof))
}

/// Modes of one reference, and what all FRFs say of them.
pub(super) struct PolesByFrf<'a> {
    pub modes: &'a RecordedModes,
    pub table: Table,
    /// By reference; `None` where a free fit does not tell all there is.
    pub own: Vec<Option<OwnModes<'a>>>,
}

/// The modes of one reference's FRFs by themselves.
pub(super) struct OwnModes<'a> {
    pub modes: &'a RecordedModes,
    /// Which of them is each mode of the table.
    pub compared: Vec<Option<usize>>,
}

/// What the FRFs say, of references whose free fits leave less than `most_left` in χ² per degree of freedom:
/// where modes do not tell all there is in the FRFs, what they leave moves them too. `None` where the
/// references' modes differ no more than chance makes with the probability `certain`, each reference's FRFs
/// taken together.
pub(super) fn poles_by_frf<'a>(
    observation: &Observation,
    struck: &'a [Option<ReferenceModes>],
    (most_left, certain): (f64, f64),
) -> Option<PolesByFrf<'a>> {
    let tells = |own: &&ReferenceModes| own.modes.chi2_per_dof < most_left;
    let struck: Vec<Option<&ReferenceModes>> = struck.iter().map(|own| own.as_ref().filter(tells)).collect();
    // The reference that shows most modes well is the one that the others are compared with.
    let known_poles = |struck: &Option<&ReferenceModes>| {
        struck.map_or(0, |s| (0..s.modes.modes.len()).filter(|&r| variance(&s.modes, r).is_some()).count())
    };
    let (first, _) = struck.iter().enumerate().rev().max_by_key(|(_, struck)| known_poles(struck))?;
    let base = &struck[first]?.modes;
    let mut partners: Vec<Vec<Option<usize>>> = Vec::new();
    for struck in &struck {
        partners.push(match struck {
            Some(struck) => partners_of(base, &struck.modes),
            None => vec![None; base.modes.len()],
        });
    }
    let is_compared =
        |r: &usize| variance(base, *r).is_some() && partners.iter().filter(|of| of[*r].is_some()).count() > 1;
    let compared: Vec<usize> = (0..base.modes.len()).filter(is_compared).collect();
    if probability_by_chance(base, &compared, &struck, &partners) >= certain {
        return None;
    }
    let responses = distinct(observation.pairs().iter().map(|pair| &pair.response));
    let cells = cells(base, &compared, (&struck, &partners), &responses);
    let half_widths = compared.iter().map(|&r| base.modes[r].pole.damping_ratio).collect();
    let own = struck.iter().zip(&partners).map(|(own, of)| {
        own.map(|own| OwnModes { modes: &own.modes, compared: compared.iter().map(|&r| of[r]).collect() })
    });
    let own = own.collect();
    let table =
        Table { cells, modes: compared, half_widths, responses: responses.len(), references: struck.len() };
    Some(PolesByFrf { modes: base, table, own })
}

/// ln of the natural frequency of each `compared` mode over that of `base`, FRF by FRF.
fn cells(
    base: &RecordedModes,
    compared: &[usize],
    (struck, partners): (&[Option<&ReferenceModes>], &[Vec<Option<usize>>]),
    responses: &[Channel],
) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (reference, (struck, of)) in struck.iter().zip(partners).enumerate() {
        let Some(ReferenceModes { part, modes }) = struck else { continue };
        let alone = match part.pairs().len() {
            1 => vec![Some(modes.clone())],
            _ => modes.one_by_one(part.weighted()),
        };
        for (pair, alone) in part.pairs().iter().zip(&alone) {
            let (Some(alone), Some(response)) = (alone, responses.iter().position(|o| *o == pair.response))
            else {
                continue;
            };
            for (mode, &r) in compared.iter().enumerate() {
                let own = of[r].filter(|&own| same(&alone.modes[own], &modes.modes[own]));
                if let Some(variance) = own.and_then(|own| variance(alone, own)) {
                    let omega = own.map_or(f64::NAN, |own| alone.modes[own].pole.omega);
                    let ln_omega = (omega / base.modes[r].pole.omega).ln();
                    cells.push(Cell { mode, response, reference, ln_omega, variance });
                }
            }
        }
    }
    cells
}

/// Probability of natural frequencies of the `compared` modes of `base` that differ as much between
/// references by chance.
fn probability_by_chance(
    base: &RecordedModes,
    compared: &[usize],
    struck: &[Option<&ReferenceModes>],
    partners: &[Vec<Option<usize>>],
) -> f64 {
    let (mut chi2, mut degrees) = (0.0, 0);
    for &r in compared {
        let values: Vec<(f64, f64)> = struck
            .iter()
            .zip(partners)
            .filter_map(|(struck, of)| {
                let (modes, own) = (&struck.as_ref()?.modes, of[r]?);
                Some(((modes.modes[own].pole.omega / base.modes[r].pole.omega).ln(), variance(modes, own)?))
            })
            .collect();
        let weight: f64 = values.iter().map(|(_, variance)| 1.0 / variance).sum();
        let mean = values.iter().map(|(x, variance)| x / variance).sum::<f64>() / weight;
        chi2 += values.iter().map(|(x, variance)| (x - mean).powi(2) / variance).sum::<f64>();
        degrees += values.len() - 1;
    }
    chance(chi2, degrees, 1.0, 0)
}

/// Whether two fits' modes can be the same mode of a structure.
fn same(own: &RecordedMode, begun: &RecordedMode) -> bool {
    let apart = |own: f64, begun: f64| (own / begun).ln().abs();
    apart(own.pole.omega, begun.pole.omega) < MOST_MOVED
        && apart(own.pole.damping_ratio, begun.pole.damping_ratio) < MOST_DAMPING_FACTOR.ln()
}

/// Variance of ln ω of a mode; `None` where it is not known well enough.
fn variance(modes: &RecordedModes, r: usize) -> Option<f64> {
    let mode = &modes.modes[r];
    let [deviation, _] = modes.deviations(r);
    let half_width = mode.pole.damping_ratio;
    let is_known = mode.resolved && deviation < KNOWN_SHARE * half_width;
    is_known.then(|| deviation.powi(2))
}

/// For each mode of `base` the mode that is nearest among `other`'s and has it nearest too.
fn partners_of(base: &RecordedModes, other: &RecordedModes) -> Vec<Option<usize>> {
    let nearest = |to: f64, among: &[RecordedMode]| {
        let apart = |r: &usize| (among[*r].pole.omega / to).ln().abs();
        (0..among.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).filter(|r| apart(r) < MOST_MOVED)
    };
    let partner = |r: usize| {
        let own = nearest(base.modes[r].pole.omega, &other.modes)?;
        let back = nearest(other.modes[own].pole.omega, &base.modes)?;
        let is_one = back == r && same(&other.modes[own], &base.modes[r]);
        (is_one && variance(other, own).is_some()).then_some(own)
    };
    (0..base.modes.len()).map(partner).collect()
}
