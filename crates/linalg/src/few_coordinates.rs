//! The undamped modes of a handful of coordinates: two or three rigid bodies have four or six, and a fit asks
//! for the modes of slightly changed ones by the hundred thousand. A library made for large matrices spends
//! most of its time on its way to them.
//!
//! Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, 8.5) on L⁻¹KL⁻ᵀ: nothing is faster at
//! this size, and nothing more accurate.

use crate::modal_basis::{EigenError, ModalBasis, judged};

/// Largest number of coordinates.
pub(crate) const FEW: usize = 8;
/// Sweeps over all pairs of coordinates at the most; six or seven do.
const SWEEPS: usize = 40;
/// Of the norm, what an element off the diagonal may keep.
const NEGLIGIBLE: f64 = 1e-16;

type Square = [[f64; FEW]; FEW];

/// Solves K φ = λ M φ for balanced matrices, M with a unit diagonal and K of unit norm: eigenvalues
/// ascending, and the shapes, ΞᵀMΞ = I, by coordinate and mode.
fn solve(n: usize, mass: &Square, stiffness: &Square) -> Result<([f64; FEW], Square), EigenError> {
    let mut lower = *mass;
    if !factorise(n, &mut lower) {
        return Err(EigenError::MassNotPositive);
    }
    let mut a = *stiffness;
    for _ in 0..2 {
        // L⁻¹ from the left, then the transpose: twice makes L⁻¹KL⁻ᵀ.
        for column in 0..n {
            for i in 0..n {
                let known: f64 = (0..i).map(|k| lower[i][k] * a[k][column]).sum();
                a[i][column] = (a[i][column] - known) / lower[i][i];
            }
        }
        let half = a;
        (0..n).for_each(|i| (0..n).for_each(|j| a[i][j] = half[j][i]));
    }
    let half = a;
    (0..n).for_each(|i| (0..n).for_each(|j| a[i][j] = 0.5 * (half[i][j] + half[j][i])));
    let vectors = diagonalised(n, &mut a)?;

    let mut order: [usize; FEW] = std::array::from_fn(|r| r);
    order[..n].sort_by(|&r, &s| a[r][r].total_cmp(&a[s][s]));
    let mut values = [0.0; FEW];
    let mut shapes = [[0.0; FEW]; FEW];
    for (r, &from) in order[..n].iter().enumerate() {
        values[r] = a[from][from];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| lower[k][i] * shapes[k][r]).sum();
            shapes[i][r] = (vectors[i][from] - known) / lower[i][i];
        }
    }
    Ok((values, shapes))
}

/// Overwrites the lower triangle of the leading `n` × `n` part of a matrix with its Cholesky factor; false
/// where it is not positive definite.
fn factorise(n: usize, matrix: &mut Square) -> bool {
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - known;
            if j < i {
                matrix[i][j] = rest / matrix[j][j];
            } else if rest > 0.0 && rest.is_finite() {
                matrix[i][i] = rest.sqrt();
            } else {
                return false;
            }
        }
    }
    true
}

/// Rotates `a` until it is diagonal; the product of the rotations, whose columns are the eigenvectors.
fn diagonalised(n: usize, a: &mut Square) -> Result<Square, EigenError> {
    let mut vectors = [[0.0; FEW]; FEW];
    (0..n).for_each(|i| vectors[i][i] = 1.0);
    let norm = a.iter().flatten().map(|value| value * value).sum::<f64>().sqrt();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() <= NEGLIGIBLE * norm {
                    continue;
                }
                rotated = true;
                let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
                let cosine = (tangent * tangent + 1.0).sqrt().recip();
                let sine = tangent * cosine;
                let change = tangent * a[p][q];
                a[p][p] -= change;
                a[q][q] += change;
                (a[p][q], a[q][p]) = (0.0, 0.0);
                for k in (0..n).filter(|&k| k != p && k != q) {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (cosine * x - sine * y, sine * x + cosine * y);
                    (a[k][p], a[k][q]) = (a[p][k], a[q][k]);
                }
                for row in &mut vectors[..n] {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (cosine * x - sine * y, sine * x + cosine * y);
                }
            }
        }
        if !rotated {
            return Ok(vectors);
        }
    }
    Err(EigenError::NoConvergence)
}

/// As [`crate::generalized_symmetric_eigen`], of finite matrices of at most [`FEW`] coordinates.
pub(crate) fn modes(n: usize, mass: &[f64], stiffness: &[f64]) -> Result<ModalBasis, EigenError> {
    let mut unit = [0.0; FEW];
    for i in 0..n {
        let diagonal = mass[i * n + i];
        if diagonal <= 0.0 {
            return Err(EigenError::MassNotPositive);
        }
        unit[i] = diagonal.sqrt().recip();
    }
    let balanced = |matrix: &[f64]| {
        let mut all = [[0.0; FEW]; FEW];
        for i in 0..n {
            for j in 0..n {
                all[i][j] = 0.5 * (matrix[i * n + j] + matrix[j * n + i]) * unit[i] * unit[j];
            }
        }
        all
    };
    let (mass, mut stiffness) = (balanced(mass), balanced(stiffness));
    let norm = stiffness.iter().flatten().map(|value| value * value).sum::<f64>().sqrt();
    let norm = if norm > 0.0 { norm } else { 1.0 };
    stiffness.iter_mut().flatten().for_each(|value| *value /= norm);
    let (mut values, shapes) = solve(n, &mass, &stiffness)?;
    let largest = values[n - 1].abs().max(values[0].abs());
    let zero = 1e-14 * n as f64 * largest;
    values[..n].iter_mut().filter(|value| value.abs() <= zero).for_each(|value| *value = 0.0);
    judged(n, residual(n, &mass, &stiffness, &values, &shapes))?;
    let mut columns = Vec::with_capacity(n * n);
    (0..n).for_each(|r| columns.extend((0..n).map(|i| shapes[i][r] * unit[i])));
    ModalBasis::new(values[..n].iter().map(|value| value * norm).collect(), columns)
        .ok_or(EigenError::NoConvergence)
}

/// The largest of what the equations leave and of the departures of ΞᵀMΞ from the unit matrix.
fn residual(n: usize, mass: &Square, stiffness: &Square, values: &[f64; FEW], shapes: &Square) -> f64 {
    let times = |matrix: &Square, r: usize| -> [f64; FEW] {
        std::array::from_fn(|i| (0..n).map(|k| matrix[i][k] * shapes[k][r]).sum())
    };
    let scale = values[..n].iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let mut worst = 0.0_f64;
    for r in 0..n {
        let (inertial, elastic) = (times(mass, r), times(stiffness, r));
        let left: f64 = (0..n).map(|i| (elastic[i] - values[r] * inertial[i]).powi(2)).sum();
        let size: f64 = inertial.iter().map(|value| value * value).sum();
        // The larger of two would drop a residual that is not a number.
        let equation = (left / size).sqrt() / scale;
        worst = if equation <= worst { worst } else { equation };
        for s in 0..n {
            let gram: f64 = (0..n).map(|i| shapes[i][s] * inertial[i]).sum();
            let departure = (gram - f64::from(r == s)).abs();
            worst = if departure <= worst { worst } else { departure };
        }
    }
    worst
}
