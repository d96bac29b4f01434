//! Inputs that go wrong, by the hundred, in tables by what is wrong: each through the program, which must
//! refuse it in one plain sentence that says where and what to do, and leave the directory as it was.
//!
//! A case is a flaw in a good pair (two blocks and their FRFs) and words that the sentence must have. All
//! cases of a table are run before it fails.

mod arguments;
mod fixtures;
mod keys;
mod recordings;
mod syntax;

use std::fmt::Write;

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

    /// The good fixture with further keys.
    fn added(&mut self, keys: &str, words: &str) {
        self.changed(r#""damping""#, &format!(r#"{keys}, "damping""#), words);
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
