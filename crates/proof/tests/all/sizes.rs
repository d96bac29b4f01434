//! Effects of stated sizes, and the limits of a test.

use crate::common::{judged, opened};
use jointscope_diagnosis::{Fit, Hypothesis, Observation};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture};
use jointscope_proof::{Case, Family, IndependentFits, Judged, Limits, Plan, Reference, Role, Score};

fn plan(graded: usize) -> Plan {
    Plan { cases: 8, graded, seed: 11, families: vec![Family::TwoBlocks], ..Plan::default() }
}

/// χ² and squared departures of the best fit of the quantities alone: by the diagnosis' own fits from what is
/// stated, or from the true quantities. Either may end in a false minimum, where tolerances imitate nearly
/// all of an effect or peaks are very sharp.
fn without_effects(case: &Case, truth: &Fixture, observation: &Observation) -> f64 {
    let start = Hypothesis::nominal(&case.believed, false);
    let fits = [true, false].into_iter().filter_map(|far| Fit::of(&start, observation, far));
    let bare = truth.clone().with_physics(Vec::new()).unwrap();
    fits.map(|fit| fit.objective).fold(about_the_truth(case, &bare, observation), f64::min)
}

fn about_the_truth(case: &Case, truth: &Fixture, observation: &Observation) -> f64 {
    Reference::of(&case.believed, truth, observation).unwrap().objective
}

#[test]
fn graded_effects_come_after_the_others_and_cost_about_what_they_should() {
    let (cases, truths) = opened(&plan(6));
    assert_eq!(opened(&plan(0)).0, cases[..8], "they leave the others as they are");
    for (case, truth) in cases.iter().zip(&truths).skip(8) {
        assert_eq!((truth.role, truth.effects().len()), (Role::Graded, 1));
        let observation = Observation::new(&case.recorded, |_| true).unwrap();
        let cost = without_effects(case, &truth.fixture, &observation)
            - about_the_truth(case, &truth.fixture, &observation);
        // Drawn between 3 and 300; chance moves the root by one or two.
        println!("{}: {cost:.1}", truth.hidden());
        assert!((-1.0..(300f64.sqrt() * 1.1 + 3.0).powi(2)).contains(&cost), "{}: {cost}", truth.hidden());
    }
}

#[test]
fn detection_is_counted_by_size_over_singles_and_graded_effects() {
    let (_, truths) = opened(&plan(16));
    let sized = |truth: &jointscope_proof::Truth, size: f64, found: bool| {
        let own = judged(truth, if found { truth.effects() } else { &[] });
        let fits =
            IndependentFits { refitted: 100.0 + size, without: vec![100.0 + size], ..own.fits.clone() };
        Judged { fits, ..own }
    };
    let all: Vec<Judged> = truths
        .iter()
        .enumerate()
        .map(|(i, truth)| sized(truth, if i % 2 == 0 { 7.0 } else { 70.0 }, i % 2 == 1))
        .collect();
    let detection = Score::of(&all).detection;
    let class = |from: f64| detection.classes.iter().find(|class| class.from == from).unwrap();
    let ones = all.iter().filter(|judged| judged.truth.role.is_of_one()).count();
    assert_eq!(class(5.0).named.of, 0);
    assert_eq!(class(50.0).named.of, class(50.0).named.all);
    assert_eq!(class(5.0).named.all + class(50.0).named.all, ones);
    let half = detection.half_named_from.unwrap();
    assert!((10.0..60.0).contains(&half), "{half}");
    // A bound of a hundredth of a mass at a Δχ² needs so many deviations.
    let mass = detection.smallest.iter().find(|s| s.kind == EffectKind::AddedMass).unwrap();
    let sure = detection.sure_from.unwrap();
    let singles =
        truths.iter().filter(|t| t.effects().len() == 1 && t.effects()[0].kind == EffectKind::AddedMass);
    let masses: Vec<f64> = singles.map(|t| 0.01 * t.effects()[0].value(1).abs() * sure.sqrt()).collect();
    let least = masses.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((mass.range[0] / least - 1.0).abs() < 1e-9 && mass.cases == masses.len());
}

