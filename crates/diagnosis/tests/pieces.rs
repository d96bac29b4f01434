//! The pieces of a diagnosis, each by itself.
#![allow(clippy::unwrap_used, missing_docs)]

use jointscope_diagnosis::{Fit, Hypothesis, Observation, catalogue};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Motion, Place, Starts};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

fn fixture() -> Fixture {
    Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": {"value": 1.1, "std": 0.002}, "inertia": {"value": 9.5e-4, "std": 4e-6}, "x_cg": {"value": -0.03, "std": 1e-4} },
                         "B": { "mass": {"value": 1.2, "std": 0.0}, "inertia": {"value": 9.9e-4, "std": 0.0}, "x_cg": {"value": 0.095, "std": 0.0} } },
             "points": { "1": { "body": "A", "x": {"value": -0.06, "std": 0.0} }, "2": { "body": "A", "x": {"value": 0, "std": 0.0} },
                         "3": { "body": "B", "x": {"value": 0.065, "std": 0.0} }, "4": { "body": "B", "x": {"value": 0.125, "std": 0.0} } },
             "joints": { "J": { "from": "2", "to": "3",
               "beam": { "youngs_modulus": {"value": 2e11, "std": 4e9}, "second_moment": {"value": 4e-10, "std": 6e-12} } } },
             "damping": { "modal_ratios": [{"value": 0.006, "std": 0.001}] } }"#,
    )
    .unwrap()
}

/// The FRFs of `truth` with stated variances of a thousandth of their mean square, and no noise.
fn recorded(truth: &Fixture) -> FrfSet {
    let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i));
    let lines = SpectralLines::even(10.0, 10.0, 120).unwrap();
    let frfs = synthesize(truth, &pairs, &lines, Instrument::AsRecorded).unwrap();
    let variance = (0..4)
        .flat_map(|i| {
            let mean = frfs.values(i).iter().map(|v| v.norm_sqr()).sum::<f64>() / 120.0;
            vec![1e-6 * mean; 120]
        })
        .collect();
    frfs.with_variance(variance).unwrap()
}

fn observation(truth: &Fixture) -> Observation {
    Observation::new(&recorded(truth), |_| true).unwrap()
}

#[test]
fn modulus_and_second_moment_enter_as_their_product_and_exact_quantities_do_not_move() {
    let hypothesis = Hypothesis::nominal(&fixture(), false);
    let paths: Vec<&str> = hypothesis.tolerances().iter().map(|t| t.quantity.path.as_str()).collect();
    let expected = [
        "bodies/A/mass",
        "bodies/A/inertia",
        "bodies/A/x_cg",
        "joints/J/beam/youngs_modulus",
        "damping/modal_ratios/0",
    ];
    assert_eq!(paths, expected);
    // 2 % and 1.5 % are 2.5 % of the product.
    let modulus = hypothesis.tolerances()[3].quantity.std.unwrap();
    assert!((modulus / (0.025 * 2e11) - 1.0).abs() < 1e-12, "{modulus}");
}

#[test]
fn a_refit_finds_quantities_that_were_moved_within_their_tolerances() {
    let mut truth = fixture();
    for quantity in truth.quantities_mut() {
        match quantity.path.as_str() {
            "bodies/A/mass" => quantity.quantity.value += 0.002,
            "joints/J/beam/youngs_modulus" => quantity.quantity.value += 6e9,
            _ => {}
        }
    }
    let observation = observation(&truth);
    let start = Hypothesis::nominal(&fixture(), false);
    let before = observation.chi2(&start.predict(&observation).unwrap());
    let fit = Fit::of(&start, &observation, true).unwrap();
    assert!(fit.chi2 < 1e-2 && before > 1e5, "chi2 {before:.0} to {:.3}", fit.chi2);
    assert!((fit.hypothesis.departure(0) - 1.0).abs() < 0.1, "mass {}", fit.hypothesis.departure(0));
    assert!((fit.hypothesis.departure(3) - 1.2).abs() < 0.1, "modulus {}", fit.hypothesis.departure(3));
}

