//! Scores of answerers whose worth is known.

use crate::common::{answer, fits, found, judged, opened};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::{Effect, EffectKind, Place};
use jointscope_proof::{Judged, NOTHING, Name, NoAnswer, Plan, Role, Score, Share, Truth};
use rand::RngExt;

fn truths(cases: usize) -> Vec<Truth> {
    opened(&Plan { cases, seed: 11, ..Plan::default() }).1
}

fn share(score: &Score, key: &str) -> Share {
    score.rate(key).unwrap().share
}

#[test]
fn a_perfect_answerer_scores_everything() {
    let all: Vec<Judged> = truths(32).iter().map(|truth| judged(truth, truth.effects())).collect();
    let score = Score::of(&all);
    for key in
        ["nulls_consistent", "single_kind", "single_place", "single_certain", "coverage", "double_both"]
    {
        let share = share(&score, key);
        assert!(share.all > 0 && share.of == share.all, "{key}: {share:?}");
    }
    for key in ["single_extra", "held_out_worse", "unseen_worse", "false_minimum"] {
        assert_eq!(share(&score, key).of, 0, "{key}");
    }
    assert!((score.figure("interval_width").unwrap().value.unwrap() - 1.0).abs() < 1e-9);
    assert!((score.figure("log_score").unwrap().value.unwrap() - 0.99f64.ln()).abs() < 1e-9);
    assert!(all.iter().all(|judged| judged.faults().is_empty()));
}

#[test]
fn answers_to_other_cases_score_at_chance() {
    let truths = truths(64);
    let singles: Vec<&Truth> = truths.iter().filter(|truth| truth.role == Role::Single).collect();
    let next = singles.iter().cycle().skip(1);
    let all: Vec<Judged> = singles
        .iter()
        .zip(next)
        .map(|(truth, other)| {
            // What was hidden elsewhere, as an answer to this case; the fixture handed back does not matter
            // here.
            let findings = other.effects().iter().map(|effect| found(effect, 0.99, |_| 0.0)).collect();
            let own = Judged { answer: Ok(answer(other, findings)), ..judged(truth, &[]) };
            Judged { fits: jointscope_proof::IndependentFits { repaired: 900.0, ..own.fits }, ..own }
        })
        .collect();
    let score = Score::of(&all);
    let right = share(&score, "single_place");
    assert!(right.all == singles.len() && right.of * 10 < right.all, "{right:?}");
    assert_eq!(share(&score, "single_certain").of, right.of);
    assert!(score.figure("log_score").unwrap().value.unwrap() < -6.0);
}

#[test]
fn who_always_says_consistent_is_right_on_nulls_alone() {
    let all: Vec<Judged> = truths(32).iter().map(|truth| judged(truth, &[])).collect();
    let score = Score::of(&all);
    let nulls = share(&score, "nulls_consistent");
    assert_eq!((nulls.of, nulls.all), (8, 8));
    for key in ["single_kind", "single_place", "single_certain", "double_both"] {
        let share = share(&score, key);
        assert!(share.all > 0 && share.of == 0, "{key}: {share:?}");
    }
    assert_eq!(score.confusion.count(EffectKind::AddedMass.name(), NOTHING), 1);
    assert!(all[0].faults().contains(&"missed".to_owned()), "{:?}", all[0].faults());
    let text = score.to_string();
    assert!(text.contains("single effects: kind right") && text.contains("missed"), "{text}");
}

#[test]
fn who_always_finds_something_fails_on_nulls() {
    let mass = |truth: &Truth| {
        let body = truth.fixture.bodies()[0].name.clone();
        Effect::new(EffectKind::AddedMass, Place::Body(body), None, &[0.0, 0.01])
    };
    let all: Vec<Judged> = truths(16).iter().map(|truth| judged(truth, &[mass(truth)])).collect();
    let score = Score::of(&all);
    assert_eq!(share(&score, "nulls_consistent").of, 0);
    assert!(score.confusion.count(NOTHING, EffectKind::AddedMass.name()) > 0);
}

