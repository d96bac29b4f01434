//! Several joints at once, in a chain and in a ring, on recordings that the simulated laboratory makes: it
//! shares no mechanics with the model fitted.

use crate::joint_fit::{NAMES, recorded, rms};
use jointscope::SpectralLines;
use jointscope::comparison::{Comparison, Decomposed};
use jointscope::decomposition::{
    JointFitOptions, JointsFit, LawKind, SeveralError, Sides, SidesError, fit_joints,
};
use jointscope::fixture::{Fixture, JointLaw};
use jointscope::joints_file;
use jointscope_rig::{Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_samples::{Noise, transverse};

/// Ways that three blocks are connected.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    /// A–J–B–K–C.
    Chain,
    /// The same, and L from A to C past B.
    Ring,
}

/// FRFs across both joints, and some that stay on a block.
const TWELVE: [(&str, &str); 12] = [
    ("4", "1"),
    ("3", "1"),
    ("4", "2"),
    ("3", "2"),
    ("6", "4"),
    ("5", "4"),
    ("6", "3"),
    ("5", "3"),
    ("1", "1"),
    ("6", "6"),
    ("6", "1"),
    ("5", "2"),
];

fn q(value: f64, std: f64) -> String {
    format!(r#"{{"value": {value}, "std": {std}}}"#)
}

/// A matrix k·[[1, −a], [−a, b]], its elements known to a share.
fn matrix([k, a, b]: [f64; 3], share: f64) -> String {
    let [first, cross, last] = [k, -a * k, b * k].map(|e| q(e, share * e.abs()));
    format!("[[{first}, {cross}], [{cross}, {last}]]")
}

fn joint(from: &str, to: &str, k: [f64; 3], c: [f64; 3]) -> String {
    let damping = match c {
        [0.0, ..] => String::new(),
        c => format!(r#", "damping": {}"#, matrix(c, 0.0)),
    };
    format!(r#"{{ "from": "{from}", "to": "{to}", "stiffness": {}{damping} }}"#, matrix(k, 0.01))
}

fn fixture(shape: Shape, physics: &str) -> Fixture {
    let block = |mass: f64, inertia: f64, x: f64| {
        let [m, i] = [q(mass, 1e-3 * mass), q(inertia, 5e-3 * inertia)];
        format!(r#"{{ "mass": {m}, "inertia": {i}, "x_cg": {} }}"#, q(x, 1e-4))
    };
    let point = |body: &str, x: f64| format!(r#"{{ "body": "{body}", "x": {} }}"#, q(x, 1e-4));
    let past = match shape {
        Shape::Chain => String::new(),
        Shape::Ring => {
            format!(r#", "L": {}"#, joint("7", "8", [3e5, 0.16, 0.034], [3.0, 0.15, 0.03]))
        }
    };
    // A joint that relaxes has no other losses.
    let dashpots = if physics.is_empty() { 9.0 } else { 0.0 };
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {}, "B": {}, "C": {} }},
            "points": {{ "1": {}, "2": {}, "3": {}, "4": {}, "5": {}, "6": {}, "7": {}, "8": {} }},
            "joints": {{ "J": {}, "K": {}{past} }}, "physics": [{physics}] }}"#,
        block(1.102, 5.9e-4, -0.031),
        block(0.91, 6.1e-4, 0.1),
        block(1.485, 1.02e-3, 0.231),
        point("A", -0.056),
        point("A", 0.0),
        point("B", 0.07),
        point("B", 0.131),
        point("C", 0.2),
        point("C", 0.262),
        point("A", -0.02),
        point("C", 0.29),
        joint("2", "3", [2.4e6, 0.035, 1.7e-3], [12.0, 0.029, 1.7e-3]),
        joint("4", "5", [1.6e6, 0.035, 1.6e-3], [dashpots, 0.032, 1.8e-3]),
    ))
    .unwrap()
}

/// k11, k12, k22, c11, c12, c22 of every joint that a fixture states.
fn stated(fixture: &Fixture) -> Vec<f64> {
    let of = |joint: &jointscope::fixture::Joint| match &joint.law {
        JointLaw::Stiffness { stiffness: [a, b, d], damping: Some([e, f, g]) } => {
            [a, b, d, e, f, g].map(|q| q.value)
        }
        _ => unreachable!(),
    };
    fixture.joints().iter().flat_map(of).collect()
}

