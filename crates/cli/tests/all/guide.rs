//! The guides to a structure of one's own, to many tests and to comparisons, typed along: their commands in
//! their order, their excerpts put into the files that they name.

use crate::common::Bench;
use serde_json::Value;

/// A guide's code blocks: what stands behind the fence, and the text.
fn blocks(guide: &str) -> Vec<(String, String)> {
    let page = format!("{}/../../docs/guide/{guide}", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(page).unwrap();
    let mut all = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(kind) = line.strip_prefix("```") {
            let text: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            all.push((kind.to_owned(), text.join("\n")));
        }
    }
    all
}

/// Puts the keys of an excerpt into a fixture; a file that is not there yet is a copy of `fixture.json`.
fn edit(bench: &Bench, file: &str, excerpt: &str) {
    let from = if bench.0.join(file).exists() { file } else { "fixture.json" };
    let mut fixture = bench.json(from);
    let keys: Value = serde_json::from_str(&format!("{{{excerpt}}}")).unwrap();
    for (key, value) in keys.as_object().unwrap() {
        fixture[key] = value.clone();
    }
    bench.write(file, fixture.to_string());
}

#[test]
fn the_first_own_structure_goes_from_ruler_to_finding_as_the_guide_says() {
    let bench = Bench::new("guide");
    let mut said: Vec<(String, String)> = Vec::new();
    for (kind, text) in blocks("own-structure.md") {
        if let Some(file) = kind.strip_prefix("json excerpt ") {
            edit(&bench, file, &text);
            continue;
        }
        assert_eq!(kind, "sh", "{text}");
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(words[0], "jointscope", "{line}");
            said.push((line.to_owned(), bench.done(&words[1..])));
        }
    }
    let of = |start: &str| {
        let mut all = said.iter().filter(|(line, _)| line.starts_with(start));
        all.next().unwrap_or_else(|| panic!("{start} is not in the guide")).1.as_str()
    };
    assert!(of("jointscope check fixture.json -o").starts_with("Nothing odd in the fixture."));
    assert!(
        of("jointscope check fixture.json test.uff").starts_with("Nothing odd in fixture and recording.")
    );
    let finding = &bench.json("out/diagnosis.json")["findings"][0];
    assert_eq!((&finding["kind"], &finding["place"]), (&"added_mass".into(), &"B".into()));
    let mass = finding["parameters"]["mass"]["value"].as_f64().unwrap();
    let x = finding["parameters"]["x"]["value"].as_f64().unwrap();
    assert!((mass - 0.06).abs() < 0.003 && (x - 0.135).abs() < 0.001, "{finding}");
    assert!(finding["probability"].as_f64().unwrap() > 0.9, "{finding}");
    let before = bench.json("checked/check.json")["recording"]["nrmse"].as_f64().unwrap();
    let after = bench.json("repaired/check.json")["recording"]["nrmse"].as_f64().unwrap();
    assert!(before > 0.1 && after < 0.02, "{before} {after}");
}

#[test]
fn many_tests_go_from_folders_to_one_table_as_the_guide_says() {
    let bench = Bench::new("guide-many");
    let mut said: Vec<(String, String)> = Vec::new();
    for (kind, text) in blocks("many.md") {
        if let Some(file) = kind.strip_prefix("json excerpt ") {
            edit(&bench, file, &text);
            continue;
        }
        if let Some(file) = kind.strip_prefix("text file ") {
            bench.write(file, text);
            continue;
        }
        assert_eq!(kind, "sh", "{text}");
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            said.push((line.to_owned(), bench.done(&words[1..])));
        }
    }
    let of = |line: &str| -> Vec<&str> {
        said.iter().filter(|(own, _)| own == line).map(|(_, said)| said.as_str()).collect()
    };
    let twice = of("jointscope diagnose specimens -o diagnosed");
    assert!(twice[0].contains("3 cases: 2 consistent, 1 explained"), "{}", twice[0]);
    assert_eq!(twice[1].strip_prefix("note: 3 cases had their answers already\n"), Some(twice[0]));
    let table = bench.text("diagnosed/summary.csv");
    let heavier = table.lines().find(|line| line.starts_with("b,")).unwrap();
    assert!(heavier.starts_with("b,done,explained,1,added_mass,B,"), "{heavier}");
    // Joined shares are what one run gives, but for the paths in the files.
    assert_eq!(bench.text("shares/summary.csv"), table);
    assert!(
        of("jointscope diagnose specimens --shard 1/2 -o shares")[0].starts_with("share 1 of 2: 2 cases")
    );
    let decomposed = bench.text("decomposed/summary.csv");
    assert!(
        ["a-test,done,J", "b-test,done,J", "c-test,done,J"].iter().all(|row| decomposed.contains(row)),
        "{decomposed}"
    );
}

/// Whether a line is the one in a guide, numbers within 2 % of each other: they are the last digits of what
/// noise leaves.
fn is_line_of_guide(guide: &str, line: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.split_whitespace().map(|word| word.trim_matches(['(', ')', ',', ';']).to_owned()).collect()
    };
    let same = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.02 * b.abs(),
        _ => a == b,
    };
    let (a, b) = (words(guide), words(line));
    a.len() == b.len() && a.iter().zip(&b).all(same)
}

#[test]
fn model_test_and_finite_elements_are_overlaid_as_the_guide_says() {
    let bench = Bench::new("guide-compare");
    bench.write("fixture.json", include_str!("../../../../fixtures/paper/D0.json"));
    let (mut said, mut held) = (String::new(), 0);
    for (kind, text) in blocks("compare.md") {
        if let Some(file) = kind.strip_prefix("json excerpt ") {
            edit(&bench, file, &text);
            continue;
        }
        if kind == "text" {
            for line in text.lines() {
                assert!(said.lines().any(|own| is_line_of_guide(line, own)), "{line}\n{said}");
                held += 1;
            }
            continue;
        }
        assert_eq!(kind, "sh", "{text}");
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(words[0], "jointscope", "{line}");
            said = bench.done(&words[1..]);
        }
    }
    assert_eq!(held, 5);
    let file = bench.json("out/comparison.json");
    // The weld's strip is 2.5/2.864708 of the model's.
    let ratio = &file["models"]["ratios"][0]["numbers"][0]["ratio"];
    let [low, high] = [0, 1].map(|end| ratio["ci95"][end].as_f64().unwrap());
    let truth = 2.864708 / 2.5;
    assert!(low < truth && truth < high, "{ratio}");
}
