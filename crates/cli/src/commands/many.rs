//! Many cases at once, for `diagnose` and `decompose`: tried beside each other, those that have their answer
//! left out, a share of them for a cluster's job.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use clap::Args;
use jointscope::cases::{Case, Command, FolderOfFiles, Shard, State, listed, of_folders};
use serde_json::{Value, json};

use super::summary;
use crate::answered::{Answered, Destination, PAGE, REFUSED};
use crate::input;
use crate::origin;
use crate::output::{Outputs, counted, pretty};
use crate::progress::tell;
use crate::refusal::Refusal;
use crate::said::Said;

/// Options for many cases.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Many cases (FIXTURE is a folder of them or a list, without recordings)")]
pub(crate) struct ManyArguments {
    /// Try only share I of N of the cases, for job I of a cluster's job array; `jointscope summary DIR` joins
    /// the shares.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Cases that are tried at the same time, which bounds the memory needed [default: one a processor].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

impl ManyArguments {
    /// Refuses what has no meaning for one test.
    pub(crate) fn unused(&self) -> Result<(), Refusal> {
        match self.shard.is_some() || self.jobs.is_some() {
            false => Ok(()),
            true => Err(Refusal::new(
                "--shard and --jobs are for many cases: give a folder of cases or a list of them in place of fixture and recordings",
            )),
        }
    }
}

/// One case as a command of its own.
pub(super) struct OneCase<'a> {
    pub fixture: PathBuf,
    pub recordings: Vec<PathBuf>,
    /// The command line that gives this answer alone.
    pub command: &'a str,
}

/// What is to be done with every case.
pub(super) struct Task<'a> {
    pub command: Command,
    /// A folder or a list.
    pub cases: &'a Path,
    pub many: &'a ManyArguments,
    pub destination: &'a Destination,
}

/// Tries the cases that have no answer yet; answers with what came of all, or of the share.
pub(super) fn run(
    task: &Task,
    answer: impl Fn(&OneCase) -> Result<Answered, Refusal> + Sync,
) -> Result<Said, Refusal> {
    let Some(folder) = task.destination.output.as_deref().filter(|_| !task.destination.json) else {
        return Err(Refusal::new(
            "many cases write their answers to directories: give `-o DIR` and leave out `--json`; `jointscope summary DIR --json` prints what came of them",
        ));
    };
    let cases = found(task.cases, folder)?;
    summary::belongs_to(folder, task.command)?;
    let manifest = folder.join(manifest_name(task.many.shard.as_ref()));
    let contents = json!({ "command": task.command.name(), "cases": cases });
    let mut outputs = Outputs::default();
    outputs.add(&manifest, pretty(&contents));
    outputs.write()?;
    let own: Vec<&Case> = cases
        .iter()
        .enumerate()
        .filter(|(place, _)| task.many.shard.is_none_or(|shard| shard.has(*place)))
        .map(|(_, case)| case)
        .collect();
    let ends = tried(task, &own, folder, &answer)?;
    let before = ends.iter().filter(|end| **end == End::Before).count();
    let refused = ends.iter().filter(|end| **end == End::Refused).count();
    let whole = refused == 0;
    if let Some(shard) = &task.many.shard {
        let text = format!(
            "share {shard}: {}, {before} of them done before, {refused} refused; when all shares are done: jointscope summary {}",
            counted(own.len(), "case"),
            folder.display()
        );
        return Ok(Said { text, whole });
    }
    if before > 0 {
        tell(&format!("note: {} had their answers already", counted(before, "case")));
    }
    let text = summary::written(folder, task.command, &cases, false)?;
    Ok(Said { text, whole })
}

fn manifest_name(shard: Option<&Shard>) -> String {
    match shard {
        None => "cases.json".to_owned(),
        Some(shard) => format!("cases-{}.json", shard.to_string().replace(' ', "-")),
    }
}

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// Its answer was there.
    Before,
    Answered,
    Refused,
}

