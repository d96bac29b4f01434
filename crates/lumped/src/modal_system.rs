//! Receptances of few modes with changes of high rank: one solution in the modes' own coordinates.

use crate::denominator::Denominator;
use crate::lanes::Lines;
use jointscope_linalg::LuWorkspace;
use num_complex::Complex64;

/// Modes up to which there is a solution of fixed size, which the compiler unrolls.
pub(crate) const FEW_MODES: usize = 12;
/// A pivot smaller than this share of the largest element is a zero.
const ZERO: f64 = 1e-15;
/// A pivot smaller than this share of the largest element below it, both squared, asks for rows to be
/// exchanged: what is eliminated by it grows as many times. Against the largest of all it may well be small:
/// where a change is stiff, all that is left once it has been eliminated is.
const WEAK: f64 = 1e-6;

/// (D(s) + V Δ(s) Vᵀ) q = Φ_i with D diagonal. The modes are mass-normalised, so that all elements have one
/// unit and none needs scaling.
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

    /// Writes the receptance of each (output, input) at `s`, given Δ(s) with its elements that are not zero;
    /// `false` where a line has no solution. `solution` is memory for the modes' coordinates, a row for each
    /// input.
    #[inline(always)]
    pub(crate) fn at<T: Lines>(
        &self,
        s: T,
        change: (&[T], &[(usize, usize)]),
        (solution, lu): (&mut Vec<T>, &mut LuWorkspace),
        pairs: &[(usize, usize)],
        values: &mut [T],
    ) -> bool {
        let order = self.denominators.len();
        solution.resize(self.inputs.len(), T::ZERO);
        let memory = (&mut solution[..], lu);
        let solved = match order {
            1 => self.solve::<1, T>(s, change, memory),
            2 => self.solve::<2, T>(s, change, memory),
            3 => self.solve::<3, T>(s, change, memory),
            4 => self.solve::<4, T>(s, change, memory),
            5 => self.solve::<5, T>(s, change, memory),
            6 => self.solve::<6, T>(s, change, memory),
            7 => self.solve::<7, T>(s, change, memory),
            8 => self.solve::<8, T>(s, change, memory),
            9 => self.solve::<9, T>(s, change, memory),
            10 => self.solve::<10, T>(s, change, memory),
            11 => self.solve::<11, T>(s, change, memory),
            FEW_MODES => self.solve::<FEW_MODES, T>(s, change, memory),
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
        change: (&[T], &[(usize, usize)]),
        (solution, lu): (&mut [T], &mut LuWorkspace),
    ) -> bool {
        let mut matrix = self.matrix::<N, T>(s, change);
        if factorize_symmetric(&mut matrix) {
            let inputs = self.inputs.as_chunks::<N>().0;
            for (input, column) in inputs.iter().zip(solution.as_chunks_mut::<N>().0) {
                *column = input.map(|shape| T::constant(Complex64::new(shape, 0.0)));
                substitute(&matrix, column);
            }
            return true;
        }
        let matrix = self.matrix::<N, T>(s, change);
        self.solve_line_by_line(matrix.as_flattened(), solution, lu)
    }

    /// Each line by itself, rows exchanged for the sake of its pivots, from the lower triangle of its matrix.
    #[inline(never)]
    fn solve_line_by_line<T: Lines>(&self, lower: &[T], solution: &mut [T], lu: &mut LuWorkspace) -> bool {
        let order = self.denominators.len();
        let mut values = vec![Complex64::ZERO; order];
        (0..T::COUNT).all(|line| {
            let factorized = lu.factorize(order, |matrix| {
                for i in 0..order {
                    for j in 0..=i {
                        let element = lower[i * order + j].line(line);
                        (matrix[i * order + j], matrix[j * order + i]) = (element, element);
                    }
                }
            });
            if factorized.is_err() {
                return false;
            }
            for (input, column) in self.inputs.chunks_exact(order).zip(solution.chunks_exact_mut(order)) {
                values.iter_mut().zip(input).for_each(|(to, shape)| *to = Complex64::new(*shape, 0.0));
                lu.solve_in_place(&mut values);
                column.iter_mut().zip(&values).for_each(|(to, value)| to.set_line(line, *value));
            }
            true
        })
    }

    /// The lower triangle of D + V Δ Vᵀ, which is symmetric.
    #[inline(always)]
    fn matrix<const N: usize, T: Lines>(
        &self,
        s: T,
        (delta, elements): (&[T], &[(usize, usize)]),
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

/// L D Lᵀ of a symmetric matrix given by its lower triangle, in place of it: L below the diagonal and D⁻¹ on
/// it; `false`, the matrix spoilt, where on any line a pivot is weak.
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
