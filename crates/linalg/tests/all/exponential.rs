use jointscope_linalg::matrix_exponential;
use proptest::prelude::*;

proptest! {
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
fn an_exponential_that_is_not_finite_is_refused() {
    assert_eq!(matrix_exponential(&[f64::INFINITY], 1), None);
    assert_eq!(matrix_exponential(&[1e9], 1), None);
}
