//! Plans of structures for which pencil and paper tell what a measurement is worth.
#![allow(clippy::unwrap_used, missing_docs)]

use jointscope_diagnosis::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place, Quantity, QuantityKey};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_plan::{
    Measure, Plan, PlanError, PlanOptions, Remaining, Start, Weighed, WeighedName, weighed_by,
};
use jointscope_samples::transverse;
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;

/// Masses of 2 kg and 3 kg on a spring of 5 MN/m, everything exact.
fn chain() -> Fixture {
    Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": {"value": 2.0, "std": 0.0}, "rotates": false }, "B": { "mass": {"value": 3.0, "std": 0.0}, "rotates": false } },
             "points": { "1": { "body": "A", "x": {"value": 0, "std": 0.0} }, "2": { "body": "B", "x": {"value": 0.1, "std": 0.0} } },
             "joints": { "J": { "from": "1", "to": "2", "stiffness": [[{"value": 5e6, "std": 0.0}, {"value": 0.0, "std": 0.0}], [{"value": 0.0, "std": 0.0}, {"value": 0.0, "std": 0.0}]] } },
             "damping": { "modal_ratios": [{"value": 0.02, "std": 0.0}] } }"#,
    )
    .unwrap()
}

fn blocks() -> Fixture {
    Fixture::from_json(include_str!("../../../fixtures/two-blocks/fixture.json")).unwrap()
}

const LINES: usize = 200;
/// Noise of each value, relative.
const NOISE: f64 = 1e-2;

fn lines() -> SpectralLines {
    SpectralLines::even(5.0, 5.0, LINES).unwrap()
}

/// What `truth` shows, without noise but with the variance of some.
fn recorded(truth: &Fixture, pairs: &[(&str, &str)]) -> Observation {
    let pairs = transverse(pairs);
    let frfs = synthesize(truth, &pairs, &lines(), Instrument::AsRecorded).unwrap();
    let variance = frfs.all_values().iter().map(|v| NOISE * NOISE * v.norm_sqr()).collect();
    Observation::new(&frfs.with_variance(variance).unwrap(), |_| true).unwrap()
}

/// Two names as probable as each other, the first one true.
fn remaining(fixture: &Fixture, names: [Effect; 2], pairs: &[(&str, &str)]) -> Remaining {
    let truth = fixture.clone().with_physics(vec![names[0].clone()]).unwrap();
    Remaining {
        repaired: Hypothesis::nominal(fixture, false).with(names[0].clone()),
        index: 0,
        names: names.map(|name| (name, 0.48)).to_vec(),
        observation: recorded(&truth, pairs),
        model_error: None,
    }
}

fn gain(place: Place, factor: f64) -> Effect {
    Effect::new(EffectKind::ChannelGain, place, None, &[factor])
}

#[test]
fn gains_of_two_sensors_are_told_apart_by_a_driving_point_as_the_closed_form_says() {
    // FRFs 2/1 and 2/2: a gain of response 2, or one of the force.
    let factor = 1.03;
    let (sensor, force) = (gain(Place::Response("2".into()), factor), gain(Place::Force, 1.0 / factor));
    let remaining = remaining(&chain(), [sensor, force], &[("2", "1"), ("2", "2")]);
    let plan = Plan::between(&chain(), &remaining, &PlanOptions::default()).unwrap();
    // FRF 1/1 is H by the one name and g·H by the other, whose g the present FRFs tell: ln g to a deviation
    // of ε/√(4N).
    let n = 2.0 * LINES as f64;
    let noise = NOISE * NOISE * 0.5 * (1.0 + factor * factor);
    let d2 = n * (factor - 1.0).powi(2) / noise;
    let a2 = n * factor * factor / noise * NOISE * NOISE / (2.0 * n);
    let widened = 0.5 * (d2 - d2 * a2 / (1.0 + a2) - a2 / (1.0 + a2) + (1.0 + a2).ln());
    let exact = 0.5 * (d2 + a2 - (1.0 + a2).ln());
    let expected = 0.5 * (widened + exact);
    let of = |name: &str| plan.suggestions.iter().find(|s| s.measure == name).unwrap();
    let found = of("frf 1/1").expected_log_odds.unwrap();
    assert!((found / expected - 1.0).abs() < 0.01, "{found} nats, {expected} by the closed form");
    assert!(of("frf 1/1").sure.unwrap() > 0.97);
    // More averages of what both names say alike tell nothing.
    assert!(plan.suggestions.iter().all(|s| s.measure != "averages times 4"));
    assert_eq!(plan.suggestions[0].action.frfs().len(), 1, "{}", plan.suggestions[0].says);
    assert!(plan.not_by_frfs.is_empty(), "{}", plan.says);
}

