//! Weighted products of columns: the normal equations of a fit, with the widest instructions the processor
//! has.

use num_complex::Complex64;

/// Values that are whitened at a time: those of all columns stay near the processor.
const BLOCK: usize = 64;

/// √w·value, real and imaginary parts side by side.
pub fn whitened(values: &[Complex64], weights: &[f64]) -> Vec<f64> {
    let mut parts = vec![0.0; 2 * values.len()];
    whiten(values, weights, &mut parts);
    parts
}

/// Σ aᵢ bᵢ.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    pulp::Arch::new().dispatch(Dot { a, b })
}

/// Re Σ w·conj(aᵢ)·aⱼ of every pair of columns, row-major, whole.
pub fn weighted_products(columns: &[&[Complex64]], weights: &[f64]) -> Vec<f64> {
    pulp::Arch::new().dispatch(Products { columns, weights })
}

#[inline(always)]
fn whiten(values: &[Complex64], weights: &[f64], parts: &mut [f64]) {
    for ((value, weight), part) in values.iter().zip(weights).zip(parts.as_chunks_mut::<2>().0) {
        let root = weight.sqrt();
        *part = [value.re * root, value.im * root];
    }
}

/// Eight sums at once: a single one would wait for each addition.
#[inline(always)]
fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let ((left, left_rest), (right, right_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    for (x, y) in left.iter().zip(right) {
        for lane in 0..8 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = left_rest.iter().zip(right_rest).map(|(x, y)| x * y).sum();
    rest + sums.iter().sum::<f64>()
}

struct Dot<'a> {
    a: &'a [f64],
    b: &'a [f64],
}

impl pulp::WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        sum_of_products(self.a, self.b)
    }
}

struct Products<'a> {
    columns: &'a [&'a [Complex64]],
    weights: &'a [f64],
}

/// Columns of a tile, and rows: each value that is fetched serves in several products.
const ACROSS: usize = 4;
const DOWN: usize = 2;

impl pulp::WithSimd for Products<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Vec<f64> {
        let n = self.columns.len();
        // Columns of zeros fill the last tile.
        let padded = n.next_multiple_of(ACROSS);
        let mut all = vec![0.0; padded * padded];
        let mut parts = vec![0.0; 2 * BLOCK * padded];
        let mut roots = [[0.0; 2]; BLOCK];
        for (block, weights) in self.weights.chunks(BLOCK).enumerate() {
            let first = block * BLOCK;
            // One root a line for all columns, as often as a value has parts.
            roots.iter_mut().zip(weights).for_each(|(root, weight)| *root = [weight.sqrt(); 2]);
            for (column, parts) in self.columns.iter().zip(parts.chunks_exact_mut(2 * BLOCK)) {
                let (used, rest) = parts.split_at_mut(2 * weights.len());
                let values = &column[first..first + weights.len()];
                for ((part, value), root) in used.as_chunks_mut::<2>().0.iter_mut().zip(values).zip(&roots) {
                    *part = [value.re * root[0], value.im * root[1]];
                }
                rest.fill(0.0);
            }
            for row in (0..padded).step_by(DOWN) {
                for column in (0..row + DOWN).step_by(ACROSS) {
                    tile(simd, &parts, row, column, |r, c, sum| all[r * padded + c] += sum);
                }
            }
        }
        let entry = |i: usize| all[(i / n).max(i % n) * padded + (i / n).min(i % n)];
        (0..n * n).map(entry).collect()
    }
}

/// Hands the products of [`DOWN`] columns from `row` on with [`ACROSS`] from `column` on to `add`.
#[inline(always)]
fn tile<S: pulp::Simd>(
    simd: S,
    parts: &[f64],
    row: usize,
    column: usize,
    mut add: impl FnMut(usize, usize, f64),
) {
    let part = |index: usize| S::as_simd_f64s(&parts[index * 2 * BLOCK..][..2 * BLOCK]).0;
    let left: [&[S::f64s]; DOWN] = std::array::from_fn(|r| part(row + r));
    let right: [&[S::f64s]; ACROSS] = std::array::from_fn(|c| part(column + c));
    let mut sums = [[simd.splat_f64s(0.0); ACROSS]; DOWN];
    for at in 0..left[0].len() {
        for (sums, left) in sums.iter_mut().zip(left) {
            for (sum, right) in sums.iter_mut().zip(right) {
                *sum = simd.mul_add_e_f64s(left[at], right[at], *sum);
            }
        }
    }
    for (r, sums) in sums.into_iter().enumerate() {
        for (c, sum) in sums.into_iter().enumerate() {
            add(row + r, column + c, simd.reduce_sum_f64s(sum));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_products_of_columns_are_the_sums_that_they_stand_for(
            values in prop::collection::vec((-1.0..1.0, -1.0..1.0, 0.0..9.0), 3 * 130), length in 1usize..130
        ) {
            let values: Vec<(f64, f64, f64)> = values;
            let complex: Vec<Complex64> = values.iter().map(|v| Complex64::new(v.0, v.1)).collect();
            let weights: Vec<f64> = values.iter().map(|v| v.2).take(length).collect();
            let columns: Vec<&[Complex64]> = (0..3).map(|c| &complex[c * 130..][..length]).collect();
            let found = weighted_products(&columns, &weights);
            for m in 0..3 {
                for k in 0..3 {
                    let terms = columns[m].iter().zip(columns[k]).zip(&weights);
                    let expected: f64 = terms.map(|((a, b), w)| w * (a.conj() * b).re).sum();
                    prop_assert!((found[m * 3 + k] - expected).abs() < 1e-10, "({}, {})", m, k);
                    let [a, b] = [columns[m], columns[k]].map(|column| whitened(column, &weights));
                    prop_assert!((dot(&a, &b) - expected).abs() < 1e-10);
                }
            }
        }
    }
}