fn found(fit: &JointsFit) -> Vec<f64> {
    let of = |found: &jointscope::decomposition::FoundJoint| {
        let (k, c) = (&found.fit.stiffness, &found.fit.damping);
        [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
    };
    fit.joints.iter().flat_map(of).collect()
}

/// Solves A x = b for a covariance A: χ² of all errors at once is bᵀ A⁻¹ b.
fn chi2_of_all(covariance: &[Vec<f64>], errors: &[f64]) -> f64 {
    let n = errors.len();
    let mut all: Vec<f64> = covariance.concat();
    let mut x = errors.to_vec();
    assert!(jointscope::linalg::solve_positive_definite(&mut all, &mut x), "{n} numbers");
    x.iter().zip(errors).map(|(a, b)| a * b).sum()
}

/// Errors of all numbers in standard deviations, χ² of each run's errors together, χ² per degree of freedom
/// of the fits.
struct Runs {
    scores: Vec<Vec<f64>>,
    together: Vec<f64>,
    chi2: Vec<f64>,
    p: Vec<f64>,
}

fn run(shape: Shape, count: u64, seed: u64) -> Runs {
    let fixture = fixture(shape, "");
    let (mut rng, mut noise) = (generator(seed), Noise::new(seed));
    let mut runs = Runs { scores: Vec::new(), together: Vec::new(), chi2: Vec::new(), p: Vec::new() };
    for _ in 0..count {
        let truth = drawn_within_tolerance(&fixture, &mut rng).unwrap();
        let frfs = recorded(&truth, &mut noise, 0.01, &TWELVE);
        let fit = fit_joints(&fixture, &frfs, None, JointFitOptions::default()).unwrap();
        let errors: Vec<f64> = found(&fit).iter().zip(stated(&truth)).map(|(a, b)| a - b).collect();
        let score = |(e, error): (usize, &f64)| error / fit.covariance[e][e].sqrt();
        runs.scores.push(errors.iter().enumerate().map(score).collect());
        runs.together.push(chi2_of_all(&fit.covariance, &errors));
        runs.chi2.push(fit.joints[0].fit.chi2_per_dof);
        runs.p.extend(fit.joints.iter().filter_map(|joint| joint.fit.tests.reciprocity));
    }
    runs
}

/// Share of intervals that hold, by number.
fn held(runs: &Runs) -> Vec<f64> {
    let count = runs.scores.len() as f64;
    let inside = |e: usize| runs.scores.iter().filter(|scores| scores[e].abs() < 1.96).count() as f64;
    (0..runs.scores[0].len()).map(|e| inside(e) / count).collect()
}

fn report(shape: &str, runs: &Runs) {
    let n = runs.scores.len() as f64;
    println!("{shape}: {n} runs, chi2 per dof {:.3}", runs.chi2.iter().sum::<f64>() / n);
    for (e, held) in held(runs).iter().enumerate() {
        println!(
            "joint {} {}: rms of error/std {:.3}, 95 % intervals hold {:.1} %",
            e / 6 + 1,
            NAMES[e % 6],
            rms(runs.scores.iter().map(|scores| scores[e])),
            100.0 * held
        );
    }
    let order = runs.scores[0].len() as f64;
    println!("chi2 of all errors, by their covariance, per number: {:.3}", rms_mean(&runs.together) / order);
    let below = |q: f64| runs.p.iter().filter(|p| **p < q).count() as f64 / runs.p.len() as f64;
    println!(
        "reciprocity: p below 0.05, 0.2, 0.5, 0.8: {:.3} {:.3} {:.3} {:.3}",
        below(0.05),
        below(0.2),
        below(0.5),
        below(0.8)
    );
}

fn rms_mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn both_joints_of_a_chain_and_all_three_of_a_ring_are_as_far_off_as_stated() {
    for (shape, name) in [(Shape::Chain, "chain"), (Shape::Ring, "ring")] {
        let runs = run(shape, 12, 3);
        report(name, &runs);
        let order = runs.scores[0].len() as f64;
        let chi2 = rms_mean(&runs.chi2);
        assert!((0.97..1.03).contains(&chi2), "{name}: {chi2}");
        // The mean of 12 χ² of as many degrees of freedom as numbers.
        let together = rms_mean(&runs.together) / order;
        assert!((together - 1.0).abs() < 4.0 * (2.0 / (12.0 * order)).sqrt(), "{name}: {together}");
    }
}

#[test]
#[ignore = "minutes; the record of several joints has its figures"]
fn in_two_hundred_runs_the_intervals_of_a_chain_and_of_a_ring_hold() {
    for (shape, name) in [(Shape::Chain, "chain"), (Shape::Ring, "ring")] {
        let runs = run(shape, 200, 29);
        report(name, &runs);
        // An interval of 95 % holds in 92 to 98 of 100 but for chance, of which 200 runs have 1.5 %.
        let held = held(&runs);
        let mean = held.iter().sum::<f64>() / held.len() as f64;
        assert!((0.92..0.98).contains(&mean) && held.iter().all(|h| (0.9..=1.0).contains(h)), "{held:?}");
    }
}

/// The fixture's joints so many times as stiff.
fn stiffened(fixture: &Fixture, times: &[(&str, f64)], seed: u64) -> Fixture {
    let mut truth = drawn_within_tolerance(fixture, &mut generator(seed)).unwrap();
    let all: Vec<(usize, f64)> = truth
        .quantities()
        .iter()
        .enumerate()
        .filter(|(_, own)| own.path.contains("stiffness"))
        .filter_map(|(index, own)| {
            let (_, times) =
                times.iter().find(|(name, _)| own.path.starts_with(&format!("joints/{name}/")))?;
            Some((index, times * own.value))
        })
        .collect();
    truth.set_quantities(all);
    truth
}

#[test]
fn joints_that_are_much_softer_or_stiffer_than_the_fixture_says_each_by_its_own_are_found() {
    let [chain, ring] = [Shape::Chain, Shape::Ring].map(|shape| fixture(shape, ""));
    for (seed, fixture, times) in [
        (5, &ring, vec![("J", 0.6), ("K", 0.6), ("L", 0.6)]),
        (6, &ring, vec![("J", 0.5), ("K", 2.0), ("L", 0.6)]),
        (7, &chain, vec![("J", 2.2), ("K", 0.45)]),
        (8, &chain, vec![("J", 0.45), ("K", 2.2)]),
    ] {
        let truth = stiffened(fixture, &times, seed);
        let frfs = recorded(&truth, &mut Noise::new(seed), 0.01, &TWELVE);
        let fit = fit_joints(fixture, &frfs, None, JointFitOptions::default()).unwrap();
        for (e, (found, expected)) in found(&fit).iter().zip(stated(&truth)).enumerate() {
            let score = (found - expected) / fit.covariance[e][e].sqrt();
            assert!(
                score.abs() < 4.0,
                "{times:?}, {}: {found} for {expected}, {score} deviations",
                fit.elements[e]
            );
        }
        assert!(fit.joints.iter().all(|joint| joint.is_in_a_loop == std::ptr::eq(fixture, &ring)));
    }
}

#[test]
fn a_joint_of_a_ring_has_no_two_sides_and_the_fit_finds_it_with_the_others_within_their_tolerances() {
    let fixture = fixture(Shape::Ring, "");
    assert_eq!(Sides::of(&fixture, Some("K")).unwrap_err(), SidesError::Loop("K".into()));
    let truth = drawn_within_tolerance(&fixture, &mut generator(8)).unwrap();
    let frfs = recorded(&truth, &mut Noise::new(8), 0.01, &TWELVE);
    let names = ["K".to_owned()];
    let fit = fit_joints(&fixture, &frfs, Some(&names), JointFitOptions::default()).unwrap();
    assert_eq!(fit.elements[..2], ["K/k11", "K/k12"]);
    for (e, (found, expected)) in found(&fit).iter().zip(&stated(&truth)[6..12]).enumerate() {
        let score = (found - expected) / fit.covariance[e][e].sqrt();
        assert!(score.abs() < 4.0, "{}: {found} for {expected}, {score} deviations", fit.elements[e]);
    }
}

#[test]
fn joints_side_by_side_between_rigid_blocks_and_joints_without_frfs_are_refused_by_name() {
    let frfs = recorded(&fixture(Shape::Ring, ""), &mut Noise::new(1), 0.01, &TWELVE);
    let text = r#"{ "bodies": { "A": {"mass": 1, "inertia": 1e-3, "x_cg": 0}, "B": {"mass": 1, "inertia": 1e-3, "x_cg": 0.1} },
        "points": { "1": {"body": "A", "x": 0.0}, "2": {"body": "A", "x": 0.02}, "3": {"body": "B", "x": 0.08}, "4": {"body": "B", "x": 0.1} },
        "joints": { "J": {"from": "1", "to": "4", "stiffness": [[1e6, 0], [0, 1e3]]}, "K": {"from": "2", "to": "3", "stiffness": [[1e6, 0], [0, 1e3]]} } }"#;
    let pair = Fixture::from_json(text).unwrap();
    let error = fit_joints(&pair, &frfs, None, JointFitOptions::default()).unwrap_err();
    assert!(matches!(&error, SeveralError::Parallel { joints, .. } if joints == &["J", "K"]), "{error}");
    // Nothing is measured of the second pair of blocks.
    let text = r#"{ "bodies": { "A": {"mass": 1, "inertia": 1e-3, "x_cg": 0}, "B": {"mass": 1, "inertia": 1e-3, "x_cg": 0.1},
                    "C": {"mass": 1, "inertia": 1e-3, "x_cg": 0.3}, "D": {"mass": 1, "inertia": 1e-3, "x_cg": 0.4} },
        "points": { "1": {"body": "A", "x": -0.03}, "2": {"body": "A", "x": 0.02}, "3": {"body": "B", "x": 0.08}, "4": {"body": "B", "x": 0.14},
                    "5": {"body": "C", "x": 0.32}, "6": {"body": "D", "x": 0.38} },
        "joints": { "J": {"from": "2", "to": "3", "stiffness": [[1e6, -3e4], [-3e4, 2e3]], "damping": [[5, 0], [0, 0.01]]},
                    "K": {"from": "5", "to": "6", "stiffness": [[1e6, -3e4], [-3e4, 2e3]], "damping": [[5, 0], [0, 0.01]]} } }"#;
    let two = Fixture::from_json(text).unwrap();
    let few = recorded(&two, &mut Noise::new(2), 0.01, &TWELVE[..4]);
    let error = fit_joints(&two, &few, None, JointFitOptions::default()).unwrap_err();
    assert_eq!(error, SeveralError::Undetermined { joints: vec!["K".into()] });
}

