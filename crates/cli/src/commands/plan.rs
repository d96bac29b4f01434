//! `jointscope plan`: a fixture and what was measured of it in, what to measure next out.

use std::path::{Path, PathBuf};

use clap::Args;
use jointscope::diagnosis::Observation;
use jointscope::pipeline::MeasuredFrfs;
use jointscope::plan::{Plan, PlanOptions, Remaining, Start, Suggestion, Wanted, WeighedName, weighed_by};
use jointscope::report::{PageContext, plan_page, weighed_page};
use jointscope::{Answer, Band, Fixture, Outcome, SpectralLines, effect_name, plan_file, weighed_file};
use serde_json::Value;

use crate::answered::Destination;
use crate::commands::again::{self, ReadDiagnose};
use crate::commands::diagnose::{self, DiagnoseArguments};
use crate::commands::many::ManyArguments;
use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::{Outputs, counted, pretty};
use crate::progress;
use crate::recording::{ReadingArguments, RecordingArguments};
use crate::refusal::Refusal;
use crate::values::{band, spectral_lines};

/// Options of `jointscope plan`.
#[derive(Debug, Args)]
pub(super) struct PlanArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// What was recorded of it (UFF, UNV, CSV, MAT), which is diagnosed first; or the directory of a
    /// diagnosis, which is made again from its files.
    #[arg(value_name = "F.uff|DIR")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadingArguments,
    /// The directory of a diagnosis, or its diagnosis.json.
    #[arg(long, value_name = "DIR", conflicts_with = "files")]
    pub diagnosis: Option<PathBuf>,
    /// Instead of names: what makes the 95 % interval of a joint's element narrower, half of it stated, such
    /// as J/k11=1% or J/k22=50.
    #[arg(long, value_name = "JOINT/ELEMENT=WIDTH", value_parser = wanted)]
    pub interval: Option<Wanted>,
    /// Lines of a test that nobody has made yet, in Hz, for --interval without recordings.
    #[arg(long, value_name = "FROM:TO:STEP", value_parser = spectral_lines, requires = "interval", conflicts_with = "files")]
    pub lines: Option<SpectralLines>,
    /// A further test of the same structure with a mass added or off its supports: the fixture that describes
    /// it then, and what was recorded.
    #[arg(long, alias = "also", num_args = 2, value_names = ["FIXTURE", "G.uff"], conflicts_with = "interval")]
    pub second_test: Vec<PathBuf>,
    /// The finding whose names are to be told apart, counted from 1 [default: the one that is named least
    /// surely].
    #[arg(long, value_name = "N", conflicts_with = "interval")]
    pub finding: Option<usize>,
    /// Points between which FRFs are considered [default: all of a small structure].
    #[arg(long, value_name = "POINT", num_args = 1..)]
    pub points: Vec<String>,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// Bands to leave out, in Hz, such as mains hum.
    #[arg(long, value_name = "F1:F2", value_parser = band, num_args = 1..)]
    pub exclude: Vec<Band>,
    /// Take numbers of the fixture without a standard deviation as exact.
    #[arg(long)]
    pub exact: bool,
    /// Print plan.json to standard output, for scripts.
    #[arg(long)]
    pub json: bool,
    /// The directory to write plan.json and plan.html to [default: nothing is written].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

/// Reads `JOINT/ELEMENT=WIDTH`.
fn wanted(text: &str) -> Result<Wanted, String> {
    text.parse()
}

/// What was planned, and what it was made of.
struct Planned {
    plan: Plan,
    fixture: Fixture,
    files: Vec<PathBuf>,
    notes: Vec<String>,
}

/// Plans; answers with the suggestions, the best first.
pub(super) fn run(arguments: &PlanArguments, read: ReadDiagnose) -> Result<String, Refusal> {
    let folder = arguments.output.iter();
    let names = folder.flat_map(|folder| FILES.iter().map(|name| folder.join(name)));
    Outputs::foresee(std::iter::once(&arguments.fixture), names)?;
    let planned = match &arguments.interval {
        Some(wanted) => for_interval(arguments, wanted)?,
        None => {
            let diagnosed = diagnosed(arguments, read)?;
            match arguments.second_test.as_slice() {
                [state, recording] => return weighed(arguments, &diagnosed, state, recording),
                _ => between(arguments, diagnosed)?,
            }
        }
    };
    let Planned { plan, fixture, files, notes } = planned;
    let context = origin::context(&files, notes, None)?;
    let page = plan_page(&plan, &fixture, &context).map_err(Refusal::new)?;
    written(arguments, &files, plan_file(&plan), page, &context, summary(&plan))
}

/// A diagnosis, and the arguments with which it was made.
struct Diagnosed {
    arguments: DiagnoseArguments,
    answer: Answer,
}

impl Diagnosed {
    fn files(&self) -> Vec<PathBuf> {
        std::iter::once(&self.arguments.fixture).chain(&self.arguments.recording.files).cloned().collect()
    }

