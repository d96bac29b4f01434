//! Where along a beam a finding may sit: mirrored places that no FRF of the test tells apart, and one that
//! does.

use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Estimate, Finding};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::lumped::{Instrument, synthesize};
use jointscope::{Fixture, FrfPair, FrfSet, Says, SpectralLines};

/// A free steel bar of half a metre, as well known at one end as at the other.
const BAR: &str = r#"{
  "bodies": { "bar": { "beam": { "from": 0.0, "to": 0.5, "youngs_modulus": {"value": 2.07e11, "std": 2e9}, "second_moment": 1.6e-9,
                                 "mass_per_length": {"value": 1.88, "std": 0.01} } } },
  "points": { "1": { "body": "bar", "x": 0.03 }, "2": { "body": "bar", "x": 0.47 }, "3": { "body": "bar", "x": 0.2 } },
  "joints": {}, "damping": { "modal_ratios": [0.002] } }"#;

/// FRFs known to 0.2 %, of the bar as it is and with a lump of 20 g at 0.13 m.
fn before_and_after(pairs: &[(&str, &str)]) -> (Fixture, [FrfSet; 2]) {
    let bar = Fixture::from_json(BAR).unwrap();
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("bar".into()), None, &[0.13, 0.02]);
    let pairs: Vec<FrfPair> = pairs.iter().map(|(o, i)| FrfPair::transverse(o, i)).collect();
    let lines = SpectralLines::even(20.0, 1.25, 1200).unwrap();
    let recorded = [vec![], vec![lump]].map(|physics| {
        let truth = bar.clone().with_physics(physics).unwrap();
        let frfs = synthesize(&truth, &pairs, &lines, Instrument::AsRecorded).unwrap();
        let variance = frfs.all_values().iter().map(|value| 4e-6 * value.norm_sqr()).collect();
        frfs.with_variance(variance).unwrap()
    });
    (bar, recorded)
}

/// The lump as it is found, against the bar without it or by itself, where lines tell all.
fn found(pairs: &[(&str, &str)], against: bool) -> Finding {
    let (bar, [before, after]) = before_and_after(pairs);
    let options = DiagnosisOptions { baseline: against.then_some(before), ..DiagnosisOptions::default() };
    let diagnosis = Diagnosis::of(&bar, &after, &options).unwrap();
    let [finding] = &diagnosis.findings[..] else { panic!("{}", diagnosis.says()) };
    assert_eq!(finding.effect.kind, EffectKind::AddedMass, "{}", diagnosis.says());
    finding.clone()
}

/// Place and size, each with its interval, of a finding or of the same elsewhere.
fn place_and_mass(estimates: &[Estimate]) -> [(f64, [f64; 2]); 2] {
    [0, 1].map(|parameter| (estimates[parameter].value, estimates[parameter].interval.unwrap()))
}

#[test]
fn mirrored_places_are_both_stated_where_the_only_frf_is_its_own_mirror_image() {
    // The transfer FRF between two ends alike is the same with a mass at x as with one at L − x: reciprocity.
    for against in [true, false] {
        let finding = found(&[("2", "1")], against);
        let [other] = &finding.evidence.elsewhere[..] else { panic!("{}", finding.says()) };
        let [(x, place), (_, mass)] = place_and_mass(&finding.estimates);
        let [(mirrored, _), _] = place_and_mass(&other.estimates);
        let nearer = x.min(mirrored);
        assert!((x + mirrored - 0.5).abs() < 2e-3 && (nearer - 0.13).abs() < 2e-3, "{}", finding.says());
        assert!((other.share - 0.5).abs() < 0.02, "{}", finding.says());
        let truth = if x < 0.25 { 0.13 } else { 0.37 };
        assert!(place[0] <= truth && truth <= place[1], "{}", finding.says());
        assert!(mass[0] <= 0.02 && 0.02 <= mass[1], "{}", finding.says());
        assert!(finding.says().contains("it may also sit at x = "), "{}", finding.says());
    }
}

#[test]
fn an_frf_that_is_not_its_own_mirror_image_tells_the_places_apart() {
    for against in [true, false] {
        let finding = found(&[("2", "1"), ("3", "1")], against);
        assert!(finding.evidence.elsewhere.is_empty(), "{}", finding.says());
        assert!((finding.estimates[0].value - 0.13).abs() < 2e-3, "{}", finding.says());
    }
}