#[test]
fn a_joint_that_relaxes_is_told_from_the_viscous_one_beside_it() {
    let physics = r#"{ "kind": "relaxation", "place": "K", "ratio": 0.06, "time": 4e-4 }"#;
    let truth = fixture(Shape::Chain, physics);
    let frfs = recorded(&truth, &mut Noise::new(4), 0.003, &TWELVE);
    let options = JointFitOptions { laws: true, ..JointFitOptions::default() };
    let fit = fit_joints(&fixture(Shape::Chain, ""), &frfs, None, options).unwrap();
    let kinds: Vec<LawKind> = fit.joints.iter().map(|joint| joint.fit.laws[0].kind).collect();
    assert_eq!(kinds, [LawKind::Viscous, LawKind::StandardLinearSolid]);
}

/// Three blocks glued in a row, the glue's losses structural.
fn glued(loss_factor: f64) -> Fixture {
    let block = |mass: f64, inertia: f64, x: f64| serde_json::json!({ "mass": {"value": mass, "std": 0.001}, "inertia": inertia, "x_cg": x });
    let glue = |from: &str, to: &str| serde_json::json!({ "from": from, "to": to, "stiffness": [[5.833e6, -8750.0], [-8750.0, 3485.0]] });
    let point = |body: &str, x: f64| serde_json::json!({ "body": body, "x": x });
    let value = serde_json::json!({
        "bodies": { "A": block(1.1775, 5.986e-4, -0.03), "B": block(1.1775, 5.986e-4, 0.033), "C": block(1.57, 1.1644e-3, 0.106) },
        "points": {
            "1": point("A", -0.055), "2": point("A", -0.005), "3": point("B", 0.008), "4": point("B", 0.058), "5": point("C", 0.071),
            "6": point("C", 0.141), "7": point("A", 0.0), "8": point("B", 0.003), "9": point("B", 0.063), "10": point("C", 0.066),
        },
        "joints": { "J": glue("7", "8"), "K": glue("9", "10") },
        "damping": { "loss_factor": loss_factor },
    });
    Fixture::from_value(&value).unwrap()
}

