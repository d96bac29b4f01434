//! Joints whose files are made by hand, against closed forms.

#![allow(clippy::unwrap_used)]

mod at_once;
mod equality;
mod models;

use jointscope_comparison::{Caution, Comparison, ComparisonOptions, Decomposed, WhyApart};
use jointscope_wording::Says;
use jointscope_wording::comparison::{share, shared};
use serde_json::{Value, json};

/// A test that reads k11 + s·q off a scale of deviation 1, with q the mass of block A in standard deviations:
/// J over (k11, q) is [[1, s], [s, s²]].
fn file(k11: f64, by_mass: f64, stated: f64) -> Value {
    let zero = [[0.0; 2]; 2];
    let mut covariance = [[0.0; 6]; 6];
    covariance[0][0] = 1.0 + by_mass * by_mass;
    let pair = json!({"stiffness": zero, "damping": zero});
    json!({
        "relation": "exact",
        "lines": [],
        "average": {"band": [100.0, 200.0], "stiffness": zero, "damping": zero, "std": pair},
        "joint": {
            "name": "J",
            "stiffness": [[k11, 0.0], [0.0, 0.0]],
            "damping": zero,
            "covariance": covariance,
            "chi2_per_dof": 1.01,
            "quantities": [{"path": "bodies/A/mass", "body": "A", "stated": stated, "std": 0.1}],
            "likelihood": {
                "elements": ["k11"],
                "at": [k11, 0.0],
                "gradient": [0.0, 0.0],
                "information": [[1.0], [by_mass, by_mass * by_mass]],
            },
        },
    })
}

fn joints(files: &[Value]) -> Vec<Decomposed> {
    let names = ["a", "b", "c", "d"];
    names.iter().zip(files).map(|(name, file)| Decomposed::of(*name, file).unwrap()).collect()
}

fn compared(files: &[Value], options: &ComparisonOptions) -> Comparison {
    Comparison::with(joints(files), options).unwrap()
}

/// Standard deviation of the difference of K11 of the first two.
fn apart(comparison: &Comparison) -> f64 {
    comparison.pairs[0].number("K11").unwrap().difference.std
}

#[test]
fn what_two_tests_share_cancels_in_their_difference_and_stays_in_each() {
    let found = compared(&[file(1000.0, 20.0, 5.0), file(1050.0, 20.0, 5.0)], &ComparisonOptions::default());
    assert!((apart(&found) - 2f64.sqrt()).abs() < 1e-9, "{}", apart(&found));
    let number = found.pairs[0].number("K11").unwrap();
    assert!((number.difference.value - 50.0).abs() < 1e-9);
    assert!((number.correlation.unwrap() - 400.0 / 401.0).abs() < 1e-9);
    assert!((found.together.std(0, 0) - 401f64.sqrt()).abs() < 1e-9);
    // Var(b/a) = (V_bb − 2r V_ab + r² V_aa)/a².
    let r: f64 = 1.05;
    let variance = (401.0 - 2.0 * r * 400.0 + r * r * 401.0) / 1e6;
    assert!((number.ratio.unwrap().std - variance.sqrt()).abs() < 1e-9);
    let equality = found.pairs[0].equality.unwrap();
    assert!((equality.chi2 - 1250.0).abs() < 1e-6 && equality.degrees == 1, "{equality:?}");
    assert_eq!(found.together.shared[0].quantities, ["bodies/A/mass"]);
}

#[test]
fn a_quantity_that_acts_otherwise_on_the_other_joint_cancels_as_far_as_it_does_the_same() {
    // b − a: 2 of noise and (30 − 20)² of the mass.
    let found = compared(&[file(1000.0, 20.0, 5.0), file(1050.0, 30.0, 5.0)], &ComparisonOptions::default());
    assert!((apart(&found) - 102f64.sqrt()).abs() < 1e-9, "{}", apart(&found));
}

