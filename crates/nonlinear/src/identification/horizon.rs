//! How far a motion can be followed: until what the force's noise, the length of steps, or what is not known
//! of the law does to it has grown beyond the responses' own noise.
//!
//! A joint that knocks or hardens strongly can make motions that depend on more digits than a force is
//! measured with, or steps resolve. What comes later in such a record is no evidence for or against any
//! model, and a fit to it is caught in false minima.

use super::fit::Fit;
use super::hypothesis::Hypothesis;
use super::misfit::{Focus, View};
use super::records::Record;
use crate::settings::horizon::{BLOCK, CERTAIN, DEVIATIONS, DISTURBANCES, LINEAR_DEPARTURES, TOLERATED};

/// Samples of each record up to which `fit` can follow it, not below `least` seconds after its blow; no limit
/// where motions stay together to the end.
pub(crate) fn horizons(records: &[&Record], focus: &Focus, fit: &Fit, least: f64) -> Vec<usize> {
    let (unlimited, hypothesis) = (vec![usize::MAX; records.len()], &fit.hypothesis);
    if hypothesis.effects().is_empty() {
        return unlimited;
    }
    let view = View::new(records, focus, &[]);
    let fine =
        View::new(records, &Focus { within: 2 * focus.within, halvings: focus.halvings + 1, ..*focus }, &[]);
    let linear = hypothesis.without_effects();
    let disturbed = DISTURBANCES.iter().map(|by| view.histories(hypothesis, *by));
    let moved = departed(fit);
    let moved = moved.iter().map(|moved| view.histories(moved, 0.0));
    let disturbed: Option<Vec<_>> = disturbed.chain([fine.histories(hypothesis, 0.0)]).chain(moved).collect();
    let undisturbed = (view.histories(hypothesis, 0.0), view.histories(&linear, 0.0));
    let (Some(plain), Some(linear_plain)) = undisturbed else { return unlimited };
    let (Some(disturbed), Some(linear)) = (disturbed, view.histories(&linear, DISTURBANCES[0])) else {
        return unlimited;
    };
    (0..records.len())
        .map(|i| {
            let record = records[i];
            let least = record.onset + (least / record.hit.interval()).ceil() as usize;
            let ends = (0..record.noise.len()).flat_map(|j| {
                let allowed = allowed(&linear_plain[i][j], &linear[i][j], record.noise[j]);
                let plain = &plain[i][j];
                disturbed.iter().filter_map(move |disturbed| {
                    let departures = departures(plain, &disturbed[i][j]);
                    let beyond =
                        departures.iter().zip(&allowed).position(|(departure, most)| departure > most);
                    beyond.map(|block| block * BLOCK)
                })
            });
            ends.min().unwrap_or(usize::MAX).max(least)
        })
        .collect()
}

/// The hypothesis moved along with each of its effects' parameters, as far as the fit leaves them uncertain.
fn departed(fit: &Fit) -> Vec<Hypothesis> {
    let (hypothesis, Some(covariance)) = (&fit.hypothesis, fit.covariance(1.0)) else { return Vec::new() };
    let along = |k: usize| {
        let mut moved = hypothesis.clone();
        for (i, coordinate) in moved.coordinates.iter_mut().enumerate() {
            *coordinate += DEVIATIONS * covariance.at(i, k) / covariance.std(k);
        }
        moved
    };
    let certain = |k: &usize| covariance.at(*k, *k) > 0.0 && covariance.at(*k, *k) < CERTAIN;
    (hypothesis.quantities.len()..covariance.order()).filter(certain).map(along).collect()
}

fn departures(a: &[f64], b: &[f64]) -> Vec<f64> {
    let square = |(a, b): (&f64, &f64)| (a - b).powi(2);
    let blocks = a.chunks(BLOCK).zip(b.chunks(BLOCK));
    blocks.map(|(a, b)| (a.iter().zip(b).map(square).sum::<f64>() / a.len() as f64).sqrt()).collect()
}

/// What the noise of the response and of the force through a linear structure may come to, block by block.
fn allowed(plain: &[f64], disturbed: &[f64], noise: f64) -> Vec<f64> {
    let mut largest: f64 = 0.0;
    let most = |departure: f64| {
        largest = largest.max(departure);
        (TOLERATED * noise).max(LINEAR_DEPARTURES * largest)
    };
    departures(plain, disturbed).into_iter().map(most).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn departures_are_those_of_their_block_and_no_other() {
        let plain = vec![0.0; 3 * BLOCK];
        let disturbed: Vec<f64> = (0..3 * BLOCK).map(|i| if i < 2 * BLOCK { 0.0 } else { 2.0 }).collect();
        assert_eq!(departures(&plain, &disturbed), [0.0, 0.0, 2.0]);
    }

    #[test]
    fn what_a_linear_structure_makes_of_the_same_disturbance_is_allowed() {
        let plain = vec![0.0; 2 * BLOCK];
        let disturbed = vec![0.5; 2 * BLOCK];
        assert_eq!(allowed(&plain, &disturbed, 1e-3), [LINEAR_DEPARTURES * 0.5; 2]);
        assert_eq!(allowed(&plain, &plain, 1e-3), [TOLERATED * 1e-3; 2]);
    }
}
