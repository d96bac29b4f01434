//! The product A·Bᵀ by the kernels of faer.

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
