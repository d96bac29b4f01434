//! The elements compared, and their names.

use jointscope_comparison::{Comparison, ELEMENTS, Kind};

/// Row or column, as a subscript.
pub(super) const DIGITS: [&str; 2] = ["₁", "₂"];

pub(super) fn name_of(kind: Kind, (i, j): (usize, usize)) -> String {
    format!("{}{}{}", kind.symbol(), DIGITS[i], DIGITS[j])
}

/// The elements that any joint has: the first alone of bodies that do not rotate.
pub(super) fn elements(comparison: &Comparison) -> &'static [(usize, usize)] {
    let is_scalar = comparison.numbers.iter().all(|number| number.element == (0, 0));
    if is_scalar { &ELEMENTS[..1] } else { &ELEMENTS }
}
