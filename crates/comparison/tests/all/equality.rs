//! Whether joints are the same, of files that state other laws or hold a C.

use super::{compared, file};
use jointscope_comparison::{Comparison, ComparisonOptions, WhyApart};
use jointscope_wording::comparison::{shared, tested};
use serde_json::{Value, json};

fn likelihood(elements: &[&str], at: &[f64]) -> Value {
    let unit: Vec<Vec<f64>> =
        (0..at.len()).map(|i| (0..=i).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    json!({"elements": elements, "at": at, "gradient": vec![0.0; at.len()], "information": unit})
}

/// A joint whose numbers are of the law `own`, with K11 and C11 of this and of another law, each to ±1; the
/// quantity does nothing.
fn by_law(own: (&str, f64, [f64; 2]), other: (&str, f64, [f64; 2])) -> Value {
    let mut file = file(own.2[0], 0.0, 5.0);
    let matrix = |value: f64| json!([[value, 0.0], [0.0, 0.0]]);
    let law = |(law, probability, [k, c]): (&str, f64, [f64; 2])| {
        let middle = json!({"stiffness": matrix(k), "damping": matrix(c)});
        json!({"law": law, "probability": probability, "in_the_middle": middle})
    };
    let told = |[k, c]: [f64; 2]| likelihood(&["k11", "c11"], &[k, c, 0.0]);
    let mut beside = law(other);
    beside["likelihood"] = told(other.2);
    let joint = &mut file["joint"];
    joint["damping"] = matrix(own.2[1]);
    joint["covariance"][3][3] = json!(1.0);
    joint["likelihood"] = told(own.2);
    joint["law"] = json!(own.0);
    joint["follows"] = json!({"law": own.0, "frequency": 100.0});
    joint["laws"] = json!([law(own), beside]);
    file
}

fn both(files: &[Value]) -> Comparison {
    compared(files, &ComparisonOptions::default())
}

#[test]
fn joints_whose_most_probable_laws_differ_are_compared_at_the_law_most_probable_of_both() {
    // C11 is 20 of the deviations apart by their own laws, and less than one by either.
    let a = by_law(("viscous", 0.9, [1000.0, 40.0]), ("fractional", 0.1, [1002.0, 60.0]));
    let b = by_law(("fractional", 0.6, [1002.5, 60.4]), ("viscous", 0.4, [1000.5, 40.5]));
    let found = both(&[a, b]);
    let law = found.law.as_ref().unwrap();
    assert_eq!((law.law.as_str(), &law.moved[..]), ("viscous", &["b".to_owned()][..]));
    let equality = found.pairs[0].equality.unwrap();
    // 0.5 in K11 and in C11, each of variance 2; what laws change is no part of it.
    assert!((equality.chi2 - 0.25).abs() < 1e-9 && equality.degrees == 2, "{equality:?}");
    assert!((found.estimate(1).stiffness[0][0] - 1000.5).abs() < 1e-9);
    assert!(shared(&found).iter().any(|said| said.contains("viscous; by its own FRFs another is")));
}

#[test]
fn joints_of_no_law_in_common_are_not_the_same_and_that_is_said() {
    let mut a = by_law(("viscous", 1.0, [1000.0, 40.0]), ("fractional", 1e-9, [1002.0, 60.0]));
    let mut b = by_law(("fractional", 1.0, [1002.0, 60.0]), ("viscous", 1e-9, [1000.0, 40.0]));
    for file in [&mut a, &mut b] {
        file["joint"]["laws"][1].as_object_mut().unwrap().remove("likelihood");
    }
    let found = both(&[a, b]);
    assert!(found.law.is_none() && found.equality.is_none() && found.pairs[0].equality.is_none());
    let said = tested(&found, &found.pairs[0]);
    assert!(
        said.contains("a and b are not the same joint: they follow different laws over frequency, a most probably a viscous one and b a fractional one"),
        "{said}"
    );
    assert!(said.contains("less than 0.001"), "{said}");
}

#[test]
fn joints_whose_files_tell_of_no_law_are_not_tested_for_being_the_same_and_that_is_said() {
    let mut a = by_law(("viscous", 1.0, [1000.0, 40.0]), ("fractional", 1e-9, [1002.0, 60.0]));
    let mut b = by_law(("fractional", 1.0, [1002.0, 60.0]), ("viscous", 1e-9, [1000.0, 40.0]));
    for file in [&mut a, &mut b] {
        file["joint"]["laws"] = json!([]);
    }
    let found = both(&[a, b]);
    assert!(found.law.is_none() && found.pairs[0].laws_differ.is_none());
    assert!(tested(&found, &found.pairs[0]).contains("it is not tested whether a and b are the same"));
}

/// The same with how well the exponent of its fractional law is known.
fn with_exponent(mut file: Value, value: f64, std: f64) -> Value {
    let laws = file["joint"]["laws"].as_array_mut().unwrap();
    let fractional = laws.iter_mut().find(|law| law["law"] == "fractional").unwrap();
    fractional["exponent"] = json!({"value": value, "std": std});
    file
}

#[test]
fn joints_of_other_exponents_follow_no_one_fractional_law() {
    // Exponents at either end imitate a viscous and a structural joint.
    let a = by_law(("viscous", 0.9, [1000.0, 40.0]), ("fractional", 0.1, [1000.0, 40.0]));
    let b = by_law(("structural", 0.9, [1000.0, 40.0]), ("fractional", 0.1, [1000.0, 40.0]));
    let found = both(&[with_exponent(a.clone(), 0.97, 0.01), with_exponent(b.clone(), 0.03, 0.01)]);
    let differ = found.pairs[0].laws_differ.as_ref().unwrap();
    assert_eq!((differ.first.as_str(), differ.second.as_str()), ("viscous", "structural"));
    assert!(found.law.is_none() && found.pairs[0].equality.is_none() && differ.one_law < 1e-9);
    // Where the FRFs tell nothing of the exponents they may be the same: 2·0.1·0.1/(1 + 2·0.1·0.1) is below
    // 0.05 still.
    let found = both(&[with_exponent(a, 0.97, 9.0), with_exponent(b, 0.03, 9.0)]);
    let one_law = found.pairs[0].laws_differ.as_ref().unwrap().one_law;
    assert!((one_law - 0.02 / 1.02).abs() < 1e-3, "{one_law}");
}

#[test]
fn tests_that_agree_on_the_blocks_by_one_law_do_not_contradict_each_other_by_another() {
    // By the fractional law, a little more probable for both together, b would move the quantity by four
    // deviations.
    let a = by_law(("viscous", 0.58, [1000.0, 40.0]), ("fractional", 0.42, [1000.0, 40.0]));
    let mut b = by_law(("fractional", 0.6, [1000.0, 40.0]), ("viscous", 0.4, [1000.0, 40.0]));
    b["joint"]["likelihood"]["at"][2] = json!(8.0);
    let found = both(&[a.clone(), b.clone()]);
    assert_eq!(found.law.as_ref().unwrap().law, "fractional");
    assert!(found.together.apart.is_empty() && !found.together.shared.is_empty());
    // By either law they do.
    b["joint"]["laws"][1]["likelihood"]["at"][2] = json!(8.0);
    let found = both(&[a, b]);
    assert!(found.together.apart.iter().any(|apart| apart.why == WhyApart::Disagrees));
}

#[test]
fn three_joints_are_the_same_where_every_two_are() {
    // K11 to ±1 each: the first two are 0.4 apart, the third is 3 and 3.4.
    let of = |k: f64| by_law(("viscous", 1.0, [k, 40.0]), ("fractional", 1e-9, [k, 40.0]));
    let found = both(&[of(1000.0), of(1000.4), of(997.0)]);
    let p: Vec<f64> = found.pairs.iter().map(|pair| pair.equality.unwrap().p_value).collect();
    assert!(p[0] > p[1] && p[1] > p[2], "{p:?}");
    assert!((found.equality.unwrap().p_value - 3.0 * p[2]).abs() < 1e-12);
}

#[test]
fn c_of_structural_joints_whose_bands_differ_is_compared_at_one_frequency() {
    // C of b, which is half as large at twice the frequency, to half of ±1.
    let own = |c: f64| ("structural", 0.9, [1000.0, c]);
    let a = by_law(own(40.0), ("viscous", 0.1, [1000.0, 40.0]));
    let mut b = by_law(own(20.0), ("viscous", 0.1, [1000.0, 40.0]));
    b["joint"]["follows"]["frequency"] = json!(200.0);
    b["joint"]["covariance"][3][3] = json!(0.25);
    b["joint"]["likelihood"]["information"][1][1] = json!(4.0);
    let found = both(&[a, b]);
    let pair = &found.pairs[0];
    let c11 = pair.number("C11").unwrap();
    assert!((c11.ratio.unwrap().value - 1.0).abs() < 1e-9, "{c11:?}");
    assert!((found.together.std(1, 1) - 1.0).abs() < 1e-2, "{}", found.together.std(1, 1));
    assert!(pair.equality.unwrap().p_value > 0.99);
    assert!(
        shared(&found).iter().any(|said| said.contains("C of b is stated at the frequency of the first"))
    );
}

#[test]
fn two_of_three_joints_that_have_a_law_in_common_are_tested_at_it() {
    let mut a = by_law(("viscous", 1.0, [1000.0, 40.0]), ("fractional", 1e-9, [1002.0, 60.0]));
    a["joint"]["laws"][1].as_object_mut().unwrap().remove("likelihood");
    let mut b = by_law(("fractional", 1.0, [1002.0, 60.0]), ("viscous", 1e-9, [1000.0, 40.0]));
    b["joint"]["laws"][1].as_object_mut().unwrap().remove("likelihood");
    let found = both(&[a.clone(), b, a]);
    let of = |pair: usize| found.pairs[pair].equality.map(|equality| equality.chi2);
    assert!(found.equality.is_none());
    assert_eq!((of(0), of(1).map(|chi2| chi2.abs() < 1e-9), of(2)), (None, Some(true), None));
}

#[test]
fn a_c_that_is_held_enters_the_test_of_equality_as_its_frfs_alone_have_it() {
    // The FRFs of b ask for C11 = −1 ± 1, which is held at zero; those of a for 1 ± 1.
    let own = |c: f64| ("viscous", 0.9, [1000.0, c]);
    let other = ("fractional", 0.1, [1000.0, 5.0]);
    let mut held = by_law(own(0.0), other);
    held["joint"]["on_the_boundary_of_passive"] = json!(true);
    held["joint"]["covariance"][3][3] = json!(0.0);
    held["joint"]["likelihood"] = likelihood(&["k11", "c11"], &[1000.0, -1.0, 0.0]);
    let found = both(&[by_law(own(1.0), other), held]);
    let equality = found.pairs[0].equality.unwrap();
    assert!((equality.chi2 - 2.0).abs() < 1e-9 && equality.degrees == 2, "{equality:?}");
    assert_eq!(found.estimate(1).damping[0][0], 0.0);
}

#[test]
fn numbers_that_neither_joints_frfs_tell_are_left_out_of_the_test_of_equality_and_named() {
    // Of three joints a and b follow a law without damping, the third a viscous one.
    let mut bare = by_law(("constant", 1.0, [1000.0, 0.0]), ("viscous", 1e-9, [1000.0, 0.0]));
    bare["joint"]["laws"][1].as_object_mut().unwrap().remove("likelihood");
    bare["joint"]["covariance"][3][3] = json!(0.0);
    bare["joint"]["likelihood"] = likelihood(&["k11"], &[1000.0, 0.0]);
    let viscous = by_law(("viscous", 1.0, [1000.0, 40.0]), ("fractional", 1e-9, [1002.0, 60.0]));
    let found = both(&[bare.clone(), bare, viscous]);
    let pair = &found.pairs[0];
    assert_eq!((pair.equality.unwrap().degrees, &pair.undetermined[..]), (1, &["C11".to_owned()][..]));
    assert!(tested(&found, pair).contains("C11, of which neither's FRFs tell anything, are left out"));
}

#[test]
fn a_c_that_another_law_makes_give_out_energy_is_stated_where_it_just_does_not() {
    let a = by_law(("viscous", 0.9, [1000.0, 1.0]), ("fractional", 0.1, [1002.0, 60.0]));
    let b = by_law(("fractional", 0.6, [1002.5, 60.4]), ("viscous", 0.4, [1000.0, -1.0]));
    let found = both(&[a, b]);
    assert_eq!(found.estimate(1).damping[0][0], 0.0);
    assert!((found.pairs[0].equality.unwrap().chi2 - 2.0).abs() < 1e-9);
}

#[test]
fn slopes_that_differ_since_fits_end_at_other_places_of_one_valley_are_no_difference_of_joints() {
    // K11 = 1000 + 2 q² is what the FRFs tell, q is not: fits that end at q = ±0.5 have slopes of ±2 and the
    // same K11; by their own slopes K11 is 2 (q + 0.5) or −2 (q − 0.5) off.
    let at = |q: f64| {
        let slope = -4.0 * q;
        let k11 = 1000.0 + 2.0 * q * q;
        let mut file = file(k11, 0.0, 5.0);
        let scale = 1e4;
        file["joint"]["likelihood"] = json!({
            "elements": ["k11"], "at": [k11, q], "gradient": [0.0, 0.0],
            "information": [[scale], [scale * slope, scale * slope * slope]],
        });
        file
    };
    let found = both(&[at(0.5), at(-0.5)]);
    let equality = found.pairs[0].equality.unwrap();
    assert!(equality.chi2 < 1e-6, "{equality:?}");
    // Three places of it: the mean of all slopes is that between no two of them.
    let found = both(&[at(0.5), at(-0.5), at(0.3)]);
    assert!(found.pairs.iter().all(|pair| pair.equality.unwrap().chi2 < 1e-6), "{:?}", found.pairs);
    assert!(found.equality.unwrap().p_value > 0.99, "{:?}", found.equality);
    // A joint that is 0.1 stiffer with noise of 0.01 is told, whatever the slopes: 0.1²/(2·0.01²).
    let mut stiffer = at(-0.5);
    stiffer["joint"]["likelihood"]["at"][0] = json!(1000.6);
    let equality = both(&[at(0.5), stiffer]).pairs[0].equality.unwrap();
    assert!((equality.chi2 - 50.0).abs() < 1e-3, "{equality:?}");
}
