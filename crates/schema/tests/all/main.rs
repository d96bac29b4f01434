//! The schema beside the reader: what one takes, the other takes.
#![allow(clippy::unwrap_used)] // helpers of tests fail as tests do

mod documents;

use jointscope_fixture::Fixture;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn validator() -> jsonschema::Validator {
    jsonschema::draft202012::new(&jointscope_schema::fixture_schema()).unwrap()
}

fn files(folder: &Path, name: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, name, found);
        } else if path.file_name().is_some_and(|own| own.to_string_lossy().ends_with(name)) {
            found.push(path);
        }
    }
}

fn shipped() -> Vec<(PathBuf, Value)> {
    let mut found = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures"), ".json", &mut found);
    found.sort();
    let read = |path: PathBuf| {
        let value: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        (path, value)
    };
    found.into_iter().map(read).filter(|(_, value)| value.get("bodies").is_some()).collect()
}

/// Everything that a fixture can state, in two files.
fn everything() -> Vec<Value> {
    let first = json!({
        "$schema": "fixture.schema.json",
        "name": "everything",
        "notes": ["weighed on the kitchen scales", "point 4 is by the crack"],
        "bodies": {
            "A": { "mass": {"value": 1.1, "std": 0.002}, "inertia": 9.5e-4, "x_cg": {"value": -0.03, "std": "unknown"}, "rotates": true, "masses": [{ "x": -0.05, "mass": 0.01 }] },
            "B": { "beam": { "from": 0.06, "to": 0.2, "youngs_modulus": 2.07e11, "second_moment": 7.2e-10, "mass_per_length": 1.9 } },
            "F": { "mass": 3.5, "rotates": false } },
        "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.06 }, "4": { "body": "B", "x": 0.2 }, "5": { "body": "F", "x": 0.3 } },
        "joints": {
            "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": {"value": 3.67e-10, "std": 1e-12} } },
            "K": { "from": "4", "to": "5", "stiffness": [[1e6, -1e3], [-1e3, 200.0]], "damping": [[1.0, 0.0], [0.0, 0.01]] } },
        "damping": { "modal_ratios": [0.002, {"value": 0.003, "std": 0.001}], "of": "free" },
        "supports": { "S": { "point": "1", "stiffness": 200.0, "damping": 0.5 }, "T": { "body": "B", "x": 0.1, "stiffness": 0, "rotational_stiffness": 10.0, "rotational_damping": 0.01 } },
        "physics": [
            { "kind": "added_mass", "place": "A", "x": -0.02, "mass": {"value": 0.1, "std": 0.01} },
            { "kind": "support", "place": "A", "dof": "rotation", "stiffness": 20.0 },
            { "kind": "support", "place": "A", "x": 0.0, "stiffness": 20.0, "damping": 0.1 },
            { "kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 1e4 },
            { "kind": "bypass", "place": "A/B", "x_from": -0.01, "x_to": 0.1, "stiffness": 1e3, "damping": 0.1 },
            { "kind": "channel_gain", "place": "response 4", "factor": 0.9 },
            { "kind": "exponential_window", "place": "all", "decay": 3.0 },
            { "kind": "quantity_error", "place": "bodies/A/x_cg", "value": -0.025 },
            { "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 1e9 } ],
        "channels": { "response 4": { "gain": {"value": 1, "std": 0.05}, "delay": {"value": 0, "std": 1e-6} }, "force": { "gain": 1.0 }, "*": { "gain": {"value": 1, "std": 0.1} } },
        "model_error": { "frequency": 0.003, "damping": 0.1, "residue": 0.05 }
    });
    let second = json!({
        "bodies": { "A": { "mass": 1.2, "inertia": 6e-4, "x_cg": -0.03 }, "B": { "mass": 1.9, "inertia": 1.6e-3, "x_cg": 0.105 } },
        "points": { "1": { "body": "A", "x": -0.055 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.065 } },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.1e-10 } } },
        "damping": { "rayleigh": { "mass": 0.1, "stiffness": 1e-6 } },
        "geometry": {
            "materials": { "steel": { "youngs_modulus": 2.07e11, "poisson_ratio": 0.3, "density": 7850 }, "glue": { "youngs_modulus": 3e9, "poisson_ratio": 0.35, "density": 1200 } },
            "bodies": { "A": { "from": -0.06, "to": 0.0, "height": 0.05, "depth": 0.05, "material": "steel" }, "B": { "from": 0.065, "to": 0.145, "height": 0.06, "depth": 0.05, "y": 0.001, "material": "steel" } },
            "joints": { "J": { "thickness": 0.005, "width": 0.03, "y": 0.0, "material": "steel", "interfaces": { "2": { "thickness": 0.0002, "material": "glue" } } } },
            "points": { "1": { "y": 0.01 } } }
    });
    let mut loss = second.clone();
    loss["damping"] = json!({ "loss_factor": 0.01 });
    let mut none = second.clone();
    none["damping"] = json!({});
    vec![first, second, loss, none]
}

#[test]
fn every_shipped_fixture_and_everything_that_can_be_stated_is_valid() {
    let validator = validator();
    let shipped = shipped();
    assert!(shipped.len() > 25, "{}", shipped.len());
    for (path, fixture) in shipped {
        assert!(Fixture::from_value(&fixture).is_ok(), "{}", path.display());
        if let Err(error) = validator.validate(&fixture) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
    }
    for fixture in everything() {
        Fixture::from_value(&fixture).unwrap();
        if let Err(error) = validator.validate(&fixture) {
            panic!("{error} at {}", error.instance_path());
        }
    }
}

