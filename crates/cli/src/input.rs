//! Files in: fixtures and recordings, every fault a sentence that starts with the file's name.

use std::fs;
use std::path::{Path, PathBuf};

use jointscope_fixture::Fixture;
use jointscope_recordings::{Recording, RecordingError, Source};
use jointscope_report::{HammerTest, InputFile, PageContext};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::arguments::RecordingArguments;
use crate::refusal::Refusal;

/// Reads a fixture file.
pub fn fixture(path: &Path) -> Result<Fixture, Refusal> {
    let bytes = bytes(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
        Refusal::at(path, format_args!("line {line} is not UTF-8 text; save the fixture as UTF-8"))
    })?;
    // A byte order mark is no JSON, but editors leave one.
    Fixture::from_json(text.trim_start_matches('\u{feff}')).map_err(|error| Refusal::at(path, error))
}

/// Reads the files of a test against the fixture `fixture`, read from `fixture_path`.
pub fn recording(
    arguments: &RecordingArguments,
    fixture: &Fixture,
    fixture_path: &Path,
) -> Result<Recording, Refusal> {
    let options = arguments.options()?;
    Recording::of(&sources(arguments)?, fixture, &options)
        .map_err(|error| refusal(error, &arguments.files, Some(fixture_path)))
}

/// Reads the files of a test of a structure that no fixture describes.
pub fn recording_of_nodes(arguments: &RecordingArguments) -> Result<Recording, Refusal> {
    let options = arguments.options()?;
    Recording::of_nodes(&sources(arguments)?, &options)
        .map_err(|error| refusal(error, &arguments.files, None))
}

/// Reads the files of a test.
pub fn sources(arguments: &RecordingArguments) -> Result<Vec<Source>, Refusal> {
    arguments.files.iter().map(|path| source(path)).collect()
}

/// The refusal of a recording that does not suit the fixture read from `fixture_path`, if there is one.
pub fn refusal(error: RecordingError, files: &[PathBuf], fixture_path: Option<&Path>) -> Refusal {
    use RecordingError as Error;
    match error {
        Error::MapPoint { .. } => Refusal::at(fixture_path.unwrap_or(Path::new("the map")), error),
        // These name their files, and the function in them.
        Error::Function { .. }
        | Error::Twice { .. }
        | Error::Lines { .. }
        | Error::Windows { .. }
        | Error::OnlyTimeHistories { .. }
        | Error::NoFrf { .. }
        | Error::NotPerForce { .. } => Refusal::new(error),
        _ => Refusal::new(format_args!("{}: {error}", names(files))),
    }
}

/// The files' names for a message about all of them.
pub fn names(files: &[PathBuf]) -> String {
    files.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// A file's name and the SHA-256 of its contents.
pub fn hash(path: &Path) -> Result<InputFile, Refusal> {
    let digest = Sha256::digest(bytes(path)?);
    let sha256 = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(InputFile { name: path.display().to_string(), sha256 })
}

/// What a page says of its origin: program, command, inputs, notes and hits.
pub fn context<'a>(
    files: impl Iterator<Item = &'a PathBuf>,
    notes: Vec<String>,
    hits: Option<HammerTest>,
) -> Result<PageContext, Refusal> {
    Ok(PageContext {
        program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
        command: command_line(),
        inputs: files.map(|path| hash(path)).collect::<Result<_, _>>()?,
        notes,
        hits,
    })
}

/// Adds to a file's contents what they were made from.
pub fn add_origin(answer: &mut Value, context: &PageContext) {
    answer["notes"] = json!(context.notes);
    answer["made"] = json!({
        "program": context.program,
        "command": context.command,
        "inputs": context.inputs.iter().map(|i| json!({"file": i.name, "sha256": i.sha256})).collect::<Value>(),
    });
}

