//! The diagnosis on recordings of the simulated laboratory, whose hidden physics it is not told.

use crate::common::recorded;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Dof, Effect, EffectKind, Place};
use jointscope::{Fixture, Says};

fn diagnose(effects: Vec<Effect>, seed: u64) -> Diagnosis {
    let (fixture, frfs) = recorded(effects, seed);
    Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap()
}

#[test]
fn nothing_hidden_is_called_consistent_and_the_refit_stays_within_the_tolerances() {
    let diagnosis = diagnose(Vec::new(), 11);
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{:?}", diagnosis.findings);
    assert!(diagnosis.refitted.1 > 0.001, "p = {}", diagnosis.refitted.1);
    let refitted = &diagnosis.search.refitted.hypothesis;
    for (index, tolerance) in refitted.tolerances().iter().enumerate() {
        let departure = refitted.departure(index);
        assert!(departure.abs() < 4.0, "{} went {departure} deviations away", tolerance.quantity.path);
    }
    assert!(diagnosis.residual_correlation.abs() < 0.15, "{}", diagnosis.residual_correlation);
}

#[test]
fn a_forgotten_mass_is_found_with_its_place_size_and_a_prediction_of_what_was_held_out() {
    let hidden = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, 0.05]);
    let diagnosis = diagnose(vec![hidden], 12);
    assert_eq!(diagnosis.verdict, Verdict::Explained);
    assert_eq!(diagnosis.findings.len(), 1, "{:?}", diagnosis.findings);
    let finding = &diagnosis.findings[0];
    assert_eq!(
        (finding.effect.kind, &finding.effect.place),
        (EffectKind::AddedMass, &Place::Body("B".into()))
    );
    let mass = &finding.estimates[1];
    let [low, high] = mass.interval.unwrap();
    assert!(mass.unit == "kg" && (low..high).contains(&0.05), "{low} to {high} kg");
    assert!(finding.probability > 0.5, "{}", finding.probability);
    let held_out = diagnosis.held_out.as_ref().unwrap();
    // What is left is the noise of the held-out values.
    assert!(held_out.nrmse_repaired < 0.5 * held_out.nrmse_refitted, "{held_out:?}");
}

#[test]
fn a_mass_on_the_face_of_a_block_is_told_with_its_height_above_the_axis() {
    let lump =
        |height| Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, 0.06, height]);
    let diagnosis = diagnose(vec![lump(0.03)], 12);
    let [finding] = &diagnosis.findings[..] else { panic!("{:?}", diagnosis.findings) };
    assert!(finding.effect.is_named_as(&lump(0.03)) && finding.probability > 0.9, "{}", finding.says());
    for (estimate, truth) in finding.estimates.iter().zip([0.11, 0.06, 0.03]) {
        let [low, high] = estimate.interval.unwrap();
        assert!((low..high).contains(&truth) && low > 0.0, "{low} to {high}: {truth}");
    }
    assert!(finding.says().contains("off the body's axis"), "{}", finding.says());
    let diagnosis = diagnose(vec![lump(0.0)], 12);
    assert!(!diagnosis.says().contains("off the body's axis"), "{}", diagnosis.says());
}

#[test]
fn names_that_the_data_cannot_tell_apart_come_back_together() {
    let hidden = Effect::new(
        EffectKind::InterfaceCompliance,
        Place::Point("3".into()),
        Some(Dof::Translation),
        &[9e6, 0.0],
    );
    let diagnosis = diagnose(vec![hidden], 13);
    let finding = &diagnosis.findings[0];
    let mut names: Vec<(EffectKind, Place)> =
        finding.alternatives.iter().map(|(effect, _)| (effect.kind, effect.place.clone())).collect();
    names.push((finding.effect.kind, finding.effect.place.clone()));
    // A translation spring at either end of a massless joint is one and the same, and shear is too.
    for end in ["2", "3"] {
        assert!(names.contains(&(EffectKind::InterfaceCompliance, Place::Point(end.into()))), "{names:?}");
    }
    assert!(names.contains(&(EffectKind::ShearDeformation, Place::Joint("J".into()))), "{names:?}");
    let sum: f64 = finding.probability + finding.alternatives.iter().map(|(_, p)| p).sum::<f64>();
    assert!(sum < 1.0 && finding.probability < 0.7, "{} of {sum}", finding.probability);
}

#[test]
fn the_repaired_fixture_is_a_fixture_file_with_the_effect_in_its_physics() {
    let hidden = Effect::new(EffectKind::ChannelGain, Place::Response("3".into()), None, &[0.8]);
    let diagnosis = diagnose(vec![hidden], 14);
    let repaired = diagnosis.search.repaired.hypothesis.to_fixture().unwrap();
    let text = repaired.to_json();
    let again = Fixture::from_json(&text).unwrap();
    assert_eq!(again.physics().len(), 1);
    assert!((again.physics()[0].value(0) - 0.8).abs() < 0.01, "{text}");
}
