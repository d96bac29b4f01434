//! Inputs that go wrong, by the hundred: each through the program, which must refuse it in one plain sentence that says where and what to do, and leave
//! the directory as it was.
//!
//! A case is a flaw in a good pair (two blocks and their FRFs) and words that the sentence must have. All cases of a table are run before it fails.

use std::fmt::Write;
use std::fs;

use crate::common::{Bench, TWO_BLOCKS};

/// Few lines: what is refused is refused before anything is computed.
const LINES: &str = "100:900:20";

/// Refusals of one table, those that fail gathered.
struct Cases {
    bench: Bench,
    count: usize,
    failures: String,
}

impl Cases {
    fn new(name: &str) -> Self {
        let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
        bench.done(&["synthesize", "two.json", "--lines", LINES, "--ascii", "-o", "text.uff"]);
        Cases { bench, count: 0, failures: String::new() }
    }

    /// Runs a case whose words, parted by `|`, must all be said.
    fn refused(&mut self, name: &str, arguments: &[&str], words: &str) {
        self.count += 1;
        let before = self.bench.contents();
        let output = self.bench.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr).trim_end().to_owned();
        let mut wrong = Vec::new();
        if output.status.code() != Some(2) {
            wrong.push(format!("ends with {:?}", output.status.code()));
        }
        if !said.starts_with("jointscope: ") || said.lines().count() != 1 || !output.stdout.is_empty() {
            wrong.push("is not one sentence".to_owned());
        }
        wrong.extend(
            words.split('|').filter(|word| !said.contains(*word)).map(|word| format!("lacks `{word}`")),
        );
        if self.bench.contents() != before {
            wrong.push("left something behind".to_owned());
        }
        println!("{name}: {said}");
        if !wrong.is_empty() {
            let _ = writeln!(self.failures, "{name}: {}: {said}", wrong.join(", "));
        }
    }

    /// A fixture that is never right.
    fn fixture(&mut self, name: &str, contents: impl AsRef<[u8]>, words: &str) {
        self.bench.write("bad.json", contents);
        self.refused(name, &["check", "bad.json"], &format!("bad.json|{words}"));
    }

    /// The good fixture with one thing changed.
    fn changed(&mut self, from: &str, to: &str, words: &str) {
        assert!(TWO_BLOCKS.contains(from), "{from}");
        self.fixture(&format!("{from} → {to}"), TWO_BLOCKS.replacen(from, to, 1), words);
    }

    /// A recording that is never right.
    fn recording(&mut self, name: &str, contents: impl AsRef<[u8]>, words: &str) {
        self.bench.write("bad.uff", contents);
        self.refused(name, &["decompose", "two.json", "bad.uff", "-o", "out"], &format!("bad.uff|{words}"));
    }

    /// The good recording in ASCII with one line (from 1) changed.
    fn line(&mut self, name: &str, line: usize, to: impl Fn(&str) -> String, words: &str) {
        let text = self.bench.text("text.uff");
        let lines = text.lines().enumerate();
        let changed: Vec<String> =
            lines.map(|(at, own)| if at + 1 == line { to(own) } else { own.to_owned() }).collect();
        assert_ne!(changed[line - 1], text.lines().nth(line - 1).unwrap(), "{name} changes nothing");
        self.recording(name, changed.join("\n") + "\n", words);
    }

    fn finish(self) {
        println!("{} cases", self.count);
        assert!(self.failures.is_empty(), "{}", self.failures);
    }
}