#[test]
fn tests_on_other_blocks_are_independent_and_said_to_be() {
    let whole = 802f64.sqrt();
    let other = compared(&[file(1000.0, 20.0, 5.0), file(1050.0, 20.0, 5.1)], &ComparisonOptions::default());
    assert!((apart(&other) - whole).abs() < 1e-9);
    assert!(other.together.shared.is_empty());
    assert_eq!(other.together.apart[0].why, WhyApart::OtherBodies);
    assert_eq!(other.together.differing, ["bodies/A/mass"]);
    let options = ComparisonOptions { independent: true, ..Default::default() };
    let said = shared(&other).join("\n");
    assert!(said.contains("bodies/A/mass"), "{said}");
    let asked = compared(&[file(1000.0, 20.0, 5.0), file(1050.0, 20.0, 5.0)], &options);
    assert!((apart(&asked) - whole).abs() < 1e-9);
    let mut earlier = file(1050.0, 20.0, 5.0);
    earlier["joint"].as_object_mut().unwrap().remove("likelihood");
    let found = compared(&[file(1000.0, 20.0, 5.0), earlier], &ComparisonOptions::default());
    assert!((apart(&found) - whole).abs() < 1e-9);
    assert_eq!(
        found.together.apart.iter().find(|apart| apart.joint == "b").unwrap().why,
        WhyApart::NotStated
    );
}

#[test]
fn each_of_four_joints_shares_with_those_of_its_own_blocks() {
    let files = [5.0, 5.1, 5.0, 5.1].map(|mass| file(1000.0, 20.0, mass));
    let found = compared(&files, &ComparisonOptions::default());
    assert_eq!(found.together.shared.len(), 2);
    assert_eq!(found.together.shared[0].joints, ["a", "c"]);
    assert!((found.together.covariance((0, 0), (2, 0)) - 400.0).abs() < 1e-9);
    assert_eq!(found.together.covariance((0, 0), (1, 0)), 0.0);
}

#[test]
fn errors_of_the_model_are_each_joints_own() {
    let mut model = [[0.0; 6]; 6];
    model[0][0] = 7.0;
    let mut wrong = file(1050.0, 20.0, 5.0);
    wrong["joint"]["model_error"] = json!({"inflation": 3.0, "strain": 1.0, "covariance": model});
    let found = compared(&[file(1000.0, 20.0, 5.0), wrong], &ComparisonOptions::default());
    assert!((apart(&found) - 9f64.sqrt()).abs() < 1e-9);
    assert!(!found.is_sound());
    assert!(
        matches!(&found.cautions[..], [Caution::PoorFit { joint, chi2_per_dof }] if joint == "b" && *chi2_per_dof == 1.01)
    );
}

/// The same test with q told by it as well: at `at` deviations with the precision `told`.
fn telling(k11: f64, at: f64, told: f64) -> Value {
    let mut file = file(k11, 20.0, 5.0);
    file["joint"]["likelihood"] = json!({
        "elements": ["k11"], "at": [k11, at], "gradient": [0.0, 0.0], "information": [[1.0], [20.0, 400.0 + told]],
    });
    file
}

#[test]
fn tests_that_contradict_each_other_on_the_blocks_are_not_taken_as_on_the_same() {
    // Each knows q to 0.1: 0.2 apart is chance, 2 apart is not.
    let near =
        compared(&[telling(1000.0, 0.5, 100.0), telling(1050.0, 0.7, 100.0)], &ComparisonOptions::default());
    assert!(near.is_sound() && near.together.shared.len() == 1);
    // Each posterior has the variance 1/101 and (1 − S) of the prior: m₁ − m₂ = 0.2·100/101, of variance 2A −
    // 2A².
    let a: f64 = 100.0 / 101.0;
    let z = 0.2 * a / (2.0 * a - 2.0 * a * a).sqrt();
    let expected = statrs::function::erf::erfc(z / 2f64.sqrt());
    let p = near.together.agreement(&near.joints[0], &near.joints[1]).unwrap();
    assert!((p - expected).abs() < 1e-6, "{p} {expected}");
    let far =
        compared(&[telling(1000.0, -1.0, 100.0), telling(1050.0, 1.0, 100.0)], &ComparisonOptions::default());
    assert!(far.together.shared.is_empty());
    assert!(
        far.cautions.iter().any(|caution| matches!(caution, Caution::BodiesDisagree { .. })),
        "{:?}",
        far.cautions
    );
    assert!(!far.is_sound());
}

