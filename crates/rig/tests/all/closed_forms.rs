//! The structure against results known in closed form.

use crate::common::largest_error;
use jointscope_fixture::Fixture;
use jointscope_rig::{Assembly, BeamElement, Instrument, Law, Row, Station, Structure, frfs};
use jointscope_samples::transverse;
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A mesh of `count` equal elements, and its nodes.
fn mesh(element: BeamElement, count: usize) -> (Assembly, Vec<Station>) {
    let mut assembly = Assembly::new();
    let nodes: Vec<Station> = (0..=count).map(|_| assembly.node()).collect();
    let element = BeamElement { length: element.length / count as f64, ..element };
    for pair in nodes.windows(2) {
        element.assemble(&mut assembly, &pair[0], &pair[1], Law::ELASTIC).unwrap();
    }
    (assembly, nodes)
}

#[test]
fn a_free_uniform_beam_has_the_frequencies_of_the_textbook() {
    let (length, ei, m) = (0.38, 85.0, 1.2);
    let element = BeamElement {
        length,
        bending_stiffness: ei,
        shear_stiffness: f64::INFINITY,
        mass_per_length: m,
        rotary_inertia: 0.0,
    };
    let (assembly, _) = mesh(element, 64);
    let frequencies = Structure::new(assembly, []).natural_frequencies().unwrap();
    let unit = (ei / (m * length.powi(4))).sqrt() / TAU;
    for (mode, expected) in [22.373_285, 61.672_823, 120.903_392].into_iter().enumerate() {
        let got = frequencies[mode + 2] / unit;
        assert!((got / expected - 1.0_f64).abs() < 1e-6, "mode {}: {got} instead of {expected}", mode + 1);
    }
}

#[test]
fn a_deformable_body_of_a_fixture_has_the_same_frequencies_wherever_its_nodes_fall() {
    let fixture = Fixture::from_json(
        r#"{
        "bodies": { "A": { "beam": { "from": 0.0, "to": 0.4, "youngs_modulus": 2e11, "second_moment": 1e-9,
            "mass_per_length": 2.0 } } },
        "points": { "1": { "body": "A", "x": 0.0501 }, "2": { "body": "A", "x": 0.0502 }, "3": { "body": "A", "x": 0.39999 } },
        "damping": { "modal_ratios": [0.01] }
    }"#,
    )
    .unwrap();
    let frequencies = Structure::of(&fixture).unwrap().natural_frequencies().unwrap();
    let unit = (200.0_f64 / (2.0 * 0.4_f64.powi(4))).sqrt() / TAU;
    assert!(frequencies[1] < 1e-3 * unit, "rigid motions: {:?}", &frequencies[..2]);
    for (mode, expected) in [22.373_285, 61.672_823, 120.903_392].into_iter().enumerate() {
        let got = frequencies[mode + 2] / unit;
        assert!((got / expected - 1.0_f64).abs() < 1e-6, "mode {}: {got} instead of {expected}", mode + 1);
    }
}