#[test]
fn compliance_at_either_end_of_a_joint_is_told_apart_by_no_frf_and_the_plan_says_so() {
    let at = |point: &str| {
        Effect::new(
            EffectKind::InterfaceCompliance,
            Place::Point(point.into()),
            Some(jointscope_fixture::Dof::Translation),
            &[2e7, 0.0],
        )
    };
    let remaining = remaining(&blocks(), [at("2"), at("3")], &[("4", "1"), ("3", "2")]);
    let plan = Plan::between(&blocks(), &remaining, &PlanOptions::default()).unwrap();
    assert_eq!(plan.not_by_frfs.len(), 1, "{}", plan.says);
    assert!(plan.says.contains("No FRF of this test separates them."), "{}", plan.says);
    assert!(plan.suggestions.iter().all(|s| s.sure.unwrap() < 0.5), "{:?}", plan.suggestions);
}

#[test]
fn a_mass_that_was_added_and_one_that_was_stated_wrongly_are_told_apart_by_the_scales() {
    let text = r#"{ "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
             "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 } },
             "joints": { "J": { "from": "1", "to": "2", "stiffness": [[{"value": 5e6, "std": 1e4}, 0.0], [0.0, 0.0]] } },
             "damping": { "modal_ratios": [0.02] } }"#;
    let fixture = Fixture::from_json(text).unwrap();
    let added = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.15]);
    let place = Place::Quantity("bodies/B/mass".into(), QuantityKey::Mass);
    let wrong = Effect::new(EffectKind::QuantityError, place, None, &[3.15]);
    let remaining = remaining(&fixture, [added, wrong], &[("2", "1"), ("1", "1")]);
    let plan = Plan::between(&fixture, &remaining, &PlanOptions::default()).unwrap();
    let first = &plan.suggestions[0];
    assert!(
        matches!(&first.action, Measure::Quantity { path, .. } if path == "bodies/B/mass"),
        "{}",
        first.says
    );
    assert!(first.sure.unwrap() > 0.95 && !plan.not_by_frfs.is_empty(), "{}", plan.says);
}

#[test]
fn the_interval_of_a_spring_is_that_of_its_resonance() {
    // H₂₁ = 1/M + ω²/M/(ω₀² − ω² + 2iζω₀ω), ω₀² = k/μ, and everything but k is exact.
    let wanted = "J/k11=1%".parse().unwrap();
    let options = PlanOptions::default();
    let plan = Plan::for_interval(&chain(), &Start::Lines(&lines()), &wanted, &options).unwrap();
    let h = |k: f64, omega: f64| {
        let natural = (k / 1.2).sqrt();
        let below = Complex64::new(natural * natural - omega * omega, 2.0 * 0.02 * natural * omega);
        0.2 + 0.2 * omega * omega / below
    };
    let hz = lines();
    let mean = hz.omegas().map(|w| h(5e6, w).norm_sqr()).sum::<f64>() / LINES as f64;
    let information: f64 = hz
        .omegas()
        .map(|w| {
            let slope = (h(5e6 + 10.0, w) - h(5e6 - 10.0, w)) / 20.0;
            let variance = 9e-6 * mean + 9e-6 * h(5e6, w).norm_sqr();
            2.0 * slope.norm_sqr() / variance
        })
        .sum();
    let expected = 1.96 / information.sqrt();
    let found = plan.suggestions.iter().find(|s| s.measure == "frf 2/1").unwrap().interval.clone().unwrap();
    assert!((found.then / expected - 1.0).abs() < 0.01, "{} by the closed form {expected}", found.then);
    assert!(found.reaches && found.now.is_none());
}

