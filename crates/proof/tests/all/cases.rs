//! How cases are made, sealed and judged.

use crate::common::{answer, found, opened};
use jointscope_diagnosis::Observation;
use jointscope_proof::{
    Answers, BrokenSeal, Case, GenerationError, HIDDEN_KINDS, Judged, NoAnswer, Plan, Reference, Role,
    Sealable, SealedTruths, Truth,
};
use std::sync::atomic::{AtomicUsize, Ordering};

fn plan(cases: usize) -> Plan {
    Plan { cases, seed: 3, ..Plan::default() }
}

#[test]
fn the_same_seed_makes_the_same_cases_and_another_seed_others() {
    let (cases, sealed) = plan(8).draw().unwrap();
    let (again, resealed) = plan(8).draw().unwrap();
    assert_eq!(cases, again);
    assert_eq!(sealed.digest(), resealed.digest());
    let (others, other_seal) = Plan { seed: 4, ..plan(8) }.draw().unwrap();
    assert!(cases.iter().zip(&others).all(|(a, b)| a.believed != b.believed));
    assert_ne!(sealed.digest(), other_seal.digest());
}

#[test]
fn a_case_is_the_same_alone_and_among_others() {
    let (cases, truths) = opened(&plan(8));
    let (alone, truth) = opened(&Plan { only: Some(5), ..plan(8) });
    assert_eq!(alone, cases[5..6]);
    assert_eq!(truth, truths[5..6]);
    let beyond = Plan { only: Some(8), ..plan(8) }.draw().unwrap_err();
    assert_eq!(beyond, GenerationError::NoSuchCase { only: 8, cases: 8 });
    assert_eq!(plan(0).draw().unwrap_err(), GenerationError::NoCases);
}

#[test]
fn fresh_cases_follow_from_their_text_alone() {
    let with = |seed, text: &str| Plan { seed, fresh_from: Some(text.into()), ..plan(16) };
    let fresh = |plan: &Plan| opened(plan).0.split_off(12);
    assert_eq!(fresh(&with(3, "one commit")), fresh(&with(4, "one commit")));
    assert_ne!(fresh(&with(3, "one commit")), fresh(&with(3, "another commit")));
    let (_, truths) = opened(&with(3, "one commit"));
    assert_eq!(truths.iter().filter(|truth| truth.fresh).count(), 4);
}

#[test]
fn every_kind_of_effect_that_seeds_draw_is_hidden_in_turn() {
    let (_, truths) = opened(&plan(32));
    let singles = || truths.iter().filter(|truth| truth.role == Role::Single);
    for kind in HIDDEN_KINDS {
        let count = singles().filter(|truth| truth.effects()[0].kind == kind).count();
        assert_eq!(count, 1, "{}", kind.name());
    }
    assert!(truths.iter().all(|truth| match truth.role {
        Role::Null => truth.effects().is_empty() && truth.outside.is_none(),
        Role::Single => truth.effects().len() == 1,
        Role::Double => truth.effects().len() == 2,
        Role::Outside => truth.effects().is_empty() && truth.outside.is_some(),
        Role::Graded => false,
    }));
}

#[test]
fn what_nobody_recorded_is_neither_recorded_nor_a_reciprocal_of_it() {
    let (cases, truths) = opened(&plan(8));
    for (case, truth) in cases.iter().zip(&truths) {
        assert!(!truth.unseen.is_empty());
        for pair in &truth.unseen {
            let back = jointscope_spectra::FrfPair::new(pair.reference.clone(), pair.response.clone());
            assert!(
                case.recorded.index_of(pair).is_none() && case.recorded.index_of(&back).is_none(),
                "{pair}"
            );
        }
    }
}

