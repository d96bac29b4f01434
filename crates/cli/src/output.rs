//! Files out: all of a command's, or none.
//!
//! Every file is written whole beside its place and then renamed over what is there, so that a name always leads to one whole file, the old or the new.
//! While a run changes a folder it holds a lock on a hidden file there ([`LOCK`]); another run waits. Before the first of several renames that file gets the
//! names of all of them, and it is removed behind the last: where a run is killed in between, the names stay, and whoever reads one of these
//! files is told that they may be of two runs ([`is_unfinished`]) until a run has written them all anew.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

use jointscope::uff::Dataset58;
use same_file::Handle;
use serde_json::Value;
use tempfile::{Builder, NamedTempFile};

use crate::progress;
use crate::refusal::Refusal;

/// The files of a command, written together. Whatever goes wrong, files that were there before are left or put back as they were.
#[derive(Debug, Default)]
pub struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
    inputs: Vec<PathBuf>,
}

impl Outputs {
    /// Nothing yet; `inputs` are the files that the command has read and must not overwrite.
    pub fn new<'a>(inputs: impl IntoIterator<Item = &'a PathBuf>) -> Self {
        Outputs { files: Vec::new(), inputs: inputs.into_iter().cloned().collect() }
    }

    /// Adds a file.
    pub fn add(&mut self, path: impl Into<PathBuf>, contents: impl Into<Vec<u8>>) {
        self.files.push((path.into(), contents.into()));
    }

    /// Adds a universal file.
    pub fn add_datasets(&mut self, path: &Path, datasets: &[Dataset58]) -> Result<(), Refusal> {
        let bytes = jointscope::uff::write(datasets).map_err(|error| Refusal::at(path, error))?;
        self.add(path, bytes);
        Ok(())
    }

    /// Adds a JSON file.
    pub fn add_json(&mut self, path: impl Into<PathBuf>, value: &Value) {
        self.add(path, pretty(value));
    }

    /// Writes one JSON file.
    pub fn one(path: PathBuf, value: &Value) -> Result<(), Refusal> {
        let mut outputs = Outputs::default();
        outputs.add_json(path, value);
        outputs.write()
    }

    /// Whether these files could be written, to be asked before anything that takes long.
    pub fn foresee<'a>(
        inputs: impl IntoIterator<Item = &'a PathBuf>,
        paths: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Refusal> {
        let mut outputs = Outputs::new(inputs);
        paths.into_iter().for_each(|path| outputs.add(path, ""));
        outputs.check()
    }

    /// Writes the files, creating their directories; a page of another command that is replaced is told of.
    pub fn write(self) -> Result<(), Refusal> {
        self.check()?;
        let replaced: Vec<String> = self.files.iter().filter_map(|(path, new)| replaced(path, new)).collect();
        let mut folders = NewFolders::default();
        for (path, _) in &self.files {
            folders.create(parent(path)).map_err(|error| Refusal::io(path, &error))?;
        }
        let locks = Lock::all(self.files.iter().map(|(path, _)| path.as_path()))?;
        let part = |(path, contents): &(PathBuf, Vec<u8>)| {
            part(parent(path), contents).map_err(|error| Refusal::io(path, &error))
        };
        let parts = self.files.iter().map(part).collect::<Result<Vec<_>, _>>()?;
        let paths = self.files.iter().map(|(path, _)| path.as_path());
        rename_all(paths.zip(parts).collect(), locks)?;
        folders.keep();
        replaced.iter().for_each(|notice| progress::notice(notice));
        Ok(())
    }

    /// Whether the files have places where they may be written: to be asked before anything that takes long.
    pub fn check(&self) -> Result<(), Refusal> {
        let (mut tried, mut places) = (BTreeSet::new(), BTreeSet::new());
        for (path, _) in &self.files {
            if let Some(above) = parent(path).ancestors().find(|above| above.exists() && !above.is_dir()) {
                let above = above.display();
                let why = format!(
                    "cannot be written: {above} is a file where a directory is needed; choose another `-o`"
                );
                return Err(Refusal::at(path, why));
            }
            if path.file_name().is_none() || path.is_dir() {
                return Err(Refusal::at(path, "is a directory where a file is to be written"));
            }
            if path.exists() && !path.is_file() {
                return Err(Refusal::at(path, "is no ordinary file, so it cannot be replaced"));
            }
            let same = |input: &&PathBuf| match (input.canonicalize(), path.canonicalize()) {
                (Ok(input), Ok(output)) => input == output,
                _ => false,
            };
            if self.inputs.iter().any(|input| same(&input)) {
                return Err(Refusal::at(
                    path,
                    "is read by this command and would be overwritten; choose another `-o`",
                ));
            }
            let above = existing(parent(path));
            let whole = above.canonicalize().unwrap_or_else(|_| above.to_owned());
            if !places.insert(whole.join(path.strip_prefix(above).unwrap_or(path))) {
                return Err(Refusal::at(
                    path,
                    "would be written twice by this command; give its files different names",
                ));
            }
            if tried.insert(above) {
                try_to_write(above).map_err(|error| {
                    let above = above.display();
                    let why = format!(
                        "cannot be written: nothing can be put into {above} ({error}); choose another `-o`"
                    );
                    Refusal::at(path, why)
                })?;
            }
        }
        Ok(())
    }
}