#[test]
fn an_effects_parameters_are_fitted_and_their_covariance_is_positive() {
    let hidden = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, 0.05]);
    let truth = fixture().with_physics(vec![hidden]).unwrap();
    let observation = observation(&truth);
    let guess = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.02]);
    let fit = Fit::of(&Hypothesis::nominal(&fixture(), false).with(guess), &observation, true).unwrap();
    let found = &fit.hypothesis.effects()[0];
    assert!((found.value(0) - 0.11).abs() < 1e-4 && (found.value(1) - 0.05).abs() < 1e-4, "{found:?}");
    let covariance = fit.covariance(&observation).unwrap();
    let n = fit.hypothesis.tolerances().len() + 2;
    assert!((0..n).all(|m| covariance.at(m, m) > 0.0));
}

#[test]
fn a_bounded_parameter_stops_at_its_bound_and_the_others_go_on() {
    // The data want less loss than none: the loss factor stays at zero and the stiffness still gets its
    // factor.
    let mut truth = fixture();
    for quantity in truth.quantities_mut().into_iter().filter(|q| q.path.starts_with("damping")) {
        quantity.quantity.value = 0.0059;
    }
    let softer = Effect::new(EffectKind::StiffnessChange, Place::Joint("J".into()), None, &[0.8]);
    let observation = observation(&truth.with_physics(vec![softer]).unwrap());
    let start = Hypothesis::nominal(&fixture(), false)
        .with(Effect::new(EffectKind::LossFactor, Place::Joint("J".into()), None, &[0.01]))
        .with(Effect::new(EffectKind::StiffnessChange, Place::Joint("J".into()), None, &[0.85]));
    let effects = Fit::of(&start, &observation, true).unwrap().hypothesis.effects();
    assert!(effects[0].value(0) >= 0.0 && effects[0].value(0) < 1e-3, "{effects:?}");
    assert!((effects[1].value(0) - 0.8).abs() < 0.02, "{effects:?}");
}

#[test]
fn a_dashpot_of_zero_leaves_the_spring_beside_it_a_deviation() {
    // The data want less damping than none in the interface: its dashpot stops at zero, from where it can be
    // moved to one side only.
    let mut truth = fixture();
    for quantity in truth.quantities_mut().into_iter().filter(|q| q.path.starts_with("damping")) {
        quantity.quantity.value = 0.0056;
    }
    let interface = |stiffness: f64, damping: f64| {
        let at = Place::Point("3".into());
        Effect::new(EffectKind::InterfaceCompliance, at, Some(Dof::Rotation), &[stiffness, damping])
    };
    let observation = observation(&truth.with_physics(vec![interface(5e3, 0.0)]).unwrap());
    let start = Hypothesis::nominal(&fixture(), false).with(interface(5.2e3, 0.3));
    let fit = Fit::of(&start, &observation, true).unwrap();
    let found = &fit.hypothesis.effects()[0];
    assert!(found.value(1) == 0.0 && (found.value(0) / 5e3 - 1.0).abs() < 0.05, "{found:?}");
    let covariance = fit.covariance(&observation).unwrap();
    let n = fit.hypothesis.tolerances().len() + 2;
    assert!((0..n).all(|m| covariance.at(m, m) > 0.0));
    // The spring moves by its logarithm: its deviation is a share of it.
    let share = covariance.std(n - 2);
    assert!(share < 0.1, "deviation of {share} of the spring");
}

#[test]
fn an_offset_is_found_beyond_the_ends_of_a_bar_of_the_bodys_inertia_and_a_start_farther_away_is_led_back() {
    // The bar of A's mass and inertia ends 21 mm beyond point 1.
    let offset = |dx: f64| Effect::new(EffectKind::PointOffset, Place::Point("1".into()), None, &[dx]);
    let observation = observation(&fixture().with_physics(vec![offset(-0.025)]).unwrap());
    for start in [-0.015, -0.15] {
        let start = Hypothesis::nominal(&fixture(), false).with(offset(start));
        assert!(start.effects()[0].value(0) > -0.05, "{}", start.effects()[0].value(0));
        let fit = Fit::of(&start, &observation, false).unwrap();
        let dx = fit.hypothesis.effects()[0].value(0);
        assert!((dx + 0.025).abs() < 1e-5 && fit.chi2 < 1e-2, "{dx} m, chi2 {}", fit.chi2);
    }
}

