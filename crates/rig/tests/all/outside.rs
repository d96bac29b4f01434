//! Physics outside the vocabulary, against closed forms on two masses.

use jointscope_fixture::Fixture;
use jointscope_rig::{Family, Instrument, Outside, frfs, generator};
use jointscope_samples::TWO_BLOCKS;
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

fn read_of(outside: &Outside, fixture: &Fixture, lines: &SpectralLines) -> Vec<Complex64> {
    let pair = FrfPair::transverse("2", "1");
    outside.frfs(fixture, &[pair], lines, Instrument::AsDescribed).unwrap().values(0).to_vec()
}

#[test]
fn a_cross_axis_sensor_adds_a_share_of_the_motion_across_and_a_perfect_one_does_not() {
    let outside = Outside::CrossAxis { response: "2".into(), coupling: 0.02, ratio: 3.0 };
    let (fixture, lines) = (two_masses(), lines());
    for (got, omega) in read_of(&outside, &fixture, &lines).into_iter().zip(lines.omegas()) {
        let [within, across] = [1.0, 3.0].map(|ratio| transfer(Complex64::from(ratio * STIFFNESS), omega));
        let expected = within + 0.02 * across;
        assert!((got - expected).norm() < 1e-10 * expected.norm(), "{got}, expected {expected}");
    }
    check(&outside, 1e-10, |_| Complex64::from(STIFFNESS));
    let other = Outside::CrossAxis { response: "1".into(), coupling: 0.02, ratio: 3.0 };
    let plain = frfs(&fixture, &[FrfPair::transverse("2", "1")], &lines, Instrument::Perfect).unwrap();
    assert_eq!(read_of(&other, &fixture, &lines), plain.values(0), "of one sensor alone");
}

#[test]
fn a_clock_that_runs_fast_stretches_the_frequency_axis() {
    let outside = Outside::ClockError { response: "2".into(), rate: 1e-3 };
    let lines = lines();
    for (got, omega) in read_of(&outside, &two_masses(), &lines).into_iter().zip(lines.omegas()) {
        let expected = 1.001 * transfer(Complex64::from(STIFFNESS), 1.001 * omega);
        assert!((got - expected).norm() < 1e-10 * expected.norm(), "{got}, expected {expected}");
    }
    check(&outside, 1e-10, |_| Complex64::from(STIFFNESS));
}

#[test]
fn a_cable_resists_as_a_string_does() {
    let (mass, frequency) = (0.05, 57.0);
    let outside = Outside::Cable { body: "A".into(), x: 0.0, mass, frequency, damping_ratio: 0.0 };
    let lines = lines();
    for (line, got) in read_of(&outside, &two_masses(), &lines).into_iter().enumerate() {
        // A string of tension T and length ℓ resists one end with T/ℓ·z·cot z, z = π·f/f₁, T/ℓ = 4·m·f₁².
        let (omega, z) = (lines.omega(line), std::f64::consts::PI * lines.hz()[line] / frequency);
        let (w2, string) = (omega * omega, 4.0 * mass * frequency * frequency * z / z.tan());
        let (a, b) = (STIFFNESS - 2.0 * w2 + string, STIFFNESS - 3.0 * w2);
        let expected = -w2 * STIFFNESS / (a * b - STIFFNESS * STIFFNESS);
        assert!(
            (got - expected).norm() < 1e-4 * expected.abs(),
            "{} Hz: {got}, {expected}",
            lines.hz()[line]
        );
    }
}