/// JSON for people, and as a terminal gets it.
pub fn pretty(value: &Value) -> String {
    progress::visible(&format!("{value:#}\n"))
}

/// `1 line`, `2 lines`.
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The nearest directory that is there.
fn existing(directory: &Path) -> &Path {
    let there = |above: &&Path| above.as_os_str().is_empty() || above.is_dir();
    match directory.ancestors().find(there) {
        Some(above) if !above.as_os_str().is_empty() => above,
        _ => Path::new("."),
    }
}

/// Makes a file in a directory and takes it away: rights alone do not tell of full or read-only file systems.
fn try_to_write(directory: &Path) -> io::Result<()> {
    tempfile::tempfile_in(directory)?.write_all(b"?")
}

/// What is to be said of a page that goes for another command's.
fn replaced(path: &Path, new: &[u8]) -> Option<String> {
    let maker = |page: &[u8]| command_of_page(&String::from_utf8_lossy(page)).map(str::to_owned);
    if path.extension().is_none_or(|extension| extension != "html") {
        return None;
    }
    let before = maker(&fs::read(path).ok()?)?;
    (Some(&before) != maker(new).as_ref()).then(|| {
        let path = path.display();
        format!("{path} was the page of `jointscope {before}` and is replaced; another `-o` keeps both")
    })
}

/// The command that a page says it was made by, in its foot.
fn command_of_page(page: &str) -> Option<&str> {
    const FOOT: &str = "<pre class=\"command\">jointscope ";
    let command = &page[page.rfind(FOOT)? + FOOT.len()..];
    command.split([' ', '<']).next()
}

/// Directories that were made; removed again when dropped, unless they are kept.
#[derive(Debug, Default)]
struct NewFolders(Vec<PathBuf>);

