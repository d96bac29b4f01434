//! What effects do to a model's features: by their definition, and as a recording of them shows.

use crate::common::*;
use jointscope_model_error::ModelledMode;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Modelled features of the plain blocks and of those with `physics`, between the channels of a recording up
/// to 600 Hz: the second mode is in the upper residual.
fn modelled_beside(physics: &str) -> (Compared, Compared) {
    let recorded = Recorded::of(&blocks(""), &four(), &lines(600.0), noise(None)).modes();
    (Compared::of(&blocks(""), recorded.clone()), Compared::of(&blocks(physics), recorded))
}

#[track_caller]
fn assert_same_poles(a: &Compared, b: &Compared) {
    for (a, b) in a.modelled.poles().iter().zip(b.modelled.poles()) {
        assert!((a - b).norm() < 1e-7 * a.norm(), "pole {a} rad/s, expected {b} rad/s");
    }
}

#[test]
fn a_gain_scales_residues_and_residual_terms_of_its_channel() {
    let (plain, with) = modelled_beside(r#"{"kind": "channel_gain", "place": "response 4", "factor": 0.8}"#);
    assert_same_poles(&with, &plain);
    // FRFs 0 and 2 are those of response 4.
    let factor = |frf: usize| if frf.is_multiple_of(2) { 0.8 } else { 1.0 };
    for (a, b) in with.modelled.modes.iter().zip(&plain.modelled.modes) {
        for (frf, (a, b)) in a.residues.iter().zip(&b.residues).enumerate() {
            assert!(
                (a - b * factor(frf)).norm() < 1e-6 * b.norm(),
                "FRF {frf}: residue {a}, expected {b} · {}",
                factor(frf)
            );
        }
    }
    let first = plain.comparison.count() - 8;
    for (k, (a, b)) in with.model()[first..].iter().zip(&plain.model()[first..]).enumerate() {
        let expected = b * factor(k / 2);
        assert!(
            (a - expected).abs() < 1e-5 * b.abs().max(1.0),
            "residual term {k}: {a}, expected {expected}"
        );
    }
}

#[test]
fn a_delay_turns_residues_by_the_phase_at_the_pole() {
    let (plain, with) =
        modelled_beside(r#"{"kind": "channel_delay", "place": "response 4", "seconds": 1e-5}"#);
    assert_same_poles(&with, &plain);
    for (a, b) in with.modelled.modes.iter().zip(&plain.modelled.modes) {
        let turned = (-b.pole.lambda() * 1e-5).exp();
        for (frf, (a, b)) in a.residues.iter().zip(&b.residues).enumerate() {
            let expected = if frf.is_multiple_of(2) { b * turned } else { *b };
            assert!((a - expected).norm() < 1e-6 * b.norm(), "FRF {frf}: residue {a}, expected {expected}");
        }
    }
}

#[test]
fn an_offset_sensor_has_the_residues_of_a_sensor_there() {
    let (_, with) = modelled_beside(r#"{"kind": "point_offset", "place": "4", "dx": 0.004}"#);
    let there = Compared::of(&blocks_with_sensor_at(0.129, ""), with.recorded.clone());
    assert_same_poles(&with, &there);
    for (a, b) in with.model().iter().zip(there.model()) {
        assert!((a - b).abs() < 1e-6, "feature {a}, expected {b}");
    }
}

#[test]
fn an_interface_compliance_is_a_spring_in_series() {
    let physics =
        r#"{"kind": "interface_compliance", "place": "2", "dof": "translation", "stiffness": 4.5e7}"#;
    let recorded =
        Recorded::of(&two_masses(0.01, ""), &pairs(&[("2", "1")]), &lines(600.0), noise(None)).modes();
    let mode = &modelled(&two_masses(0.01, physics), &recorded).modes[0];
    let plain = &modelled(&two_masses(0.01, ""), &recorded).modes[0];
    // 5 MN/m and 45 MN/m in series are 4.5 MN/m. The assembly's own dashpot stays: ζω does.
    let ratio = 0.9f64.sqrt();
    let found = mode.pole.omega / plain.pole.omega;
    assert!((found - ratio).abs() < 1e-7, "frequency over that without: {found}, expected {ratio}");
    let decay = |p: &jointscope_model_error::Pole| p.damping_ratio * p.omega;
    let (a, b) = (decay(&mode.pole), decay(&plain.pole));
    assert!((a / b - 1.0).abs() < 1e-6, "decay {a} 1/s, expected {b} 1/s");
    let (a, b) = (mode.residues[0], plain.residues[0]);
    assert!((a - b).norm() < 1e-6 * b.norm(), "two masses keep their shape: {a}, expected {b}");
}

#[test]
fn a_window_adds_its_decay_to_that_of_the_modes() {
    let (plain, with) = modelled_beside(r#"{"kind": "exponential_window", "place": "all", "decay": 5}"#);
    for (a, b) in with.modelled.poles().iter().zip(plain.modelled.poles()) {
        let expected = b - Complex64::from(5.0);
        assert!((a - expected).norm() < 1e-7 * b.norm(), "pole {a} rad/s, expected {expected} rad/s");
    }
}

#[test]
fn a_recording_of_an_effect_shows_the_features_that_are_modelled_for_it() {
    for physics in [
        r#"{"kind": "channel_gain", "place": "response 4", "factor": 0.8}"#,
        r#"{"kind": "channel_delay", "place": "response 4", "seconds": 1e-5}"#,
        r#"{"kind": "point_offset", "place": "4", "dx": 0.004}"#,
        r#"{"kind": "interface_compliance", "place": "2", "dof": "rotation", "stiffness": 9e3}"#,
        r#"{"kind": "exponential_window", "place": "all", "decay": 5}"#,
        r#"{"kind": "sensor_mass", "place": "response 4", "mass": 0.02}"#,
        r#"{"kind": "added_mass", "place": "B", "x": 0.11, "mass": 0.05}"#,
        r#"{"kind": "loss_factor", "place": "J", "loss_factor": 0.01}"#,
    ] {
        let fixture = blocks(physics);
        let recorded = Recorded::of(&fixture, &four(), &lines(1500.0), noise(None)).modes();
        let compared = Compared::of(&fixture, recorded);
        let modes = compared.recorded.modes.iter().map(|m| m.pole.omega / TAU).collect::<Vec<_>>();
        // Delay, window and loss factor add what residual terms write up to a tenth of a deviation.
        let worst = compared
            .normalised()
            .into_iter()
            .zip(compared.names())
            .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
            .unwrap();
        assert!(
            worst.0.abs() < 0.2,
            "{physics}: modes at {modes:.1?} Hz; {} off by {:.3} deviations",
            worst.1.1,
            worst.0
        );
    }
}

/// Resonators of 20 g and 3 g on a block of 1.2 kg, at 620 Hz between modes of 247 and 908 Hz: a peak is
/// lower than what the others leave there, so that a search from it leads to one of these, or lies between
/// two frequencies of a coarse grid.
#[test]
fn the_mode_of_a_light_resonator_is_found_between_strong_ones() {
    for (mass, ratio) in [(0.02, 0.0005), (0.02, 0.003), (0.02, 0.01), (0.003, 0.003)] {
        let physics = format!(
            r#"{{"kind": "attached_resonator", "place": "B", "x": 0.1, "mass": {mass}, "frequency": 620, "damping_ratio": {ratio}}}"#
        );
        let recorded = Recorded::of(&blocks(""), &four(), &lines(1000.0), noise(None)).modes();
        let with = modelled(&blocks(&physics), &recorded);
        let near = |mode: &&ModelledMode| (mode.pole.omega / TAU / 620.0 - 1.0).abs() < 0.03;
        let own: Vec<f64> = with.modes.iter().filter(near).map(|mode| mode.pole.damping_ratio).collect();
        let [own] = own[..] else { panic!("damping ratio {ratio}: modes {:?}", with.poles()) };
        assert!((own / ratio - 1.0).abs() < 0.3, "damping ratio {own}, by itself {ratio}");
        assert_eq!(with.modes.len(), recorded.modes.len() + 1);
    }
}
