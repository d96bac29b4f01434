//! References whose poles agree.

use super::table::{Table, chance};
use crate::settings::drift::differences::{AGREE, LEAST_DIFFERENCE};

/// Whether each reference belongs to the most that agree, each with each: of as many the one with more FRFs
/// (`frfs` of each), then the first.
pub(super) fn agreeing(table: &Table, frfs: &[usize]) -> Vec<bool> {
    let count = table.references;
    let below: Vec<Vec<bool>> = (0..count).map(|a| (0..a).map(|b| pair(table, a, b)).collect()).collect();
    let agree = |a: usize, b: usize| a == b || below[a.max(b)][a.min(b)];
    let group = |first: usize| {
        let mut group = vec![first];
        for other in 0..count {
            if !group.contains(&other) && group.iter().all(|&own| agree(own, other)) {
                group.push(other);
            }
        }
        group
    };
    let size = |group: &Vec<usize>| (group.len(), group.iter().map(|&own| frfs[own]).sum::<usize>());
    let best = (0..count).map(group).rev().max_by_key(size).unwrap_or_default();
    (0..count).map(|reference| best.contains(&reference)).collect()
}

/// Whether two references' modes agree: nothing that they have in common says otherwise.
fn pair(table: &Table, a: usize, b: usize) -> bool {
    let cells =
        table.cells.iter().filter(|cell| cell.reference == a || cell.reference == b).copied().collect();
    let part = Table { cells, ..table.clone() };
    let (of_references, left) = part.degrees();
    if of_references == 0 {
        return true;
    }
    let [Some(together), Some(apart)] = [part.by_reference(|_| true), part.by_reference(|_| false)] else {
        return false;
    };
    let inflation = part.inflation();
    let between = (together.chi2 - apart.chi2).max(0.0) / part.shared();
    let by_chance = || chance(between, of_references, inflation, left);
    by_chance() >= AGREE || part.farthest(&[a, b]) < LEAST_DIFFERENCE
}
