//! `jointscope decompose`: a fixture and recordings in, the joint's stiffness and damping and a page out.

use std::path::PathBuf;

use clap::Args;
use jointscope::cases::Command;
use jointscope::pipeline::{DecomposeOptions, decompose};
use jointscope::report::joint_report;
use jointscope::wording::Summary;
use jointscope::{AnalysisOptions, Band, Relation, Remarks, fitted_frfs, joint_file};

use super::many::{self, ManyArguments, Task};
use crate::answered::{Also, Answered, Destination, PAGE};
use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::pretty;
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use crate::said::Said;
use crate::values::{band, one_of};

#[derive(Debug, Clone, Args)]
pub(super) struct DecomposeArguments {
    /// The fixture file (JSON); without recordings, a folder of cases or a list of them.
    pub fixture: PathBuf,
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// The joint to find; all at once, by a fit to all FRFs, where the fixture has several and none is named.
    #[arg(long, value_name = "J")]
    pub joint: Option<String>,
    /// Band of the averages and of the fit in Hz [default: the quietest band, and all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// How K and C follow from the FRFs: `exact`, or eq (7) of the `paper` without the transport across the
    /// joint.
    #[arg(long, value_parser = one_of(&RELATIONS), default_value = "exact")]
    pub relation: Relation,
    /// Take numbers of the fixture without a standard deviation as exact.
    #[arg(long)]
    pub exact: bool,
    #[command(flatten)]
    pub destination: Destination,
    #[command(flatten)]
    pub many: ManyArguments,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

const RELATIONS: [(&str, Relation); 2] = [("exact", Relation::Exact), ("paper", Relation::Paper)];

/// Decomposes and writes `stiffness.json` and `report.html`; answers with what was found and where the page
/// is, or with `stiffness.json` itself. Many cases each get a directory.
pub(super) fn run(arguments: &DecomposeArguments) -> Result<Said, Refusal> {
    if arguments.recording.files.is_empty() {
        let task = Task {
            command: Command::Decompose,
            cases: &arguments.fixture,
            many: &arguments.many,
            destination: &arguments.destination,
        };
        return many::run(&task, |case| {
            let mut single = arguments.clone();
            (single.fixture, single.recording.files) = (case.fixture.clone(), case.recordings.clone());
            found(&single, case.command.to_owned(), true)
        });
    }
    arguments.many.unused()?;
    arguments.destination.foresee(inputs(arguments), &[FILE, PAGE])?;
    found(arguments, origin::command_line(), false)?
        .end(&arguments.destination, inputs(arguments))
        .map(Said::from)
}

/// What the command reads.
fn inputs(arguments: &DecomposeArguments) -> impl Iterator<Item = &PathBuf> {
    std::iter::once(&arguments.fixture).chain(&arguments.recording.files)
}

/// The joint in the recordings, or all of them, where one alone is not asked for; `command` is the line that
/// gives this answer.
fn found(arguments: &DecomposeArguments, command: String, one_joint: bool) -> Result<Answered, Refusal> {
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let measurement = arguments.recording.measurement(&fixture)?;
    let unused = arguments.estimation.unused_with(&measurement);
    let options = DecomposeOptions {
        analysis: AnalysisOptions {
            joint: arguments.joint.clone(),
            relation: arguments.relation,
            band: arguments.band,
            exact: arguments.exact,
            laws: true,
        },
        estimate: arguments.estimation.for_models(),
        one_joint,
    };
    let mut decomposition = decompose(&fixture, measurement, &options)
        .map_err(|error| arguments.recording.unanswered(&error, &fixture))?;
    let notes = decomposition.notes.iter().cloned().chain(unused).chain(decomposition.remarks());
    let notes: Vec<String> = notes.collect();
    let hammer_test = decomposition.hammer_test.take();
    let context = origin::context_of(command, inputs(arguments), notes, hammer_test)?;
    let mut file = joint_file(&decomposition);
    origin::add(&mut file, &context);
    let mut answered = Answered {
        answer: (FILE, pretty(&file)),
        others: Vec::new(),
        elsewhere: Vec::new(),
        report: joint_report(&decomposition, &context),
        frfs: Vec::new(),
        summary: decomposition.summary(),
        notes: context.notes,
    };
    if arguments.destination.also.contains(&Also::Uff) {
        match decomposition.fit() {
            Some(fit) => {
                answered.frfs = fitted_frfs(fit, &decomposition.fixture).map_err(Refusal::new)?;
            }
            None => answered.notes.push(
                "no FRFs are written: there is no joint from all FRFs, and K and C by line are no FRFs"
                    .to_owned(),
            ),
        }
    }
    Ok(answered)
}

const FILE: &str = "stiffness.json";
