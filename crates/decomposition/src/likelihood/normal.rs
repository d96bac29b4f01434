use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;

/// JᵀWJ (lower triangle) and JᵀWr of the six parameters.
#[derive(Default)]
pub(super) struct NormalEquations {
    matrix: [[f64; 6]; 6],
    right: [f64; 6],
}

impl NormalEquations {
    pub fn add(&mut self, active: &[usize], weight: f64, residual: Complex64, derivative: &[Complex64; 6]) {
        for &m in active {
            let weighted = derivative[m].conj() * weight;
            self.right[m] += (weighted * residual).re;
            for &n in active.iter().take_while(|n| **n <= m) {
                self.matrix[m][n] += (weighted * derivative[n]).re;
            }
        }
    }

    /// The solution with the diagonal raised by the share `damping`; `None` where that is not positive definite.
    pub fn step(&self, damping: f64, active: &[usize]) -> Option<[f64; 6]> {
        let n = active.len();
        let mut matrix = [0.0; 36];
        let mut right = [0.0; 6];
        for (i, &p) in active.iter().enumerate() {
            for (j, &q) in active.iter().enumerate().take(i + 1) {
                matrix[i * n + j] = self.matrix[p][q];
            }
            matrix[i * n + i] *= 1.0 + damping;
            right[i] = self.right[p];
        }
        if !solve_positive_definite(&mut matrix[..n * n], &mut right[..n]) {
            return None;
        }
        let mut step = [0.0; 6];
        active.iter().zip(right).for_each(|(&m, value)| step[m] = value);
        Some(step)
    }
}
