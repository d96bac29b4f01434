//! Effects of the measuring chain, each against its definition.

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, LumpedError, ModelledTest, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

fn fixture(points: &str, extra_mass: &str, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }},
                           "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 {extra_mass} }} }},
          "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, {points} }},
          "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
          "damping": {{ "modal_ratios": [0.004, 0.006] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

const AS_STATED: &str = r#""4": { "body": "B", "x": 0.125 }"#;

fn frfs(fixture: &Fixture, instrument: Instrument) -> FrfSet {
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("3", "2")];
    synthesize(fixture, &pairs, &SpectralLines::even(10.0, 7.5, 130).unwrap(), instrument).unwrap()
}

fn assert_equal(a: &[Complex64], b: &[Complex64]) {
    for (line, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x - y).norm() < 1e-9 * y.norm().max(1e-3), "line {line}: {x} against {y}");
    }
}

#[test]
fn a_gain_multiplies_a_response_and_divides_a_reference() {
    let plain = frfs(&fixture(AS_STATED, "", ""), Instrument::AsRecorded);
    let physics = r#"{"kind": "channel_gain", "place": "response 4", "factor": 0.8}, {"kind": "channel_gain", "place": "reference 1", "factor": 2}"#;
    let scaled = frfs(&fixture(AS_STATED, "", physics), Instrument::AsRecorded);
    let expected: Vec<_> = plain.values(0).iter().map(|v| v * 0.4).collect();
    assert_equal(scaled.values(0), &expected);
    assert_equal(scaled.values(1), plain.values(1));
}

