//! The judgement on lines and FRFs that no fit saw.

use crate::evidence::same_names;
use crate::fit::Fit;
use crate::search::Search;
use crate::{DiagnosisError, DiagnosisOptions, Observation};
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfPair;

/// What the fit never saw, and how well it was predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOut {
    /// Bands, Hz, and an FRF, in words: `band 180:240`, `frf 4/2`.
    pub what: Vec<String>,
    /// Error of the refitted fixture there.
    pub nrmse_refitted: f64,
    /// Error of the repaired one.
    pub nrmse_repaired: f64,
    /// Whether the selection without the held-out lines found the same names.
    pub same_findings: bool,
}

/// Share of the lines in each of the two bands held out.
const HELD_OUT_SHARE: f64 = 0.06;

/// Searches again without two bands and one FRF, and predicts them.
pub(crate) fn held_out(
    fixture: &Fixture,
    observation: &Observation,
    search: &Search,
    options: &DiagnosisOptions,
) -> Result<Option<HeldOut>, DiagnosisError> {
    let hz = observation.lines().hz();
    let n = hz.len();
    let width = ((n as f64 * HELD_OUT_SHARE) as usize).max(1);
    if n < 10 * width {
        return Ok(None);
    }
    // About a third and two thirds of the lines: neither the stiff nor the massy end alone.
    let bands: Vec<(f64, f64)> = [0.3, 0.62]
        .map(|at| ((n as f64 * at) as usize, width))
        .map(|(from, width)| (hz[from], hz[from + width]))
        .to_vec();
    let frfs = held_out_frfs(observation, options)?;
    let outside = |line: f64| !bands.iter().any(|(from, to)| line >= *from && line <= *to);
    let Some(seen) = observation.reduced(outside, |pair| !frfs.contains(pair)) else { return Ok(None) };
    // What is not named is not in the repaired fixture either, and needs no search.
    let named = search.repaired.hypothesis.effect_count() > 0;
    let again = if named {
        Search::of(fixture, &seen, options.exact)
    } else {
        Search::without_effects(fixture, &seen, options.exact)
    };
    let Some(again) = again else { return Ok(None) };
    let error = |fit: &Fit| -> Option<f64> {
        let predicted = fit.hypothesis.predict(observation).ok()?;
        let unseen = |index: usize| frfs.contains(&observation.pairs()[index / n]) || !outside(hz[index % n]);
        let (mut error, mut size) = (0.0, 0.0);
        for index in (0..predicted.len()).filter(|i| unseen(*i)) {
            error += (observation.values()[index] - predicted[index]).norm_sqr();
            size += observation.values()[index].norm_sqr();
        }
        Some((error / size).sqrt())
    };
    let (Some(nrmse_refitted), Some(nrmse_repaired)) = (error(&again.refitted), error(&again.repaired))
    else {
        return Ok(None);
    };
    let what = bands
        .iter()
        .map(|(from, to)| format!("band {from}:{to}"))
        .chain(frfs.iter().map(|p| format!("frf {p}")));
    let same_findings = same_names(&again.repaired.hypothesis, &search.repaired.hypothesis);
    Ok(Some(HeldOut { what: what.collect(), nrmse_refitted, nrmse_repaired, same_findings }))
}

fn held_out_frfs(
    observation: &Observation,
    options: &DiagnosisOptions,
) -> Result<Vec<FrfPair>, DiagnosisError> {
    let pairs = observation.pairs();
    if let Some(missing) = options.hold_out.iter().find(|pair| !pairs.contains(pair)) {
        return Err(DiagnosisError::HoldOut(missing.to_string()));
    }
    match (options.hold_out.as_slice(), pairs) {
        ([], [.., last]) if pairs.len() >= 4 => Ok(vec![last.clone()]),
        ([], _) => Ok(Vec::new()),
        (named, _) if named.len() >= pairs.len() => Err(DiagnosisError::HoldOut(named[0].to_string())),
        (named, _) => Ok(named.to_vec()),
    }
}
