//! The built program on recordings, fixtures and joints that do not go together: one plain sentence with file, place and remedy, status 2, nothing
//! written. What goes wrong within one file, by the hundred, is in `bad_inputs`.

use std::fs;

use crate::common::{Bench, TWO_BLOCKS};
use jointscope::uff::{Abscissa, Axis, Data, Dataset58, FunctionType};
use jointscope_samples::TWO_STOREYS;

const LINES: &str = "50:1000:5";

/// The program on a recording made of good FRFs by a change; it must refuse.
#[track_caller]
fn recording(name: &str, change: impl FnOnce(&mut Vec<Dataset58>), parts: &[&str]) {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    bench.rewrite("frf.uff", "bad.uff", change);
    bench.refused(&["decompose", "two.json", "bad.uff", "-o", "out"], parts);
}

/// The program on a recording made of good text (dataset 58 ASCII) by a change; it must refuse.
#[track_caller]
fn text(name: &str, change: impl FnOnce(&str) -> String, parts: &[&str]) {
    let bench = Bench::new(name);
    bench.write("two.json", TWO_BLOCKS);
    bench.done(&["synthesize", "two.json", "--ascii", "--lines", LINES, "-o", "frf.uff"]);
    bench.write("bad.uff", change(&bench.text("frf.uff")));
    bench.refused(&["decompose", "two.json", "bad.uff", "-o", "out"], parts);
}

/// The program on a fixture made of a good one by a replacement; it must refuse.
#[track_caller]
fn fixture(name: &str, from: &str, to: &str, parts: &[&str]) {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    assert!(TWO_BLOCKS.contains(from), "{from}");
    bench.write("bad.json", TWO_BLOCKS.replacen(from, to, 1));
    bench.refused(&["decompose", "bad.json", "frf.uff", "-o", "out"], parts);
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
fn coherences_alone_are_no_frfs() {
    let only = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.function = FunctionType::Coherence;
            dataset.data = Data::Real(vec![0.9; dataset.data.len()]);
        }
    };
    recording("bad-coherence", only, &["bad.uff", "no FRF", "coherence", "export"]);
}

#[test]
fn time_histories_without_a_force_are_no_hits() {
    let only = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.function = FunctionType::TimeResponse;
            dataset.abscissa_axis = Axis::time();
            dataset.denominator_axis = Axis::default();
            dataset.data = Data::Real(vec![0.1; dataset.data.len()]);
        }
    };
    recording("bad-time", only, &["bad.uff: hit 0 has no force channel", "ordinate type 13"]);
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
fn frfs_on_different_lines_name_both() {
    let other = |datasets: &mut Vec<Dataset58>| {
        datasets[2].abscissa = Abscissa::Even { start: 50.0, step: 4.0, count: 191 };
    };
    recording("bad-lines", other, &["bad.uff, function 3", "function 2", "on the same lines"]);
}

#[test]
fn an_frf_that_is_needed_and_missing_is_named() {
    let without = |datasets: &mut Vec<Dataset58>| {
        datasets.pop();
    };
    recording("bad-three", without, &["bad.uff", "joint `J`", "missing FRF 3/2"]);
    let one_sensor = |datasets: &mut Vec<Dataset58>| datasets.retain(|d| d.response.number == 4);
    recording("bad-sensor", one_sensor, &["bad.uff", "missing a second sensor", "point 4"]);
    let one_hit = |datasets: &mut Vec<Dataset58>| datasets.retain(|d| d.reference.number == 1);
    recording("bad-hit", one_hit, &["bad.uff", "missing a second hammer point", "point 1"]);
    let same_side = |datasets: &mut Vec<Dataset58>| {
        datasets.truncate(1);
        datasets[0].response.number = 2;
    };
    recording(
        "bad-side",
        same_side,
        &["bad.uff", "no FRF of the recording crosses joint `J`", "3, 4", "2/1"],
    );
}

#[test]
fn an_frf_given_twice_is_left_to_the_user() {
    let twice = |datasets: &mut Vec<Dataset58>| datasets.push(datasets[0].clone());
    recording("bad-twice", twice, &["bad.uff, function 5", "4/1", "leave one of them out"]);
}

#[test]
fn unknown_and_absent_units_ask_for_what_they_are() {
    let unknown = |datasets: &mut Vec<Dataset58>| datasets[1].ordinate_axis.units = "furlong/s^2".to_owned();
    recording("bad-unit", unknown, &["bad.uff, function 2", "`furlong/s^2`", "--assume-units"]);
    let absent = |datasets: &mut Vec<Dataset58>| {
        let first = &mut datasets[0];
        for axis in [&mut first.ordinate_axis, &mut first.denominator_axis] {
            (axis.data_type, axis.units) = (0, "NONE".to_owned());
        }
    };
    recording("bad-no-unit", absent, &["bad.uff, function 1", "does not say", "--assume-units m/s^2,N"]);
    let contrary = |datasets: &mut Vec<Dataset58>| datasets[3].ordinate_axis.units = "m/s".to_owned();
    recording("bad-contrary", contrary, &["bad.uff, function 4", "`m/s`", "acceleration", "export"]);
}