#[test]
fn a_delayed_response_lags() {
    let plain = frfs(&fixture(AS_STATED, "", ""), Instrument::AsRecorded);
    let late = frfs(
        &fixture(AS_STATED, "", r#"{"kind": "channel_delay", "place": "response 4", "seconds": 1e-5}"#),
        Instrument::AsRecorded,
    );
    for line in 0..130 {
        let lag = (plain.values(0)[line] / late.values(0)[line]).arg();
        assert!((lag - plain.lines().omega(line) * 1e-5).abs() < 1e-9, "line {line}: {lag}");
    }
}

#[test]
fn an_offset_sensor_reads_what_a_sensor_there_would() {
    let offset = fixture(AS_STATED, "", r#"{"kind": "point_offset", "place": "4", "dx": 0.004}"#);
    let there = fixture(r#""4": { "body": "B", "x": 0.129 }"#, "", "");
    assert_equal(
        frfs(&offset, Instrument::AsRecorded).values(0),
        frfs(&there, Instrument::AsRecorded).values(0),
    );
}

#[test]
fn where_a_point_is_struck_and_read_its_sensor_and_its_impacts_may_each_be_off_alone() {
    let two = format!(r#"{AS_STATED}, "beside": {{ "body": "B", "x": 0.129 }}"#);
    let read = |physics: &str, pair: (&str, &str)| {
        let pairs = [FrfPair::transverse(pair.0, pair.1)];
        let lines = SpectralLines::even(10.0, 7.5, 130).unwrap();
        synthesize(&fixture(&two, "", physics), &pairs, &lines, Instrument::AsRecorded).unwrap()
    };
    for (place, there) in [("response 4", ("beside", "4")), ("reference 4", ("4", "beside"))] {
        let physics = format!(r#"{{"kind": "point_offset", "place": "{place}", "dx": 0.004}}"#);
        assert_equal(read(&physics, ("4", "4")).values(0), read("", there).values(0));
        let other = if place.starts_with("response") { ("1", "4") } else { ("4", "1") };
        assert_equal(read(&physics, other).values(0), read("", other).values(0));
    }
}

#[test]
fn a_sensors_mass_loads_its_own_row_and_no_other() {
    let loaded = frfs(
        &fixture(AS_STATED, "", r#"{"kind": "sensor_mass", "place": "response 4", "mass": 0.02}"#),
        Instrument::AsRecorded,
    );
    let with_mass =
        frfs(&fixture(AS_STATED, r#", "masses": [{"x": 0.125, "mass": 0.02}]"#, ""), Instrument::AsRecorded);
    let plain = frfs(&fixture(AS_STATED, "", ""), Instrument::AsRecorded);
    // The two differ by the damping matrix, which a known mass takes part in and an effect does not.
    for line in 0..130 {
        let (a, b) = (loaded.values(0)[line], with_mass.values(0)[line]);
        assert!((a - b).norm() < 2e-3 * b.norm(), "line {line}: {a} against {b}");
    }
    assert_equal(loaded.values(1), plain.values(1));
}

#[test]
fn a_sensor_that_is_moved_loads_every_response_while_it_is_there() {
    let each = r#"{"kind": "sensor_mass", "place": "response 4", "mass": 0.02}, {"kind": "sensor_mass", "place": "response 3", "mass": 0.02}"#;
    let one = r#"{"kind": "sensor_mass", "place": "responses", "mass": 0.02}"#;
    let [each, one] =
        [each, one].map(|physics| frfs(&fixture(AS_STATED, "", physics), Instrument::AsRecorded));
    (0..2).for_each(|frf| assert_equal(each.values(frf), one.values(frf)));
}

#[test]
fn a_perfect_instrument_leaves_all_of_that_out() {
    let physics = r#"{"kind": "channel_gain", "place": "response 4", "factor": 0.8}, {"kind": "exponential_window", "place": "all", "decay": 8},
        {"kind": "sensor_mass", "place": "response 4", "mass": 0.02}, {"kind": "point_offset", "place": "4", "dx": 0.004}"#;
    let perfect = frfs(&fixture(AS_STATED, "", physics), Instrument::Perfect);
    let plain = frfs(&fixture(AS_STATED, "", ""), Instrument::AsRecorded);
    for i in 0..2 {
        assert_equal(perfect.values(i), plain.values(i));
    }
}

#[test]
fn a_window_adds_its_decay_to_the_half_width_of_a_peak() {
    let value_at_peak = |physics: &str| {
        let fixture = fixture(AS_STATED, "", physics);
        let lines = SpectralLines::even(50.0, 0.05, 12_000).unwrap();
        let set =
            synthesize(&fixture, &[FrfPair::transverse("4", "1")], &lines, Instrument::AsRecorded).unwrap();
        let (line, peak) =
            set.values(0).iter().enumerate().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
        (lines.omega(line), peak.norm())
    };
    let (omega, plain) = value_at_peak("");
    let (_, windowed) = value_at_peak(r#"{"kind": "exponential_window", "place": "all", "decay": 5}"#);
    // A peak is as high as its half-width ζω (+ decay) is small; which of the two modes is higher is the
    // same.
    let ratio = plain / windowed;
    let expected = [0.004, 0.006].map(|zeta| (zeta * omega + 5.0) / (zeta * omega));
    assert!(expected.iter().any(|e| (ratio / e - 1.0).abs() < 0.01), "{ratio} against {expected:?}");
}

#[test]
fn a_line_at_zero_hertz_is_the_rigid_body_limit() {
    let fixture = fixture(AS_STATED, "", "");
    let at = |hz: f64| {
        let lines = SpectralLines::new(vec![hz]).unwrap();
        synthesize(&fixture, &[FrfPair::transverse("4", "1")], &lines, Instrument::Perfect).unwrap().values(0)
            [0]
    };
    assert!((at(0.0) - at(0.01)).norm() < 1e-6 * at(0.01).norm(), "{} {}", at(0.0), at(0.01));
}

#[test]
fn physics_that_depends_on_amplitude_has_no_frf_and_the_message_says_what_to_do() {
    let fixture = fixture(
        AS_STATED,
        "",
        r#"{"kind": "gap", "place": "J", "dof": "translation", "clearance": 1e-5, "stiffness": 1e5}"#,
    );
    let lines = SpectralLines::new(vec![100.0]).unwrap();
    let error =
        synthesize(&fixture, &[FrfPair::transverse("4", "1")], &lines, Instrument::Perfect).unwrap_err();
    assert!(matches!(error, LumpedError::NonLinear { index: 0, kind: "gap" }));
    assert!(error.to_string().contains("jointscope simulate"), "{error}");
}

#[test]
fn at_the_pole_of_a_sensor_on_its_mounting_frfs_are_not_finite() {
    let physics =
        r#"{"kind": "channel_resonance", "place": "response 4", "frequency": 480, "damping_ratio": 0.022}"#;
    let fixture = fixture(AS_STATED, "", physics);
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("3", "2")];
    let test = ModelledTest::new(&fixture, &pairs, 1000.0, Instrument::AsRecorded).unwrap();
    let (mut frfs, mut values) = (test.continued(), [Complex64::ZERO; 2]);
    // s² + 2ζω₀s + ω₀² = 0
    let (omega, zeta) = (std::f64::consts::TAU * 480.0, 0.022_f64);
    let pole = omega * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt());
    assert!(frfs.at(pole * 1.001, &mut values));
    let beside = values[0].norm();
    // Rounding decides whether the pole itself is met; next to it the FRF grows as the distance shrinks.
    match frfs.at(pole, &mut values) {
        false => {}
        true => assert!(values.iter().all(|v| v.is_finite()) && values[0].norm() > 1e6 * beside),
    }
    let plain = self::fixture(AS_STATED, "", "");
    let test = ModelledTest::new(&plain, &pairs, 1000.0, Instrument::AsRecorded).unwrap();
    assert!(test.continued().at(pole, &mut values), "the structure has no pole there");
}
