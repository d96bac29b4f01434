//! Cases by the other routes: sealed with the rest, judged by rules of their own.

use jointscope_diagnosis::{Verdict, restored};
use jointscope_fixture::{Dof, Effect, EffectKind, Place};
use jointscope_nonlinear::Verdict as Conclusion;
use jointscope_proof::{
    Answer, Answers, AsIsTruth, Case, Family, Filed, Found, Judgeable, LumpedTruth, ModalErrorsTruth, Opened,
    Plan, Precision, Questions, Replies, Role, RouteScore, RouteScores, Sealable, SolidTruth, StruckAnswer,
    StruckAnswers, StruckCase, StruckRole, StruckTruth,
};
use jointscope_recordings::{ReadOptions, Source, hits_of};
use jointscope_rig::{Instrument, Outside, frfs};
use jointscope_spectra::FrfSet;
use std::collections::BTreeSet;

fn drawn(plan: &Plan) -> (Questions, Opened) {
    let (questions, sealed) = plan.draw_routes().unwrap();
    let truths = sealed.open(&Replies::none(&questions)).unwrap();
    (questions, truths.into_iter().collect())
}

/// The scores of cases that were answered so.
fn scores(questions: &Questions, truths: Opened, replies: &Replies) -> Vec<RouteScore> {
    RouteScores::of(questions, truths, replies, 1, |_| ()).0
}

/// Answers of which those to one route are still to come.
fn silent() -> Replies {
    Replies::none(&Questions::default())
}

fn found(effect: &Effect) -> Found {
    Found {
        effect: effect.clone(),
        intervals: effect.parameters.iter().map(|q| Some([0.9 * q.value, 1.1 * q.value])).collect(),
        probability: 1.0,
        alternatives: Vec::new(),
    }
}

/// Solid cases answered by `name`, from their truths.
fn solid_score(
    cases: &[Case],
    truths: &[SolidTruth],
    name: impl Fn(&SolidTruth) -> Vec<Effect> + Sync,
) -> RouteScore {
    let answers = Answers::by(
        cases,
        1,
        |_| (),
        |case| {
            let position = cases.iter().position(|known| known == case).unwrap();
            let truth = &truths[position];
            let effects = name(truth);
            let repaired =
                truth.lumped.clone().with_physics(Vec::new()).unwrap().with_physics(effects.clone());
            Ok(Answer {
                verdict: if effects.is_empty() { Verdict::Consistent } else { Verdict::Explained },
                findings: effects.iter().map(found).collect(),
                objectives: [0.0; 2],
                chi2_per_dof: [1.0; 3],
                refitted: case.believed.clone(),
                repaired: repaired.unwrap(),
                held_out: None,
            })
        },
    );
    let questions = Questions { solid: cases.to_vec(), ..Questions::default() };
    let truths = Opened { solid: truths.to_vec(), ..Opened::default() };
    scores(&questions, truths, &Replies { solid: answers, ..silent() }).remove(0)
}

fn share(score: &RouteScore, key: &str) -> (usize, usize) {
    let share = score.rate(key).unwrap().share;
    (share.of, share.all)
}

#[test]
fn all_routes_are_under_one_seal_that_opens_against_all_answers_only() {
    let plan = Plan { cases: 2, solid: 1, struck: 1, seed: 4, ..Plan::default() };
    let (questions, sealed) = plan.draw_routes().unwrap();
    assert_eq!(questions.all().len(), 4);
    let (_, without) = Plan { struck: 0, ..plan.clone() }.draw_routes().unwrap();
    assert_ne!(sealed.digest(), without.digest(), "the seal holds every truth");
    let some = Replies { solid: Answers::none(0), ..Replies::none(&questions) };
    assert!(sealed.open(&some).is_none(), "an answer is missing");
    let (_, laboratory) = plan.draw().unwrap();
    let (_, alone) = Plan { solid: 0, struck: 0, ..plan }.draw_routes().unwrap();
    assert_eq!(laboratory.digest(), alone.digest(), "the laboratory's truths are sealed as ever");
}