#[test]
fn nodes_that_the_fixture_does_not_have_ask_for_a_map() {
    let moved = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.response.number += 100;
            dataset.reference.number += 100;
        }
    };
    recording("bad-nodes", moved, &["bad.uff", "104:+y", "1, 2, 3, 4", "`--map 10"]);
    let sideways = |datasets: &mut Vec<Dataset58>| {
        datasets.iter_mut().for_each(|dataset| dataset.response.direction = 3);
    };
    recording(
        "bad-direction",
        sideways,
        &["bad.uff, function 1", "+z", "`--map 4:+z=4:+y`", "`--map +z=+y`"],
    );
}

#[test]
fn a_joint_at_an_unknown_point_is_placed() {
    fixture("bad-point", r#""to": "3""#, r#""to": "9""#, &["bad.json: joints/J/to", "`9`", "1, 2, 3, 4"]);
    fixture(
        "bad-body",
        r#""4": { "body": "B""#,
        r#""4": { "body": "C""#,
        &["bad.json: points/4", "`C`", "A, B"],
    );
}

#[test]
fn an_impossible_fixture_is_placed() {
    fixture("bad-mass", "1.10", "-1.10", &["bad.json: bodies/A/mass", "above zero"]);
    fixture(
        "bad-order",
        r#""from": "2", "to": "3""#,
        r#""from": "3", "to": "2""#,
        &["bad.json: joints/J", "x"],
    );
    fixture(
        "bad-length",
        r#""3": { "body": "B", "x": 0.065 }"#,
        r#""3": { "body": "B", "x": 0.0 }"#,
        &["bad.json: joints/J", "needs a length", "`stiffness`"],
    );
}

#[test]
fn an_unknown_key_is_taken_for_the_one_it_resembles() {
    let cases = [
        (r#""x_cg""#, r#""x_gc""#, "did you mean `x_cg`?"),
        (r#""second_moment""#, r#""second_momnet""#, "did you mean `second_moment`?"),
        (r#""loss_factor""#, r#""lossfactor""#, "did you mean `loss_factor`?"),
        (r#""joints""#, r#""joint""#, "did you mean `joints`?"),
    ];
    for (index, (good, bad, advice)) in cases.into_iter().enumerate() {
        fixture(&format!("bad-key-{index}"), good, bad, &["bad.json: ", advice]);
    }
}

const THREE_BLOCKS: &str = r#"{
  "bodies": {
    "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.5e-4, "x_cg": 0.10 },
    "C": { "mass": 1.3, "inertia": 9.5e-4, "x_cg": 0.23 }
  },
  "points": {
    "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.07 }, "4": { "body": "B", "x": 0.13 },
    "5": { "body": "C", "x": 0.2 }, "6": { "body": "C", "x": 0.26 }
  },
  "joints": {
    "near": { "from": "2", "to": "3", "stiffness": [[3e6, -1e5], [-1e5, 5e3]] },
    "far": { "from": "4", "to": "5", "stiffness": [[3e6, -1e5], [-1e5, 5e3]] }
  },
  "damping": { "loss_factor": 0.01 }
}"#;

#[test]
fn a_joint_that_is_chosen_must_be_there() {
    let bench = Bench::synthesized("bad-joints", THREE_BLOCKS, LINES);
    bench.refused(
        &["decompose", "two.json", "frf.uff", "--joint", "nearr", "-o", "out"],
        &["two.json", "no joint `nearr`", "near, far"],
    );
}

#[test]
fn two_joints_between_the_same_two_blocks_are_told_from_each_other_by_no_frf() {
    let beside = r#""beside": { "from": "1", "to": "4", "stiffness": [[1e5, 0], [0, 0]] }, "far""#;
    let doubled = THREE_BLOCKS.replacen(r#""far""#, beside, 1);
    let bench = Bench::synthesized("bad-beside", &doubled, LINES);
    bench.refused(
        &["decompose", "two.json", "frf.uff", "-o", "out"],
        &["two.json", "joints `near` and `beside`", "only the sum", "--joint"],
    );
}

#[test]
fn a_fixture_of_one_body_has_no_joint_to_find() {
    let bench = Bench::new("bad-single");
    bench.write("two.json", r#"{ "bodies": { "A": { "mass": 2, "rotates": false } }, "points": { "1": { "body": "A", "x": 0 } } }"#);
    bench.done(&["synthesize", "two.json", "--frf", "1/1", "--lines", LINES, "-o", "frf.uff"]);
    bench.refused(&["decompose", "two.json", "frf.uff", "-o", "out"], &["two.json", "no joint to find"]);
}

#[test]
fn a_band_without_lines_is_told_the_lines_there_are() {
    let bench = Bench::synthesized("bad-band", TWO_BLOCKS, LINES);
    let decompose = |band: &'static str| ["decompose", "two.json", "frf.uff", "--band", band, "-o", "out"];
    bench.refused(&decompose("2000:3000"), &["frf.uff", "2000 to 3000 Hz", "no usable", "50 to 1000 Hz"]);
    bench.refused(&decompose("300:200"), &["--band", "200:800"]);
}

#[test]
fn a_coherence_that_is_zero_everywhere_is_left_out_and_named() {
    let bench = Bench::shipped("bad-incoherent");
    bench.rewrite("hammer-test.uff", "bad.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            if let (FunctionType::Coherence, Data::Real(values)) = (dataset.function, &mut dataset.data) {
                values.fill(0.0);
            }
        }
    });
    let said = bench.done(&["decompose", "fixture.json", "bad.uff", "-o", "out"]);
    assert!(said.contains("is zero on all lines: left out"), "{said}");
}

#[test]
fn a_coherence_beyond_one_is_left_out_and_named() {
    let bench = Bench::shipped("bad-coherent");
    bench.rewrite("hammer-test.uff", "bad.uff", |datasets| {
        if let Data::Real(values) = &mut datasets[1].data {
            values[9] = 1.2;
        }
    });
    let said = bench.done(&["decompose", "fixture.json", "bad.uff", "-o", "out"]);
    assert!(said.contains("the coherence of 4/1 is above one"), "{said}");
}

#[test]
fn a_refusal_leaves_an_earlier_result_as_it_was() {
    let bench = Bench::shipped("bad-earlier");
    bench.done(&["decompose", "fixture.json", "hammer-test.uff", "-o", "out"]);
    bench.refused(&["decompose", "fixture.json", "hammer-test.uff", "--joint", "K", "-o", "out"], &["`K`"]);
    bench.refused(&["decompose", "fixture.json", "hammer-test.uff", "-o", "fixture.json"], &["fixture.json"]);
}

/// The program on good files with further arguments; it must refuse.
#[track_caller]
fn diagnosis(name: &str, arguments: &[&str], parts: &[&str]) {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    let all: Vec<&str> = ["diagnose", "two.json", "frf.uff"].iter().chain(arguments).copied().collect();
    bench.refused(&all, parts);
}

#[test]
fn a_band_that_leaves_no_line_says_which_lines_there_are() {
    diagnosis(
        "bad-diagnose-band",
        &["--band", "2000:3000", "-o", "out"],
        &["frf.uff", "50 to 1000 Hz", "--band"],
    );
    diagnosis(
        "bad-diagnose-exclude",
        &["--exclude", "0:600", "500:2000", "--json"],
        &["frf.uff", "--exclude"],
    );
}

#[test]
fn a_diagnosis_without_a_place_to_write_to_is_bad_usage() {
    diagnosis("bad-diagnose-output", &[], &["--output <DIR>"]);
    diagnosis("bad-diagnose-band-form", &["--band", "800:200", "-o", "out"], &["the lower first"]);
    diagnosis("bad-diagnose-pair", &["--hold-out", "41", "-o", "out"], &["response over reference"]);
}

#[test]
fn a_recording_of_another_fixture_is_refused_by_file_and_point() {
    let bench = Bench::synthesized("bad-diagnose-other", TWO_BLOCKS, LINES);
    let renumber = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets {
            dataset.response.number += 100;
            dataset.reference.number += 100;
        }
    };
    bench.rewrite("frf.uff", "other.uff", renumber);
    bench.refused(&["diagnose", "two.json", "other.uff", "-o", "out"], &["other.uff", "104", "--map"]);
}

#[test]
fn a_fixture_that_would_be_overwritten_and_a_folder_that_is_a_file_are_refused() {
    // Before the search, which may take long.
    let bench = Bench::new("bad-diagnose-write");
    bench.write("refitted.json", TWO_STOREYS);
    bench.write("plain", "a file, no folder");
    bench.done(&[
        "synthesize",
        "refitted.json",
        "--frf",
        "1/1",
        "2/1",
        "--lines",
        "20:400:20",
        "-o",
        "frf.uff",
    ]);
    bench.refused(&["diagnose", "refitted.json", "frf.uff", "-o", "."], &["refitted.json", "overwritten"]);
    bench.refused(&["diagnose", "refitted.json", "frf.uff", "-o", "plain"], &["plain"]);
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
