//! Whether FRFs are of the form that their file says.
//!
//! A receptance read as an accelerance is 1/ω² of it: ln of recorded over modelled falls along ln ω with a
//! slope of −2, whatever resonances do to single lines.

use crate::levels::median;
use crate::settings::form::{BAND_PARTS, LEVEL_TOLERANCE, LINES_PER_PART, SLOPE_TOLERANCE};
use jointscope_spectra::{FrfForm, FrfSet};
use num_complex::Complex64;

/// The form that the FRFs are of, where that is plainly another one than accelerance; `modelled` are the
/// fixture's accelerances.
pub(crate) fn other_form(frfs: &FrfSet, modelled: &[Complex64]) -> Option<FrfForm> {
    let count = frfs.lines().len();
    let omegas: Vec<f64> = frfs.lines().omegas().collect();
    // (ln ω, ln of recorded over modelled), the median over FRFs and lines of each part.
    let first = omegas.iter().copied().find(|omega| *omega > 0.0)?.ln();
    let width = (omegas.last()?.ln() - first) / BAND_PARTS as f64;
    let part = |omega: f64| (((omega.ln() - first) / width) as usize).min(BAND_PARTS - 1);
    let mut parts: Vec<Vec<f64>> = vec![Vec::new(); BAND_PARTS];
    for (at, (recorded, modelled)) in frfs.all_values().iter().zip(modelled).enumerate() {
        let (omega, ratio) = (omegas[at % count], (recorded / modelled).norm());
        if omega > 0.0 && ratio > 0.0 && ratio.is_finite() {
            parts[part(omega)].push(ratio.ln());
        }
    }
    let least = LINES_PER_PART * frfs.pairs().len();
    let by_part: Vec<(f64, f64)> = parts
        .into_iter()
        .enumerate()
        .filter(|(_, ratios)| ratios.len() >= least)
        .filter_map(|(part, ratios)| Some((first + width * (part as f64 + 0.5), median(ratios)?)))
        .collect();
    let slopes = by_part
        .iter()
        .enumerate()
        .flat_map(|(i, a)| by_part[..i].iter().map(move |b| (a.1 - b.1) / (a.0 - b.0)));
    let slope = median(slopes.collect())?;
    [FrfForm::Mobility, FrfForm::Receptance].into_iter().find(|form| {
        let powers = f64::from(form.order() - FrfForm::Accelerance.order());
        let levels = by_part.iter().map(|(ln_omega, ratio)| ratio - powers * ln_omega);
        (slope - powers).abs() < SLOPE_TOLERANCE
            && median(levels.collect()).is_some_and(|level| level.abs() < LEVEL_TOLERANCE)
    })
}
