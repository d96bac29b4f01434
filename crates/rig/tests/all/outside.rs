//! Physics outside the vocabulary, against closed forms on two masses.

use jointscope_fixture::Fixture;
use jointscope_rig::{Instrument, Outside, frfs};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

const STIFFNESS: f64 = 5e6;

fn two_masses() -> Fixture {
    Fixture::from_json(
        r#"{
          "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
          "points": { "1": { "body": "A", "x": 0.0 }, "2": { "body": "B", "x": 0.1 } },
          "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e6, 0.0], [0.0, 0.0]] } }
        }"#,
    )
    .unwrap()
}

fn lines() -> SpectralLines {
    SpectralLines::new(vec![20.0, 100.0, 400.0, 900.0]).unwrap()
}

/// Accelerance 2/1 of two free masses with a dynamic stiffness `k` between them.
fn transfer(k: Complex64, omega: f64) -> Complex64 {
    let w2 = omega * omega;
    let (a, b) = (k - 2.0 * w2, k - 3.0 * w2);
    -w2 * k / (a * b - k * k)
}

fn check(outside: &Outside, tolerance: f64, k: impl Fn(f64) -> Complex64) {
    let lines = lines();
    let pair = FrfPair::transverse("2", "1");
    let read = outside.frfs(&two_masses(), &[pair], &lines, Instrument::Perfect).unwrap();
    for (line, omega) in lines.omegas().enumerate() {
        let (got, expected) = (read.values(0)[line], transfer(k(omega), omega));
        let error = (got - expected).norm() / expected.norm();
        assert!(error < tolerance, "{outside} at {} Hz: {got}, expected {expected}", lines.hz()[line]);
    }
}

#[test]
fn an_inerter_is_a_stiffness_that_falls_with_the_square_of_frequency() {
    let outside = Outside::Inerter { joint: "J".into(), inertance: 0.1 };
    check(&outside, 1e-10, |omega| Complex64::from(STIFFNESS - 0.1 * omega * omega));
}

#[test]
fn a_bypass_is_a_second_spring() {
    let outside = Outside::Bypass { from: "1".into(), to: "2".into(), stiffness: 4e5 };
    check(&outside, 1e-10, |_| Complex64::from(STIFFNESS + 4e5));
}

#[test]
fn a_springpot_follows_a_broken_power_of_frequency() {
    let outside = Outside::Springpot { joint: "J".into(), stiffness: 5e5, order: 0.5 };
    let power = |omega: f64| 5e5 * Complex64::new(0.0, omega / (TAU * 100.0)).powf(0.5);
    // The branches end at 1 Hz and 10 kHz, where the power law does not.
    check(&outside, 0.05, |omega| STIFFNESS + power(omega));
}

#[test]
fn a_drift_changes_the_columns_struck_after_it_alone() {
    let (fixture, lines) = (two_masses(), lines());
    let pairs = [FrfPair::transverse("2", "1"), FrfPair::transverse("1", "2")];
    let plain = frfs(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let outside = Outside::Drift { joint: "J".into(), reference: "2".into(), factor: 1.1 };
    let drifted = outside.frfs(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    assert_eq!(drifted.values(0), plain.values(0));
    let stiffer = transfer(Complex64::from(1.1 * STIFFNESS), lines.omega(2));
    assert!((drifted.values(1)[2] - stiffer).norm() < 1e-9 * stiffer.norm());
}

#[test]
fn a_gyroscope_breaks_reciprocity() {
    let fixture = Fixture::from_json(
        r#"{
          "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": 0.095 } },
          "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0.0 },
                      "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
          "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
          "damping": { "loss_factor": 0.006 }
        }"#,
    )
    .unwrap();
    let lines = lines();
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("1", "4")];
    let outside = Outside::Gyroscope { point: "2".into(), coupling: 5.0 };
    let read = outside.frfs(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let split = (read.values(0)[1] - read.values(1)[1]).norm() / read.values(0)[1].norm();
    assert!(split > 1e-3, "4/1 and 1/4 agree within {split}");
}
