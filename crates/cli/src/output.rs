//! Files out: all of a command's, or none. How they get into their places is told in [`crate::replacing`].

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use jointscope::uff::Dataset58;
use serde_json::Value;

use crate::progress;
use crate::refusal::Refusal;
use crate::replacing::{Lock, parent, part, rename_all};

/// The files of a command, written together. Whatever goes wrong, files that were there before are left or
/// put back as they were.
#[derive(Debug, Default)]
pub(crate) struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
    inputs: Vec<PathBuf>,
}

impl Outputs {
    /// Nothing yet; `inputs` are the files that the command has read and must not overwrite.
    pub(crate) fn new<'a>(inputs: impl IntoIterator<Item = &'a PathBuf>) -> Self {
        Outputs { files: Vec::new(), inputs: inputs.into_iter().cloned().collect() }
    }

    /// Adds a file.
    pub(crate) fn add(&mut self, path: impl Into<PathBuf>, contents: impl Into<Vec<u8>>) {
        self.files.push((path.into(), contents.into()));
    }

    /// Adds a universal file.
    pub(crate) fn add_datasets(&mut self, path: &Path, datasets: &[Dataset58]) -> Result<(), Refusal> {
        let bytes = jointscope::uff::write(datasets).map_err(|error| Refusal::at(path, error))?;
        self.add(path, bytes);
        Ok(())
    }

    /// Adds a JSON file.
    pub(crate) fn add_json(&mut self, path: impl Into<PathBuf>, value: &Value) {
        self.add(path, pretty(value));
    }

    /// Writes one JSON file.
    pub(crate) fn one(path: PathBuf, value: &Value) -> Result<(), Refusal> {
        let mut outputs = Outputs::default();
        outputs.add_json(path, value);
        outputs.write()
    }

    /// Whether these files could be written, to be asked before anything that takes long.
    pub(crate) fn foresee<'a>(
        inputs: impl IntoIterator<Item = &'a PathBuf>,
        paths: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), Refusal> {
        let mut outputs = Outputs::new(inputs);
        paths.into_iter().for_each(|path| outputs.add(path, ""));
        outputs.check()
    }

    /// Writes the files, creating their directories; a page of another command that is replaced is told of.
    pub(crate) fn write(self) -> Result<(), Refusal> {
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
    pub(crate) fn check(&self) -> Result<(), Refusal> {
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
pub(crate) fn pretty(value: &Value) -> String {
    progress::visible(&format!("{value:#}\n"))
}

pub(crate) use jointscope::wording::counted;

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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// An empty directory that is removed with everything in it.
    pub(crate) struct Scratch(pub PathBuf);

    impl Scratch {
        pub(crate) fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("jointscope-output-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Scratch(path)
        }

        pub(crate) fn names(&self) -> Vec<String> {
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