/// Timoshenko's cantilever: the lowest root of the 4×4 frequency determinant, by bisection on its exact
/// solution.
fn timoshenko_cantilever(length: f64, ei: f64, ga: f64, m: f64, rho_i: f64, below: f64) -> f64 {
    let determinant = |omega: f64| {
        // EI·GA·v'''' + ω²(ρI·GA + m·EI)·v'' + (ρI·ω² − GA)·m·ω²·v = 0, with v = e^{λx}.
        let w2 = omega * omega;
        let (p, q) = (w2 * (rho_i / ei + m / ga), m * w2 / ei * (rho_i * w2 / ga - 1.0));
        let root = (p * p / 4.0 - q).sqrt();
        let (a, b) = ((root - p / 2.0).sqrt(), (root + p / 2.0).sqrt());
        // ψ for v = cosh ax and for v = cos bx: GA(v'' − ψ') = −mω²v.
        let (ka, kb) = ((a * a + m * w2 / ga) / a, (b * b - m * w2 / ga) / b);
        // Clamped at 0: v = C(cosh ax − cos bx) + D(sinh ax − (ka/kb)·sin bx).
        let ratio = ka / kb;
        let (ch, sh, c, s) =
            ((a * length).cosh(), (a * length).sinh(), (b * length).cos(), (b * length).sin());
        // ψ = C(ka·sinh + kb·sin) + D(ka·cosh − ka·cos); moment ψ' and shear v' − ψ vanish at the tip.
        let moment = [ka * a * ch + kb * b * c, ka * a * sh + ka * b * s];
        let shear = [a * sh + b * s - ka * sh - kb * s, a * ch - ratio * b * c - ka * ch + ka * c];
        moment[0] * shear[1] - moment[1] * shear[0]
    };
    let step = below / 2000.0;
    let mut low = step;
    while determinant(low).signum() == determinant(low + step).signum() && low < below {
        low += step;
    }
    let mut high = low + step;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if determinant(low).signum() == determinant(middle).signum() { low = middle } else { high = middle }
    }
    low
}

#[test]
fn a_stocky_cantilever_has_timoshenkos_first_frequency_and_not_eulers() {
    let (length, ei, ga, m, rho_i) = (0.1, 4e4, 2e7, 7.0, 1.4e-3);
    let element = BeamElement {
        length,
        bending_stiffness: ei,
        shear_stiffness: ga,
        mass_per_length: m,
        rotary_inertia: rho_i,
    };
    let mut assembly = Assembly::new();
    let (count, mut left) = (80, Station::default());
    for _ in 0..count {
        let right = assembly.node();
        let element = BeamElement { length: length / count as f64, ..element };
        element.assemble(&mut assembly, &left, &right, Law::ELASTIC).unwrap();
        left = right;
    }
    let euler = 3.516_015 * (ei / (m * length.powi(4))).sqrt();
    let expected = timoshenko_cantilever(length, ei, ga, m, rho_i, euler);
    let got = Structure::new(assembly, []).natural_frequencies().unwrap()[0] * TAU;
    assert!(expected < 0.97 * euler, "the case has to be stocky: {expected} beside {euler} rad/s");
    assert!((got / expected - 1.0).abs() < 1e-4, "{got} instead of {expected} rad/s");
}

