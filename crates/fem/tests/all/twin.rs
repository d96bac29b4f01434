//! The twin of a fixture against its lumped model, and what holds of any linear structure.

use jointscope_fem::{FemError, MeshOptions, ModeRange, Omissions, Superposition, Twin, calculix_deck};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{Channel, FrfPair, FrfSet, SpectralLines};

const D0: &str = include_str!("../../../../fixtures/paper/D0.json");
const COARSE: MeshOptions =
    MeshOptions { corner: 4, along: 12, across: 2, growth: 2.5, whole: false, without: NOTHING };
const NOTHING: Omissions =
    Omissions { joint_mass: false, shear: false, plate_action: false, block_flexibility: false };

fn twin(text: &str, options: MeshOptions) -> Twin {
    let fixture = Fixture::from_json(text).unwrap();
    Twin::of(&fixture, &options, ModeRange { at_least: 4, up_to: 2000.0 }, |_| {}).unwrap()
}

/// The text with an entry added before the points.
fn with(entry: &str) -> String {
    D0.replacen("\"points\"", &format!("{entry}, \"points\""), 1)
}

fn lines(hz: &[f64]) -> SpectralLines {
    SpectralLines::new(hz.to_vec()).unwrap()
}

fn lumped(text: &str, pairs: &[FrfPair], lines: &SpectralLines) -> FrfSet {
    synthesize(&Fixture::from_json(text).unwrap(), pairs, lines, Instrument::Perfect).unwrap()
}

#[test]
fn moduli_that_no_solid_has_are_refused() {
    let coarse = MeshOptions { corner: 2, along: 4, across: 1, growth: 4.0, ..COARSE };
    let refused = |modulus: &str| {
        let fixture = Fixture::from_json(&D0.replace("207000000000.0", modulus)).unwrap();
        let range = ModeRange { at_least: 4, up_to: 2000.0 };
        Twin::of(&fixture, &coarse, range, |_| {}).err().map(|error| error.to_string()).unwrap_or_default()
    };
    for modulus in ["1e18", "1e150", "1e300"] {
        let message = refused(modulus);
        assert!(message.contains("sound would travel at"), "{modulus} Pa: {message}");
    }
    for modulus in ["1e3", "1e-30", "1e-300"] {
        let message = refused(modulus);
        assert!(message.contains("more than 400 modes lie below 2000 Hz"), "{modulus} Pa: {message}");
    }
}

#[test]
fn far_below_its_first_mode_the_twin_moves_as_the_rigid_assembly() {
    let text = D0;
    let pairs =
        [FrfPair::transverse("4", "1"), FrfPair::new(Channel::rotational("4"), Channel::transverse("1"))];
    let lines = lines(&[0.0, 0.5]);
    let (found, expected) = (
        twin(text, COARSE).frfs(&pairs, &lines, Superposition::Complete).unwrap(),
        lumped(text, &pairs, &lines),
    );
    for frf in 0..2 {
        for (a, b) in found.values(frf).iter().zip(expected.values(frf)) {
            // The strip has mass, which the lumped joint has not: 1 % of the blocks'.
            assert!((a - b).norm() < 0.03 * b.norm(), "{}: {a} for {b}", pairs[frf]);
        }
    }
}

#[test]
fn half_the_depth_gives_the_frfs_of_the_whole() {
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("3", "2")];
    let lines = lines(&[20.0, 150.0, 390.0, 800.0]);
    let half = twin(D0, COARSE).frfs(&pairs, &lines, Superposition::Complete).unwrap();
    let whole = twin(D0, MeshOptions { whole: true, ..COARSE })
        .frfs(&pairs, &lines, Superposition::Complete)
        .unwrap();
    for (a, b) in half.all_values().iter().zip(whole.all_values()) {
        assert!((a - b).norm() < 1e-6 * b.norm(), "{a} for {b}");
    }
}

