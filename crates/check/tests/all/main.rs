//! Slips of a fixture and of a test, made on purpose, and what a check says of them.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

use jointscope_check::{Check, CheckOptions, DrivingPointVerdict, Weight};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_pipeline::Measurement;
use jointscope_samples::Noise;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use serde_json::{Value, json};

fn blocks() -> Value {
    json!({
        "name": "two blocks",
        "bodies": { "A": { "mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030 }, "B": { "mass": 1.50, "inertia": 1.2e-3, "x_cg": 0.095 } },
        "points": { "1": { "body": "A", "x": -0.060 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
        "damping": { "modal_ratios": [0.004, 0.005] } })
}

fn fixture(changes: &[(&str, Value)]) -> Fixture {
    let mut file = blocks();
    for (path, value) in changes {
        match file.pointer_mut(path) {
            Some(place) => *place = value.clone(),
            None => file[path.trim_start_matches('/')] = value.clone(),
        }
    }
    Fixture::from_value(&file).unwrap()
}

/// All FRFs between points 1 to 4 and references 1, 2 and 4, with noise of 1 %.
fn recorded(fixture: &Fixture) -> FrfSet {
    let pairs: Vec<FrfPair> = ["1", "2", "4"]
        .iter()
        .flat_map(|reference| ["1", "2", "3", "4"].map(|response| FrfPair::transverse(response, reference)))
        .collect();
    let lines = SpectralLines::even(5.0, 2.5, 400).unwrap();
    let frfs = synthesize(fixture, &pairs, &lines, Instrument::AsRecorded).unwrap();
    let mut noise = Noise::from_state(7);
    let mut random = move || noise.uniform() - 0.5;
    let noise: Vec<Complex64> =
        (0..frfs.all_values().len()).map(|_| 0.03 * Complex64::new(random(), random())).collect();
    frfs.with_values(|at, value| value * (1.0 + noise[at]))
}

fn check(fixture: &Fixture, frfs: FrfSet) -> Check {
    Check::of(fixture, Some(&Measurement::from(frfs)), &CheckOptions::default()).unwrap()
}

/// The FRF's values, changed where `of` says so.
fn changed(
    frfs: &FrfSet,
    of: impl Fn(&FrfPair) -> bool,
    change: impl Fn(Complex64, f64) -> Complex64,
) -> FrfSet {
    let (count, pairs) = (frfs.lines().len(), frfs.pairs().to_vec());
    let hz = frfs.lines().hz().to_vec();
    frfs.clone().with_values(|at, value| match of(&pairs[at / count]) {
        true => change(value, hz[at % count]),
        false => value,
    })
}

#[track_caller]
fn says(check: &Check, place: &str, part: &str) {
    let told = check.remarks.iter().any(|remark| remark.place == place && remark.says.contains(part));
    assert!(told, "nothing of `{part}` at `{place}`: {:#?}", check.remarks);
}

#[test]
fn a_recording_of_the_fixture_itself_is_not_odd_and_weighs_what_the_fixture_does() {
    let fixture = fixture(&[]);
    let check = check(&fixture, recorded(&fixture));
    assert!(check.remarks.is_empty(), "{:#?}", check.remarks);
    let recording = check.recording.unwrap();
    assert!(recording.nrmse.unwrap() < 0.02);
    let passive = |point: &jointscope_check::DrivingPoint| point.verdict == DrivingPointVerdict::Passive;
    assert_eq!(recording.driving_points.len(), 3);
    assert!(recording.driving_points.iter().all(passive), "{:#?}", recording.driving_points);
    assert_eq!(recording.reciprocity.len(), 3);
    let mass = recording.mass_line.unwrap().mass.unwrap();
    assert!((mass.value - 2.6).abs() < 3.0 * mass.std.unwrap() && mass.std.unwrap() < 0.1, "{mass:?}");
    let modes = check.modes.unwrap();
    for (own, found) in modes.modes.iter().zip(&recording.modes.unwrap().modes) {
        assert!((found.fixture.unwrap() / own.frequency.value - 1.0).abs() < 1e-6);
        assert!((found.frequency / own.frequency.value - 1.0).abs() < 1e-3);
    }
}

#[test]
fn physics_that_the_fixture_leaves_out_is_no_slip() {
    let frfs = recorded(&fixture(&[(
        "/physics",
        json!([{ "kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 8000.0, "damping": 0.05 }]),
    )]));
    let check = check(&fixture(&[]), frfs);
    assert!(check.remarks.is_empty(), "{:#?}", check.remarks);
    assert!(check.recording.unwrap().nrmse.unwrap() > 0.3);
}

#[test]
fn effects_that_depend_on_amplitude_are_left_aside_and_said() {
    let cubic = json!([{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 1e9 }]);
    let check = check(&fixture(&[("/physics", cubic)]), recorded(&fixture(&[])));
    assert!(check.remarks.is_empty(), "{:#?}", check.remarks);
    let recording = check.recording.unwrap();
    assert!(
        recording.notes.iter().any(|note| note.contains("depend on amplitude"))
            && recording.nrmse.unwrap() < 0.02
    );
}

#[test]
fn a_response_that_points_the_other_way_is_named_with_its_driving_point() {
    let fixture = fixture(&[]);
    let frfs = changed(&recorded(&fixture), |pair| pair.response.point == "4", |value, _| -value);
    let check = check(&fixture, frfs);
    says(&check, "response 4", "opposite sign");
    says(&check, "4/4", "opposite ways");
    let check_again = check.clone();
    let turned: Vec<String> =
        check.recording.unwrap().channels.into_iter().filter(|c| c.turned).map(|c| c.channel).collect();
    assert_eq!(turned, ["response 4"]);
    // What it does to modes and mass line is not told a second time.
    assert_eq!(check_again.remarks.iter().filter(|remark| remark.place == "mass line").count(), 0);
}

#[test]
fn a_force_recorded_the_other_way_round_turns_all() {
    let fixture = fixture(&[]);
    let check = check(&fixture, changed(&recorded(&fixture), |_| true, |value, _| -value));
    says(&check, "force", "opposite sign");
    assert!(check.recording.unwrap().channels.iter().all(|channel| !channel.turned));
}

#[test]
fn a_receptance_that_is_called_an_accelerance_is_not_a_turned_force() {
    let fixture = fixture(&[]);
    let omega2 = |hz: f64| (2.0 * std::f64::consts::PI * hz).powi(2);
    let check = check(&fixture, changed(&recorded(&fixture), |_| true, |value, hz| -value / omega2(hz)));
    says(&check, "recording", "taken as receptance");
    assert_eq!(check.remarks.len(), 1, "{:#?}", check.remarks);
}

#[test]
fn an_absurd_value_and_lines_that_end_too_early_are_told() {
    let fixture = fixture(&[]);
    let absurd = changed(
        &recorded(&fixture),
        |pair| pair.to_string() == "3/1",
        |value, hz| if hz == 500.0 { value * 1e300 } else { value },
    );
    let check_of_absurd = check(&fixture, absurd);
    says(&check_of_absurd, "3/1", "at 500 Hz is more than a million times");
    let numbers = |check: &Check| serde_json::to_string(check).unwrap();
    assert!(!numbers(&check_of_absurd).contains("\"nrmse\":null"), "{}", numbers(&check_of_absurd));
    let short = recorded(&fixture).on_lines(|line| line < 20).unwrap();
    says(&check(&fixture, short), "recording", "its lines end at 52.5 Hz, below the first mode");
}

#[test]
fn a_response_that_reads_low_is_named_by_level_and_reciprocity() {
    let fixture = fixture(&[]);
    let frfs = changed(&recorded(&fixture), |pair| pair.response.point == "2", |value, _| 0.7 * value);
    let check = check(&fixture, frfs);
    says(&check, "response 2", "it reads 0.70 times");
    says(&check, "2/1 and 1/2", "reads 0.70 times the second");
    let pair = &check.recording.unwrap().reciprocity;
    assert!(pair.iter().any(|pair| pair.odd) && pair.iter().any(|pair| !pair.odd), "{pair:#?}");
}

#[test]
fn one_record_in_g_is_named_beside_the_others() {
    let fixture = fixture(&[]);
    let frfs = recorded(&fixture);
    let is_odd = |pair: &FrfPair| (pair.response.point.as_str(), pair.reference.point.as_str()) == ("3", "2");
    let in_g = check(&fixture, changed(&frfs, is_odd, |value, _| value / 9.80665));
    says(&in_g, "3/2", "it is 0.102 times what the fixture makes of it, the other FRFs");
}

#[test]
fn a_sensor_beside_the_blow_is_no_driving_point() {
    // The record that is called 4/4 is 4/2's: between some resonances power would come out.
    let fixture = fixture(&[]);
    let frfs = recorded(&fixture);
    let other = frfs.values(frfs.index_of(&FrfPair::transverse("4", "2")).unwrap()).to_vec();
    let index = frfs.index_of(&FrfPair::transverse("4", "4")).unwrap();
    let count = frfs.lines().len();
    let frfs = frfs.with_values(|at, value| if at / count == index { other[at % count] } else { value });
    says(&check(&fixture, frfs), "4/4", "the sensor is not where the hammer strikes");
}

#[test]
fn a_force_cell_that_reads_ten_per_cent_low_shows_in_the_mass_line() {
    let fixture = fixture(&[]);
    let check = check(&fixture, changed(&recorded(&fixture), |_| true, |value, _| value / 0.9));
    says(&check, "mass line", "the fixture 2.600 kg");
    let mass = check.recording.unwrap().mass_line.unwrap().mass.unwrap();
    assert!((mass.value / (0.9 * 2.6) - 1.0).abs() < 0.02, "{mass:?}");
}

#[test]
fn a_dead_channel_and_hum_are_told_as_a_diagnosis_tells_them() {
    let fixture = fixture(&[]);
    let frfs = recorded(&fixture);
    let dead = changed(&frfs, |pair| pair.response.point == "3", |_, _| Complex64::ZERO);
    let check_of_dead = check(&fixture, dead);
    says(&check_of_dead, "recording", "without a signal on any line, left out: 3/1, 3/2, 3/4");
    assert_eq!(check_of_dead.remarks[0].weight, Weight::Wrong);
    let hum =
        changed(&frfs, |_| true, |value, hz| if (47.5..=52.5).contains(&hz) { 30.0 * value } else { value });
    says(&check(&fixture, hum), "recording", "contradict all others");
}

#[test]
fn every_slip_of_the_fixture_is_told_with_its_place() {
    let fixture =
        fixture(&[("/bodies/A/mass", json!(1100.0)), ("/joints/J/beam/second_moment", json!(367.0))]);
    let check = Check::of(&fixture, None, &CheckOptions::default()).unwrap();
    says(&check, "bodies/A/mass", "the mass looks like grams");
    says(&check, "joints/J/beam/second_moment", "it looks like mm⁴");
    assert_eq!(check.headline(), "2 things wrong in the fixture");
    let undamped = crate::fixture(&[("/damping", json!({}))]);
    says(&Check::of(&undamped, None, &CheckOptions::default()).unwrap(), "damping", "none is stated");
}

#[test]
fn the_result_serializes_with_its_decisions() {
    let fixture = fixture(&[]);
    let value = serde_json::to_value(check(&fixture, recorded(&fixture))).unwrap();
    assert_eq!(value["recording"]["driving_points"][0]["verdict"], "passive");
    assert_eq!(value["recording"]["frfs"][0]["frf"], "1/1");
    assert_eq!(value["numbers"][0]["path"], "bodies/A/mass");
    assert!(value["recording"].get("measured").is_none());
}

#[test]
fn reciprocal_frfs_of_opposite_signs_are_odd() {
    let fixture = fixture(&[]);
    let frfs = recorded(&fixture);
    let both = |pair: &FrfPair| {
        [("1", "2"), ("2", "1")].contains(&(pair.response.point.as_str(), pair.reference.point.as_str()))
    };
    let exact =
        frfs.index_of(&FrfPair::transverse("1", "2")).map(|index| frfs.values(index).to_vec()).unwrap();
    let (count, pairs) = (frfs.lines().len(), frfs.pairs().to_vec());
    let frfs = frfs.clone().with_values(|at, value| match both(&pairs[at / count]) {
        true if pairs[at / count].response.point == "1" => exact[at % count],
        true => -exact[at % count],
        false => value,
    });
    let check = check(&fixture, frfs);
    let pair =
        check.recording.as_ref().unwrap().reciprocity.iter().find(|pair| both(&pair.frf)).unwrap().clone();
    assert!((pair.difference - 2.0).abs() < 1e-9 && pair.odd, "{pair:?}");
}

#[test]
fn one_turned_frf_of_a_response_and_a_reference_of_its_own_is_told_once_and_turned_once() {
    let fixture = fixture(&[]);
    let own: Vec<FrfPair> =
        [("1", "1"), ("2", "1"), ("3", "1"), ("4", "4")].map(|(i, j)| FrfPair::transverse(i, j)).to_vec();
    let lines = SpectralLines::even(5.0, 2.5, 400).unwrap();
    let frfs = synthesize(&fixture, &own, &lines, Instrument::AsRecorded).unwrap();
    let turned = changed(&frfs, |pair| pair.response.point == "4", |value, _| -value);
    let check = check(&fixture, turned);
    let told = check.remarks.iter().filter(|remark| remark.says.contains("opposite sign")).count();
    assert_eq!(told, 1, "{:#?}", check.remarks);
    let channels = &check.recording.as_ref().unwrap().channels;
    assert_eq!(channels.iter().filter(|channel| channel.turned).count(), 1, "{channels:#?}");
}

#[test]
fn a_turned_frf_that_is_the_only_one_is_not_held_against_others() {
    let fixture = fixture(&[]);
    let lines = SpectralLines::even(5.0, 2.5, 400).unwrap();
    let frfs =
        synthesize(&fixture, &[FrfPair::transverse("4", "1")], &lines, Instrument::AsRecorded).unwrap();
    let check = check(&fixture, changed(&frfs, |_| true, |value, _| -value));
    assert!(
        check.remarks.iter().any(|remark| remark.says.contains("sensor or hammer points the other way")),
        "{:#?}",
        check.remarks
    );
    assert!(!check.remarks.iter().any(|remark| remark.says.contains("neither all")), "{:#?}", check.remarks);
}

#[test]
fn a_soft_suspension_that_the_fixture_lacks_is_not_called_hum_alone() {
    let fixture = fixture(&[]);
    let hung = self::fixture(&[(
        "/supports",
        json!({ "a": { "point": "1", "stiffness": 4e3 }, "b": { "point": "4", "stiffness": 4e3 } }),
    )]);
    let check = check(&fixture, recorded(&hung));
    let told: Vec<_> =
        check.remarks.iter().filter(|remark| remark.says.contains("contradict all others")).collect();
    assert!(!told.is_empty(), "{:#?}", check.remarks);
    assert!(
        told.iter().all(|remark| remark.weight == Weight::Odd
            && remark.says.contains("a suspension that the fixture lacks")),
        "{told:#?}"
    );
}

#[test]
fn modes_on_the_stated_supports_are_the_fixture_s_however_soft_the_foam_turned_out() {
    let on_foam = |softer: f64| {
        let supports = json!({ "left": { "body": "A", "x": -0.03, "stiffness": 2e4 * softer, "damping": 2.0 }, "right": { "body": "B", "x": 0.09, "stiffness": 3e4 * softer, "damping": 2.0 } });
        fixture(&[("/supports", supports)])
    };
    let checked = check(&on_foam(1.0), recorded(&on_foam(0.8)));
    let modes = checked.recording.unwrap().modes.unwrap().modes;
    let suspended: Vec<f64> = modes
        .iter()
        .filter(|mode| mode.on_supports)
        .map(|mode| mode.frequency / mode.fixture.unwrap())
        .collect();
    assert_eq!(suspended.len(), 2, "{modes:?}");
    assert!(suspended.iter().all(|ratio| (ratio / 0.8f64.sqrt() - 1.0).abs() < 0.02), "{suspended:?}");
    assert!(modes.iter().any(|mode| !mode.on_supports && mode.mac.is_some()), "{modes:?}");
}

#[test]
fn a_suspension_too_stiff_to_weigh_by_is_told_with_its_frequency_and_not_with_an_empty_band() {
    let ground = json!({ "a": { "point": "1", "stiffness": 2e6 }, "b": { "point": "4", "stiffness": 2e6 } });
    let fixture = fixture(&[("/supports", ground)]);
    let check = check(&fixture, recorded(&fixture));
    let recording = check.recording.unwrap();
    let why = recording.no_mass_line.unwrap();
    assert!(why.contains("is too near the first bending mode") || why.contains("is held"), "{why}");
}

#[test]
fn a_joint_s_mass_and_loss_leave_modes_that_a_fit_of_synthesized_frfs_finds() {
    let physics = json!([
        { "kind": "joint_mass", "place": "J", "mass": 0.08 },
        { "kind": "loss_factor", "place": "J", "loss_factor": 0.01 }
    ]);
    let (bare, heavy) = (fixture(&[]), fixture(&[("/physics", physics)]));
    let first = |fixture: &Fixture| {
        let check = check(fixture, recorded(fixture));
        assert!(check.remarks.iter().all(|remark| remark.place != "bodies"), "{:?}", check.remarks);
        let mode = &check.recording.as_ref().unwrap().modes.as_ref().unwrap().modes[0];
        let modelled = check.modes.clone().unwrap();
        (mode.frequency, modelled.modes[0].frequency.value, modelled.by_frequency_only)
    };
    let ((recorded, modelled, none), (recorded_heavy, heavy, kinds)) = (first(&bare), first(&heavy));
    assert!(none.is_empty() && (recorded / modelled - 1.0).abs() < 1e-4, "{recorded} {modelled}");
    assert_eq!(kinds.len(), 2, "{kinds:?}");
    // Half of it at each end makes up for half of what the mass takes off.
    let [off, left] = [modelled, heavy].map(|hz| hz / recorded_heavy - 1.0);
    assert!(left > 0.0 && left < 0.5 * off, "{recorded_heavy} {heavy} {modelled}");
}