fn storeys(physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{
        "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
        "points": {{ "1": {{ "body": "A", "x": 0.0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
        "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[5e6, 0.0], [0.0, 0.0]], "damping": [[40.0, 0.0], [0.0, 0.0]] }} }},
        "physics": [{physics}]
    }}"#
    ))
    .unwrap()
}

fn lines() -> SpectralLines {
    SpectralLines::even(10.0, 5.0, 150).unwrap()
}

/// Two masses joined by a complex stiffness, accelerances 1/1 and 2/1.
fn two_masses(a: f64, b: f64, k: impl Fn(Complex64) -> Complex64, decay: f64) -> FrfSet {
    let lines = lines();
    let mut values = vec![Complex64::ZERO; 2 * lines.len()];
    for (line, omega) in lines.omegas().enumerate() {
        let s = Complex64::new(decay, omega);
        let (k, s2) = (k(s), s * s);
        let determinant = (s2 * a + k) * (s2 * b + k) - k * k;
        values[line] = s2 * (s2 * b + k) / determinant;
        values[lines.len() + line] = s2 * k / determinant;
    }
    let pairs = transverse(&[("1", "1"), ("2", "1")]);
    FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap()
}

#[track_caller]
fn check_two_masses(physics: &str, masses: (f64, f64), k: impl Fn(Complex64) -> Complex64, decay: f64) {
    let expected = two_masses(masses.0, masses.1, k, decay);
    let got = frfs(&storeys(physics), expected.pairs(), &lines(), Instrument::AsDescribed).unwrap();
    let error = largest_error(&expected, &got);
    assert!(error < 1e-12, "{physics}: {error}");
}

#[test]
fn two_masses_and_a_spring_follow_the_closed_form_with_every_law_of_the_joint() {
    let c = |s: Complex64| s * 40.0;
    check_two_masses("", (2.0, 3.0), |s| 5e6 + c(s), 0.0);
    check_two_masses(
        r#"{"kind": "stiffness_change", "place": "J", "factor": 0.5}"#,
        (2.0, 3.0),
        |s| 2.5e6 + c(s),
        0.0,
    );
    check_two_masses(
        r#"{"kind": "loss_factor", "place": "J", "loss_factor": 0.1}"#,
        (2.0, 3.0),
        |s| Complex64::new(5e6, 5e5) + c(s),
        0.0,
    );
    check_two_masses(
        r#"{"kind": "relaxation", "place": "J", "ratio": 0.4, "time": 5e-4}"#,
        (2.0, 3.0),
        |s| 5e6 * (1.0 + 0.4 * s * 5e-4 / (1.0 + s * 5e-4)) + c(s),
        0.0,
    );
    check_two_masses(r#"{"kind": "joint_mass", "place": "J", "mass": 0.2}"#, (2.1, 3.1), |s| 5e6 + c(s), 0.0);
    check_two_masses(
        r#"{"kind": "exponential_window", "place": "all", "decay": 15.0}"#,
        (2.0, 3.0),
        |s| 5e6 + c(s),
        15.0,
    );
    check_two_masses(
        r#"{"kind": "interface_compliance", "place": "2", "dof": "translation", "stiffness": 2e7, "damping": 100.0}"#,
        (2.0, 3.0),
        |s| ((5e6 + c(s)).inv() + (2e7 + s * 100.0).inv()).inv(),
        0.0,
    );
    check_two_masses(
        r#"{"kind": "parallel_stiffness", "place": "J", "dof": "translation", "stiffness": 1e6, "damping": 30.0}"#,
        (2.0, 3.0),
        |s| 6e6 + c(s) + s * 30.0,
        0.0,
    );
}

#[test]
fn a_resonator_below_its_frequency_is_a_mass_and_far_above_it_is_gone() {
    let pairs = transverse(&[("1", "1")]);
    let at = |frequency: f64, physics: &str| {
        let lines = SpectralLines::new(vec![frequency]).unwrap();
        frfs(&storeys(physics), &pairs, &lines, Instrument::Perfect).unwrap().values(0)[0]
    };
    let resonator = r#"{"kind": "attached_resonator", "place": "A", "x": 0.0, "mass": 0.5, "frequency": 60.0, "damping_ratio": 0.01}"#;
    let mass = r#"{"kind": "added_mass", "place": "A", "x": 0.0, "mass": 0.5}"#;
    assert!((at(0.5, resonator) / at(0.5, mass) - 1.0).norm() < 1e-4);
    assert!((at(6000.0, resonator) / at(6000.0, "") - 1.0).norm() < 1e-3);
}

#[test]
fn a_roving_sensors_mass_loads_its_own_response_only() {
    let sensor = r#"{"kind": "sensor_mass", "place": "response 2", "mass": 0.05}"#;
    let mass = r#"{"kind": "added_mass", "place": "B", "x": 0.1, "mass": 0.05}"#;
    let pairs = transverse(&[("1", "1"), ("2", "1"), ("1", "2"), ("2", "2")]);
    let read = |physics: &str, instrument| frfs(&storeys(physics), &pairs, &lines(), instrument).unwrap();
    let (roving, fixed) = (read(sensor, Instrument::AsDescribed), read(mass, Instrument::AsDescribed));
    let bare = read("", Instrument::AsDescribed);
    for index in 0..4 {
        let expected = if index % 2 == 1 { fixed.values(index) } else { bare.values(index) };
        for (a, b) in roving.values(index).iter().zip(expected) {
            assert!((a - b).norm() < 1e-10 * b.norm(), "FRF {}", pairs[index]);
        }
    }
    assert!(largest_error(&bare, &read(sensor, Instrument::Perfect)) < 1e-15);
}

#[test]
fn gains_and_delays_act_on_the_signal_of_their_channel() {
    let physics = r#"{"kind": "channel_gain", "place": "response 2", "factor": -1.0},
        {"kind": "channel_gain", "place": "reference 1", "factor": 2.0},
        {"kind": "channel_delay", "place": "reference 1", "seconds": 1e-4},
        {"kind": "channel_delay", "place": "response 1", "seconds": 3e-4}"#;
    let pairs = transverse(&[("1", "1"), ("2", "1"), ("2", "2")]);
    let bare = frfs(&storeys(""), &pairs, &lines(), Instrument::AsDescribed).unwrap();
    let read = frfs(&storeys(physics), &pairs, &lines(), Instrument::AsDescribed).unwrap();
    for (line, omega) in lines().omegas().enumerate() {
        let factors = [
            Complex64::from_polar(0.5, -omega * 2e-4),
            Complex64::from_polar(-0.5, omega * 1e-4),
            Complex64::new(-1.0, 0.0),
        ];
        for (index, factor) in factors.into_iter().enumerate() {
            let (a, b) = (read.values(index)[line], bare.values(index)[line] * factor);
            assert!((a - b).norm() < 1e-12 * b.norm(), "FRF {} at {} Hz", pairs[index], lines().hz()[line]);
        }
    }
}

fn two_blocks(x3: f64, x4: f64, x_cg: f64, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{
        "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }},
                     "B": {{ "mass": 1.3, "inertia": 1.1e-3, "x_cg": {x_cg} }} }},
        "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0.0 }},
                     "3": {{ "body": "B", "x": {x3} }}, "4": {{ "body": "B", "x": {x4} }} }},
        "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
        "damping": {{ "loss_factor": 0.005 }},
        "physics": [{physics}]
    }}"#
    ))
    .unwrap()
}

