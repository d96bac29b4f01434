//! Fixtures that cannot be.

use super::LINES;
use crate::common::{Bench, TWO_BLOCKS};

/// The program on a fixture made of a good one by a replacement; it must refuse.
#[track_caller]
fn fixture(name: &str, from: &str, to: &str, parts: &[&str]) {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    assert!(TWO_BLOCKS.contains(from), "{from}");
    bench.write("bad.json", TWO_BLOCKS.replacen(from, to, 1));
    bench.refused(&["decompose", "bad.json", "frf.uff", "-o", "out"], parts);
}

#[test]
fn a_joint_at_an_unknown_point_is_placed() {
    fixture("bad-point", r#""to": "3""#, r#""to": "9""#, &["bad.json: joints/J/to", "`9`", "1, 2, 3, 4"]);
    fixture(
        "bad-body",
        r#""4": { "body": "B""#,
        r#""4": { "body": "C""#,
        &["bad.json: points/4", "`C`", "A, B"],
    );
}

#[test]
fn an_impossible_fixture_is_placed() {
    fixture("bad-mass", "1.10", "-1.10", &["bad.json: bodies/A/mass", "above zero"]);
    fixture(
        "bad-order",
        r#""from": "2", "to": "3""#,
        r#""from": "3", "to": "2""#,
        &["bad.json: joints/J", "x"],
    );
    fixture(
        "bad-length",
        r#""3": { "body": "B", "x": 0.065 }"#,
        r#""3": { "body": "B", "x": 0.0 }"#,
        &["bad.json: joints/J", "needs a length", "`stiffness`"],
    );
}

#[test]
fn an_unknown_key_is_taken_for_the_one_it_resembles() {
    let cases = [
        (r#""x_cg""#, r#""x_gc""#, "did you mean `x_cg`?"),
        (r#""second_moment""#, r#""second_momnet""#, "did you mean `second_moment`?"),
        (r#""loss_factor""#, r#""lossfactor""#, "did you mean `loss_factor`?"),
        (r#""joints""#, r#""joint""#, "did you mean `joints`?"),
    ];
    for (index, (good, bad, advice)) in cases.into_iter().enumerate() {
        fixture(&format!("bad-key-{index}"), good, bad, &["bad.json: ", advice]);
    }
}
