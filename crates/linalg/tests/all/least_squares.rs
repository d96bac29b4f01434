use jointscope_linalg::{LeastSquares, LeastSquaresError};
use num_complex::Complex64;
use proptest::prelude::*;

proptest! {
    #[test]
    fn the_residual_is_orthogonal_to_every_column_and_the_covariance_is_the_inverse_of_the_weighted_gram_matrix(
        a in prop::collection::vec(-1.0f64..1.0, 21), y in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 7),
        w in prop::collection::vec(0.1f64..10.0, 7), unit in 1e-4f64..1e4
    ) {
        let (m, n) = (7, 3);
        let row = |i: usize| [a[3 * i], a[3 * i + 1] * unit, a[3 * i + 2]];
        let mut problem = LeastSquares::new();
        problem.begin(n);
        for i in 0..m {
            problem.equation(&row(i), Complex64::new(y[i].0, y[i].1), w[i]);
        }
        let mut x = [Complex64::ZERO; 3];
        let sum = problem.solve(&mut x);
        prop_assume!(sum.is_ok());
        prop_assume!(problem.covariance(0, 0) < 1e4);
        let residual: Vec<Complex64> = (0..m)
            .map(|i| Complex64::new(y[i].0, y[i].1) - (0..n).map(|j| x[j] * row(i)[j]).sum::<Complex64>())
            .collect();
        for j in 0..n {
            let dot: Complex64 = (0..m).map(|i| residual[i] * row(i)[j] * w[i]).sum();
            prop_assert!(dot.norm() < 1e-9 * unit.max(1.0), "column {j}: {dot}");
        }
        let expected: f64 = (0..m).map(|i| w[i] * residual[i].norm_sqr()).sum();
        prop_assert!((sum.unwrap() - expected).abs() < 1e-9 * (1.0 + expected));
        for i in 0..n {
            for j in 0..n {
                let gram = |p: usize, q: usize| (0..m).map(|r| w[r] * row(r)[p] * row(r)[q]).sum::<f64>();
                let product: f64 = (0..n).map(|k| problem.covariance(i, k) * gram(k, j)).sum();
                let scale = (gram(j, j) / gram(i, i)).sqrt();
                prop_assert!((product - f64::from(i == j)).abs() < 1e-8 * scale.max(1.0), "({i},{j}): {product}");
            }
        }
    }
}

#[test]
fn two_sensors_at_one_place_leave_the_rotation_free() {
    let mut problem = LeastSquares::new();
    problem.begin(2);
    for _ in 0..3 {
        problem.equation(&[1.0, 0.04], Complex64::new(1.0, 0.0), 1.0);
    }
    let answer = problem.solve(&mut [Complex64::ZERO; 2]);
    assert_eq!(answer, Err(LeastSquaresError::RankDeficient { rank: 1, unknowns: 2 }));
}

#[test]
fn an_equation_of_weight_zero_does_not_count() {
    let mut problem = LeastSquares::new();
    problem.begin(2);
    problem.equation(&[1.0, 0.0], Complex64::ONE, 1.0);
    problem.equation(&[0.0, 1.0], Complex64::ONE, 0.0);
    let answer = problem.solve(&mut [Complex64::ZERO; 2]);
    assert_eq!(answer, Err(LeastSquaresError::TooFewEquations { equations: 1, unknowns: 2 }));
}
