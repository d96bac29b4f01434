//! Where a fit of several joints begins.
//!
//! What a fixture says of joints that are looked for is a guess, of each joint another one: one may be half as
//! stiff as stated and its neighbour twice. Resonances are then where others are stated, and a fit from there
//! ends among the wrong ones. A prediction costs little once the blocks' receptances are known, so the stiffnesses
//! are tried on a grid first, with so much of the signal counted as noise that resonances do not decide, and
//! fits begin where that leaves least.

use super::super::problem::Problem;
use crate::settings::several::{GRID, MOST_ON_GRID, SCAN, STARTS, SWEEPS};
use jointscope_inference::each;

/// The starts to be tried, best first: by joint, the share of the fixture's stiffness. `start` makes coordinates
/// of the laws of them.
pub(super) fn starts(problem: &Problem, start: &(dyn Fn(&[f64]) -> Vec<f64> + Sync)) -> Vec<Vec<f64>> {
    let weights = problem.test.setup.recorded.weights_with(SCAN);
    let problem = problem.weighted(&weights);
    let joints = problem.laws.len();
    let Some(as_stated) = problem.point(problem.whole(&start(&vec![1.0; joints])), None) else {
        return vec![vec![1.0; joints]];
    };
    let left = |shares: &Vec<f64>| {
        problem.with_joints(&as_stated, &start(shares)).map_or(f64::INFINITY, |at| at.objective)
    };
    let tried: Vec<Vec<f64>> = match GRID.len().checked_pow(joints as u32) {
        Some(count) if count <= MOST_ON_GRID => (0..count)
            .map(|place| {
                (0..joints as u32).map(|joint| GRID[place / GRID.len().pow(joint) % GRID.len()]).collect()
            })
            .collect(),
        _ => GRID.iter().map(|share| joint_by_joint(vec![*share; joints], &left)).collect(),
    };
    let mut all: Vec<(f64, Vec<f64>)> = each(&tried, left).into_iter().zip(tried).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup_by(|a, b| a.1 == b.1);
    all.truncate(STARTS);
    all.into_iter().map(|(_, shares)| shares).collect()
}

/// From such shares, one joint after the other at the best value of the grid.
fn joint_by_joint(mut shares: Vec<f64>, left: &(impl Fn(&Vec<f64>) -> f64 + Sync)) -> Vec<f64> {
    for _ in 0..SWEEPS {
        let before = shares.clone();
        for joint in 0..shares.len() {
            let tried: Vec<Vec<f64>> = GRID
                .iter()
                .map(|share| {
                    let mut tried = shares.clone();
                    tried[joint] = *share;
                    tried
                })
                .collect();
            let least = each(&tried, left).into_iter().zip(tried).min_by(|a, b| a.0.total_cmp(&b.0));
            shares = least.map_or(shares, |(_, least)| least);
        }
        if shares == before {
            break;
        }
    }
    shares
}
