//! `jointscope prove` as a user meets it.
#![allow(clippy::unwrap_used)]

mod common;

use common::Bench;

#[test]
fn one_case_is_made_diagnosed_and_told_the_same_each_time() {
    let bench = Bench::new("prove");
    // Case 1 hides nothing: the quickest to diagnose.
    let arguments = ["prove", "--cases", "8", "--seed", "3", "--only", "1", "--family", "two-blocks"];
    let run = |threads: &str| {
        let output = bench.run(&[&arguments[..], &["--threads", threads, "-o", "proof"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (table, progress) = run("1");
    assert!(
        table.contains("case 1 of 8, seed 3, two-blocks") && table.contains("hidden: nothing"),
        "{table}"
    );
    assert!(progress.contains("seconds a case"), "{progress}");
    assert!(!table.contains("seconds"), "times differ from run to run: {table}");
    let seal = progress.split_whitespace().find(|word| word.len() == 64).unwrap();
    assert!(table.contains(seal), "{table}");
    for file in ["seal.json", "answers.json", "proof.json", "timing.json"] {
        assert!(bench.0.join("proof").join(file).is_file(), "{file}");
    }
    let first = std::fs::read(bench.0.join("proof/proof.json")).unwrap();
    assert_eq!(run("2").0, table);
    assert_eq!(std::fs::read(bench.0.join("proof/proof.json")).unwrap(), first);
}

#[test]
fn a_case_that_is_not_there_is_refused_in_a_sentence() {
    let bench = Bench::new("prove-refused");
    for (arguments, part) in [
        (["prove", "--only", "40"], "0 to 39"),
        (["prove", "--cases", "0"], "at least one case"),
        (["prove", "--family", "bridges"], "bridges"),
    ] {
        bench.refused(&arguments, &[part]);
    }
}
