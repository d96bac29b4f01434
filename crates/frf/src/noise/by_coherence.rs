//! Variances by coherence and number of averages.

use super::smoothing::{FEWEST, FLOOR, WINDOW, around, is_measured, smoothed};
use num_complex::Complex64;

/// The least of it where levels are followed from line to line.
const SHORTEST: usize = 4;
/// Degrees of freedom from which a local level of variances is told: to an eighth.
const TOLD: f64 = 150.0;
/// Steps in which such a level is found.
const STEPS: usize = 6;

/// Variances E|ε|² of one FRF from its coherence and number of averages, smoothed over the lines.
///
/// A file says nothing of the force, whose power falls by decades within few lines before a soft tip's first
/// zero, and the variances rise by as much. So what the lines show against a noise that varies slowly is
/// followed over no more of them than tell a level: with n averages each has 2(n − 1) degrees of freedom.
pub(crate) fn from_coherence(values: &[Complex64], coherence: &[f64], averages: u32) -> Vec<f64> {
    let raw = of_lines(values, coherence, averages);
    let slow = smoothed(values, &raw, coherence, &[], 1.0);
    let ratios: Vec<f64> = raw.iter().zip(&slow).map(|(raw, slow)| raw / slow).collect();
    let degrees = 2.0 * f64::from(averages.max(2) - 1);
    let reach = ((TOLD / degrees / 2.0).ceil() as usize).clamp(SHORTEST, WINDOW);
    let level = |line: usize| {
        let usable = around(line, reach, raw.len()).filter(|&i| is_measured(values, coherence, i));
        let near: Vec<(f64, f64)> = usable.map(|i| (i as f64 - line as f64, ratios[i])).collect();
        // What a level from ν degrees of freedom divides is too large in the mean by ν/(ν − 2).
        let all = degrees * near.len() as f64;
        local_level(&near).map_or(1.0, |level| level * all / (all - 2.0).max(1.0))
    };
    let floor = |value: &Complex64| (FLOOR * FLOOR * value.norm_sqr()).max(f64::MIN_POSITIVE);
    let lines = values.iter().zip(&slow).enumerate();
    lines.map(|(line, (value, slow))| (slow * level(line)).max(floor(value))).collect()
}

/// The level at zero of variances at distances from there, their logarithm along a straight line: the most
/// likely one for spreads in proportion to the level. `None` of too few, or where they are all nothing.
fn local_level(near: &[(f64, f64)]) -> Option<f64> {
    let count = near.len() as f64;
    let mean = near.iter().map(|(_, ratio)| ratio).sum::<f64>() / count;
    if near.len() < FEWEST || mean <= 0.0 {
        return None;
    }
    let (first, second) =
        near.iter().fold((0.0, 0.0), |(first, second), (at, _)| (first + at, second + at * at));
    let determinant = count * second - first * first;
    let (mut level, mut slope) = (mean.ln(), 0.0);
    for _ in 0..STEPS {
        let (mut b0, mut b1) = (0.0, 0.0);
        for (at, ratio) in near {
            let excess = ratio / (level + slope * at).exp() - 1.0;
            (b0, b1) = (b0 + excess, b1 + excess * at);
        }
        // A step no farther than by half: single lines far above the rest would throw it off.
        let step = ((b0 * second - b1 * first) / determinant, (b1 * count - b0 * first) / determinant);
        let reach = near.iter().map(|(at, _)| (step.0 + step.1 * at).abs()).fold(0.0, f64::max);
        let share = (0.5 / reach.max(f64::MIN_POSITIVE)).min(1.0);
        (level, slope) = (level + share * step.0, slope + share * step.1);
    }
    Some(level.exp())
}

/// Variance E|ε|² of one value by line as coherence and averages state it, (1 − γ²)/((n − 1)γ²)·|H|²: right
/// in the mean over many lines, with too few degrees of freedom to weigh a single one by.
pub fn of_lines(values: &[Complex64], coherence: &[f64], averages: u32) -> Vec<f64> {
    let degrees = f64::from(averages.max(2) - 1);
    let of_line = |(value, gamma2): (&Complex64, &f64)| {
        let gamma2 = gamma2.clamp(1e-6, 1.0);
        (1.0 - gamma2) / (degrees * gamma2) * value.norm_sqr()
    };
    values.iter().zip(coherence).map(of_line).collect()
}
