//! Joints that one fit found at once, whose files are made by hand, against closed forms.

use jointscope_comparison::{
    Comparison, ComparisonError, ComparisonOptions, Decomposed, DecomposedError, Source, WhyApart,
};
use jointscope_wording::comparison::shared;
use serde_json::{Value, json};

/// What a unit of the mass of block A does to K11 of either joint.
const BY_MASS: f64 = 20.0;

/// One test that reads J + 20 q and K + 20 q off scales of deviation 1, with q the mass of block A in
/// standard deviations.
fn file(j: f64, k: f64) -> Value {
    let (s, own) = (BY_MASS, BY_MASS * BY_MASS);
    let zero = [[0.0; 2]; 2];
    let joint = |name: &str, k11: f64| {
        let mut covariance = [[0.0; 6]; 6];
        covariance[0][0] = 1.0 + own;
        // K and its scale integrated out.
        let likelihood = json!({"elements": ["k11"], "at": [k11, 0.0], "gradient": [0.0, 0.0], "information": [[1.0], [s, own]]});
        json!({
            "name": name, "stiffness": [[k11, 0.0], [0.0, 0.0]], "damping": zero, "covariance": covariance, "chi2_per_dof": 1.01,
            "quantities": [{"path": "bodies/A/mass", "body": "A", "stated": 5.0, "std": 0.1}],
            "ends": {"length": 0.03, "from": {"point": "2", "body": "A", "x": 0.0}, "to": {"point": "3", "body": "B", "x": 0.03}},
            "nominal_stiffness": [[1000.0, 0.0], [0.0, 0.0]], "likelihood": likelihood,
        })
    };
    json!({
        "joints": [joint("J", j), joint("K", k)],
        "covariance": {"elements": ["J/k11", "K/k11"], "matrix": [[1.0 + own, own], [own, 1.0 + own]]},
        "likelihood": {
            "elements": ["J/k11", "K/k11"], "at": [j, k, 0.0], "gradient": [0.0, 0.0, 0.0],
            "information": [[1.0], [0.0, 1.0], [s, s, 2.0 * own]],
        },
    })
}

fn all(files: &[(&str, Value)]) -> Vec<Decomposed> {
    files.iter().flat_map(|(name, file)| Decomposed::all(*name, file).unwrap()).collect()
}

/// Standard deviation of the difference of K11 of two joints.
fn apart(comparison: &Comparison, first: &str, second: &str) -> f64 {
    let pair = comparison.pairs.iter().find(|pair| pair.first == first && pair.second == second).unwrap();
    pair.number("K11").unwrap().difference.std
}

#[test]
fn joints_of_one_fit_differ_by_what_its_covariance_leaves() {
    let found = Comparison::of(all(&[("a", file(1000.0, 1050.0))])).unwrap();
    assert!((apart(&found, "a/J", "a/K") - 2f64.sqrt()).abs() < 1e-9);
    assert!((found.together.std(0, 0) - 401f64.sqrt()).abs() < 1e-9);
    assert_eq!(found.together.at_once, [["a/J", "a/K"]]);
    // Neither is apart from anything, and that both are of one recording is in the covariance.
    assert!(found.together.apart.is_empty() && found.is_sound(), "{:?}", found.cautions);
    assert!(shared(&found).join(" ").contains("found at once by one fit"), "{:?}", shared(&found));
    let unusual = ComparisonOptions { independent: true, ..Default::default() };
    let asked = Comparison::with(all(&[("a", file(1000.0, 1050.0))]), &unusual).unwrap();
    assert!((apart(&asked, "a/J", "a/K") - 2f64.sqrt()).abs() < 1e-9);
}

#[test]
fn a_block_that_two_fits_of_several_joints_share_cancels_between_all_of_them() {
    let files = [("a", file(1000.0, 1050.0)), ("b", file(1000.0, 1100.0))];
    let found = Comparison::of(all(&files)).unwrap();
    for (first, second) in [("a/J", "b/J"), ("a/J", "b/K"), ("a/K", "b/K"), ("a/J", "a/K")] {
        let std = apart(&found, first, second);
        assert!((std - 2f64.sqrt()).abs() < 1e-9, "{first} and {second}: {std}");
    }
    assert_eq!(found.together.shared[0].joints, ["a/J", "a/K", "b/J", "b/K"]);
    assert!(found.together.apart.is_empty(), "{:?}", found.together.apart);
    let unusual = ComparisonOptions { independent: true, ..Default::default() };
    let asked = Comparison::with(all(&files), &unusual).unwrap();
    assert!((apart(&asked, "a/J", "b/J") - 802f64.sqrt()).abs() < 1e-9);
    assert!((apart(&asked, "a/J", "a/K") - 2f64.sqrt()).abs() < 1e-9);
}