#[test]
fn a_longer_joint_moves_what_lies_beyond_it_outward() {
    let pairs = transverse(&[("4", "1"), ("3", "2"), ("4", "4")]);
    let longer = two_blocks(0.065, 0.125, 0.095, r#"{"kind": "joint_length", "place": "J", "dx": 0.004}"#);
    let moved = two_blocks(0.069, 0.129, 0.099, "");
    let read = |fixture| frfs(fixture, &pairs, &lines(), Instrument::Perfect).unwrap();
    assert!(largest_error(&read(&moved), &read(&longer)) < 1e-11);
}

#[test]
fn a_footing_is_a_rotational_interface_of_one_size_at_either_end() {
    let end = |point: &str| {
        format!(
            r#"{{"kind": "interface_compliance", "place": "{point}", "dof": "rotation", "stiffness": 7e3, "damping": 0.4}}"#
        )
    };
    let pairs = transverse(&[("4", "1"), ("1", "1")]);
    let read = |physics: &str| {
        frfs(&two_blocks(0.065, 0.125, 0.095, physics), &pairs, &lines(), Instrument::Perfect).unwrap()
    };
    let footing = read(r#"{"kind": "footing", "place": "J", "stiffness": 7e3, "damping": 0.4}"#);
    let both = read(&format!("{}, {}", end("2"), end("3")));
    assert!(largest_error(&both, &footing) < 1e-11);
}

#[test]
fn a_displaced_point_reads_where_it_is_and_leaves_the_joint_alone() {
    let offset = two_blocks(0.065, 0.125, 0.095, r#"{"kind": "point_offset", "place": "3", "dx": 0.06}"#);
    let bare = two_blocks(0.065, 0.125, 0.095, "");
    let read =
        |fixture, pair| frfs(fixture, &transverse(&[pair]), &lines(), Instrument::AsDescribed).unwrap();
    let (a, b) = (read(&offset, ("3", "1")), read(&bare, ("4", "1")));
    for (a, b) in a.values(0).iter().zip(b.values(0)) {
        assert!((a - b).norm() < 1e-12 * b.norm());
    }
}

#[test]
fn an_offset_of_a_response_leaves_the_impacts_at_its_point_alone() {
    let at = |place: &str| {
        let physics = format!(r#"{{"kind": "point_offset", "place": "{place}", "dx": 0.06}}"#);
        two_blocks(0.065, 0.125, 0.095, &physics)
    };
    let bare = two_blocks(0.065, 0.125, 0.095, "");
    let read = |fixture: &Fixture, pair| {
        frfs(fixture, &transverse(&[pair]), &lines(), Instrument::AsDescribed).unwrap()
    };
    for (place, there) in [("response 3", ("4", "3")), ("reference 3", ("3", "4"))] {
        let (a, b) = (read(&at(place), ("3", "3")), read(&bare, there));
        for (a, b) in a.values(0).iter().zip(b.values(0)) {
            assert!((a - b).norm() < 1e-12 * b.norm(), "{place}");
        }
    }
}

#[test]
fn rotations_and_moments_are_reciprocal_to_displacements_and_forces() {
    let pairs = [
        FrfPair::new(Channel::rotational("4"), Channel::transverse("1")),
        FrfPair::new(Channel::transverse("1"), Channel::rotational("4")),
    ];
    let physics = r#"{"kind": "body_flexibility", "place": "B", "frequency": 1500.0, "damping_ratio": 0.01},
        {"kind": "joint_mass", "place": "J", "mass": 0.1}, {"kind": "shear_deformation", "place": "J", "shear_stiffness": 1e6}"#;
    let set = frfs(&two_blocks(0.065, 0.125, 0.095, physics), &pairs, &lines(), Instrument::Perfect).unwrap();
    for (a, b) in set.values(0).iter().zip(set.values(1)) {
        assert!((a - b).norm() < 1e-9 * a.norm(), "{a} and {b}");
    }
}

#[test]
fn a_stiff_deformable_body_moves_as_a_block() {
    let body = |kind: &str| {
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {kind}, "B": {{ "mass": 1.3, "inertia": 1.1e-3, "x_cg": 0.1 }} }},
            "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": -0.011 }},
                         "3": {{ "body": "B", "x": 0.06 }} }},
            "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2e11, "second_moment": 3e-10 }} }} }},
            "damping": {{ "modal_ratios": [0.004, 0.006] }} }}"#
        ))
        .unwrap()
    };
    let bar = body(
        r#"{ "beam": { "from": -0.1, "to": 0.0, "youngs_modulus": 2e11, "second_moment": 1e-5, "mass_per_length": 12.0 } }"#,
    );
    let block = body(r#"{ "mass": 1.2, "inertia": 1e-3, "x_cg": -0.05 }"#);
    let pairs = transverse(&[("3", "1"), ("2", "1")]);
    let read = |fixture| frfs(fixture, &pairs, &lines(), Instrument::Perfect).unwrap();
    let error = largest_error(&read(&block), &read(&bar));
    assert!(error < 0.01, "{error}");
}

#[test]
fn a_nonlinear_effect_has_no_frfs() {
    let physics =
        r#"{"kind": "gap", "place": "J", "dof": "translation", "clearance": 1e-5, "stiffness": 1e6}"#;
    let answer = frfs(&storeys(physics), &transverse(&[("1", "1")]), &lines(), Instrument::Perfect);
    assert!(answer.unwrap_err().to_string().starts_with("`gap` at J is non-linear"));
    let pair = transverse(&[("9", "1")]);
    let answer = frfs(&storeys(""), &pair, &lines(), Instrument::Perfect);
    assert_eq!(
        answer.unwrap_err().to_string(),
        "there is no point `9` to measure at: name one of the fixture's points"
    );
    assert_eq!(Row::zero().terms(), []);
}
