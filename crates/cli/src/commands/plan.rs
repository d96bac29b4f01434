//! `jointscope plan`: a fixture and what was measured of it in, what to measure next out.

use std::path::PathBuf;

use clap::Args;
use jointscope::estimation::ResponseWindow;
use jointscope::pipeline::{Options, Progress};
use jointscope::plan::{Plan, PlanOptions, Remaining};
use jointscope::{Band, DiagnosisOptions, Outcome, diagnose, plan_file};
use jointscope::diagnosis::Step;

use crate::estimation_arguments::EstimationArguments;
use crate::input::{self, FixtureFile};
use crate::origin;
use crate::output::{Outputs, pretty};
use crate::progress::Steps;
use crate::recording::{ReadingArguments, RecordingArguments};
use crate::refusal::Refusal;
use crate::values::band;

/// Options of `jointscope plan`.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// What was recorded of it (UFF, UNV, CSV, MAT), which is diagnosed first.
    #[arg(value_name = "F.uff")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadingArguments,
    /// The finding whose names are to be told apart, counted from 1 [default: the one that is named least surely].
    #[arg(long, value_name = "N")]
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

/// Plans; answers with the suggestions, the best first.
pub fn run(arguments: &PlanArguments) -> Result<String, Refusal> {
    input::once(std::iter::once(&arguments.fixture).chain(&arguments.files))?;
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let recording = RecordingArguments { files: arguments.files.clone(), reading: arguments.reading.clone() };
    let measurement = recording.measurement(&fixture)?;
    let options = Options {
        diagnosis: DiagnosisOptions {
            band: arguments.band.map(|band| (band.from, band.to)),
            exclude: arguments.exclude.iter().map(|band| (band.from, band.to)).collect(),
            exact: arguments.exact,
            ..DiagnosisOptions::default()
        },
        estimate: arguments.estimation.options(ResponseWindow::Auto),
        as_stated: false,
    };
    let steps = Steps::new();
    let answer = diagnose(&fixture, &measurement, &options, |progress| match progress {
        Progress::Searching { frfs, lines } => steps.over(&format!("{frfs} FRFs on {lines} lines")),
        Progress::Searched(Step::Stage(what)) => steps.stage(what),
        Progress::Searched(step) => steps.within(|| step.to_string()),
    });
    steps.finish();
    let answer = answer.map_err(|error| recording.unanswered(&error, &fixture))?;
    let Outcome::Linear(diagnosis) = &answer.outcome else {
        return Err(recording.refusal("what was found depends on amplitude; plans are made for linear findings only"));
    };
    let remaining = Remaining::of(diagnosis, arguments.finding).map_err(|error| recording.refusal(error))?;
    let asked = PlanOptions { points: arguments.points.clone(), exact: arguments.exact };
    let plan = Plan::between(&answer.fixture, &remaining, &asked).map_err(|error| fixture.refusal(error))?;
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.files);
    let context = origin::context(files(), answer.notes.clone(), None)?;
    let mut file = plan_file(&plan);
    origin::add(&mut file, &context);
    let file = pretty(&file);
    if let Some(folder) = &arguments.output {
        let mut outputs = Outputs::new(files());
        outputs.add(folder.join("plan.json"), file.clone());
        outputs.write()?;
    }
    if arguments.json {
        return Ok(file.trim_end().to_owned());
    }
    let mut lines = vec![plan.question.clone()];
    lines.extend(plan.suggestions.iter().map(|s| s.says.clone()));
    lines.push(plan.says.clone());
    lines.extend(plan.remarks.iter().cloned());
    Ok(lines.join("\n"))
}
