//! Joints that move alike with the fixture's quantities.
//!
//! Near its optimum a fit tells θ + S q, S = J_θθ⁻¹ J_θq being by how much the numbers θ of the joint move
//! with the quantities q for the same FRFs. FRFs are not linear in q: two fits that end at other q of one
//! flat valley have slopes S that differ, and with quantities of which the FRFs tell nothing that difference
//! alone looks like an uncertain difference of the joints. If the joints are the same and the blocks are, so
//! is the valley. Its slope between two points on it is the mean of those at both to second order (the
//! trapezoidal rule), so that whether joints are the same is tested with the mean slope of all of them. What
//! each test tells of q stays as it is.

use crate::{Decomposed, FiledJoint, FiledLikelihood};
use jointscope_inference::QuadraticLikelihood;
use jointscope_linalg::{Cholesky, dot};

/// A likelihood by the slope of its valley.
struct Valley {
    numbers: usize,
    likelihood: QuadraticLikelihood,
    /// S, by columns: one for each quantity.
    slope: Vec<Vec<f64>>,
}

impl Valley {
    fn of(fit: &FiledJoint) -> Option<Self> {
        let (slots, likelihood) = fit.likelihood()?;
        let (m, n) = (slots.len(), likelihood.order());
        let own: Vec<f64> = (0..m * m).map(|e| likelihood.information[e / m * n + e % m]).collect();
        let factor = Cholesky::of(m, &own)?;
        let column = |q: usize| {
            let mut column: Vec<f64> = (0..m).map(|i| likelihood.information[i * n + q]).collect();
            factor.solve_in_place(&mut column);
            column
        };
        let slope = (m..n).map(column).collect();
        Some(Valley { numbers: m, likelihood, slope })
    }

    /// J_θθ times a column of slopes.
    fn information_times(&self, column: &[f64]) -> Vec<f64> {
        let n = self.likelihood.order();
        let row = |i: usize| &self.likelihood.information[i * n..i * n + self.numbers];
        (0..self.numbers).map(|i| dot(row(i), column)).collect()
    }

    /// The same with another slope: what is told of θ + S q and of q by itself stays.
    fn with(&self, slope: &[Vec<f64>]) -> QuadraticLikelihood {
        let (m, n) = (self.numbers, self.likelihood.order());
        let mut other = self.likelihood.clone();
        let before: Vec<Vec<f64>> = self.slope.iter().map(|column| self.information_times(column)).collect();
        let after: Vec<Vec<f64>> = slope.iter().map(|column| self.information_times(column)).collect();
        let gradient = &self.likelihood.gradient[..m];
        for p in 0..n - m {
            other.gradient[m + p] += dot(&slope[p], gradient) - dot(&self.slope[p], gradient);
            for i in 0..m {
                other.information[i * n + m + p] = after[p][i];
                other.information[(m + p) * n + i] = after[p][i];
            }
            for q in 0..n - m {
                other.information[(m + p) * n + m + q] +=
                    dot(&slope[p], &after[q]) - dot(&self.slope[p], &before[q]);
            }
        }
        other
    }
}

/// Whether two fits are of the same numbers and quantities, stated alike.
fn is_alike(a: &FiledJoint, b: &FiledJoint) -> bool {
    let elements = |fit: &FiledJoint| fit.likelihood.as_ref().map(|filed| filed.elements.clone());
    elements(a).is_some() && elements(a) == elements(b) && a.quantities == b.quantities
}

/// The fit of a joint that no other was found with, and its valley.
fn with_valley(joint: &Decomposed) -> Option<(&FiledJoint, Valley)> {
    let fit = joint.fitted.as_ref().filter(|_| joint.at_once.is_none())?;
    Some((fit, Valley::of(fit)?))
}

/// The joints with the mean slope of those that are of the same numbers and quantities; the others stay, and
/// so do joints that one fit found at once.
pub(crate) fn of_one_slope(joints: &[Decomposed]) -> Vec<Decomposed> {
    let fits: Vec<Option<(&FiledJoint, Valley)>> = joints.iter().map(with_valley).collect();
    let levelled = |(joint, own): (&Decomposed, &Option<(&FiledJoint, Valley)>)| {
        let Some((fit, valley)) = own else { return joint.clone() };
        let alike: Vec<&Valley> = fits
            .iter()
            .flatten()
            .filter(|(other, _)| is_alike(fit, other))
            .map(|(_, valley)| valley)
            .collect();
        let mean = |p: usize, i: usize| {
            alike.iter().map(|valley| valley.slope[p][i]).sum::<f64>() / alike.len() as f64
        };
        let slope: Vec<Vec<f64>> =
            (0..valley.slope.len()).map(|p| (0..valley.numbers).map(|i| mean(p, i)).collect()).collect();
        let elements = fit.likelihood.as_ref().map_or_else(Vec::new, |filed| filed.elements.clone());
        let likelihood = Some(FiledLikelihood::of(elements, &valley.with(&slope)));
        Decomposed { fitted: Some(FiledJoint { likelihood, ..(*fit).clone() }), ..joint.clone() }
    };
    joints.iter().zip(&fits).map(levelled).collect()
}

/// What the valley of two joints that are tested for being the same bends by between their two tests: half of
/// what their slopes differ by, times what their quantities do, by place among the six; nothing of joints that
/// are not of the same numbers and quantities.
pub(crate) fn bend_between(two: &[Decomposed]) -> Vec<(usize, f64)> {
    let [Some((fit, one)), Some((with, other))] = &two.iter().map(with_valley).collect::<Vec<_>>()[..] else {
        return Vec::new();
    };
    let Some((slots, _)) = fit.likelihood().filter(|_| is_alike(fit, with)) else { return Vec::new() };
    let m = one.numbers;
    let by = |i: usize| {
        let quantities = one.slope.iter().zip(&other.slope).enumerate();
        let apart = |p: usize| one.likelihood.at[m + p] - other.likelihood.at[m + p];
        quantities.map(|(p, (own, others))| 0.5 * (own[i] - others[i]) * apart(p)).sum()
    };
    slots.into_iter().enumerate().map(|(i, slot)| (slot, by(i))).collect()
}
