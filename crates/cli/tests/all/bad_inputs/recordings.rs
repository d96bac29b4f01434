//! Recordings that are none, are cut, or cannot be read at a line.

use std::fs;

use super::Cases;
use crate::common::TWO_BLOCKS;

#[test]
fn a_file_that_is_no_recording_is_told_what_it_is_taken_for() {
    let mut cases = Cases::new("bad-files");
    for (name, contents, words) in FILES {
        cases.recording(name, contents, words);
    }
    let text = cases.bench.text("text.uff");
    let utf16: Vec<u8> =
        std::iter::once(0xfeff_u16).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    cases.recording("the fixture", TWO_BLOCKS, "JSON|recording is expected");
    cases.recording("zeros", [0_u8; 512], "neither a universal file");
    cases.recording("UTF-16", utf16, "UTF-16|UTF-8");
    cases.recording("line ends of carriage returns", text.replace('\n', "\r"), "LF");
    cases.finish();
}

/// Whole files, and what is to be said.
const FILES: &[(&str, &[u8], &str)] = &[
    ("nothing", b"", "empty|export it again"),
    ("a blank line", b"\n", "empty"),
    ("a word", b"hello\n", "no universal file|`hello`"),
    ("a picture", b"\x89PNG\r\n\x1a\n\0\0\0\0", "neither a universal file"),
    ("an archive", b"PK\x03\x04\0\0\0\0", "ZIP|unpack it"),
    ("a page", b"<!DOCTYPE html><html><body>404</body></html>", "no universal file"),
    ("a table without a header", b"1,2,3\n2,3,4\n", "header"),
    ("a table with a word among numbers", b"frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,x,4\n", "line 3|`x`"),
    ("a table with a short row", b"frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,3\n", "line 3"),
    ("a table without units", b"frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,3,3\n", "--assume-units m/s^2,N"),
    ("a table of one part", b"frequency [Hz],4/1 real\n1,2\n2,3\n", "4/1"),
    ("a cut MATLAB file", b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MAT-file|copy or save"),
    ("a header alone", b"    -1\n   151\nmodel\n    -1\n", "no FRF|dataset 151"),
];

#[test]
fn a_recording_that_is_cut_anywhere_says_where_it_ends() {
    let mut cases = Cases::new("bad-cut");
    let text = cases.bench.text("text.uff");
    let lines: Vec<&str> = text.lines().collect();
    let each = lines.len() / 4;
    assert_eq!(lines.len() % 4, 0, "four datasets of one length");
    for dataset in 0..4 {
        for (what, line) in [
            ("its number", 1),
            ("an ID line", 4),
            ("record 6", 7),
            ("record 7", 8),
            ("its units", 10),
            ("its values", each / 2),
            ("its last line", each - 1),
        ] {
            let name = format!("dataset {} cut before {what}", dataset + 1);
            let end = if dataset == 0 && line == 1 { "dataset number" } else { "export" };
            cases.recording(&name, lines[..dataset * each + line].join("\n") + "\n", end);
        }
    }
    let binary = fs::read(cases.bench.0.join("frf.uff")).unwrap();
    let each = binary.len() / 4;
    for dataset in 0..4 {
        for share in [0.3, 0.8] {
            let end = ((dataset as f64 + share) * each as f64) as usize;
            cases.recording(
                &format!("binary dataset {} cut at {share}", dataset + 1),
                &binary[..end],
                &format!("dataset {}|the file ends", dataset + 1),
            );
        }
    }
    cases.finish();
}

/// Replaces field `index` of a line of blanks and words.
fn field(index: usize, to: &str) -> impl Fn(&str) -> String {
    move |line| {
        let mut words: Vec<&str> = line.split_whitespace().collect();
        words[index] = to;
        // Fields of eleven columns, as record 7 has them at the most.
        words.iter().map(|word| format!("{word:>13}")).collect()
    }
}

#[test]
fn a_dataset_that_cannot_be_read_is_placed_by_its_line() {
    let mut cases = Cases::new("bad-datasets");
    let value = |to: &'static str| move |line: &str| format!("{to:>20}{}", &line[20..]);
    for (name, to, words) in [
        ("not a number", "NaN", "dataset 1|not finite|mask or remove"),
        ("infinite", "Infinity", "dataset 1|not finite"),
        ("minus infinite", "-inf", "dataset 1|not finite"),
        ("too large", "1e999", "dataset 1"),
        ("a decimal comma", "1,5E+00", "dataset 1, line 14|`1,5E+00`"),
        ("letters", "x.xxxE-xx", "dataset 1, line 14|export"),
        ("stars, as where a column was too narrow", "********", "dataset 1, line 14|`********`"),
        ("blank", "", "dataset 1, line 14|blank"),
    ] {
        cases.line(name, 14, value(to), words);
    }
    cases.line("the value 1e300", 14, value("1e300"), "FRF");
    let whole = |to: &'static str| move |_: &str| to.to_owned();
    cases.line("no dataset number", 2, whole("    xx"), "line 2");
    cases.line("no opening line", 1, whole("hello"), "universal file");
    cases.line("values in words", 14, whole("one two three four"), "dataset 1, line 14");
    cases.line("ordinates of an unknown type", 9, field(0, "99"), "dataset 1, line 9|`99`");
    cases.line("a number of points below zero", 9, field(1, "-41"), "dataset 1, line 9|`-41`");
    cases.line("no points", 9, field(1, "0"), "dataset 1");
    cases.line("points by the milliard", 9, field(1, "2000000000"), "2000000000 points");
    cases.line("points in words", 9, field(1, "many"), "dataset 1, line 9");
    cases.line("abscissae of an unknown spacing", 9, field(2, "7"), "dataset 1, line 9|`7`");
    cases.line("no step", 9, field(4, "0.0"), "ascend");
    cases.line("a step below zero", 9, field(4, "-20.0"), "ascend");
    cases.line("a step that is no number", 9, field(4, "NaN"), "dataset 1, line 9");
    cases.line("a first frequency that is no number", 9, field(3, "1e999"), "dataset 1, line 9");
    cases.line("more values than stated", 9, field(1, "40"), "dataset 1, line |more data|number of points");
    cases.line("fewer values than stated", 9, field(1, "42"), "42 points");
    cases.finish();
}
