//! Orders of several numbers with deviations, and how probable each is.

use jointscope_linalg::semidefinite_factor;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::cmp::Ordering;

/// The order of several quantities by magnitude, and how sure it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranking {
    /// Indices, the smallest magnitude first.
    pub order: Vec<usize>,
    /// Probability that the whole order is right.
    pub probability: f64,
    /// Probability that each neighbour in the order is truly larger than the one before it.
    pub adjacent: Vec<f64>,
    /// For each quantity (as given), the probability of each rank.
    pub ranks: Vec<Vec<f64>>,
    /// For each quantity in the order, the quantities behind it that are larger than it as good as surely.
    pub decided: Vec<Vec<usize>>,
}

/// Draws behind the probabilities: their own standard error is below 0.0036.
const DRAWS: usize = 20_000;

/// Probability from which an order counts as settled.
const SURE: f64 = 0.95;

/// Probability from which an order is stated: twice as likely right as wrong. Of two joints either order is
/// right half of the time.
const STATED: f64 = 2.0 / 3.0;

impl Ranking {
    /// Whether the whole order is settled.
    pub fn is_settled(&self) -> bool {
        self.probability >= SURE
    }

    /// Whether the whole order is at least twice as likely right as wrong.
    pub fn is_stated(&self) -> bool {
        self.probability >= STATED
    }

    /// Of each but the first: whether it is settled that it is larger than the one before it.
    pub fn settled_neighbours(&self) -> impl Iterator<Item = bool> {
        self.adjacent.iter().map(|p| *p >= SURE)
    }

    /// Ranks values with their standard deviations, taken as independent and normal, by magnitude.
    pub fn of(values: &[(f64, f64)]) -> Self {
        let n = values.len();
        let entry = |e: usize| if e / n == e % n { values[e / n].1.powi(2) } else { 0.0 };
        let covariance: Vec<f64> = (0..n * n).map(entry).collect();
        Ranking::joint(&values.iter().map(|(value, _)| *value).collect::<Vec<_>>(), &covariance)
    }

    /// Ranks jointly normal values with this covariance (row-major) by magnitude: errors that all have in
    /// common leave the order alone.
    pub fn joint(values: &[f64], covariance: &[f64]) -> Self {
        let count = values.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| values[*a].abs().total_cmp(&values[*b].abs()));
        let factor = semidefinite_factor(count, covariance, ROUNDING);
        let mut random = ChaCha8Rng::seed_from_u64(1);
        // What is drawn alike is in either order as often.
        let mut right = 0.0;
        // How often what stands at one place of the order is smaller than what stands at a later one.
        let mut smaller = vec![vec![0.0; count]; count];
        let mut ranks = vec![vec![0.0; count]; count];
        let (mut drawn, mut normals) = (vec![0.0; count], vec![0.0; count]);
        let mut sorted: Vec<usize> = order.clone();
        for _ in 0..DRAWS {
            normals.fill_with(|| normal(&mut random));
            for (draw, (value, row)) in
                drawn.iter_mut().zip(values.iter().zip(factor.chunks_exact(count.max(1))))
            {
                let error: f64 = row.iter().zip(&normals).map(|(a, b)| a * b).sum();
                *draw = (value + error).abs();
            }
            right +=
                order.windows(2).map(|pair| share_larger(drawn[pair[0]], drawn[pair[1]])).product::<f64>();
            for (place, counts) in smaller.iter_mut().enumerate() {
                for later in place + 1..count {
                    counts[later] += share_larger(drawn[order[place]], drawn[order[later]]);
                }
            }
            sorted.sort_by(|a, b| drawn[*a].total_cmp(&drawn[*b]).then(a.cmp(b)));
            let mut rank = 0;
            for alike in sorted.chunk_by(|a, b| drawn[*a] == drawn[*b]) {
                let share = 1.0 / alike.len() as f64;
                for index in alike {
                    ranks[*index][rank..rank + alike.len()].iter_mut().for_each(|entry| *entry += share);
                }
                rank += alike.len();
            }
        }
        let share = |count: f64| count / DRAWS as f64;
        let sure = |place: usize| -> Vec<usize> {
            let later = (place + 1..count).filter(|&later| share(smaller[place][later]) >= SURE);
            later.map(|later| order[later]).collect()
        };
        Ranking {
            decided: (0..count).map(sure).collect(),
            adjacent: (1..count).map(|place| share(smaller[place - 1][place])).collect(),
            order,
            probability: share(right),
            ranks: ranks.into_iter().map(|row| row.into_iter().map(share).collect()).collect(),
        }
    }
}

/// 1 where `second` is larger than `first`, a half where they are equal.
fn share_larger(first: f64, second: f64) -> f64 {
    match second.total_cmp(&first) {
        Ordering::Greater => 1.0,
        Ordering::Equal => 0.5,
        Ordering::Less => 0.0,
    }
}

