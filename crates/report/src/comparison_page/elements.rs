//! The elements compared, and their names.

use jointscope_comparison::{Comparison, ELEMENTS, Kind};

/// Row or column, as a subscript.
pub(super) const DIGITS: [&str; 2] = ["₁", "₂"];

pub(super) fn name_of(kind: Kind, (i, j): (usize, usize)) -> String {
    format!("{}{}{}", kind.symbol(), DIGITS[i], DIGITS[j])
}

/// A number of a pair as the page writes it.
pub(super) fn typeset(element: &str) -> String {
    match element {
        "elastic_centre" => "elastic centre".to_owned(),
        "K22_at_centre" => "K₂₂ at the centre".to_owned(),
        other => other.replace('1', "₁").replace('2', "₂"),
    }
}

/// The elements that any joint has: the first alone of bodies that do not rotate.
pub(super) fn elements(comparison: &Comparison) -> &'static [(usize, usize)] {
    let is_scalar = comparison.numbers.iter().all(|number| number.element == (0, 0));
    if is_scalar { &ELEMENTS[..1] } else { &ELEMENTS }
}