#[test]
fn what_the_reader_refuses_by_its_shape_the_schema_refuses() {
    let validator = validator();
    let [all, ..] = &everything()[..] else { panic!() };
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut fixture = all.clone();
        change(&mut fixture);
        assert!(Fixture::from_value(&fixture).is_err(), "{fixture:#}");
        assert!(!validator.is_valid(&fixture), "{fixture:#}");
    };
    refused(&|f| f["physics"][0]["kind"] = json!("hidden_mass"));
    refused(&|f| _ = f["bodies"]["A"].as_object_mut().unwrap().remove("mass"));
    refused(&|f| f["bodies"]["A"]["mass"] = json!(0));
    refused(&|f| f["bodies"]["A"]["mass"] = json!({ "value": 1.0, "std": -0.1 }));
    refused(&|f| f["bodies"]["A"]["mass"] = json!({ "value": 1.0, "std": "vague" }));
    refused(&|f| f["bodies"]["A"]["mass"] = json!({ "value": 1.0 }));
    refused(&|f| f["bodies"]["B"]["mass"] = json!(1.0));
    refused(&|f| f["joints"]["J"]["stiffness"] = json!([[1, 0], [0, 1]]));
    refused(&|f| f["damping"] = json!({ "modal_ratios": [1.2] }));
    refused(&|f| f["damping"] = json!({ "loss_factor": 0.1, "rayleigh": { "mass": 1 } }));
    refused(&|f| f["physics"][0]["dof"] = json!("rotation"));
    refused(&|f| _ = f["physics"][3].as_object_mut().unwrap().remove("dof"));
    refused(&|f| _ = f["physics"][2].as_object_mut().unwrap().remove("x"));
    refused(&|f| f["supports"]["S"]["body"] = json!("A"));
    refused(&|f| f["model_error"]["frequency"] = json!(3.0));
    refused(&|f| f["channels"]["force"]["gains"] = json!(1));
    refused(&|f| f["damping"] = Value::Null);
    refused(&|f| f["bodies"] = json!({}));
}

/// Pointers to every value within `value`.
fn pointers(value: &Value, at: &str, all: &mut Vec<String>) {
    let mut each = |key: &str, child: &Value| {
        let at = format!("{at}/{}", key.replace('~', "~0").replace('/', "~1"));
        all.push(at.clone());
        pointers(child, &at, all);
    };
    match value {
        Value::Object(entries) => entries.iter().for_each(|(key, child)| each(key, child)),
        Value::Array(items) => items.iter().enumerate().for_each(|(i, child)| each(&i.to_string(), child)),
        _ => {}
    }
}

#[test]
fn whatever_key_is_taken_out_or_put_in_schema_and_reader_agree() {
    let validator = validator();
    let mut tried = 0;
    for fixture in everything() {
        let mut all = vec![String::new()];
        pointers(&fixture, "", &mut all);
        for pointer in &all {
            let mut changed = Vec::new();
            if let Some((parent, key)) = pointer.rsplit_once('/') {
                let mut without = fixture.clone();
                if let Value::Object(entries) = without.pointer_mut(parent).unwrap() {
                    entries.remove(&key.replace("~1", "/").replace("~0", "~"));
                    changed.push(without);
                }
            }
            let with = |value: Value| {
                let mut with = fixture.clone();
                *with.pointer_mut(pointer).unwrap() = value;
                with
            };
            match fixture.pointer(pointer).unwrap() {
                Value::Object(entries) => {
                    let mut more = entries.clone();
                    more.insert("no_such_key".into(), json!(1));
                    changed.push(with(Value::Object(more)));
                }
                Value::Number(_) => changed.extend([json!(-1), json!("1"), Value::Null].map(with)),
                Value::String(_) => changed.extend([json!(1), Value::Null].map(with)),
                _ => changed.push(with(json!(1))),
            }
            for changed in changed {
                tried += 1;
                let valid = validator.is_valid(&changed);
                match Fixture::from_value(&changed) {
                    Ok(_) => {
                        assert!(valid, "the reader takes it, the schema does not, at {pointer}: {changed:#}")
                    }
                    Err(error) => {
                        let said = error.to_string();
                        // What ties entries together, or a matrix, no schema can say.
                        let by_shape = ["the key `", "stands where", "it must be above zero"];
                        let of_matrix = pointer.contains("/stiffness/") || pointer == "/geometry/joints";
                        let shape = by_shape.iter().any(|part| said.contains(part)) && !of_matrix;
                        assert!(!(valid && shape), "the schema takes it at {pointer}: {said}");
                    }
                }
            }
        }
    }
    assert!(tried > 800, "{tried}");
}

#[test]
fn every_property_is_described_where_an_editor_shows_it() {
    fn described(schema: &Value, at: &str) {
        if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
            for (key, property) in properties {
                let is_plain =
                    property.get("const").is_some() || matches!(key.as_str(), "value" | "beam" | "rayleigh");
                assert!(is_plain || property.get("description").is_some(), "{at}/{key}: {property}");
            }
        }
    }
    let schema = jointscope_schema::fixture_schema();
    described(&schema, "");
    for (name, definition) in schema["$defs"].as_object().unwrap() {
        described(definition, name);
        for kind in definition.get("oneOf").and_then(Value::as_array).into_iter().flatten() {
            described(kind, kind["title"].as_str().unwrap_or_default());
        }
    }
}
