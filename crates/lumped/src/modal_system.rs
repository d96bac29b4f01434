//! Receptances of few modes with changes of high rank: one solution in the modes' own coordinates.

use crate::denominator::Denominator;
use crate::lanes::Lines;
use num_complex::Complex64;

/// Modes up to which there is a solution of fixed size, which the compiler unrolls.
pub(crate) const FEW_MODES: usize = 12;
/// A pivot smaller than this share of the largest element is a zero.
const ZERO: f64 = 1e-15;
/// A pivot smaller than this share of the largest element below it, both squared, asks for rows to be exchanged: what is eliminated by it grows as many times. Against the largest of
/// all it may well be small: where a change is stiff, all that is left once it has been eliminated is.
const WEAK: f64 = 1e-6;

/// (D(s) + V Δ(s) Vᵀ) q = Φ_i with D diagonal. The modes are mass-normalised, so that all elements have one unit and none needs scaling.
#[derive(Debug, Clone)]
pub(crate) struct ModalSystem {
    denominators: Vec<Denominator>,
    /// Participations, a row over the modes for each output, input and station of the change.
    outputs: Vec<f64>,
    inputs: Vec<f64>,
    change: Vec<f64>,
}

impl ModalSystem {
    pub(crate) fn new(
        denominators: Vec<Denominator>,
        outputs: &[Vec<f64>],
        inputs: &[Vec<f64>],
        change: &[Vec<f64>],
    ) -> Self {
        let (outputs, inputs, change) = (outputs.concat(), inputs.concat(), change.concat());
        ModalSystem { outputs, inputs, change, denominators }
    }

    /// Writes the receptance of each (output, input) at `s`, given Δ(s) with its elements that are not zero; `false` where a line has
    /// no solution. `solution` is memory for the modes' coordinates, a row for each input.
    #[inline(always)]
    pub(crate) fn at<T: Lines>(
        &self,
        s: T,
        delta: &[T],
        elements: &[(usize, usize)],
        solution: &mut Vec<T>,
        pairs: &[(usize, usize)],
        values: &mut [T],
    ) -> bool {
        let order = self.denominators.len();
        solution.resize(self.inputs.len(), T::ZERO);
        let solved = match order {
            1 => self.solve::<1, T>(s, delta, elements, solution),
            2 => self.solve::<2, T>(s, delta, elements, solution),
            3 => self.solve::<3, T>(s, delta, elements, solution),
            4 => self.solve::<4, T>(s, delta, elements, solution),
            5 => self.solve::<5, T>(s, delta, elements, solution),
            6 => self.solve::<6, T>(s, delta, elements, solution),
            7 => self.solve::<7, T>(s, delta, elements, solution),
            8 => self.solve::<8, T>(s, delta, elements, solution),
            9 => self.solve::<9, T>(s, delta, elements, solution),
            10 => self.solve::<10, T>(s, delta, elements, solution),
            11 => self.solve::<11, T>(s, delta, elements, solution),
            FEW_MODES => self.solve::<FEW_MODES, T>(s, delta, elements, solution),
            _ => false,
        };
        if solved {
            for (value, &(output, input)) in values.iter_mut().zip(pairs) {
                let shapes = &self.outputs[output * order..(output + 1) * order];
                let modes = &solution[input * order..(input + 1) * order];
                *value = shapes.iter().zip(modes).fold(T::ZERO, |sum, (shape, q)| sum + *q * *shape);
            }
        }
        solved
    }

    #[inline(always)]
    fn solve<const N: usize, T: Lines>(
        &self,
        s: T,
        delta: &[T],
        elements: &[(usize, usize)],
        solution: &mut [T],
    ) -> bool {
        let mut matrix = self.matrix::<N, T>(s, delta, elements);
        let inputs = self.inputs.as_chunks::<N>().0;
        let columns = solution.as_chunks_mut::<N>().0;
        if factorize_symmetric(&mut matrix) {
            for (input, column) in inputs.iter().zip(columns) {
                *column = input.map(|shape| T::constant(Complex64::new(shape, 0.0)));
                substitute(&matrix, column);
            }
            return true;
        }
        let matrix = self.matrix::<N, T>(s, delta, elements);
        (0..T::COUNT).all(|line| solve_line(&matrix, line, inputs, columns))
    }

