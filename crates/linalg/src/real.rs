//! Real dense matrices of a few rows: inverse and exponential.

/// Inverse of the row-major `order` × `order` matrix by Gauss–Jordan elimination with partial pivoting, rows scaled before pivots are compared;
/// `None` where it is singular to working precision or not finite.
pub fn inverse(matrix: &[f64], order: usize) -> Option<Vec<f64>> {
    let n = order;
    let mut left = matrix.to_vec();
    let mut right = identity(n);
    for i in 0..n {
        let scale = left[i * n..(i + 1) * n].iter().fold(0.0, |largest: f64, e| e.abs().max(largest));
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        for j in 0..n {
            left[i * n + j] /= scale;
            right[i * n + j] /= scale;
        }
    }
    for column in 0..n {
        let size = |row: usize| left[row * n + column].abs();
        let pivot = (column..n).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        if size(pivot).is_nan() || size(pivot) <= 1e-15 {
            return None;
        }
        for j in 0..n {
            left.swap(column * n + j, pivot * n + j);
            right.swap(column * n + j, pivot * n + j);
        }
        let factor = left[column * n + column].recip();
        for j in 0..n {
            left[column * n + j] *= factor;
            right[column * n + j] *= factor;
        }
        for row in (0..n).filter(|row| *row != column) {
            let factor = left[row * n + column];
            for j in 0..n {
                left[row * n + j] -= factor * left[column * n + j];
                right[row * n + j] -= factor * right[column * n + j];
            }
        }
    }
    right.iter().all(|e| e.is_finite()).then_some(right)
}

/// Terms of the Taylor series: of a matrix of norm 1/2 the next is below 1e-19.
const TERMS: usize = 14;

/// e^A of the row-major `order` × `order` matrix by scaling and squaring.
///
/// Coordinates of very different size are balanced by powers of two first, so that states in metres and in metres per second can share A.
/// `None` where A is not finite or its exponential is not.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_matrix_times_its_inverse_is_one_whatever_the_units(v in prop::collection::vec(-1.0f64..1.0, 16), decades in prop::array::uniform4(-6i32..6)) {
            let entry = |i: usize, j: usize| (v[4 * i + j] + if i == j { 3.0 } else { 0.0 }) * 10f64.powi(decades[i]);
            let matrix: Vec<f64> = (0..16).map(|e| entry(e / 4, e % 4)).collect();
            let one = product(&matrix, &inverse(&matrix, 4).unwrap(), 4);
            for e in 0..16 {
                let expected = f64::from(e / 4 == e % 4);
                let size = 10f64.powi(decades[e / 4] - decades[e % 4]);
                prop_assert!((one[e] - expected).abs() < 1e-12 * size.max(1.0), "{}: {}", e, one[e]);
            }
        }

        #[test]
        fn the_exponential_of_an_oscillator_turns_its_state(omega in 1.0f64..1e5, time in 0.0f64..1e-2) {
            // ẋ = v, v̇ = −ω²x.
            let e = matrix_exponential(&[0.0, time, -omega * omega * time, 0.0], 2).unwrap();
            let (sin, cos) = (omega * time).sin_cos();
            let tolerance = 1e-13 * (1.0 + omega * time);
            prop_assert!((e[0] - cos).abs() < tolerance && (e[3] - cos).abs() < tolerance);
            prop_assert!((e[1] * omega - sin).abs() < tolerance && (e[2] / omega + sin).abs() < tolerance);
        }
    }

    #[test]
    fn the_exponential_of_a_double_integrator_is_exact() {
        assert_eq!(matrix_exponential(&[0.0, 3.0, 0.0, 0.0], 2), Some(vec![1.0, 3.0, 0.0, 1.0]));
    }

    #[test]
    fn what_has_no_inverse_or_is_not_finite_is_refused() {
        assert_eq!(inverse(&[1.0, 2.0, 2.0, 4.0], 2), None);
        assert_eq!(inverse(&[f64::NAN], 1), None);
        assert_eq!(matrix_exponential(&[f64::INFINITY], 1), None);
        assert_eq!(matrix_exponential(&[1e9], 1), None);
    }
}
