//! What errors of a structure's model leave of recordings: noise of any structure, and more of what filters,
//! and sensors that are moved, do.

use crate::common::*;
use jointscope_fixture::Fixture;
use jointscope_model_error::{Structural, WeightedFrfs};
use jointscope_spectra::SpectralLines;

/// What is left, and of how many degrees of freedom; of a structure that is held by dashpots, or not.
fn left(fixture: &Fixture, held: bool, seed: u64) -> (Structural, f64) {
    let lines = SpectralLines::even(7.5, 2.5, 400).unwrap();
    let recorded = Recorded::of(fixture, &four(), &lines, noise(Some(seed)));
    let recording = WeightedFrfs { frfs: &recorded.set, weights: &recorded.weights };
    let structural = recorded.modes().structural(recording, held).unwrap();
    let lines = lines.hz().iter().filter(|hz| **hz >= structural.from).count();
    (structural, (8 * lines - structural.unknowns) as f64)
}

#[test]
fn of_any_structure_no_more_than_noise_is_left() {
    let dashpot = r#"{"kind": "support", "place": "B", "x": 0.1, "stiffness": 5e4, "damping": 20.0}"#;
    let glue = r#"{"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 5e3, "damping": 0.05}"#;
    for (name, fixture) in [
        ("free", blocks("")),
        ("suspended", suspended()),
        ("supported", blocks(dashpot)),
        ("glued", blocks(glue)),
    ] {
        for seed in 1..4 {
            let (structural, degrees) = left(&fixture, name == "suspended", seed);
            let excess = (structural.chi2 - degrees) / (2.0 * degrees).sqrt();
            assert!(excess.abs() < 4.0, "{name}: {} of {degrees}", structural.chi2);
        }
    }
}

#[test]
fn what_is_of_no_structure_is_left() {
    let high_pass = r#"{"kind": "channel_highpass", "place": "response 4", "corner": 0.8}"#;
    let sensor = r#"{"kind": "sensor_mass", "place": "response 4", "mass": 0.004}"#;
    for physics in [high_pass, sensor] {
        let (structural, degrees) = left(&blocks(physics), false, 5);
        assert!(structural.chi2 > degrees + 100.0, "{physics}: {} of {degrees}", structural.chi2);
    }
}

#[test]
fn what_dashpots_of_a_suspension_add_is_of_a_structure_that_has_them() {
    let fixture = suspended_by("8.0");
    let excess = |held: bool| {
        let (structural, degrees) = left(&fixture, held, 7);
        (structural.chi2 - degrees) / (2.0 * degrees).sqrt()
    };
    assert!(excess(true).abs() < 4.0, "{}", excess(true));
    assert!(excess(false) > 10.0, "{}", excess(false));
}