#[test]
fn a_name_that_fits_as_well_as_the_truth_is_right_and_one_that_does_not_is_wrong() {
    let truths = truths(8);
    let truth = truths.iter().find(|truth| truth.role == Role::Single).unwrap();
    let other = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[5.0]);
    for (objective, right) in [(108.9, true), (109.1, false)] {
        let mut case = judged(truth, std::slice::from_ref(&other));
        case.fits.others.insert(Name::of(&other), objective);
        case.fits.repaired = objective;
        assert_eq!(share(&Score::of(&[case]), "single_place").of, usize::from(right), "{objective}");
    }
}

#[test]
fn an_effect_that_does_not_show_is_not_asked_for() {
    let truths = truths(8);
    let truth = truths.iter().find(|truth| truth.role == Role::Single).unwrap();
    for (refitted, asked) in [(149.0, 0), (151.0, 1)] {
        let mut case = judged(truth, &[]);
        case.fits.refitted = refitted;
        assert_eq!(share(&Score::of(&[case]), "single_place").all, asked, "{refitted}");
    }
}

#[test]
fn intervals_of_the_right_width_cover_and_halved_ones_do_not() {
    let truths = truths(200);
    let mut random = jointscope_rig::generator(5);
    let mut normal = || (0..12).map(|_| random.random_range(-0.5..0.5f64)).sum::<f64>();
    let mut covering = |width: f64| {
        let all: Vec<Judged> = truths
            .iter()
            .filter(|truth| truth.role == Role::Single)
            .map(|truth| {
                let mut estimate = truth.effects().to_vec();
                for quantity in estimate.iter_mut().flat_map(|effect| &mut effect.parameters) {
                    quantity.value += 0.01 * quantity.value.abs() * normal();
                }
                let sizes: Vec<f64> =
                    truth.effects()[0].parameters.iter().map(|q| 0.01 * q.value.abs()).collect();
                let mut finding = found(&estimate[0], 0.99, |_| 0.0);
                for ((interval, quantity), size) in
                    finding.intervals.iter_mut().zip(&estimate[0].parameters).zip(sizes)
                {
                    let half = 1.96 * width * size;
                    *interval = Some([quantity.value - half, quantity.value + half]);
                }
                Judged { truth: truth.clone(), answer: Ok(answer(truth, vec![finding])), fits: fits(truth) }
            })
            .collect();
        let score = Score::of(&all);
        let rate = *score.rate("coverage").unwrap();
        (rate.share.value().unwrap(), score.figure("interval_width").unwrap().value.unwrap())
    };
    let (covered, width) = covering(1.0);
    assert!((0.92..=0.98).contains(&covered) && (width - 1.0).abs() < 1e-9, "{covered}, width {width}");
    let (covered, width) = covering(0.5);
    assert!((0.55..0.8).contains(&covered) && (width - 0.5).abs() < 1e-9, "{covered}, width {width}");
}

#[test]
fn an_interval_that_is_not_stated_covers_nothing() {
    let truths = truths(8);
    let truth = truths.iter().find(|truth| truth.role == Role::Single).unwrap();
    let mut case = judged(truth, truth.effects());
    case.answer.as_mut().unwrap().findings[0].intervals.fill(None);
    let coverage = share(&Score::of(&[case]), "coverage");
    assert!(coverage.all > 0 && coverage.of == 0, "{coverage:?}");
}

#[test]
fn of_two_effects_both_must_be_right() {
    let truths = truths(8);
    let truth = truths.iter().find(|truth| truth.role == Role::Double).unwrap();
    let both = truth.effects();
    let window = |decay| Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[decay]);
    let bad = |case: Judged| Judged {
        fits: jointscope_proof::IndependentFits { repaired: 400.0, ..case.fits.clone() },
        ..case
    };
    let with = |one: &Effect| vec![one.clone(), window(5.0)];
    let cases = [
        ("both", judged(truth, both), 1),
        ("one", bad(judged(truth, &both[..1])), 0),
        ("one, and another in the second's stead", bad(judged(truth, &with(&both[0]))), 0),
        ("two that fit as well", judged(truth, &with(&both[1])), 1),
        ("both and a third", bad(judged(truth, &[both, &[window(5.0)]].concat())), 1),
        ("nothing", bad(judged(truth, &[])), 0),
    ];
    for (what, case, right) in cases {
        let share = share(&Score::of(&[case]), "double_both");
        assert_eq!((share.of, share.all), (right, 1), "{what}");
    }
    let mut hardly = judged(truth, both);
    hardly.fits.without[1] = 130.0;
    assert_eq!(share(&Score::of(&[hardly]), "double_both").all, 0, "one of them does not show");
}

