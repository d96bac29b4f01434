//! Files in: every fault a sentence that starts with the file's name.

use std::fmt;
use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};

use jointscope::fixture::Fixture;
use jointscope::recordings::Source;
use serde_json::Value;

use crate::refusal::Refusal;

/// A fixture with the path of its file.
pub struct FixtureFile {
    /// What the file says.
    pub fixture: Fixture,
    /// Where it was read from.
    pub path: PathBuf,
}

impl FixtureFile {
    /// Reads a fixture file.
    pub fn read(path: &Path) -> Result<Self, Refusal> {
        let bytes = bytes(path)?;
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
            Refusal::at(path, format_args!("line {line} is not UTF-8 text; save the fixture as UTF-8"))
        })?;
        let fixture = Fixture::from_json(without_mark(text)).map_err(|error| Refusal::at(path, error))?;
        Ok(FixtureFile { fixture, path: path.to_owned() })
    }

    /// A sentence about the fixture.
    pub fn refusal(&self, problem: impl fmt::Display) -> Refusal {
        Refusal::at(&self.path, problem)
    }
}

impl Deref for FixtureFile {
    type Target = Fixture;

    fn deref(&self) -> &Fixture {
        &self.fixture
    }
}

/// The files' names for a message about all of them.
pub fn names(files: &[PathBuf]) -> String {
    files.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// Reads a universal file.
pub fn source(path: &Path) -> Result<Source, Refusal> {
    let file = jointscope::uff::read(&bytes(path)?).map_err(|error| Refusal::at(path, error))?;
    Ok(Source { name: path.display().to_string(), file })
}

/// Reads a JSON file.
pub fn json(path: &Path) -> Result<Value, Refusal> {
    let text = fs::read_to_string(path).map_err(|error| Refusal::io(path, &error))?;
    serde_json::from_str(without_mark(&text)).map_err(|error| Refusal::at(path, error))
}

/// Reads a file.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    fs::read(path).map_err(|error| Refusal::io(path, &error))
}

/// A byte order mark is no JSON, but editors leave one.
fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}
