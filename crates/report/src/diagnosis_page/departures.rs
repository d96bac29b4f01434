//! Quantities that the models take farther from what is stated than chance does.

use jointscope_diagnosis::Departure;

use super::subject::Subject;
use crate::format::{quantity_in, significant};
use crate::section::Section;
use crate::table::Table;
use crate::unit::Scale;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let diagnosis = subject.diagnosis;
    if diagnosis.departures.is_empty() {
        return None;
    }
    let [refitted, _] = &diagnosis.stated;
    let tolerances = refitted.tolerances();
    let scale = |departure: &Departure| {
        let own = tolerances.iter().find(|tolerance| tolerance.quantity.path == departure.path);
        let unit = own.map_or("", |tolerance| tolerance.quantity.key.unit());
        Scale::of_stated([departure.stated, departure.std, departure.refitted, departure.repaired], unit)
    };
    let deviation = |path: &str| {
        let own = tolerances.iter().position(|tolerance| tolerance.quantity.path == path);
        own.map_or(f64::NAN, |index| refitted.departure(index))
    };
    let mut table = Table::of(&diagnosis.departures)
        .words("Quantity", |departure| departure.path.clone())
        .words("Stated", |departure| quantity_in(departure.stated, departure.std, &scale(departure)))
        .words("refitted", |departure| quantity_in(departure.refitted, None, &scale(departure)))
        .numbers("deviation, refitted", "std", |departure| significant(deviation(&departure.path), 2));
    let words = if diagnosis.findings.is_empty() {
        "These quantities would have to be more than four standard deviations from what is stated. Measure them again; if they are as \
         stated, they stand in for something that is left out."
    } else {
        table = table
            .words("repaired", |departure| quantity_in(departure.repaired, None, &scale(departure)))
            .numbers("deviation, repaired", "std", |departure| significant(departure.deviations, 2));
        "One of the models takes these quantities more than four standard deviations from what is stated. What the repaired model brings back \
         was imitating what the findings name; what it leaves there is to be measured again, or stands in for something else."
    };
    Some(Section::new("Departures from what is stated").paragraph(words).with(table))
}