#[test]
fn a_case_is_the_same_however_many_are_drawn_with_it() {
    let plan = Plan { cases: 0, solid: 2, struck: 2, seed: 9, ..Plan::default() };
    let (all, _) = drawn(&plan);
    for (only, solid) in [(1, Some(1)), (3, None)] {
        let (one, truths) = drawn(&Plan { only: Some(only), ..plan.clone() });
        match solid {
            Some(position) => {
                assert_eq!(one.solid, all.solid[position..=position]);
                assert_eq!(truths.solid[0].index, only);
            }
            None => {
                assert_eq!(one.struck, all.struck[1..]);
                assert_eq!(truths.struck[0].index, only);
            }
        }
    }
    assert_eq!((Plan::along_with(19), Plan::along_with(20), Plan::along_with(300)), (0, 1, 15));
}

#[test]
fn solids_are_judged_by_what_is_in_them() {
    // Three singles, a null and a double.
    let plan = Plan { cases: 0, solid: 5, seed: 1, ..Plan::default() };
    let (questions, truths) = drawn(&plan);
    let (cases, truths) = (&questions.solid, &truths.solid);
    let singles = truths.iter().filter(|truth| truth.role == Role::Single).count();
    let perfect = solid_score(cases, truths, |truth| truth.effects().to_vec());
    assert_eq!(share(&perfect, "nulls_consistent"), (1, 1));
    let (right, asked) = share(&perfect, "single_place");
    assert!(right == asked && asked + 1 >= singles, "{right} of {asked}, {singles} drawn");
    assert_eq!(share(&perfect, "sizes").0, share(&perfect, "sizes").1);
    assert!(perfect.figure("unseen_ratio").unwrap().value.unwrap() > 1.0, "{perfect}");
    let nothing = solid_score(cases, truths, |_| Vec::new());
    assert_eq!(share(&nothing, "single_place"), (0, asked));
    assert!(nothing.lines.iter().any(|line| line.faults.contains(&"missed".to_owned())));
    let always = solid_score(cases, truths, |_| {
        vec![Effect::new(EffectKind::LossFactor, Place::Joint("J".into()), None, &[0.02])]
    });
    assert_eq!(share(&always, "null_finding"), (1, 1));
    assert_eq!((share(&always, "single_place").0, share(&always, "wrong_name").0), (0, 5));
}

#[test]
fn a_spring_across_the_strip_is_right_by_any_of_its_names_and_a_soft_rotation_is_not() {
    let plan = Plan { cases: 0, solid: 8, seed: 1, only: Some(7), ..Plan::default() };
    let (questions, truths) = drawn(&plan);
    let (case, truth) = (&questions.solid, &truths.solid);
    assert_eq!((truth[0].role, truth[0].effects()[0].dof), (Role::Single, Some(Dof::Translation)));
    let score = |name: &dyn Fn(&Effect, f64) -> Effect| {
        let name = |truth: &SolidTruth| {
            let length = truth.lumped.joint_length(&truth.lumped.joints()[0]);
            vec![name(&truth.effects()[0], length)]
        };
        let answers = |truth: &SolidTruth| name(truth);
        // A trait object is not shared between workers; the answer is made beforehand.
        let made = answers(&truth[0]);
        solid_score(case, truth, move |_| made.clone())
    };
    let sheared = score(&|hidden, length| {
        Effect::new(
            EffectKind::ShearDeformation,
            Place::Joint("J".into()),
            None,
            &[hidden.value(0) * length, 0.0],
        )
    });
    assert_eq!((share(&sheared, "single_place"), share(&sheared, "sizes")), ((1, 1), (1, 1)));
    let turned = score(&|hidden, _| {
        Effect::new(EffectKind::InterfaceCompliance, hidden.place.clone(), Some(Dof::Rotation), &[1e4, 0.0])
    });
    assert_eq!(share(&turned, "single_place"), (0, 1));
    assert_eq!(turned.lines[0].faults[0], "wrong name");
}