/// Tries cases, as many at the same time as there are jobs; each has threads of its own, so that no more than
/// that are in memory.
fn tried(
    task: &Task,
    cases: &[&Case],
    folder: &Path,
    answer: &(impl Fn(&OneCase) -> Result<Answered, Refusal> + Sync),
) -> Result<Vec<End>, Refusal> {
    let threads = rayon::current_num_threads();
    let jobs = task.many.jobs.map_or(threads, usize::from).min(cases.len()).max(1);
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || -> Result<Vec<(usize, End)>, Refusal> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads((threads / jobs).max(1)).build();
        let pool = pool.map_err(|error| {
            Refusal::new(format_args!("no threads for a case: {error}; try fewer with --jobs"))
        })?;
        let mut ends = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(place) else { return Ok(ends) };
            let (end, said) = pool.install(|| one(task, case, folder, answer))?;
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            if end != End::Before {
                tell(&format!("[{count}/{}] {}: {said}", cases.len(), case.name));
            }
            ends.push((place, end));
        }
    };
    let all = thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| {
                worker
                    .join()
                    .unwrap_or_else(|_| Err(Refusal::new("a thread ended early; run the command again")))
            })
            .collect::<Result<Vec<_>, Refusal>>()
    })?;
    let mut ends: Vec<(usize, End)> = all.into_iter().flatten().collect();
    ends.sort_unstable_by_key(|(place, _)| *place);
    Ok(ends.into_iter().map(|(_, end)| end).collect())
}

/// One case: its answer written, or why there is none. An answer that cannot be written ends everything: so
/// would all others.
fn one(
    task: &Task,
    case: &Case,
    folder: &Path,
    answer: &impl Fn(&OneCase) -> Result<Answered, Refusal>,
) -> Result<(End, String), Refusal> {
    let own = folder.join(&case.name);
    let recordings: Vec<PathBuf> = case.recordings.iter().map(PathBuf::from).collect();
    let command = command_of(std::env::args_os().skip(1), task, case, &own);
    let inputs: Vec<PathBuf> =
        std::iter::once(PathBuf::from(&case.fixture)).chain(recordings.clone()).collect();
    if case.fault.is_none() && is_done(task.command, &own, &command, &inputs) {
        return Ok((End::Before, String::new()));
    }
    let single = OneCase { fixture: PathBuf::from(&case.fixture), recordings, command: &command };
    let answered = match &case.fault {
        Some(fault) => Err(Refusal::new(fault)),
        // A fault of the program in one case is no reason to leave out the others.
        None => catch_unwind(AssertUnwindSafe(|| answer(&single))).unwrap_or_else(|_| {
            Err(Refusal::new(format_args!(
                "{}: the program failed; please report it with this case",
                case.name
            )))
        }),
    };
    let refused = own.join(REFUSED);
    match answered {
        Ok(answered) => {
            let state = serde_json::from_str(&answered.answer.1).map(|file: Value| task.command.state(&file));
            let mut outputs = Outputs::new(&inputs);
            answered.add(&own, &task.destination.also, &mut outputs)?;
            outputs.write()?;
            if refused.exists() {
                fs::remove_file(&refused).map_err(|error| Refusal::io(&refused, &error))?;
            }
            Ok((End::Answered, state.unwrap_or(State::Missing).to_string()))
        }
        Err(refusal) => {
            let contents = json!({
                "refused": refusal.to_string(),
                "made": { "program": origin::program(), "command": command },
            });
            let mut outputs = Outputs::new(&inputs);
            outputs.add_json(&refused, &contents);
            outputs.write()?;
            Ok((End::Refused, format!("refused: {refusal}")))
        }
    }
}

/// Whether the answer that is there was made by this program with these options from these very files.
fn is_done(command: Command, folder: &Path, line: &str, inputs: &[PathBuf]) -> bool {
    if folder.join(REFUSED).exists() || !folder.join(PAGE).exists() {
        return false;
    }
    let Ok(file) = input::answer(&folder.join(command.answer())) else { return false };
    let Ok(inputs) = origin::inputs(inputs) else { return false };
    let made =
        json!({ "program": origin::program(), "command": line, "inputs": origin::inputs_value(&inputs) });
    file.get("made") == Some(&made)
}

/// The command line that answers a case alone: the one that was typed with fixture and recordings in place of
/// the cases.
fn command_of(typed: impl Iterator<Item = OsString>, task: &Task, case: &Case, folder: &Path) -> String {
    let mut words: Vec<String> = vec![task.command.name().to_owned(), case.fixture.clone()];
    words.extend(case.recordings.iter().cloned());
    // The command itself, and the first word that is the cases.
    let mut typed = typed.skip(1);
    let mut seen = false;
    while let Some(word) = typed.next() {
        let text = word.to_string_lossy().into_owned();
        match text.as_str() {
            "--shard" | "--jobs" | "-o" | "--output" => {
                typed.next();
            }
            text if ["--shard=", "--jobs=", "--output="].iter().any(|option| text.starts_with(option)) => {}
            text if text.starts_with("-o") && !text.starts_with("--") => {}
            _ if !seen && word == task.cases.as_os_str() => seen = true,
            _ => words.push(text),
        }
    }
    words.extend(["-o".to_owned(), folder.display().to_string()]);
    origin::command_of(words)
}

