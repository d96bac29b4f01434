//! Slips of a test, made on FRFs of two blocks on a strip, and FRFs without any.

#![allow(clippy::unwrap_used, clippy::panic)]

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_samples::{ACROSS, transverse};
use jointscope_screening::{Oddity, Polar, ScreeningError, screened};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use proptest::prelude::*;

fn fixture(physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.4, "inertia": 1.3e-3, "x_cg": 0.095 }} }},
             "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0.0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
             "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
             "damping": {{ "modal_ratios": [0.004] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

fn pairs() -> Vec<FrfPair> {
    transverse(&ACROSS)
}

/// FRFs of a structure with physics that its fixture does not have: resonances are elsewhere.
fn recorded(physics: &str) -> FrfSet {
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    synthesize(&fixture(physics), &pairs(), &lines, Instrument::AsRecorded).unwrap()
}

const WELD: &str =
    r#"{ "kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 9000.0 }"#;

fn oddities(frfs: &FrfSet) -> (FrfSet, Vec<Oddity>) {
    let screened = screened(frfs.clone(), &fixture("")).unwrap();
    (screened.frfs, screened.oddities)
}

#[test]
fn frfs_without_a_signal_are_left_out() {
    let frfs = recorded(WELD);
    let dead = frfs.clone().with_values(|at, value| if at < 400 { Complex64::ZERO } else { value });
    let (left, found) = oddities(&dead);
    assert_eq!(found, [Oddity::Dead(vec![pairs()[0].clone()])]);
    assert_eq!(left.pairs(), &pairs()[1..]);
    let nothing = frfs.with_values(|_, _| Complex64::ZERO);
    assert_eq!(screened(nothing, &fixture("")).unwrap_err(), ScreeningError::NothingRecorded);
}

#[test]
fn lines_of_exactly_zero_are_said_and_left_out_where_all_frfs_have_them() {
    let frfs = recorded(WELD);
    let empty = |index: usize, line: usize| line >= 390 || (index == 2 && (100..120).contains(&line));
    let zero = |at: usize, value| if empty(at / 400, at % 400) { Complex64::ZERO } else { value };
    let (left, found) = oddities(&frfs.clone().with_values(zero));
    let top = [977.5, 1000.0];
    let of = |index: usize, count, lines| (pairs()[index].clone(), count, lines);
    let listed = vec![of(0, 10, top), of(1, 10, top), of(2, 30, [252.5, 1000.0]), of(3, 10, top)];
    assert_eq!(found, [Oddity::Empty(listed)]);
    assert_eq!(left.lines().len(), 390);
    let measured = |index: usize| (0..390).filter(|&line| left.is_measured(index, line)).count();
    assert_eq!([0, 1, 2, 3].map(measured), [390, 390, 370, 390]);
    assert!(found[0].to_string().contains("4/1, 3/1 on 10 lines from 977.5 to 1000 Hz; "), "{}", found[0]);
}

#[test]
fn frfs_without_a_phase_are_left_out_unless_the_structure_has_no_damping() {
    let frfs = recorded(WELD);
    let magnitude = |value: Complex64| Complex64::from(value.norm());
    let (left, found) =
        oddities(&frfs.clone().with_values(|at, value| if at < 400 { magnitude(value) } else { value }));
    assert_eq!(found, [Oddity::NoPhase(vec![pairs()[0].clone()])]);
    assert_eq!(left.pairs(), &pairs()[1..]);
    let nothing = frfs.with_values(|_, value| magnitude(value));
    assert_eq!(screened(nothing, &fixture("")).unwrap_err(), ScreeningError::NoPhase);
    let undamped = Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 } },
             "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0.0 } } }"#,
    )
    .unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = synthesize(&undamped, &transverse(&[("1", "2")]), &lines, Instrument::AsRecorded).unwrap();
    assert_eq!(screened(frfs, &undamped).unwrap().oddities, []);
}

