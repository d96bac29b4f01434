//! The place of a mismatch, found with no law assumed, on recordings of the simulated laboratory.

use crate::common;
use jointscope::diagnosis::{Fit, Hypothesis, Location, Observation, Site, locate, measure};
use jointscope::fixture::{Dof, Effect, EffectKind, Place, Quantity};
use jointscope::{Fixture, FrfPair, SpectralLines, synthesize};

fn recorded(effects: Vec<Effect>, seed: u64) -> (Fixture, Observation) {
    let (believed, frfs) = common::recorded(effects, seed);
    (believed, Observation::new(&frfs, |_| true).unwrap())
}

fn located(effects: Vec<Effect>, seed: u64) -> (Fixture, Vec<Location>) {
    let (fixture, observation) = recorded(effects, seed);
    let nominal = Hypothesis::nominal(&fixture, false);
    let refitted = Fit::of(&nominal, &observation, true).unwrap();
    let all = locate(&nominal, &refitted, &observation);
    (fixture, all)
}

fn listed(all: &[Location]) -> String {
    all.iter().map(|l| format!("{:?}: {:.2}\n", l.site, l.chi2_per_dof)).collect()
}

#[test]
fn a_strong_added_mass_is_located_on_its_body_and_measured_as_minus_omega_squared_m() {
    let mass = 0.08;
    let hidden = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.118, mass]);
    let (fixture, all) = located(vec![hidden.clone()], 12);
    let best = &all[0];
    assert!(best.site.holds(&hidden, &fixture), "{}", listed(&all));
    assert!(best.p_value > 0.001, "p = {}: {}", best.p_value, listed(&all));
    let Site::Body { x, .. } = best.site else { unreachable!() };
    assert!((x - 0.118).abs() < 0.01, "at {x} m");
    let law = &best.laws[0];
    let told = &law.parameters[0];
    assert_eq!(told.name, "mass", "{law:?}");
    assert!((told.value - mass).abs() < 4.0 * told.std.max(0.003 * mass), "{told:?}");
    // Every line by itself, tolerances included: nearly all real parts within two and a half deviations.
    let inside = best.delta.iter().filter(|d| {
        let omega = std::f64::consts::TAU * d.frequency;
        (d.value.re + omega * omega * mass).abs() < 2.5 * d.std
    });
    let (inside, of) = (inside.count(), best.delta.len());
    assert!(of > 40 && inside as f64 > 0.85 * of as f64, "{inside} of {of} lines");
}

#[test]
fn a_wrong_place_leaves_misfit() {
    let hidden = Effect::new(EffectKind::ChannelGain, Place::Response("3".into()), None, &[0.8]);
    let (fixture, all) = located(vec![hidden.clone()], 14);
    assert!(all[0].site.holds(&hidden, &fixture), "{}", listed(&all));
    assert!(all[0].chi2_per_dof < 1.2, "{}", listed(&all));
    assert!(all.last().unwrap().chi2_per_dof > 10.0, "{}", listed(&all));
    let law = &all[0].laws[0];
    assert_eq!(law.parameters[0].name, "factor", "{law:?}");
    assert!((law.parameters[0].value - 0.8).abs() < 4.0 * law.parameters[0].std, "{law:?}");
}

#[test]
fn a_rotation_spring_at_a_joints_end_is_measured_as_the_same_stiffness_on_all_lines() {
    let hidden = Effect::new(
        EffectKind::InterfaceCompliance,
        Place::Point("3".into()),
        Some(Dof::Rotation),
        &[6000.0, 0.0],
    );
    let (fixture, all) = located(vec![hidden.clone()], 15);
    let at = all.iter().find(|l| l.site.holds(&hidden, &fixture)).unwrap();
    assert!(at.p_value > 0.001, "{}", listed(&all));
    let law = &at.laws[0];
    let told = &law.parameters[0];
    assert!((told.value / 6000.0 - 1.0).abs() < 0.1, "{law:?}");
    assert!(at.site.unit() == "N*m/rad" && told.unit == "N*m/rad");
}

#[test]
fn with_nothing_hidden_every_place_leaves_what_chance_leaves() {
    let (_, all) = located(Vec::new(), 11);
    assert!(all.len() >= 12, "{}", listed(&all));
    for location in &all {
        assert!(location.p_value > 0.001 && location.chi2_per_dof > 0.8, "{}", listed(&all));
    }
}

#[test]
fn without_noise_and_tolerance_every_line_gives_the_stiffness_that_was_put_there() {
    let mut believed = common::believed(common::RATIOS);
    for quantity in believed.quantities_mut() {
        *quantity.quantity = Quantity::bare(quantity.quantity.value);
    }
    let lines = SpectralLines::even(15.0, 15.0, 86).unwrap();
    for (mass, x) in [(-0.05, 0.11), (0.02, 0.07), (0.3, 0.13), (-0.004, 0.09)] {
        let hidden = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[x, mass]);
        let truth = believed.clone().with_physics(vec![hidden.clone()]).unwrap();
        let set =
            synthesize(&truth, &common::four_pairs(), &lines, jointscope::Instrument::AsRecorded).unwrap();
        let tiny = set.all_values().iter().map(|v| (1e-6 * v.norm()).powi(2)).collect();
        let observation = Observation::new(&set.with_variance(tiny).unwrap(), |_| true).unwrap();
        let hypothesis = Hypothesis::nominal(&believed, true).with(hidden);
        let repaired = Fit::of(&hypothesis, &observation, false).unwrap();
        let found = measure(&repaired, 0, &observation).unwrap();
        assert_eq!((found.delta.len(), found.masked), (lines.len(), 0));
        for line in &found.delta {
            let omega = std::f64::consts::TAU * line.frequency;
            let relative = (line.value / (-omega * omega * mass) - 1.0).norm();
            assert!(relative < 1e-9, "{mass} kg, {} Hz: {relative:e}", line.frequency);
        }
    }
}