/// Cases of hits answered by `laws`, from their truths.
fn struck_score(
    cases: &[StruckCase],
    truths: &[StruckTruth],
    laws: impl Fn(&StruckTruth) -> Vec<Effect> + Sync,
) -> RouteScore {
    let reply = |case: &StruckCase| {
        let position = cases.iter().position(|known| known == case).unwrap();
        let laws = laws(&truths[position]);
        Ok(StruckAnswer {
            verdict: if laws.is_empty() { Conclusion::Consistent } else { Conclusion::Explained },
            p_value: Some(if laws.is_empty() { 0.5 } else { 0.0 }),
            findings: laws.iter().map(found).collect(),
            chi2_per_dof: None,
            held_out: (!laws.is_empty()).then_some([0.3, 0.01]),
            linear: None,
        })
    };
    let answers = StruckAnswers::by(cases, 1, |_| (), reply);
    let questions = Questions { struck: cases.to_vec(), ..Questions::default() };
    let truths = Opened { struck: truths.to_vec(), ..Opened::default() };
    scores(&questions, truths, &Replies { struck: answers, ..silent() }).remove(0)
}

#[test]
fn hits_are_judged_by_the_law_that_they_exercise() {
    let plan = Plan { cases: 0, struck: 8, seed: 5, ..Plan::default() };
    let (questions, truths) = drawn(&plan);
    let (cases, truths) = (&questions.struck, &truths.struck);
    let perfect = struck_score(cases, truths, |truth| match truth.role {
        StruckRole::Law => truth.law().into_iter().cloned().collect(),
        _ => Vec::new(),
    });
    assert_eq!((share(&perfect, "law_named"), share(&perfect, "linear_alarm")), ((5, 5), (0, 2)));
    assert_eq!((share(&perfect, "idle_named"), share(&perfect, "law_wrong")), ((0, 1), (0, 5)));
    assert_eq!(share(&perfect, "coverage").0, share(&perfect, "coverage").1);
    let never = struck_score(cases, truths, |_| Vec::new());
    assert_eq!((share(&never, "law_noticed"), share(&never, "linear_alarm")), ((0, 5), (0, 2)));
    let always = struck_score(cases, truths, |truth| {
        // A law that is another's: of the other kind.
        let kind = match truth.law().map(|law| law.kind) {
            Some(EffectKind::Gap) => EffectKind::CubicStiffness,
            _ => EffectKind::Gap,
        };
        let values: &[f64] = if kind == EffectKind::Gap { &[1e-5, 1e6] } else { &[1e14] };
        vec![Effect::new(kind, Place::Joint("J".into()), Some(Dof::Translation), values)]
    });
    assert_eq!((share(&always, "law_named").0, share(&always, "law_wrong").0), (0, 5));
    assert_eq!((share(&always, "linear_alarm"), share(&always, "idle_named")), ((2, 2), (1, 1)));
}

#[test]
fn hits_are_written_as_they_are_and_an_idle_law_leaves_them_in_proportion() {
    let plan = Plan { cases: 0, struck: 5, seed: 2, ..Plan::default() };
    let (questions, truths) = drawn(&plan);
    let case = &questions.struck[4];
    let file = jointscope_uff::read(&case.recording(Precision::Double).unwrap()).unwrap();
    let sources = [Source { name: "hammer-test.uff".into(), file }];
    let read = hits_of(&sources, Some(&case.believed), &ReadOptions::default()).unwrap();
    assert_eq!(read.hits, case.recorded);
    let truth = &truths.struck[4];
    assert_eq!(truth.role, StruckRole::Idle);
    // The same blows without the law give the same motion, noise included: it is drawn alike.
    let plain = truth.fixture.clone().with_physics(Vec::new()).unwrap();
    let (struck, read) =
        ([case.recorded[0].struck().clone()], [case.recorded[0].responses()[0].channel.clone()]);
    let recorded =
        |fixture| truth.test.record(fixture, &struck, &read, &mut jointscope_rig::generator(3)).unwrap();
    for (a, b) in recorded(&truth.fixture).iter().zip(&recorded(&plain)) {
        let (a, b) = (&a.responses()[0].values, &b.responses()[0].values);
        let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        let size: f64 = b.iter().map(|b| b * b).sum();
        assert!((off / size).sqrt() < 1e-4, "{}", (off / size).sqrt());
    }
}

