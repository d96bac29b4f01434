//! Many cases: what one bad case does to the others, what is done again, shares, threads.

use crate::common::{Bench, TWO_BLOCKS};
use std::fs;
use std::process::Command;

const LINES: &str = "50:1000:10";

/// Cases `a`, `b` and `c/deep` of two blocks; what `b` recorded is broken.
fn folder(name: &str) -> Bench {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    for case in ["all/a", "all/b", "all/c/deep", "all/no-case"] {
        fs::create_dir_all(bench.0.join(case)).unwrap();
        bench.write(&format!("{case}/two.json"), TWO_BLOCKS);
        if case != "all/no-case" {
            fs::copy(bench.0.join("frf.uff"), bench.0.join(case).join("test.uff")).unwrap();
        }
    }
    bench.write("all/b/test.uff", "no universal file");
    bench
}

/// The program with status 1; standard output and standard error.
#[track_caller]
fn in_part(bench: &Bench, arguments: &[&str]) -> (String, String) {
    let output = bench.run(arguments);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{told}");
    (String::from_utf8(output.stdout).unwrap(), told)
}

const DECOMPOSE: [&str; 4] = ["decompose", "all", "-o", "out"];

#[test]
fn a_case_that_fails_has_its_sentence_in_the_table_and_does_not_stop_the_others() {
    let bench = folder("many-fails");
    let (said, _) = in_part(&bench, &DECOMPOSE);
    assert!(said.starts_with("3 cases: ") && said.contains("1 refused"), "{said}");
    let table = bench.text("out/summary.csv");
    let rows: Vec<&str> = table.lines().map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(rows, ["case", "a", "b", "c/deep"]);
    let why = bench.json("out/b/refused.json")["refused"].as_str().unwrap().to_owned();
    assert!(
        why.starts_with("all/b/test.uff: ") && table.contains(&why.replace('"', "\"\"")),
        "{why}\n{table}"
    );
    assert!(bench.0.join("out/c/deep/report.html").is_file() && !bench.0.join("out/b/report.html").exists());
    let page = bench.text("out/summary.html");
    assert!(page.contains("href=\"./c/deep/report.html\"") && !page.contains("href=\"./b/report.html\""));
    // One case is the answer that its own command line gives.
    let line = bench.json("out/a/stiffness.json")["made"]["command"].as_str().unwrap().to_owned();
    assert_eq!(line, "jointscope decompose all/a/two.json all/a/test.uff -o out/a");
    let many = bench.text("out/a/stiffness.json");
    fs::remove_dir_all(bench.0.join("out/a")).unwrap();
    bench.done(&line.split(' ').skip(1).collect::<Vec<_>>());
    assert_eq!(bench.text("out/a/stiffness.json"), many);
}

#[test]
fn a_case_of_several_joints_says_that_a_row_holds_one_and_is_taken_with_its_name() {
    const CHAIN: &str = r#"{ "bodies": { "A": {"mass": 1.0, "rotates": false}, "B": {"mass": 1.2, "rotates": false}, "C": {"mass": 0.8, "rotates": false} },
      "points": { "1": {"body": "A", "x": 0}, "2": {"body": "B", "x": 0.1}, "3": {"body": "B", "x": 0.2}, "4": {"body": "C", "x": 0.3} },
      "joints": { "J1": {"from": "1", "to": "2", "stiffness": [[1e6, 0], [0, 0]], "damping": [[20, 0], [0, 0]]},
                  "J2": {"from": "3", "to": "4", "stiffness": [[2e6, 0], [0, 0]], "damping": [[20, 0], [0, 0]]} } }"#;
    let bench = Bench::new("many-several");
    fs::create_dir_all(bench.0.join("all/chain")).unwrap();
    bench.write("all/chain/chain.json", CHAIN);
    let frfs = ["1/1", "2/1", "4/1", "4/4"];
    let synthesize =
        ["synthesize", "all/chain/chain.json", "--lines", LINES, "-o", "all/chain/f.uff", "--frf"];
    bench.done(&[&synthesize[..], &frfs].concat());
    in_part(&bench, &DECOMPOSE);
    let why = bench.json("out/chain/refused.json")["refused"].as_str().unwrap().to_owned();
    assert!(why.contains("has 2 joints") && why.contains("--joint"), "{why}");
    bench.done(&[&DECOMPOSE[..], &["--joint", "J2"]].concat());
    assert!(bench.text("out/summary.csv").contains("chain,done,J2,"), "{}", bench.text("out/summary.csv"));
}