#[test]
fn of_three_tests_the_one_that_contradicts_the_others_is_taken_apart() {
    let files = [telling(1000.0, 0.5, 100.0), telling(1050.0, -1.5, 100.0), telling(1020.0, 0.6, 100.0)];
    let found = compared(&files, &ComparisonOptions::default());
    assert_eq!(found.together.shared[0].joints, ["a", "c"]);
    assert_eq!(found.together.apart.len(), 1);
    assert_eq!(
        (found.together.apart[0].joint.as_str(), found.together.apart[0].why),
        ("b", WhyApart::Disagrees)
    );
    assert_eq!(found.cautions, [Caution::BodiesDisagree { joint: "b".into() }]);
}

#[test]
fn blocks_farther_from_what_is_stated_than_chance_widen_what_rests_on_them() {
    // Both have q at 4 of the deviations stated.
    let found =
        compared(&[telling(1000.0, 4.0, 1e4), telling(1050.0, 4.0, 1e4)], &ComparisonOptions::default());
    let expected =
        compared(&[telling(1000.0, 0.1, 1e4), telling(1050.0, 0.1, 1e4)], &ComparisonOptions::default());
    assert!((apart(&found) / apart(&expected) - 4.0).abs() < 0.01, "{} {}", apart(&found), apart(&expected));
}

#[test]
fn failed_tests_and_unusable_decompositions_are_told() {
    let mut refused = file(1050.0, 20.0, 5.0);
    refused["joint"]["tests"] = json!({"reciprocity": 0.001, "definite": 0.5, "passive": null});
    refused["judgement"] = json!({"verdict": "unusable"});
    let found = compared(&[file(1000.0, 20.0, 5.0), refused], &ComparisonOptions::default());
    assert!(found.cautions.contains(&Caution::Refused { joint: "b".into(), tests: vec!["reciprocity"] }));
    assert!(found.cautions.contains(&Caution::Unusable { joint: "b".into() }));
    assert!(found.cautions.iter().all(|caution| caution.says().starts_with("b: ")));
}

#[test]
fn a_likelihood_that_does_not_fit_its_quantities_is_not_used() {
    for broken in [json!([[1.0], [20.0]]), json!([[1.0]]), json!([])] {
        let mut file_b = file(1050.0, 20.0, 5.0);
        file_b["joint"]["likelihood"]["information"] = broken;
        let found = compared(&[file(1000.0, 20.0, 5.0), file_b], &ComparisonOptions::default());
        assert!(found.together.shared.is_empty());
    }
}

/// A joint whose FRFs do not tell a viscous law from one that is `off` in K11.
fn with_laws(k11: f64, off: f64, probability: f64, best: &str) -> Value {
    let mut file = file(k11, 0.0, 5.0);
    let middle = |k: f64| json!({"stiffness": [[k, 0.0], [0.0, 0.0]], "damping": [[0.0, 0.0], [0.0, 0.0]]});
    file["joint"]["law"] = json!(best);
    file["joint"]["laws"] = json!([
        {"law": "structural", "probability": probability, "in_the_middle": middle(k11 + off)},
        {"law": "viscous", "probability": 1.0 - probability, "in_the_middle": middle(k11)},
    ]);
    let law = probability * off * off;
    let mut of_laws = [[0.0; 6]; 6];
    of_laws[0][0] = law;
    file["joint"]["law_covariance"] = json!(of_laws);
    file["joint"]["covariance"][0][0] = json!(1.0 + law);
    file
}

