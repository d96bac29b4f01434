//! What goes where: answers, notices, progress, exit status, pages of several commands in one directory.

use std::fs::File;
use std::process::{Command, Stdio};

use crate::common::{Bench, TWO_BLOCKS};

const LINES: &str = "50:1000:10";

#[test]
fn an_answer_that_standard_output_does_not_take_is_told_and_is_no_success() {
    let Ok(full) = File::options().write(true).open("/dev/full") else { return };
    let bench = Bench::shipped("full");
    let show = |output: Stdio| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_jointscope"));
        program.args(["show", "hammer-test.uff"]).current_dir(&bench.0).stdout(output).output().unwrap()
    };
    let refused = show(full.into());
    let told = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1), "{told}");
    assert!(
        told.starts_with("jointscope: standard output takes no more (") && told.lines().count() == 1,
        "{told}"
    );
    let taken = show(Stdio::piped());
    assert_eq!((taken.status.code(), taken.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let bench = Bench::shipped("head");
    let mut program = Command::new(env!("CARGO_BIN_EXE_jointscope"))
        .args(["schema"])
        .current_dir(&bench.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(program.stdout.take());
    let output = program.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn notices_go_to_standard_error_and_json_is_the_file_itself() {
    let bench = Bench::synthesized("notices", TWO_BLOCKS, LINES);
    bench.rewrite("frf.uff", "bare.uff", |datasets| datasets.truncate(4));
    let output = bench.run(&["decompose", "two.json", "bare.uff", "--json", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stdout).unwrap(), bench.text("out/stiffness.json"));
    let alone = bench.answer(&["decompose", "two.json", "bare.uff", "--json"]);
    assert!(alone.contains("\"stiffness\""), "{alone}");
    bench.done(&["decompose", "two.json", "bare.uff", "-o", "again"]);
    let compared = bench.json_of(&["compare", "out", "again", "--json"]);
    assert_eq!(compared["joints"].as_array().unwrap().len(), 2);
}

#[test]
fn a_directory_that_takes_no_files_is_found_out_before_the_search() {
    if !std::path::Path::new("/proc/self").exists() {
        return;
    }
    let bench = Bench::shipped("unwritable");
    for arguments in [
        &["diagnose", "fixture.json", "hammer-test.uff", "-o", "/proc/jointscope"][..],
        &["decompose", "fixture.json", "hammer-test.uff", "-o", "/proc/jointscope"],
        &["modes", "hammer-test.uff", "-o", "/proc/jointscope"],
        &["fem", "fixture.json", "-o", "/proc/jointscope/f.uff"],
        &["tables", "-o", "/proc/jointscope/t.txt"],
    ] {
        // One sentence: nothing was told of any search.
        bench.refused(
            arguments,
            &["/proc/jointscope/", "nothing can be put into /proc", "choose another `-o`"],
        );
    }
}

#[test]
fn the_page_of_another_command_is_not_replaced_without_a_word() {
    let bench = Bench::synthesized("pages", TWO_BLOCKS, LINES);
    let decompose = ["decompose", "two.json", "frf.uff", "-o", "out"];
    assert!(!bench.done(&decompose).contains("note: "));
    assert!(!bench.done(&decompose).contains("is replaced"), "its own page goes without a word");
    let said = bench.done(&["modes", "frf.uff", "-o", "out"]);
    assert!(
        said.contains("note: out/report.html was the page of `jointscope decompose` and is replaced"),
        "{said}"
    );
}

#[test]
fn help_says_what_the_exit_status_means() {
    let bench = Bench::new("status");
    let help = bench.answer(&["--help"]);
    assert!(
        help.contains("Exit status: 0 done; 1 done in part") && help.contains("2 bad usage or bad input"),
        "{help}"
    );
}

#[test]
fn shells_and_manual_know_every_command() {
    let bench = Bench::new("manual");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = bench.answer(&["completions", shell]);
        assert!(script.contains("diagnose") && script.contains("hold-out"), "{shell}: {script}");
    }
    bench.done(&["man", "-o", "man1"]);
    let page = bench.text("man1/jointscope-diagnose.1");
    assert!(page.contains("hold") && page.starts_with(".ie"), "{page}");
    let help = bench.answer(&["--help"]);
    let listed = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    for command in listed.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next()) {
        assert!(
            command.is_empty() || bench.0.join(format!("man1/jointscope-{command}.1")).exists(),
            "{command}"
        );
    }
    assert_eq!(bench.answer(&["man"]), bench.text("man1/jointscope.1"));
}
