//! A case: a fixture and the recordings of one test of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A test to be diagnosed or decomposed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Case {
    /// What it is called, and the directory of its answer, with `/` between parts.
    pub name: String,
    /// Path of the fixture file.
    pub fixture: String,
    /// Paths of the recordings of the test.
    pub recordings: Vec<String>,
    /// Why it cannot be tried, one plain sentence: what stands in its folder is no case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
}

/// What a folder holds, and the names of its files.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FolderOfFiles {
    /// Its path from the folder of all cases, with `/` between parts; empty for that folder itself.
    pub name: String,
    /// Its path.
    pub path: String,
    /// Names of its JSON files.
    pub fixtures: Vec<String>,
    /// Names of its recordings.
    pub recordings: Vec<String>,
}

/// Why there are no cases.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CasesError {
    /// A line without a recording.
    #[error("line {line} names a fixture and no recording: a line is `fixture.json, recording.uff, …`")]
    NoRecording {
        /// From 1.
        line: usize,
    },
    /// Two lines are alike.
    #[error("lines {first} and {second} are the same case, `{name}`: leave one of them out")]
    Twice {
        /// From 1.
        first: usize,
        /// From 1.
        second: usize,
        /// What both are called.
        name: String,
    },
    /// Nothing in it.
    #[error("there is no case in it: {0}")]
    None(&'static str),
}

/// The cases of a list: a line each, the fixture and its recordings with commas between them. Empty lines,
/// and lines that begin with `#`, say nothing.
///
/// A case is called by the path of its first recording, without what all have in common and without its
/// ending; where several fixtures go with one recording, by the fixture too.
///
/// # Errors
/// See [`CasesError`].
pub fn listed(text: &str) -> Result<Vec<Case>, CasesError> {
    let mut lines = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut files = line.split(',').map(|file| file.trim().to_owned()).filter(|file| !file.is_empty());
        let (fixture, recordings) = (files.next().unwrap_or_default(), files.collect::<Vec<_>>());
        if recordings.is_empty() {
            return Err(CasesError::NoRecording { line: index + 1 });
        }
        lines.push((index + 1, fixture, recordings));
    }
    if lines.is_empty() {
        return Err(CasesError::None(
            "a line is a fixture and its recordings, `fixture.json, recording.uff, …`",
        ));
    }
    let firsts: Vec<&str> = lines.iter().map(|(.., recordings)| recordings[0].as_str()).collect();
    let common = common_folder(&firsts);
    let plain = |(_, _, recordings): &(usize, String, Vec<String>)| name_of(&recordings[0][common..]);
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    lines.iter().for_each(|line| *count.entry(plain(line)).or_default() += 1);
    let mut cases: Vec<Case> = Vec::with_capacity(lines.len());
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    for line in &lines {
        let name = match plain(line) {
            name if count[&name] == 1 => name,
            name => format!("{name}-{}", name_of(&line.1)),
        };
        if let Some(first) = taken.insert(name.clone(), line.0) {
            return Err(CasesError::Twice { first, second: line.0, name });
        }
        cases.push(Case { name, fixture: line.1.clone(), recordings: line.2.clone(), fault: None });
    }
    Ok(cases)
}

/// Name of a file that is a fixture and no answer: where it lies, a case is meant.
const FIXTURE: &str = "fixture.json";

/// The cases of folders, in the order of their names: each that holds recordings is one. A folder with
/// recordings and no fixture, or several, is a case with a fault, and so is one below the top that
/// has a `fixture.json` alone.
///
/// # Errors
/// No folder holds recordings.
pub fn of_folders(mut folders: Vec<FolderOfFiles>) -> Result<Vec<Case>, CasesError> {
    let none = folders.iter().all(|folder| folder.recordings.is_empty());
    let is_meant = |folder: &FolderOfFiles| {
        !none && !folder.name.is_empty() && folder.fixtures.iter().any(|name| name == FIXTURE)
    };
    folders.retain(|folder| !folder.recordings.is_empty() || is_meant(folder));
    folders.sort_by(|a, b| a.name.cmp(&b.name));
    if folders.is_empty() {
        return Err(CasesError::None(
            "a case is a folder with one fixture (.json) and recordings (.uff, .unv, .csv, .mat)",
        ));
    }
    let case = |folder: FolderOfFiles| {
        let FolderOfFiles { name, path, mut fixtures, mut recordings } = folder;
        fixtures.sort();
        recordings.sort();
        let below = |file: &String| if path.is_empty() { file.clone() } else { format!("{path}/{file}") };
        let fault = match fixtures.as_slice() {
            _ if recordings.is_empty() => Some(format!(
                "{path}: has a fixture and no recording; put its FRFs or hits (.uff, .unv, .csv, .mat) beside it"
            )),
            [_] => None,
            [] => Some(format!(
                "{path}: has recordings and no fixture; put the fixture's JSON file beside them"
            )),
            several => Some(format!(
                "{path}: has {} JSON files ({}) where one fixture is needed; take the others out",
                several.len(),
                several.join(", ")
            )),
        };
        let own = || {
            path.rsplit('/')
                .next()
                .filter(|own| !matches!(*own, "" | "." | ".."))
                .unwrap_or("case")
                .to_owned()
        };
        Case {
            name: if name.is_empty() { own() } else { name },
            fixture: fixtures.first().map(below).unwrap_or_default(),
            recordings: recordings.iter().map(below).collect(),
            fault,
        }
    };
    Ok(folders.into_iter().map(case).collect())
}

