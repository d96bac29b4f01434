//! `plan`: the guide typed along, and what has no plan.

use std::fs;

use crate::common::{Bench, shipped};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/plan.md");

/// The shipped look-alikes.
fn look_alikes(name: &str) -> Bench {
    let bench = Bench::new(name);
    for file in ["fixture.json", "first-test.uff", "second-test.uff"] {
        fs::copy(shipped().with_file_name("look-alikes").join(file), bench.0.join(file)).unwrap();
    }
    bench
}

#[test]
fn the_first_suggestion_of_the_guide_settles_the_name_as_the_guide_says() {
    let bench = look_alikes("plan-guide");
    let page = fs::read_to_string(PAGE).unwrap();
    let mut said = Vec::new();
    for block in page.split("```sh\n").skip(1) {
        for line in block.split("```").next().unwrap().lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(words[0], "jointscope", "{line}");
            said.push(bench.done(&words[1..]));
        }
    }
    let before = &bench.json("out/diagnosis.json")["findings"][0];
    assert!(before["probability"].as_f64().unwrap() < 0.9, "{before}");
    let plan = bench.json("next/plan.json");
    let first = &plan["suggestions"][0];
    assert_eq!(first["measure"], "frf 3/3", "{first}");
    assert!(first["promise"].as_f64().unwrap() >= 0.9, "{first}");
    let after = &bench.json("settled/diagnosis.json")["findings"][0];
    assert!(after["probability"].as_f64().unwrap() >= 0.9, "{after}");
    assert_eq!(after["place"], "3");
    // What the page shows of the terminal is what the terminal shows.
    let shown = page.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    for line in shown.lines() {
        assert!(said[1].contains(line), "{line}\n is not in\n{}", said[1]);
    }
    let interval = &bench.json("narrower/plan.json")["suggestions"][0]["interval"];
    assert!(interval["then"].as_f64().unwrap() < interval["now"].as_f64().unwrap(), "{interval}");
    assert!(bench.json("beforehand/plan.json")["suggestions"][0]["interval"]["now"].is_null());
    for page in ["next", "narrower", "beforehand"] {
        let html = bench.text(&format!("{page}/plan.html"));
        assert!(html.contains("What to measure next") && html.contains("<svg"), "{page}");
    }
}

#[test]
fn two_tests_together_write_the_names_they_leave_and_a_page() {
    let bench = look_alikes("plan-two-tests");
    let tests =
        ["plan", "fixture.json", "first-test.uff", "--second-test", "fixture.json", "second-test.uff"];
    let said = bench.done(&[&tests[..], &["-o", "both"]].concat());
    let file = bench.json("both/plan.json");
    assert!(said.starts_with(file["says"].as_str().unwrap()), "{said}");
    let names = file["names"].as_array().unwrap();
    assert!(names.len() > 1 && names[0]["probability"].as_f64().unwrap() >= 0.9, "{file}");
    assert!(names[0]["before"].as_f64().unwrap() < 0.9 && names[0]["place"] == "3", "{file}");
    assert!(file["made"]["inputs"].as_array().unwrap().len() >= 3, "{file}");
    let html = bench.text("both/plan.html");
    assert!(html.contains("Plan: two tests together"), "no title");
    assert!(html.contains("First alone") && html.contains("<svg"), "no table or view");
}

#[test]
fn a_diagnosis_is_made_again_from_any_directory() {
    let bench = look_alikes("plan-from-elsewhere");
    bench.done(&["diagnose", "fixture.json", "first-test.uff", "-o", "./results/first"]);
    fs::create_dir(bench.0.join("elsewhere")).unwrap();
    // Another test's files, of the same names.
    for file in ["fixture.json", "first-test.uff"] {
        fs::write(bench.0.join("elsewhere").join(file), "of another test").unwrap();
    }
    let planned = |directory: &str, arguments: [&str; 3]| {
        let program = env!("CARGO_BIN_EXE_jointscope");
        let directory = bench.0.join(directory);
        let output =
            std::process::Command::new(program).args(arguments).current_dir(directory).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let from_there = planned(".", ["plan", "fixture.json", "results/first"]);
    assert_eq!(planned("elsewhere", ["plan", "../fixture.json", "../results/first"]), from_there);
    assert_eq!(planned("results", ["plan", "../fixture.json", "first/diagnosis.json"]), from_there);
}

#[test]
fn what_cannot_be_planned_is_refused_in_a_sentence() {
    let bench = look_alikes("plan-refused");
    bench.refused(&["plan", "fixture.json"], &["nothing was recorded", "--interval"]);
    bench.refused(&["plan", "fixture.json", "gone"], &["gone", "no such file"]);
    bench.write("some.json", "{}");
    bench.refused(
        &["plan", "fixture.json", "--diagnosis", "some.json"],
        &["some.json", "is no diagnosis.json"],
    );
    bench.write("broken.json", "{");
    bench.refused(&["plan", "fixture.json", "broken.json"], &["broken.json"]);
    let interval = |wanted: &str, parts: &[&str]| {
        bench.refused(&["plan", "fixture.json", "first-test.uff", "--interval", wanted], parts);
    };
    interval("J/k33=1%", &["k33", "k11, k12, k22"]);
    interval("J/k11=0", &["such as J/k11=1%"]);
    interval("X/k11=1%", &["fixture.json: the fixture has no joint `X` (it has J)"]);
    interval("J/c11=1%", &["states no dashpots"]);
    bench.refused(&["plan", "fixture.json", "--interval", "J/k11=1%"], &["--lines 2.5:1000:2.5"]);
    let points = ["plan", "fixture.json", "first-test.uff", "--interval", "J/k11=1%", "--points", "9"];
    bench.refused(&points, &["the fixture has no point `9` (it has 1, 2, 3, 4)"]);
}

#[test]
fn a_name_that_is_sure_and_a_recording_that_has_changed_leave_nothing_to_plan() {
    let bench = look_alikes("plan-sure");
    let last = |arguments: &[&str]| {
        let output = bench.run(arguments);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap().lines().last().unwrap_or_default().to_owned()
    };
    let sure = last(&["plan", "fixture.json", "first-test.uff", "second-test.uff"]);
    assert!(sure.contains("no other name is left") && sure.contains("--interval"), "{sure}");
    bench.done(&["diagnose", "fixture.json", "first-test.uff", "-o", "out"]);
    fs::copy(bench.0.join("second-test.uff"), bench.0.join("first-test.uff")).unwrap();
    bench.refused(&["plan", "fixture.json", "out"], &["first-test.uff: has changed since", "diagnose anew"]);
}

#[test]
fn promises_of_a_few_look_alikes_are_counted() {
    let bench = Bench::new("plan-prove");
    let counted = bench.json_of(&["prove", "--plan", "1", "--seed", "1", "--threads", "2", "--json"]);
    let cases = counted["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 1);
    assert!(cases[0]["before"].as_array().unwrap().len() > 1, "{counted}");
    let promise = cases[0]["promise"].as_f64().unwrap();
    assert!((0.0..=1.0).contains(&promise));
}
