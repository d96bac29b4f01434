//! Files in: every fault a sentence that starts with the file's name.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::io::Read;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use jointscope::fixture::Fixture;
use jointscope::import::{self, ColumnMap};
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
    files.iter().map(|path| name(path)).collect::<Vec<_>>().join(", ")
}

/// A file's name in messages; `-` is standard input.
pub fn name(path: &Path) -> String {
    if is_standard_input(path) { "standard input".to_owned() } else { path.display().to_string() }
}

fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Refuses standard input that is given twice.
pub fn once<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), Refusal> {
    match files.into_iter().filter(|path| is_standard_input(path)).count() {
        0 | 1 => Ok(()),
        _ => Err(Refusal::new("standard input (`-`) is given twice; it can be read once")),
    }
}

/// Reads the recordings of a test, whatever their formats; with the entries of `columns` that were of no use.
pub fn sources(files: &[PathBuf], columns: &ColumnMap) -> Result<(Vec<Source>, Vec<String>), Refusal> {
    once(files)?;
    let mut used = BTreeSet::new();
    let mut sources = Vec::with_capacity(files.len());
    for path in files {
        let name = name(path);
        let imported =
            import::read(&bytes(path)?, &name, columns).map_err(|error| Refusal::about(&name, error))?;
        used.extend(imported.used);
        sources.push(Source { name, file: imported.file });
    }
    let unused = columns.entries().iter().enumerate().filter(|(at, _)| !used.contains(at));
    let unused = unused.map(|(_, entry)| entry.text.clone()).collect();
    Ok((sources, unused))
}

/// Reads a recording that says all that there is to know of it.
pub fn source(path: &Path) -> Result<Source, Refusal> {
    let (mut sources, _) = sources(std::slice::from_ref(&path.to_owned()), &ColumnMap::default())?;
    sources.pop().ok_or_else(|| Refusal::at(path, "holds nothing"))
}

/// Reads a JSON file.
pub fn json(path: &Path) -> Result<Value, Refusal> {
    let text = fs::read_to_string(path).map_err(|error| Refusal::io(path, &error))?;
    serde_json::from_str(without_mark(&text)).map_err(|error| Refusal::at(path, error))
}

/// Reads a file, or standard input, which is kept: its hash is told of it, too.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    static STANDARD_INPUT: OnceLock<Vec<u8>> = OnceLock::new();
    if !is_standard_input(path) {
        return whole(path);
    }
    if let Some(bytes) = STANDARD_INPUT.get() {
        return Ok(bytes.clone());
    }
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .read_to_end(&mut bytes)
        .map_err(|error| Refusal::about("standard input", error))?;
    Ok(STANDARD_INPUT.get_or_init(|| bytes).clone())
}

/// What may be read of something that is no file of a known length, such as a pipe or a device, bytes.
const ENDLESS: u64 = 1 << 30;

/// Reads a file; what has no length of its own is refused where it does not end.
fn whole(path: &Path) -> Result<Vec<u8>, Refusal> {
    let failed = |error: std::io::Error| Refusal::io(path, &error);
    let file = fs::File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_file() {
        return fs::read(path).map_err(failed);
    }
    bounded(file, ENDLESS).map_err(failed)?.ok_or_else(|| {
        Refusal::at(path, "is no file but a device or pipe of more than 1 GiB; save it to a file first")
    })
}

/// What `source` holds; `None` where that is more than `most` bytes.
fn bounded(source: impl Read, most: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    source.take(most + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// A byte order mark is no JSON, but editors leave one.
fn without_mark(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_ends_is_not_read_to_its_end() {
        assert_eq!(bounded(std::io::repeat(0), 1000).unwrap(), None);
        assert_eq!(bounded(&b"four"[..], 4).unwrap().as_deref(), Some(&b"four"[..]));
    }
}
