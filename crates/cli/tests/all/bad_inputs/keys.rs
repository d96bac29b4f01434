//! Keys that a fixture may have beside its blocks and joints, with something wrong in them: supports,
//! effects, channels, errors of the model.

use super::Cases;

#[test]
fn a_key_with_something_wrong_in_it_is_refused_by_the_path_of_what_is_wrong() {
    let mut cases = Cases::new("bad-keys");
    for (keys, words) in ADDED {
        cases.added(keys, words);
    }
    cases.finish();
}

/// What is added to the good fixture, and what is to be said.
const ADDED: &[(&str, &str)] = &[
    (r#""supports": { "S": { "point": "1" } }"#, "supports/S|`stiffness` is missing"),
    (r#""supports": { "S": { "point": "9", "stiffness": 10 } }"#, "supports/S/point|`9`|1, 2, 3, 4"),
    (r#""supports": { "S": { "stiffness": 10 } }"#, "supports/S"),
    (r#""supports": { "S": { "point": "1", "stiffness": -10 } }"#, "supports/S/stiffness"),
    (r#""supports": { "S": { "body": "C", "x": 0, "stiffness": 10 } }"#, "supports/S/body|`C`"),
    (r#""supports": []"#, "supports|a list stands"),
    (r#""physics": {}"#, "physics|a list [..] is needed"),
    (r#""physics": [{}]"#, "physics/0|`kind` is missing"),
    (r#""physics": [{ "kind": "ghost" }]"#, "physics/0/kind|`ghost`|the effects are"),
    (r#""physics": [{ "kind": "added_mas" }]"#, "physics/0/kind|did you mean `added_mass`?"),
    (r#""physics": [{ "kind": "added_mass" }]"#, "physics/0|`place` is missing"),
    (r#""physics": [{ "kind": "added_mass", "place": "C", "x": 0, "mass": 1 }]"#, "physics/0/place|`C`|A, B"),
    (r#""physics": [{ "kind": "added_mass", "place": "B", "x": 0.1 }]"#, "physics/0|`mass` is missing"),
    (
        r#""physics": [{ "kind": "added_mass", "place": "B", "x": 0.1, "mass": "1 g" }]"#,
        "physics/0/mass|a number is needed",
    ),
    (
        r#""physics": [{ "kind": "added_mass", "place": "B", "x": 0.1, "mas": 1 }]"#,
        "physics/0|did you mean `mass`?",
    ),
    (r#""physics": [{ "kind": "joint_mass", "place": "K", "mass": 1 }]"#, "physics/0/place|`K`"),
    (
        r#""physics": [{ "kind": "interface_compliance", "place": "2", "dof": "x", "stiffness": 1 }]"#,
        "physics/0/dof|`translation`|`rotation`",
    ),
    (
        r#""physics": [{ "kind": "interface_compliance", "place": "2", "stiffness": 1 }]"#,
        "physics/0|`dof` is missing",
    ),
    (
        r#""physics": [{ "kind": "channel_gain", "place": "sensor 3", "factor": 2 }]"#,
        "physics/0/place|response",
    ),
    (r#""physics": [{ "kind": "channel_gain", "place": "response 9", "factor": 2 }]"#, "physics/0/place|`9`"),
    (
        r#""physics": [{ "kind": "bypass", "place": "A/A", "x_from": 0, "x_to": 0.1, "stiffness": 1 }]"#,
        "physics/0/place",
    ),
    (r#""channels": { "sensor 3": {} }"#, "channels"),
    (r#""channels": { "response 3": { "gian": 1 } }"#, "channels|did you mean `gain`?"),
    (r#""model_error": { "frequency": -1 }"#, "model_error/frequency"),
    (r#""model_error": { "frequencies": 1 }"#, "model_error|did you mean `frequency`?"),
    (r#""notes": 3"#, "notes"),
];