/// Probability that a normal number is below x.
fn below(x: f64, mean: f64, std: f64) -> f64 {
    // By Simpson's rule: the tests need no more than five digits.
    let (from, steps) = (mean - 9.0 * std, 20_000);
    let step = (x - from) / f64::from(steps);
    let density = |x: f64| (-0.5 * ((x - mean) / std).powi(2)).exp() / (std * std::f64::consts::TAU.sqrt());
    let sum: f64 = (0..steps).map(|i| density(from + (f64::from(i) + 0.5) * step)).sum();
    sum * step
}

/// Checks that the 95 % interval of the difference of K11 is that of a mixture of normal numbers: weight,
/// mean and variance.
fn is_of_mixture(found: &Comparison, parts: &[(f64, f64, f64)]) {
    let difference = found.pairs[0].number("K11").unwrap().difference;
    let share = |x: f64| parts.iter().map(|(w, mean, v)| w * below(x, *mean, v.sqrt())).sum::<f64>();
    let [low, high] = difference.ci95.map(share);
    assert!((low - 0.025).abs() < 1e-5 && (high - 0.975).abs() < 1e-5, "{difference:?} {low} {high}");
    let normal = (difference.ci95[1] - difference.ci95[0]) / (2.0 * 1.959_963_985);
    assert!((difference.std - normal).abs() < 1e-4 * normal);
}

#[test]
fn what_one_law_changes_in_two_joints_alike_cancels_in_their_difference() {
    let files = [with_laws(1000.0, 30.0, 0.8, "structural"), with_laws(1050.0, 32.0, 0.8, "structural")];
    let found = compared(&files, &ComparisonOptions::default());
    // The law is structural with 0.8²/(0.8² + 0.2²) = 16/17: then the difference is 2 larger.
    is_of_mixture(&found, &[(1.0 / 17.0, 50.0, 2.0), (16.0 / 17.0, 52.0, 2.0)]);
    assert!((found.together.std(0, 0) - (1.0 + 900.0 * 16.0 / 17.0f64).sqrt()).abs() < 1e-9);
    assert_eq!(found.together.one_law, [["a", "b"]]);
}

#[test]
fn an_improbable_law_far_away_widens_an_interval_by_its_probability_and_not_by_its_distance() {
    let width = |off: f64| {
        let files = [with_laws(1000.0, 30.0, 0.1, "viscous"), with_laws(1050.0, 30.0 + off, 0.1, "viscous")];
        let found = compared(&files, &ComparisonOptions::default());
        let [low, high] = found.pairs[0].number("K11").unwrap().difference.ci95;
        (high - low) / (2.0 * 1.959_963_985 * 2.0f64.sqrt())
    };
    // With 1/82 it is off by 1000: the upper end leaves out 0.0128 in place of 0.025 of what the other law
    // tells.
    let far = width(1000.0);
    assert!(far > 1.02 && far < 1.12, "{far}");
    assert!((width(1e6) - far).abs() < 1e-6);
    assert!((width(0.0) - 1.0).abs() < 1e-4);
}

