use faer::MatRef;

/// All products Σ_k a_ik b_jk of the rows of two square matrices, row-major: A·Bᵀ.
///
/// # Panics
/// Where a matrix is not of the stated order.
pub fn products(order: usize, a: &[f64], b: &[f64]) -> Vec<f64> {
    let rows = |m| MatRef::from_row_major_slice(m, order, order);
    let product = rows(b) * rows(a).transpose();
    // Column j of B·Aᵀ is row j of its transpose.
    (0..order).flat_map(|j| product.col_as_slice(j).iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn products_are_the_sums_over_rows(
            n in 1usize..20,
            values in prop::collection::vec(-1.0f64..1.0, 2 * 20 * 20),
        ) {
            let (a, b) = (&values[..n * n], &values[n * n..2 * n * n]);
            let all = products(n, a, b);
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let sum: f64 = (0..n).map(|k| a[i * n + k] * b[j * n + k]).sum();
                prop_assert!((all[i * n + j] - sum).abs() < 1e-13 * n as f64);
            }
        }
    }
}