#[test]
fn magnitudes_and_phases_in_the_place_of_real_and_imaginary_parts_are_taken_as_what_they_are() {
    let frfs = recorded(WELD);
    let decibels = |value: Complex64| 20.0 * value.norm().log10();
    let readings: [(Polar, &dyn Fn(Complex64) -> Complex64); 4] = [
        (Polar::Degrees, &|value| Complex64::new(value.norm(), value.arg().to_degrees())),
        (Polar::Radians, &|value| Complex64::new(value.norm(), value.arg())),
        (Polar::DecibelsDegrees, &|value| Complex64::new(decibels(value), value.arg().to_degrees())),
        (Polar::DecibelsRadians, &|value| Complex64::new(decibels(value), value.arg())),
    ];
    for (polar, written) in readings {
        let (back, found) = oddities(&frfs.clone().with_values(|_, value| written(value)));
        assert_eq!(found, [Oddity::Polar(polar)]);
        for (a, b) in back.all_values().iter().zip(frfs.all_values()) {
            assert!((a - b).norm() < 1e-12 * b.norm());
        }
    }
    assert_eq!(oddities(&frfs).1, []);
    // One sensor points the other way, as the file's direction says: both of its numbers have the other sign.
    let turned = |at: usize, value: Complex64| {
        let written = Complex64::new(value.norm(), value.arg().to_degrees());
        if at < 400 { -written } else { written }
    };
    let (back, found) = oddities(&frfs.clone().with_values(turned));
    assert_eq!(found, [Oddity::Polar(Polar::Degrees), Oddity::Conjugated(vec![pairs()[0].clone()])]);
    for (a, b) in back.values(0).iter().zip(frfs.values(0)) {
        assert!((a + b).norm() < 1e-12 * b.norm());
    }
}

#[test]
fn conjugates_are_taken_back() {
    let frfs = recorded(WELD);
    let (back, found) = oddities(&frfs.clone().with_values(|_, value| value.conj()));
    assert_eq!(found, [Oddity::Conjugated(pairs())]);
    assert_eq!(back, frfs);
}

#[test]
fn receptances_and_mobilities_labelled_accelerance_are_taken_as_what_they_are() {
    let frfs = recorded(WELD);
    let omegas: Vec<f64> = frfs.lines().omegas().collect();
    for form in [FrfForm::Mobility, FrfForm::Receptance] {
        let factor = |at: usize| FrfForm::Accelerance.factor_to(form, omegas[at % 400]).unwrap();
        let (back, found) = oddities(&frfs.clone().with_values(|at, value| value * factor(at)));
        assert_eq!(found, [Oddity::Form(form)]);
        for (a, b) in back.all_values().iter().zip(frfs.all_values()) {
            assert!((a - b).norm() < 1e-12 * b.norm());
        }
    }
}

#[test]
fn frfs_in_another_unit_than_stated_are_taken_in_it() {
    let frfs = recorded(WELD);
    for factor in [9.80665, 0.101972, 1000.0, 39.3701, 4.44822] {
        let (back, found) = oddities(&frfs.clone().with_values(|_, value| value * factor));
        assert!(matches!(&found[..], [Oddity::Unit { .. }]), "{factor}: {found:?}");
        for (a, b) in back.all_values().iter().zip(frfs.all_values()) {
            assert!((a - b).norm() < 1e-4 * b.norm());
        }
    }
}

