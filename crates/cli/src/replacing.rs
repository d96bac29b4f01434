//! Files put in the place of others.
//!
//! Every file is written whole beside its place and then renamed over what is there, so that a name always
//! leads to one whole file, the old or the new. While a run changes a folder it holds a lock on a hidden file
//! there ([`LOCK`]); another run waits. Before the first of several renames that file gets the names of all
//! of them, and it is removed behind the last: where a run is killed in between, the names stay, and whoever
//! reads one of these files is told that they may be of two runs ([`is_unfinished`]) until a run has written
//! them all anew.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

use same_file::Handle;
use tempfile::{Builder, NamedTempFile};

use crate::progress;
use crate::refusal::Refusal;

/// The folder that a file is in.
pub(crate) fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Ends of the names of files that are not in their places yet, or were moved out of them.
const PART: &str = ".jointscope-part";

/// A hidden file with these contents, on disk.
pub(crate) fn part(folder: &Path, contents: &[u8]) -> io::Result<NamedTempFile<File>> {
    let mut part =
        Builder::new().suffix(PART).make_in(folder, |path| step().and_then(|()| File::create_new(path)))?;
    step()?;
    part.write_all(contents)?;
    step()?;
    part.as_file().sync_all()?;
    Ok(part)
}

/// Renames the parts over their places; where one cannot be, all are put back.
pub(crate) fn rename_all(
    parts: Vec<(&Path, NamedTempFile<File>)>,
    mut locks: Vec<Lock>,
) -> Result<(), Refusal> {
    if parts.len() > 1 {
        for lock in &mut locks {
            lock.begin().map_err(|error| Refusal::io(&lock.path, &error))?;
        }
    }
    let mut before: Vec<(&Path, Before)> = Vec::with_capacity(parts.len());
    for (path, part) in parts {
        match rename(path, part) {
            Ok(was) => before.push((path, was)),
            Err(error) => {
                let put_back = |lost, (path, was): (_, Before)| lost + usize::from(!was.put_back(path));
                if before.into_iter().rev().fold(0, put_back) > 0 {
                    locks.iter_mut().for_each(|lock| lock.doubtful.extend(lock.names.clone()));
                }
                return Err(Refusal::io(path, &error));
            }
        }
    }
    for lock in &mut locks {
        lock.doubtful.retain(|name| !lock.names.contains(name));
        if !lock.doubtful.is_empty() {
            let names = lock.doubtful.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
            let folder = parent(&lock.path).display();
            progress::notice(&format!(
                "{folder}: {names} may be of two runs, for one was ended while it wrote them; make them anew, or take them away with {LOCK}"
            ));
        }
    }
    // Before what was there: a run that is killed now has done its work.
    drop(locks);
    Ok(())
}

/// What was in a file's place.
enum Before {
    Nothing,
    Kept(NamedTempFile<()>),
    /// Something, in a file system where no file has two names.
    Lost,
}

impl Before {
    fn put_back(self, path: &Path) -> bool {
        match self {
            Before::Nothing => fs::remove_file(path).is_ok(),
            Before::Kept(aside) => aside.persist(path).is_ok(),
            Before::Lost => false,
        }
    }
}

fn rename(path: &Path, part: NamedTempFile<File>) -> io::Result<Before> {
    step()?;
    let before = match Builder::new().suffix(PART).make_in(parent(path), |aside| fs::hard_link(path, aside)) {
        Ok(aside) => Before::Kept(aside),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Before::Nothing,
        Err(_) => Before::Lost,
    };
    step()?;
    part.persist(path).map_err(|error| error.error)?;
    Ok(before)
}

/// The hidden file of a folder that is being changed.
const LOCK: &str = ".jointscope-lock";

/// Whether a file is one of several that a run was ended in the middle of renaming; one that is renaming just
/// now is waited for.
pub(crate) fn is_unfinished(path: &Path) -> bool {
    let is_named = |mut lock: &File| {
        let mut names = String::new();
        let read = lock.rewind().and_then(|()| lock.read_to_string(&mut names));
        read.is_ok() && path.file_name().is_some_and(|name| names.lines().any(|line| *line == *name))
    };
    let Ok(lock) = File::open(parent(path).join(LOCK)) else { return false };
    // Where there are no locks, nobody can be waited for.
    is_named(&lock) && (lock.lock_shared().is_err() || is_named(&lock))
}