/// The command as it was typed; the program by its name alone, wherever it lies.
pub fn command_line() -> String {
    let quoted = |word: String| if word.contains([' ', '"', '\'']) { format!("{word:?}") } else { word };
    let arguments = std::env::args_os().skip(1).map(|word| quoted(word.to_string_lossy().into_owned()));
    std::iter::once("jointscope".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Reads a universal file.
pub fn source(path: &Path) -> Result<Source, Refusal> {
    let file = jointscope_uff::read(&bytes(path)?).map_err(|error| Refusal::at(path, error))?;
    Ok(Source { name: path.display().to_string(), file })
}

fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    fs::read(path).map_err(|error| Refusal::io(path, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    use jointscope_recordings::{Recording, to_datasets};
    use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
    use jointscope_uff::Encoding;

    const FIXTURE: &str = r#"{ "bodies": { "A": { "mass": 2.0, "rotates": false } },
        "points": { "1": { "body": "A", "x": 0 } } }"#;

    /// A directory with one FRF between the points of this name, removed afterwards.
    struct Bench(PathBuf);

    impl Bench {
        fn new(name: &str, point: &str) -> Self {
            let path = std::env::temp_dir().join(format!("jointscope-input-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            let lines = SpectralLines::even(10.0, 1.0, 50).unwrap();
            let values = vec![0.5.into(); 50];
            let pairs = vec![FrfPair::transverse(point, point)];
            let frfs = FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap();
            let datasets = to_datasets(&frfs, "one block", Encoding::default()).unwrap();
            fs::write(path.join("f.uff"), jointscope_uff::write(&datasets).unwrap()).unwrap();
            Bench(path)
        }

        fn read(&self, file: &str, map: &[&str]) -> Result<Recording, String> {
            let arguments = RecordingArguments {
                files: vec![self.0.join(file)],
                map: map.iter().map(|entry| entry.to_string()).collect(),
                assume_units: None,
            };
            let fixture = Fixture::from_json(FIXTURE).unwrap();
            let read = |sources: Vec<Source>| {
                let options = arguments.options()?;
                Recording::of(&sources, &fixture, &options)
                    .map_err(|error| refusal(error, &arguments.files, Some(Path::new("one.json"))))
            };
            sources(&arguments).and_then(read).map_err(|refusal| refusal.to_string())
        }
    }

    impl Drop for Bench {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn holds(message: &str, parts: &[&str]) {
        parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is missing from: {message}"));
    }

    #[test]
    fn a_recording_is_read_against_the_fixture() {
        let bench = Bench::new("good", "1");
        assert_eq!(bench.read("f.uff", &[]).unwrap().frfs().unwrap().pairs().len(), 1);
    }

    #[test]
    fn a_truncated_recording_names_file_and_dataset() {
        let bench = Bench::new("truncated", "1");
        let whole = fs::read(bench.0.join("f.uff")).unwrap();
        fs::write(bench.0.join("f.uff"), &whole[..whole.len() - 100]).unwrap();
        holds(&bench.read("f.uff", &[]).unwrap_err(), &["f.uff: dataset 1", "800 bytes"]);
    }

    #[test]
    fn a_missing_recording_and_one_that_is_no_uff_are_named() {
        let bench = Bench::new("missing", "1");
        holds(&bench.read("g.uff", &[]).unwrap_err(), &["g.uff", "no such file"]);
        fs::write(bench.0.join("g.uff"), FIXTURE).unwrap();
        holds(&bench.read("g.uff", &[]).unwrap_err(), &["g.uff", "is it a UFF file?"]);
    }

    #[test]
    fn nodes_beyond_the_fixture_name_the_files_and_the_remedy() {
        let bench = Bench::new("nodes", "101");
        holds(&bench.read("f.uff", &[]).unwrap_err(), &["f.uff: no FRF", "`--map 101:+y=1:+y`"]);
        assert!(bench.read("f.uff", &["101:+y=1:+y"]).is_ok());
        holds(&bench.read("f.uff", &["101:+y=9:+y"]).unwrap_err(), &["one.json: the map entry", "`9`"]);
    }
}
