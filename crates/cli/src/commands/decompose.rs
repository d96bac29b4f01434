//! `jointscope decompose`: a fixture and recordings in, the joint's stiffness and damping and a page out.

use std::path::PathBuf;

use clap::Args;
use jointscope::cases::Command;
use jointscope::decomposition::{JointFit, JointsFit, LikelihoodFit};
use jointscope::estimation::ResponseWindow;
use jointscope::pipeline::{DecomposeOptions, Joints, decompose};
use jointscope::report::format::quantity;
use jointscope::report::joint_report;
use jointscope::{Analysis, AnalysisOptions, Band, Relation, Remarks, fitted_frfs, joint_file};

use super::Said;
use super::many::{self, ManyArguments, Task};
use crate::answered::{Also, Answered, Destination, PAGE};
use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::{counted, pretty};
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use crate::values::{band, one_of};

#[derive(Debug, Clone, Args)]
pub struct DecomposeArguments {
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
    /// How K and C follow from the FRFs: `exact`, or eq (7) of the `paper` without the transport across the joint.
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

/// Decomposes and writes `stiffness.json` and `report.html`; answers with what was found and where the page is, or with `stiffness.json` itself.
/// Many cases each get a directory.
pub fn run(arguments: &DecomposeArguments) -> Result<Said, Refusal> {
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

/// The joint in the recordings, or all of them, where one alone is not asked for; `command` is the line that gives this answer.
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
        estimate: arguments.estimation.options(ResponseWindow::Auto),
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
        summary: match &decomposition.found {
            Joints::One(analysis) => summary(analysis),
            Joints::AtOnce(joints) => summary_of_several(joints),
        },
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

/// What was found of every joint, a line each.
fn summary_of_several(fit: &JointsFit) -> Vec<String> {
    let mut lines = Vec::new();
    for joint in &fit.joints {
        lines.push(format!("joint {}", joint.name));
        lines.extend(numbers(&joint.fit, elements_of(joint.fit.scalar)));
        lines.extend(joint.remarks());
    }
    lines.extend(fit.joints.first().map(|first| basis(&first.fit)));
    lines.extend(fit.remarks());
    lines
}

/// What was found, a line each.
fn summary(analysis: &Analysis) -> Vec<String> {
    let spectrum = &analysis.spectrum;
    let all = spectrum.solved.len() + spectrum.masked.len();
    let mut lines =
        vec![format!("joint {}: {} of {all} lines solved", analysis.joint, spectrum.solved.len())];
    for (reason, count) in spectrum.masked_summary() {
        lines.push(format!("{} masked: {}", counted(count, "line"), reason.why()));
    }
    match analysis.noisy_lines() {
        0 => {}
        1 => lines.push("1 line is dominated by noise; its interval is only indicative".to_owned()),
        noisy => {
            lines.push(format!("{noisy} lines are dominated by noise; their intervals are only indicative"))
        }
    }
    let elements = elements_of(spectrum.scalar);
    match (&analysis.joint_fit, &analysis.likelihood) {
        (Ok(fit), _) => lines.extend(all_frfs(fit, elements)),
        (Err(error), Ok(fit)) => {
            lines.push(format!("{error}; from the FRFs across the joint alone:"));
            lines.extend(across(analysis, fit, elements));
        }
        (Err(error), Err(_)) => lines.push(error.to_string()),
    }
    lines
}

const UNITS: [[&str; 3]; 2] = [["N/m", "N/rad", "N*m/rad"], ["N*s/m", "N*s/rad", "N*m*s/rad"]];

/// The elements of a symmetric matrix, or the one that means anything where bodies do not rotate.
fn elements_of(scalar: bool) -> &'static [(usize, usize)] {
    if scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 1)] }
}

/// The joint from all FRFs, an element a line, and what is to be known of it.
fn all_frfs(fit: &JointFit, elements: &[(usize, usize)]) -> Vec<String> {
    let mut lines = numbers(fit, elements);
    lines.push(basis(fit));
    lines.extend(fit.remarks());
    lines
}

fn numbers(fit: &JointFit, elements: &[(usize, usize)]) -> Vec<String> {
    let (k_std, c_std) = fit.std();
    let parts = [("k", &fit.stiffness, k_std), ("c", &fit.damping, c_std)];
    let mut lines = Vec::new();
    for ((symbol, value, std), units) in parts.into_iter().zip(UNITS) {
        for &(i, j) in elements {
            let text = quantity(value.at(i, j), std.at(i, j), units[i + j]);
            lines.push(format!("{symbol}{}{} = {text}", i + 1, j + 1));
        }
    }
    lines
}

/// What a fit rests on.
fn basis(fit: &JointFit) -> String {
    let fixture = match fit.quantities.is_empty() {
        true => "the fixture taken as exact",
        false => "the fixture moving within its tolerances",
    };
    format!(
        "from {} over {}, {fixture}; chi2 per degree of freedom {:.3}",
        counted(fit.frfs.len(), "FRF"),
        counted(fit.lines, "line"),
        fit.chi2_per_dof
    )
}

/// The joint from the FRFs across it, with the fixture taken as exact.
fn across(analysis: &Analysis, fit: &LikelihoodFit, elements: &[(usize, usize)]) -> Vec<String> {
    let (k_fixture, c_fixture) = analysis.tolerance_of_likelihood();
    let (k_model, c_model) = fit.model_std();
    let parts = [
        ("k", &fit.stiffness, [fit.stiffness_std, k_fixture, k_model]),
        ("c", &fit.damping, [fit.damping_std, c_fixture, c_model]),
    ];
    let mut lines = Vec::new();
    for ((symbol, value, shares), units) in parts.into_iter().zip(UNITS) {
        for &(i, j) in elements {
            let std = shares.iter().map(|share| share.at(i, j).powi(2)).sum::<f64>().sqrt();
            let text = quantity(value.at(i, j), std, units[i + j]);
            lines.push(format!("{symbol}{}{} = {text}", i + 1, j + 1));
        }
    }
    lines.push(format!("chi2 per degree of freedom of this constant joint: {:.3}", fit.chi2_per_dof));
    if !fit.explains() {
        lines.push(
            "with the fixture as stated, a constant joint does not explain the FRFs within their noise; the ± allow for \
             it as far as the band shows, and the page says what may be behind it"
                .to_owned(),
        );
    }
    lines
}
