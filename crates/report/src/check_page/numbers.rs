//! Every number of the fixture file.

use jointscope_check::{Check, Known};

use crate::format::quantity_in;
use crate::section::Section;
use crate::table::Table;
use crate::unit::Scale;

pub(super) fn section(check: &Check) -> Section {
    let table = Table::of(&check.numbers)
        .words("number", |number| number.path.clone())
        .words("value", |number| {
            let std = number.std.filter(|std| *std > 0.0);
            quantity_in(number.value, std, &Scale::of_stated([number.value], number.unit))
        })
        .words("its deviation", |number| match number.known {
            Known::Stated => "stated",
            Known::Default => "default",
            Known::Unknown => "unknown: left free",
            Known::Exact => "exact",
        })
        .words("means", |number| number.means.clone().unwrap_or_default());
    Section::new("Every number").paragraph(
        "What the file says, as the program reads it, with one standard deviation: the one that is stated, or the default of a bare number.",
    ).with(table)
}
