//! A diagnosis made again from what its result states: the command line, and the inputs with their hashes.

use std::path::{Component, Path, PathBuf};

use crate::commands::diagnose::DiagnoseArguments;
use crate::input;
use crate::origin;
use crate::refusal::Refusal;

/// The arguments of a command line that diagnoses; `None` of any other.
pub(super) type ReadDiagnose = fn(&[String]) -> Option<DiagnoseArguments>;

/// The arguments of the diagnosis that wrote a file or the one in a directory, its inputs as they were then
/// and `fixture` among them.
pub(super) fn of_diagnosis(
    path: &Path,
    fixture: &Path,
    read: ReadDiagnose,
) -> Result<DiagnoseArguments, Refusal> {
    let directory = path.is_dir().then_some(path);
    let path = directory.map_or(path.to_owned(), |directory| directory.join("diagnosis.json"));
    if let Some(directory) = directory.filter(|_| !path.exists()) {
        return Err(Refusal::holding_no(directory, "diagnosis.json", "diagnose"));
    }
    let file = input::json(&path)?;
    let not_one = || {
        Refusal::at(
            &path,
            "is no diagnosis.json: it does not say which command made it; make it anew with `jointscope diagnose`",
        )
    };
    let command = file["made"]["command"].as_str().ok_or_else(not_one)?;
    let mut arguments = read(&origin::words(command)).ok_or_else(not_one)?;
    let ran_in = arguments.destination.output.as_ref().and_then(|stated| ran_in(&path, stated));
    let here = |name: &Path| as_seen_from_here(name, ran_in.as_deref());
    for made_of in file["made"]["inputs"].as_array().into_iter().flatten() {
        let (Some(name), Some(hash)) = (made_of["file"].as_str(), made_of["sha256"].as_str()) else {
            return Err(not_one());
        };
        let name = here(Path::new(name));
        if input::sha256(&name)? != hash {
            let problem = format!("has changed since {} was made; diagnose anew", path.display());
            return Err(Refusal::at(&name, problem));
        }
    }
    let recorded = arguments.recording.files.iter_mut().chain(&mut arguments.baseline);
    recorded.chain([&mut arguments.fixture]).for_each(|name| *name = here(name));
    let same = |a: &Path, b: &Path| a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
    if !same(&arguments.fixture, fixture) {
        let problem = format!(
            "is not the fixture that {} was made with, {}",
            path.display(),
            arguments.fixture.display()
        );
        return Err(Refusal::at(fixture, problem));
    }
    Ok(arguments)
}

/// The directory in which a command ran that wrote `result` to the directory `stated`; `None` where that
/// cannot be told, and where it is this one.
fn ran_in(result: &Path, stated: &Path) -> Option<PathBuf> {
    let mut directory = result.canonicalize().ok()?;
    directory.pop();
    for part in stated.components().rev() {
        match part {
            Component::Normal(name) if directory.file_name() == Some(name) => directory.pop(),
            Component::CurDir => true,
            _ => return None,
        };
    }
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    (here.ok()? != directory).then_some(directory)
}

/// A name that a command wrote which ran elsewhere; as it is where there is no such file.
fn as_seen_from_here(name: &Path, ran_in: Option<&Path>) -> PathBuf {
    let there = ran_in.map(|directory| directory.join(name)).filter(|there| there.exists());
    there.unwrap_or_else(|| name.to_owned())
}
