//! Receptances of few modes with changes of high rank: one solution in the modes' own coordinates.

use crate::model::Denominator;
use crate::terms::Terms;
use num_complex::Complex64;

/// A pivot smaller than this share of the largest element is a zero.
const ZERO: f64 = 1e-15;

/// (D(s) + V Δ(s) Vᵀ) q = Φ_i with D diagonal. The modes are mass-normalised, so that all elements have one unit and none needs scaling.
#[derive(Debug, Clone)]
pub(crate) struct ModalSystem {
    order: usize,
    denominators: Vec<Denominator>,
    /// Participations, a row over the modes for each output, input and station of the change.
    outputs: Vec<f64>,
    inputs: Vec<f64>,
    change: Vec<f64>,
    delta: Vec<Complex64>,
    product: Vec<Complex64>,
    matrix: Vec<Complex64>,
    /// One row over the inputs for each mode.
    solution: Vec<Complex64>,
    columns: usize,
}

impl ModalSystem {
    pub fn new(
        denominators: Vec<Denominator>,
        outputs: &[Vec<f64>],
        inputs: &[Vec<f64>],
        change: &[Vec<f64>],
    ) -> Self {
        let (order, rank, columns) = (denominators.len(), change.len(), inputs.len());
        ModalSystem {
            order,
            denominators,
            outputs: outputs.concat(),
            inputs: inputs.concat(),
            change: change.concat(),
            delta: vec![Complex64::ZERO; rank * rank],
            product: vec![Complex64::ZERO; rank * order],
            matrix: vec![Complex64::ZERO; order * order],
            solution: vec![Complex64::ZERO; order * columns],
            columns,
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
        self.fill(s, terms);
        for (mode, row) in self.solution.chunks_exact_mut(self.columns).enumerate() {
            for (column, value) in row.iter_mut().enumerate() {
                *value = Complex64::new(self.inputs[column * self.order + mode], 0.0);
            }
        }
        if !self.eliminate() {
            return false;
        }
        for (value, &(output, input)) in values.iter_mut().zip(pairs) {
            let shapes = &self.outputs[output * self.order..(output + 1) * self.order];
            let modes = self.solution.iter().skip(input).step_by(self.columns);
            *value = shapes.iter().zip(modes).map(|(shape, q)| q * *shape).sum();
        }
        true
    }

    fn fill(&mut self, s: Complex64, terms: &Terms) {
        let rank = terms.stations.len();
        terms.write(s, &mut self.delta);
        self.product.fill(Complex64::ZERO);
        for (row, delta) in self.product.chunks_exact_mut(self.order).zip(self.delta.chunks_exact(rank)) {
            let acting = delta.iter().zip(self.change.chunks_exact(self.order));
            for (factor, shapes) in acting.filter(|(factor, _)| **factor != Complex64::ZERO) {
                row.iter_mut().zip(shapes).for_each(|(to, shape)| *to += factor * *shape);
            }
        }
        self.matrix.fill(Complex64::ZERO);
        for (shapes, product) in
            self.change.chunks_exact(self.order).zip(self.product.chunks_exact(self.order))
        {
            for (row, shape) in self.matrix.chunks_exact_mut(self.order).zip(shapes) {
                row.iter_mut().zip(product).for_each(|(to, value)| *to += value * *shape);
            }
        }
        let squared = s * s;
        for (mode, denominator) in self.denominators.iter().enumerate() {
            self.matrix[mode * self.order + mode] +=
                denominator.stiffness + s * denominator.viscous + squared;
        }
    }

    /// Gaussian elimination with partial pivoting of the matrix and its right-hand sides.
    fn eliminate(&mut self) -> bool {
        let (n, m) = (self.order, self.columns);
        let largest = self.matrix.iter().map(|e| e.norm_sqr()).fold(0.0, f64::max);
        if !largest.is_finite() {
            return false;
        }
        for column in 0..n {
            let size = |row: usize| self.matrix[row * n + column].norm_sqr();
            let pivot = (column..n).fold(column, |best, row| if size(row) > size(best) { row } else { best });
            if size(pivot) <= ZERO * ZERO * largest {
                return false;
            }
            if pivot != column {
                (0..n).for_each(|j| self.matrix.swap(column * n + j, pivot * n + j));
                (0..m).for_each(|j| self.solution.swap(column * m + j, pivot * m + j));
            }
            let inverse = self.matrix[column * n + column].inv();
            let (upper, lower) = self.matrix.split_at_mut((column + 1) * n);
            let (known, unknown) = self.solution.split_at_mut((column + 1) * m);
            let pivot_row = &upper[column * n + column + 1..];
            known[column * m..].iter_mut().for_each(|value| *value *= inverse);
            for (row, right) in lower.chunks_exact_mut(n).zip(unknown.chunks_exact_mut(m)) {
                let factor = row[column];
                right.iter_mut().zip(&known[column * m..]).for_each(|(to, from)| *to -= factor * from);
                let factor = factor * inverse;
                row[column + 1..].iter_mut().zip(pivot_row).for_each(|(to, from)| *to -= factor * from);
            }
            // The row above keeps the inverse of its pivot for the way back.
            upper[column * n + column] = inverse;
        }
        for row in (0..n).rev() {
            let (known, below) = self.solution.split_at_mut((row + 1) * m);
            let inverse = self.matrix[row * n + row];
            for (k, right) in below.chunks_exact(m).enumerate() {
                let factor = self.matrix[row * n + row + 1 + k] * inverse;
                known[row * m..].iter_mut().zip(right).for_each(|(to, from)| *to -= factor * from);
            }
        }
        true
    }
}