#[test]
fn what_is_no_json_says_where_it_ends_to_be_and_what_to_do() {
    let mut cases = Cases::new("bad-syntax");
    let utf16 = |text: &str, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    let with = |from: &str, to: &str| TWO_BLOCKS.replacen(from, to, 1);
    cases.fixture("nothing", "", "empty|jointscope init");
    cases.fixture("blank lines", " \n\n\t\n", "empty|jointscope init");
    cases.fixture("cut in an object", &TWO_BLOCKS[..120], "line |ends inside|copy it again");
    cases.fixture("cut in a text", "{ \"name\": \"two blo", "line 1|ends inside");
    cases.fixture("cut before the last brace", TWO_BLOCKS.trim_end_matches('}'), "ends inside|close");
    cases.fixture("decimal comma", with("1.10", "1,10"), "line 4|decimal point");
    cases.fixture("decimal comma in an exponent", with("9.5e-4", "9,5e-4"), "line 4|decimal point");
    cases.fixture("NaN", with("1.10", "NaN"), "line 4|NaN|leave the key out");
    cases.fixture("nan", with("1.10", "nan"), "line 4|NaN");
    cases.fixture("Infinity", with("1.10", "Infinity"), "line 4|infinity");
    cases.fixture("minus infinity", with("1.10", "-Infinity"), "line 4|infinity");
    cases.fixture(
        "a comment of two slashes",
        with("\"points\"", "// where\n\"points\""),
        "no comments|`notes`",
    );
    cases.fixture(
        "a comment between stars",
        with("\"points\"", "/* where */ \"points\""),
        "no comments|`notes`",
    );
    cases.fixture("a comment of a hash", with("\"points\"", "# where\n\"points\""), "no comments|`notes`");
    cases.fixture("a comma too many", with("\"x_cg\": -0.030 }", "\"x_cg\": -0.030, }"), "line 4|remove it");
    cases.fixture("a comma too few", with("1.10, ", "1.10 "), "line 4|comma is missing");
    cases.fixture("a colon too few", with("\"mass\":", "\"mass\""), "line 4|colon is missing");
    cases.fixture("single quotes", with("\"mass\"", "'mass'"), "line 4|double quotes");
    cases.fixture("no quotes", with("\"mass\"", "mass"), "line 4|double quotes");
    cases.fixture("a number too large", with("1.10", "1e999"), "line 4|too large");
    cases.fixture("a number with a plus", with("1.10", "+1.10"), "line 4");
    cases.fixture("a number that begins with a point", with("1.10", ".10"), "line 4");
    cases.fixture("a number that ends with a point", with("1.10", "1."), "line 4");
    cases.fixture("a hexadecimal number", with("1.10", "0x11"), "line 4");
    cases.fixture("a number with a unit", with("1.10", "1.10 kg"), "line 4");
    cases.fixture("True of Python", with("1.10", "True"), "line 4|true, false or null");
    cases.fixture("two objects", format!("{TWO_BLOCKS}{TWO_BLOCKS}"), "ends before the file does|remove");
    cases.fixture("brackets without end", "[".repeat(5000), "deeper");
    cases.fixture("a line break in a text", with("two blocks", "two\nblocks"), "line |double quote");
    cases.fixture("a path with backslashes", with("two blocks", "C:\\data\\q"), "line 2|backslash");
    cases.fixture("UTF-16, little end first", utf16(TWO_BLOCKS, u16::to_le_bytes), "UTF-8");
    cases.fixture("UTF-16, big end first", utf16(TWO_BLOCKS, u16::to_be_bytes), "UTF-8");
    cases.fixture("Latin-1", b"{ \"name\": \"Br\xfccke\" }", "line 1|UTF-8");
    cases.fixture("zeros", [0_u8; 64], "line 1");
    cases.fixture("a picture", b"\x89PNG\r\n\x1a\n\0\0", "UTF-8");
    cases.fixture("a page", "<!DOCTYPE html><html></html>", "line 1, column 1");
    cases.fixture("a table", "body,mass\nA,1.1\n", "line 1, column 1");
    cases.fixture("a list", "[]", "an object");
    cases.fixture("null", "null", "an object");
    cases.fixture("a number", "42", "an object");
    cases.fixture("a text", "\"fixture\"", "an object");
    cases.fixture(
        "the recording",
        fs::read(cases.bench.0.join("text.uff")).unwrap(),
        "universal file|fixture first",
    );
    cases.fixture(
        "a key twice",
        with("\"mass\": 1.10,", "\"mass\": 1.10, \"mass\": 1.2,"),
        "`mass` stands twice|remove one",
    );
    cases.fixture("a body twice", with("\"B\": {", "\"A\": {"), "`A` stands twice|rename");
    cases.fixture("a point twice", with("\"4\": {", "\"3\": {"), "`3` stands twice|rename");
    cases.finish();
}

