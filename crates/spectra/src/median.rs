//! The median that noise models and plausibility checks take over lines, without a sorted copy.

/// The median of values over lines, the larger of the two in the middle of an even number; `None` of none.
/// The order of the values changes.
pub fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
