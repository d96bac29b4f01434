//! χ² and its derivatives by k and c, summed over lines.

use super::parameters::Parameters;
use jointscope_inference::NormalEquations;
use num_complex::Complex64;

/// Sums over values: χ², Re Σ w·conj(dₘ)·dₙ and Re Σ w·conj(dₘ)·r, d being derivatives by (k11, k12, k22,
/// c11, c12, c22).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub chi2: f64,
    information: [[f64; 6]; 6],
    right: [f64; 6],
}

/// Sums over the values of one line, where d/dc = s·d/dk.
#[derive(Default)]
pub(super) struct OfLine {
    products: [Complex64; 6],
    right: [Complex64; 3],
}

/// Pairs (m, n) of products: the upper triangle.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

impl OfLine {
    /// Adds a residual of the model aᵀ (k + sc) b, both matrices symmetric.
    pub(super) fn add(&mut self, weight: f64, residual: Complex64, a: [Complex64; 2], b: [Complex64; 2]) {
        let (by, weighted) = self.add_right(weight, residual, a, b);
        for (sum, (m, n)) in self.products.iter_mut().zip(PAIRS) {
            *sum += weighted[m] * by[n];
        }
    }

    /// Adds it to the gradient alone; answers with its derivatives by k11, k12, k22, and these conjugate and
    /// weighted.
    #[inline]
    pub(super) fn add_right(
        &mut self,
        weight: f64,
        residual: Complex64,
        a: [Complex64; 2],
        b: [Complex64; 2],
    ) -> ([Complex64; 3], [Complex64; 3]) {
        let by = [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1]];
        let weighted = by.map(|d| d.conj() * weight);
        self.right.iter_mut().zip(weighted).for_each(|(sum, d)| *sum += d * residual);
        (by, weighted)
    }
}

impl Sums {
    /// Adds a line at s.
    pub(super) fn add(&mut self, s: Complex64, line: &OfLine) {
        for (product, (m, n)) in line.products.into_iter().zip(PAIRS) {
            let own = [product.re, s.norm_sqr() * product.re];
            let across = [(s * product).re, (s * product.conj()).re];
            for (first, own) in [0, 3].into_iter().zip(own) {
                self.information[first + m][first + n] += own;
                if m != n {
                    self.information[first + n][first + m] += own;
                }
            }
            self.information[m][3 + n] += across[0];
            self.information[3 + n][m] += across[0];
            if m != n {
                self.information[n][3 + m] += across[1];
                self.information[3 + m][n] += across[1];
            }
        }
        self.add_right(s, line);
    }

    /// Adds a line's gradient alone.
    pub(super) fn add_right(&mut self, s: Complex64, line: &OfLine) {
        for (m, right) in line.right.into_iter().enumerate() {
            self.right[m] += right.re;
            self.right[3 + m] += (s.conj() * right).re;
        }
    }

    /// Minus half of the gradient by the free parameters.
    pub(super) fn right(&self, parameters: &Parameters) -> Vec<f64> {
        let along = |row: &[f64; 6]| row.iter().zip(self.right).map(|(d, r)| d * r).sum();
        parameters.derivatives().iter().map(along).collect()
    }

    /// Gauss and Newton's normal equations of the free parameters.
    pub(super) fn equations(&self, parameters: &Parameters) -> NormalEquations {
        let rows = parameters.derivatives();
        let mut equations = NormalEquations::zero(rows.len());
        equations.right = self.right(parameters);
        for (entry, (a, b)) in equations
            .information
            .iter_mut()
            .zip((0..rows.len()).flat_map(|a| (0..rows.len()).map(move |b| (a, b))))
        {
            for m in (0..6).filter(|&m| rows[a][m] != 0.0) {
                let along: f64 = (0..6).map(|n| self.information[m][n] * rows[b][n]).sum();
                *entry += rows[a][m] * along;
            }
        }
        equations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sums_by_lines_are_the_normal_equations_of_their_values(values in prop::collection::vec(-1.0f64..1.0, 24), v in prop::array::uniform2(-1.0f64..1.0)) {
            let z = |k: usize| Complex64::new(values[2 * k], values[2 * k + 1]);
            let k = [2.0, 0.3, 1.0];
            for boundary in [None, Some(v)] {
                let parameters = Parameters { k, c: [0.1, 0.0, 0.2], boundary, scalar: false };
                let rows = parameters.derivatives();
                let (mut sums, mut plain) = (Sums::default(), NormalEquations::zero(rows.len()));
                for line in 0..2 {
                    let s = z(6 * line);
                    let mut own = OfLine::default();
                    let (a, b) = ([z(6 * line + 1), z(6 * line + 2)], [z(6 * line + 3), z(6 * line + 4)]);
                    let residual = z(6 * line + 5);
                    own.add(1.5, residual, a, b);
                    sums.add(s, &own);
                    let by_k = [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1]];
                    let by: Vec<Complex64> = by_k.into_iter().chain(by_k.map(|d| s * d)).collect();
                    let free: Vec<Complex64> =
                        rows.iter().map(|row| row.iter().zip(&by).map(|(d, by)| by * d).sum()).collect();
                    for part in [|z: &Complex64| z.re, |z: &Complex64| z.im] {
                        plain.add(1.5, part(&residual), &free.iter().map(part).collect::<Vec<_>>());
                    }
                }
                let found = sums.equations(&parameters);
                for (a, b) in found.information.iter().zip(&plain.information).chain(found.right.iter().zip(&plain.right)) {
                    prop_assert!((a - b).abs() < 1e-12, "{found:?} against {plain:?}");
                }
            }
        }
    }
}