    fn remaining(&self, finding: Option<usize>) -> Result<Remaining, Refusal> {
        let Outcome::Linear(diagnosis) = &self.answer.outcome else {
            return Err(self.arguments.recording.refusal(
                "what was found depends on amplitude, and no plan is made for that; `--interval` plans for a joint's stiffness",
            ));
        };
        Remaining::of(diagnosis, finding).map_err(|error| self.arguments.recording.refusal(error))
    }

    fn options(&self, points: &[String]) -> PlanOptions {
        PlanOptions { points: points.to_vec(), exact: self.arguments.exact }
    }
}

/// The diagnosis of the recordings, or the one of a directory made again.
fn diagnosed(arguments: &PlanArguments, read: ReadDiagnose) -> Result<Diagnosed, Refusal> {
    let of_directory =
        |path: &PathBuf| path.is_dir() || path.extension().is_some_and(|ending| ending == "json");
    let directory = arguments.diagnosis.as_ref().or_else(|| match arguments.files.as_slice() {
        [only] if of_directory(only) => Some(only),
        _ => None,
    });
    let again = match directory {
        Some(path) => again::of_diagnosis(path, &arguments.fixture, read)?,
        None if arguments.files.is_empty() => {
            return Err(Refusal::new(
                "nothing was recorded that could be diagnosed; give the recordings or the directory of a diagnosis, or ask for an interval with `--interval JOINT/k11=1%`",
            ));
        }
        None => DiagnoseArguments {
            fixture: arguments.fixture.clone(),
            recording: recording(arguments),
            baseline: Vec::new(),
            band: arguments.band,
            exclude: arguments.exclude.clone(),
            hold_out: Vec::new(),
            time_limit: None,
            exact: arguments.exact,
            as_stated: false,
            destination: Destination::default(),
            many: ManyArguments::default(),
            estimation: arguments.estimation.clone(),
        },
    };
    let answer = diagnose::telling(|watch| diagnose::diagnosed(&again, watch))?;
    Ok(Diagnosed { answer, arguments: again })
}

fn recording(arguments: &PlanArguments) -> RecordingArguments {
    RecordingArguments { files: arguments.files.clone(), reading: arguments.reading.clone() }
}

/// A plan for the names that are left.
fn between(arguments: &PlanArguments, diagnosed: Diagnosed) -> Result<Planned, Refusal> {
    let remaining = diagnosed.remaining(arguments.finding)?;
    let fixture = diagnosed.answer.fixture.clone();
    let plan = Plan::between(&fixture, &remaining, &diagnosed.options(&arguments.points))
        .map_err(|error| Refusal::at(&arguments.fixture, error))?;
    let files = diagnosed.files();
    Ok(Planned { plan, fixture, files, notes: diagnosed.answer.notes })
}

/// A plan for an interval.
fn for_interval(arguments: &PlanArguments, wanted: &Wanted) -> Result<Planned, Refusal> {
    let file = FixtureFile::read(&arguments.fixture)?;
    let options = PlanOptions { points: arguments.points.clone(), exact: arguments.exact };
    let planned = |fixture: &Fixture, start: &Start| {
        Plan::for_interval(fixture, start, wanted, &options).map_err(|error| file.refusal(error))
    };
    if let Some(lines) = &arguments.lines {
        let plan = planned(&file, &Start::Lines(lines))?;
        let files = vec![arguments.fixture.clone()];
        return Ok(Planned { plan, fixture: file.fixture.clone(), files, notes: Vec::new() });
    }
    if arguments.files.is_empty() {
        return Err(Refusal::new(
            "a plan for an interval needs what was recorded, or the lines of the test to come, such as `--lines 2.5:1000:2.5`",
        ));
    }
    let recording = recording(arguments);
    let estimate = arguments.estimation.for_models();
    let measured = MeasuredFrfs::of(&recording.measurement(&file)?, &estimate)
        .and_then(|measured| measured.screened(&file))
        .map_err(|error| recording.unanswered(&error, &file))?;
    let fixture = measured.as_recorded(&file).map_err(|error| file.refusal(error))?;
    let in_use = |hz: f64| {
        let within = |band: &Band| hz >= band.from && hz <= band.to;
        arguments.band.as_ref().is_none_or(within) && !arguments.exclude.iter().any(within)
    };
    let observation = Observation::new(&measured.frfs, in_use)
        .map_err(|error| recording.refusal(format!("{error}; choose `--band` and `--exclude` anew")))?;
    let plan = planned(&fixture, &Start::Recorded(&observation))?;
    let files = std::iter::once(&arguments.fixture).chain(&arguments.files).cloned().collect();
    Ok(Planned { plan, fixture, files, notes: measured.notes })
}