#[test]
fn the_catalogue_has_every_linear_effect_that_the_fixture_can_have() {
    let observation = observation(&fixture());
    let candidates = catalogue(&fixture(), &observation);
    // Which quantity may be wrong, a refit tells first.
    let is_listed = |kind: &EffectKind| !kind.is_nonlinear() && *kind != EffectKind::QuantityError;
    for kind in EffectKind::ALL.into_iter().filter(is_listed) {
        let mine: Vec<_> = candidates.iter().filter(|c| c.kind == kind).collect();
        assert!(!mine.is_empty(), "{} is missing", kind.name());
        for candidate in mine {
            for start in 0..candidate.starts.len() {
                let possible = fixture().with_physics(vec![candidate.effect(start)]);
                assert!(possible.is_ok(), "{possible:?}");
            }
        }
    }
}

#[test]
fn what_a_fixture_states_of_a_joint_is_not_among_what_it_leaves_out() {
    let values = [(EffectKind::JointMass, vec![0.01]), (EffectKind::ShearDeformation, vec![2e6, 0.0])];
    let stated = values.map(|(kind, values)| Effect::new(kind, Place::Joint("J".into()), None, &values));
    let stated = fixture().with_physics(stated.to_vec()).unwrap();
    let kinds = |fixture: &Fixture| {
        let all = catalogue(fixture, &observation(fixture));
        all.iter().map(|candidate| candidate.kind).collect::<Vec<_>>()
    };
    for kind in [EffectKind::JointMass, EffectKind::ShearDeformation] {
        assert!(kinds(&fixture()).contains(&kind) && !kinds(&stated).contains(&kind), "{}", kind.name());
    }
}

#[test]
fn what_touches_a_storey_may_be_as_stiff_as_what_holds_it() {
    // Storeys of 7 kg, tested to 120 Hz, are held far more stiffly than they would resonate on in mid-band.
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "F1": { "mass": 7.0, "rotates": false }, "F2": { "mass": 7.0, "rotates": false } },
             "points": { "1": { "body": "F1", "x": 0 }, "2": { "body": "F2", "x": 0.2 } },
             "joints": { "C": { "from": "1", "to": "2", "stiffness": [[4e5, 0], [0, 0]] } },
             "supports": { "ground": { "point": "1", "stiffness": 3e5 } },
             "damping": { "modal_ratios": [0.003] } }"#,
    )
    .unwrap();
    let lines = SpectralLines::even(4.0, 0.5, 233).unwrap();
    let pairs = [FrfPair::transverse("1", "1"), FrfPair::transverse("2", "1")];
    let frfs = synthesize(&fixture, &pairs, &lines, Instrument::AsRecorded).unwrap();
    let all = catalogue(&fixture, &Observation::new(&frfs, |_| true).unwrap());
    let of = |body: &str| {
        let own = Place::Body(body.into());
        all.iter().find(|c| c.kind == EffectKind::Support && c.place == own && c.dof != Some(Dof::Rotation))
    };
    for body in ["F1", "F2"] {
        let stiffest = of(body).unwrap().starts.iter().map(|start| start[1]).fold(0.0, f64::max);
        assert!((1e5..8e5).contains(&stiffest), "{body}: up to {stiffest} N/m");
    }
}

#[test]
fn what_resonates_between_two_starts_is_within_the_reach_of_one() {
    // Lines whose lowest is less than a fiftieth of the highest: no band has starts farther apart.
    let observation = observation(&fixture());
    let mut seen = 0;
    for candidate in catalogue(&fixture(), &observation) {
        for (index, parameter) in candidate.kind.spec().parameters.iter().enumerate() {
            let (Starts::OverBand { high, .. }, Motion::Logarithm { reach }) =
                (parameter.starts, parameter.motion)
            else {
                continue;
            };
            let mut starts: Vec<f64> = candidate.starts.iter().map(|start| start[index]).collect();
            starts.sort_by(f64::total_cmp);
            let name = candidate.kind.name();
            for pair in starts.windows(2) {
                let apart = (pair[1] / pair[0]).ln();
                assert!(apart <= 2.0 * reach, "{name}: {pair:?} Hz, reach {reach}");
            }
            let end = high * 1200.0;
            let last = starts[starts.len() - 1];
            assert!((end / last).ln() <= reach, "{name}: from {last} Hz not to {end} Hz");
            seen += 1;
        }
    }
    assert!(seen > 0);
}

