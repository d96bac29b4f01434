//! The files of a test, and how they are read.

use std::path::PathBuf;

use clap::Args;
use jointscope::Measurement;
use jointscope::import::{ColumnMap, ColumnMapError};
use jointscope::pipeline::{Concern, Error, MeasurementError};
use jointscope::recordings::{
    AssumedUnits, ChannelMap, ChannelMapError, ReadOptions, Recording, RecordingError, Source,
};

use crate::input::{self, FixtureFile};
use crate::names::names;
use crate::refusal::Refusal;

/// Recordings and what the analyst says of them, for every command that reads FRFs or time histories.
#[derive(Debug, Clone, Args)]
pub(crate) struct RecordingArguments {
    /// The recordings (UFF, UNV, CSV, MAT): all files of one test, in any order; `-` is standard input.
    #[arg(required = true, value_name = "F.uff")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadingArguments,
}

/// What the analyst says of recordings where the files do not.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ReadingArguments {
    /// Which channel of the files is which of the fixture: +z=+y for all nodes, 101:+z=1:+y for one, which
    /// beats it, "10*:+z=*:+y" for nodes by their digits.
    #[arg(long, value_name = "[NODE:]DIR=[POINT:]DIR", value_parser = map_entry, num_args = 1..)]
    pub map: Vec<String>,
    /// Units of response and force where a file states none, such as g,lbf.
    #[arg(long, value_name = "RESPONSE,FORCE", value_parser = AssumedUnits::parse)]
    pub assume_units: Option<AssumedUnits>,
    /// Which column of a CSV file or variable of a MATLAB file is which FRF, in which unit, such as "H1=4/1
    /// [m/s^2/N]".
    #[arg(long, value_name = "NAME=OUT/IN [UNIT]", value_parser = column_entry, num_args = 1..)]
    pub columns: Vec<String>,
    /// Number of averages of every FRF, where the files do not state it: with it, coherence tells the noise.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub averages: Option<u32>,
    /// Leave coherences aside, and take the noise from the scatter over the lines.
    #[arg(long)]
    pub ignore_coherence: bool,
    /// Whether other files of the same command may use the entries of `columns`.
    #[arg(skip)]
    pub beside_others: bool,
}

impl RecordingArguments {
    /// Files that say all that there is to know of them.
    pub(crate) fn plain(files: Vec<PathBuf>) -> Self {
        RecordingArguments { files, reading: ReadingArguments::default() }
    }

    /// The arguments as options of the reading.
    pub(crate) fn options(&self) -> Result<ReadOptions, Refusal> {
        let ReadingArguments { map, assume_units, averages, ignore_coherence, .. } = self.reading.clone();
        let map = ChannelMap::parse(&map).map_err(Refusal::new)?;
        Ok(ReadOptions { map, assume_units, averages, ignore_coherence })
    }

    /// Other files, read alike.
    pub(crate) fn of_files(&self, files: &[PathBuf]) -> Self {
        let reading = ReadingArguments { beside_others: true, ..self.reading.clone() };
        RecordingArguments { files: files.to_vec(), reading }
    }

    /// The files as they are.
    pub(crate) fn sources(&self) -> Result<Vec<Source>, Refusal> {
        let columns = ColumnMap::parse(&self.reading.columns).map_err(Refusal::new)?;
        let (sources, unused) = input::sources(&self.files, &columns)?;
        // An entry that applies to nothing is a slip.
        match unused.into_iter().next().filter(|_| !self.reading.beside_others) {
            None => Ok(sources),
            Some(entry) => Err(self.refusal(format_args!(
                "the entry `{entry}` of `--columns` names no column, variable or file of one FRF; universal files name their nodes themselves (`--map`)"
            ))),
        }
    }

    /// The FRFs of a test of the fixture.
    pub(crate) fn recording(&self, fixture: &FixtureFile) -> Result<Recording, Refusal> {
        let options = self.options()?;
        Recording::of(&self.sources()?, fixture, &options)
            .map_err(|error| self.unreadable(error.into(), Some(fixture)))
    }

    /// The FRFs of a test of a structure that no fixture describes.
    pub(crate) fn recording_of_nodes(&self) -> Result<Recording, Refusal> {
        let options = self.options()?;
        Recording::of_nodes(&self.sources()?, &options).map_err(|error| self.unreadable(error.into(), None))
    }

    /// What a test of the fixture recorded, FRFs or hits.
    pub(crate) fn measurement(&self, fixture: &FixtureFile) -> Result<Measurement, Refusal> {
        let sources = self.sources()?;
        Measurement::of(&sources, fixture, &self.options()?)
            .map_err(|error| self.unreadable(error, Some(fixture)))
    }