#[test]
fn a_plan_says_which_routes_it_takes() {
    let plan =
        |cases, solid, struck, only| Plan { cases, solid, struck, only, ..Plan::default() }.to_string();
    assert_eq!(plan(40, 2, 2, None), "40 cases, seed 1, and 2 solid, and 2 struck");
    assert_eq!(plan(0, 8, 3, None), "8 solid cases, seed 1, and 3 struck");
    assert_eq!(plan(0, 0, 3, Some(1)), "case 1 of 3, seed 1");
    let wrong_everywhere = Plan { cases: 0, solid_as_is: 4, modal_errors: 6, ..Plan::default() };
    assert_eq!(wrong_everywhere.to_string(), "4 solid-as-is cases, seed 1, and 6 modal-errors");
    let lumped = Plan { cases: 0, channel_flaws: 3, load_paths: 2, unknown_physics: 1, ..Plan::default() };
    assert_eq!(lumped.to_string(), "3 channel-flaws cases, seed 1, and 2 load-paths, and 1 unknown-physics");
}

/// An answer that names effects, each with its probability.
fn naming(case: &Case, effects: &[(Effect, f64)]) -> Answer {
    let findings =
        effects.iter().map(|(effect, probability)| Found { probability: *probability, ..found(effect) });
    Answer {
        verdict: if effects.is_empty() { Verdict::Consistent } else { Verdict::Explained },
        findings: findings.collect(),
        objectives: [0.0; 2],
        chi2_per_dof: [1.0; 3],
        refitted: case.believed.clone(),
        repaired: case.believed.clone(),
        held_out: None,
    }
}

/// Cases answered by what is hidden in each and by other effects, each with its probability.
fn answered_with<T: Judgeable + Sync>(
    cases: &[Case],
    truths: &[T],
    others: impl Fn(&T) -> Vec<(Effect, f64)> + Sync,
) -> Answers {
    let reply = |case: &Case| {
        let truth = &truths[cases.iter().position(|known| known == case).unwrap()];
        let hidden = truth.effects().iter().map(|effect| (effect.clone(), 0.95));
        Ok(naming(case, &hidden.chain(others(truth)).collect::<Vec<_>>()))
    };
    Answers::by(cases, 1, |_| (), reply)
}

#[test]
fn where_the_model_is_wrong_everywhere_what_is_true_may_stand_beside_what_is_hidden_and_nothing_else() {
    let (questions, truths) =
        drawn(&Plan { cases: 0, solid_as_is: 3, modal_errors: 4, seed: 2, ..Plan::default() });
    // A strip's ends yield across it, whatever is stated.
    let end = Place::Point("10".into());
    let across = Effect::new(EffectKind::InterfaceCompliance, end, Some(Dof::Translation), &[1e8, 0.0]);
    let beside = |truth: &AsIsTruth| truth.effects().iter().map(|_| (across.clone(), 0.95)).collect();
    let replies = Replies {
        solid_as_is: answered_with(&questions.solid_as_is, &truths.solid_as_is, beside),
        modal_errors: answered_with(&questions.modal_errors, &truths.modal_errors, |_| Vec::new()),
        ..silent()
    };
    let right = scores(&questions, truths.clone(), &replies);
    for score in &right {
        let (right, asked) = share(score, "single_right");
        assert_eq!((right, share(score, "null_alone")), (asked, (1, 1)), "{}", score.key);
        assert_eq!(share(score, "sizes").0, share(score, "sizes").1);
        assert_eq!((share(score, "untrue_claimed").0, share(score, "null_untrue").0), (0, 0));
    }
    assert_eq!(share(&right[0], "single_right"), (2, 2), "of solids as they are all is asked for");
    let values = [0.0, 1e-3, 500.0, 0.01];
    let untrue = Effect::new(EffectKind::AttachedResonator, Place::Body("A".into()), None, &values);
    let both = |_: &AsIsTruth| vec![(across.clone(), 0.95), (untrue.clone(), 0.6)];
    let solid_as_is = answered_with(&questions.solid_as_is, &truths.solid_as_is, both);
    let questions = Questions { modal_errors: Vec::new(), ..questions };
    let wrong = scores(&questions, truths, &Replies { solid_as_is, ..silent() }).remove(0);
    let counted = ["single_right", "single_first", "untrue_claimed", "untrue_likely", "null_untrue"];
    assert_eq!(counted.map(|key| share(&wrong, key).0), [0, 2, 0, 3, 1]);
}

