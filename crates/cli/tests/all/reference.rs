//! The reference of result files: its commands run, its examples beside what they write, every key that is
//! written described and every one described written.

use crate::common::Bench;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/result-files.md");
const FIXTURES: [&str; 3] = ["two-blocks", "glued-joint", "look-alikes"];

/// Relative difference of a number in the text, which is rounded, from the one in the file.
const ROUNDED: f64 = 0.02;

/// A part of the page below a heading of its own.
struct Part {
    heading: String,
    text: String,
}

fn parts() -> Vec<Part> {
    let page = std::fs::read_to_string(DOCS).unwrap();
    let of = |part: &str| {
        let (heading, text) = part.split_once('\n').unwrap();
        Part { heading: heading.to_owned(), text: text.to_owned() }
    };
    page.split("\n## ").skip(1).map(of).collect()
}

impl Part {
    /// Its blocks of code: what stands behind the fence, and the lines.
    fn blocks(&self) -> Vec<(&str, Vec<&str>)> {
        let mut all = Vec::new();
        let mut lines = self.text.lines();
        while let Some(line) = lines.next() {
            if let Some(kind) = line.strip_prefix("```") {
                all.push((kind, lines.by_ref().take_while(|line| *line != "```").collect()));
            }
        }
        all
    }

    /// Whatever it has between backticks.
    fn words(&self) -> BTreeSet<&str> {
        self.text.split('`').skip(1).step_by(2).collect()
    }

    /// Keys of its tables that are there whatever was recorded: a row that says where, or with which option,
    /// promises less.
    fn promised(&self) -> impl Iterator<Item = &str> {
        let rows = self.text.lines().filter_map(|line| line.strip_prefix("| `"));
        let always = rows.filter(|row| !row.contains(" where ") && !row.contains("with `--"));
        always.flat_map(|row| row.split(" | ").next().unwrap().split('`').step_by(2))
    }
}

/// A folder with the shipped fixtures in which the page's commands were run.
fn bench() -> Bench {
    let bench = Bench::new("reference");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    for name in FIXTURES {
        std::fs::create_dir_all(bench.0.join("fixtures").join(name)).unwrap();
        for entry in std::fs::read_dir(shipped.join(name)).unwrap() {
            let file = entry.unwrap().path();
            let copy = bench.0.join("fixtures").join(name).join(file.file_name().unwrap());
            std::fs::copy(&file, copy).unwrap();
        }
    }
    for part in parts() {
        for (_, lines) in part.blocks().into_iter().filter(|(kind, _)| *kind == "sh") {
            for line in lines {
                let words: Vec<&str> = line.split_whitespace().collect();
                assert_eq!(words[0], "jointscope", "{line}");
                bench.done(&words[1..]);
            }
        }
    }
    bench
}

/// Holds an example to what was written: all of its keys, the first items of its lists, its numbers as
/// rounded.
fn check(example: &Value, written: &Value, place: &str) {
    match (example, written) {
        (Value::Object(example), Value::Object(_)) => {
            example.iter().for_each(|(key, value)| check(value, &written[key], &format!("{place}/{key}")));
        }
        (Value::Array(example), Value::Array(all)) => {
            assert!(example.len() <= all.len(), "{place}: {example:?} of {all:?}");
            example.iter().zip(all).enumerate().for_each(|(i, (a, b))| check(a, b, &format!("{place}/{i}")));
        }
        (Value::Number(example), Value::Number(number)) => {
            let (a, b) = (example.as_f64().unwrap(), number.as_f64().unwrap());
            assert!((a - b).abs() <= ROUNDED * b.abs(), "{place}: {a} on the page, {b} in the file");
        }
        _ => assert_eq!(example, written, "{place}"),
    }
}

#[test]
fn every_key_of_a_result_file_is_described_and_every_example_is_what_its_command_writes() {
    let bench = bench();
    let mut examples = 0;
    for part in parts() {
        let blocks = part.blocks();
        let answers =
            blocks.iter().filter_map(|(kind, lines)| Some((kind.strip_prefix("json answer ")?, lines)));
        for (file, lines) in answers {
            examples += 1;
            let written = bench.json(file);
            let example = serde_json::from_str(&lines.join("\n")).unwrap_or_else(|e| panic!("{file}: {e}"));
            check(&example, &written, file);
            assert!(file.ends_with(&part.heading), "{file} stands below {}", part.heading);
            let mut keys: BTreeSet<String> = written.as_object().unwrap().keys().cloned().collect();
            let described = part.words();
            let undescribed: Vec<&String> =
                keys.iter().filter(|key| !["notes", "made"].contains(&key.as_str())).collect();
            let undescribed: Vec<_> =
                undescribed.into_iter().filter(|key| !described.contains(key.as_str())).collect();
            assert!(undescribed.is_empty(), "{}: not described: {undescribed:?}", part.heading);
            // The one joint has a table of its own.
            keys.extend(written["joint"].as_object().into_iter().flat_map(|joint| joint.keys().cloned()));
            let missing: Vec<&str> = part.promised().filter(|key| !keys.contains(*key)).collect();
            assert!(missing.is_empty(), "{}: described and not written: {missing:?}", part.heading);
        }
    }
    assert!(examples >= 6, "{examples}");
}