/// The cases of a folder, or of a list.
fn found(cases: &Path, output: &Path) -> Result<Vec<Case>, Refusal> {
    if cases.is_dir() {
        let mut folders = Vec::new();
        let output = output.canonicalize().ok();
        look(cases, String::new(), output.as_deref(), &mut folders)?;
        return of_folders(folders).map_err(|error| Refusal::at(cases, error));
    }
    let bytes = input::bytes(cases)?;
    let text = std::str::from_utf8(&bytes).ok().filter(|text| !text.contains('\0'));
    if text.is_none_or(|text| text.trim_start_matches('\u{feff}').trim_start().starts_with(['{', '['])) {
        return Err(Refusal::at(
            cases,
            "no recordings were given with it; name them after the fixture, or give a folder of cases or a list of lines `fixture.json, recording.uff, …`",
        ));
    }
    let mut found = listed(text.unwrap_or_default()).map_err(|error| Refusal::at(cases, error))?;
    // A list speaks of files as seen from where it lies.
    let above = cases.parent().filter(|above| !above.as_os_str().is_empty());
    let seen = |file: &String| above.map_or(file.clone(), |above| above.join(file).display().to_string());
    for case in &mut found {
        case.fixture = seen(&case.fixture);
        case.recordings = case.recordings.iter().map(seen).collect();
        if case.recordings.iter().chain([&case.fixture]).any(|file| file == "-") {
            return Err(Refusal::at(cases, "standard input (`-`) is no file of a list"));
        }
    }
    Ok(found)
}

/// Endings of recordings.
const RECORDINGS: [&str; 5] = ["uff", "unv", "uf", "csv", "mat"];

/// A folder's files and those of the folders in it; hidden ones and the answers' own are passed over.
fn look(
    path: &Path,
    name: String,
    output: Option<&Path>,
    folders: &mut Vec<FolderOfFiles>,
) -> Result<(), Refusal> {
    let failed = |error: std::io::Error| Refusal::io(path, &error);
    let mut own =
        FolderOfFiles { name: name.clone(), path: path.display().to_string(), ..FolderOfFiles::default() };
    let mut below = BTreeSet::new();
    for entry in fs::read_dir(path).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let file = entry.file_name().to_string_lossy().into_owned();
        let path = entry.path();
        if file.starts_with('.') {
            continue;
        }
        if path.is_dir() {
            // A link back to a folder above would never end.
            let is_link = entry.file_type().map_err(failed)?.is_symlink();
            if !is_link && path.canonicalize().ok().as_deref() != output {
                below.insert((file, path));
            }
            continue;
        }
        match path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase).as_deref() {
            Some("json") => own.fixtures.push(file),
            Some(ending) if RECORDINGS.contains(&ending) => own.recordings.push(file),
            _ => {}
        }
    }
    folders.push(own);
    for (file, path) in below {
        let name = if name.is_empty() { file } else { format!("{name}/{file}") };
        look(&path, name, output, folders)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_of_a_case_is_what_was_typed_with_its_files_in_place_of_the_cases() {
        let (many, destination) = (ManyArguments::default(), Destination::default());
        let task = Task {
            command: Command::Diagnose,
            cases: Path::new("all"),
            many: &many,
            destination: &destination,
        };
        let case = Case {
            name: "a b".into(),
            fixture: "all/a b/f.json".into(),
            recordings: vec!["r.uff".into()],
            fault: None,
        };
        let line =
            |typed: &[&str]| command_of(typed.iter().map(OsString::from), &task, &case, Path::new("out/a b"));
        let expected = r#"jointscope diagnose "all/a b/f.json" r.uff --band 1:9 -o "out/a b""#;
        assert_eq!(line(&["diagnose", "all", "--band", "1:9", "--shard", "1/2", "-o", "out"]), expected);
        assert_eq!(line(&["diagnose", "--jobs=2", "--output=out", "--band", "1:9", "all"]), expected);
        assert_eq!(line(&["diagnose", "all", "-oout", "--shard=2/2", "--band", "1:9"]), expected);
    }
}
