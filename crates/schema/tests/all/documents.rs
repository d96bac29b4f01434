//! The examples of the documentation: read by the reader, valid by the schema.

use crate::{files, validator};
use jointscope_fixture::Fixture;
use serde_json::{Map, Value};
use std::path::Path;

/// What a code block of JSON is.
#[derive(Debug, PartialEq)]
enum Block {
    /// By itself.
    Whole(String),
    /// Keys that go into the page's first whole fixture.
    Fragment(String),
}

/// What is marked `json excerpt` leaves something out and is not read.
fn blocks(page: &str) -> Vec<Block> {
    let mut all = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        let fence = line.trim();
        if fence == "```json" || fence == "```json fragment" {
            let text: Vec<&str> = lines.by_ref().take_while(|line| line.trim() != "```").collect();
            let text = text.join("\n");
            all.push(if fence == "```json" { Block::Whole(text) } else { Block::Fragment(text) });
        }
    }
    all
}

fn object(text: &str, place: &str) -> Map<String, Value> {
    match serde_json::from_str(text) {
        Ok(Value::Object(object)) => object,
        other => panic!("{place}: {other:?} of {text}"),
    }
}

#[test]
fn every_example_of_a_fixture_in_the_documentation_reads_and_is_valid() {
    let validator = validator();
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let mut pages = Vec::new();
    files(&docs, ".md", &mut pages);
    pages.sort();
    let (mut read, mut fragments) = (0, 0);
    for page in pages {
        let place = page.display().to_string();
        let mut first: Option<Map<String, Value>> = None;
        for block in blocks(&std::fs::read_to_string(&page).unwrap()) {
            let fixture = match block {
                Block::Whole(text) => {
                    let whole = object(&text, &place);
                    // Other files than fixtures are shown as well, on other pages.
                    if !whole.contains_key("bodies") {
                        assert!(
                            !place.ends_with("fixture-file.md"),
                            "{place}: neither a fixture nor a fragment: {text}"
                        );
                        continue;
                    }
                    first.get_or_insert_with(|| whole.clone());
                    whole
                }
                Block::Fragment(text) => {
                    fragments += 1;
                    let mut fixture =
                        first.clone().unwrap_or_else(|| panic!("{place}: a fragment before any fixture"));
                    fixture.extend(object(&format!("{{{text}}}"), &place));
                    fixture
                }
            };
            read += 1;
            let fixture = Value::Object(fixture);
            if let Err(error) = Fixture::from_value(&fixture) {
                panic!("{place}: {error}: {fixture:#}");
            }
            if let Err(error) = validator.validate(&fixture) {
                panic!("{place}: {error} at {}: {fixture:#}", error.instance_path());
            }
        }
    }
    assert!(read >= 11 && fragments >= 7, "{read} examples, {fragments} of them fragments");
}

#[test]
fn the_reference_names_every_effect_with_all_its_parameters_and_every_key() {
    let page = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/fixture-file.md"),
    );
    let page = page.unwrap();
    for kind in jointscope_fixture::EffectKind::ALL {
        let row = page.lines().find(|line| line.starts_with(&format!("| `{}` |", kind.name())));
        let row = row.unwrap_or_else(|| panic!("`{}` is missing", kind.name()));
        for parameter in kind.spec().parameters {
            assert!(row.contains(&format!("`{}`", parameter.name)), "`{}` of {row}", parameter.name);
        }
    }
    let schema = jointscope_schema::fixture_schema();
    let mut keys: Vec<&String> = schema["properties"].as_object().unwrap().keys().collect();
    for (name, definition) in schema["$defs"].as_object().unwrap() {
        if !["Geometry", "Material", "BodySolid", "JointSolid", "Layer", "PointHeight"]
            .contains(&name.as_str())
        {
            keys.extend(
                definition.get("properties").and_then(Value::as_object).into_iter().flat_map(Map::keys),
            );
        }
    }
    for key in keys {
        assert!(
            page.contains(&format!("`{key}`")) || page.contains(&format!("\"{key}\"")),
            "`{key}` is missing"
        );
    }
}
