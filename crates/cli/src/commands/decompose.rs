//! `jointscope decompose`: a fixture and recordings in, the joint's stiffness and damping and a page out.

use std::path::PathBuf;

use clap::Args;
use jointscope::cases::Command;
use jointscope::decomposition::{
    JointFit, JointFitOptions, JointsFit, LikelihoodFit, SeveralError, SidesError, fit_joints,
};
use jointscope::estimation::ResponseWindow;
use jointscope::pipeline::MeasuredFrfs;
use jointscope::report::format::quantity;
use jointscope::report::{PageContext, Report, decomposition_report, joints_report};
use jointscope::wording::merging;
use jointscope::{
    Analysis, AnalysisOptions, Band, DecompositionError, Fixture, Relation, Remarks, fitted_frfs,
    joints_file, stiffness_file,
};

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
            found(&single, case.command.to_owned(), Joints::One)
        });
    }
    arguments.many.unused()?;
    arguments.destination.foresee(inputs(arguments), &[FILE, PAGE])?;
    found(arguments, origin::command_line(), Joints::Any)?
        .end(&arguments.destination, inputs(arguments))
        .map(Said::from)
}

/// What the command reads.
fn inputs(arguments: &DecomposeArguments) -> impl Iterator<Item = &PathBuf> {
    std::iter::once(&arguments.fixture).chain(&arguments.recording.files)
}

/// How many joints an answer may hold.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Joints {
    /// One, as a row of a table does.
    One,
    /// As many as there are.
    Any,
}

/// The joint in the recordings, or all of them; `command` is the line that gives this answer.
fn found(arguments: &DecomposeArguments, command: String, joints: Joints) -> Result<Answered, Refusal> {
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let measurement = arguments.recording.measurement(&fixture)?;
    let unused = arguments.estimation.unused_with(&measurement);
    let measured = MeasuredFrfs::of(&measurement, &arguments.estimation.options(ResponseWindow::Auto));
    drop(measurement); // as much memory as the recording
    let mut measured = measured
        .and_then(|measured| measured.screened(&fixture))
        .map_err(|error| arguments.recording.unanswered(&error, &fixture))?;
    measured.notes.extend(unused);
    let as_recorded = measured.as_recorded(&fixture).map_err(|error| fixture.refusal(error))?;
    let options = AnalysisOptions {
        joint: arguments.joint.clone(),
        relation: arguments.relation,
        band: arguments.band,
        exact: arguments.exact,
        laws: true,
    };
    let count = as_recorded.joints().len();
    if arguments.joint.is_none() && count > 1 {
        if joints == Joints::One {
            return Err(fixture.refusal(format!(
                "has {count} joints, and a row of the table holds one: choose it with `--joint`, or decompose this case by itself"
            )));
        }
        return several(arguments, command, (&fixture, &as_recorded), measured);
    }
    let analysis = match Analysis::of(&as_recorded, &measured.frfs, &options) {
        Err(DecompositionError::Sides(SidesError::Loop(_))) => {
            return several(arguments, command, (&fixture, &as_recorded), measured);
        }
        analysis => analysis.map_err(|error| match error {
            DecompositionError::Sides(_) | DecompositionError::Model(_) => fixture.refusal(error),
            error => arguments.recording.refusal(error),
        })?,
    };
    let merged = analysis.merged_from.and_then(|recorded| merging(recorded, analysis.frfs.lines().len()));
    let said = merged.into_iter().chain(window(&analysis)).chain(lost_tolerances(&analysis));
    let notes = measured.notes.into_iter().chain(said);
    let context = origin::context_of(command, inputs(arguments), notes.collect(), measured.hammer_test)?;
    let report = decomposition_report(&analysis, &as_recorded, &context);
    let answered = answered(context, stiffness_file(&analysis), report, summary(&analysis));
    with_frfs(answered, &arguments.destination, analysis.joint_fit.as_ref().ok(), &as_recorded)
}

/// The same with the FRFs that were fitted and those of the fit, where they are asked for.
fn with_frfs(
    mut answered: Answered,
    destination: &Destination,
    fit: Option<&JointFit>,
    fixture: &Fixture,
) -> Result<Answered, Refusal> {
    match fit.filter(|_| destination.also.contains(&Also::Uff)) {
        Some(fit) => answered.frfs = fitted_frfs(fit, fixture).map_err(Refusal::new)?,
        None if destination.also.contains(&Also::Uff) => answered.notes.push(
            "no FRFs are written: there is no joint from all FRFs, and K and C by line are no FRFs"
                .to_owned(),
        ),
        None => {}
    }
    Ok(answered)
}

const FILE: &str = "stiffness.json";

/// The files of what was found.
fn answered(
    context: PageContext,
    mut file: serde_json::Value,
    report: Report,
    summary: Vec<String>,
) -> Answered {
    origin::add(&mut file, &context);
    Answered {
        answer: (FILE, pretty(&file)),
        others: Vec::new(),
        elsewhere: Vec::new(),
        report,
        frfs: Vec::new(),
        summary,
        notes: context.notes,
    }
}

/// All joints at once, or the one named, which lies in a loop.
fn several(
    arguments: &DecomposeArguments,
    command: String,
    (file, fixture): (&FixtureFile, &Fixture),
    measured: MeasuredFrfs,
) -> Result<Answered, Refusal> {
    let names = arguments.joint.as_ref().map(std::slice::from_ref);
    let options = JointFitOptions { band: arguments.band, exact: arguments.exact, laws: true };
    let fit = fit_joints(fixture, &measured.frfs, names, options).map_err(|error| match error {
        SeveralError::NothingRecorded | SeveralError::Noise(_) | SeveralError::Undetermined { .. } => {
            arguments.recording.refusal(error)
        }
        error => file.refusal(error),
    })?;
    let mut notes = measured.notes;
    if arguments.relation == Relation::Paper {
        notes.push(
            "--relation paper has no meaning for several joints at once: no line is decomposed, all are fitted"
                .to_owned(),
        );
    }
    let context = origin::context_of(command, inputs(arguments), notes, measured.hammer_test)?;
    let report = joints_report(&fit, fixture, &context);
    let answered = answered(context, joints_file(&fit), report, summary_of_several(&fit));
    with_frfs(answered, &arguments.destination, fit.joints.first().map(|joint| &joint.fit), fixture)
}

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

/// Where on the complex plane the joint was read, if not on the imaginary axis.
fn window(analysis: &Analysis) -> Option<String> {
    let decay = analysis.spectrum.decay;
    (decay > 0.0).then(|| {
        format!(
            "the FRFs lie under an exponential window of decay {decay:.4} 1/s: sides and joint are read at s = {decay:.4} 1/s + iω, where they \
             hold exactly, so that K and C are those of the joint and no damping of the window is left in them"
        )
    })
}

/// What the deviations leave out, if anything.
fn lost_tolerances(analysis: &Analysis) -> Option<String> {
    let lost = &analysis.lost_tolerances;
    (!lost.is_empty()).then(|| {
        format!(
            "the ± of the fit leave out the tolerances of {}: the fit could not follow them",
            lost.join(", ")
        )
    })
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
