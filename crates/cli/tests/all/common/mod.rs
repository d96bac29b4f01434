//! The built program in a directory of its own, and recordings to give it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

use jointscope::uff::{Data, Dataset58};

pub(crate) use jointscope_samples::TWO_BLOCKS;

/// Length and bending stiffness EI of [`TWO_BLOCKS`]' beam.
pub(crate) const LENGTH: f64 = 0.065;
pub(crate) const BENDING_STIFFNESS: f64 = 2.07e11 * 3.67e-10;

/// The example that the project ships.
pub(crate) fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/glued-joint")
}

/// A directory of its own, removed afterwards.
pub(crate) struct Bench(pub PathBuf);

impl Bench {
    pub(crate) fn new(name: &str) -> Self {
        static MADE: AtomicUsize = AtomicUsize::new(0);
        let count = MADE.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("jointscope-{name}-{}-{count}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Bench(path)
    }

    /// With these files, which another one had.
    pub(crate) fn with(name: &str, files: &[(PathBuf, Vec<u8>)]) -> Self {
        let bench = Bench::new(name);
        for (path, contents) in files {
            let path = bench.0.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, contents).unwrap();
        }
        bench
    }

    /// All files, by their paths within it: what several tests set out from is made once.
    pub(crate) fn into_files(self) -> Vec<(PathBuf, Vec<u8>)> {
        let (mut folders, mut files) = (vec![self.0.clone()], Vec::new());
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    files.push((path.strip_prefix(&self.0).unwrap().to_owned(), fs::read(&path).unwrap()));
                }
            }
        }
        files
    }

    /// With the shipped example's fixture and recording.
    pub(crate) fn shipped(name: &str) -> Self {
        let bench = Bench::new(name);
        for file in ["fixture.json", "hammer-test.uff"] {
            fs::copy(shipped().join(file), bench.0.join(file)).unwrap();
        }
        bench
    }

    /// With a fixture, `two.json`, and the FRFs that the program computes of it, `frf.uff`.
    pub(crate) fn synthesized(name: &str, fixture: &str, lines: &str) -> Self {
        let bench = Bench::new(name);
        bench.write("two.json", fixture);
        bench.done(&["synthesize", "two.json", "--lines", lines, "-o", "frf.uff"]);
        bench
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), contents).unwrap();
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// What the program prints as JSON.
    #[track_caller]
    pub(crate) fn json_of(&self, arguments: &[&str]) -> serde_json::Value {
        serde_json::from_str(&self.answer(arguments)).unwrap()
    }

    /// Names of what the directory itself holds, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The functions of a universal file.
    pub(crate) fn datasets(&self, name: &str) -> Vec<Dataset58> {
        jointscope::uff::read(&fs::read(self.0.join(name)).unwrap()).unwrap().datasets
    }

    /// Writes the functions of `from`, changed, to `to`.
    pub(crate) fn rewrite(&self, from: &str, to: &str, change: impl FnOnce(&mut Vec<Dataset58>)) {
        let mut datasets = self.datasets(from);
        change(&mut datasets);
        self.write(to, jointscope::uff::write(&datasets).unwrap());
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        Self::run_in(&self.0, arguments)
    }

    /// The program in another folder.
    pub(crate) fn run_in(folder: impl AsRef<Path>, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_jointscope")).args(arguments).current_dir(folder).output().unwrap()
    }

    /// The program with these bytes on its standard input.
    pub(crate) fn run_with_input(&self, arguments: &[&str], input: &[u8]) -> Output {
        use std::io::Write;
        use std::process::Stdio;
        let mut program = Command::new(env!("CARGO_BIN_EXE_jointscope"))
            .args(arguments)
            .current_dir(&self.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // A program that refuses its arguments reads nothing.
        let _ = program.stdin.take().unwrap().write_all(input);
        program.wait_with_output().unwrap()
    }

    /// The program must do it; what a reader at a terminal has of it, progress apart: notices, then the
    /// answer.
    #[track_caller]
    pub(crate) fn done(&self, arguments: &[&str]) -> String {
        let (mut notices, answer) = self.notices_and_answer(arguments);
        notices.push_str(&answer);
        notices
    }

    /// The program must do it; what it puts on standard output.
    #[track_caller]
    pub(crate) fn answer(&self, arguments: &[&str]) -> String {
        self.notices_and_answer(arguments).1
    }

    #[track_caller]
    fn notices_and_answer(&self, arguments: &[&str]) -> (String, String) {
        let output = self.run(arguments);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {told}");
        assert!(!told.contains("jointscope: "), "{told}");
        // A diagnosis tells how it comes along; others do so where they take long.
        let notices = told.lines().filter(|line| line.starts_with("note: ")).map(|line| format!("{line}\n"));
        (notices.collect(), String::from_utf8(output.stdout).unwrap())
    }

    /// The program must refuse in one sentence that holds every part, and leave the directory as it was; the
    /// sentence.
    #[track_caller]
    pub(crate) fn refused(&self, arguments: &[&str], parts: &[&str]) -> String {
        let before = self.contents();
        let output = self.run(arguments);
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {complaint}");
        assert!(output.stdout.is_empty(), "{arguments:?} printed to standard output");
        assert!(complaint.starts_with("jointscope: "), "{complaint}");
        assert_eq!(complaint.trim_end().lines().count(), 1, "one sentence: {complaint}");
        for part in parts {
            assert!(complaint.contains(part), "`{part}` is missing from: {complaint}");
        }
        assert!(self.contents() == before, "{arguments:?} left something behind");
        println!("{}", complaint.trim_end());
        complaint
    }

    /// Every file below the directory with what it holds.
    pub(crate) fn contents(&self) -> Vec<(PathBuf, Option<Vec<u8>>)> {
        let mut found = Vec::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path.clone());
                    found.push((path, None));
                } else {
                    let bytes = fs::read(&path).unwrap();
                    found.push((path, Some(bytes)));
                }
            }
        }
        found.sort();
        found
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Multiplies every value of an FRF.
pub(crate) fn scale(dataset: &mut Dataset58, factor: f64) {
    let Data::Complex(values) = &mut dataset.data else { panic!("an FRF is complex") };
    values.iter_mut().for_each(|value| *value *= factor);
}

/// A 2×2 matrix of a result file.
#[track_caller]
pub(crate) fn matrix(value: &serde_json::Value) -> [[f64; 2]; 2] {
    let rows = value.as_array().unwrap();
    assert_eq!(rows.len(), 2, "{value} has two rows");
    std::array::from_fn(|i| {
        let row = rows[i].as_array().unwrap();
        assert_eq!(row.len(), 2, "{value} has two columns");
        std::array::from_fn(|j| row[j].as_f64().unwrap())
    })
}
