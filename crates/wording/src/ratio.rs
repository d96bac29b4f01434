//! Ratios with their intervals, in words.

use crate::format::fixed;
use jointscope_comparison::Ratio;

/// `93.02 % (92.98 to 93.06 %)`.
pub fn percents(ratio: &Ratio) -> String {
    let decimals = decimals(ratio.std * 100.0);
    let [value, low, high] =
        [ratio.value, ratio.ci95[0], ratio.ci95[1]].map(|share| fixed(100.0 * share, decimals));
    format!("{value} % ({low} to {high} %)")
}

/// Digits after the point that show two of a standard deviation.
fn decimals(std: f64) -> usize {
    if std > 0.0 && std.is_finite() { (1 - std.log10().floor() as i32).clamp(0, 6) as usize } else { 2 }
}