#[test]
fn a_further_test_with_a_known_mass_says_of_the_names_what_its_frfs_can_tell() {
    let (sensor, hammer) =
        (gain(Place::Response("2".into()), 1.03), gain(Place::Reference("1".into()), 1.0 / 1.03));
    let fixture = chain();
    let remaining = remaining(&fixture, [sensor.clone(), hammer], &[("2", "1")]);
    let with = |mut physics: Vec<Effect>| {
        physics.insert(0, Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 1.0]));
        fixture.clone().with_physics(physics).unwrap()
    };
    let probability_of_the_sensor = |frf: (&str, &str)| {
        let observation = recorded(&with(vec![sensor.clone()]), &[frf]);
        let options = PlanOptions::default();
        let weighed = weighed_by(&fixture, &remaining, (&with(Vec::new()), &observation), &options).unwrap();
        let of_the_sensor = |name: &&WeighedName| name.effect.place == sensor.place;
        assert!(weighed.is_met, "{}", weighed.says);
        weighed.names.iter().find(of_the_sensor).unwrap().probability
    };
    // The same FRF has both channels in it, mass or no mass, and the force beside them; the driving point has
    // no sensor 2.
    assert!((probability_of_the_sensor(("2", "1")) - 0.32).abs() < 0.01);
    assert!(probability_of_the_sensor(("1", "1")) > 0.9);
}

/// The two names and a further FRF 1/1 that `truth` makes of the chain's state as the fixture has it.
fn weighed_by_a_driving_point(ratio: Quantity, truth: impl Fn(&Fixture) -> Fixture) -> Weighed {
    let (sensor, hammer) =
        (gain(Place::Response("2".into()), 1.03), gain(Place::Reference("1".into()), 1.0 / 1.03));
    let mut fixture = chain();
    let ratios = |fixture: &mut Fixture, ratio: Quantity| {
        let mut quantities = fixture.quantities_mut();
        *quantities.iter_mut().find(|q| q.key == QuantityKey::ModalRatio(0)).unwrap().quantity = ratio;
    };
    ratios(&mut fixture, ratio);
    let remaining = remaining(&fixture, [sensor.clone(), hammer], &[("2", "1")]);
    let mut other = truth(&fixture);
    ratios(&mut other, Quantity::bare(0.022));
    let physics = [other.physics(), &[sensor]].concat();
    let observation = recorded(&other.with_physics(physics).unwrap(), &[("1", "1")]);
    weighed_by(&fixture, &remaining, (&fixture, &observation), &PlanOptions::default()).unwrap()
}

#[test]
fn a_further_test_has_damping_ratios_of_its_own_and_what_no_name_meets_is_told() {
    let free = weighed_by_a_driving_point(Quantity::with_std(0.02, 0.004), Fixture::clone);
    assert!(free.is_met && free.chi2_per_dof < 0.01, "{}", free.says);
    assert!(free.is_settled() && free.names[0].effect.place == Place::Response("2".into()), "{}", free.says);
    assert!(free.says.starts_with("With both tests it is"), "{}", free.says);
    // Stated to a thousandth of what differs, and a mass that the second fixture forgot.
    let exact = weighed_by_a_driving_point(Quantity::with_std(0.02, 2e-6), Fixture::clone);
    let forgotten = weighed_by_a_driving_point(Quantity::with_std(0.02, 0.004), |fixture| {
        let mass = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.2]);
        fixture.clone().with_physics(vec![mass]).unwrap()
    });
    for weighed in [exact, forgotten] {
        assert!(!weighed.is_met && !weighed.is_settled(), "{}", weighed.says);
        assert!(weighed.says.starts_with("No name meets the further test"), "{}", weighed.says);
        assert!(weighed.names.iter().all(|name| name.probability < 0.05), "{:?}", weighed.names);
    }
}