#[test]
fn a_fixture_that_cannot_be_is_refused_by_the_path_of_what_is_wrong() {
    let mut cases = Cases::new("bad-fixtures");
    for (from, to, words) in CHANGES {
        cases.changed(from, to, words);
    }
    cases.fixture("nothing in it", "{}", "`bodies` is missing");
    cases.fixture("no bodies", "{ \"bodies\": {}, \"points\": {} }", "bodies|there are no bodies|state one");
    cases.fixture("a list alone", "[1, 2]", "a list stands|jointscope init");
    cases.fixture(
        "a deviation below zero",
        TWO_BLOCKS.replacen("\"mass\": 1.10,", "\"mass\": {\"value\": 1.10, \"std\": -0.01},", 1),
        "bodies/A/mass/std|below zero|unknown",
    );
    cases.fixture("bodies in a list", "{ \"bodies\": [], \"points\": {} }", "bodies|a list stands|object");
    cases.finish();
}

/// What is changed in the good fixture, to what, and what is to be said.
const CHANGES: &[(&str, &str, &str)] = &[
    ("\"bodies\"", "\"Bodies\"", "did you mean `bodies`?"),
    ("\"points\"", "\"point\"", "did you mean `points`?"),
    ("\"joints\"", "\"jionts\"", "did you mean `joints`?"),
    ("\"damping\"", "\"dampign\"", "did you mean `damping`?"),
    ("\"name\"", "\"title\"", "`title` is unknown|the keys possible here"),
    ("\"mass\"", "\"masss\"", "bodies/A|did you mean `mass`?"),
    ("\"inertia\"", "\"intertia\"", "bodies/A|did you mean `inertia`?"),
    ("\"x_cg\"", "\"xcg\"", "bodies/A|did you mean `x_cg`?"),
    ("\"youngs_modulus\"", "\"young_modulus\"", "joints/J/beam|did you mean `youngs_modulus`?"),
    ("\"second_moment\"", "\"I\"", "joints/J/beam|`I` is unknown|second_moment"),
    ("\"loss_factor\"", "\"eta\"", "damping|`eta` is unknown"),
    ("\"from\": \"2\"", "\"form\": \"2\"", "joints/J|did you mean `from`?"),
    ("\"mass\": 1.10, ", "", "bodies/A|`mass`|missing"),
    ("\"inertia\": 9.5e-4, ", "", "bodies/A|`inertia` is missing"),
    (", \"x_cg\": -0.030", "", "bodies/A|`x_cg` is missing"),
    ("\"body\": \"A\", ", "", "points/1|`body` is missing"),
    (", \"x\": -0.060", "", "points/1|`x` is missing"),
    ("\"to\": \"3\", ", "", "joints/J|`to` is missing"),
    (", \"second_moment\": 3.67e-10", "", "joints/J/beam|`second_moment` is missing"),
    (
        ", \"beam\": { \"youngs_modulus\": 2.07e11, \"second_moment\": 3.67e-10 }",
        "",
        "joints/J|`beam`|`stiffness`",
    ),
    ("\"beam\": {", "\"stiffness\": [[1e6, 0], [0, 1e3]], \"beam\": {", "joints/J|`beam`|`stiffness`"),
    ("1.10", "-1.10", "bodies/A/mass|above zero"),
    ("1.10", "0", "bodies/A/mass|above zero"),
    ("1.10", "null", "bodies/A/mass|null stands where a number is needed"),
    ("1.10", "\"1.10 kg\"", "bodies/A/mass|the text \"1.10 kg\" stands where a number is needed"),
    ("1.10", "[1.10]", "bodies/A/mass|a list stands where a number is needed"),
    ("1.10", "true", "bodies/A/mass|stands where a number is needed"),
    ("1.10", "{}", "bodies/A/mass|`value` is missing"),
    ("1.10", "{ \"std\": 0.1 }", "bodies/A/mass|`value` is missing"),
    ("1.10", "{ \"value\": 1.10 }", "bodies/A/mass|`std` is missing"),
    ("1.10", "{ \"value\": 1.10, \"sdt\": 0.1 }", "bodies/A/mass|did you mean `std`?"),
    ("1.10", "{ \"value\": 1.10, \"std\": -0.1 }", "bodies/A/mass/std|below zero"),
    ("1.10", "{ \"value\": 1.10, \"std\": \"good\" }", "bodies/A/mass/std|a number or \"unknown\""),
    ("1.10", "{ \"value\": \"1.10\", \"std\": 0.1 }", "bodies/A/mass/value|stands where a number is needed"),
    ("9.5e-4", "-9.5e-4", "bodies/A/inertia|above zero"),
    ("9.5e-4", "0", "bodies/A/inertia|above zero"),
    ("\"x\": -0.060", "\"x\": \"left\"", "points/1/x|stands where a number is needed"),
    ("\"body\": \"A\"", "\"body\": 1", "points/1/body|a name in quotes is needed"),
    ("{ \"body\": \"A\", \"x\": -0.060 }", "-0.060", "points/1|stands where an object"),
    ("\"4\": { \"body\": \"B\"", "\"4\": { \"body\": \"C\"", "points/4|`C`|A, B"),
    ("\"4\": { \"body\": \"B\"", "\"4\": { \"body\": \"b\"", "points/4|`b`"),
    ("\"from\": \"2\"", "\"from\": \"7\"", "joints/J/from|`7`|1, 2, 3, 4"),
    ("\"to\": \"3\"", "\"to\": 3", "joints/J/to|a name in quotes is needed"),
    ("\"to\": \"3\"", "\"to\": \"2\"", "joints/J|a joint connects two bodies"),
    ("\"to\": \"3\"", "\"to\": \"1\"", "joints/J|a joint connects two bodies"),
    ("\"from\": \"2\", \"to\": \"3\"", "\"from\": \"3\", \"to\": \"2\"", "joints/J|wrong order"),
    ("\"x\": 0.065", "\"x\": 0.0", "joints/J|needs a length"),
    ("2.07e11", "0", "joints/J/beam/youngs_modulus|above zero"),
    ("2.07e11", "-2.07e11", "joints/J/beam/youngs_modulus|above zero"),
    ("3.67e-10", "-3.67e-10", "joints/J/beam/second_moment|above zero"),
    ("0.006", "-0.006", "damping|zero or above"),
    ("0.006", "\"small\"", "damping/loss_factor|stands where a number is needed"),
    ("\"loss_factor\": 0.006", "\"modal_ratios\": 0.01", "damping/modal_ratios|a list [..] is needed"),
    ("\"loss_factor\": 0.006", "\"modal_ratios\": [0.01, -0.01]", "damping/modal_ratios/1|zero or above"),
    ("\"loss_factor\": 0.006", "\"modal_ratios\": [2]", "damping/modal_ratios/0|1 % is written 0.01"),
    ("\"loss_factor\": 0.006", "\"rayleigh\": { \"mas\": 1 }", "damping/rayleigh|did you mean `mass`?"),
    (
        "\"loss_factor\": 0.006",
        "\"rayleigh\": { \"mass\": -1, \"stiffness\": 0 }",
        "damping/rayleigh/mass|zero or above",
    ),
    ("\"loss_factor\": 0.006", "\"loss_factor\": 0.006, \"modal_ratios\": [0.01]", "damping"),
    ("\"loss_factor\": 0.006", "\"modal_ratios\": [0.01], \"of\": \"all\"", "damping/of|`\"of\": \"free\"`"),
    ("{ \"loss_factor\": 0.006 }", "0.006", "damping|an object {..} is needed"),
    (
        "\"damping\"",
        "\"supports\": { \"S\": { \"point\": \"1\" } }, \"damping\"",
        "supports/S|`stiffness` is missing",
    ),
    (
        "\"damping\"",
        "\"supports\": { \"S\": { \"point\": \"9\", \"stiffness\": 10 } }, \"damping\"",
        "supports/S/point|`9`|1, 2, 3, 4",
    ),
    ("\"damping\"", "\"supports\": { \"S\": { \"stiffness\": 10 } }, \"damping\"", "supports/S"),
    (
        "\"damping\"",
        "\"supports\": { \"S\": { \"point\": \"1\", \"stiffness\": -10 } }, \"damping\"",
        "supports/S/stiffness",
    ),
    (
        "\"damping\"",
        "\"supports\": { \"S\": { \"body\": \"C\", \"x\": 0, \"stiffness\": 10 } }, \"damping\"",
        "supports/S/body|`C`",
    ),
    ("\"damping\"", "\"supports\": [], \"damping\"", "supports|a list stands"),
    ("\"damping\"", "\"physics\": {}, \"damping\"", "physics|a list [..] is needed"),
    ("\"damping\"", "\"physics\": [{}], \"damping\"", "physics/0|`kind` is missing"),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"ghost\" }], \"damping\"",
        "physics/0/kind|`ghost`|the effects are",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mas\" }], \"damping\"",
        "physics/0/kind|did you mean `added_mass`?",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mass\" }], \"damping\"",
        "physics/0|`place` is missing",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mass\", \"place\": \"C\", \"x\": 0, \"mass\": 1 }], \"damping\"",
        "physics/0/place|`C`|A, B",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mass\", \"place\": \"B\", \"x\": 0.1 }], \"damping\"",
        "physics/0|`mass` is missing",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mass\", \"place\": \"B\", \"x\": 0.1, \"mass\": \"1 g\" }], \"damping\"",
        "physics/0/mass|a number is needed",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"added_mass\", \"place\": \"B\", \"x\": 0.1, \"mas\": 1 }], \"damping\"",
        "physics/0|did you mean `mass`?",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"joint_mass\", \"place\": \"K\", \"mass\": 1 }], \"damping\"",
        "physics/0/place|`K`",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"interface_compliance\", \"place\": \"2\", \"dof\": \"x\", \"stiffness\": 1 }], \"damping\"",
        "physics/0/dof|`translation`|`rotation`",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"interface_compliance\", \"place\": \"2\", \"stiffness\": 1 }], \"damping\"",
        "physics/0|`dof` is missing",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"channel_gain\", \"place\": \"sensor 3\", \"factor\": 2 }], \"damping\"",
        "physics/0/place|response",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"channel_gain\", \"place\": \"response 9\", \"factor\": 2 }], \"damping\"",
        "physics/0/place|`9`",
    ),
    (
        "\"damping\"",
        "\"physics\": [{ \"kind\": \"bypass\", \"place\": \"A/A\", \"x_from\": 0, \"x_to\": 0.1, \"stiffness\": 1 }], \"damping\"",
        "physics/0/place",
    ),
    ("\"damping\"", "\"channels\": { \"sensor 3\": {} }, \"damping\"", "channels"),
    (
        "\"damping\"",
        "\"channels\": { \"response 3\": { \"gian\": 1 } }, \"damping\"",
        "channels|did you mean `gain`?",
    ),
    ("\"damping\"", "\"model_error\": { \"frequency\": -1 }, \"damping\"", "model_error/frequency"),
    (
        "\"damping\"",
        "\"model_error\": { \"frequencies\": 1 }, \"damping\"",
        "model_error|did you mean `frequency`?",
    ),
    ("\"damping\"", "\"notes\": 3, \"damping\"", "notes"),
    ("\"x_cg\": -0.030", "\"x_cg\": -0.030, \"rotates\": \"no\"", "bodies/A/rotates"),
    (
        "\"x_cg\": -0.030",
        "\"x_cg\": -0.030, \"masses\": [{ \"x\": 0, \"mass\": -1 }]",
        "bodies/A/masses/0/mass|zero or above",
    ),
    (
        "\"x_cg\": -0.030",
        "\"x_cg\": -0.030, \"masses\": [{ \"mass\": 1 }]",
        "bodies/A/masses/0|`x` is missing",
    ),
    (
        "\"mass\": 1.10, \"inertia\": 9.5e-4, \"x_cg\": -0.030",
        "\"beam\": { \"from\": 0, \"to\": -0.1, \"youngs_modulus\": 2e11, \"second_moment\": 1e-9, \"mass_per_length\": 1 }",
        "bodies/A/beam",
    ),
    (
        "\"mass\": 1.10, \"inertia\": 9.5e-4, \"x_cg\": -0.030",
        "\"beam\": { \"from\": -0.05, \"to\": 0, \"youngs_modulus\": 2e11, \"second_moment\": 1e-9, \"mass_per_length\": 1 }",
        "points/1|not on the beam `A`",
    ),
    (
        "\"mass\": 1.10, \"inertia\": 9.5e-4, \"x_cg\": -0.030",
        "\"beam\": { \"from\": -0.06, \"to\": 0, \"youngs_modulus\": 2e11, \"second_moment\": 1e-9, \"mass_per_length\": 0 }",
        "bodies/A/beam/mass_per_length|above zero",
    ),
];

