//! Noise from what the modes leave of each FRF, where neither variances nor coherence tell it.
//!
//! The scatter of neighbouring lines says how noisy an FRF is between its resonances. On a sharp peak, of
//! which a recording has a line or three, the neighbours say little, and these lines decide on the damping
//! ratio. Once the modes are known, their residuals tell the noise better: a floor S that varies slowly, and
//! a share N of |H|² (noise of the force, and of everything that moves with it) that is told by all
//! resonances within a wide window together.

use jointscope_spectra::median;
use num_complex::Complex64;

use crate::likelihood::{Likelihood, Poles, Prior};
use crate::model::rebuilt;
use crate::observed::Observed;
use crate::settings::each_frf::HELD;
use crate::settings::noise::{
    EACH_FIT_STEPS, FLOOR_WINDOW, FROM_OTHERS, LEAST_NOISE, MOST_FOLLOWED, MOST_OVER_EXPECTED, PASSES,
    SHARE_WINDOW_PARTS, UNTOLD_SHARE,
};

/// Variances E|ε|² of the accelerances of `frfs` on all lines, merged ones as what they leave and not as
/// their own scatter tells it, from what is left of them by modes at their own places for each FRF, so that
/// resonances that moved between records are not taken for noise. FRFs that the modes cannot be fitted to are
/// left out.
pub(crate) fn variances(
    observed: &Observed,
    condensed: &Observed,
    fit: &Likelihood,
    frfs: &[usize],
) -> Vec<(usize, Vec<f64>)> {
    let poles = Poles {
        poles: fit.poles.poles.clone(),
        participations: vec![vec![Complex64::ONE]; fit.poles.poles.len()],
    };
    let prior = Prior { poles: poles.poles.clone(), std: HELD };
    let highest = condensed.omegas[condensed.lines() - 1];
    let mut fitted = Vec::new();
    let mut left = Vec::new();
    for &frf in frfs.iter().filter(|frf| condensed.weights(**frf).iter().any(|w| *w > 0.0)) {
        let single = condensed.single(frf);
        let Some(own) = Likelihood::search(&single, poles.clone(), fit.terms, EACH_FIT_STEPS, Some(&prior))
        else {
            continue;
        };
        let model = rebuilt(&observed.omegas, &own, 0, 0, 0, highest);
        let followed = followed(observed, &own.poles.poles, frf);
        let squares: Vec<f64> = observed
            .values(frf)
            .iter()
            .zip(&model)
            .zip(&followed)
            .zip(&observed.stands_for)
            .map(|(((v, m), followed), lines)| {
                lines * (v - m).norm_sqr() / (1.0 - followed.min(MOST_FOLLOWED))
            })
            .collect();
        left.push(Left {
            squares,
            size: model.iter().map(|m| m.norm_sqr()).collect(),
            usable: followed.iter().map(|f| *f < MOST_FOLLOWED).collect(),
        });
        fitted.push(frf);
    }
    // Of the recorded lines; what stands for several of them is as much better.
    let of_lines = |all: Vec<f64>| all.iter().zip(&observed.stands_for).map(|(v, lines)| v / lines).collect();
    fitted.into_iter().zip(floors_and_shares(&left).into_iter().map(of_lines)).collect()
}

/// What share of each line's own noise residues and poles follow, about: those of a peak of three lines go
/// through them.
fn followed(observed: &Observed, poles: &[Complex64], frf: usize) -> Vec<f64> {
    let weights = observed.weights(frf);
    let mut all = vec![0.0; observed.lines()];
    for pole in poles {
        // Columns of the residue and of the pole.
        for power in [1, 2] {
            let size =
                |omega: f64| omega.powi(4) / (Complex64::new(0.0, omega) - pole).norm_sqr().powi(power);
            let column = observed.omegas.iter().zip(weights).map(|(omega, weight)| weight * size(*omega));
            let sum: f64 = column.clone().sum();
            all.iter_mut().zip(column).for_each(|(share, part)| *share += part / sum.max(f64::MIN_POSITIVE));
        }
    }
    all
}

/// What is left of an FRF: squared residuals, |H|², and whether the line tells its noise.
struct Left {
    squares: Vec<f64>,
    size: Vec<f64>,
    usable: Vec<bool>,
}

/// S + N·|H|² of each FRF, by line.
fn floors_and_shares(left: &[Left]) -> Vec<Vec<f64>> {
    let mut all: Vec<Fit> = left.iter().map(Fit::begun).collect();
    let Some(n) = left.first().map(|l| l.squares.len()) else { return Vec::new() };
    let half = (n / SHARE_WINDOW_PARTS).max(FLOOR_WINDOW);
    for _ in 0..PASSES {
        let sums: Vec<[Running; 2]> = left.iter().zip(&all).map(|(l, fit)| fit.share_sums(l)).collect();
        let pooled = |i: usize, part: usize| -> f64 {
            sums.iter().map(|sum| sum[part].over(window(i, half, n))).sum::<f64>() * FROM_OTHERS
        };
        let pooled: Vec<[f64; 2]> = (0..n).map(|i| [pooled(i, 0), pooled(i, 1)]).collect();
        for ((fit, l), sums) in all.iter_mut().zip(left).zip(&sums) {
            let share = |i: usize| {
                let [above, below] = [0, 1].map(|part| sums[part].over(window(i, half, n)) + pooled[i][part]);
                // A standard deviation more than it seems: too little noise on a peak costs more than too
                // much.
                let below = below.max(f64::MIN_POSITIVE);
                (above / below).max(0.0) + below.sqrt().recip().min(UNTOLD_SHARE)
            };
            let share: Vec<f64> = (0..n).map(share).collect();
            fit.update(l, &share);
        }
    }
    all.into_iter().map(|fit| fit.variance).collect()
}