#[test]
fn two_joints_that_are_structural_both_have_that_law_and_none_takes_the_blame_for_the_other() {
    let lines = SpectralLines::even(10.0, 4.0, 600).unwrap();
    let exact = frfs(&glued(0.05), &transverse(&TWELVE), &lines, Instrument::Perfect).unwrap();
    let recorded = Noise::new(1).on(&exact, 0.002);
    let options = JointFitOptions { laws: true, ..JointFitOptions::default() };
    let fit = fit_joints(&glued(0.005), &recorded, None, options).unwrap();
    let kinds: Vec<LawKind> = fit.joints.iter().map(|joint| joint.fit.laws[0].kind).collect();
    assert_eq!(kinds, [LawKind::Structural, LawKind::Structural]);
    // One joint after the other ended at 19.
    assert!((0.9..1.1).contains(&fit.joints[0].fit.chi2_per_dof), "{}", fit.joints[0].fit.chi2_per_dof);
}

#[test]
fn a_cable_from_block_to_block_past_the_joints_is_in_the_fit() {
    let cable = r#"{ "kind": "bypass", "place": "A/C", "x_from": -0.04, "x_to": 0.28, "stiffness": 4e4, "damping": 0 }"#;
    let with_cable = with_effect(&fixture(Shape::Chain, ""), cable);
    let frfs = recorded(&with_cable, &mut Noise::new(6), 0.01, &TWELVE);
    let fit = fit_joints(&with_cable, &frfs, None, JointFitOptions::default()).unwrap();
    assert!((0.95..1.05).contains(&fit.joints[0].fit.chi2_per_dof), "{}", fit.joints[0].fit.chi2_per_dof);
    for (e, (found, expected)) in found(&fit).iter().zip(stated(&with_cable)).enumerate() {
        let score = (found - expected) / fit.covariance[e][e].sqrt();
        assert!(score.abs() < 4.0, "{}: {found} for {expected}, {score} deviations", fit.elements[e]);
    }
}