#[test]
fn a_test_cannot_tell_a_soft_interface_in_translation_from_shear() {
    let (cases, _) = opened(&plan(0));
    let limits = Limits::of(&cases[1].believed, &cases[1].recorded).unwrap();
    let alike = [EffectKind::InterfaceCompliance, EffectKind::ShearDeformation];
    let both = |pair: &&jointscope_proof::Alike| {
        pair.names.iter().map(|name| name.kind).eq(alike) && pair.names[0].dof == Some(Dof::Translation)
    };
    let pairs: Vec<_> = limits.alike.iter().filter(both).collect();
    assert!(pairs.len() == 2 && pairs.iter().all(|pair| pair.angle_beyond_tolerances < 0.5), "{pairs:?}");
    for shown in &limits.smallest {
        let worse = if shown.is_upper {
            shown.shows <= shown.shows_if_exact
        } else {
            shown.shows >= shown.shows_if_exact
        };
        assert!(worse, "tolerances help nothing to show: {shown:?}");
    }
}

#[test]
fn the_smallest_effect_that_shows_costs_a_fit_without_it_what_was_stated() {
    // The limit is of first order; the laboratory and full fits are the check.
    let (cases, truths) = opened(&plan(0));
    let truth = &truths[1];
    // An analyst who happens to believe what is true: where peaks are sharper than the lines' spacing much
    // hangs on how near they fall.
    let case = &Case { believed: truth.fixture.clone(), ..cases[1].clone() };
    let limits = Limits::of(&case.believed, &case.recorded).unwrap();
    let mut checked = 0;
    for shown in &limits.smallest {
        // Of the others the best abscissa or frequency is not told. Dashpots count as none, a sensor's
        // damping ratio is the one that was tried.
        let more: &[f64] = match shown.name.kind {
            EffectKind::Footing => &[0.0],
            EffectKind::ChannelResonance => &[0.03],
            kind if kind.spec().parameters.len() > 1 || shown.parameter == "factor − 1" => continue,
            _ => &[],
        };
        let values = [&[shown.shows], more].concat();
        let effect = Effect::new(shown.name.kind, shown.name.place.clone(), shown.name.dof, &values);
        let with = truth.fixture.clone().with_physics(vec![effect]).unwrap();
        let (pairs, lines) = (case.recorded.pairs(), case.recorded.lines());
        let clean =
            jointscope_rig::frfs(&with, pairs, lines, jointscope_rig::Instrument::AsDescribed).unwrap();
        let observation = Observation::new(&truth.hammer.measure(&clean).unwrap(), |_| true).unwrap();
        let cost = without_effects(case, &with, &observation) - about_the_truth(case, &with, &observation);
        println!("{}: {cost:.1}", shown.name);
        // 50 was stated; chance moves its root by one or two.
        assert!((16.0..121.0).contains(&cost), "{}: Δχ² {cost}", shown.name);
        checked += 1;
    }
    assert!(checked >= 20, "{checked}");
}

#[test]
fn every_linear_kind_has_a_limit() {
    let (cases, _) = opened(&plan(0));
    let limits = Limits::of(&cases[1].believed, &cases[1].recorded).unwrap();
    // A wrong quantity is looked for where a refit takes it, at any size.
    let is_listed = |kind: &EffectKind| !kind.is_nonlinear() && *kind != EffectKind::QuantityError;
    for kind in EffectKind::ALL.into_iter().filter(is_listed) {
        let own: Vec<_> = limits.smallest.iter().filter(|shown| shown.name.kind == kind).collect();
        assert!(!own.is_empty(), "{}", kind.name());
        assert!(own.iter().all(|shown| shown.shows.is_finite() && shown.shows > 0.0), "{own:?}");
    }
    let force =
        |shown: &&jointscope_proof::SmallestShown| shown.name.place == jointscope_fixture::Place::Force;
    assert_eq!(
        limits.smallest.iter().filter(force).count(),
        4,
        "gain, delay, high-pass and resonance of the hammer"
    );
}
