//! Files that cannot be read.

use super::LINES;
use crate::common::{Bench, TWO_BLOCKS};
use std::fs;

/// The program on a recording made of good text (dataset 58 ASCII) by a change; it must refuse.
#[track_caller]
fn text(name: &str, change: impl FnOnce(&str) -> String, parts: &[&str]) {
    let bench = Bench::new(name);
    bench.write("two.json", TWO_BLOCKS);
    bench.done(&["synthesize", "two.json", "--ascii", "--lines", LINES, "-o", "frf.uff"]);
    bench.write("bad.uff", change(&bench.text("frf.uff")));
    bench.refused(&["decompose", "two.json", "bad.uff", "-o", "out"], parts);
}

#[test]
fn a_missing_file_is_named() {
    let bench = Bench::synthesized("bad-missing", TWO_BLOCKS, LINES);
    bench.refused(
        &["decompose", "two.json", "gone.uff", "-o", "out"],
        &["gone.uff", "no such file", "check the path"],
    );
    bench.refused(&["decompose", "gone.json", "frf.uff", "-o", "out"], &["gone.json", "no such file"]);
    bench.refused(&["decompose", "two.json", "frf.uff", "gone.uff", "-o", "out"], &["gone.uff"]);
    bench.refused(&["decompose", "two.json", ".", "-o", "out"], &["directory where a file is needed"]);
}

#[test]
fn a_truncated_binary_file_names_the_dataset_that_ends_early() {
    let bench = Bench::synthesized("bad-truncated", TWO_BLOCKS, LINES);
    let whole = fs::read(bench.0.join("frf.uff")).unwrap();
    bench.write("bad.uff", &whole[..whole.len() - 1000]);
    bench.refused(
        &["decompose", "two.json", "bad.uff", "-o", "out"],
        &["bad.uff: dataset 4", "191 points", "the file ends", "copy or export"],
    );
}

#[test]
fn a_truncated_text_file_names_the_line_where_it_ends() {
    let cut = |whole: &str| whole[..whole.len() - 1000].to_owned();
    text("bad-truncated-text", cut, &["bad.uff: dataset 4, line ", "the file ends", "copy or export"]);
}

#[test]
fn a_file_without_any_function_says_which_datasets_it_has() {
    let bench = Bench::new("bad-151");
    bench.write("two.json", TWO_BLOCKS);
    let header = "    -1\n   151\nmodel\ntwo blocks\nNONE\n    -1\n";
    bench.write("header.uff", header);
    bench.refused(
        &["decompose", "two.json", "header.uff", "-o", "out"],
        &["header.uff", "no FRF", "dataset 151", "export"],
    );
}

#[test]
fn a_file_that_is_no_universal_file_is_doubted() {
    let bench = Bench::new("bad-json");
    bench.write("two.json", TWO_BLOCKS);
    bench.refused(
        &["decompose", "two.json", "two.json", "-o", "out"],
        &["two.json", "is a JSON file, such as a fixture"],
    );
    bench.write("empty.uff", "");
    bench.refused(&["decompose", "two.json", "empty.uff", "-o", "out"], &["empty.uff", "empty", "export"]);
}

#[test]
fn a_value_that_is_no_number_is_placed() {
    let nan = |whole: &str| replace_a_value(whole, 30, "          NaN");
    text("bad-nan", nan, &["bad.uff: dataset 1", "not finite", "mask or remove"]);
    let word = |whole: &str| replace_a_value(whole, 30, "       broken");
    text("bad-word", word, &["bad.uff: dataset 1, line 31", "`broken`", "export"]);
}

#[test]
fn a_missing_value_is_placed() {
    let blank = |whole: &str| replace_a_value(whole, 30, "             ");
    text("bad-blank", blank, &["bad.uff: dataset 1, line 31", "blank", "fill it in"]);
    let short = |whole: &str| {
        let mut lines: Vec<&str> = whole.lines().collect();
        lines.remove(40);
        lines.join("\n") + "\n"
    };
    text("bad-short", short, &["bad.uff, function 1", "states 191 points", "after 189", "export"]);
}

/// Puts 13 characters over the first ones of a line's second value (double precision, 20 columns each).
fn replace_a_value(whole: &str, line: usize, value: &str) -> String {
    let mut lines: Vec<String> = whole.lines().map(str::to_owned).collect();
    let padded = format!("{value:>20}");
    lines[line].replace_range(20..40, &padded);
    lines.join("\n") + "\n"
}

#[test]
fn a_table_that_is_no_recording_is_refused_with_the_line_and_what_to_do() {
    let bench = Bench::new("bad-tables");
    bench.write("two.json", TWO_BLOCKS);
    let check = |rows: &str, parts: &[&str]| {
        bench.write("t.csv", format!("frequency [Hz],3/1 real [m/s^2/N],3/1 imag\n{rows}"));
        bench.refused(&["diagnose", "two.json", "t.csv", "-o", "out"], parts);
    };
    check("10,1,2\n20,NaN,3\n", &["t.csv: line 3, column 2", "`NaN`", "leave the line out"]);
    check("10,1e400,2\n20,1,3\n", &["t.csv: line 2, column 2", "`1e400`", "leave the line out"]);
    check("30,1,2\n20,1,3\n", &["t.csv", "20 Hz", "sort them by frequency"]);
    check("10,1,2\n10,1,3\n", &["t.csv", "10 Hz", "each once"]);
    check("-10,1,2\n20,1,3\n", &["t.csv", "-10 Hz", "zero or above"]);
    bench.write("t.csv", "frequency [Hz],3/1 real [m/s^2/N],3/1 imag\n10,1,2\n20,1,3\n");
    bench.write("u.csv", "frequency [Hz],4/1 real [m/s^2/N],4/1 imag\n10,1,2\n25,1,3\n30,1,3\n");
    bench
        .refused(&["diagnose", "two.json", "t.csv", "u.csv", "-o", "out"], &["u.csv", "t.csv", "same lines"]);
}