#[test]
fn response_and_force_may_change_places() {
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("1", "4")];
    let frfs = twin(D0, COARSE).frfs(&pairs, &lines(&[33.0, 444.0]), Superposition::Complete).unwrap();
    for (a, b) in frfs.values(0).iter().zip(frfs.values(1)) {
        assert!((a - b).norm() < 1e-9 * a.norm());
    }
}

#[test]
fn supports_and_point_masses_act_as_in_the_lumped_model() {
    let held = with(
        r#""supports": { "S": { "point": "1", "stiffness": 2e5, "damping": 20.0, "rotational_stiffness": 500.0 } }"#,
    )
    .replacen("\"x_cg\": -0.06895", "\"x_cg\": -0.06895, \"masses\": [{\"x\": -0.1, \"mass\": 0.4}]", 1);
    assert!(held.contains("masses"));
    let pairs = [FrfPair::transverse("1", "1"), FrfPair::transverse("3", "1")];
    // Below, near and above what the support makes of the rigid motions.
    let lines = lines(&[5.0, 15.0, 22.0, 40.0]);
    let found = twin(&held, COARSE).frfs(&pairs, &lines, Superposition::Complete).unwrap();
    let expected = lumped(&held, &pairs, &lines);
    let free = lumped(D0, &pairs, &lines);
    for ((a, b), without) in found.all_values().iter().zip(expected.all_values()).zip(free.all_values()) {
        assert!((a - b).norm() < 0.06 * b.norm(), "{a} for {b}");
        assert!((b - without).norm() > 0.1 * b.norm(), "the support must matter here");
    }
}

#[test]
fn two_modes_alone_miss_what_the_rest_adds_at_the_points() {
    let pairs = [FrfPair::transverse("3", "2")];
    let lines = lines(&[800.0]);
    let twin = twin(D0, COARSE);
    let all = twin.frfs(&pairs, &lines, Superposition::Complete).unwrap();
    let two = twin.frfs(&pairs, &lines, Superposition::First(2)).unwrap();
    let missing = (all.values(0)[0] - two.values(0)[0]).norm() / all.values(0)[0].norm();
    assert!(missing > 1e-3, "{missing}");
}

#[test]
fn a_layer_of_glue_softens_the_assembly() {
    let glued = D0
        .replacen(
            "\"steel\": {",
            "\"epoxy\": {\"youngs_modulus\": 3e9, \"poisson_ratio\": 0.35, \"density\": 1200}, \"steel\": {",
            1,
        )
        .replacen(
            "\"width\": 0.0584",
            "\"interfaces\": {\"2\": {\"thickness\": 0.0003, \"material\": \"epoxy\"}}, \"width\": 0.0584",
            1,
        );
    let (stiff, soft) = (twin(D0, COARSE).frequencies(), twin(&glued, COARSE).frequencies());
    assert!(soft[0] < 0.98 * stiff[0] && soft[1] < 0.99 * stiff[1], "{soft:?} {stiff:?}");
}

