//! Linear least-squares problems of one spectral line, by Householder reflections.

use num_complex::Complex64;

/// Why a least-squares problem has no single answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LeastSquaresError {
    /// Fewer equations than unknowns.
    #[error("{equations} equations cannot determine {unknowns} unknowns")]
    TooFewEquations {
        /// Equations with a positive weight.
        equations: usize,
        /// Unknowns asked for.
        unknowns: usize,
    },
    /// The equations leave a combination of the unknowns free.
    #[error("the equations leave a combination of the unknowns free (rank {rank} of {unknowns})")]
    RankDeficient {
        /// Numerical rank.
        rank: usize,
        /// Unknowns asked for.
        unknowns: usize,
    },
    /// A coefficient, weight or observation is not finite.
    #[error("an equation holds a value that is not a finite number")]
    NotFinite,
}

/// Weighted linear least squares with a real design matrix and complex observations, by
/// Householder reflections; keeps its memory from one spectral line to the next.
///
/// Minimises `Σ w_i |y_i − Σ_j a_ij x_j|²`. Columns are scaled to size one first, so that
/// displacements and rotations can share the unknowns.
#[derive(Debug, Clone, Default)]
pub struct LeastSquares {
    equations: usize,
    unknowns: usize,
    design: Vec<f64>,
    observed: Vec<Complex64>,
    column_scale: Vec<f64>,
    inverse_triangle: Vec<f64>,
    reflector: Vec<f64>,
}

/// Below this ratio of diagonal elements of the triangle, a combination counts as undetermined.
const RANK_TOLERANCE: f64 = 1e-10;

impl LeastSquares {
    /// A workspace for problems of any size.
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts a problem with `unknowns` unknowns.
    pub fn begin(&mut self, unknowns: usize) {
        self.unknowns = unknowns;
        self.equations = 0;
        self.design.clear();
        self.observed.clear();
    }

    /// Adds the equation `Σ_j coefficients_j x_j = observation` with weight `weight` (one over the
    /// variance); a weight of zero leaves it out.
    pub fn equation(&mut self, coefficients: &[f64], observation: Complex64, weight: f64) {
        if weight == 0.0 {
            return;
        }
        let root = weight.sqrt();
        self.design.extend(coefficients.iter().map(|c| c * root));
        self.observed.push(observation * root);
        self.equations += 1;
    }

    /// Solves into `x` (length: unknowns) and returns the weighted sum of squared residuals
    /// `Σ w |y − a x|²`, which is zero where there are as many equations as unknowns.
    ///
    /// # Errors
    /// See [`LeastSquaresError`]; `x` is then untouched.
    pub fn solve(&mut self, x: &mut [Complex64]) -> Result<f64, LeastSquaresError> {
        let (m, n) = (self.equations, self.unknowns);
        if m < n {
            return Err(LeastSquaresError::TooFewEquations { equations: m, unknowns: n });
        }
        self.scale_columns()?;
        for column in 0..n {
            self.reflect(column);
        }
        self.check_rank()?;
        self.invert_triangle();
        for i in 0..n {
            let mut sum = Complex64::ZERO;
            for j in i..n {
                sum += self.observed[j] * self.inverse_triangle[i * n + j];
            }
            x[i] = sum * self.column_scale[i];
        }
        Ok(self.observed[n..m].iter().map(|r| r.norm_sqr()).sum())
    }

    /// Element (i, j) of `(Aᵀ W A)⁻¹` of the problem solved last: with weights of one over the
    /// variance, the covariance of the unknowns.
    pub fn covariance(&self, i: usize, j: usize) -> f64 {
        let n = self.unknowns;
        let row = |r: usize| &self.inverse_triangle[r * n..(r + 1) * n];
        let product: f64 = row(i).iter().zip(row(j)).map(|(a, b)| a * b).sum();
        product * self.column_scale[i] * self.column_scale[j]
    }

    fn scale_columns(&mut self) -> Result<(), LeastSquaresError> {
        let n = self.unknowns;
        self.column_scale.clear();
        for j in 0..n {
            let norm = self.design.iter().skip(j).step_by(n).map(|a| a * a).sum::<f64>().sqrt();
            if !norm.is_finite() {
                return Err(LeastSquaresError::NotFinite);
            }
            let scale = if norm > 0.0 { 1.0 / norm } else { 1.0 };
            self.design.iter_mut().skip(j).step_by(n).for_each(|a| *a *= scale);
            self.column_scale.push(scale);
        }
        if !self.observed.iter().all(|y| y.is_finite()) {
            return Err(LeastSquaresError::NotFinite);
        }
        Ok(())
    }

    fn reflect(&mut self, column: usize) {
        let (m, n) = (self.equations, self.unknowns);
        self.reflector.clear();
        self.reflector.extend((column..m).map(|i| self.design[i * n + column]));
        let norm = self.reflector.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm == 0.0 {
            return;
        }
        self.reflector[0] += if self.reflector[0] < 0.0 { -norm } else { norm };
        let factor = 2.0 / self.reflector.iter().map(|v| v * v).sum::<f64>();
        for j in column..n {
            let dot: f64 = (column..m).map(|i| self.reflector[i - column] * self.design[i * n + j]).sum();
            for i in column..m {
                self.design[i * n + j] -= factor * dot * self.reflector[i - column];
            }
        }
        let dot: Complex64 = (column..m).map(|i| self.observed[i] * self.reflector[i - column]).sum();
        for i in column..m {
            self.observed[i] -= dot * (factor * self.reflector[i - column]);
        }
    }

    fn check_rank(&self) -> Result<(), LeastSquaresError> {
        let n = self.unknowns;
        let diagonal = |i: usize| self.design[i * n + i].abs();
        let largest = (0..n).map(diagonal).fold(0.0, f64::max);
        let rank = (0..n).filter(|&i| diagonal(i) > RANK_TOLERANCE * largest).count();
        if rank < n {
            return Err(LeastSquaresError::RankDeficient { rank, unknowns: n });
        }
        Ok(())
    }

    fn invert_triangle(&mut self) {
        let n = self.unknowns;
        self.inverse_triangle.clear();
        self.inverse_triangle.resize(n * n, 0.0);
        for j in 0..n {
            self.inverse_triangle[j * n + j] = 1.0 / self.design[j * n + j];
            for i in (0..j).rev() {
                let sum: f64 =
                    (i + 1..=j).map(|k| self.design[i * n + k] * self.inverse_triangle[k * n + j]).sum();
                self.inverse_triangle[i * n + j] = -sum / self.design[i * n + i];
            }
        }
    }
}
