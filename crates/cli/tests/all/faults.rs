//! What goes wrong around a run: pipes, files that change under it.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use sha2::{Digest, Sha256};

use crate::common::{Bench, TWO_BLOCKS};

const LINES: &str = "50:1000:5";

/// SHA-256 of a file's bytes as answers state it.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The hashes that an answer states, in the order of its inputs.
fn hashes(answer: &serde_json::Value) -> Vec<String> {
    let inputs = answer["made"]["inputs"].as_array().unwrap();
    inputs.iter().map(|input| input["sha256"].as_str().unwrap().to_owned()).collect()
}

/// The program, started by a shell as a user would.
fn shell(bench: &Bench, script: &str) -> std::process::Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", script]).env("PROGRAM", env!("CARGO_BIN_EXE_jointscope")).current_dir(&bench.0);
    shell.output().unwrap()
}

#[test]
fn a_pipe_is_read_once_and_its_hash_is_that_of_what_came_through() {
    let bench = Bench::synthesized("pipe", TWO_BLOCKS, LINES);
    let expected =
        [sha256(bench.text("two.json").as_bytes()), sha256(&fs::read(bench.0.join("frf.uff")).unwrap())];
    for script in [
        "mkfifo p q; cat two.json > p & cat frf.uff > q & $PROGRAM decompose p q --json",
        "$PROGRAM decompose two.json /dev/stdin --json < frf.uff",
        "cat frf.uff | $PROGRAM decompose two.json /dev/stdin --json",
        "cat frf.uff | $PROGRAM decompose two.json - --json",
    ] {
        let output = shell(&bench, script);
        assert_eq!(output.status.code(), Some(0), "{script}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(hashes(&serde_json::from_slice(&output.stdout).unwrap()), expected, "{script}");
    }
    let twice = shell(&bench, "mkfifo r; cat frf.uff > r & $PROGRAM decompose two.json r r --json");
    let told = String::from_utf8(twice.stderr).unwrap();
    assert!(twice.status.code() == Some(2) && told.contains("r: is given twice"), "{told}");
}

#[test]
fn files_that_change_or_go_while_they_are_diagnosed_neither_cost_the_answer_nor_lend_it_their_hash() {
    let bench = Bench::shipped("changed");
    let expected =
        ["fixture.json", "hammer-test.uff"].map(|name| sha256(&fs::read(bench.0.join(name)).unwrap()));
    let mut program = Command::new(env!("CARGO_BIN_EXE_jointscope"))
        .args(["diagnose", "fixture.json", "hammer-test.uff", "--band", "400:600", "-o", "out"])
        .current_dir(&bench.0)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut told = BufReader::new(program.stderr.take().unwrap()).lines();
    told.next().unwrap().unwrap();
    // The search has begun, so everything has been read.
    bench.write("fixture.json", "{}");
    fs::remove_file(bench.0.join("hammer-test.uff")).unwrap();
    let rest: Vec<String> = told.map_while(Result::ok).collect();
    assert_eq!(program.wait().unwrap().code(), Some(0), "{rest:?}");
    assert_eq!(hashes(&bench.json("out/diagnosis.json")), expected);
    let page = bench.text("out/report.html");
    assert!(expected.iter().all(|hash| page.contains(hash)));
}