/// The right to change a folder's files; given back when dropped.
#[derive(Debug)]
pub(crate) struct Lock {
    path: PathBuf,
    file: File,
    /// Files that may not belong together.
    doubtful: BTreeSet<String>,
    /// Files that are to be written.
    names: BTreeSet<String>,
}

impl Lock {
    /// Locks of the folders of these files, taken in one order by whoever takes several.
    pub(crate) fn all<'a>(paths: impl Iterator<Item = &'a Path>) -> Result<Vec<Self>, Refusal> {
        let mut folders: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
        for path in paths {
            let folder = parent(path).canonicalize().map_err(|error| Refusal::io(path, &error))?;
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            folders.entry(folder).or_default().insert(name);
        }
        let locked = |(folder, names): (PathBuf, _)| {
            Lock::of(&folder, names).map_err(|error| Refusal::io(&folder.join(LOCK), &error))
        };
        folders.into_iter().map(locked).collect()
    }

    fn of(folder: &Path, names: BTreeSet<String>) -> io::Result<Self> {
        let path = folder.join(LOCK);
        let (file, is_alone) = loop {
            step()?;
            let file = File::options().read(true).write(true).create(true).truncate(false).open(&path)?;
            let is_alone = match file.try_lock() {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => {
                    progress::notice(&format!("another run is writing to {}: waiting", folder.display()));
                    file.lock()?;
                    true
                }
                // Some network file systems know no locks: names are unlike there, too, and old parts stay.
                Err(TryLockError::Error(_)) => false,
            };
            // Who held it before has removed it: the next to come would make another.
            if Handle::from_path(&path)
                .is_ok_and(|there| file.try_clone().and_then(Handle::from_file).is_ok_and(|own| own == there))
            {
                break (file, is_alone);
            }
        };
        let doubtful = fs::read_to_string(&path)?.lines().map(str::to_owned).collect();
        if is_alone {
            // Of runs that were killed.
            for entry in fs::read_dir(folder)?.flatten() {
                if entry.file_name().to_string_lossy().ends_with(PART) {
                    step()?;
                    let _ = fs::remove_file(entry.path());
                }
            }
        }
        Ok(Lock { path, file, doubtful, names })
    }

    /// From now on the files may not belong together.
    fn begin(&mut self) -> io::Result<()> {
        self.state(self.doubtful.union(&self.names))?;
        step()?;
        self.file.sync_all()
    }

    fn state<'n>(&self, names: impl Iterator<Item = &'n String>) -> io::Result<()> {
        step()?;
        let names: String = names.map(|name| format!("{name}\n")).collect();
        self.file.set_len(0)?;
        (&self.file).rewind()?;
        (&self.file).write_all(names.as_bytes())
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // What cannot be told here stays doubtful.
        let stated = self.state(self.doubtful.iter());
        if stated.is_ok() && self.doubtful.is_empty() {
            let _ = step().and_then(|()| fs::remove_file(&self.path));
        }
    }
}

/// Where tests end a run.
#[cfg(not(test))]
fn step() -> io::Result<()> {
    Ok(())
}
#[cfg(test)]
use tests::step;

#[cfg(test)]
mod tests {
    use super::*;

    use std::cell::Cell;

    use crate::output::Outputs;
    use crate::output::tests::Scratch;

    /// What ends a run.
    type End = fn() -> io::Error;

    thread_local! {
        /// Steps that are still done, and what comes then.
        static LEFT: Cell<Option<(usize, End)>> = const { Cell::new(None) };
    }

    pub(super) fn step() -> io::Result<()> {
        match LEFT.get() {
            Some((0, end)) => {
                LEFT.set(None);
                Err(end())
            }
            Some((left, end)) => {
                LEFT.set(Some((left - 1, end)));
                Ok(())
            }
            None => Ok(()),
        }
    }

