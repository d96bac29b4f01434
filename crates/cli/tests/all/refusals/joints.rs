//! Joints and bands that are not there.

use super::LINES;
use crate::common::{Bench, TWO_BLOCKS};

const THREE_BLOCKS: &str = r#"{
  "bodies": {
    "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.5e-4, "x_cg": 0.10 },
    "C": { "mass": 1.3, "inertia": 9.5e-4, "x_cg": 0.23 }
  },
  "points": {
    "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.07 }, "4": { "body": "B", "x": 0.13 },
    "5": { "body": "C", "x": 0.2 }, "6": { "body": "C", "x": 0.26 }
  },
  "joints": {
    "near": { "from": "2", "to": "3", "stiffness": [[3e6, -1e5], [-1e5, 5e3]] },
    "far": { "from": "4", "to": "5", "stiffness": [[3e6, -1e5], [-1e5, 5e3]] }
  },
  "damping": { "loss_factor": 0.01 }
}"#;

#[test]
fn a_joint_that_is_chosen_must_be_there() {
    let bench = Bench::synthesized("bad-joints", THREE_BLOCKS, LINES);
    bench.refused(
        &["decompose", "two.json", "frf.uff", "--joint", "nearr", "-o", "out"],
        &["two.json", "no joint `nearr`", "near, far"],
    );
}

#[test]
fn two_joints_between_the_same_two_blocks_are_told_from_each_other_by_no_frf() {
    let beside = r#""beside": { "from": "1", "to": "4", "stiffness": [[1e5, 0], [0, 0]] }, "far""#;
    let doubled = THREE_BLOCKS.replacen(r#""far""#, beside, 1);
    let bench = Bench::synthesized("bad-beside", &doubled, LINES);
    bench.refused(
        &["decompose", "two.json", "frf.uff", "-o", "out"],
        &["two.json", "joints `near` and `beside`", "only the sum", "--joint"],
    );
}

#[test]
fn a_fixture_of_one_body_has_no_joint_to_find() {
    let bench = Bench::new("bad-single");
    bench.write("two.json", r#"{ "bodies": { "A": { "mass": 2, "rotates": false } }, "points": { "1": { "body": "A", "x": 0 } } }"#);
    bench.done(&["synthesize", "two.json", "--frf", "1/1", "--lines", LINES, "-o", "frf.uff"]);
    bench.refused(&["decompose", "two.json", "frf.uff", "-o", "out"], &["two.json", "no joint to find"]);
}

#[test]
fn a_band_without_lines_is_told_the_lines_there_are() {
    let bench = Bench::synthesized("bad-band", TWO_BLOCKS, LINES);
    let decompose = |band: &'static str| ["decompose", "two.json", "frf.uff", "--band", band, "-o", "out"];
    bench.refused(&decompose("2000:3000"), &["frf.uff", "2000 to 3000 Hz", "no usable", "50 to 1000 Hz"]);
    bench.refused(&decompose("300:200"), &["--band", "200:800"]);
}

#[test]
fn a_refusal_leaves_an_earlier_result_as_it_was() {
    let bench = Bench::shipped("bad-earlier");
    bench.done(&["decompose", "fixture.json", "hammer-test.uff", "-o", "out"]);
    bench.refused(&["decompose", "fixture.json", "hammer-test.uff", "--joint", "K", "-o", "out"], &["`K`"]);
    bench.refused(&["decompose", "fixture.json", "hammer-test.uff", "-o", "fixture.json"], &["fixture.json"]);
}