#[test]
fn a_point_that_is_not_there_and_a_dashpot_that_is_not_stated_are_named() {
    let (sensor, hammer) =
        (gain(Place::Response("2".into()), 1.03), gain(Place::Reference("1".into()), 0.97));
    let remaining = remaining(&chain(), [sensor, hammer], &[("2", "1")]);
    let options = PlanOptions { points: vec!["9".into()], ..PlanOptions::default() };
    let error = Plan::between(&chain(), &remaining, &options).unwrap_err();
    assert!(matches!(&error, PlanError::UnknownPoint { point, .. } if point == "9"), "{error}");
    let wanted = "J/c11=1%".parse().unwrap();
    let error =
        Plan::for_interval(&chain(), &Start::Lines(&lines()), &wanted, &PlanOptions::default()).unwrap_err();
    assert!(error.to_string().contains("states no dashpots"), "{error}");
}

#[test]
fn with_one_reference_the_force_of_all_references_is_a_name_too_and_takes_two_frfs() {
    let (sensor, hammer) =
        (gain(Place::Response("2".into()), 1.03), gain(Place::Reference("1".into()), 1.0 / 1.03));
    let remaining = remaining(&chain(), [sensor, hammer], &[("2", "1")]);
    let plan = Plan::between(&chain(), &remaining, &PlanOptions::default()).unwrap();
    assert!(plan.names.iter().any(|name| name.effect.place == Place::Force), "{}", plan.question);
    assert!((plan.names.iter().map(|name| name.probability).sum::<f64>() - 0.96).abs() < 1e-9);
    // 1/1 has only the hammer of the one name and of the force, 1/2 that of the force alone, 2/2 the sensor
    // and the force.
    let first = &plan.suggestions[0];
    assert!(matches!(&first.action, Measure::Frfs { frfs } if frfs.len() == 2), "{}", first.says);
    assert!(first.sure.unwrap() > 0.95 && plan.not_by_frfs.is_empty(), "{}", first.says);
    let alone = plan.suggestions.iter().filter(|s| matches!(s.action, Measure::Frf { .. }));
    alone.for_each(|s| assert!(s.sure.unwrap() < 0.7, "{}", s.says));
}

#[test]
fn a_stiffness_that_the_recording_does_not_determine_is_said_to_be_so_instead_of_an_interval_without_end() {
    let wanted = "J/k11=1%".parse().unwrap();
    // One mass alone in a band far below the only resonance: the spring between the masses is not seen.
    let far_below = SpectralLines::even(1e-3, 1e-3, 20).unwrap();
    let pairs = transverse(&[("1", "1")]);
    let frfs = synthesize(&chain(), &pairs, &far_below, Instrument::AsRecorded).unwrap();
    let variance = frfs.all_values().iter().map(|v| NOISE * NOISE * v.norm_sqr()).collect();
    let blind = Observation::new(&frfs.with_variance(variance).unwrap(), |_| true).unwrap();
    let plan =
        Plan::for_interval(&chain(), &Start::Recorded(&blind), &wanted, &PlanOptions::default()).unwrap();
    assert!(plan.says.ends_with("What was recorded does not determine it."), "{}", plan.says);
    assert!(plan.suggestions.iter().all(|s| s.interval.as_ref().is_none_or(|i| i.then <= 5e7)));
    let seen = recorded(&chain(), &[("1", "1")]);
    let plan =
        Plan::for_interval(&chain(), &Start::Recorded(&seen), &wanted, &PlanOptions::default()).unwrap();
    assert!(!plan.says.contains("does not determine"), "{}", plan.says);
}