#[test]
fn a_claim_about_physics_outside_the_vocabulary_is_wrong_unless_it_cannot_be_told_from_the_truth() {
    let truths = truths(8);
    let truth = truths.iter().find(|truth| truth.role == Role::Outside).unwrap();
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[5.0]);
    for (probability, repaired, wrong) in [(0.95, 400.0, 1), (0.8, 400.0, 0), (0.95, 105.0, 0)] {
        let mut case = judged(truth, std::slice::from_ref(&window));
        case.fits.repaired = repaired;
        case.answer.as_mut().unwrap().findings[0].probability = probability;
        let share = share(&Score::of(&[case]), "outside_wrong_name");
        assert_eq!((share.of, share.all), (wrong, 1), "probability {probability}, objective {repaired}");
    }
}

#[test]
fn boasting_shows_in_the_reliability_and_the_log_score() {
    let truths = truths(64);
    let singles: Vec<&Truth> = truths.iter().filter(|truth| truth.role == Role::Single).collect();
    // Right every other time, sure of it every time.
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[5.0]);
    let all: Vec<Judged> = singles
        .iter()
        .enumerate()
        .map(|(i, truth)| {
            if i % 2 == 0 {
                judged(truth, truth.effects())
            } else {
                judged(truth, std::slice::from_ref(&window))
            }
        })
        .collect();
    let score = Score::of(&all);
    let last = score.reliability.0.last().unwrap();
    assert!(last.stated > 0.98 && last.true_names.value().unwrap() < 0.6, "{last:?}");
    assert!(score.figure("log_score").unwrap().value.unwrap() < -3.0);
}

#[test]
fn a_refusal_counts_against_the_diagnosis() {
    let all: Vec<Judged> = truths(8)
        .iter()
        .map(|truth| Judged { answer: Err(NoAnswer::BrokeDown), ..judged(truth, truth.effects()) })
        .collect();
    let score = Score::of(&all);
    assert_eq!(share(&score, "nulls_consistent"), Share { of: 0, all: 2 });
    assert_eq!(share(&score, "single_place"), Share { of: 0, all: 4 });
    assert!(all.iter().all(|judged| judged.faults() == ["no answer"]));
}

#[test]
fn fresh_cases_that_score_differently_are_told() {
    let plan = Plan { cases: 160, seed: 11, fresh_from: Some("a commit".into()), ..Plan::default() };
    let (_, truths) = opened(&plan);
    let score_of = |good: &dyn Fn(&Truth) -> bool| {
        let answered = |truth: &Truth| if good(truth) { truth.effects().to_vec() } else { Vec::new() };
        Score::of(&truths.iter().map(|truth| judged(truth, &answered(truth))).collect::<Vec<_>>())
    };
    let compared = |score: &Score| {
        let comparison = score.comparisons.iter().find(|c| c.key == "single_place").copied().unwrap();
        (comparison.fresh.all, comparison.probability)
    };
    let (fresh, probability) = compared(&score_of(&|_| true));
    assert!(fresh == 20 && probability > 0.99, "{fresh} fresh, {probability}");
    let (_, probability) = compared(&score_of(&|truth| !truth.fresh));
    assert!(probability < jointscope_proof::CHANCE, "{probability}");
    assert!(score_of(&|truth| !truth.fresh).to_string().contains("differ"));
}

#[test]
fn verdicts_are_counted_by_role() {
    let truths = truths(8);
    let mut all: Vec<Judged> = truths.iter().map(|truth| judged(truth, truth.effects())).collect();
    let outside = all.iter_mut().find(|judged| judged.truth.role == Role::Outside).unwrap();
    outside.answer.as_mut().unwrap().verdict = Verdict::Unexplained;
    let score = Score::of(&all);
    let (_, given) = score.verdicts.iter().find(|(role, _)| *role == Role::Outside).unwrap();
    assert!(given.contains(&("unexplained", 1)), "{given:?}");
}
