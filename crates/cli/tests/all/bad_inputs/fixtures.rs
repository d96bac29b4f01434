//! Fixtures with a wrong value, name or unit, or without a key that they need.

use super::Cases;
use crate::common::TWO_BLOCKS;

#[test]
fn a_fixture_that_cannot_be_is_refused_by_the_path_of_what_is_wrong() {
    let mut cases = Cases::new("bad-fixtures");
    for (from, to, words) in CHANGED {
        cases.changed(from, to, words);
    }
    cases.fixture("nothing in it", "{}", "`bodies` is missing");
    cases.fixture("no bodies", "{ \"bodies\": {}, \"points\": {} }", "bodies|there are no bodies|state one");
    cases.fixture("a list alone", "[1, 2]", "a list stands|jointscope init");
    cases.fixture(
        "a deviation below zero",
        TWO_BLOCKS.replacen("\"mass\": 1.10,", "\"mass\": {\"value\": 1.10, \"std\": -0.01},", 1),
        "bodies/A/mass/std|below zero|unknown",
    );
    cases.fixture("bodies in a list", "{ \"bodies\": [], \"points\": {} }", "bodies|a list stands|object");
    cases.finish();
}

/// What is changed in the good fixture, to what, and what is to be said.
const CHANGED: &[(&str, &str, &str)] = &[
    (r#""bodies""#, r#""Bodies""#, "did you mean `bodies`?"),
    (r#""points""#, r#""point""#, "did you mean `points`?"),
    (r#""joints""#, r#""jionts""#, "did you mean `joints`?"),
    (r#""damping""#, r#""dampign""#, "did you mean `damping`?"),
    (r#""name""#, r#""title""#, "`title` is unknown|the keys possible here"),
    (r#""mass""#, r#""masss""#, "bodies/A|did you mean `mass`?"),
    (r#""inertia""#, r#""intertia""#, "bodies/A|did you mean `inertia`?"),
    (r#""x_cg""#, r#""xcg""#, "bodies/A|did you mean `x_cg`?"),
    (r#""youngs_modulus""#, r#""young_modulus""#, "joints/J/beam|did you mean `youngs_modulus`?"),
    (r#""second_moment""#, r#""I""#, "joints/J/beam|`I` is unknown|second_moment"),
    (r#""loss_factor""#, r#""eta""#, "damping|`eta` is unknown"),
    (r#""from": "2""#, r#""form": "2""#, "joints/J|did you mean `from`?"),
    (r#""mass": 1.10, "#, "", "bodies/A|`mass`|missing"),
    (r#""inertia": 9.5e-4, "#, "", "bodies/A|`inertia` is missing"),
    (r#", "x_cg": -0.030"#, "", "bodies/A|`x_cg` is missing"),
    (r#""body": "A", "#, "", "points/1|`body` is missing"),
    (r#", "x": -0.060"#, "", "points/1|`x` is missing"),
    (r#""to": "3", "#, "", "joints/J|`to` is missing"),
    (r#", "second_moment": 3.67e-10"#, "", "joints/J/beam|`second_moment` is missing"),
    (
        r#", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }"#,
        "",
        "joints/J|`beam`|`stiffness`",
    ),
    (r#""beam": {"#, r#""stiffness": [[1e6, 0], [0, 1e3]], "beam": {"#, "joints/J|`beam`|`stiffness`"),
    ("1.10", "-1.10", "bodies/A/mass|above zero"),
    ("1.10", "0", "bodies/A/mass|above zero"),
    ("1.10", "null", "bodies/A/mass|null stands where a number is needed"),
    ("1.10", r#""1.10 kg""#, r#"bodies/A/mass|the text "1.10 kg" stands where a number is needed"#),
    ("1.10", "[1.10]", "bodies/A/mass|a list stands where a number is needed"),
    ("1.10", "true", "bodies/A/mass|stands where a number is needed"),
    ("1.10", "{}", "bodies/A/mass|`value` is missing"),
    ("1.10", r#"{ "std": 0.1 }"#, "bodies/A/mass|`value` is missing"),
    ("1.10", r#"{ "value": 1.10 }"#, "bodies/A/mass|`std` is missing"),
    ("1.10", r#"{ "value": 1.10, "sdt": 0.1 }"#, "bodies/A/mass|did you mean `std`?"),
    ("1.10", r#"{ "value": 1.10, "std": -0.1 }"#, "bodies/A/mass/std|below zero"),
    ("1.10", r#"{ "value": 1.10, "std": "good" }"#, r#"bodies/A/mass/std|a number or "unknown""#),
    ("1.10", r#"{ "value": "1.10", "std": 0.1 }"#, "bodies/A/mass/value|stands where a number is needed"),
    ("9.5e-4", "-9.5e-4", "bodies/A/inertia|above zero"),
    ("9.5e-4", "0", "bodies/A/inertia|above zero"),
    (r#""x": -0.060"#, r#""x": "left""#, "points/1/x|stands where a number is needed"),
    (r#""body": "A""#, r#""body": 1"#, "points/1/body|a name in quotes is needed"),
    (r#"{ "body": "A", "x": -0.060 }"#, "-0.060", "points/1|stands where an object"),
    (r#""4": { "body": "B""#, r#""4": { "body": "C""#, "points/4|`C`|A, B"),
    (r#""4": { "body": "B""#, r#""4": { "body": "b""#, "points/4|`b`"),
    (r#""from": "2""#, r#""from": "7""#, "joints/J/from|`7`|1, 2, 3, 4"),
    (r#""to": "3""#, r#""to": 3"#, "joints/J/to|a name in quotes is needed"),
    (r#""to": "3""#, r#""to": "2""#, "joints/J|a joint connects two bodies"),
    (r#""to": "3""#, r#""to": "1""#, "joints/J|a joint connects two bodies"),
    (r#""from": "2", "to": "3""#, r#""from": "3", "to": "2""#, "joints/J|wrong order"),
    (r#""x": 0.065"#, r#""x": 0.0"#, "joints/J|needs a length"),
    ("2.07e11", "0", "joints/J/beam/youngs_modulus|above zero"),
    ("2.07e11", "-2.07e11", "joints/J/beam/youngs_modulus|above zero"),
    ("3.67e-10", "-3.67e-10", "joints/J/beam/second_moment|above zero"),
    ("0.006", "-0.006", "damping|zero or above"),
    ("0.006", r#""small""#, "damping/loss_factor|stands where a number is needed"),
    (r#""loss_factor": 0.006"#, r#""modal_ratios": 0.01"#, "damping/modal_ratios|a list [..] is needed"),
    (r#""loss_factor": 0.006"#, r#""modal_ratios": [0.01, -0.01]"#, "damping/modal_ratios/1|zero or above"),
    (r#""loss_factor": 0.006"#, r#""modal_ratios": [2]"#, "damping/modal_ratios/0|1 % is written 0.01"),
    (r#""loss_factor": 0.006"#, r#""rayleigh": { "mas": 1 }"#, "damping/rayleigh|did you mean `mass`?"),
    (
        r#""loss_factor": 0.006"#,
        r#""rayleigh": { "mass": -1, "stiffness": 0 }"#,
        "damping/rayleigh/mass|zero or above",
    ),
    (r#""loss_factor": 0.006"#, r#""loss_factor": 0.006, "modal_ratios": [0.01]"#, "damping"),
    (r#""loss_factor": 0.006"#, r#""modal_ratios": [0.01], "of": "all""#, r#"damping/of|`"of": "free"`"#),
    (r#"{ "loss_factor": 0.006 }"#, "0.006", "damping|an object {..} is needed"),
    (r#""x_cg": -0.030"#, r#""x_cg": -0.030, "rotates": "no""#, "bodies/A/rotates"),
    (
        r#""x_cg": -0.030"#,
        r#""x_cg": -0.030, "masses": [{ "x": 0, "mass": -1 }]"#,
        "bodies/A/masses/0/mass|zero or above",
    ),
    (r#""x_cg": -0.030"#, r#""x_cg": -0.030, "masses": [{ "mass": 1 }]"#, "bodies/A/masses/0|`x` is missing"),
    (
        r#""mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030"#,
        r#""beam": { "from": 0, "to": -0.1, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 1 }"#,
        "bodies/A/beam",
    ),
    (
        r#""mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030"#,
        r#""beam": { "from": -0.05, "to": 0, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 1 }"#,
        "points/1|not on the beam `A`",
    ),
    (
        r#""mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030"#,
        r#""beam": { "from": -0.06, "to": 0, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 0 }"#,
        "bodies/A/beam/mass_per_length|above zero",
    ),
];