#[test]
fn joints_stated_by_a_law_that_they_follow_differ_from_the_other_laws_by_what_these_change() {
    // As above, but the numbers are the structural law's: the viscous one is off by 30 and 32 with 1/17.
    let by_its_law = |k11: f64, off: f64| {
        let mut file = with_laws(k11 - off, off, 0.8, "structural");
        file["joint"]["stiffness"][0][0] = json!(k11);
        file["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0});
        let mut of_laws = [[0.0; 6]; 6];
        of_laws[0][0] = 0.2 * off * off;
        file["joint"]["law_covariance"] = json!(of_laws);
        file["joint"]["covariance"][0][0] = json!(1.0 + 0.2 * off * off);
        file
    };
    let mut files = [by_its_law(1000.0, 30.0), by_its_law(1050.0, 32.0)];
    let found = compared(&files, &ComparisonOptions::default());
    // What the FRFs tell is taken at 970 and 1018.
    is_of_mixture(&found, &[(16.0 / 17.0, 48.0, 2.0), (1.0 / 17.0, 46.0, 2.0)]);
    let frequencies = |found: &Comparison| {
        found.cautions.iter().any(|caution| matches!(caution, Caution::Frequencies { .. }))
    };
    assert!(!frequencies(&found));
    files[1]["joint"]["follows"]["frequency"] = json!(200.0);
    assert!(
        !frequencies(&compared(&files, &ComparisonOptions::default())),
        "C of structural joints is stated at one"
    );
    for file in &mut files {
        file["joint"]["follows"]["law"] = json!("fractional");
        file["joint"]["laws"][0]["law"] = json!("fractional");
    }
    assert!(frequencies(&compared(&files, &ComparisonOptions::default())));
    for file in &mut files {
        file["joint"]["follows"]["law"] = json!("viscous");
    }
    assert!(
        !frequencies(&compared(&files, &ComparisonOptions::default())),
        "C of viscous joints is of all frequencies"
    );
}

#[test]
fn joints_of_other_laws_keep_what_laws_change_in_each() {
    // One is of a structural joint with 0.99, the other of a viscous one: one law for both has 2·2·0.99·0.01
    // against 1.
    let mut files = [with_laws(1000.0, 30.0, 0.99, "structural"), with_laws(1050.0, 32.0, 0.01, "viscous")];
    files[0]["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0});
    files[1]["joint"]["laws"].as_array_mut().unwrap().reverse();
    let found = compared(&files, &ComparisonOptions::default());
    let all = 1.0 + 2.0 * 0.01 / 0.99;
    is_of_mixture(
        &found,
        &[(1.0 / all, 50.0, 2.0), (0.01 / 0.99 / all, 80.0, 2.0), (0.01 / 0.99 / all, 82.0, 2.0)],
    );
    assert!(found.together.one_law.is_empty());
    let differ = found.pairs[0].laws_differ.as_ref().unwrap();
    assert_eq!((differ.first.as_str(), differ.second.as_str()), ("structural", "viscous"));
    assert!((differ.one_law - 0.0396 / 1.0396).abs() < 1e-9);
}

#[test]
fn a_joint_held_at_the_boundary_of_passivity_keeps_what_its_file_states() {
    // What the FRFs alone tell is of another joint, which must not take its place.
    let mut held = file(1050.0, 20.0, 5.0);
    held["joint"]["on_the_boundary_of_passive"] = json!(true);
    held["joint"]["likelihood"]["at"] = json!([900.0, 0.0]);
    let files = [file(1000.0, 20.0, 5.0), held, file(1020.0, 20.0, 5.0)];
    let found = compared(&files, &ComparisonOptions::default());
    assert_eq!(found.together.value(1, 0), 1050.0);
    assert_eq!(found.together.covariance((0, 0), (1, 0)), 0.0);
    assert_eq!(found.together.shared[0].joints, ["a", "c"]);
    assert_eq!(found.together.apart.len(), 1);
    assert_eq!(found.together.apart[0].why, WhyApart::OnTheBoundary);
    assert_eq!(found.cautions, [Caution::OnTheBoundary { joint: "b".into() }]);
    let alone = compared(&files[..2], &ComparisonOptions::default());
    assert_eq!(alone.together.apart[0].why, WhyApart::LeftAlone);
}

#[test]
fn blocks_that_are_strained_widen_nothing_that_does_not_rest_on_them() {
    // a and c have q at 4 of the deviations stated; b and d are on other blocks, where it is at 0.1.
    let other = |k11: f64| {
        let mut file = telling(k11, 0.1, 1e4);
        file["joint"]["quantities"][0]["stated"] = json!(5.1);
        file
    };
    let files = [telling(1000.0, 4.0, 1e4), other(1000.0), telling(1050.0, 4.0, 1e4), other(1050.0)];
    let found = compared(&files, &ComparisonOptions::default());
    let calm = compared(&[other(1000.0), other(1050.0)], &ComparisonOptions::default());
    assert!((found.together.std(1, 0) / calm.together.std(0, 0) - 1.0).abs() < 1e-9);
    let departing = compared(&[files[0].clone(), files[2].clone()], &ComparisonOptions::default());
    assert!((found.together.std(0, 0) / departing.together.std(0, 0) - 1.0).abs() < 1e-9);
    assert!((found.together.std(0, 0) / calm.together.std(0, 0) - 4.0).abs() < 0.01);
}

#[test]
fn a_test_left_alone_is_not_said_to_be_on_other_bodies() {
    let far =
        compared(&[telling(1000.0, -1.0, 100.0), telling(1050.0, 1.0, 100.0)], &ComparisonOptions::default());
    let mut why: Vec<WhyApart> = far.together.apart.iter().map(|apart| apart.why).collect();
    why.sort_by_key(|why| *why != WhyApart::Disagrees);
    assert_eq!(why, [WhyApart::Disagrees, WhyApart::LeftAlone]);
    let said = shared(&far).join("\n");
    assert!(!said.contains("no other fixture") && said.contains("are taken apart"), "{said}");
}

#[test]
fn a_likelihood_of_no_number_or_of_one_twice_is_not_used() {
    for (elements, at, information) in [
        (json!([]), json!([0.0]), json!([[400.0]])),
        (json!(["k11", "k11"]), json!([1050.0, 1050.0, 0.0]), json!([[1.0], [0.0, 1.0], [20.0, 0.0, 400.0]])),
    ] {
        let mut broken = file(1050.0, 20.0, 5.0);
        let gradient = vec![0.0; at.as_array().unwrap().len()];
        broken["joint"]["likelihood"] =
            json!({"elements": elements, "at": at, "gradient": gradient, "information": information});
        let found = compared(&[file(1000.0, 20.0, 5.0), broken], &ComparisonOptions::default());
        assert!(found.together.shared.is_empty());
        assert_eq!(
            found.together.apart.iter().find(|apart| apart.joint == "b").unwrap().why,
            WhyApart::NotStated
        );
    }
}

/// The same with the abscissa of block A's point among what its fixture is not sure of, moved by the fit or
/// not.
fn with_point(mut file: Value, moved: bool) -> Value {
    let point = json!({"path": "points/1/x", "body": "A", "stated": 0.2, "std": 1e-4});
    if moved {
        file["joint"]["quantities"].as_array_mut().unwrap().push(point);
        file["joint"]["likelihood"]["at"].as_array_mut().unwrap().push(json!(0.0));
        file["joint"]["likelihood"]["gradient"].as_array_mut().unwrap().push(json!(0.0));
        file["joint"]["likelihood"]["information"].as_array_mut().unwrap().push(json!([0.0, 0.0, 1.0]));
    } else {
        file["joint"]["unmoved"] = json!([point]);
    }
    file
}

#[test]
fn a_body_of_which_one_fixture_is_sure_and_the_other_is_not_is_not_the_same() {
    let plain = || file(1000.0, 20.0, 5.0);
    for files in [[plain(), with_point(plain(), true)], [with_point(plain(), true), plain()]] {
        let found = compared(&files, &ComparisonOptions::default());
        assert!(found.together.shared.is_empty());
        assert_eq!(found.together.differing, ["points/1/x"]);
    }
    // Stated alike, though one test's FRFs do not depend on it.
    for files in [
        [with_point(plain(), false), with_point(plain(), true)],
        [with_point(plain(), true), with_point(plain(), false)],
    ] {
        let found = compared(&files, &ComparisonOptions::default());
        assert_eq!(found.together.shared[0].quantities, ["bodies/A/mass"]);
        assert!(found.together.differing.is_empty());
    }
}

fn cautions(files: &[Value]) -> Vec<Caution> {
    compared(files, &ComparisonOptions::default()).cautions
}

#[test]
fn a_joint_whose_fit_failed_is_told_with_the_reason() {
    let mut failed = file(1050.0, 20.0, 5.0);
    failed["joint"] = json!({"name": "J", "failed": "no start gives finite FRFs"});
    let found = cautions(&[file(1000.0, 20.0, 5.0), failed.clone()]);
    let told = Caution::NoFit { joint: "b".into(), why: "no start gives finite FRFs".into() };
    assert!(found.contains(&told) && told.says().contains("no start gives finite FRFs"), "{found:?}");
    // Where all are compared by another relation, fits do not enter.
    failed["relation"] = json!("paper");
    let mut other = file(1000.0, 20.0, 5.0);
    other["relation"] = json!("paper");
    assert!(!cautions(&[other, failed]).iter().any(|caution| matches!(caution, Caution::NoFit { .. })));
}

#[test]
fn numbers_without_a_deviation_settle_nothing() {
    let mut bare = file(1050.0, 0.0, 5.0);
    bare["joint"].as_object_mut().unwrap().remove("likelihood");
    bare["joint"]["covariance"][0][0] = json!(0.0);
    let found = compared(&[bare.clone(), file(1000.0, 20.0, 5.0)], &ComparisonOptions::default());
    assert_eq!(found.cautions, [Caution::NoDeviations { joint: "a".into(), numbers: vec!["K11".into()] }]);
    assert!(!found.is_sound() && !found.rankings[0].is_settled());
    assert!(found.pairs[0].number("K11").unwrap().ratio.is_none());
}

#[test]
fn tests_of_one_recording_are_told() {
    let mut first = file(1000.0, 20.0, 5.0);
    let mut second = file(1050.0, 20.0, 5.0);
    let made = |recording: &str| json!({"inputs": [{"file": "f.json", "sha256": "f"}, {"file": "r", "sha256": recording}]});
    let one = || Caution::SameRecording { first: "a".into(), second: "b".into() };
    first["made"] = made("1");
    second["made"] = made("2");
    assert!(cautions(&[first.clone(), second.clone()]).is_empty());
    second["made"] = made("1");
    assert_eq!(cautions(&[first.clone(), second]), [one()]);
    // The same to the last digit, wherever it comes from.
    let mut copied = file(1000.0, 20.0, 5.0);
    copied["made"] = made("2");
    assert_eq!(cautions(&[first, copied]), [one()]);
}

#[test]
fn joints_over_different_lengths_are_told() {
    let over = |k11: f64, stated: f64, fitted: f64| {
        let mut file = file(k11, 20.0, 5.0);
        let end = |x: f64| json!({"point": "p", "body": "A", "x": x});
        file["ends"] = json!({"length": stated, "from": end(0.0), "to": end(stated)});
        file["joint"]["length"] = json!({"value": fitted, "std": 1e-4});
        file
    };
    let told = cautions(&[over(1000.0, 0.030, 0.030), over(1050.0, 0.032, 0.032)]);
    let expected = Caution::Lengths { joints: vec!["a".into(), "b".into()], lengths: vec![0.030, 0.032] };
    assert_eq!(told, [expected]);
    assert!(told[0].says().contains("a 30.00 mm, b 32.00 mm"), "{}", told[0].says());
    // √2 of 0.1 mm at 95 % is 0.277 mm; what both fixtures state alike is one length.
    assert!(cautions(&[over(1000.0, 0.030, 0.030), over(1050.0, 0.0302, 0.0302)]).is_empty());
    assert!(cautions(&[over(1000.0, 0.030, 0.030), over(1050.0, 0.030, 0.032)]).is_empty());
}

#[test]
fn a_share_is_said_with_its_significant_digits() {
    assert_eq!(share(2.0, 1000.0), "0.200 %");
    assert_eq!(share(0.012, -1000.0), "0.00120 %");
    assert_eq!(share(1e-7, 1000.0), "1.0×10⁻⁸ %");
    assert_eq!((share(0.0, 3.0), share(12.0, 10.0)), ("0 %".into(), "120 %".into()));
}
