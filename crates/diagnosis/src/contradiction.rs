//! Lines that contradict all others, whatever the structure: mains hum, clipped peaks, a tone from elsewhere.
//!
//! Any linear structure's FRFs are sums over modes with common poles. Where a free fit of such a sum leaves next to nothing but on few lines, and those are off in the
//! FRFs at large, it is these lines that are wrong, and no model has to explain them.

use crate::modal::recorded;
use crate::{Hypothesis, Observation};
use jointscope_frf::breaks;

use crate::settings::ModalSettings;

/// χ² of a line, per value, from which it contradicts, as a multiple of the median line's.
const CONTRADICTS: f64 = 25.0;
/// Share of the lines that may.
const MOST: f64 = 0.08;
/// χ² per degree of freedom of a free fit from which lines are looked for, and what their absence must leave of it.
const POOR: f64 = 2.0;
const LEFT: f64 = 0.3;
/// Lines from one break to the next of what was clipped, at most.
const APART: usize = 12;
/// Rounds in which more of them are found: a fit that has to follow a wrong line hides its neighbours.
const ROUNDS: usize = 5;

/// Bands (Hz) of lines that contradict all others; none where there is nothing of the kind.
pub(crate) fn contradictory(
    observation: &Observation,
    nominal: &Hypothesis,
    settings: &ModalSettings,
) -> Vec<(f64, f64)> {
    let breaks = breaks(observation.frfs(), observation.weights());
    if breaks.is_empty() {
        return Vec::new();
    }
    let hz = observation.lines().hz().to_vec();
    let without = |wrong: &[bool]| {
        let seen = |line: f64| hz.iter().position(|hz| *hz == line).is_some_and(|at| !wrong[at]);
        let part = observation.reduced(seen, |_| true)?;
        let modes = recorded(&part, nominal, settings)?;
        Some((part, modes))
    };
    let many = |wrong: &[bool]| wrong.iter().filter(|wrong| **wrong).count() as f64 > MOST * hz.len() as f64;
    let mut wrong = vec![false; hz.len()];
    let mut before = None;
    for _ in 0..ROUNDS {
        let Some((part, modes)) = without(&wrong) else { return Vec::new() };
        let first = *before.get_or_insert(modes.chi2_per_dof);
        if first < POOR {
            return Vec::new();
        }
        if modes.chi2_per_dof < POOR && modes.chi2_per_dof < LEFT * first {
            return bands(&hz, &wrong);
        }
        let mut sorted = modes.misfit.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0).max(1.0);
        for (line, misfit) in part.lines().hz().iter().zip(&modes.misfit) {
            if *misfit > CONTRADICTS * usual
                && let Some(at) = hz.iter().position(|hz| hz == line)
            {
                wrong[at] = true;
            }
        }
        if many(&wrong) {
            break;
        }
    }
    // A wrong peak bends the fit of all lines: then whatever lies between two breaks close to each other.
    let mut between = vec![false; hz.len()];
    for pair in breaks.windows(2).filter(|pair| pair[1] - pair[0] <= APART) {
        between[pair[0]..=pair[1]].fill(true);
    }
    let better = |chi2: f64| chi2 < POOR && before.is_some_and(|before| chi2 < LEFT * before);
    match without(&between) {
        Some((_, modes)) if !many(&between) && better(modes.chi2_per_dof) => bands(&hz, &between),
        _ => Vec::new(),
    }
}

/// Runs of wrong lines, gaps of one line closed.
fn bands(hz: &[f64], wrong: &[bool]) -> Vec<(f64, f64)> {
    let mut bands: Vec<(usize, usize)> = Vec::new();
    for line in (0..wrong.len()).filter(|&line| wrong[line]) {
        match bands.last_mut() {
            Some((_, last)) if line <= *last + 2 => *last = line,
            _ => bands.push((line, line)),
        }
    }
    bands.into_iter().map(|(from, to)| (hz[from], hz[to])).collect()
}
