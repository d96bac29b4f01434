//! How things are concealed in a recording that a fixture explains, and how the answers are scored. A
//! simulated recording stands in for a real one.

use crate::common::found;
use jointscope_diagnosis::Verdict;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_proof::concealed::{
    Concealed, ConcealmentError, ConcealmentKind, ConcealmentPlan, ConcealmentScores, Explained, Outcome,
};
use jointscope_proof::{Answer, Answers, Case, NoAnswer};
use jointscope_rig::{HammerSetup, Instrument, frfs};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

/// Two blocks, a strip that shears and is glued, a known mass, a soft support: room for every kind of
/// concealment.
const EXPLAINING: &str = r#"{
  "bodies": {
    "A": { "mass": {"value": 1.10, "std": 0.002}, "inertia": {"value": 9.5e-4, "std": 5e-6}, "x_cg": -0.030,
           "masses": [ {"x": -0.05, "mass": 0.06} ] },
    "B": { "mass": {"value": 1.25, "std": 0.002}, "inertia": {"value": 1.1e-3, "std": 5e-6}, "x_cg": 0.096 } },
  "points": {
    "1": { "body": "A", "x": -0.060 }, "2": { "body": "A", "x": 0.0 },
    "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.127 }, "5": { "body": "A", "x": -0.02 } },
  "joints": { "J": { "from": "2", "to": "3",
    "beam": { "youngs_modulus": {"value": 2.07e11, "std": 2e9}, "second_moment": {"value": 3.6e-10, "std": 3e-12} } } },
  "supports": { "S": { "body": "A", "x": -0.03, "stiffness": 3e4 } },
  "physics": [ { "kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 9e3 } ] }"#;

fn explaining() -> Fixture {
    Fixture::from_json(EXPLAINING).unwrap()
}

fn pairs() -> [FrfPair; 6] {
    [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2"), ("4", "5"), ("3", "5")]
        .map(|(o, i)| FrfPair::transverse(o, i))
}

fn clean(fixture: &Fixture, pairs: &[FrfPair]) -> FrfSet {
    let lines = SpectralLines::even(10.0, 7.0, 130).unwrap();
    frfs(fixture, pairs, &lines, Instrument::AsDescribed).unwrap()
}

/// The recording of a fixture, with the noise of a good hammer test.
fn measured(fixture: &Fixture) -> FrfSet {
    let hammer = HammerSetup {
        averages: 8,
        noise_response: 0.004,
        noise_force: 0.0005,
        corner: 1200.0,
        spread: 0.2,
        common_hits: false,
        seed: 11,
    };
    hammer.measure(&clean(fixture, &pairs())).unwrap()
}

fn opened(plan: &ConcealmentPlan, recorded: &FrfSet) -> (Vec<Case>, Vec<Concealed>) {
    let (cases, sealed) = plan.conceal(&explaining(), recorded).unwrap();
    let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    (cases, sealed.open(&silent).unwrap())
}

fn plan(cases: usize) -> ConcealmentPlan {
    ConcealmentPlan { cases, seed: 3, ..ConcealmentPlan::default() }
}

/// An answer that finds `effects`, and repairs the fixture with them.
fn answer(case: &Case, effects: &[Effect]) -> Answer {
    let physics = case.believed.physics().iter().chain(effects).cloned().collect();
    Answer {
        verdict: if effects.is_empty() { Verdict::Consistent } else { Verdict::Explained },
        findings: effects.iter().map(|effect| found(effect, 0.95, |v| 0.01 * v.abs())).collect(),
        objectives: [1000.0, 100.0],
        chi2_per_dof: [10.0, 5.0, 1.0],
        refitted: case.believed.clone(),
        repaired: case.believed.clone().with_physics(physics).unwrap(),
        held_out: None,
    }
}

/// The scores of answers that find what `finds` says of each case's truth.
fn scored(cases: usize, finds: impl Fn(&Concealed) -> Vec<Effect> + Sync) -> ConcealmentScores {
    let (cases, truths) = opened(&plan(cases), &measured(&explaining()));
    let effects = |case: &Case| {
        let index = cases.iter().position(|other| other == case).unwrap();
        finds(&truths[index])
    };
    let answers = Answers::by(&cases, 1, |_| (), |case| Ok(answer(case, &effects(case))));
    ConcealmentScores::of(&cases, truths.clone(), &answers, 1)
}

fn truth_of(truth: &Concealed) -> Vec<Effect> {
    truth.expected.iter().map(|expected| expected.effect.clone()).collect()
}

#[test]
fn the_same_seed_conceals_the_same_and_another_seed_something_else() {
    let recorded = measured(&explaining());
    let seal = |plan: ConcealmentPlan| plan.conceal(&explaining(), &recorded).unwrap().1.digest().to_owned();
    assert_eq!(seal(plan(8)), seal(plan(8)));
    assert_ne!(seal(plan(8)), seal(ConcealmentPlan { seed: 4, ..plan(8) }));
    let (cases, truths) = opened(&plan(8), &recorded);
    let (alone, truth) = opened(&ConcealmentPlan { only: Some(6), ..plan(8) }, &recorded);
    assert_eq!((&alone[0], &alone[1]), (&cases[0], &cases[6]));
    assert_eq!(truth, [truths[0].clone(), truths[6].clone()]);
}

#[test]
fn the_first_case_is_as_it_is_and_every_fourth_after_it_has_its_quantities_stated_anew() {
    let recorded = measured(&explaining());
    let (cases, truths) = opened(&plan(9), &recorded);
    assert_eq!(cases[0], Case { believed: explaining(), recorded: recorded.clone() });
    let controls: Vec<usize> = truths.iter().filter(|t| t.is_control()).map(|t| t.index).collect();
    assert_eq!(controls, [0, 4, 8]);
    for control in [4, 8] {
        assert_eq!(cases[control].recorded, recorded);
        assert_ne!(cases[control].believed, explaining());
        assert_eq!(cases[control].believed.physics(), explaining().physics());
    }
    assert!(cases.iter().zip(&truths).skip(1).all(|(case, _)| *case != cases[0]));
}

#[test]
fn what_is_to_be_found_undoes_what_was_concealed() {
    // Noise-free and undamped: what was recorded must come back to rounding, of the laboratory's own model.
    let recorded = clean(&explaining(), &pairs());
    let (cases, truths) = opened(&plan(41), &recorded);
    let kinds: std::collections::BTreeSet<_> = truths.iter().filter_map(|truth| truth.kind).collect();
    assert_eq!(kinds.len(), ConcealmentKind::ALL.len(), "{kinds:?}");
    for (case, truth) in cases.iter().zip(&truths).filter(|(_, truth)| !truth.expected.is_empty()) {
        let alternatives = truth.expected.iter().flat_map(|expected| &expected.same).map(|e| vec![e.clone()]);
        for effects in std::iter::once(truth_of(truth)).chain(alternatives) {
            let physics = case.believed.physics().iter().chain(&effects).cloned().collect();
            let undone = case.believed.clone().with_physics(physics).unwrap();
            let predicted = clean(&undone, case.recorded.pairs());
            let off = apart(&predicted, &case.recorded);
            let before = apart(&clean(&case.believed, case.recorded.pairs()), &case.recorded);
            assert!(off < 1e-6 && before > 1e-5, "{}: {before} before, {off} after", truth.what);
        }
    }
}

/// √(Σ|a − b|²/Σ|b|²) of what is large at resonance and small between them alike.
fn apart(a: &FrfSet, b: &FrfSet) -> f64 {
    let relative = a.all_values().iter().zip(b.all_values()).map(|(a, b)| (a - b).norm() / b.norm());
    let mut all: Vec<f64> = relative.collect();
    all.sort_by(f64::total_cmp);
    all[all.len() * 9 / 10]
}

#[test]
fn a_channel_read_in_the_same_frfs_is_the_same_channel() {
    let two = [FrfPair::transverse("4", "1"), FrfPair::transverse("4", "2")];
    let only = |kind| ConcealmentPlan { cases: 14, kinds: vec![kind], ..plan(14) };
    for (kind, frfs) in [(ConcealmentKind::Gain, &two[..1]), (ConcealmentKind::Delay, &two)] {
        let (_, truths) = opened(&only(kind), &clean(&explaining(), frfs));
        for truth in truths.iter().filter(|truth| !truth.is_control()) {
            let expected = &truth.expected[0];
            let own = expected.effect.value(0);
            match frfs.len() {
                // Response and reference of one FRF.
                1 => assert!((expected.same[0].value(0) * own - 1.0).abs() < 1e-12, "{}", truth.what),
                _ => assert!(expected.same.is_empty(), "{}", truth.what),
            }
        }
    }
}

#[test]
fn who_finds_everything_is_told_so_and_who_finds_nothing_too() {
    let all = scored(9, truth_of);
    assert_eq!((all.share("found").of, all.share("quiet").of), (all.share("found").all, 2));
    assert!(all.share("found").all >= 4, "{all}");
    assert_eq!(all.share("extra").of, 0);
    let intervals = all.share("intervals");
    assert!(intervals.all > 0 && intervals.of == intervals.all, "{all}");
    let none = scored(9, |_| Vec::new());
    assert_eq!((none.share("found").of, none.share("quiet").of), (0, 2));
    let missed =
        |scores: &ConcealmentScores| scores.cases.iter().filter(|c| c.outcome == Outcome::Missed).count();
    assert!(missed(&none) >= 4, "{none}");
    assert!(none.to_string().contains("missed") && all.to_string().contains("holds it"));
}

#[test]
fn what_the_control_has_too_is_no_false_alarm_and_what_it_has_not_is() {
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[1.0]);
    let always = scored(5, |_| vec![window.clone()]);
    assert_eq!(always.own.len(), 1);
    assert_eq!((always.share("quiet").of, always.cases[4].outcome), (1, Outcome::Quiet));
    assert!(always.cases.iter().all(|case| case.extra.is_empty()));
    let sometimes = scored(5, |truth| if truth.index == 4 { vec![window.clone()] } else { Vec::new() });
    assert_eq!((sometimes.share("quiet").of, sometimes.cases[4].outcome), (0, Outcome::FalseAlarm));
}

#[test]
fn another_place_is_told_from_another_kind() {
    let elsewhere = |truth: &Concealed| {
        let moved = |effect: &Effect| {
            let place = match &effect.place {
                Place::Reference(name) if name == "1" => Place::Reference("2".into()),
                Place::Reference(_) => Place::Reference("1".into()),
                Place::Response(_) => Place::Reference("1".into()),
                other => other.clone(),
            };
            Effect { place, ..effect.clone() }
        };
        truth_of(truth).iter().map(moved).collect()
    };
    let recorded = measured(&explaining());
    let gains = ConcealmentPlan { kinds: vec![ConcealmentKind::Gain], ..plan(4) };
    let (cases, truths) = opened(&gains, &recorded);
    let by = |finds: &(dyn Fn(&Concealed) -> Vec<Effect> + Sync)| {
        let all =
            cases.iter().zip(&truths).map(|(case, truth)| answer(case, &finds(truth))).collect::<Vec<_>>();
        let index = |case: &Case| cases.iter().position(|other| other == case).unwrap();
        let answers = Answers::by(&cases, 1, |_| (), |case| Ok(all[index(case)].clone()));
        let scores = ConcealmentScores::of(&cases, truths.clone(), &answers, 1);
        scores.cases.iter().skip(1).map(|case| case.outcome).collect::<Vec<_>>()
    };
    assert_eq!(by(&elsewhere), [Outcome::Elsewhere; 3]);
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[1.0]);
    let another = |truth: &Concealed| if truth.is_control() { Vec::new() } else { vec![window.clone()] };
    assert_eq!(by(&another), [Outcome::Confused; 3]);
}

#[test]
fn what_cannot_be_concealed_is_refused_in_a_sentence() {
    let recorded = clean(&explaining(), &pairs());
    let refused = |plan: ConcealmentPlan, fixture: &str| {
        plan.conceal(&Fixture::from_json(fixture).unwrap(), &recorded).unwrap_err()
    };
    assert_eq!(refused(plan(1), EXPLAINING), ConcealmentError::TooFew(1));
    let beyond = ConcealmentPlan { only: Some(8), ..plan(8) };
    assert_eq!(refused(beyond, EXPLAINING), ConcealmentError::NoSuchCase { only: 8, cases: 8 });
    let bare = r#"{ "bodies": { "A": { "mass": 1.0, "rotates": false } }, "points": { "1": { "body": "A", "x": 0 } } }"#;
    let entries = ConcealmentPlan { kinds: vec![ConcealmentKind::Entry, ConcealmentKind::Point], ..plan(8) };
    let sentence = refused(entries, bare).to_string();
    assert!(sentence.contains("(entry, point)") && sentence.contains("mass, delay"), "{sentence}");
}

#[test]
fn a_deleted_entry_and_a_scaled_channel_are_found_in_a_recording_that_the_fixture_as_given_does_not_explain()
{
    // The analyst forgot the known mass: the first diagnosis makes it good.
    let mut file = explaining().to_value();
    file["damping"] = serde_json::json!({ "modal_ratios": [0.003, 0.004] });
    let recorded = measured(&Fixture::from_json(&file.to_string()).unwrap());
    file["bodies"]["A"].as_object_mut().unwrap().remove("masses");
    let given = Fixture::from_json(&file.to_string()).unwrap();
    let explained = Explained::of(&given, &recorded, 1).unwrap();
    assert!(!explained.as_given() && explained.to_string().contains("added_mass A"), "{explained}");
    assert_eq!(explained.fixture.physics().len(), 2);
    let kinds = vec![ConcealmentKind::Entry, ConcealmentKind::Gain];
    let plan = ConcealmentPlan { kinds, ..plan(3) };
    let (cases, sealed) = plan.conceal(&explained.fixture, &recorded).unwrap();
    let answers = explained.answers(&cases, 2, |_| ());
    let scores = ConcealmentScores::of(&cases, sealed.open(&answers).unwrap(), &answers, 2);
    assert_eq!(scores.own, []);
    assert_eq!((scores.share("found").of, scores.share("found").all), (2, 2), "{scores}");
}
