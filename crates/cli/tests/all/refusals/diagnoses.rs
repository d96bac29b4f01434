//! Options of a diagnosis that do not go together with its files.

use super::LINES;
use crate::common::{Bench, TWO_BLOCKS};
use jointscope::uff::Dataset58;
use jointscope_samples::TWO_STOREYS;

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
