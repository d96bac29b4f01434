//! The lumped model against the simulated laboratory, which shares no code with it, and both against
//! recordings that neither made, where they are at hand.

use jointscope::fixture::EffectKind;
use jointscope::{Fixture, FrfSet, Instrument, SpectralLines, synthesize};
use jointscope_rig::{Family, drawn_within_tolerance, frfs, generator, random_effect};

fn relative_error(a: &FrfSet, b: &FrfSet, index: usize) -> f64 {
    let mean = b.values(index).iter().map(|v| v.norm_sqr()).sum::<f64>() / b.lines().len() as f64;
    let worst = a.values(index).iter().zip(b.values(index)).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
    worst / mean.sqrt()
}

/// Largest difference, relative to an FRF's rms, that the two discretisations may have.
fn allowed(kind: EffectKind) -> f64 {
    match kind {
        // Sixteen elements of a joint's mass on either side, summed in another order.
        EffectKind::JointMass => 1e-5,
        _ => 2e-7,
    }
}

#[test]
fn every_linear_effect_at_random_places_of_random_fixtures_means_the_same_to_both() {
    let mut random = generator(20_261);
    let families = [Family::TwoBlocks, Family::SupportedTwoBlocks, Family::ThreeBlocks, Family::Frame];
    let lines = SpectralLines::even(5.0, 5.0, 200).unwrap();
    let mut compared = [0usize; EffectKind::ALL.len()];
    for round in 0..4 {
        for family in families {
            let nominal = family.draw("random", &mut random).unwrap();
            let truth = drawn_within_tolerance(&nominal, &mut random).unwrap();
            let pairs = family.usual_pairs();
            for (slot, kind) in EffectKind::ALL.into_iter().enumerate().filter(|(_, k)| !k.is_nonlinear()) {
                let Some(effect) = random_effect(&mut random, &truth, kind, &pairs).unwrap() else {
                    continue;
                };
                let fixture = truth.clone().with_physics(vec![effect.clone()]).unwrap();
                let lumped = synthesize(&fixture, &pairs, &lines, Instrument::AsRecorded).unwrap();
                let rig = frfs(&fixture, &pairs, &lines, jointscope_rig::Instrument::AsDescribed).unwrap();
                compared[slot] += 1;
                for index in 0..pairs.len() {
                    let error = relative_error(&lumped, &rig, index);
                    assert!(
                        error < allowed(kind),
                        "round {round}, {family:?}, {effect:?}: FRF {} differs by {error:e}",
                        pairs[index]
                    );
                }
            }
        }
    }
    for (slot, kind) in EffectKind::ALL.into_iter().enumerate().filter(|(_, k)| !k.is_nonlinear()) {
        assert!(compared[slot] > 0, "{} was never compared", kind.name());
    }
}

#[test]
fn a_mass_on_the_face_of_a_block_means_the_same_to_both() {
    let fixture = |height: f64| {
        let text = format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 }} }},
                 "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
                 "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
                 "damping": {{ "modal_ratios": [0.005] }},
                 "physics": [{{ "kind": "added_mass", "place": "B", "x": 0.12, "mass": 0.05, "height": {height} }}] }}"#
        );
        Fixture::from_json(&text).unwrap()
    };
    let lines = SpectralLines::even(5.0, 5.0, 400).unwrap();
    let pairs = [("4", "1"), ("1", "1"), ("4", "4")].map(|(o, i)| jointscope::FrfPair::transverse(o, i));
    let lumped = |height: f64| synthesize(&fixture(height), &pairs, &lines, Instrument::Perfect).unwrap();
    let rig = frfs(&fixture(0.03), &pairs, &lines, jointscope_rig::Instrument::Perfect).unwrap();
    for index in 0..pairs.len() {
        assert!(relative_error(&lumped(0.03), &rig, index) < 2e-7, "{}", pairs[index]);
        assert!(relative_error(&lumped(0.0), &rig, index) > 1e-3, "a height that does nothing");
    }
}

