//! The tolerances used, and where they ended.

use jointscope_fixture::NamedQuantity;

use super::subject::Subject;
use crate::format::{quantity_in, significant};
use crate::section::Section;
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let models = subject.stated();
    let tolerances = models.first()?.1.tolerances();
    if tolerances.is_empty() {
        return Some(
            Section::new("Tolerances")
                .paragraph("The fixture states every quantity as exact: there was nothing to refit."),
        );
    }
    let is_far = |index: usize| models.iter().any(|(_, model)| model.is_far(index));
    let far = (0..tolerances.len()).filter(|index| is_far(*index)).count();
    let scale = |index: usize, own: &NamedQuantity| {
        let ended = models.iter().map(|(_, model)| model.ended_at(index));
        Scale::of_stated(ended.chain([own.value]).chain(own.std), own.key.unit())
    };
    let mut table = Table::of(tolerances.iter().map(|tolerance| &tolerance.quantity).enumerate())
        .words("Quantity", |(_, own)| own.path.clone())
        .words("Stated", |(index, own)| {
            let stated = quantity_in(own.value, own.std, &scale(*index, own));
            if own.std.is_some() { stated } else { format!("{stated} (unknown, left free)") }
        });
    for (name, model) in &models {
        table = table
            .words(*name, |(index, own)| quantity_in(model.ended_at(*index), None, &scale(*index, own)))
            .numbers(format!("departure, {name}"), "std", |(index, own)| match own.std {
                Some(_) => significant(model.deviations(*index), 2),
                None => "free".to_owned(),
            });
    }
    let table = table.marked(|(index, _)| is_far(*index).then_some(Tone::Attention));
    let words = match (far, subject.diagnosis.findings.is_empty()) {
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
    let product = "Young's modulus and second moment of a joint act as a product only: one of them carries the deviation of both.";
    let footnote = match subject.diagnosis.model_error {
        Some(_) => format!(
            "{product} The models drawn, and the fixtures written, are to predict: their quantities follow the recorded natural \
             frequencies more closely than these, and may be farther from what is stated."
        ),
        None => product.to_owned(),
    };
    Some(Section::new("Tolerances").paragraph(words).with(table.footnote(footnote)))
}
