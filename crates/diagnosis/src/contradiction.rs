//! Lines that contradict all others, whatever the structure: mains hum, clipped peaks, a tone from elsewhere.
//!
//! Any linear structure's FRFs are sums over modes with common poles. Where a free fit of such a sum leaves
//! next to nothing but on few lines, and those are off in the FRFs at large, it is these lines that are
//! wrong, and no model has to explain them. A single wrong line is told by its neighbours, of any FRF, or
//! where that is too many, of the FRFs at large; where more of them lie side by side, the fit of all lines tells.

use crate::modal::recorded;
use crate::settings::lines::contradiction::{
    CONTRADICTS, MISFIT, MOST_BETWEEN_BREAKS, MOST_SHARE, NEAR_MODE, REMAINING_SHARE, ROUNDS,
};
use crate::{DiagnosisError, Hypothesis, Observation};
use jointscope_fixture::Fixture;
use jointscope_frf::{breaks, lone_lines};
use jointscope_lumped::Assembly;
use jointscope_spectra::FrfSet;

/// Bands (Hz) of lines of `frfs` that contradict all others: what a diagnosis leaves out before it begins.
///
/// # Errors
/// FRFs that cannot be used, or a fixture that cannot be modelled between their channels.
pub fn contradictory_lines(fixture: &Fixture, frfs: &FrfSet) -> Result<Vec<(f64, f64)>, DiagnosisError> {
    let observation = Observation::new(frfs, |_| true)?;
    let nominal = Hypothesis::nominal(fixture, false);
    nominal.predict(&observation)?;
    Ok(contradictory(&observation, &nominal))
}

/// Bands (Hz) of lines that contradict all others; none where there is nothing of the kind.
pub(crate) fn contradictory(observation: &Observation, nominal: &Hypothesis) -> Vec<(f64, f64)> {
    let breaks = breaks(observation.frfs(), observation.weights());
    let [of_any, of_half] = lone_lines(observation.frfs(), observation.weights());
    if breaks.is_empty() && of_any.is_empty() {
        return Vec::new();
    }
    let hz = observation.lines().hz().to_vec();
    let at = |line: f64| hz.binary_search_by(|hz| hz.total_cmp(&line)).ok();
    let without = |wrong: &[bool]| {
        let seen = |line: f64| at(line).is_some_and(|at| !wrong[at]);
        let part = observation.reduced(seen, |_| true)?;
        let modes = recorded(&part, nominal)?;
        Some((part, modes))
    };
    let many =
        |wrong: &[bool]| wrong.iter().filter(|wrong| **wrong).count() as f64 > MOST_SHARE * hz.len() as f64;
    let mut wrong = vec![false; hz.len()];
    let whole = without(&wrong);
    let before = whole.as_ref().map_or(f64::INFINITY, |(_, modes)| modes.chi2_per_dof);
    let much_better = |chi2_per_dof: f64| chi2_per_dof < REMAINING_SHARE * before;
    let mut singles = [of_any, of_half].map(|lone| lines_of_no_mode(&lone, &hz, nominal)).to_vec();
    singles.dedup();
    for single in singles {
        if single.contains(&true)
            && !many(&single)
            && let Some((_, modes)) = without(&single)
            // A free fit may follow a wrong line with a mode of its own: then nothing is lost without both.
            && (much_better(modes.chi2_per_dof) || modes.chi2_per_dof < MISFIT)
        {
            return bands(&hz, &single);
        }
    }
    if before < MISFIT {
        return Vec::new();
    }
    let Some((mut part, mut modes)) = whole else { return Vec::new() };
    let better = |chi2_per_dof: f64| chi2_per_dof < MISFIT && much_better(chi2_per_dof);
    for _ in 0..ROUNDS {
        let mut sorted = modes.misfit.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0).max(1.0);
        for (line, misfit) in part.lines().hz().iter().zip(&modes.misfit) {
            if *misfit > CONTRADICTS * usual
                && let Some(at) = at(*line)
            {
                wrong[at] = true;
            }
        }
        if many(&wrong) {
            break;
        }
        let Some(fewer) = without(&wrong) else { return Vec::new() };
        (part, modes) = fewer;
        if better(modes.chi2_per_dof) {
            return bands(&hz, &wrong);
        }
    }
    // A wrong peak bends the fit of all lines: then whatever lies between two breaks close to each other.
    let mut between = vec![false; hz.len()];
    for pair in breaks.windows(2).filter(|pair| pair[1] - pair[0] <= MOST_BETWEEN_BREAKS) {
        between[pair[0]..=pair[1]].fill(true);
    }
    match without(&between) {
        Some((_, modes)) if !many(&between) && better(modes.chi2_per_dof) => bands(&hz, &between),
        _ => Vec::new(),
    }
}

/// Which lines are lone ones at which the fixture has no mode either: the peak of one that is damped very
/// little may be all of it that shows.
fn lines_of_no_mode(lone: &[usize], hz: &[f64], nominal: &Hypothesis) -> Vec<bool> {
    let mut single = vec![false; hz.len()];
    let (Some(highest), Ok(fixture)) = (hz.last(), nominal.to_fixture()) else { return single };
    let Ok(assembly) = Assembly::new(&fixture, *highest) else { return single };
    let modes = assembly.natural_frequencies_hz();
    for &line in lone {
        let [from, to] = [line.saturating_sub(NEAR_MODE), (line + NEAR_MODE).min(hz.len() - 1)];
        single[line] = !modes.iter().any(|mode| (hz[from]..=hz[to]).contains(mode));
    }
    single
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
