//! `jointscope diagnose`: a fixture and recordings in, what the fixture leaves out and a page out.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use jointscope::cases::Command;
use jointscope::diagnosis::Step;
use jointscope::pipeline::{Alike, MeasuredFrfs, Options, Progress};
use jointscope::report::answer_report;
use jointscope::spectra::FrfPair;
use jointscope::{Answer, Band, DiagnosisOptions, answer_file, diagnose, model_frfs};

use super::many::{self, ManyArguments, Task};
use crate::answered::{Also, Answered, Destination, PAGE};
use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::pretty;
use crate::progress::Steps;
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use crate::said::Said;
use crate::values::{band, frf_pair, seconds};

#[derive(Debug, Clone, Args)]
pub(crate) struct DiagnoseArguments {
    /// The fixture file (JSON); without recordings, a folder of cases or a list of them.
    pub fixture: PathBuf,
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// A recording of the same structure when it was known to be right: what has changed since is diagnosed.
    /// May be given again.
    #[arg(long, value_name = "B.uff")]
    pub baseline: Vec<PathBuf>,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// Bands to leave out, in Hz, such as mains hum.
    #[arg(long, value_name = "F1:F2", value_parser = band, num_args = 1..)]
    pub exclude: Vec<Band>,
    /// FRFs to judge by, which no fit sees [default: one, where there are four or more].
    #[arg(long, value_name = "OUT/IN", value_parser = frf_pair, num_args = 1..)]
    pub hold_out: Vec<FrfPair>,
    /// Seconds after which the search ends with what it has found [default: it ends after a fixed amount of
    /// work, most of a minute].
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub time_limit: Option<Duration>,
    /// Take numbers of the fixture without a standard deviation as exact.
    #[arg(long)]
    pub exact: bool,
    /// Take numbers of the fixture as they are stated, even where they belong to no structure together.
    #[arg(long)]
    pub as_stated: bool,
    #[command(flatten)]
    pub destination: Destination,
    #[command(flatten)]
    pub many: ManyArguments,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

/// Diagnoses, and writes `diagnosis.json`, `refitted.json`, `repaired.json` and `report.html`; answers with
/// what was found and where the page is, or with `diagnosis.json` itself. Many cases each get a directory.
pub(super) fn run(arguments: &DiagnoseArguments) -> Result<Said, Refusal> {
    if arguments.recording.files.is_empty() {
        let task = Task {
            command: Command::Diagnose,
            cases: &arguments.fixture,
            many: &arguments.many,
            destination: &arguments.destination,
        };
        if !arguments.baseline.is_empty() {
            return Err(Refusal::new("--baseline is of one test: diagnose the cases one by one with it"));
        }
        return many::run(&task, |case| {
            let mut single = arguments.clone();
            (single.fixture, single.recording.files) = (case.fixture.clone(), case.recordings.clone());
            found(&single, case.command.to_owned(), |_| ())
        });
    }
    arguments.many.unused()?;
    arguments.destination.foresee(inputs(arguments), &FILES)?;
    let answered = telling(|watch| found(arguments, origin::command_line(), watch));
    answered?.end(&arguments.destination, inputs(arguments)).map(Said::from)
}

/// Tells what a diagnosis is doing while it does it.
pub(super) fn telling<T>(diagnosis: impl FnOnce(&(dyn Fn(Progress) + Sync)) -> T) -> T {
    let steps = Steps::new();
    let done = diagnosis(&|progress| match progress {
        Progress::Searching { frfs, lines } => steps.over(&format!("{frfs} FRFs on {lines} lines")),
        Progress::Searched(Step::Stage(what)) => steps.stage(what),
        Progress::Searched(step) => steps.within(|| step.to_string()),
    });
    steps.finish();
    done
}

/// What the fixture leaves out of the recordings; `command` is the line that gives this answer.
fn found(
    arguments: &DiagnoseArguments,
    command: String,
    watch: impl Fn(Progress) + Sync,
) -> Result<Answered, Refusal> {
    answered(arguments, command, &diagnosed(arguments, watch)?)
}

/// What the fixture leaves out of the recordings, nothing written.
pub(super) fn diagnosed(
    arguments: &DiagnoseArguments,
    watch: impl Fn(Progress) + Sync,
) -> Result<Answer, Refusal> {
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let measurement = arguments.recording.measurement(&fixture)?;
    let mut estimate = arguments.estimation.for_models();
    let (mut baseline, mut unlike) = (None, None);
    if !arguments.baseline.is_empty() {
        let recording = arguments.recording.of_files(&arguments.baseline);
        let before = recording.measurement(&fixture)?;
        Alike { estimate, note: unlike } = Alike::of(&before, &measurement, &estimate);
        let measured = MeasuredFrfs::of(&before, &estimate).and_then(|measured| measured.screened(&fixture));
        baseline = Some(measured.map_err(|error| recording.unanswered(&error, &fixture))?.frfs);
    }
    let options = Options {
        diagnosis: DiagnosisOptions {
            band: arguments.band.map(|band| (band.from, band.to)),
            exclude: arguments.exclude.iter().map(|band| (band.from, band.to)).collect(),
            hold_out: arguments.hold_out.clone(),
            time_limit: arguments.time_limit,
            exact: arguments.exact,
            baseline,
            ..DiagnosisOptions::default()
        },
        estimate,
        as_stated: arguments.as_stated,
    };
    let answer = diagnose(&fixture, &measurement, &options, watch);
    let mut answer = answer.map_err(|error| arguments.recording.unanswered(&error, &fixture))?;
    answer.notes.extend(arguments.estimation.unused_with(&measurement));
    answer.notes.extend(unlike);
    Ok(answer)
}

/// What the command reads.
fn inputs(arguments: &DiagnoseArguments) -> impl Iterator<Item = &PathBuf> {
    std::iter::once(&arguments.fixture).chain(&arguments.recording.files).chain(&arguments.baseline)
}

/// What the command writes.
const FILES: [&str; 4] = ["diagnosis.json", "refitted.json", "repaired.json", PAGE];

/// The files of an answer.
fn answered(arguments: &DiagnoseArguments, command: String, answer: &Answer) -> Result<Answered, Refusal> {
    let context =
        origin::context_of(command, inputs(arguments), answer.notes.clone(), answer.hammer_test.clone())?;
    let mut file = answer_file(answer);
    origin::add(&mut file, &context);
    let report = answer_report(answer, &context);
    let mut notes = context.notes;
    let mut frfs = Vec::new();
    if arguments.destination.also.contains(&Also::Uff) {
        frfs = model_frfs(answer).map_err(Refusal::new)?;
        if frfs.is_empty() {
            notes.push("no FRFs are written: the answer rests on motion over time or on levels, not on one set of FRFs".to_owned());
        }
    }
    Ok(Answered {
        notes,
        answer: (FILES[0], pretty(&file)),
        others: vec![(FILES[1], answer.refitted.to_json()), (FILES[2], answer.repaired.to_json())],
        elsewhere: Vec::new(),
        report,
        frfs,
        summary: answer.summary(),
    })
}
