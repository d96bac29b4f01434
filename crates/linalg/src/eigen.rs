//! All modes of a symmetric pair of stiffness and mass, normalised to the mass.

use faer::{Mat, Side};

use crate::few_coordinates::{self, FEW};
use crate::modal_basis::{EigenError, ModalBasis, judged};

/// Solves `K φ = λ M φ` for symmetric `stiffness` and symmetric positive definite `mass`, both
/// row-major of order `order` (eq 24 as corrected, 25, 28, 29).
///
/// Coordinates are scaled to unit mass first, so that displacements and rotations weigh alike, and the
/// standard problem is divided by its norm before it is solved. Eigenvalues that are zero to working
/// precision (rigid motions) come back as exactly zero; negative ones of an indefinite stiffness come back as
/// they are. The lowest modes of a structure that something very stiff holds are found from `M φ = λ⁻¹ K φ`:
/// beside an eigenvalue of 1e14 times theirs, the problem as it stands has only rounding left of them.
///
/// # Errors
/// See [`EigenError`].
pub fn generalized_symmetric_eigen(
    order: usize,
    mass: &[f64],
    stiffness: &[f64],
) -> Result<ModalBasis, EigenError> {
    let finite = |a: &[f64]| a.len() == order * order && a.iter().all(|e| e.is_finite());
    if order == 0 || !finite(mass) || !finite(stiffness) {
        return Err(EigenError::Shape { order });
    }
    if order <= FEW {
        few_coordinates::modes(order, mass, stiffness)
    } else {
        by_library(order, mass, stiffness)
    }
}

fn by_library(order: usize, mass: &[f64], stiffness: &[f64]) -> Result<ModalBasis, EigenError> {
    let mut unit = Vec::with_capacity(order);
    for i in 0..order {
        let diagonal = mass[i * order + i];
        if diagonal <= 0.0 {
            return Err(EigenError::MassNotPositive);
        }
        unit.push(1.0 / diagonal.sqrt());
    }
    let balanced = |a: &[f64]| {
        Mat::from_fn(order, order, |i, j| 0.5 * (a[i * order + j] + a[j * order + i]) * unit[i] * unit[j])
    };
    let mass = balanced(mass);
    let mut stiffness = balanced(stiffness);
    let norm = norm_of(&stiffness);
    stiffness *= faer::Scale(1.0 / norm);

    let factor = mass.llt(Side::Lower).map_err(|_| EigenError::MassNotPositive)?;
    let lower = factor.L();
    // A = L⁻¹ K L⁻ᵀ, by two triangular solves.
    let mut standard = stiffness.clone();
    lower.solve_lower_triangular_in_place(standard.as_mut());
    let mut standard = standard.transpose().to_owned();
    lower.solve_lower_triangular_in_place(standard.as_mut());
    let symmetric = Mat::from_fn(order, order, |i, j| 0.5 * (standard[(i, j)] + standard[(j, i)]));
    let standard_norm = norm_of(&symmetric);
    let symmetric = symmetric * faer::Scale(1.0 / standard_norm);
    let eigen = symmetric.self_adjoint_eigen(Side::Lower).map_err(|_| EigenError::NoConvergence)?;
    let mut shapes = eigen.U().to_owned();
    lower.transpose().solve_upper_triangular_in_place(shapes.as_mut());

    let values = eigen.S();
    let largest = values[order - 1].abs().max(values[0].abs());
    let zero = 1e-14 * order as f64 * largest;
    let lost = (0..order).any(|r| values[r].abs() <= zero);
    let mut scaled: Vec<f64> =
        (0..order).map(|r| if values[r].abs() <= zero { 0.0 } else { values[r] * standard_norm }).collect();
    if lost && let Some(held) = HeldModes::of(&mass, &stiffness) {
        held.replace_lowest(&mass, &mut scaled, &mut shapes);
    }
    check(&mass, &stiffness, &scaled, &shapes)?;

    let columns = (0..order * order).map(|k| shapes[(k % order, k / order)] * unit[k % order]).collect();
    ModalBasis::new(scaled.iter().map(|value| value * norm).collect(), columns)
        .ok_or(EigenError::NoConvergence)
}

/// Root of the sum of squares, one for a matrix of zeros. The library's own guards against overflow, at a
/// tenth of the eigenproblem's cost.
fn norm_of(matrix: &Mat<f64>) -> f64 {
    let column = |j: usize| matrix.col_as_slice(j).iter().map(|value| value * value).sum::<f64>();
    let norm = (0..matrix.ncols()).map(column).sum::<f64>().sqrt();
    if norm > 0.0 { norm } else { 1.0 }
}

