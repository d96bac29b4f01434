//! Files in: every fault a sentence that starts with the file's name.
//!
//! Whatever is read is noted with the SHA-256 of the bytes that were handed out, so that an answer states
//! what it was made of, be it a pipe that is read out or a file that has changed since. One run knows one
//! version of a file: where a second reading finds another, it is refused.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs;
use std::io::Read;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use jointscope::fixture::Fixture;
use jointscope::import::{self, ColumnMap, Format};
use jointscope::recordings::Source;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::names::{is_standard_input, name};
use crate::refusal::Refusal;
use crate::replacing;

/// A fixture with the path of its file.
pub(crate) struct FixtureFile {
    /// What the file says.
    pub fixture: Fixture,
    /// Where it was read from.
    pub path: PathBuf,
}

impl FixtureFile {
    /// Reads a fixture file.
    pub(crate) fn read(path: &Path) -> Result<Self, Refusal> {
        let bytes = bytes(path)?;
        let recording = match Format::of(&bytes) {
            Ok(Format::Universal) => Some("universal"),
            Ok(Format::Mat5 | Format::Mat73) => Some("MATLAB"),
            _ => None,
        };
        if let Some(kind) = recording {
            let problem = format_args!(
                "is a {kind} file, a recording and no fixture; give the fixture first and then its recordings"
            );
            return Err(Refusal::at(path, problem));
        }
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
            Refusal::at(path, format_args!("line {line} is not UTF-8 text; save the fixture as UTF-8"))
        })?;
        let fixture =
            Fixture::from_json(text.trim_start_matches(MARK)).map_err(|error| Refusal::at(path, error))?;
        Ok(FixtureFile { fixture, path: path.to_owned() })
    }

    /// A sentence about the fixture.
    pub(crate) fn refusal(&self, problem: impl fmt::Display) -> Refusal {
        Refusal::at(&self.path, problem)
    }
}

impl Deref for FixtureFile {
    type Target = Fixture;

    fn deref(&self) -> &Fixture {
        &self.fixture
    }
}

/// Reads the recordings of a test, whatever their formats; with the entries of `columns` that were of no use.
pub(crate) fn sources(files: &[PathBuf], columns: &ColumnMap) -> Result<(Vec<Source>, Vec<String>), Refusal> {
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
pub(crate) fn source(path: &Path) -> Result<Source, Refusal> {
    let (mut sources, _) = sources(std::slice::from_ref(&path.to_owned()), &ColumnMap::default())?;
    sources.pop().ok_or_else(|| Refusal::at(path, "holds nothing"))
}

/// Reads a JSON file.
pub(crate) fn json(path: &Path) -> Result<Value, Refusal> {
    parsed(path, &bytes(path)?)
}

/// Reads a JSON file that this very run may write: nothing is noted of it.
pub(crate) fn answer(path: &Path) -> Result<Value, Refusal> {
    parsed(path, &whole(path)?.0)
}

/// The bytes of a file as JSON.
pub(crate) fn parsed(path: &Path, bytes: &[u8]) -> Result<Value, Refusal> {
    if replacing::is_unfinished(path) {
        return Err(Refusal::at(
            path,
            "may not belong to the files beside it, for the run that wrote them was ended in the middle; run that command again",
        ));
    }
    serde_json::from_slice(bytes.strip_prefix(MARK.as_bytes()).unwrap_or(bytes))
        .map_err(|error| Refusal::at(path, broken(&error)))
}

/// What is wrong with a file that a command wrote, and what to do.
fn broken(error: &serde_json::Error) -> String {
    let (line, column) = (error.line(), error.column());
    let what = match error.is_eof() {
        true => "ends in the middle,",
        false => "is no JSON, or none any more,",
    };
    format!("{what} at line {line}, column {column}; make the file anew with the command that wrote it")
}

/// What was read.
struct Taken {
    sha256: String,
    /// A pipe, which is empty now.
    is_pipe: bool,
}

static TAKEN: Mutex<BTreeMap<PathBuf, Taken>> = Mutex::new(BTreeMap::new());

/// Reads a file or standard input, and notes what was read.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    let taken = || TAKEN.lock().unwrap_or_else(PoisonError::into_inner);
    if taken().get(path).is_some_and(|before| before.is_pipe) {
        return Err(Refusal::at(path, "is given twice, and what is no file can be read once"));
    }
    let (bytes, is_pipe) = whole(path)?;
    let sha256 = digest(&bytes);
    match taken().entry(path.to_owned()).or_insert_with(|| Taken { sha256: sha256.clone(), is_pipe }) {
        before if before.sha256 == sha256 => Ok(bytes),
        _ => Err(Refusal::at(
            path,
            "has changed since this run read it first; run the command again when nothing writes to it",
        )),
    }
}

/// The SHA-256 of what was read of a file, which is read where it has not been.
pub(crate) fn sha256(path: &Path) -> Result<String, Refusal> {
    let noted =
        TAKEN.lock().unwrap_or_else(PoisonError::into_inner).get(path).map(|taken| taken.sha256.clone());
    noted.map_or_else(|| bytes(path).map(|bytes| digest(&bytes)), Ok)
}

/// The SHA-256 of bytes, in hexadecimal digits.
pub(crate) fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What may be read of something that is no file of a known length, such as a pipe or a device, bytes.
const ENDLESS: u64 = 1 << 30;

/// Reads a file, and whether it is none but a pipe or device; what has no length of its own is refused where
/// it does not end.
fn whole(path: &Path) -> Result<(Vec<u8>, bool), Refusal> {
    let failed = |error: std::io::Error| Refusal::io(path, &error);
    let contents = if is_standard_input(path) {
        bounded(std::io::stdin().lock(), ENDLESS)
    } else {
        let mut file = fs::File::open(path).map_err(failed)?;
        if file.metadata().map_err(failed)?.is_file() {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map_err(failed)?;
            return Ok((bytes, false));
        }
        bounded(file, ENDLESS)
    };
    let contents = contents.map_err(failed)?.ok_or_else(|| {
        Refusal::at(path, "is no file but a device or pipe of more than 1 GiB; save it to a file first")
    })?;
    Ok((contents, true))
}

/// What `source` holds; `None` where that is more than `most` bytes.
fn bounded(source: impl Read, most: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    source.take(most + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// A byte order mark is no JSON, but editors leave one.
const MARK: &str = "\u{feff}";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_ends_is_not_read_to_its_end() {
        assert_eq!(bounded(std::io::repeat(0), 1000).unwrap(), None);
        assert_eq!(bounded(&b"four"[..], 4).unwrap().as_deref(), Some(&b"four"[..]));
    }
}