    /// The lower triangle of D + V Δ Vᵀ, which is symmetric.
    #[inline(always)]
    fn matrix<const N: usize, T: Lines>(
        &self,
        s: T,
        delta: &[T],
        elements: &[(usize, usize)],
    ) -> [[T; N]; N] {
        let change = self.change.as_chunks::<N>().0;
        let mut matrix = [[T::ZERO; N]; N];
        for of_one_row in elements.chunk_by(|a, b| a.0 == b.0) {
            let row = of_one_row[0].0;
            let mut product = [T::ZERO; N];
            for &(_, column) in of_one_row {
                let factor = delta[row * change.len() + column];
                for n in 0..N {
                    product[n] = product[n] + factor * change[column][n];
                }
            }
            for i in 0..N {
                for j in 0..=i {
                    matrix[i][j] = matrix[i][j] + product[j] * change[row][i];
                }
            }
        }
        let squared = s * s;
        for (mode, denominator) in self.denominators.iter().enumerate().take(N) {
            matrix[mode][mode] =
                matrix[mode][mode] + T::constant(denominator.stiffness) + s * denominator.viscous + squared;
        }
        matrix
    }
}

/// L D Lᵀ of a symmetric matrix given by its lower triangle, in place of it: L below the diagonal and D⁻¹ on it; `false`, the matrix spoilt, where on
/// any line a pivot is weak.
#[inline(always)]
fn factorize_symmetric<const N: usize, T: Lines>(matrix: &mut [[T; N]; N]) -> bool {
    let mut largest = matrix[0][0].sizes();
    for i in 1..N {
        for j in 0..=i {
            largest = T::larger(largest, matrix[i][j].sizes());
        }
    }
    for k in 0..N {
        let pivot = matrix[k][k].sizes();
        let mut below = pivot;
        for i in k + 1..N {
            below = T::larger(below, matrix[i][k].sizes());
        }
        if !T::all_exceed(pivot, WEAK, below) || !T::all_exceed(pivot, ZERO * ZERO, largest) {
            return false;
        }
        let inverse = matrix[k][k].reciprocal();
        let mut scaled = [T::ZERO; N];
        for i in k + 1..N {
            scaled[i] = matrix[i][k] * inverse;
            for j in k + 1..=i {
                matrix[i][j] = matrix[i][j] - scaled[i] * matrix[j][k];
            }
        }
        matrix[k][k] = inverse;
        for i in k + 1..N {
            matrix[i][k] = scaled[i];
        }
    }
    true
}

#[inline(always)]
fn substitute<const N: usize, T: Lines>(factors: &[[T; N]; N], values: &mut [T; N]) {
    for i in 1..N {
        for j in 0..i {
            values[i] = values[i] - factors[i][j] * values[j];
        }
    }
    for i in 0..N {
        values[i] = values[i] * factors[i][i];
    }
    for i in (0..N).rev() {
        for j in i + 1..N {
            values[i] = values[i] - factors[j][i] * values[j];
        }
    }
}

/// One line by itself, rows exchanged for the sake of its pivots.
#[inline(never)]
fn solve_line<const N: usize, T: Lines>(
    lower: &[[T; N]; N],
    line: usize,
    inputs: &[[f64; N]],
    columns: &mut [[T; N]],
) -> bool {
    let mut matrix = [[Complex64::ZERO; N]; N];
    for i in 0..N {
        for j in 0..=i {
            matrix[i][j] = lower[i][j].line(line);
            matrix[j][i] = matrix[i][j];
        }
    }
    let Some((matrix, pivots)) = factorized(matrix) else { return false };
    for (input, column) in inputs.iter().zip(columns) {
        let mut values = input.map(|shape| Complex64::new(shape, 0.0));
        substitute_exchanged(&matrix, &pivots, &mut values);
        column.iter_mut().zip(values).for_each(|(to, value)| to.set_line(line, value));
    }
    true
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

fn substitute_exchanged<const N: usize>(
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
