//! The tolerances used, and where they ended.

use super::Subject;
use crate::format::{quantity, significant};
use crate::section::{Section, Tone};
use crate::table::Table;

/// Standard deviations beyond which a quantity has been bent rather than adjusted.
const BENT: f64 = 2.0;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let models: Vec<_> = subject.models().into_iter().skip(1).collect();
    let tolerances = models.first()?.1.hypothesis.tolerances();
    if tolerances.is_empty() {
        return Some(
            Section::new("Tolerances")
                .paragraph("The fixture states every quantity as exact: there was nothing to refit."),
        );
    }
    let farthest = |index: usize| {
        let departures = models.iter().map(|(_, fit)| fit.hypothesis.departure(index).abs());
        tolerances[index].quantity.std.map_or(0.0, |_| departures.fold(0.0, f64::max))
    };
    let bent = (0..tolerances.len()).filter(|index| farthest(*index) > BENT).count();
    let mut table = Table::of(tolerances.iter().map(|tolerance| &tolerance.quantity).enumerate())
        .words("Quantity", |(_, own)| own.path.clone())
        .words("Stated", |(_, own)| {
            let stated = quantity(own.value, own.std, own.key.unit());
            if own.std.is_some() { stated } else { format!("{stated} (unknown, left free)") }
        });
    for (name, fit) in &models {
        table = table
            .words(*name, |(index, own)| quantity(fit.hypothesis.ended_at(*index), None, own.key.unit()))
            .numbers(format!("departure, {name}"), "std", |(index, own)| match own.std {
                Some(_) => significant(fit.hypothesis.departure(*index), 2),
                None => "free".to_owned(),
            });
    }
    let table = table.marked(|(index, _)| (farthest(*index) > BENT).then_some(Tone::Attention));
    let words = match (bent, subject.diagnosis.findings.is_empty()) {
        (0, _) => "No quantity had to move by more than two of its standard deviations.".to_owned(),
        (n, true) => format!(
            "{n} of {} moved by more than two standard deviations (marked); one in twenty does so by chance, more than that calls the stated \
             values in doubt.",
            tolerances.len()
        ),
        (n, false) => format!(
            "{n} moved by more than two standard deviations in one of the models (marked): without the findings a refit bends quantities to \
             imitate what is missing."
        ),
    };
    Some(Section::new("Tolerances").paragraph(words).with(table.footnote(
        "Young's modulus and second moment of a joint act as a product only: one of them carries the deviation of both.",
    )))
}