/// Length of the folders that all paths begin with.
fn common_folder(paths: &[&str]) -> usize {
    let first = paths.first().copied().unwrap_or_default();
    let ends = first.match_indices(['/', '\\']).map(|(at, _)| at + 1);
    ends.take_while(|end| paths.iter().all(|path| path.starts_with(&first[..*end]))).last().unwrap_or(0)
}

/// A path as a name: without its ending, hyphens between its folders.
fn name_of(path: &str) -> String {
    let parts: Vec<&str> = path.split(['/', '\\']).filter(|part| !matches!(*part, "" | "." | "..")).collect();
    let whole = parts.join("-");
    let stem = match whole.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => whole.as_str(),
    };
    let name: String =
        stem.chars().map(|c| if c.is_control() || ":*?\"<>|".contains(c) { '-' } else { c }).collect();
    if name.is_empty() { "case".to_owned() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        listed(text).unwrap().into_iter().map(|case| case.name).collect()
    }

    #[test]
    fn cases_are_called_by_their_first_recording_without_what_all_have_in_common() {
        assert_eq!(
            names("f.json, /data/day1/a.uff\n\n# no\nf.json,/data/day2/a.uff, x.uff\n"),
            ["day1-a", "day2-a"]
        );
        assert_eq!(names("f.json, a.b.uff"), ["a.b"]);
        assert_eq!(names("one/f.json, a.uff\ntwo/f.json, a.uff\nf.json, b.uff"), ["a-one-f", "a-two-f", "b"]);
    }

    #[test]
    fn a_line_without_a_recording_and_a_case_given_twice_are_placed() {
        assert_eq!(listed("\nf.json\n"), Err(CasesError::NoRecording { line: 2 }));
        let twice = CasesError::Twice { first: 1, second: 3, name: "a-f".into() };
        assert_eq!(listed("f.json, a.uff\nf.json, b.uff\nf.json, a.uff"), Err(twice));
        assert!(matches!(listed("# nothing\n"), Err(CasesError::None(_))));
    }

    #[test]
    fn folders_with_recordings_are_cases_and_those_without_one_fixture_say_so() {
        let folder = |name: &str, fixtures: &[&str], recordings: &[&str]| FolderOfFiles {
            name: name.into(),
            path: format!("all/{name}").trim_end_matches('/').into(),
            fixtures: fixtures.iter().map(|file| file.to_string()).collect(),
            recordings: recordings.iter().map(|file| file.to_string()).collect(),
        };
        let cases = of_folders(vec![
            folder("b", &["f.json", "g.json"], &["1.uff"]),
            folder("a/1", &["f.json"], &["2.uff", "1.uff"]),
            folder("c", &[], &["1.uff"]),
            folder("d", &["fixture.json"], &[]),
            folder("out", &["refitted.json"], &[]),
            folder("", &["fixture.json"], &[]),
        ]);
        let cases = cases.unwrap();
        assert_eq!(cases.len(), 4);
        assert!(cases[3].fault.as_ref().unwrap().contains("all/d: has a fixture and no recording"));
        assert_eq!((cases[0].name.as_str(), cases[0].fixture.as_str()), ("a/1", "all/a/1/f.json"));
        assert_eq!(cases[0].recordings, ["all/a/1/1.uff", "all/a/1/2.uff"]);
        assert!(cases[1].fault.as_ref().unwrap().contains("2 JSON files (f.json, g.json)"));
        assert!(cases[2].fault.as_ref().unwrap().contains("no fixture"));
        assert_eq!(of_folders(vec![folder("", &["f.json"], &["1.uff"])]).unwrap()[0].name, "all");
        assert!(of_folders(vec![folder("", &["f.json"], &[])]).is_err());
    }
}