#[test]
fn one_joint_of_several_is_compared_with_the_others_integrated_out() {
    let one = |name: &str, k: f64| Decomposed::one(name, &file(1000.0, k), "K").unwrap();
    let found = Comparison::of(vec![one("a", 1050.0), one("b", 1100.0)]).unwrap();
    assert!((apart(&found, "a", "b") - 2f64.sqrt()).abs() < 1e-9);
    assert_eq!((found.joints[0].joint.as_str(), found.together.at_once.len()), ("K", 0));
    let error = Decomposed::one("a", &file(1000.0, 1050.0), "L").unwrap_err();
    assert_eq!(error, DecomposedError::NoSuchJoint { name: "L".into(), known: vec!["J".into(), "K".into()] });
    let error = Decomposed::of("ring", &file(1000.0, 1050.0)).unwrap_err();
    assert_eq!(error, DecomposedError::Several(vec!["J".into(), "K".into()]));
}

#[test]
fn what_a_models_error_does_to_two_joints_at_once_stays_common_to_them() {
    let mut first = file(1000.0, 1050.0);
    first["covariance"]["model"] = json!([[9.0, 8.0], [8.0, 9.0]]);
    for joint in 0..2 {
        let mut model = [[0.0; 6]; 6];
        model[0][0] = 9.0;
        first["joints"][joint]["model_error"] = json!({"inflation": 3.0, "strain": 1.0, "covariance": model});
    }
    let found = Comparison::of(all(&[("a", first), ("b", file(1000.0, 1100.0))])).unwrap();
    // 2 of noise, 9 + 9 − 2·8 of the model.
    assert!((apart(&found, "a/J", "a/K") - 2.0).abs() < 1e-9, "{}", apart(&found, "a/J", "a/K"));
    assert!((apart(&found, "a/J", "b/J") - 11f64.sqrt()).abs() < 1e-9);
}

#[test]
fn a_joint_whose_c_is_held_keeps_all_of_its_fit_apart() {
    let mut held = file(1000.0, 1050.0);
    held["joints"][1]["on_the_boundary_of_passive"] = json!(true);
    let found = Comparison::of(all(&[("a", held), ("b", file(1000.0, 1100.0))])).unwrap();
    let why =
        |name: &str| found.together.apart.iter().find(|apart| apart.joint == name).map(|apart| apart.why);
    assert_eq!((why("a/J"), why("a/K")), (Some(WhyApart::OnTheBoundary), Some(WhyApart::OnTheBoundary)));
    assert_eq!(why("b/J"), Some(WhyApart::LeftAlone));
    assert!((apart(&found, "a/J", "a/K") - 2f64.sqrt()).abs() < 1e-9);
}

#[test]
fn joints_found_at_once_are_not_compared_by_averages_which_they_do_not_have() {
    let average = json!({
        "joint": "J", "relation": "exact", "lines": [],
        "average": {"band": [1.0, 2.0], "stiffness": [[1.0, 0.0], [0.0, 1.0]], "damping": [[0.0, 0.0], [0.0, 0.0]]},
    });
    let error = Comparison::of(all(&[("old", average), ("a", file(1000.0, 1050.0))])).unwrap_err();
    let expected = ComparisonError::NothingInCommon { found_at_once: "a/J".into(), other: "old".into() };
    assert_eq!(error, expected);
}

#[test]
fn a_file_whose_covariance_does_not_fit_its_joints_is_refused() {
    let mut wrong = file(1000.0, 1050.0);
    wrong["covariance"]["matrix"] = json!([[1.0]]);
    let refused = Decomposed::all("a", &wrong).unwrap_err();
    assert_eq!(refused, DecomposedError::Missing("covariance".into()));
    wrong = file(1000.0, 1050.0);
    wrong["joints"] = json!([]);
    assert_eq!(Decomposed::all("a", &wrong).unwrap_err(), DecomposedError::Missing("joints".into()));
}

#[test]
fn of_joints_found_at_once_a_model_is_set_against_the_measured_one_of_its_name() {
    let mut joints = all(&[("model", file(1000.0, 1100.0)), ("test", file(1000.0, 1100.0))]);
    for joint in &mut joints {
        let is_model = joint.name.starts_with("model");
        joint.source = Some(if is_model { Source::Simulation } else { Source::Measurement });
    }
    let found = Comparison::of(joints).unwrap();
    let set: Vec<_> = found.models.iter().map(|m| (m.model.as_str(), m.measurement.as_str())).collect();
    assert_eq!(set, [("model/J", "test/J"), ("model/K", "test/K")]);
}
