//! The matrix exponential, by which linear motion is carried over a time step exactly.

/// Terms of the Taylor series: of a matrix of norm 1/2 the next is below 1e-19.
const TERMS: usize = 14;

/// e^A of the row-major `order` × `order` matrix by scaling and squaring.
///
/// Coordinates of very different size are balanced by powers of two first, so that states in metres and in
/// metres per second can share A. `None` where A is not finite or its exponential is not.
pub fn matrix_exponential(matrix: &[f64], order: usize) -> Option<Vec<f64>> {
    let n = order;
    let balance = balancing(matrix, n);
    let mut scaled: Vec<f64> = (0..n * n).map(|e| matrix[e] * balance[e % n] / balance[e / n]).collect();
    let norm = scaled.chunks_exact(n.max(1)).map(|row| row.iter().map(|e| e.abs()).sum()).fold(0.0, f64::max);
    if !norm.is_finite() {
        return None;
    }
    let squarings = if norm > 0.5 { (2.0 * norm).log2().ceil() as i32 } else { 0 };
    scaled.iter_mut().for_each(|e| *e *= 0.5f64.powi(squarings));
    let mut sum = identity(n);
    for term in (1..=TERMS).rev() {
        sum = product(&scaled, &sum, n);
        sum.iter_mut().for_each(|e| *e /= term as f64);
        (0..n).for_each(|i| sum[i * n + i] += 1.0);
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum, n);
    }
    let all: Vec<f64> = (0..n * n).map(|e| sum[e] * balance[e / n] / balance[e % n]).collect();
    all.iter().all(|e| e.is_finite()).then_some(all)
}

/// Powers of two by which rows and columns of equal index get sums of like size.
fn balancing(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut balance = vec![1.0; n];
    for _ in 0..8 {
        for i in 0..n {
            let others = || (0..n).filter(|j| *j != i);
            let row: f64 = others().map(|j| (matrix[i * n + j] * balance[j] / balance[i]).abs()).sum();
            let column: f64 = others().map(|j| (matrix[j * n + i] * balance[i] / balance[j]).abs()).sum();
            if row > 0.0 && column > 0.0 && (row / column).is_finite() {
                balance[i] *= (0.5 * (row / column).log2()).round().clamp(-60.0, 60.0).exp2();
            }
        }
    }
    balance
}

fn identity(n: usize) -> Vec<f64> {
    (0..n * n).map(|e| f64::from(e / n.max(1) == e % n.max(1))).collect()
}

fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut all = vec![0.0; n * n];
    for i in 0..n {
        for k in 0..n {
            let factor = a[i * n + k];
            if factor != 0.0 {
                for j in 0..n {
                    all[i * n + j] += factor * b[k * n + j];
                }
            }
        }
    }
    all
}
