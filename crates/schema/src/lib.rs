//! The JSON Schema of fixture files.
//!
//! [`fixture_schema`] describes what [`Fixture::from_json`](jointscope_fixture::Fixture::from_json) takes:
//! keys, units, default deviations, ranges. Editors complete and check with it. What ties one entry to
//! another (names that must exist, a joint's points in order, a beam's points between its ends) no schema can
//! say: the reader does.
//!
//! The reader is written by hand for the sake of its messages, so the types here (`file`) are a description
//! and not what reads. Tests hold the two together: whatever key is taken out of a fixture or put into it,
//! schema and reader agree on whether it may be. Effects (`effects`) are read off the table that the reader
//! uses itself.
//!
//! ```
//! let schema = jointscope_schema::fixture_schema();
//! assert_eq!(schema["required"], serde_json::json!(["bodies", "points"]));
//! assert!(schema["$defs"]["Effect"]["oneOf"].as_array().is_some_and(|kinds| kinds.len() > 20));
//! ```

mod effects;
mod file;
mod quantity;

use serde_json::Value;

/// The schema, JSON Schema 2020-12.
pub fn fixture_schema() -> Value {
    let generator = schemars::generate::SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<file::FixtureFile>().to_value();
    without_null(&mut schema);
    schema["title"] = "jointscope fixture".into();
    schema
}

/// What may be left out may not be `null`: the reader wants it left out.
fn without_null(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(without_null),
        Value::Object(entries) => {
            if let Some(Value::Array(types)) = entries.get_mut("type") {
                types.retain(|name| name != "null");
                if let [one] = types.as_slice() {
                    let one = one.clone();
                    entries.insert("type".into(), one);
                }
            }
            if let Some(Value::Array(ways)) = entries.get_mut("anyOf") {
                ways.retain(|way| way != &serde_json::json!({ "type": "null" }));
                if let [Value::Object(one)] = ways.as_slice() {
                    let one = one.clone();
                    entries.remove("anyOf");
                    one.into_iter().for_each(|(key, value)| {
                        entries.entry(key).or_insert(value);
                    });
                }
            }
            // Shown by editors as a value, of which there is none.
            if entries.get("default").is_some_and(Value::is_null) {
                entries.remove("default");
            }
            entries.values_mut().for_each(without_null);
        }
        _ => {}
    }
}
