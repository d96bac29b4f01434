//! Receptances of few modes with changes of high rank: one solution in the modes' own coordinates.

use crate::model::Denominator;
use crate::terms::Terms;
use num_complex::Complex64;

/// Modes up to which there is a solution of fixed size, which the compiler unrolls.
pub(crate) const FEW_MODES: usize = 12;
/// A pivot smaller than this share of the largest element is a zero.
const ZERO: f64 = 1e-15;

/// (D(s) + V Δ(s) Vᵀ) q = Φ_i with D diagonal. The modes are mass-normalised, so that all elements have one unit and none needs scaling.
#[derive(Debug, Clone)]
pub(crate) struct ModalSystem {
    denominators: Vec<Denominator>,
    /// Participations, a row over the modes for each output, input and station of the change.
    outputs: Vec<f64>,
    inputs: Vec<f64>,
    change: Vec<f64>,
    delta: Vec<Complex64>,
    /// Modal coordinates, a row over the modes for each input.
    solution: Vec<Complex64>,
}

impl ModalSystem {
    pub fn new(
        denominators: Vec<Denominator>,
        outputs: &[Vec<f64>],
        inputs: &[Vec<f64>],
        change: &[Vec<f64>],
    ) -> Self {
        ModalSystem {
            outputs: outputs.concat(),
            inputs: inputs.concat(),
            change: change.concat(),
            delta: vec![Complex64::ZERO; change.len() * change.len()],
            solution: vec![Complex64::ZERO; denominators.len() * inputs.len()],
            denominators,
        }
    }

    /// Writes the receptance of each (output, input) at `s`; `false` where there is no solution.
    pub fn at(
        &mut self,
        s: Complex64,
        terms: &Terms,
        pairs: &[(usize, usize)],
        values: &mut [Complex64],
    ) -> bool {
        terms.write(s, &mut self.delta);
        let order = self.denominators.len();
        let solved = match order {
            1 => self.solve::<1>(s),
            2 => self.solve::<2>(s),
            3 => self.solve::<3>(s),
            4 => self.solve::<4>(s),
            5 => self.solve::<5>(s),
            6 => self.solve::<6>(s),
            7 => self.solve::<7>(s),
            8 => self.solve::<8>(s),
            9 => self.solve::<9>(s),
            10 => self.solve::<10>(s),
            11 => self.solve::<11>(s),
            FEW_MODES => self.solve::<FEW_MODES>(s),
            _ => false,
        };
        if solved {
            for (value, &(output, input)) in values.iter_mut().zip(pairs) {
                let shapes = &self.outputs[output * order..(output + 1) * order];
                let modes = &self.solution[input * order..(input + 1) * order];
                *value = shapes.iter().zip(modes).map(|(shape, q)| q * *shape).sum();
            }
        }
        solved
    }

    fn solve<const N: usize>(&mut self, s: Complex64) -> bool {
        let Some((matrix, pivots)) = factorized(self.matrix::<N>(s)) else { return false };
        let columns = self.inputs.as_chunks::<N>().0.iter().zip(self.solution.as_chunks_mut::<N>().0);
        for (input, solution) in columns {
            *solution = input.map(|shape| Complex64::new(shape, 0.0));
            substitute(&matrix, &pivots, solution);
        }
        true
    }

    /// D + V Δ Vᵀ.
    fn matrix<const N: usize>(&self, s: Complex64) -> [[Complex64; N]; N] {
        let change = self.change.as_chunks::<N>().0;
        let mut matrix = [[Complex64::ZERO; N]; N];
        for (shapes, delta) in change.iter().zip(self.delta.chunks_exact(change.len())) {
            let mut product = [Complex64::ZERO; N];
            for (factor, other) in delta.iter().zip(change).filter(|(factor, _)| **factor != Complex64::ZERO)
            {
                for n in 0..N {
                    product[n] += factor * other[n];
                }
            }
            for (row, shape) in matrix.iter_mut().zip(shapes) {
                for n in 0..N {
                    row[n] += product[n] * *shape;
                }
            }
        }
        let squared = s * s;
        for (mode, denominator) in self.denominators.iter().enumerate().take(N) {
            matrix[mode][mode] += denominator.stiffness + s * denominator.viscous + squared;
        }
        matrix
    }
}

/// LU with partial pivoting in place, pivots inverted on the diagonal, and the rows that were exchanged.
fn factorized<const N: usize>(mut matrix: [[Complex64; N]; N]) -> Option<([[Complex64; N]; N], [usize; N])> {
    let largest = matrix.iter().flatten().map(|e| e.norm_sqr()).fold(0.0, f64::max);
    let mut pivots = [0; N];
    for column in 0..N {
        let size = |row: usize| matrix[row][column].norm_sqr();
        let pivot = (column..N).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        if !largest.is_finite() || size(pivot).is_nan() || size(pivot) <= ZERO * ZERO * largest {
            return None;
        }
        pivots[column] = pivot;
        matrix.swap(column, pivot);
        let inverse = matrix[column][column].inv();
        matrix[column][column] = inverse;
        let pivot_row = matrix[column];
        for row in matrix.iter_mut().skip(column + 1) {
            let factor = row[column] * inverse;
            row[column] = factor;
            for n in column + 1..N {
                row[n] -= factor * pivot_row[n];
            }
        }
    }
    Some((matrix, pivots))
}

fn substitute<const N: usize>(
    matrix: &[[Complex64; N]; N],
    pivots: &[usize; N],
    values: &mut [Complex64; N],
) {
    for row in 0..N {
        values.swap(row, pivots[row]);
    }
    for row in 1..N {
        for n in 0..row {
            values[row] -= matrix[row][n] * values[n];
        }
    }
    for row in (0..N).rev() {
        for n in row + 1..N {
            values[row] -= matrix[row][n] * values[n];
        }
        values[row] *= matrix[row][row];
    }
}