/// Share of a variance below which what other values leave of it is rounding.
const ROUNDING: f64 = 1e-13;

/// A standard normal number (Box and Muller).
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (radius, angle): (f64, f64) = (random.random(), random.random());
    (-2.0 * (1.0 - radius).ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_values_have_the_probability_of_their_difference() {
        // Φ(1/√2) = 0.7602
        let ranking = Ranking::of(&[(11.0, 1.0), (10.0, 1.0)]);
        assert_eq!(ranking.order, [1, 0]);
        assert!((ranking.probability - 0.7602).abs() < 0.012, "{}", ranking.probability);
        assert!((ranking.ranks[0][1] - ranking.probability).abs() < 1e-12);
        // Either order of two that hardly differ is right about half of the time.
        assert!(ranking.is_stated() && !Ranking::of(&[(10.1, 1.0), (10.0, 1.0)]).is_stated());
    }

    #[test]
    fn an_error_in_common_does_not_blur_an_order() {
        // Each known to 10, their difference of 3 to √(2·(100 − 99)) = √2: Φ(3/√2) = 0.98305.
        let ranking = Ranking::joint(&[100.0, 103.0], &[100.0, 99.0, 99.0, 100.0]);
        assert!((ranking.probability - 0.98305).abs() < 0.004, "{}", ranking.probability);
        let same = Ranking::joint(&[100.0, 103.0, 101.0], &[100.0; 9]);
        assert_eq!((same.order.as_slice(), same.probability), ([0, 2, 1].as_slice(), 1.0));
    }

    #[test]
    fn magnitudes_are_ranked_and_exact_values_are_sure() {
        let ranking = Ranking::of(&[(-3.0, 0.0), (2.0, 0.0), (-1.0, 0.0)]);
        assert_eq!((ranking.order.as_slice(), ranking.probability), ([2, 1, 0].as_slice(), 1.0));
        assert_eq!(ranking.ranks[0], [0.0, 0.0, 1.0]);
    }

    #[test]
    fn what_is_equal_is_in_either_order_as_often() {
        let ranking = Ranking::of(&[(2.0, 0.0), (2.0, 0.0), (1.0, 0.0)]);
        assert_eq!((ranking.probability, ranking.adjacent.as_slice()), (0.5, [1.0, 0.5].as_slice()));
        assert_eq!(ranking.ranks, [[0.0, 0.5, 0.5], [0.0, 0.5, 0.5], [1.0, 0.0, 0.0]]);
    }

    #[test]
    fn of_an_order_that_cannot_be_told_the_pairs_that_are_far_apart_are_decided() {
        // Three that are alike to their deviations and one far above.
        let ranking = Ranking::of(&[(10.0, 1.0), (20.0, 1.0), (10.2, 1.0), (10.1, 1.0)]);
        assert_eq!(ranking.order, [0, 3, 2, 1]);
        assert!(!ranking.is_stated(), "{}", ranking.probability);
        assert_eq!(ranking.decided, [vec![1], vec![1], vec![1], vec![]]);
        let apart = Ranking::of(&[(1.0, 0.1), (3.0, 0.1), (2.0, 0.1)]);
        assert!(apart.is_stated());
        assert_eq!(apart.decided, [vec![2, 1], vec![1], vec![]]);
    }

    #[test]
    fn no_value_and_one_value_are_in_order() {
        assert_eq!(Ranking::of(&[]).probability, 1.0);
        assert_eq!(Ranking::of(&[(1.0, 5.0)]).order, [0]);
    }

    #[test]
    fn an_order_said_to_be_right_so_often_is_right_so_often() {
        // Five joints of stiffness 1 to 2, measured to 0.08, three hundred times: in each tenth of the stated
        // probability the share of right orders is the stated one to within what so few can show.
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let (mut said, mut was) = (0.0, 0.0);
        let mut tenths = [(0.0, 0.0, 0.0); 10];
        for _ in 0..300 {
            let truth: Vec<f64> = (0..5).map(|_| 1.0 + random.random::<f64>()).collect();
            let measured: Vec<(f64, f64)> =
                truth.iter().map(|t| (t + 0.08 * normal(&mut random), 0.08)).collect();
            let ranking = Ranking::of(&measured);
            let right = ranking.order.windows(2).all(|pair| truth[pair[1]] >= truth[pair[0]]);
            let tenth = &mut tenths[((ranking.probability * 10.0) as usize).min(9)];
            *tenth = (tenth.0 + 1.0, tenth.1 + ranking.probability, tenth.2 + f64::from(right));
            said += ranking.probability;
            was += f64::from(right);
        }
        assert!((said - was).abs() < 30.0, "said {said} of 300, was {was}");
        for (count, said, was) in tenths {
            assert!(
                (said - was).abs() < 4.0 + 3.0 * (0.25_f64 * count).sqrt(),
                "of {count}: said {said}, was {was}"
            );
        }
    }
}