#[test]
fn cases_with_a_wrong_model_come_last_and_change_no_other() {
    let without = Plan { cases: 2, solid: 1, struck: 1, seed: 4, ..Plan::default() };
    let with = Plan { solid_as_is: 1, modal_errors: 1, ..without.clone() };
    let ((before, _), (after, truths)) = (drawn(&without), drawn(&with));
    assert_eq!(
        (before.laboratory, before.solid, before.struck),
        (after.laboratory, after.solid, after.struck)
    );
    assert_eq!((truths.solid_as_is[0].index, truths.modal_errors[0].index()), (4, 5));
    let (one, _) = drawn(&Plan { only: Some(5), ..with });
    assert_eq!((one.solid_as_is.len(), one.modal_errors), (0, after.modal_errors));
}

#[test]
fn errors_of_every_mode_are_filed_with_the_truth_and_are_more_than_noise() {
    let (questions, truths) = drawn(&Plan { cases: 0, modal_errors: 3, seed: 6, ..Plan::default() });
    for (case, truth) in questions.modal_errors.iter().zip(&truths.modal_errors) {
        let text = truth.to_value().to_string();
        let read = ModalErrorsTruth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(read.to_value().to_string(), text);
        let (pairs, lines) = (case.recorded.pairs(), case.recorded.lines());
        let error_of = |set: &FrfSet| {
            let both = set.all_values().iter().zip(case.recorded.all_values());
            let (off, size) =
                both.fold((0.0, 0.0), |(off, size), (a, b)| (off + (a - b).norm_sqr(), size + b.norm_sqr()));
            (off / size).sqrt()
        };
        let wrong = error_of(&read.frfs(pairs, lines, Instrument::AsDescribed).unwrap());
        let without = error_of(&frfs(&truth.truth.fixture, pairs, lines, Instrument::AsDescribed).unwrap());
        assert!(wrong < 5e-3 && without > 5.0 * wrong, "{wrong:e} with the errors, {without:e} without");
    }
}

/// Lumped cases of each route, answered by what is hidden and by other effects.
fn lumped_scores(
    (questions, truths): &(Questions, Opened),
    others: &[Effect],
    probability: f64,
) -> Vec<RouteScore> {
    let lumped = lumped(questions, truths);
    let reply = |case: &Case| {
        let truth = lumped.iter().find_map(|(known, truth)| (*known == case).then_some(truth)).unwrap();
        let named = truth.effects().iter().chain(others).map(|effect| (effect.clone(), probability));
        let answer = naming(case, &named.collect::<Vec<_>>());
        // Where nothing has a name, what is handed back is the fixture at its true quantities.
        let repaired =
            if truth.role() == Role::Outside { truth.truth.fixture.clone() } else { answer.repaired };
        Ok(Answer { repaired, ..answer })
    };
    let answers = |cases: &[Case]| Answers::by(cases, 1, |_| (), reply);
    let replies = Replies {
        channel_flaws: answers(&questions.channel_flaws),
        load_paths: answers(&questions.load_paths),
        unknown_physics: answers(&questions.unknown_physics),
        ..silent()
    };
    scores(questions, truths.clone(), &replies)
}

/// Cases of the three routes of lumped structures and what is true of them.
fn lumped<'a>(questions: &'a Questions, truths: &'a Opened) -> Vec<(&'a Case, &'a LumpedTruth)> {
    let cases = [&questions.channel_flaws, &questions.load_paths, &questions.unknown_physics];
    let truths = [&truths.channel_flaws, &truths.load_paths, &truths.unknown_physics];
    cases.into_iter().flatten().zip(truths.into_iter().flatten()).collect()
}

fn lumped_plan() -> Plan {
    let families = vec![Family::TwoBlocks, Family::SupportedTwoBlocks];
    let (channel_flaws, load_paths, unknown_physics) = (8, 6, 8);
    Plan { cases: 0, channel_flaws, load_paths, unknown_physics, seed: 2, families, ..Plan::default() }
}

