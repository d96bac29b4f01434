//! `jointscope prove --recordings`: something concealed in a real recording's fixture or channels, diagnosed,
//! and only then opened.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use jointscope::proof::Timing;
use jointscope::proof::concealed::{ConcealmentKind, ConcealmentPlan, ConcealmentScores, Explained};
use jointscope::recordings::{HeldAmplitude, Level, Recording};
use jointscope::spectra::{FrfSet, in_text};
use serde_json::json;

use super::arguments::{ProveArguments, RealRecordings};
use crate::input::{self, FixtureFile};
use crate::origin;
use crate::output::{Outputs, pretty};
use crate::progress::{self, tell};
use crate::recording::{ReadingArguments, RecordingArguments};
use crate::refusal::Refusal;

/// Cases where no number is given: each takes a whole diagnosis of the recording.
const CASES: usize = 8;

/// Makes the fixture that explains the recording, conceals, has all cases diagnosed, opens the truths and
/// scores them; answers with the table.
pub(super) fn run(directory: &Path, arguments: &ProveArguments) -> Result<String, Refusal> {
    let test = Test::read(directory, &arguments.real)?;
    let plan = plan(arguments);
    // Found out before the first diagnosis, which takes its time.
    plan.check().map_err(Refusal::new)?;
    Outputs::foresee(test.files(), arguments.output.iter().map(|directory| directory.join("seal.json")))?;
    let bar = progress::cases(1, "diagnosed as they are");
    let explained = Explained::of(&test.fixture, &test.frfs, arguments.real.rounds)
        .map_err(|error| Refusal::at(directory, error))?;
    drop(bar);
    let (cases, truths) =
        plan.conceal(&explained.fixture, &test.frfs).map_err(|error| Refusal::at(directory, error))?;
    let digest = truths.digest().to_owned();
    tell(&format!("truths sealed, SHA-256 {digest}"));
    let inputs = origin::inputs_value(&origin::inputs(test.files())?);
    if let Some(directory) = &arguments.output {
        // A directory that cannot be written to is found out before the work, not after it.
        let seal = json!({ "plan": plan.to_value(), "inputs": inputs, "sealed_truths_sha256": digest });
        let mut outputs = Outputs::new(test.files());
        outputs.add_json(directory.join("seal.json"), &seal);
        outputs.add(directory.join("explaining.json"), explained.fixture.to_json());
        outputs.write()?;
    }
    let threads = arguments.workers();
    let bar = progress::cases(cases.len(), "diagnosed");
    let answers = explained.answers(&cases, threads, |done| bar.set_position(done as u64));
    drop(bar);
    if let Some(directory) = &arguments.output {
        // On disk before the truths are opened.
        Outputs::one(directory.join("answers.json"), &answers.to_value())?;
    }
    let truths = truths.open(&answers).ok_or_else(|| Refusal::new("answers are missing"))?;
    let scores = ConcealmentScores::of(&cases, truths, &answers, threads);
    let timing = Timing::of(answers.seconds());
    tell(&timing.to_string());
    let mut value = scores.to_value();
    value["recording"] = json!({ "inputs": inputs, "notes": test.notes, "in_words": test.to_string() });
    value["explained"] = explained.to_value();
    value["plan"] = plan.to_value();
    value["sealed_truths_sha256"] = digest.clone().into();
    if let Some(directory) = &arguments.output {
        let mut outputs = Outputs::new(test.files());
        outputs.add_json(directory.join("proof.json"), &value);
        outputs.add_json(directory.join("timing.json"), &timing.to_value());
        outputs.write()?;
    }
    if arguments.json {
        return Ok(pretty(&value).trim_end().to_owned());
    }
    let lines = [
        format!("{}: {test}", directory.display()),
        explained.to_string(),
        format!("{plan}\ntruths sealed before the first answer, SHA-256 {digest}\n"),
        scores.to_string(),
    ];
    Ok(lines.join("\n").trim_end().to_owned())
}

/// What is to be concealed.
fn plan(arguments: &ProveArguments) -> ConcealmentPlan {
    let asked = &arguments.real.conceal;
    let is_asked = |kind: &ConcealmentKind| asked.is_empty() || asked.iter().any(|name| name == kind.name());
    ConcealmentPlan {
        cases: arguments.cases.unwrap_or(CASES),
        seed: arguments.seed.unwrap_or(1),
        only: arguments.only,
        kinds: ConcealmentKind::ALL.into_iter().filter(is_asked).collect(),
    }
}

/// A test as its directory holds it.
struct Test {
    fixture: FixtureFile,
    files: Vec<PathBuf>,
    frfs: FrfSet,
    level: Option<HeldAmplitude>,
    notes: Vec<String>,
}