/// Of a stiffness with a unit diagonal and so many coordinates, less than this left of a pivot may be
/// rounding of a structure that moves as rigid.
const PIVOT_ROUNDING: f64 = 1e-13;
/// Relative distance up to which eigenvalues are taken from one of the two problems together.
const NEIGHBOURS: f64 = 1e-3;

/// Modes of a structure that cannot move as rigid, from `M φ = μ K φ`: the lowest are exact in it, as the
/// highest are in `K φ = λ M φ`.
struct HeldModes {
    /// 1/μ, ascending.
    values: Vec<f64>,
    shapes: Mat<f64>,
}

impl HeldModes {
    /// `None` where the stiffness is not positive definite beyond rounding.
    fn of(mass: &Mat<f64>, stiffness: &Mat<f64>) -> Option<Self> {
        let order = mass.nrows();
        let unit: Vec<f64> = (0..order)
            .map(|i| (stiffness[(i, i)] > 0.0).then(|| stiffness[(i, i)].sqrt().recip()))
            .collect::<Option<_>>()?;
        let balanced = |a: &Mat<f64>| Mat::from_fn(order, order, |i, j| a[(i, j)] * unit[i] * unit[j]);
        let factor = balanced(stiffness).llt(Side::Lower).ok()?;
        let lower = factor.L();
        let least = PIVOT_ROUNDING * order as f64;
        if (0..order).any(|i| lower[(i, i)].powi(2) <= least) {
            return None;
        }
        let mut inverse = balanced(mass);
        lower.solve_lower_triangular_in_place(inverse.as_mut());
        let mut inverse = inverse.transpose().to_owned();
        lower.solve_lower_triangular_in_place(inverse.as_mut());
        let inverse = Mat::from_fn(order, order, |i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]));
        let eigen = inverse.self_adjoint_eigen(Side::Lower).ok()?;
        let (found, mut columns) = (eigen.S(), eigen.U().to_owned());
        lower.transpose().solve_upper_triangular_in_place(columns.as_mut());
        // Rounding of the largest decides how far down the others mean anything.
        let meaningful = (0..order).rev().take_while(|&r| found[r] > found[order - 1] * f64::EPSILON);
        let values: Vec<f64> = meaningful.map(|r| found[r].recip()).collect();
        let shapes = Mat::from_fn(order, values.len(), |i, r| {
            columns[(i, order - 1 - r)] * unit[i] * values[r].sqrt()
        });
        Some(HeldModes { values, shapes })
    }

    /// Puts them in the place of the lowest of all modes, up to where both problems are equally exact.
    fn replace_lowest(&self, mass: &Mat<f64>, values: &mut [f64], shapes: &mut Mat<f64>) {
        let order = values.len();
        let middle = (self.values[0] * values[order - 1]).sqrt();
        let mut low = self.values.iter().take_while(|value| **value <= middle).count();
        while (1..self.values.len()).contains(&low)
            && self.values[low] - self.values[low - 1] <= NEIGHBOURS * self.values[low]
        {
            low += 1;
        }
        // Where the two disagree about what comes next, neither is known to be right.
        if low == 0 || low < order && values[low] < self.values[low - 1] {
            return;
        }
        for r in 0..low {
            values[r] = self.values[r];
            (0..order).for_each(|i| shapes[(i, r)] = self.shapes[(i, r)]);
        }
        // Of the lowest modes the others hold what rounding left in them.
        let inertial = mass * self.shapes.subcols(0, low);
        let shares = inertial.transpose() * shapes.subcols(low, order - low);
        let held = self.shapes.subcols(0, low) * shares;
        for r in low..order {
            (0..order).for_each(|i| shapes[(i, r)] -= held[(i, r - low)]);
        }
    }
}

fn check(mass: &Mat<f64>, stiffness: &Mat<f64>, values: &[f64], shapes: &Mat<f64>) -> Result<(), EigenError> {
    let order = values.len();
    let mass_shapes = mass * shapes;
    let stiffness_shapes = stiffness * shapes;
    let scale = values.iter().fold(f64::MIN_POSITIVE, |largest, v| largest.max(v.abs()));
    let mut residual = 0.0_f64;
    for r in 0..order {
        let equation: f64 =
            (0..order).map(|i| (stiffness_shapes[(i, r)] - values[r] * mass_shapes[(i, r)]).powi(2)).sum();
        let size: f64 = (0..order).map(|i| mass_shapes[(i, r)].powi(2)).sum();
        residual = residual.max((equation / size).sqrt() / scale);
    }
    let gram = shapes.transpose() * &mass_shapes;
    for i in 0..order {
        for j in 0..order {
            residual = residual.max((gram[(i, j)] - f64::from(i == j)).abs());
        }
    }
    judged(order, residual)
}