#[test]
fn a_file_that_is_no_recording_is_told_what_it_is_taken_for() {
    let mut cases = Cases::new("bad-files");
    let text = cases.bench.text("text.uff");
    let utf16: Vec<u8> =
        std::iter::once(0xfeff_u16).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    cases.recording("nothing", "", "empty|export it again");
    cases.recording("a blank line", "\n", "empty");
    cases.recording("a word", "hello\n", "no universal file|`hello`");
    cases.recording("the fixture", TWO_BLOCKS, "JSON|recording is expected");
    cases.recording("a picture", b"\x89PNG\r\n\x1a\n\0\0\0\0", "neither a universal file");
    cases.recording("an archive", b"PK\x03\x04\0\0\0\0", "ZIP|unpack it");
    cases.recording("zeros", [0_u8; 512], "neither a universal file");
    cases.recording("UTF-16", utf16, "UTF-16|UTF-8");
    cases.recording("line ends of carriage returns", text.replace('\n', "\r"), "LF");
    cases.recording("a page", "<!DOCTYPE html><html><body>404</body></html>", "no universal file");
    cases.recording("a table without a header", "1,2,3\n2,3,4\n", "header");
    cases.recording(
        "a table with a word among numbers",
        "frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,x,4\n",
        "line 3|`x`",
    );
    cases.recording("a table with a short row", "frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,3\n", "line 3");
    cases.recording(
        "a table without units",
        "frequency [Hz],4/1 real,4/1 imag\n1,2,3\n2,3,3\n",
        "--assume-units m/s^2,N",
    );
    cases.recording("a table of one part", "frequency [Hz],4/1 real\n1,2\n2,3\n", "4/1");
    cases.recording("a cut MATLAB file", b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MAT-file|copy or save");
    cases.recording("a header alone", "    -1\n   151\nmodel\n    -1\n", "no FRF|dataset 151");
    cases.finish();
}

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

#[test]
fn arguments_that_cannot_be_are_refused_with_what_is_meant() {
    let mut cases = Cases::new("bad-arguments");
    fs::create_dir(cases.bench.0.join("folder")).unwrap();
    cases.bench.write("broken.json", "{");
    for (line, words) in ARGUMENTS {
        let arguments: Vec<&str> = line.split(' ').filter(|word| !word.is_empty()).collect();
        cases.refused(line, &arguments, words);
    }
    cases.finish();
}

/// Command lines and what is to be said.
const ARGUMENTS: &[(&str, &str)] = &[
    ("", "no command|jointscope --help"),
    ("frobnicate", "`jointscope --help`|frobnicate"),
    ("diagnos two.json frf.uff", "'diagnose'"),
    ("diagnose", "required|<FIXTURE"),
    ("diagnose two.json -o out", "no recordings were given|after the fixture"),
    ("diagnose two.json frf.uff --otput out", "--output"),
    ("diagnose text.uff two.json -o out", "text.uff|universal file|fixture first"),
    ("decompose text.uff two.json -o out", "text.uff|fixture first"),
    ("check text.uff two.json", "text.uff|fixture first"),
    ("check text.uff", "text.uff|fixture first"),
    ("plan text.uff two.json", "two.json|no diagnosis.json"),
    ("synthesize text.uff -o o.uff", "text.uff|fixture first"),
    ("fem text.uff -o o.uff", "text.uff|fixture first"),
    ("simulate text.uff --force two.json -o o.uff", "text.uff|fixture first"),
    ("check folder", "folder|directory where a file is needed|name the file"),
    ("check two.json folder", "folder|directory where a file is needed"),
    ("diagnose two.json folder -o out", "folder|directory where a file is needed"),
    ("modes folder -o out", "folder|directory where a file is needed"),
    ("show folder", "folder|directory where a file is needed"),
    ("estimate folder -o o.uff", "folder|directory where a file is needed"),
    ("check gone.json", "gone.json|no such file|check the path"),
    ("show gone.uff", "gone.uff|no such file"),
    ("modes two.json -o out", "two.json|JSON|recording is expected"),
    ("show two.json", "two.json|JSON|recording is expected"),
    ("estimate two.json -o o.uff", "two.json|JSON|recording is expected"),
    ("estimate frf.uff -o o.uff", "frf.uff|no time histories|4 FRFs"),
    ("simulate two.json --force frf.uff -o o.uff", "frf.uff|no time histories"),
    ("fem two.json -o o.uff", "two.json|`geometry`"),
    ("compare folder -o out", "folder|no stiffness.json|jointscope decompose"),
    ("compare . -o out", "no stiffness.json|jointscope decompose"),
    ("compare two.json -o out", "two.json"),
    ("compare folder folder -o out", "the same directory"),
    ("compare gone -o out", "gone/stiffness.json|no such file"),
    ("plan two.json folder", "folder|no diagnosis.json|jointscope diagnose"),
    ("export folder --to nastran -o o.bdf", "folder|neither stiffness.json nor diagnosis.json"),
    ("export two.json --to nastran -o o.bdf", "two.json|neither"),
    ("export broken.json --to nastran -o o.bdf", "broken.json|neither"),
    ("export folder --to catia -o o.bdf", "catia|nastran"),
    ("summary folder", "folder|no cases.json"),
    ("decompose two.json frf.uff --band 800:200 -o out", "--band|the lower first"),
    ("decompose two.json frf.uff --band 800 -o out", "--band|the lower first"),
    ("decompose two.json frf.uff --band a:b -o out", "--band|in Hz"),
    ("decompose two.json frf.uff --band 5000:6000 -o out", "frf.uff|100 to 900 Hz"),
    ("decompose two.json frf.uff --joint K -o out", "two.json|`K`|J"),
    ("decompose two.json frf.uff --relation papr -o out", "papr|paper"),
    ("decompose two.json frf.uff --map 1=2 -o out", "--map|101:+z=1:+y"),
    ("decompose two.json frf.uff --map 1:+z=7:+y -o out", "`7`|1, 2, 3, 4"),
    ("decompose two.json frf.uff --map +z=+y -o out", "`+z=+y` applies to no channel|1:+y"),
    ("decompose two.json frf.uff --map -z=+y -o out", "minus on the right|`--map z=-y`"),
    ("decompose two.json frf.uff --map -rz=+theta -o out", "minus on the right|`--map rz=-theta`"),
    ("decompose two.json frf.uff --map z=x -o out", "--map|`x`|y, theta of a fixture"),
    ("decompose two.json frf.uff --map *:+y=1:+y -o out", "`*:+y=1:+y`|once on both sides"),
    ("decompose two.json frf.uff --map y=y +y=-y -o out", "`y=y` and `+y=-y`|leave one out"),
    ("decompose two.json frf.uff --assume-units bananas -o out", "`bananas`|g,lbf"),
    ("decompose two.json frf.uff frf.uff -o out", "given already|leave one"),
    ("decompose two.json frf.uff -o two.json", "two.json"),
    ("diagnose two.json frf.uff --hold-out 9/9 -o out", "9/9|--hold-out"),
    ("diagnose two.json frf.uff --hold-out 41 -o out", "response over reference"),
    ("diagnose two.json frf.uff --exclude 0:5000 -o out", "frf.uff|--exclude"),
    ("diagnose two.json frf.uff --time-limit -3 -o out", "above zero"),
    ("diagnose two.json frf.uff --time-limit soon -o out", "above zero"),
    ("diagnose two.json frf.uff --baseline two.json -o out", "two.json|JSON"),
    ("diagnose two.json frf.uff --baseline gone.uff -o out", "gone.uff|no such file"),
    ("diagnose two.json frf.uff --also pdf -o out", "pdf|csv"),
    ("diagnose two.json frf.uff --averages 0 -o out", "--averages"),
    ("synthesize two.json --lines 100:10:1 -o o.uff", "--lines|below the first"),
    ("synthesize two.json --lines 10:100:0 -o o.uff", "--lines|above 0 Hz"),
    ("synthesize two.json --lines 10:1e9:0.0001 -o o.uff", "--lines|larger step"),
    ("synthesize two.json --lines ten -o o.uff", "--lines"),
    ("synthesize two.json --noise -1 -o o.uff", "--noise|above zero"),
    ("synthesize two.json --noise 1 --seed -4 -o o.uff", "--seed"),
    ("synthesize two.json --noise 1 --averages -2 -o o.uff", "--averages"),
    ("synthesize two.json --frf 9/1 -o o.uff", "`9`|1, 2, 3, 4"),
    ("synthesize two.json --frf 41 -o o.uff", "response over reference"),
    ("synthesize two.json", "--output"),
    ("synthesize two.json -o folder", "folder"),
    ("synthesize two.json -o two.json/o.uff", "two.json"),
    ("check frf.uff", "frf.uff|is a universal file|the fixture first"),
    ("diagnose frf.uff two.json -o out", "frf.uff|is a universal file|the fixture first"),
    ("diagnose text.uff two.json -o out", "text.uff|is a universal file|the fixture first"),
    ("synthesize two.json -o two.json", "two.json"),
    ("compare two.json frf.uff -o out", "two.json|is a file|jointscope decompose"),
    ("export two.json --to csv -o out", "two.json|jointscope decompose"),
    ("init", "--output"),
    ("init --blocks a -o i.json", "60x40x6:steel"),
    ("init --blocks 60x40x0:steel -o i.json", "above zero"),
    ("init --blocks 60x40x6:cheese -o i.json", "cheese"),
    ("prove --cases few -o out", "--cases takes a whole number|not \"few\""),
    ("prove --solid=-1 -o out", "--solid takes a whole number of zero or more|not \"-1\""),
    ("prove --seed 99999999999999999999 -o out", "--seed takes no number as large"),
    ("diagnose two.json frf.uff --averages few -o out", "--averages takes a whole number"),
    ("diagnose many.csv --jobs 1.5 -o out", "--jobs takes a whole number"),
    ("diagnose many.csv --jobs 0 -o out", "--jobs takes a whole number from 1 to 1024|not \"0\""),
    ("fem two.json --growth fast -o o.uff", "--growth takes a number|not \"fast\""),
    ("prove --recordings folder -o out", "folder"),
    ("tables more", "more"),
    ("completions klingon", "klingon|bash"),
];