    const SET: [&str; 3] = ["answer.json", "tables/one.csv", "report.html"];

    /// What a run writes whose files all hold `contents`.
    fn write_set(folder: &Path, contents: &str) -> Result<(), Refusal> {
        let mut outputs = Outputs::default();
        SET.iter().for_each(|name| outputs.add(folder.join(name), contents));
        outputs.write()
    }

    fn set(folder: &Path) -> [String; 3] {
        SET.map(|name| fs::read_to_string(folder.join(name)).unwrap())
    }

    #[test]
    fn a_fault_at_any_step_leaves_all_files_as_they_were_or_writes_all() {
        for fault_at in 0.. {
            let scratch = Scratch::new("fault");
            write_set(&scratch.0, "old").unwrap();
            LEFT.set(Some((fault_at, || io::Error::other("no room"))));
            let written = write_set(&scratch.0, "new");
            let is_over = LEFT.take().is_some();
            let expected = if written.is_ok() { "new" } else { "old" };
            assert_eq!(set(&scratch.0), [expected; 3], "fault at step {fault_at}");
            write_set(&scratch.0, "again").unwrap();
            assert_eq!(scratch.names(), ["answer.json", "report.html", "tables"], "fault at step {fault_at}");
            if is_over {
                assert!(fault_at > 15, "{fault_at} steps");
                return;
            }
        }
    }

    /// Not a test of its own: the run that the next one kills.
    #[test]
    fn a_run_that_is_killed() {
        let stated = |name| std::env::var(name).ok();
        let (Some(folder), Some(at)) = (stated("KILLED_FOLDER"), stated("KILLED_AT")) else { return };
        LEFT.set(Some((at.parse().unwrap(), || std::process::abort())));
        write_set(Path::new(&folder), "new").unwrap();
    }

    #[test]
    fn a_run_killed_at_any_step_leaves_each_file_old_or_new_and_no_mixture_unnoticed() {
        for killed_at in 0.. {
            let scratch = Scratch::new("killed");
            write_set(&scratch.0, "old").unwrap();
            let run = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "replacing::tests::a_run_that_is_killed"])
                .env("KILLED_FOLDER", &scratch.0)
                .env("KILLED_AT", killed_at.to_string())
                .output()
                .unwrap();
            let found = set(&scratch.0);
            assert!(found.iter().all(|contents| contents == "old" || contents == "new"), "{found:?}");
            let is_mixed = found.iter().any(|contents| *contents != found[0]);
            let doubted = SET.map(|name| is_unfinished(&scratch.0.join(name)));
            assert!(!is_mixed || doubted == [true; 3], "killed at step {killed_at}: {found:?}, {doubted:?}");
            // A run that writes one of them does not make the others belong together.
            Outputs::one(scratch.0.join(SET[0]), &serde_json::json!({})).unwrap();
            assert_eq!(is_unfinished(&scratch.0.join(SET[2])), doubted[2], "killed at step {killed_at}");
            write_set(&scratch.0, "again").unwrap();
            assert_eq!(set(&scratch.0), ["again"; 3]);
            assert_eq!(
                scratch.names(),
                ["answer.json", "report.html", "tables"],
                "killed at step {killed_at}"
            );
            assert_eq!(
                fs::read_dir(scratch.0.join("tables")).unwrap().count(),
                1,
                "killed at step {killed_at}"
            );
            if run.status.success() {
                assert!(killed_at > 15 && found == ["new"; 3], "{killed_at} steps");
                return;
            }
        }
    }

    #[test]
    fn runs_at_once_wait_for_each_other_and_leave_the_files_of_one() {
        let scratch = Scratch::new("pairs");
        std::thread::scope(|scope| {
            for run in 0..3 {
                let folder = &scratch.0;
                scope.spawn(move || (0..4).for_each(|_| write_set(folder, &run.to_string()).unwrap()));
            }
        });
        let found = set(&scratch.0);
        assert!(found.iter().all(|contents| *contents == found[0]), "{found:?}");
        assert_eq!(scratch.names(), ["answer.json", "report.html", "tables"]);
    }
}
