//! What goes wrong around a run: pipes, files that change under it, no room, folders of other runs, names
//! given twice.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use sha2::{Digest, Sha256};

use crate::common::{Bench, TWO_BLOCKS};

const LINES: &str = "50:1000:10";

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

#[test]
fn a_disk_that_is_full_leaves_the_earlier_answer_as_it_was_and_nothing_half_written() {
    let bench = Bench::synthesized("room", TWO_BLOCKS, LINES);
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "out"]);
    let before = (bench.text("out/stiffness.json"), bench.text("out/report.html"));
    // The largest file that the shell lets the program make: 8 blocks of 512 bytes or 1024.
    let script = "trap '' XFSZ; ulimit -f 8; $PROGRAM decompose two.json frf.uff --band 100:900 -o out";
    let output = shell(&bench, script);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && told.contains("out/stiffness.json: "), "{told}");
    assert_eq!((bench.text("out/stiffness.json"), bench.text("out/report.html")), before);
    assert_eq!(fs::read_dir(bench.0.join("out")).unwrap().count(), 2);
}

#[test]
fn what_dead_runs_left_behind_blocks_nothing_and_goes() {
    let bench = Bench::synthesized("dead", TWO_BLOCKS, LINES);
    fs::create_dir(bench.0.join("out")).unwrap();
    for name in [".tmpA.jointscope-part", ".stiffness.json.1-0.jointscope-part", ".jointscope-lock"] {
        bench.write(&format!("out/{name}"), "");
    }
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "out"]);
    let mut names: Vec<_> =
        fs::read_dir(bench.0.join("out")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["report.html", "stiffness.json"]);
}

#[test]
fn files_of_a_run_that_was_killed_between_them_are_not_taken_for_a_whole() {
    let bench = Bench::synthesized("killed", TWO_BLOCKS, LINES);
    let decompose = |to: &str| bench.done(&["decompose", "two.json", "frf.uff", "-o", to]);
    decompose("a");
    decompose("b");
    bench.write("a/.jointscope-lock", "report.html\nstiffness.json\n");
    for command in [&["compare", "a", "b", "-o", "c"][..], &["export", "a", "--to", "csv", "-o", "j.csv"]] {
        bench.refused(command, &["a/stiffness.json: may not belong to the files beside it", "again"]);
    }
    let said = bench.done(&["modes", "frf.uff", "-o", "a"]);
    assert!(said.contains("stiffness.json may be of two runs"), "{said}");
    bench.refused(&["compare", "a", "b", "-o", "c"], &["a/stiffness.json"]);
    decompose("a");
    bench.done(&["compare", "a", "b", "-o", "c"]);
}

#[test]
fn runs_at_once_into_one_folder_leave_the_files_of_one_of_them() {
    let bench = Bench::synthesized("pair", TWO_BLOCKS, LINES);
    let start = |band: &str| {
        Command::new(env!("CARGO_BIN_EXE_jointscope"))
            .args(["decompose", "two.json", "frf.uff", "--band", band, "--also", "csv,svg", "-o", "out"])
            .current_dir(&bench.0)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    for run in [start("100:900"), start("110:800"), start("120:700")] {
        let output = run.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let command = bench.json("out/stiffness.json")["made"]["command"].as_str().unwrap().to_owned();
    assert!(bench.text("out/report.html").contains(&command), "{command}");
}

#[test]
fn one_name_for_two_files_is_refused_before_the_work() {
    let bench = Bench::synthesized("twice", TWO_BLOCKS, LINES);
    let modes = ["modes", "frf.uff", "--fixture", "two.json", "--update", "m/modes.json", "-o", "m"];
    bench.refused(&modes, &["m/modes.json: would be written twice", "different names"]);
    let fem = ["fem", "two.json", "-o", "twin.uff", "--deck", "./twin.uff"];
    bench.refused(&fem, &["twin.uff: would be written twice"]);
}

#[test]
fn a_folder_that_may_not_be_written_to_is_told_before_the_work() {
    let bench = Bench::synthesized("rights", TWO_BLOCKS, LINES);
    let folder = bench.0.join("out");
    fs::create_dir(&folder).unwrap();
    fs::set_permissions(&folder, std::os::unix::fs::PermissionsExt::from_mode(0o555)).unwrap();
    if tempfile::tempfile_in(&folder).is_ok() {
        println!("skipped: this user may write everywhere");
        return;
    }
    bench.refused(&["decompose", "two.json", "frf.uff", "-o", "out"], &["nothing can be put into out"]);
}

#[test]
fn names_that_turn_text_around_are_spelled_out_on_the_terminal_and_in_json() {
    let bench = Bench::synthesized("names", TWO_BLOCKS, LINES);
    let name = "two\u{202e}\u{1b}[2J.json";
    bench.write(name, TWO_BLOCKS.replace("\"two blocks and a beam\"", "\"a\\u202eb\\u001bc\""));
    let said = bench.done(&["decompose", name, "frf.uff", "-o", "out", "--json"]);
    assert!(said.contains("two\\u202e\\u001b[2J.json") && !said.contains(['\u{202e}', '\u{1b}']), "{said}");
    let page = bench.text("out/report.html");
    assert!(!page.contains(['\u{202e}', '\u{1b}']) && page.contains("two\u{fffd}\u{fffd}[2J.json"));
    bench.refused(
        &["decompose", "gone\u{1b}.json", "frf.uff", "-o", "o"],
        &["gone\\u001b.json: there is no such file"],
    );
}

#[test]
fn a_second_run_waits_and_says_so() {
    let bench = Bench::synthesized("waits", TWO_BLOCKS, LINES);
    fs::create_dir(bench.0.join("out")).unwrap();
    let lock = fs::File::create(bench.0.join("out/.jointscope-lock")).unwrap();
    lock.lock().unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_jointscope"))
        .args(["decompose", "two.json", "frf.uff", "-o", "out"])
        .current_dir(&bench.0)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut told = BufReader::new(run.stderr.take().unwrap()).lines();
    let sentence = told.by_ref().map_while(Result::ok).find(|line| line.contains("waiting")).unwrap();
    assert!(sentence.contains("another run is writing to ") && sentence.contains("/out"), "{sentence}");
    assert!(!bench.0.join("out/stiffness.json").exists());
    lock.unlock().unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(0));
    assert!(bench.0.join("out/stiffness.json").exists());
}
