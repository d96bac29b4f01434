//! The noise that everything is judged against, and whether it holds.

use jointscope_frf::noise::NoiseSource;

use super::Subject;
use crate::format::{fixed, significant};
use crate::{Column, Section, Table};

/// Correlation of neighbouring lines from which residuals are not called white.
const WHITE: f64 = 0.2;

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let observation = &diagnosis.observation;
    let n = observation.lines().len();
    let models: Vec<_> = subject.models().into_iter().skip(1).collect();
    let mut columns = vec![
        Column::text("FRF"),
        Column::text("Noise from"),
        Column::numbers("Noise to signal, median", "%"),
        Column::numbers("Values in use", ""),
    ];
    columns.extend(models.iter().map(|(name, _)| Column::numbers(format!("χ² per value, {name}"), "")));
    let misfits: Vec<_> = models.iter().map(|(_, fit)| diagnosis.misfit(fit)).collect();
    let mut table = Table::new(columns);
    for (index, pair) in observation.pairs().iter().enumerate() {
        let lines = index * n..(index + 1) * n;
        let weights = &observation.weights()[lines.clone()];
        let mut ratios: Vec<f64> = observation.values()[lines]
            .iter()
            .zip(weights)
            .filter(|(value, weight)| **weight > 0.0 && value.norm() > 0.0)
            .map(|(value, weight)| (2.0 / weight).sqrt() / value.norm())
            .collect();
        ratios.sort_unstable_by(f64::total_cmp);
        let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
        let source = match observation.noise().get(index) {
            Some(NoiseSource::Coherence) => "coherence and averages",
            Some(NoiseSource::Scatter) => "scatter over the lines",
            None => "variances given",
        };
        let mut cells = vec![
            pair.to_string(),
            source.to_owned(),
            significant(100.0 * median, 2),
            (2 * ratios.len()).to_string(),
        ];
        cells.extend(misfits.iter().map(|misfit| significant(misfit[index].whole.unwrap_or(f64::NAN), 4)));
        table = table.row(cells);
    }
    let correlation = diagnosis.residual_correlation;
    let white = if correlation.abs() < WHITE {
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
        .table(table)
}