#[test]
fn what_is_done_is_left_out_until_a_file_or_an_option_changes() {
    let bench = folder("many-again");
    in_part(&bench, &DECOMPOSE);
    let (again, told) = in_part(&bench, &DECOMPOSE);
    assert!(
        told.contains("note: 2 cases had their answers already")
            && told.lines().filter(|line| line.starts_with('[')).count() == 1,
        "{told}"
    );
    assert!(again.contains("1 refused"));
    bench.write("all/b/test.uff", fs::read(bench.0.join("frf.uff")).unwrap());
    let repaired = bench.done(&DECOMPOSE);
    assert!(!repaired.contains("refused") && !bench.0.join("out/b/refused.json").exists(), "{repaired}");
    bench.write("all/a/two.json", TWO_BLOCKS.replacen("0.006", "0.007", 1));
    assert!(bench.done(&DECOMPOSE).starts_with("note: 2 cases had their answers already"));
    let other = bench.done(&["decompose", "all", "--band", "100:900", "-o", "out"]);
    assert!(!other.contains("already"), "{other}");
}

#[test]
fn the_answers_are_the_same_bytes_for_any_number_of_threads_and_shares() {
    let bench = folder("many-threads");
    let run = |threads: &str, more: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_jointscope"));
        program.args(DECOMPOSE).args(more).current_dir(&bench.0).env("RAYON_NUM_THREADS", threads);
        let output = program.output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let files = || {
        [
            "out/a/stiffness.json",
            "out/a/report.html",
            "out/c/deep/stiffness.json",
            "out/b/refused.json",
            "out/summary.csv",
        ]
        .map(|file| fs::read(bench.0.join(file)).unwrap())
    };
    run("1", &[]);
    let one = files();
    fs::remove_dir_all(bench.0.join("out")).unwrap();
    run("3", &["--jobs", "3"]);
    assert!(files() == one);
    fs::remove_dir_all(bench.0.join("out")).unwrap();
    run("2", &["--shard", "2/2"]);
    assert!(!bench.0.join("out/summary.csv").exists() && !bench.0.join("out/a").exists());
    let (said, _) = in_part(&bench, &["summary", "out"]);
    assert!(said.contains("2 not done"), "{said}");
    run("2", &["--shard", "1/2"]);
    in_part(&bench, &["summary", "out"]);
    assert!(files() == one);
}

#[test]
fn what_is_no_folder_or_list_of_cases_is_refused_with_what_to_do() {
    let bench = folder("many-refused");
    bench.refused(
        &["diagnose", "two.json", "-o", "out"],
        &["two.json: no recordings were given", "a folder of cases or a list"],
    );
    bench.refused(
        &["diagnose", "all/no-case", "-o", "out"],
        &["all/no-case: there is no case in it", "one fixture (.json)"],
    );
    bench.refused(&["diagnose", "all", "--json"], &["-o DIR", "summary DIR --json"]);
    bench.refused(
        &["diagnose", "two.json", "frf.uff", "--shard", "1/2", "-o", "out"],
        &["--shard", "a folder of cases"],
    );
    bench.refused(&["diagnose", "all", "--shard", "3/2", "-o", "out"], &["3/2", "such as 2/8"]);
    bench.write("list.txt", "all/a/two.json\n");
    bench.refused(&["diagnose", "list.txt", "-o", "out"], &["list.txt: line 1", "no recording"]);
    bench.refused(&["summary", "all"], &["all: holds no cases.json"]);
    in_part(&bench, &DECOMPOSE);
    bench.refused(
        &["diagnose", "all", "-o", "out"],
        &["out: holds cases of `decompose`", "choose another `-o`"],
    );
}