#[test]
fn an_axis_in_khz_or_rad_s_is_taken_as_what_it_is() {
    let frfs = recorded(r#"{ "kind": "added_mass", "place": "B", "x": 0.12, "mass": 0.02 }"#);
    for factor in [1000.0, 0.001, std::f64::consts::TAU] {
        let hz = frfs.lines().hz().iter().map(|hz| factor * hz).collect();
        let (back, found) = oddities(&frfs.clone().with_lines(SpectralLines::new(hz).unwrap()));
        assert!(matches!(&found[..], [Oddity::Axis(_)]), "{factor}: {found:?}");
        assert!((back.lines().hz()[399] - 1000.0).abs() < 1e-9);
    }
}

#[test]
fn two_frfs_under_each_others_labels_are_exchanged() {
    let frfs = recorded(WELD);
    let mut labels = pairs();
    labels.swap(0, 3);
    let (back, found) = oddities(&frfs.with_pairs(labels));
    assert!(matches!(&found[..], [Oddity::Exchanged(..)]), "{found:?}");
    assert_eq!(back.pairs(), pairs());
}

#[test]
fn two_points_whose_channels_are_swapped_are_told_as_points() {
    let frfs = recorded(WELD);
    // Responses 3 and 4 in each other's place under both references, then references 1 and 2.
    for (order, points) in [([1, 0, 3, 2], ("3", "4")), ([2, 3, 0, 1], ("1", "2"))] {
        let labels = order.map(|index| pairs()[index].clone()).to_vec();
        let (back, found) = oddities(&frfs.clone().with_pairs(labels));
        assert_eq!(found, [Oddity::Swapped(points.0.into(), points.1.into())]);
        assert_eq!(back.pairs(), pairs());
    }
}

#[test]
fn swapped_channels_are_told_where_some_of_their_frfs_have_no_partner() {
    let all = transverse(&[("4", "1"), ("3", "1"), ("4", "2"), ("3", "2"), ("1", "1"), ("1", "4")]);
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs = synthesize(&fixture(WELD), &all, &lines, Instrument::AsRecorded).unwrap();
    // The sensors at 1 and 4 under each other's names: 1/2 and 4/4 are of nobody else.
    let of = |name: &str| if name == "4" { "1" } else { "4" };
    let labels: Vec<FrfPair> = all
        .iter()
        .map(|pair| match pair.response.point.as_str() {
            "3" => pair.clone(),
            own => FrfPair::transverse(of(own), &pair.reference.point),
        })
        .collect();
    let (back, found) = oddities(&frfs.clone().with_pairs(labels));
    assert_eq!(found, [Oddity::Swapped("1".into(), "4".into())]);
    assert_eq!(back.pairs(), all);
    // Two FRFs alone are exchanged as before.
    let mut two = all.clone();
    two.swap(0, 4);
    let (back, found) = oddities(&frfs.with_pairs(two));
    assert!(matches!(&found[..], [Oddity::Exchanged(..)]), "{found:?}");
    assert_eq!(back.pairs(), all);
}

#[test]
fn a_band_without_coherence_is_laid_to_the_hammer_where_all_its_frfs_lack_it_and_to_a_sensor_otherwise() {
    let without = |of: fn(&FrfPair) -> bool| {
        let mut frfs = recorded("");
        for (index, pair) in pairs().iter().enumerate() {
            let gamma = |line: usize| if line > 280 && of(pair) { 0.1 } else { 0.98 };
            frfs.set_coherence(index, (0..400).map(gamma).collect()).unwrap();
        }
        oddities(&frfs).1
    };
    let told = |found: &[Oddity]| match found {
        [Oddity::Unexcited { point, is_reference, from, .. }] => (point.clone(), *is_reference, *from),
        other => panic!("{other:?}"),
    };
    let (point, is_reference, from) = told(&without(|pair| pair.reference.point == "1"));
    assert!(point == "1" && is_reference && (from - 705.0).abs() < 30.0, "{from}");
    let (point, is_reference, _) = told(&without(|pair| pair.response.point == "4"));
    assert!(point == "4" && !is_reference);
    assert!(without(|_| false).is_empty());
}

/// The fixture with masses and inertias multiplied.
fn read_as(mass: f64, inertia: f64, of: impl Fn(usize) -> bool) -> Fixture {
    let mut other = fixture("");
    for quantity in fixture("").quantities() {
        let jointscope_fixture::QuantityOwner::Body(body) = quantity.owner else { continue };
        let factor = match quantity.nature {
            jointscope_fixture::Nature::Mass => mass,
            jointscope_fixture::Nature::Inertia => inertia,
            _ => 1.0,
        };
        if of(body) {
            other.set_quantity(quantity.owner, quantity.key, factor * quantity.value);
        }
    }
    other
}

#[test]
fn masses_or_inertias_in_another_unit_are_told_by_what_was_recorded_and_frfs_are_left_as_they_are() {
    let pound = 1.0 / 0.453_592_37;
    // A weld that turns moves levels themselves: beside it only slips that are larger are told.
    for (physics, count) in [("", 5), (WELD, 3)] {
        let frfs = recorded(physics);
        for (mass, inertia, body, place, looks) in [
            (1e3, 1e3, None, "bodies", "masses look like grams, and the inertias"),
            (pound, pound, None, "bodies", "masses look like pounds, and the inertias"),
            (1e-3, 1e-3, None, "bodies", "tonnes"),
            (pound, 1.0, None, "bodies", "masses look like pounds"),
            (1.0, 10.0, Some(0), "bodies/A/inertia", "10 times too large"),
        ]
        .into_iter()
        .take(count)
        {
            let fixture = read_as(mass, inertia, |index| body.is_none_or(|body| body == index));
            let found = screened(frfs.clone(), &fixture).unwrap();
            let [Oddity::Masses(slip)] = &found.oddities[..] else {
                panic!("{mass} {inertia} {physics}: {:?}", found.oddities)
            };
            assert!(slip.place == place && slip.advice.contains(looks), "{mass} {inertia}: {slip}");
            assert!(!slip.advice.contains("or the recording"), "stiffness tells: {slip}");
            assert_eq!(found.frfs, frfs);
        }
    }
}

#[test]
fn without_stiffness_in_the_band_grams_and_millimetres_are_both_said() {
    let body = |mass: f64| {
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": {mass}, "rotates": false }} }}, "points": {{ "1": {{ "body": "A", "x": 0 }} }} }}"#
        ))
        .unwrap()
    };
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let frfs =
        synthesize(&body(1.1), &[FrfPair::transverse("1", "1")], &lines, Instrument::AsRecorded).unwrap();
    let found = screened(frfs, &body(1100.0)).unwrap().oddities;
    let [Oddity::Masses(slip)] = &found[..] else { panic!("{found:?}") };
    assert!(slip.advice.contains("grams") && slip.advice.contains("mm and m"), "{slip}");
}

