//! Which lines the hammer excites.

use crate::settings::band::{BELOW_FILTER, DEEP, DIP_PARTS, WEAK};

/// The last line, counted from 0, up to which the force's power by line stays within 20 dB of its largest.
pub(crate) fn last_usable(power: &[f64]) -> usize {
    let n = power.len();
    let largest = power.iter().skip(1).copied().fold(0.0, f64::max);
    let reach = (n / DIP_PARTS).max(1);
    let strong = |line: usize| power[line] >= WEAK * largest;
    let mut last = (1..n).max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap_or(0);
    while let Some(next) = (last + 1..(last + 1 + reach).min(n)).rev().find(|&line| strong(line)) {
        last = next;
    }
    last.min(((n.max(1) - 1) as f64 * BELOW_FILTER) as usize)
}

/// The deepest line of each narrow dip of the force's power below line `last`.
pub(crate) fn dips(power: &[f64], last: usize) -> Vec<usize> {
    let reach = (power.len() / DIP_PARTS).max(1);
    let mut near = Vec::with_capacity(2 * reach + 1);
    let mut is_deep = |line: usize| {
        near.clear();
        near.extend_from_slice(
            &power[line.saturating_sub(reach).max(1)..(line + reach + 1).min(power.len())],
        );
        let middle = near.len() / 2;
        power[line] < DEEP * *near.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let deep: Vec<usize> =
        (1..=last.min(power.len().saturating_sub(1))).filter(|&line| is_deep(line)).collect();
    let deepest = |run: &[usize]| run.iter().copied().min_by(|a, b| power[*a].total_cmp(&power[*b]));
    deep.chunk_by(|a, b| b - a <= reach).filter_map(deepest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_ends_where_the_force_has_fallen_by_20_db_and_bridges_a_narrow_dip() {
        let mut power: Vec<f64> = (0..1000).map(|line| (-0.01 * line as f64).exp()).collect();
        assert_eq!(last_usable(&power), 461);
        power[100..110].fill(1e-9);
        assert_eq!(last_usable(&power), 461);
        power[104] = 0.0;
        assert_eq!(dips(&power, 461), [104]);
        assert_eq!(last_usable(&vec![1.0; 1001]), 800);
        assert_eq!(last_usable(&[0.0; 5]), 3);
    }
}
