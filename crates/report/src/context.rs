//! Where a page comes from, as every page states it.

use jointscope_estimation::Estimate;
use jointscope_fixture::Fixture;
use jointscope_hits::Hit;

use crate::Foot;

/// Where a page comes from: what its foot states, and what was noticed on the way.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PageContext {
    /// The program and its version.
    pub program: String,
    /// The command line.
    pub command: String,
    /// The files that were read.
    pub inputs: Vec<InputFile>,
    /// Remarks from reading the recordings, one plain sentence each.
    pub notes: Vec<String>,
    /// The hammer hits, where the FRFs were estimated from them; shown before anything else.
    pub hits: Option<HammerTest>,
}

/// Hammer hits and what was estimated from them.
#[derive(Debug, Clone, PartialEq)]
pub struct HammerTest {
    /// The hits.
    pub hits: Vec<Hit>,
    /// FRFs, and what became of each hit.
    pub estimate: Estimate,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputFile {
    /// Its name.
    pub name: String,
    /// SHA-256 of its contents, in hexadecimal digits.
    pub sha256: String,
}

impl PageContext {
    /// The fixture's name and the recordings.
    pub(crate) fn subtitle(&self, fixture: &Fixture) -> String {
        let recordings: Vec<&str> = self.inputs.iter().skip(1).map(|input| input.name.as_str()).collect();
        match (fixture.name(), recordings.as_slice()) {
            (name, []) => name.to_owned(),
            ("", files) => files.join(", "),
            (name, files) => format!("{name} · {}", files.join(", ")),
        }
    }

    /// The recordings; the first input is none of them where a fixture was read.
    pub(crate) fn recordings(&self, fixture: bool) -> String {
        let files = self.inputs.iter().skip(usize::from(fixture)).map(|input| input.name.as_str());
        files.collect::<Vec<_>>().join(", ")
    }

    /// Program, command line and the inputs' hashes.
    pub(crate) fn foot(&self) -> Foot {
        let mut foot = Foot::new(&self.program);
        if !self.command.is_empty() {
            foot = foot.command(&self.command);
        }
        self.inputs
            .iter()
            .fold(foot, |foot, input| foot.input(&input.name, format!("sha256 {}", input.sha256)))
    }
}