/// The fixture with an effect.
fn with_effect(fixture: &Fixture, effect: &str) -> Fixture {
    let mut value = fixture.to_value();
    value["physics"] = serde_json::json!([serde_json::from_str::<serde_json::Value>(effect).unwrap()]);
    Fixture::from_value(&value).unwrap()
}

/// Two tests of a chain on the same drawn blocks, K a twentieth stiffer in the second, compared as `compare`
/// does it: errors of the ratio of K11 over its stated deviation and the relative deviation, of K between the
/// tests and of K to J within the first.
fn compared(count: u64, seed: u64) -> [Vec<[f64; 2]>; 2] {
    let fixture = fixture(Shape::Chain, "");
    let mut all = [Vec::new(), Vec::new()];
    for run in 0..count {
        let truth = drawn_within_tolerance(&fixture, &mut generator(seed + run)).unwrap();
        let mut other = truth.clone();
        for entry in other.quantities_mut() {
            if entry.path.starts_with("joints/K/stiffness") {
                entry.quantity.value *= 1.05;
            }
        }
        let mut noise = Noise::new(seed + run);
        let mut joints = |name: &str, truth: &Fixture| {
            let frfs = recorded(truth, &mut noise, 0.01, &TWELVE);
            let fit = fit_joints(&fixture, &frfs, None, JointFitOptions::default()).unwrap();
            Decomposed::all(name, &joints_file(&fit)).unwrap()
        };
        let both = [joints("a", &truth), joints("b", &other)].concat();
        let comparison = Comparison::of(both).unwrap();
        let k11 = stated(&truth);
        for (all, (first, second, expected)) in
            all.iter_mut().zip([("a/K", "b/K", 1.05), ("a/J", "a/K", k11[6] / k11[0])])
        {
            let pair = comparison.pairs.iter().find(|pair| pair.first == first && pair.second == second);
            let ratio = pair.unwrap().number("K11").unwrap().ratio.unwrap();
            all.push([(ratio.value - expected) / ratio.std, ratio.std / ratio.value]);
        }
    }
    for (all, name) in all.iter().zip(["K of two tests", "K to J of one test"]) {
        let inside = all.iter().filter(|run| run[0].abs() < 1.96).count();
        println!(
            "{name}: rms of error/std {:.3}, 95 % intervals hold {inside} of {count}, std {:.4} %",
            rms(all.iter().map(|run| run[0])),
            100.0 * rms(all.iter().map(|run| run[1]))
        );
    }
    all
}

#[test]
fn ratios_of_joints_found_at_once_are_as_far_off_as_stated_within_a_test_and_between_two() {
    for (runs, most) in compared(12, 300).iter().zip([1e-3, 5e-3]) {
        // The rms of 12 scores has a standard deviation of 0.2.
        let score = rms(runs.iter().map(|run| run[0]));
        assert!((0.4..1.6).contains(&score), "{score}");
        assert!(runs.iter().all(|run| run[1] < most), "{:?}", runs[0]);
    }
}

#[test]
#[ignore = "minutes; the record of the joint has its figures"]
fn ratios_of_joints_found_at_once_hold_in_their_intervals_in_two_hundred_runs() {
    for runs in compared(200, 400) {
        let score = rms(runs.iter().map(|run| run[0]));
        let inside = runs.iter().filter(|run| run[0].abs() < 1.96).count();
        assert!(score <= 1.15 && (182..=198).contains(&inside), "{score}, {inside}");
    }
}
