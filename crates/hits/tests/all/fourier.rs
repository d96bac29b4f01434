//! Fourier transforms of sampled signals.

use jointscope_hits::{Fourier, InverseFourier};
use num_complex::Complex64;

#[test]
fn a_signal_of_any_length_comes_back_from_its_lines() {
    for length in [1, 2, 7, 30, 31] {
        let signal: Vec<f64> = (0..length).map(|i| (i as f64 * 0.7).sin() + 0.2).collect();
        let mut lines = Fourier::new(length).lines(&mut signal.clone());
        let inverse = InverseFourier::new(length);
        assert_eq!(lines.len(), inverse.count());
        let back = inverse.signal(&mut lines);
        for (a, b) in signal.iter().zip(&back) {
            assert!((a - b / length as f64).abs() < 1e-14, "{length} samples: {a} and {b}");
        }
    }
}

#[test]
fn a_signal_of_another_length_has_no_lines() {
    assert!(Fourier::new(8).lines(&mut [1.0; 7]).iter().all(|line| *line == Complex64::ZERO));
}
