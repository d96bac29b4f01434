use jointscope_linalg::products;
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
