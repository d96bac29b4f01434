//! The tolerances used, and where they ended.

use super::Subject;
use crate::format::{quantity, significant};
use crate::{Column, Section, Table, Tone};

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
    let mut columns = vec![Column::text("Quantity"), Column::text("Stated")];
    for (name, _) in &models {
        columns.push(Column::text(*name));
        columns.push(Column::numbers(format!("departure, {name}"), "std"));
    }
    let mut table = Table::new(columns);
    let mut bent = 0;
    for (index, tolerance) in tolerances.iter().enumerate() {
        let stated = match tolerance.std {
            Some(_) => quantity(tolerance.nominal, tolerance.std, tolerance.unit()),
            None => format!("{} (unknown, left free)", quantity(tolerance.nominal, None, tolerance.unit())),
        };
        let mut cells = vec![tolerance.path.clone(), stated];
        let mut farthest = 0.0_f64;
        for (_, fit) in &models {
            let departure = fit.hypothesis.departure(index);
            cells.push(quantity(fit.hypothesis.ended_at(index), None, tolerance.unit()));
            cells.push(match tolerance.std {
                Some(_) => significant(departure, 2),
                None => "free".to_owned(),
            });
            if tolerance.std.is_some() {
                farthest = farthest.max(departure.abs());
            }
        }
        if farthest > BENT {
            bent += 1;
            table = table.marked_row(Tone::Attention, cells);
        } else {
            table = table.row(cells);
        }
    }
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
    Some(Section::new("Tolerances").paragraph(words).table(table.footnote(
        "Young's modulus and second moment of a joint act as a product only: one of them carries the deviation of both.",
    )))
}