#[test]
fn flaws_and_load_paths_are_right_by_name_and_alone() {
    let cases = drawn(&lumped_plan());
    let kinds: BTreeSet<_> =
        cases.1.unknown_physics.iter().filter_map(|t| t.truth.outside.as_ref()).map(Outside::kind).collect();
    assert_eq!(kinds.len(), Outside::UNLISTED.len(), "{kinds:?}");
    let keys = |scores: &[RouteScore]| scores.iter().map(|score| score.key).collect::<Vec<_>>();
    let perfect = lumped_scores(&cases, &[], 1.0);
    assert_eq!(keys(&perfect), ["channel_flaws", "load_paths", "unknown_physics"]);
    for score in &perfect[..2] {
        let (alone, asked) = share(score, "single_alone");
        assert!(alone == asked && asked > 0, "{}", score.key);
        assert_eq!(share(score, "single_own"), (asked, asked));
        assert_eq!((share(score, "untrue_claimed").0, share(score, "null_named").0), (0, 0));
        assert_eq!(share(score, "sizes").0, share(score, "sizes").1);
    }
    // A gram that resonates at 500 Hz is nowhere here.
    let values = [0.0, 1e-3, 500.0, 0.01];
    let untrue = Effect::new(EffectKind::AttachedResonator, Place::Body("A".into()), None, &values);
    let wrong = lumped_scores(&cases, &[untrue], 0.6);
    for score in &wrong[..2] {
        assert_eq!(share(score, "single_alone").0, 0, "{}", score.key);
        assert_eq!(share(score, "null_named").0, share(score, "null_named").1);
        let all = share(score, "untrue_likely").1;
        assert_eq!((share(score, "untrue_likely"), share(score, "untrue_claimed").0), ((all, all), 0));
    }
}

#[test]
fn a_suspension_about_the_lowest_line_is_no_early_end_of_records() {
    // Nothing is hidden; modes at 1.9, 5.7, 70 and 516 Hz on lines from 2.5 Hz on, and no poles explain the first
    // few of these.
    let (questions, truths) = drawn(&Plan { cases: 0, load_paths: 2, seed: 2024, ..Plan::default() });
    let (case, truth) = (&questions.load_paths[1], &truths.load_paths[1]);
    assert_eq!((case.believed.supports().len(), truth.truth.role), (2, Role::Null));
    assert!(restored(&case.recorded).is_none(), "{:?}", restored(&case.recorded).map(|(_, end)| end));
}

#[test]
fn a_name_of_what_has_none_is_untrue_unless_it_fits_as_well() {
    let cases = drawn(&Plan { channel_flaws: 0, load_paths: 0, ..lumped_plan() });
    let values = [0.0, 1e-3, 7e3, 0.01];
    let wrong = Effect::new(EffectKind::AttachedResonator, Place::Body("A".into()), None, &values);
    let [score] = lumped_scores(&cases, &[wrong], 0.95).try_into().unwrap();
    let (untrue, all) = share(&score, "untrue_claimed");
    let imitated = share(&score, "imitated").0;
    // Sizes run down to what nobody could see: there the true quantities alone fit as well.
    assert_eq!((untrue + imitated, all), (8, 8));
    assert!(untrue >= 4, "{untrue}");
    let silent = lumped_scores(&cases, &[], 0.95);
    assert_eq!(share(&silent[0], "untrue_likely").0, 0);
}

#[test]
fn lumped_cases_of_their_own_routes_come_last_and_read_back_as_they_were_written() {
    let without = Plan { cases: 2, modal_errors: 1, seed: 4, ..Plan::default() };
    let with = Plan { channel_flaws: 2, load_paths: 2, unknown_physics: 4, ..without.clone() };
    let ((before, _), (after, truths)) = (drawn(&without), drawn(&with));
    assert_eq!(
        (before.laboratory, before.modal_errors),
        (after.laboratory.clone(), after.modal_errors.clone())
    );
    let numbers: Vec<usize> = lumped(&after, &truths).iter().map(|(_, truth)| truth.index()).collect();
    assert_eq!(numbers, (3..11).collect::<Vec<_>>());
    let (one, _) = drawn(&Plan { only: Some(6), ..with });
    assert_eq!((one.load_paths, one.unknown_physics), (after.load_paths[1..].to_vec(), Vec::new()));
    for (case, truth) in lumped(&after, &truths) {
        let text = truth.to_value().to_string();
        let read = LumpedTruth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(read.to_value().to_string(), text);
        assert_eq!(read.recorded, case.recorded.pairs());
        assert_eq!(read.truth.unseen().unwrap(), truth.truth.unseen().unwrap());
    }
}