/// Multiple of the highest line below which sensors may resonate on their mountings: bands end at a fifth of
/// that, or before.
const MOUNTED: f64 = 6.0;

#[test]
fn a_channel_that_resonates_at_six_times_the_band_is_within_the_reach_of_a_start() {
    let fixture = fixture();
    let observation = observation(&fixture);
    let highest = *observation.lines().hz().last().unwrap();
    let mut seen = 0;
    for candidate in catalogue(&fixture, &observation) {
        if candidate.kind != EffectKind::ChannelResonance {
            continue;
        }
        let Motion::Logarithm { reach } = candidate.kind.spec().parameters[0].motion else { continue };
        let last = candidate.starts.iter().map(|start| start[0]).fold(0.0, f64::max);
        let end = last * reach.exp();
        assert!(
            end >= MOUNTED * highest,
            "{:?}: no farther than {end:.0} Hz on lines to {highest} Hz",
            candidate.place
        );
        seen += 1;
    }
    assert!(seen > 0);
}

#[test]
fn an_observation_on_fewer_lines_and_frfs_keeps_the_noise_of_what_is_left() {
    let all = observation(&fixture());
    let fewer = all.reduced(|hz| hz > 600.0, |pair| pair.to_string() != "3/1").unwrap();
    assert_eq!((fewer.pairs().len(), fewer.lines().len()), (3, 60));
    assert_eq!(fewer.weights()[60], all.weights()[2 * 120 + 60]);
    assert!(all.reduced(|_| false, |_| true).is_none() && all.reduced(|_| true, |_| false).is_none());
}

#[test]
fn values_that_were_not_measured_count_in_neither_chi2_nor_the_relative_error() {
    let empty = |at: usize| (30..50).contains(&at) || at >= 470;
    let zero = |at, value| if empty(at) { Complex64::ZERO } else { value };
    let observation = Observation::new(&recorded(&fixture()).with_values(zero), |_| true).unwrap();
    let predicted = Hypothesis::nominal(&fixture(), false).predict(&observation).unwrap();
    assert_eq!(observation.degrees(), 2 * (4 * 120 - 30));
    assert!(observation.chi2(&predicted) < 1e-9 && observation.nrmse(&predicted) < 1e-9);
}

#[test]
fn ends_that_are_stated_to_turn_are_no_footing_that_is_left_out() {
    let turning = |point: &str| {
        Effect::new(EffectKind::InterfaceCompliance, Place::Point(point.into()), Some(Dof::Rotation), &[3e4])
    };
    let listed = |physics: Vec<Effect>| {
        let fixture = fixture().with_physics(physics).unwrap();
        let kinds = catalogue(&fixture, &observation(&fixture)).into_iter().map(|candidate| candidate.kind);
        kinds.filter(|kind| *kind == EffectKind::Footing).count()
    };
    assert_eq!(listed(Vec::new()), 1);
    assert_eq!(listed(vec![turning("2")]), 1, "the other end is clamped still");
    assert_eq!(listed(vec![turning("2"), turning("3")]), 0);
}

#[test]
fn an_end_of_a_beam_is_tried_as_a_hinge_and_as_a_layer_along_its_foot() {
    let fixture = fixture();
    let all = catalogue(&fixture, &observation(&fixture));
    let spreads = |dof: Dof| -> Vec<f64> {
        let ends = all.iter().filter(|c| c.kind == EffectKind::InterfaceCompliance && c.dof == Some(dof));
        let mut spreads: Vec<f64> = ends.flat_map(|c| c.starts.iter().map(|start| start[2])).collect();
        spreads.sort_by(f64::total_cmp);
        spreads.dedup();
        spreads
    };
    assert_eq!(spreads(Dof::Rotation), [0.0, 1.0]);
    assert_eq!(spreads(Dof::Translation), [0.0]);
}
