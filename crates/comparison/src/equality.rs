//! Whether joints are the same: FRFs alone, at one law, with C free, as if on one valley of the quantities.
//!
//! Two joints are tested by their own two tests. With a third on the same blocks the quantities would be
//! known better, but combinations of K are known a hundred times better than its elements, and the mean slope
//! of three valleys follows none of two between them to second order. All joints are the same where every two
//! are: the p-value of the pair that differs most, times the number of pairs.
//!
//! Where several laws are probable for both, the p-value is the mean of those under each, as often as it is
//! probable.
//!
//! Two tests with wide tolerances end far apart in the valley, and of the differences of numbers that are known
//! to 10⁻⁵ its third order is then many deviations. So the test is of the numbers about the elastic centre, of
//! which the valley bends least; and a tenth of what it bends by between the two, its second order, is taken
//! off before a difference counts. Of 29 joints tested twice, the valley of which bent by 50 deviations and more, √χ² was 0.02 to
//! 0.08 of that.

use crate::about_centre::about_centre;
use crate::at_law::with_free_damping;
use crate::choices::{Choice, choices};
use crate::normal::mahalanobis;
use crate::one_slope::{bend_between, of_one_slope};
use crate::{Decomposed, LawOfAll, Number, Together};
use jointscope_inference::{SIGNIFICANT, chi_squared_above};
use serde::Serialize;

/// Share of a difference's terms below which it is rounding.
const ROUNDING: f64 = 1e-13;
/// Share of what the valley bends by between two tests, its second order, that higher orders may come to.
const HIGHER_ORDERS: f64 = 0.1;

/// Deviations that may be hidden without a word.
const HIDDEN: f64 = 2.0;

/// A test of equal numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Equality {
    /// χ² of the differences.
    pub chi2: f64,
    /// Degrees of freedom: numbers that have a deviation and are not fixed by others.
    pub degrees: usize,
    /// By how many deviations the blocks' valley bends between the two tests; a tenth of it is taken off √χ²
    /// before the differences count.
    pub bend: f64,
    /// Probability of differences as large or larger, if the joints are the same.
    pub p_value: f64,
}

impl Equality {
    /// Whether the joints count as different.
    pub fn is_refuted(&self) -> bool {
        self.p_value < SIGNIFICANT
    }

    /// Whether what is taken off for the bend of the blocks' valley hides differences of several deviations.
    pub fn is_blunt(&self) -> bool {
        HIGHER_ORDERS * self.bend > HIDDEN
    }

    /// Of several joints, by the tests of every two of them.
    pub(crate) fn of_pairs(pairs: impl Iterator<Item = Option<Equality>>) -> Option<Self> {
        let each: Vec<Equality> = pairs.collect::<Option<_>>()?;
        let most =
            each.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value).then(b.chi2.total_cmp(&a.chi2)))?;
        Some(Equality { p_value: (most.p_value * each.len() as f64).min(1.0), ..*most })
    }

    /// Of two joints by each of several laws: χ² is of the first, the p-value the mean of all, each as often
    /// as it is probable.
    pub(crate) fn by_law(tests: &[TestedTwo]) -> Option<Self> {
        let each: Vec<Option<(f64, Equality)>> =
            tests.iter().map(|test| Some((test.weight, test.equality()?))).collect();
        let first = each.first().copied().flatten()?.1;
        let known = each.iter().flatten();
        let (sum, weight) =
            known.fold((0.0, 0.0), |(sum, all), (weight, of)| (sum + weight * of.p_value, all + weight));
        Some(Equality { p_value: if each.len() == 1 { first.p_value } else { sum / weight }, ..first })
    }
}

/// Two joints under one law, by which they are tested for being the same.
pub(crate) struct TestedTwo {
    /// How probable the law is.
    weight: f64,
    /// Their numbers, about the elastic centre where that can be.
    pub together: Together,
    /// What the valley bends by between the two tests, by number.
    bend: Vec<f64>,
}

/// The joints by every law that is probable for both; nothing where they have none in common.
pub(crate) fn of_two(two: &[Decomposed; 2], numbers: &[Number], independent: bool) -> Option<Vec<TestedTwo>> {
    let law = LawOfAll::of(two)?;
    let all = choices(two, &law.placed(two), Some(&law));
    let known = all.iter().filter(|choice| choice.apart.is_none());
    let of = |choice: &Choice| {
        let joints = about_centre(&choice.joints, numbers).unwrap_or_else(|| choice.joints.clone());
        let bends = bend_between(&joints);
        let bend = |number: &Number| bends.iter().find(|(slot, _)| *slot == number.slot());
        let free = with_free_damping(&of_one_slope(&joints));
        TestedTwo {
            weight: choice.weight,
            together: Together::of((&free, &all), numbers, independent),
            bend: numbers.iter().map(|number| bend(number).map_or(0.0, |(_, by)| *by)).collect(),
        }
    };
    Some(known.map(of).collect())
}

impl TestedTwo {
    /// Of all numbers of both joints at once; nothing where it is not known how their errors go together.
    fn equality(&self) -> Option<Equality> {
        let (differences, covariance) = self.together.second_less_first()?;
        let (chi2, degrees) = mahalanobis(&differences, &covariance)?;
        let bend = mahalanobis(&self.bend, &covariance)?.0.sqrt();
        let told = (chi2.sqrt() - HIGHER_ORDERS * bend).max(0.0);
        Some(Equality { chi2, degrees, bend, p_value: chi_squared_above(told * told, degrees as f64) })
    }
}

impl Together {
    /// By how much the numbers of the second joint are more than those of the first, and the covariance of
    /// that; nothing where it is not known how their errors go together.
    fn second_less_first(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        if !self.has_covariances {
            return None;
        }
        let n = self.numbers();
        let covariance = |e: usize| {
            let (a, b) = (e / n, e % n);
            let of = |a, b| self.covariance(a, b);
            // What is left of nearly equal terms is rounding where it is nothing beside them.
            let left = of((1, a), (1, b)) - of((1, a), (0, b)) - of((0, a), (1, b)) + of((0, a), (0, b));
            let variance = |n: usize| of((1, n), (1, n)) + of((0, n), (0, n));
            if left.abs() <= ROUNDING * (variance(a) * variance(b)).sqrt() { 0.0 } else { left }
        };
        let differences = (0..n).map(|number| self.value(1, number) - self.value(0, number)).collect();
        Some((differences, (0..n * n).map(covariance).collect()))
    }
}