#[test]
fn supports_on_a_table_are_springs_in_series_with_it() {
    let mut value = two_masses().to_value();
    value["supports"] = serde_json::json!({ "S": { "point": "1", "stiffness": 4e4, "damping": 3.0 } });
    let fixture = Fixture::from_value(&value).unwrap();
    let (mass, frequency, damping_ratio) = (20.0, 30.0, 0.04);
    let outside = Outside::BaseMotion { mass, frequency, damping_ratio };
    let lines = lines();
    for (line, got) in read_of(&outside, &fixture, &lines).into_iter().enumerate() {
        let (omega, own) = (lines.omega(line), TAU * frequency);
        let (w2, support) = (omega * omega, Complex64::new(4e4, 3.0 * omega));
        let table = mass * Complex64::new(own * own - w2, 2.0 * damping_ratio * own * omega);
        let series = support * table / (support + table);
        let (a, b) = (STIFFNESS - 2.0 * w2 + series, STIFFNESS - 3.0 * w2);
        let expected = -w2 * STIFFNESS / (a * b - STIFFNESS * STIFFNESS);
        assert!(
            (got - expected).norm() < 1e-9 * expected.norm(),
            "{} Hz: {got}, {expected}",
            lines.hz()[line]
        );
    }
}

#[test]
fn a_second_bending_mode_is_that_of_the_uniform_bar() {
    // A block by itself, read at its end: rigid motion and the second mode, whose ends deflect by 2 where the
    // mean square is one.
    let fixture = Fixture::from_json(
        r#"{
          "bodies": { "A": { "mass": 1.2, "inertia": 4e-3, "x_cg": 0.0 } },
          "points": { "1": { "body": "A", "x": -0.1 }, "2": { "body": "A", "x": 0.1 } },
          "joints": {}
        }"#,
    )
    .unwrap();
    let (frequency, damping_ratio) = (800.0, 0.01);
    let outside = Outside::SecondBending { body: "A".into(), frequency, damping_ratio };
    let lines = lines();
    for (got, omega) in read_of(&outside, &fixture, &lines).into_iter().zip(lines.omegas()) {
        let (w2, own) = (omega * omega, TAU * frequency);
        let modal = 1.2 * Complex64::new(own * own - w2, 2.0 * damping_ratio * own * omega);
        // The length is √(12 I/m) = 0.2 m, so the points are its ends, which move against each other.
        let expected = 1.0 / 1.2 - 0.01 / 4e-3 + w2 * 4.0 / modal;
        assert!((got - expected).norm() < 1e-6 * expected.norm(), "{got}, expected {expected}");
    }
    let known = outside.known();
    assert!((known[0].value(0) / frequency - 0.362_774).abs() < 1e-6, "the first mode is known: {known:?}");
}

#[test]
fn every_kind_that_has_no_name_is_drawn_where_there_is_room_for_it() {
    let mut random = generator(7);
    for kind in Outside::UNLISTED {
        let drawn = (0..40).find_map(|_| {
            let fixture = Family::SupportedTwoBlocks.draw("case", &mut random).unwrap();
            let pairs = Family::SupportedTwoBlocks.usual_pairs();
            let outside = Outside::draw_kind(&mut random, &fixture, kind, &pairs)?;
            assert_eq!(outside.kind(), kind);
            let known = fixture.with_physics(outside.known()).unwrap();
            let plain = frfs(&known, &pairs, &lines(), Instrument::AsDescribed).unwrap();
            let with = outside.frfs(&known, &pairs, &lines(), Instrument::AsDescribed).unwrap();
            assert_ne!(plain.all_values(), with.all_values(), "{outside}");
            Some(outside)
        });
        assert!(drawn.is_some(), "{kind}");
    }
    let firm = Family::TwoBlocks.draw("case", &mut random).unwrap();
    let pairs = Family::TwoBlocks.usual_pairs();
    assert_eq!(
        Outside::draw_kind(&mut random, &firm, "base_motion", &pairs),
        None,
        "nothing stands on ground"
    );
}

#[test]
fn a_gyroscope_breaks_reciprocity() {
    let fixture = Fixture::from_json(TWO_BLOCKS).unwrap();
    let lines = lines();
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("1", "4")];
    let outside = Outside::Gyroscope { point: "2".into(), coupling: 5.0 };
    let read = outside.frfs(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let split = (read.values(0)[1] - read.values(1)[1]).norm() / read.values(0)[1].norm();
    assert!(split > 1e-3, "4/1 and 1/4 agree within {split}");
}
