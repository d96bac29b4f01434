//! How many eigenvalues lie below a number: by the signs of a factor (Sylvester).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::IntranodeLbltRef;
use faer::{Conj, MatMut, Par, Side};

use crate::sparse_cholesky::{Elimination, lower, room};
use crate::sparse_space::Random;
use crate::{EigenError, SparseError, SparseSymmetric};
use std::f64::consts::TAU;

/// Number of eigenvalues of K φ = λ M φ below `shift`, (rad/s)², rigid motions included: a Sturm count.
///
/// By Sylvester's law of inertia it is the number of negative pivots of K − σM = Pᵀ L B Lᵀ P, whatever P and
/// L; B has blocks of one and two (Bunch and Kaufman's pivots, chosen within the supernodes of the factor).
/// What rounding makes of the factor is looked at: refining a solution with it must converge, which is so
/// just where no eigenvalue lies between the matrix and what was factorised in its place.
///
/// # Errors
/// Matrices of different patterns, a mass matrix without a positive diagonal, a shift that lies too close to
/// an eigenvalue for a certain answer, or no room for the factor.
pub fn eigenvalues_below(
    stiffness: &SparseSymmetric,
    mass: &SparseSymmetric,
    shift: f64,
) -> Result<usize, SparseError> {
    count_below(stiffness, mass, shift, &Elimination::of(&stiffness.pattern)?)
}

/// [`eigenvalues_below`] with an order of elimination that is known already.
pub(crate) fn count_below(
    stiffness: &SparseSymmetric,
    mass: &SparseSymmetric,
    shift: f64,
    elimination: &Elimination,
) -> Result<usize, SparseError> {
    let shifted = stiffness.plus(-shift, mass)?;
    let factor = Indefinite::of(&shifted, &stiffness.plus(shift.abs(), mass)?, elimination)?;
    let error = factor.relative_error(&shifted, mass);
    // A comparison that an error of NaN fails as well.
    let count = if error <= ERROR_ALLOWED { factor.negative_pivots() } else { None };
    count.ok_or(SparseError::Uncertain { hz: shift.max(0.0).sqrt() / TAU, error })
}

/// Most that one step of refinement may leave of a solution: at one the count would be worth nothing.
const ERROR_ALLOWED: f64 = 0.1;

/// Steps of refinement taken; each brings the error closer to the direction in which the factor is worst.
const REFINEMENTS: usize = 3;

/// S A S = Pᵀ L B Lᵀ P of a matrix of any signs, S diagonal.
struct Indefinite<'a> {
    elimination: &'a Elimination,
    /// S, which makes the diagonal of a positive definite companion one.
    scale: Vec<f64>,
    /// L, with the diagonal of B on its own.
    values: Vec<f64>,
    /// B below its diagonal: zero but for pivots of two.
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl<'a> Indefinite<'a> {
    fn of(
        matrix: &SparseSymmetric,
        companion: &SparseSymmetric,
        elimination: &'a Elimination,
    ) -> Result<Self, SparseError> {
        let order = matrix.order();
        let (starts, rows) = (&matrix.pattern.starts, &matrix.pattern.rows);
        let scale: Vec<f64> =
            starts[..order].iter().map(|start| 1.0 / companion.values[*start].sqrt()).collect();
        if scale.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(EigenError::MassNotPositive.into());
        }
        let mut scaled = matrix.values.clone();
        for column in 0..order {
            for index in starts[column]..starts[column + 1] {
                scaled[index] *= scale[column] * scale[rows[index]];
            }
        }
        if scaled.iter().any(|value| !value.is_finite()) {
            return Err(EigenError::MassNotPositive.into());
        }
        let symbolic = &elimination.symbolic;
        let mut values = room(symbolic.len_val(), 0.0, order)?;
        let mut subdiagonal = room(order, 0.0, order)?;
        let (mut forward, mut inverse) = (room(order, 0, order)?, room(order, 0, order)?);
        let scratch = symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| SparseError::Memory { order })?;
        symbolic.factorize_numeric_intranode_lblt(
            &mut values,
            &mut subdiagonal,
            &mut forward,
            &mut inverse,
            lower(matrix, &scaled),
            Side::Lower,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        Ok(Indefinite { elimination, scale, values, subdiagonal, forward, inverse })
    }

    fn negative_pivots(&self) -> Option<usize> {
        let diagonal = self.elimination.diagonal(&self.values)?;
        let mut negative = 0;
        let mut index = 0;
        while index < diagonal.len() {
            let (first, below) = (diagonal[index], self.subdiagonal[index]);
            if below == 0.0 {
                negative += usize::from(first < 0.0);
                index += 1;
            } else {
                // Two pivots at once: of opposite signs where their determinant is negative.
                let second = diagonal[index + 1];
                let opposite = first * second < below * below;
                negative += if opposite { 1 } else { 2 * usize::from(first < 0.0) };
                index += 2;
            }
        }
        Some(negative)
    }

    fn solve_in_place(&self, column: &mut [f64]) {
        let order = self.scale.len();
        let symbolic = &self.elimination.symbolic;
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, order);
        let factor = IntranodeLbltRef::new(symbolic, &self.values, &self.subdiagonal, permutation);
        let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        column.iter_mut().zip(&self.scale).for_each(|(c, s)| *c *= s);
        factor.solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(column, order, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        column.iter_mut().zip(&self.scale).for_each(|(c, s)| *c *= s);
    }

    /// Largest ‖x − F⁻¹Ax‖ / ‖x‖ in the norm of M over a few steps, F being what was factorised: of F⁻¹(F −
    /// A), which must stay below one.
    fn relative_error(&self, matrix: &SparseSymmetric, mass: &SparseSymmetric) -> f64 {
        // Not a number where the factor has overflown, and then the answer is none either.
        let norm = |x: &[f64]| mass.quadratic(x).sqrt();
        let mut x = mass.multiply(&Random::new().vector(mass.order()));
        self.solve_in_place(&mut x);
        let mut size = norm(&x);
        let mut largest = 0.0_f64;
        for _ in 0..REFINEMENTS {
            if !(size > 0.0 && size.is_finite()) {
                return f64::INFINITY;
            }
            x.iter_mut().for_each(|x| *x /= size);
            let mut image = matrix.multiply(&x);
            self.solve_in_place(&mut image);
            x.iter_mut().zip(&image).for_each(|(x, y)| *x -= y);
            size = norm(&x);
            if size == 0.0 {
                return largest;
            }
            largest = largest.max(size);
        }
        if size.is_finite() { largest } else { f64::INFINITY }
    }
}
