//! Overload: a signal that its input cut off.

use crate::settings::overload::{
    CLIFF_STEPS, EXTREME_SHARE, FINEST_STEP, FLANK_STEPS, HELD_BETWEEN_CLIFFS, HELD_SAMPLES, OFF_THE_GRID,
    SAMPLES_LOOKED_AT,
};

/// The value at which a signal is cut off, if it is: its extreme held for three samples or more, with steep
/// flanks, so that no smooth top read by a coarse converter is meant. Of a blow that lasts a few samples the
/// top may be two: these are enough where the flanks are so steep that chance hardly makes them equal.
///
/// What was cut off before an anti-alias filter is round again and cannot be seen.
pub(crate) fn is_cut_off(values: &[f64]) -> Option<f64> {
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    if high <= low || !(high - low).is_finite() {
        return None;
    }
    [high, low].into_iter().filter(|extreme| extreme.abs() >= EXTREME_SHARE * high.abs().max(low.abs())).find(
        |&extreme| {
            let at_top = |i: &usize| (values[*i] - extreme).abs() <= 1e-9 * (high - low);
            let tops: Vec<usize> = (0..values.len()).filter(at_top).collect();
            if tops.len() < HELD_BETWEEN_CLIFFS {
                return false;
            }
            let step = converter_step(values).max(FINEST_STEP * (high - low));
            tops.chunk_by(|a, b| a + 1 == *b).any(|run| {
                let beside = [run[0].checked_sub(1), run.last().map(|last| last + 1)];
                let below = beside.map(|i| {
                    let value = i.and_then(|i| values.get(i));
                    value.map_or(f64::INFINITY, |v| (v - extreme).abs() / step)
                });
                let flanks = below[0].min(below[1]);
                // A top that is its own mirror image is equal on both sides of its middle by itself.
                let apart = (below[0] - below[1]).abs();
                let is_cliff = flanks > CLIFF_STEPS && apart > CLIFF_STEPS && apart.is_finite();
                let held = if is_cliff { HELD_BETWEEN_CLIFFS } else { HELD_SAMPLES };
                run.len() >= held && flanks > FLANK_STEPS
            })
        },
    )
}

/// The step of the converter, as far as a sample of the values shows it: the smallest distance between two,
/// if all others are multiples of it.
fn converter_step(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().take(SAMPLES_LOOKED_AT).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let range = match (sorted.first(), sorted.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    let steps = || sorted.windows(2).map(|two| two[1] - two[0]).filter(|step| *step > 1e-9 * range);
    let smallest = steps().fold(f64::INFINITY, f64::min);
    let on_grid = |step: f64| (step / smallest - (step / smallest).round()).abs() < OFF_THE_GRID;
    if smallest.is_finite() && steps().all(on_grid) { smallest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn ringing(count: usize) -> Vec<f64> {
        (0..count).map(|i| 10.0 * (-0.01 * i as f64).exp() * (0.31 * i as f64).sin()).collect()
    }

    #[test]
    fn a_signal_that_is_cut_off_is_found_on_either_side() {
        assert_eq!(is_cut_off(&ringing(500)), None);
        let cut: Vec<f64> = ringing(500).iter().map(|v| v.min(6.0)).collect();
        assert_eq!(is_cut_off(&cut), Some(6.0));
        let cut: Vec<f64> = ringing(500).iter().map(|v| v.max(-7.0)).collect();
        assert_eq!(is_cut_off(&cut), Some(-7.0));
    }

    /// A blow of five samples that is cut off at `most`, read in steps.
    fn blow(most: f64, begins: f64, step: f64) -> Vec<f64> {
        let pulse = |t: f64| if (0.0..5.0).contains(&t) { 100.0 * (0.2 * PI * t).sin().powi(2) } else { 0.0 };
        (0..200).map(|i| ((pulse(i as f64 - begins).min(most)) / step).round() * step).collect()
    }

    #[test]
    fn a_short_blow_that_is_cut_off_holds_two_samples_and_one_that_is_not_holds_none() {
        // Of 1.84 samples above the cut two are recorded in 84 of 100.
        for step in [1e-9, 3e-3] {
            let begins = |k: usize| 50.0 + 0.01 * k as f64 + 0.003;
            let found = (0..100).filter(|&k| is_cut_off(&blow(70.0, begins(k), step)).is_some()).count();
            assert!(found > 80, "{found} of 100 in steps of {step}");
            let taken = (0..100).filter(|&k| is_cut_off(&blow(200.0, begins(k), step)).is_some()).count();
            assert_eq!(taken, 0, "in steps of {step}");
        }
        // Two samples on either side of the middle of a blow are equal by themselves.
        assert_eq!(is_cut_off(&blow(200.0, 50.0, 1e-9)), None);
    }

    #[test]
    fn the_round_top_of_a_coarsely_read_signal_is_no_overload() {
        let slow: Vec<f64> = (0..2000).map(|i| (30.0 * (0.002 * i as f64).sin()).round()).collect();
        assert_eq!(is_cut_off(&slow), None);
        let fine: Vec<f64> = ringing(500).iter().map(|v| (v * 100.0).round() / 100.0).collect();
        assert_eq!(is_cut_off(&fine), None);
        assert_eq!(is_cut_off(&[0.0; 100]), None);
    }

    #[test]
    fn a_cut_off_signal_in_coarse_steps_is_found() {
        let coarse: Vec<f64> =
            ringing(500).iter().map(|v| (v * 20.0).round() / 20.0).map(|v| v.min(6.0)).collect();
        assert_eq!(is_cut_off(&coarse), Some(6.0));
    }
}
