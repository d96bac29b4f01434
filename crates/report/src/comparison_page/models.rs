//! Joints of models over measured ones: SIM/EXP and FEM/EXP.

use jointscope_comparison::{Comparison, ModelIs};
use jointscope_wording::models::{OverOne, by_measurement, source, without_ratio};

use super::elements::typeset;
use crate::section::Section;
use crate::table::Table;
use crate::tone::Tone;

/// A table by measured joint, a column a model; nothing where no model is set against a measurement.
pub(super) fn model_section(comparison: &Comparison) -> Option<Section> {
    if comparison.models.is_empty() {
        return None;
    }
    let section = Section::new("Models over measurement").paragraph(
        "Ratios with their 95 % intervals, Fieller's, errors in common cancelling. By chance alone one interval in twenty leaves out 1 where model and test are the same.",
    );
    Some(
        by_measurement(comparison)
            .iter()
            .fold(section, |section, over| section.with(table(comparison, over))),
    )
}

fn table<'a>(comparison: &Comparison, over: &OverOne<'a>) -> Table<&'a str> {
    let table = Table::of(over.elements.clone()).words("number", |element| typeset(element));
    let departs = |element: &&str| {
        let mut of_models = over.models.iter().filter_map(|model| OverOne::ratio(model, element));
        let departs = of_models.any(|n| n.model_is.is_some_and(|is| is != ModelIs::AsMeasured));
        departs.then_some(Tone::Attention)
    };
    let table = over.models.iter().fold(table, |table, model| {
        let heading = format!("{} ({})", OverOne::heading(model), source(model.kind));
        table.words(heading, |element| OverOne::cell(model, element))
    });
    let table = if comparison.is_sound() { table.marked(departs) } else { table };
    let table = table.caption(format!("Models in % of {}", over.measurement));
    match without_ratio(comparison, over) {
        Some(text) => table.footnote(format!("{text}.")),
        None => table,
    }
}