impl Test {
    fn read(directory: &Path, options: &RealRecordings) -> Result<Self, Refusal> {
        let entries = files_of(directory)?;
        let fixture = FixtureFile::read(&the_fixture(directory, &entries)?)?;
        let files: Vec<PathBuf> =
            entries.into_iter().filter(|path| has_extension(path, &["uff", "unv"])).collect();
        if files.is_empty() {
            return Err(Refusal::at(
                directory,
                "there is no recording here; put its universal files (.uff, .unv) beside the fixture",
            ));
        }
        let arguments = RecordingArguments {
            files,
            reading: ReadingArguments {
                map: options.map.clone(),
                assume_units: options.assume_units.clone(),
                ..ReadingArguments::default()
            },
        };
        let recording = arguments.recording(&fixture)?;
        let Level { held, frfs, .. } = the_level(directory, &recording, options.level)?;
        let hz = frfs.lines().hz();
        let within = |line: usize| options.band.is_none_or(|band| band.contains(hz[line]));
        let frfs = frfs.on_lines(within).ok_or_else(|| {
            let (first, last) = (in_text(hz[0]), in_text(hz[hz.len() - 1]));
            let problem =
                format_args!("`--band` leaves no spectral line of the recording, which runs from {first} to {last} Hz; choose it anew");
            Refusal::at(directory, problem)
        })?;
        Ok(Test { fixture, files: arguments.files, frfs, level: *held, notes: recording.notes.clone() })
    }

    fn files(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.fixture.path).chain(&self.files)
    }
}

impl fmt::Display for Test {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hz = self.frfs.lines().hz();
        let (first, last) = (in_text(hz[0]), in_text(hz[hz.len() - 1]));
        write!(f, "{} FRFs on {} lines, {first} to {last} Hz", self.frfs.pairs().len(), hz.len())?;
        match self.level {
            Some(level) => write!(f, ", {level}"),
            None => Ok(()),
        }
    }
}

/// The files of a directory by name.
fn files_of(directory: &Path) -> Result<Vec<PathBuf>, Refusal> {
    let entries = fs::read_dir(directory).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotADirectory => {
            Refusal::at(directory, "is a file; give the directory that holds fixture.json and the recordings")
        }
        std::io::ErrorKind::NotFound => Refusal::at(directory, "there is no such directory; check the path"),
        _ => Refusal::io(directory, &error),
    })?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>();
    let mut paths = paths.map_err(|error| Refusal::io(directory, &error))?;
    paths.retain(|path| path.is_file());
    paths.sort();
    Ok(paths)
}

fn has_extension(path: &Path, any: &[&str]) -> bool {
    let own = path.extension().unwrap_or_default();
    any.iter().any(|extension| own.eq_ignore_ascii_case(extension))
}

/// The fixture of a directory: `fixture.json`, if no other file describes bodies.
fn the_fixture(directory: &Path, files: &[PathBuf]) -> Result<PathBuf, Refusal> {
    let is_named = |path: &PathBuf| path.file_name().is_some_and(|name| name == "fixture.json");
    let describes_bodies = |path: &PathBuf| input::json(path).is_ok_and(|value| value["bodies"].is_object());
    let fixtures: Vec<&PathBuf> = files
        .iter()
        .filter(|path| is_named(path) || has_extension(path, &["json"]) && describes_bodies(path))
        .collect();
    match fixtures.as_slice() {
        [one] if is_named(one) => Ok(one.to_path_buf()),
        [] => {
            Err(Refusal::at(directory, format_args!("there is no fixture.json here{}", elsewhere(directory))))
        }
        [one] => Err(Refusal::at(
            directory,
            format_args!("there is no fixture.json here; is {} the fixture? Name it so", name(one)),
        )),
        several => {
            let names: Vec<String> = several.iter().map(|path| name(path)).collect();
            Err(Refusal::at(
                directory,
                format_args!(
                    "there are several fixtures ({}); leave fixture.json alone here",
                    names.join(", ")
                ),
            ))
        }
    }
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Directories within that hold a fixture, or what to do.
fn elsewhere(directory: &Path) -> String {
    let entries = fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut names: Vec<String> =
        entries.filter(|path| path.join("fixture.json").is_file()).map(|path| name(&path)).collect();
    names.sort();
    match names.as_slice() {
        [] => "; put the fixture that the recordings belong to beside them".to_owned(),
        names => format!(", but in its directories {}; give one of these", names.join(", ")),
    }
}

/// The recording's FRFs at the level asked for.
fn the_level<'a>(
    directory: &Path,
    recording: &'a Recording,
    asked: Option<HeldAmplitude>,
) -> Result<&'a Level, Refusal> {
    let named = |level: &Level| level.held.map_or_else(|| "none stated".to_owned(), |held| held.to_string());
    let names = || recording.levels.iter().map(named).collect::<Vec<_>>().join(", ");
    let refused = |problem: String| Refusal::at(directory, problem);
    match (asked, recording.levels.as_slice()) {
        (None, [one]) => Ok(one),
        (None, levels) => Err(refused(format!(
            "there are FRFs at {} levels ({}); choose one with --level \"{}\"",
            levels.len(),
            names(),
            levels.iter().find_map(|level| level.held).map_or_else(String::new, |held| held.to_string())
        ))),
        (Some(asked), levels) => levels
            .iter()
            .find(|level| level.held == Some(asked))
            .ok_or_else(|| refused(format!("there are no FRFs at the level {asked}; there are {}", names()))),
    }
}