#[test]
fn a_layer_along_a_foot_means_the_same_to_both() {
    let strip = |physics: &str| {
        let text = format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 }} }},
                 "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
                 "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
                 "damping": {{ "modal_ratios": [0.005] }}, "physics": [{physics}] }}"#
        );
        Fixture::from_json(&text).unwrap()
    };
    let end = |point: &str, spread: f64| {
        format!(
            r#"{{"kind": "interface_compliance", "place": "{point}", "dof": "rotation", "stiffness": 5e3, "damping": 0.2, "spread": {spread}}}"#
        )
    };
    let mass = r#"{"kind": "joint_mass", "place": "J", "mass": 0.05}"#;
    let lines = SpectralLines::even(5.0, 5.0, 400).unwrap();
    let pairs = [("4", "1"), ("1", "1"), ("4", "4")].map(|(o, i)| jointscope::FrfPair::transverse(o, i));
    for (spreads, mass) in [([1.0, 0.0], ""), ([0.0, 1.0], ""), ([1.0, 0.7], ""), ([1.0, 1.0], mass)] {
        let mut physics = vec![end("2", spreads[0]), end("3", spreads[1])];
        physics.extend((!mass.is_empty()).then(|| mass.to_owned()));
        let fixture = strip(&physics.join(", "));
        let lumped = synthesize(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
        let rig = frfs(&fixture, &pairs, &lines, jointscope_rig::Instrument::Perfect).unwrap();
        let hinged = synthesize(
            &strip(&[end("2", 0.0), end("3", 0.0)].join(", ")),
            &pairs,
            &lines,
            Instrument::Perfect,
        );
        for index in 0..pairs.len() {
            let error = relative_error(&lumped, &rig, index);
            assert!(error < 1e-5, "{spreads:?}: FRF {} differs by {error:e}", pairs[index]);
            assert!(
                relative_error(&lumped, hinged.as_ref().unwrap(), index) > 1e-3,
                "a spread that does nothing"
            );
        }
    }
}

#[test]
fn the_open_cases_true_structures_respond_as_their_simulator_says() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/concealed/open");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no cases at {}", folder.display());
        return;
    };
    let mut cases: Vec<_> = entries.filter_map(|e| e.ok()).map(|e| e.path()).filter(|p| p.is_dir()).collect();
    cases.sort();
    for case in cases {
        let text = |name: &str| std::fs::read_to_string(case.join(name)).unwrap();
        let truth: serde_json::Value = serde_json::from_str(&text("truth.json")).unwrap();
        let mut fixture: serde_json::Value = serde_json::from_str(&text("fixture.json")).unwrap();
        fixture["physics"] = truth["effects"].clone();
        let mut fixture = Fixture::from_value(&fixture).unwrap();
        if fixture.physics().iter().any(|e| e.kind.is_nonlinear()) {
            continue;
        }
        for quantity in fixture.quantities_mut() {
            if let Some(value) = truth["true_quantities"][&quantity.path]["true"].as_f64() {
                quantity.quantity.value = value;
            }
        }
        let unseen = jointscope::read(&fixture, &std::fs::read(case.join("unseen.uff")).unwrap()).unwrap();
        let unseen = unseen.frfs().unwrap();
        let found = synthesize(&fixture, unseen.pairs(), unseen.lines(), Instrument::Perfect).unwrap();
        let kinds: Vec<_> = fixture.physics().iter().map(|e| e.kind).collect();
        // Their joint mass is six elements, their bending mode was normalised numerically.
        let allowed = match kinds.first() {
            Some(EffectKind::JointMass) => 2e-3,
            Some(EffectKind::BodyFlexibility) => 5e-4,
            _ => 1e-8,
        };
        let error = (0..unseen.pairs().len()).map(|i| relative_error(&found, unseen, i)).fold(0.0, f64::max);
        println!("{}: {error:.1e} {kinds:?}", case.file_name().unwrap().to_string_lossy());
        assert!(error < allowed, "{}: {error:e}", case.display());
    }
}