    /// Why the files are no recording (of the fixture, if there is one).
    pub(crate) fn unreadable(&self, error: MeasurementError, fixture: Option<&FixtureFile>) -> Refusal {
        use RecordingError as E;
        match (error, fixture) {
            (MeasurementError::Recording(error @ E::MapPoint { .. }), Some(fixture)) => {
                fixture.refusal(error)
            }
            // These name their files, and the function in them.
            (
                MeasurementError::Recording(
                    error @ (E::Function { .. }
                    | E::Twice { .. }
                    | E::Lines { .. }
                    | E::Windows { .. }
                    | E::OnlyTimeHistories { .. }
                    | E::NoFrf { .. }
                    | E::NotPerForce { .. }),
                ),
                _,
            ) => Refusal::new(error),
            (MeasurementError::Hits(error), _) => Refusal::new(error),
            (error, _) => self.refusal(error),
        }
    }

    /// Why there is no answer, behind the name of the file that this is about.
    pub(crate) fn unanswered(&self, error: &Error, fixture: &FixtureFile) -> Refusal {
        match error.concern() {
            Concern::Fixture => fixture.refusal(error),
            Concern::Recording => self.refusal(error),
            Concern::Options => Refusal::new(error),
        }
    }

    /// A sentence about all the files.
    pub(crate) fn refusal(&self, problem: impl std::fmt::Display) -> Refusal {
        Refusal::new(format_args!("{}: {problem}", names(&self.files)))
    }
}

/// One entry of `--columns`, checked by itself.
pub(crate) fn column_entry(text: &str) -> Result<String, ColumnMapError> {
    ColumnMap::parse([text]).map(|_| text.to_owned())
}

/// One map entry, checked by itself; entries are checked against each other in
/// [`RecordingArguments::options`].
pub(crate) fn map_entry(text: &str) -> Result<String, ChannelMapError> {
    ChannelMap::parse([text]).map(|_| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::fs;

    use clap::Parser;
    use jointscope::recordings::to_datasets;
    use jointscope::spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
    use jointscope::uff::Encoding;

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
            fs::write(path.join("f.uff"), jointscope::uff::write(&datasets).unwrap()).unwrap();
            Bench(path)
        }

        fn read(&self, file: &str, map: &[&str]) -> Result<Recording, String> {
            let arguments = RecordingArguments {
                files: vec![self.0.join(file)],
                reading: ReadingArguments {
                    map: map.iter().map(|entry| entry.to_string()).collect(),
                    ..ReadingArguments::default()
                },
            };
            let path = self.0.join("one.json");
            fs::write(&path, FIXTURE).unwrap();
            let fixture = FixtureFile::read(&path).unwrap();
            arguments.recording(&fixture).map_err(|refusal| refusal.to_string())
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
        holds(&bench.read("g.uff", &[]).unwrap_err(), &["g.uff", "is a JSON file, such as a fixture"]);
    }

    #[test]
    fn nodes_beyond_the_fixture_name_the_files_and_the_remedy() {
        let bench = Bench::new("nodes", "101");
        holds(&bench.read("f.uff", &[]).unwrap_err(), &["f.uff: no FRF", "`--map 101:+y=1:+y`"]);
        assert!(bench.read("f.uff", &["101:+y=1:+y"]).is_ok());
        holds(&bench.read("f.uff", &["101:+y=9:+y"]).unwrap_err(), &["one.json: the map entry", "`9`"]);
    }

    #[test]
    fn recordings_come_with_their_map_and_units() {
        #[derive(Debug, Parser)]
        struct Reading {
            #[command(flatten)]
            recording: RecordingArguments,
        }
        let parse = |words: &[&str]| Reading::try_parse_from(["reading"].iter().chain(words));
        let reading =
            parse(&["a.uff", "b.uff", "--map", "101:z=1:y", "102:z=2:y", "--assume-units", "g,lbf"]);
        let recording = reading.unwrap().recording;
        assert_eq!(recording.files.len(), 2);
        let options = recording.options().unwrap();
        assert_eq!(options.map.entries().len(), 2);
        assert!(options.assume_units.is_some());
        assert!(parse(&[]).is_err());
        assert!(parse(&["a.uff", "--map", "101=1"]).unwrap_err().to_string().contains("101:+z=1:+y"));
        assert!(parse(&["a.uff", "--assume-units", "g"]).unwrap_err().to_string().contains("`g,lbf`"));
        let twice = parse(&["a.uff", "--map", "1:z=1:y", "--map", "1:-z=2:y"]).unwrap();
        assert!(twice.recording.options().unwrap_err().to_string().contains("same channel"));
    }
}