#[test]
fn what_cannot_be_meshed_is_refused_with_a_reason() {
    let without = Fixture::from_json(D0).unwrap().to_value();
    let mut without = without.clone();
    without.as_object_mut().unwrap().remove("geometry");
    let fixture = Fixture::from_value(&without).unwrap();
    let range = ModeRange { at_least: 1, up_to: 10.0 };
    assert_eq!(Twin::of(&fixture, &COARSE, range, |_| {}).err(), Some(FemError::NoGeometry));
    let fixture = Fixture::from_json(D0).unwrap();
    let options = MeshOptions { corner: 0, ..COARSE };
    assert_eq!(Twin::of(&fixture, &options, range, |_| {}).err(), Some(FemError::Options));
    let more = with(r#""physics": [{"kind": "joint_mass", "place": "J", "mass": 0.1}]"#);
    let error = Twin::of(&Fixture::from_json(&more).unwrap(), &COARSE, range, |_| {}).err().unwrap();
    assert!(error.to_string().contains("physics/0: `joint_mass`"), "{error}");
}

#[test]
fn the_deck_names_every_node_and_element_once() {
    let twin = twin(D0, MeshOptions { corner: 1, along: 3, across: 1, growth: 3.0, ..COARSE });
    let deck = calculix_deck(&twin.mesh, "a title", 7);
    let section =
        |start: &str| deck.split(start).nth(1).unwrap().split('*').next().unwrap().lines().skip(1).count();
    assert_eq!(section("*NODE, NSET=ALL"), twin.mesh.nodes.len());
    assert_eq!(section("*ELEMENT, TYPE=C3D20, ELSET=SET0"), 2 * twin.mesh.elements.len());
    assert!(deck.contains("*FREQUENCY\n7\n") && deck.contains("PLANE, 3, 3"));
}

#[test]
fn without_what_the_lumped_model_leaves_out_the_twin_is_the_lumped_model() {
    let all = Omissions { joint_mass: true, shear: true, plate_action: true, block_flexibility: true };
    let bare = twin(D0, MeshOptions { without: all, ..COARSE }).frequencies();
    let pairs = [FrfPair::transverse("4", "1")];
    // The lumped model's frequencies, where its accelerance peaks on a fine grid.
    let peak = |from: f64, to: f64| {
        let lines = SpectralLines::even(from, 0.05, ((to - from) / 0.05) as usize).unwrap();
        let frfs = lumped(D0, &pairs, &lines);
        let (line, _) =
            frfs.values(0).iter().enumerate().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
        lines.hz()[line]
    };
    let expected = [peak(60.0, 80.0), peak(350.0, 450.0)];
    for (found, expected) in bare.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 4e-3, "{found} Hz for {expected} Hz");
    }
    for one in [
        Omissions { joint_mass: true, ..NOTHING },
        Omissions { shear: true, ..NOTHING },
        Omissions { block_flexibility: true, ..NOTHING },
    ] {
        let stiffer = twin(D0, MeshOptions { without: one, ..COARSE }).frequencies();
        let full = twin(D0, COARSE).frequencies();
        assert!(stiffer[1] > full[1], "{one:?}: {stiffer:?} for {full:?}");
    }
}

#[test]
fn a_couple_on_either_block_turns_them_against_each_other_by_what_the_strip_bends() {
    let all = Omissions { joint_mass: true, shear: true, plate_action: true, block_flexibility: true };
    let bare = twin(D0, MeshOptions { without: all, ..COARSE });
    // One newton metre on B and its opposite on A.
    let (a, b) = ([-0.11, -0.03], [0.08, 0.17]);
    let (on_a, on_b) = (1.0 / (a[1] - a[0]), 1.0 / (b[1] - b[0]));
    let forces = [(0, a[0], on_a), (0, a[1], -on_a), (1, b[0], -on_b), (1, b[1], on_b)];
    let read = bare.deflections(&forces, &[(0, -0.09), (0, -0.05), (1, 0.1), (1, 0.15)]).unwrap();
    let turned = (read[3] - read[2]) / 0.05 - (read[1] - read[0]) / 0.04;
    let (length, bending) = (0.0651, 2.07e11 * 2.864708e-10);
    let expected = length / bending;
    assert!((turned / expected - 1.0).abs() < 5e-3, "{turned:e} rad for {expected:e} rad");
    // The strip leaves A straight: B's line, continued to its near end, is half that angle away over the
    // strip's length.
    let at = |x: f64, [(x0, y0), (x1, y1)]: [(f64, f64); 2]| y0 + (y1 - y0) * (x - x0) / (x1 - x0);
    let apart =
        at(length, [(0.1, read[2]), (0.15, read[3])]) - at(length, [(-0.09, read[0]), (-0.05, read[1])]);
    let expected = length * length / (2.0 * bending);
    assert!((apart / expected - 1.0).abs() < 5e-3, "{apart:e} m for {expected:e} m");
}