#[test]
fn an_effect_of_higher_rank_has_no_single_stiffness_to_measure() {
    let (fixture, observation) = recorded(Vec::new(), 16);
    let bends = Effect::new(EffectKind::BodyFlexibility, Place::Body("B".into()), None, &[3000.0, 0.01]);
    let fit = Fit::of(&Hypothesis::nominal(&fixture, false).with(bends), &observation, false).unwrap();
    assert!(measure(&fit, 0, &observation).is_none());
}

#[test]
fn one_frf_alone_locates_nothing() {
    let (fixture, observation) = recorded(Vec::new(), 17);
    let one = observation.reduced(|_| true, |pair| *pair == FrfPair::transverse("4", "1")).unwrap();
    let nominal = Hypothesis::nominal(&fixture, false);
    let refitted = Fit::of(&nominal, &one, false).unwrap();
    assert!(locate(&nominal, &refitted, &one).is_empty());
}

/// The share of deviations, in units of what was stated for them, within one and within two.
fn covered(deviations: &[f64]) -> [f64; 2] {
    let within = |limit: f64| deviations.iter().filter(|d| d.abs() < limit).count() as f64;
    [1.0, 2.0].map(|limit| within(limit) / deviations.len() as f64)
}

/// Deviations of δ's real part on all lines told, and of the closest law's first parameter, with noise and
/// tolerances drawn anew.
fn deviations(hidden: &Effect, delta: &dyn Fn(f64) -> f64, parameter: f64) -> [Vec<f64>; 2] {
    let (mut lines, mut parameters) = (Vec::new(), Vec::new());
    for seed in 100..120 {
        let (fixture, all) = located(vec![hidden.clone()], seed);
        let at = all.iter().find(|l| l.site.holds(hidden, &fixture)).unwrap();
        lines.extend(at.delta.iter().map(|d| (d.value.re - delta(d.frequency)) / d.std));
        let law = at.laws.first().map(|law| law.parameters[0]);
        parameters.extend(law.map(|told| (told.value - parameter) / told.std));
    }
    [lines, parameters]
}

/// Twenty realisations of 86 lines each: 0.68 and 0.95 would be perfect. The lines of one realisation share
/// its tolerances, and a compliance that is hardly known is turned into a stiffness: there the lines cover
/// less.
#[test]
fn stated_deviations_cover_the_truth_about_as_often_as_they_should() {
    let squared = |hz: f64| (std::f64::consts::TAU * hz).powi(2);
    let body = Place::Body("B".into());
    let mass = Effect::new(EffectKind::AddedMass, body, None, &[0.118, 0.08]);
    let end = Place::Point("3".into());
    let spring = Effect::new(EffectKind::InterfaceCompliance, end, Some(Dof::Rotation), &[6000.0, 0.0]);
    let gain = Effect::new(EffectKind::ChannelGain, Place::Response("3".into()), None, &[0.8]);
    type Delta<'a> = &'a dyn Fn(f64) -> f64;
    let cases: [(Effect, Delta, f64, f64); 3] = [
        (mass, &|hz| -0.08 * squared(hz), 0.08, 0.85),
        (spring, &|_| 6000.0, 6000.0, 0.75),
        (gain, &|_| -0.2, 0.8, 0.85),
    ];
    for (hidden, delta, parameter, least) in cases {
        let [lines, parameters] = deviations(&hidden, delta, parameter);
        let ([one, two], of_laws) = (covered(&lines), covered(&parameters));
        let figures = format!("{}: lines {one:.2} {two:.2}, laws {of_laws:.2?}", hidden.kind.name());
        println!("{figures}");
        assert!(lines.len() > 1000 && parameters.len() >= 18, "{figures}");
        assert!(two > least && one > least - 0.35 && one < 0.85, "{figures}");
        assert!(of_laws[1] > 0.8 && of_laws[0] > 0.4, "{figures}");
    }
}

#[test]
fn what_a_law_leaves_is_never_negative_nor_its_deviation_unknown() {
    for (seed, factor) in [(21, 1.5), (22, 0.9), (23, 1.05)] {
        let hidden = Effect::new(EffectKind::StiffnessChange, Place::Joint("J".into()), None, &[factor]);
        let (_, all) = located(vec![hidden], seed);
        assert!(all.iter().any(|location| !location.laws.is_empty()), "{}", listed(&all));
        for law in all.iter().flat_map(|location| &location.laws) {
            assert!(law.chi2_per_dof >= 0.0, "{law:?}");
            assert!(law.parameters.iter().all(|p| p.std.is_finite() && p.value.is_finite()), "{law:?}");
        }
    }
}