#[test]
fn the_seal_is_broken_without_answers_to_all_cases() {
    let (cases, sealed) = plan(4).draw().unwrap();
    let some = Answers::by(&cases[..3], 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    assert!(sealed.open(&some).is_none());
}

/// Truths as a file would hold them, with the hash that was published.
fn filed(cases: &[Case], truths: &[Truth]) -> (String, String) {
    let text = serde_json::Value::Array(truths.iter().map(Sealable::to_value).collect()).to_string();
    let (_, sealed) = plan(cases.len()).draw().unwrap();
    (text, sealed.digest().to_owned())
}

#[test]
fn truths_come_out_of_their_file_as_they_went_in_and_against_answers_alone() {
    let (cases, truths) = opened(&plan(8));
    let (text, published) = filed(&cases, &truths);
    let silent = |cases: &[Case]| Answers::by(cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    let open = |only, cases: &[Case]| {
        SealedTruths::<Truth>::filed(&text, &published, only).unwrap().open(&silent(cases))
    };
    assert_eq!(open(None, &cases).unwrap(), truths);
    assert_eq!(open(Some(5), &cases[5..6]).unwrap(), truths[5..6]);
    assert!(open(None, &cases[..7]).is_none(), "an answer is missing");
}

#[test]
fn a_file_of_truths_that_was_changed_is_not_the_published_one() {
    let (cases, truths) = opened(&plan(2));
    let (text, published) = filed(&cases, &truths);
    let changed = text.replacen("single", "double", 1);
    let broken: BrokenSeal = SealedTruths::<Truth>::filed(&changed, &published, None).unwrap_err();
    assert_eq!(broken.published, published);
    assert!(broken.to_string().contains("were changed"), "{broken}");
}

#[test]
fn answers_keep_the_order_of_the_cases_on_any_number_of_threads() {
    let (cases, truths) = opened(&plan(8));
    let by = |threads| {
        let told = AtomicUsize::new(0);
        let answers = Answers::by(
            &cases,
            threads,
            |done| _ = told.fetch_max(done, Ordering::Relaxed),
            |case| {
                let index = cases.iter().position(|other| other == case).unwrap();
                // The first take longest.
                std::thread::sleep(std::time::Duration::from_millis(8 - index as u64));
                Ok(answer(&truths[index], Vec::new()))
            },
        );
        assert_eq!((told.into_inner(), answers.seconds().len()), (8, 8));
        answers.to_value()
    };
    assert_eq!(by(1), by(3));
}

#[test]
fn an_answerer_that_breaks_down_leaves_the_others_alone() {
    let (cases, truths) = opened(&plan(3));
    let answers = Answers::by(
        &cases,
        2,
        |_| (),
        |case| {
            let index = cases.iter().position(|other| other == case).unwrap();
            assert!(index != 1, "a fault in one case");
            Ok(answer(&truths[index], Vec::new()))
        },
    );
    let given: Vec<bool> = answers.all().iter().map(Result::is_ok).collect();
    assert_eq!(given, [true, false, true]);
}

#[test]
fn the_fit_about_the_truth_is_within_the_noise_and_bounds_the_hidden_parameters() {
    let (cases, truths) = opened(&Plan { only: Some(0), ..plan(8) });
    let observation = Observation::new(&cases[0].recorded, |_| true).unwrap();
    let reference = Reference::of(&cases[0].believed, &truths[0].fixture, &observation).unwrap();
    let degrees = observation.degrees() as f64;
    assert!(reference.objective <= reference.at_truth);
    assert!((reference.objective / degrees - 1.0).abs() < 0.15, "{reference:?} of {degrees}");
    // What a fit may gain over the truth is one a quantity and parameter, on average.
    assert!(reference.at_truth - reference.objective < 60.0, "{reference:?}");
    let mass = reference.bounds[0][1].unwrap();
    let hidden = truths[0].effects()[0].value(1).abs();
    assert!(mass > 0.0 && mass < hidden, "mass {hidden} kg known to {mass}");
}

#[test]
fn the_truth_as_an_answer_is_right_in_every_respect() {
    let (cases, truths) = opened(&Plan { only: Some(0), ..plan(8) });
    let effect = &truths[0].effects()[0];
    let answers =
        Answers::by(&cases, 1, |_| (), |_| Ok(answer(&truths[0], vec![found(effect, 0.99, |v| v.abs())])));
    let judged = Judged::all(&cases, truths.clone(), &answers, 1, |_| ());
    let fits = &judged[0].fits;
    assert!(fits.repaired >= fits.truth && fits.repaired < fits.truth + 60.0, "{fits:?}");
    assert!(fits.refitted > fits.repaired, "{fits:?}");
    assert!(fits.beyond_tolerance.is_empty(), "true quantities lie within their tolerances: {fits:?}");
    let [refitted, repaired] = fits.unseen.unwrap();
    assert!(repaired < 1e-6 && refitted > 1e-4, "unseen FRFs: {refitted}, {repaired}");
}
