//! The noise of the FRFs, and whether it holds.

use super::subject::Subject;
use crate::format::{fixed, significant};
use crate::section::{Block, Section};
use crate::table::Table;

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let correlation = diagnosis.residual_correlation;
    let white = if diagnosis.model_error.is_some() {
        "the error of the model is larger than the noise, and correlates over lines as noise does not"
    } else if diagnosis.is_white() {
        "they are white, as noise is"
    } else {
        "they are not white: either something is left in them, or the noise is not what coherence says, and gains count for less and intervals are wider \
         for it"
    };
    let (chi2, p) = diagnosis.refitted;
    let chance = if p < 1e-6 { "below 10⁻⁶".to_owned() } else { significant(p, 2) };
    Section::new("Noise")
        .paragraph(format!(
            "Residuals of the best model on neighbouring lines correlate by {}: {white}. The refitted fixture leaves χ² per degree of freedom {}; \
             the probability of as much by chance is {chance}, with the noise's own uncertainty counted in.",
            fixed(correlation, 2),
            significant(chi2, 4),
        ))
        .with(table(subject))
}

fn table(subject: &Subject) -> impl Into<Block> {
    let diagnosis = subject.diagnosis;
    let observation = &diagnosis.observation;
    let table = Table::of(0..observation.pairs().len())
        .words("FRF", |index| observation.pairs()[*index].to_string())
        .words("Noise from", |index| {
            observation.noise().get(*index).map_or("variances given", |source| source.says())
        })
        .numbers("Noise to signal, median", "%", |index| {
            let ratios = noise_to_signal(subject, *index);
            significant(100.0 * ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN), 2)
        })
        .numbers("Values in use", "", |index| (2 * noise_to_signal(subject, *index).len()).to_string());
    subject.models().into_iter().skip(1).fold(table, |table, (name, fit)| {
        let misfit = diagnosis.misfit(fit);
        table.numbers(format!("χ² per value, {name}"), "", |index| {
            significant(misfit[*index].whole.unwrap_or(f64::NAN), 4)
        })
    })
}

/// Standard deviation over magnitude of each value in use, ascending.
fn noise_to_signal(subject: &Subject, index: usize) -> Vec<f64> {
    let observation = &subject.diagnosis.observation;
    let n = observation.lines().len();
    let lines = index * n..(index + 1) * n;
    let mut ratios: Vec<f64> = observation.values()[lines.clone()]
        .iter()
        .zip(&observation.weights()[lines])
        .filter(|(value, weight)| **weight > 0.0 && value.norm() > 0.0)
        .map(|(value, weight)| (2.0 / weight).sqrt() / value.norm())
        .collect();
    ratios.sort_unstable_by(f64::total_cmp);
    ratios
}