impl NewFolders {
    fn create(&mut self, path: &Path) -> io::Result<()> {
        let missing: Vec<&Path> = path
            .ancestors()
            .take_while(|ancestor| !ancestor.as_os_str().is_empty() && !ancestor.exists())
            .collect();
        for directory in missing.into_iter().rev() {
            match fs::create_dir(directory) {
                Ok(()) => self.0.push(directory.to_owned()),
                // Another case, or another job, has made it in between.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && directory.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        for directory in self.0.iter().rev() {
            // Where somebody else has put something there, it stays.
            let _ = fs::remove_dir(directory);
        }
    }
}

/// Ends of the names of files that are not in their places yet, or were moved out of them.
const PART: &str = ".jointscope-part";

/// A hidden file with these contents, on disk.
fn part(folder: &Path, contents: &[u8]) -> io::Result<NamedTempFile<File>> {
    let mut part =
        Builder::new().suffix(PART).make_in(folder, |path| step().and_then(|()| File::create_new(path)))?;
    step()?;
    part.write_all(contents)?;
    step()?;
    part.as_file().sync_all()?;
    Ok(part)
}

/// Renames the parts over their places; where one cannot be, all are put back.
fn rename_all(parts: Vec<(&Path, NamedTempFile<File>)>, mut locks: Vec<Lock>) -> Result<(), Refusal> {
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

/// Whether a file is one of several that a run was ended in the middle of renaming; one that is renaming just now is waited for.
pub fn is_unfinished(path: &Path) -> bool {
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
struct Lock {
    path: PathBuf,
    file: File,
    /// Files that may not belong together.
    doubtful: BTreeSet<String>,
    /// Files that are to be written.
    names: BTreeSet<String>,
}

impl Lock {
    /// Locks of the folders of these files, taken in one order by whoever takes several.
    fn all<'a>(paths: impl Iterator<Item = &'a Path>) -> Result<Vec<Self>, Refusal> {
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
        let told = self.state(self.doubtful.iter());
        if told.is_ok() && self.doubtful.is_empty() {
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

    /// An empty directory that is removed with everything in it.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("jointscope-output-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Scratch(path)
        }

        fn names(&self) -> Vec<String> {
            let mut names: Vec<String> = fs::read_dir(&self.0)
                .unwrap()
                .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
                .collect();
            names.sort();
            names
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn all_files_are_written_into_directories_that_did_not_exist() {
        let scratch = Scratch::new("all");
        let mut outputs = Outputs::default();
        outputs.add(scratch.0.join("a/b/one.json"), "1");
        outputs.add(scratch.0.join("a/two.json"), "2");
        outputs.write().unwrap();
        assert_eq!(fs::read(scratch.0.join("a/b/one.json")).unwrap(), b"1");
        assert_eq!(fs::read(scratch.0.join("a/two.json")).unwrap(), b"2");
        assert_eq!(fs::read_dir(scratch.0.join("a")).unwrap().count(), 2, "nothing else is left");
    }

    #[test]
    fn threads_that_write_below_one_new_directory_do_not_trip_over_each_other() {
        let scratch = Scratch::new("threads");
        for round in 0..20 {
            std::thread::scope(|scope| {
                for thread in 0..4 {
                    let path = scratch.0.join(format!("{round}/new/{thread}/one.json"));
                    scope.spawn(move || {
                        let mut outputs = Outputs::default();
                        outputs.add(path, "1");
                        outputs.write().unwrap();
                    });
                }
            });
            assert_eq!(fs::read_dir(scratch.0.join(format!("{round}/new"))).unwrap().count(), 4);
        }
    }

    #[test]
    fn an_earlier_file_is_replaced() {
        let scratch = Scratch::new("replace");
        fs::write(scratch.0.join("one"), "before").unwrap();
        let mut outputs = Outputs::default();
        outputs.add(scratch.0.join("one"), "after");
        outputs.write().unwrap();
        assert_eq!(fs::read(scratch.0.join("one")).unwrap(), b"after");
        assert_eq!(scratch.names(), ["one"]);
    }

    #[test]
    fn when_one_file_cannot_be_written_none_is_and_nothing_is_left_behind() {
        let scratch = Scratch::new("none");
        fs::write(scratch.0.join("plain"), "a file, no directory").unwrap();
        fs::write(scratch.0.join("one"), "before").unwrap();
        let mut outputs = Outputs::default();
        outputs.add(scratch.0.join("one"), "after");
        outputs.add(scratch.0.join("new/two"), "2");
        outputs.add(scratch.0.join("plain/three"), "3");
        let message = outputs.write().unwrap_err().to_string();
        assert!(message.contains("plain/three"), "{message}");
        assert_eq!(scratch.names(), ["one", "plain"]);
        assert_eq!(fs::read(scratch.0.join("one")).unwrap(), b"before");
    }

    /// What ends a run.
    type End = fn() -> io::Error;

    thread_local! {
        /// Steps that are still done, and what comes then.
        static LEFT: Cell<Option<(usize, End)>> = const { Cell::new(None) };
    }

    pub fn step() -> io::Result<()> {
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
        let told = |name| std::env::var(name).ok();
        let (Some(folder), Some(at)) = (told("KILLED_FOLDER"), told("KILLED_AT")) else { return };
        LEFT.set(Some((at.parse().unwrap(), || std::process::abort())));
        write_set(Path::new(&folder), "new").unwrap();
    }

    #[test]
    fn a_run_killed_at_any_step_leaves_each_file_old_or_new_and_no_mixture_unnoticed() {
        for killed_at in 0.. {
            let scratch = Scratch::new("killed");
            write_set(&scratch.0, "old").unwrap();
            let run = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "output::tests::a_run_that_is_killed"])
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

    #[test]
    fn a_file_is_written_once() {
        let scratch = Scratch::new("twice");
        let mut outputs = Outputs::default();
        outputs.add(scratch.0.join("new/modes.json"), "modes");
        outputs.add(scratch.0.join("new/./modes.json"), "fixture");
        let message = outputs.write().unwrap_err().to_string();
        assert!(message.contains("would be written twice"), "{message}");
        assert!(scratch.names().is_empty());
    }

    #[test]
    fn a_file_that_was_read_is_never_overwritten() {
        let scratch = Scratch::new("input");
        let fixture = scratch.0.join("fixture.json");
        fs::write(&fixture, "{}").unwrap();
        let mut outputs = Outputs::new([&fixture]);
        outputs.add(scratch.0.join("./fixture.json"), "FRFs");
        assert!(outputs.write().unwrap_err().to_string().contains("would be overwritten"));
        assert_eq!(fs::read(&fixture).unwrap(), b"{}");
    }

    #[test]
    fn a_directory_in_which_nothing_can_be_made_is_found_out_beforehand() {
        let outputs = Path::new("/proc/jointscope/out.json").to_owned();
        if !Path::new("/proc/self").exists() {
            return;
        }
        let message = Outputs::foresee([], [outputs]).unwrap_err().to_string();
        assert!(message.contains("nothing can be put into /proc ("), "{message}");
        let scratch = Scratch::new("foresee");
        Outputs::foresee([], [scratch.0.join("a/b.json"), scratch.0.join("c.json")]).unwrap();
        assert!(scratch.names().is_empty(), "{:?}", scratch.names());
    }

    #[test]
    fn a_page_is_told_from_that_of_another_command_by_its_foot() {
        let page = |command: &str| {
            format!("<pre class=\"command\">x</pre><pre class=\"command\">jointscope {command}</pre>")
        };
        assert_eq!(command_of_page(&page("diagnose a.json -o out")), Some("diagnose"));
        let scratch = Scratch::new("page");
        let path = scratch.0.join("report.html");
        assert_eq!(replaced(&path, page("modes").as_bytes()), None);
        fs::write(&path, page("decompose a b")).unwrap();
        assert_eq!(replaced(&path, page("decompose c").as_bytes()), None);
        assert!(
            replaced(&path, page("diagnose a").as_bytes())
                .unwrap()
                .contains("the page of `jointscope decompose`")
        );
    }

    #[test]
    fn a_directory_is_no_place_for_a_file() {
        let scratch = Scratch::new("directory");
        let mut outputs = Outputs::default();
        outputs.add(&scratch.0, "x");
        assert!(outputs.write().unwrap_err().to_string().contains("is a directory"));
    }
}