/// The names with what a further test of a changed structure says of them.
fn weighed(
    arguments: &PlanArguments,
    diagnosed: &Diagnosed,
    state: &Path,
    recorded: &Path,
) -> Result<String, Refusal> {
    let remaining = diagnosed.remaining(arguments.finding)?;
    let state = FixtureFile::read(state)?;
    let recording = diagnosed.arguments.recording.of_files(&[recorded.to_owned()]);
    let estimate = diagnosed.arguments.estimation.for_models();
    let measured = MeasuredFrfs::of(&recording.measurement(&state)?, &estimate)
        .and_then(|measured| measured.screened(&state))
        .map_err(|error| recording.unanswered(&error, &state))?;
    let observation = Observation::new(&measured.frfs, |_| true).map_err(|error| recording.refusal(error))?;
    let seen = measured.as_recorded(&state).map_err(|error| state.refusal(error))?;
    let options = diagnosed.options(&arguments.points);
    let weighed = weighed_by(&diagnosed.answer.fixture, &remaining, (&seen, &observation), &options)
        .map_err(|error| state.refusal(error))?;
    let files = [diagnosed.files(), arguments.second_test.clone()].concat();
    let notes = [diagnosed.answer.notes.clone(), measured.notes].concat();
    let context = origin::context(&files, notes, None)?;
    let page = weighed_page(&weighed, &state, &context).map_err(Refusal::new)?;
    let name = |name: &WeighedName| {
        format!(
            "  {}: {:.1} %, after {:.1} % without the further test",
            effect_name(&name.effect),
            100.0 * name.probability,
            100.0 * name.before
        )
    };
    let lines = std::iter::once(weighed.says.clone())
        .chain(weighed.names.iter().map(name))
        .chain(weighed.remarks.iter().map(|remark| format!("{remark}.")));
    written(arguments, &files, weighed_file(&weighed), page, &context, lines.collect())
}

/// What the command writes.
const FILES: [&str; 2] = ["plan.json", "plan.html"];

fn outputs(arguments: &PlanArguments, files: &[PathBuf], contents: [String; 2]) -> Outputs {
    let mut outputs = Outputs::new(std::iter::once(&arguments.fixture).chain(files));
    if let Some(folder) = &arguments.output {
        for (name, contents) in FILES.into_iter().zip(contents) {
            outputs.add(folder.join(name), contents);
        }
    }
    outputs
}

/// Writes plan.json with what it was made of, and the page; answers with these lines, or with the file.
fn written(
    arguments: &PlanArguments,
    files: &[PathBuf],
    mut file: Value,
    page: String,
    context: &PageContext,
    mut lines: Vec<String>,
) -> Result<String, Refusal> {
    origin::add(&mut file, context);
    let file = pretty(&file);
    outputs(arguments, files, [file.clone(), page]).write()?;
    context.notes.iter().for_each(|note| progress::notice(note));
    if arguments.json {
        return Ok(file.trim_end().to_owned());
    }
    lines.extend(arguments.output.iter().map(|folder| folder.join(FILES[1]).display().to_string()));
    Ok(lines.join("\n"))
}

/// Suggestions that are listed in the terminal.
const LISTED: usize = 8;

/// What a plan comes to, a line each.
fn summary(plan: &Plan) -> Vec<String> {
    let mut lines = vec![plan.question.clone(), plan.says.clone()];
    if !plan.suggestions.is_empty() {
        let width =
            plan.suggestions.iter().take(LISTED).map(|s| s.measure.chars().count()).max().unwrap_or(0);
        let heading = match plan.names.is_empty() {
            true => "95 % interval then",
            false => "one name ≥ 90 %   ln of the odds",
        };
        lines.push(format!("  {:<width$}   {heading}   effort", ""));
        lines.extend(plan.suggestions.iter().take(LISTED).map(|suggestion| row(suggestion, width)));
    }
    if plan.suggestions.len() > LISTED {
        lines.push(format!("  and {}", counted(plan.suggestions.len() - LISTED, "other")));
    }
    lines.extend(plan.remarks.iter().map(|remark| format!("{remark}.")));
    lines
}

fn row(suggestion: &Suggestion, width: usize) -> String {
    let brings = match &suggestion.interval {
        Some(interval) => {
            let mark = if interval.reaches { " *" } else { "" };
            format!("{:>18}", format!("± {:.3e} {}{mark}", interval.then, interval.unit))
        }
        None => {
            let odds = suggestion.expected_log_odds.unwrap_or(0.0);
            let odds = if odds > 100.0 { "> 100 nats".to_owned() } else { format!("{odds:.1} nats") };
            let sure = suggestion.sure.unwrap_or(0.0);
            let sure = if sure > 0.99 { "> 99 %".to_owned() } else { format!("{:.0} %", 100.0 * sure) };
            format!("{sure:>15}   {odds:>15}")
        }
    };
    let effort = counted(suggestion.effort.round() as usize, "FRF");
    format!("  {:<width$}   {brings}   {effort:>6}", suggestion.measure)
}
