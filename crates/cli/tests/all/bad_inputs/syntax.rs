//! Fixture files that are no JSON, or JSON of something else.

use std::fs;

use super::Cases;
use crate::common::TWO_BLOCKS;

#[test]
fn what_is_no_json_says_where_it_ends_to_be_and_what_to_do() {
    let mut cases = Cases::new("bad-syntax");
    for (name, contents, words) in FILES {
        cases.fixture(name, contents, words);
    }
    for (name, from, to, words) in REPLACED {
        assert!(TWO_BLOCKS.contains(from), "{name} changes nothing");
        cases.fixture(name, TWO_BLOCKS.replacen(from, to, 1), words);
    }
    let utf16 = |text: &str, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    cases.fixture("cut in an object", &TWO_BLOCKS[..120], "line |ends inside|copy it again");
    cases.fixture("cut before the last brace", TWO_BLOCKS.trim_end_matches('}'), "ends inside|close");
    cases.fixture("two objects", format!("{TWO_BLOCKS}{TWO_BLOCKS}"), "ends before the file does|remove");
    cases.fixture("brackets without end", "[".repeat(5000), "deeper");
    cases.fixture("UTF-16, little end first", utf16(TWO_BLOCKS, u16::to_le_bytes), "UTF-8");
    cases.fixture("UTF-16, big end first", utf16(TWO_BLOCKS, u16::to_be_bytes), "UTF-8");
    cases.fixture("zeros", [0_u8; 64], "line 1");
    cases.fixture(
        "the recording",
        fs::read(cases.bench.0.join("text.uff")).unwrap(),
        "universal file|fixture first",
    );
    cases.finish();
}

/// Whole files, and what is to be said.
const FILES: &[(&str, &[u8], &str)] = &[
    ("nothing", b"", "empty|jointscope init"),
    ("blank lines", b" \n\n\t\n", "empty|jointscope init"),
    ("cut in a text", br#"{ "name": "two blo"#, "line 1|ends inside"),
    ("Latin-1", b"{ \"name\": \"Br\xfccke\" }", "line 1|UTF-8"),
    ("a picture", b"\x89PNG\r\n\x1a\n\0\0", "UTF-8"),
    ("a page", b"<!DOCTYPE html><html></html>", "line 1, column 1"),
    ("a table", b"body,mass\nA,1.1\n", "line 1, column 1"),
    ("a list", b"[]", "an object"),
    ("null", b"null", "an object"),
    ("a number", b"42", "an object"),
    ("a text", br#""fixture""#, "an object"),
];

/// What is replaced in the good fixture, by what, and what is to be said.
const REPLACED: &[(&str, &str, &str, &str)] = &[
    ("decimal comma", "1.10", "1,10", "line 4|decimal point"),
    ("decimal comma in an exponent", "9.5e-4", "9,5e-4", "line 4|decimal point"),
    ("NaN", "1.10", "NaN", "line 4|NaN|leave the key out"),
    ("nan", "1.10", "nan", "line 4|NaN"),
    ("Infinity", "1.10", "Infinity", "line 4|infinity"),
    ("minus infinity", "1.10", "-Infinity", "line 4|infinity"),
    ("a comment of two slashes", r#""points""#, "// where\n\"points\"", "no comments|`notes`"),
    ("a comment between stars", r#""points""#, r#"/* where */ "points""#, "no comments|`notes`"),
    ("a comment of a hash", r#""points""#, "# where\n\"points\"", "no comments|`notes`"),
    ("a comma too many", r#""x_cg": -0.030 }"#, r#""x_cg": -0.030, }"#, "line 4|remove it"),
    ("a comma too few", "1.10, ", "1.10 ", "line 4|comma is missing"),
    ("a colon too few", r#""mass":"#, r#""mass""#, "line 4|colon is missing"),
    ("single quotes", r#""mass""#, "'mass'", "line 4|double quotes"),
    ("no quotes", r#""mass""#, "mass", "line 4|double quotes"),
    ("a number too large", "1.10", "1e999", "line 4|too large"),
    ("a number with a plus", "1.10", "+1.10", "line 4"),
    ("a number that begins with a point", "1.10", ".10", "line 4"),
    ("a number that ends with a point", "1.10", "1.", "line 4"),
    ("a hexadecimal number", "1.10", "0x11", "line 4"),
    ("a number with a unit", "1.10", "1.10 kg", "line 4"),
    ("True of Python", "1.10", "True", "line 4|true, false or null"),
    ("a line break in a text", "two blocks", "two\nblocks", "line |double quote"),
    ("a path with backslashes", "two blocks", "C:\\data\\q", "line 2|backslash"),
    ("a key twice", r#""mass": 1.10,"#, r#""mass": 1.10, "mass": 1.2,"#, "`mass` stands twice|remove one"),
    ("a body twice", r#""B": {"#, r#""A": {"#, "`A` stands twice|rename"),
    ("a point twice", r#""4": {"#, r#""3": {"#, "`3` stands twice|rename"),
];