#[test]
fn lines_that_the_hammer_does_not_excite_are_left_out_of_its_frfs() {
    let with = |of: fn(&FrfPair) -> bool| {
        let mut frfs = recorded("");
        for (index, pair) in pairs().iter().enumerate() {
            let gamma = |line: usize| if line >= 280 && of(pair) { 0.1 } else { 0.98 };
            frfs.set_coherence(index, (0..400).map(gamma).collect()).unwrap();
        }
        oddities(&frfs)
    };
    let (left, found) = with(|_| true);
    assert_eq!((left.lines().len(), found.len()), (280, 2));
    assert!(found[0].to_string().contains("120 lines are left out"), "{}", found[0]);
    let (left, _) = with(|pair| pair.reference.point == "1");
    assert_eq!(left.lines().len(), 400);
    for (index, pair) in left.pairs().iter().enumerate() {
        let silent = left.coherence(index).unwrap().iter().filter(|gamma| **gamma == 0.0).count();
        assert_eq!(silent, if pair.reference.point == "1" { 120 } else { 0 }, "{pair}");
    }
    let (left, _) = with(|pair| pair.response.point == "4");
    assert!(left.coherence(0).unwrap().iter().all(|gamma| *gamma > 0.0), "a sensor's lines stay");
}

#[test]
fn frfs_of_which_a_part_of_the_numbers_was_multiplied_are_refused() {
    let frfs = recorded(WELD).with_values(|_, value| if value.norm() >= 1.0 { 1e3 * value } else { value });
    let error = screened(frfs, &fixture("")).unwrap_err();
    let says = error.to_string();
    assert!(matches!(error, ScreeningError::Changed(_)) && says.contains("factor of 1000"), "{says}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn physics_that_a_fixture_leaves_out_is_no_slip(
        kind in 0usize..6, size in 0.05f64..1.0, sign in prop::bool::ANY
    ) {
        let signed = if sign { size } else { -size };
        let physics = match kind {
            0 => format!(r#"{{ "kind": "added_mass", "place": "B", "x": 0.12, "mass": {} }}"#, 0.3 * signed),
            1 => format!(r#"{{ "kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": {} }}"#, 2e3 / size),
            2 => format!(r#"{{ "kind": "channel_gain", "place": "response 4", "factor": {} }}"#, if sign { -1.0 } else { 1.0 + 0.5 * size }),
            3 => format!(r#"{{ "kind": "channel_delay", "place": "reference 1", "seconds": {} }}"#, 1e-4 * signed),
            4 => format!(r#"{{ "kind": "support", "place": "A", "x": -0.05, "stiffness": {}, "damping": 5 }}"#, 1e6 * size),
            _ => format!(r#"{{ "kind": "stiffness_change", "place": "J", "factor": {} }}"#, 1.0 + 0.8 * signed),
        };
        let frfs = recorded(&physics);
        let screened = screened(frfs.clone(), &fixture("")).unwrap();
        prop_assert!(screened.oddities.is_empty(), "{:?} of {physics}", screened.oddities);
        prop_assert_eq!(screened.frfs, frfs);
    }
}