fn window(i: usize, half: usize, n: usize) -> std::ops::Range<usize> {
    i.saturating_sub(half)..(i + half + 1).min(n)
}

/// One FRF's floor and variance between passes.
struct Fit {
    floor: Vec<f64>,
    variance: Vec<f64>,
    largest: f64,
}

impl Fit {
    /// An upper bound: all of it floor, and all of it share. The median of an exponential is ln 2 of its
    /// mean.
    fn begun(left: &Left) -> Self {
        let n = left.squares.len();
        let largest = left.size.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let share = mean_by_median((0..n).map(|i| left.squares[i] / left.size[i].max(1e-30 * largest)));
        let floors: Vec<f64> = (0..n)
            .step_by(FLOOR_WINDOW)
            .map(|i| mean_by_median(window(i, FLOOR_WINDOW, n).map(|k| left.squares[k])))
            .collect();
        let variance = (0..n).map(|i| floors[i / FLOOR_WINDOW] + share * left.size[i]).collect();
        Fit { floor: vec![0.0; n], variance, largest }
    }

    fn least(&self, left: &Left, i: usize) -> f64 {
        (LEAST_NOISE * LEAST_NOISE * left.size[i].max(1e-12 * self.largest)).max(f64::MIN_POSITIVE.sqrt())
    }

    fn weight(&self, left: &Left, i: usize) -> f64 {
        if !left.usable[i] {
            return 0.0;
        }
        self.variance[i].max(self.least(left, i)).powi(-2)
    }

    fn clipped(&self, left: &Left, i: usize) -> f64 {
        left.squares[i].min(MOST_OVER_EXPECTED * self.variance[i])
    }

    /// Sums of which the quotient over a window is the share.
    fn share_sums(&self, left: &Left) -> [Running; 2] {
        let lines = 0..left.squares.len();
        let above = |i| self.weight(left, i) * left.size[i] * (self.clipped(left, i) - self.floor[i]);
        let below = |i| self.weight(left, i) * left.size[i] * left.size[i];
        [Running::of(lines.clone().map(above)), Running::of(lines.map(below))]
    }

    fn update(&mut self, left: &Left, share: &[f64]) {
        let n = left.squares.len();
        let weights: Vec<f64> = (0..n).map(|i| self.weight(left, i)).collect();
        let above = |i: usize| weights[i] * (self.clipped(left, i) - share[i] * left.size[i]);
        let (above, below) = (Running::of((0..n).map(above)), Running::of(weights.iter().copied()));
        for i in 0..n {
            let near = window(i, FLOOR_WINDOW, n);
            self.floor[i] = (above.over(near.clone()) / below.over(near).max(f64::MIN_POSITIVE)).max(0.0);
            self.variance[i] = (self.floor[i] + share[i] * left.size[i]).max(self.least(left, i));
        }
    }
}

/// The mean of exponential numbers, such as squares of a complex normal, by their median, which is ln 2 of
/// it; zero of none.
fn mean_by_median(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.collect::<Vec<f64>>()).map_or(0.0, |median| median / std::f64::consts::LN_2)
}

/// Sums over ranges by one subtraction.
struct Running(Vec<f64>);

impl Running {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sums = vec![0.0];
        let mut sum = 0.0;
        for value in values {
            sum += value;
            sums.push(sum);
        }
        Running(sums)
    }

    fn over(&self, range: std::ops::Range<usize>) -> f64 {
        self.0[range.end] - self.0[range.start]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_and_a_share_are_told_apart_where_the_size_varies() {
        // Squares at their expected size: nothing random to hide behind.
        let size: Vec<f64> = (0..400).map(|i| 1.0 / (1e-4 + (i as f64 / 200.0 - 1.0).powi(2))).collect();
        let truth: Vec<f64> = size.iter().map(|s| 0.3 + 1e-3 * s).collect();
        let found = floors_and_shares(&[Left { squares: truth.clone(), size, usable: vec![true; 400] }]);
        for (i, (found, truth)) in found[0].iter().zip(&truth).enumerate() {
            // A share is taken for a little more than it seems.
            assert!((0.97..1.2).contains(&(found / truth)), "line {i}: {found} of {truth}");
        }
    }

    #[test]
    fn residuals_of_exactly_nothing_keep_a_positive_variance() {
        for (squares, size) in [(vec![0.0; 50], vec![1.0; 50]), (vec![0.0; 5], vec![0.0; 5])] {
            let usable = vec![true; size.len()];
            let found = floors_and_shares(&[Left { squares, size, usable }]);
            assert!(found[0].iter().all(|v| *v > 0.0 && v.is_finite()), "{found:?}");
        }
        assert!(floors_and_shares(&[]).is_empty());
    }
}
