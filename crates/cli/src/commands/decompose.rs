//! `jointscope decompose`: a fixture and recordings in, the joint's stiffness and damping and a page out.

use std::path::PathBuf;

use clap::Args;
use jointscope::decomposition::{
    JointFit, JointFitOptions, JointsFit, LikelihoodFit, SeveralError, SidesError, fit_joints,
};
use jointscope::estimation::ResponseWindow;
use jointscope::pipeline::MeasuredFrfs;
use jointscope::report::format::quantity;
use jointscope::report::{PageContext, decomposition_page, joints_page};
use jointscope::{
    Analysis, AnalysisOptions, Band, DecompositionError, Fixture, Relation, Remarks, joints_file,
    stiffness_file,
};

use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::{Outputs, counted};
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use crate::values::{band, one_of};

#[derive(Debug, Args)]
pub struct DecomposeArguments {
    /// The fixture file (JSON).
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
    /// The directory to write to.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

const RELATIONS: [(&str, Relation); 2] = [("exact", Relation::Exact), ("paper", Relation::Paper)];

/// Decomposes and writes `stiffness.json` and `report.html`; answers with what was found and where the page is.
pub fn run(arguments: &DecomposeArguments) -> Result<String, Refusal> {
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let measurement = arguments.recording.measurement(&fixture)?;
    let mut measured = MeasuredFrfs::of(&measurement, &arguments.estimation.options(ResponseWindow::Auto))
        .and_then(|measured| measured.screened(&fixture))
        .map_err(|error| arguments.recording.unanswered(&error, &fixture))?;
    measured.notes.extend(arguments.estimation.unused_with(&measurement));
    let as_recorded = measured.as_recorded(&fixture).map_err(|error| fixture.refusal(error))?;
    let options = AnalysisOptions {
        joint: arguments.joint.clone(),
        relation: arguments.relation,
        band: arguments.band,
        exact: arguments.exact,
        laws: true,
    };
    if arguments.joint.is_none() && as_recorded.joints().len() > 1 {
        return several(arguments, &fixture, &as_recorded, measured);
    }
    let analysis = match Analysis::of(&as_recorded, &measured.frfs, &options) {
        Err(DecompositionError::Sides(SidesError::Loop(_))) => {
            return several(arguments, &fixture, &as_recorded, measured);
        }
        analysis => analysis.map_err(|error| match error {
            DecompositionError::Sides(_) | DecompositionError::Model(_) => fixture.refusal(error),
            error => arguments.recording.refusal(error),
        })?,
    };
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
    let notes = measured.notes.into_iter().chain(window(&analysis)).chain(lost_tolerances(&analysis));
    let context = origin::context(files(), notes.collect(), measured.hammer_test)?;
    let page = decomposition_page(&analysis, &as_recorded, &context).map_err(Refusal::new)?;
    written(arguments, &context, (stiffness_file(&analysis), page), summary(&analysis))
}

/// Writes both files; answers with what was found and where the page is.
fn written(
    arguments: &DecomposeArguments,
    context: &PageContext,
    (mut file, page): (serde_json::Value, String),
    found: Vec<String>,
) -> Result<String, Refusal> {
    let mut outputs = Outputs::new(std::iter::once(&arguments.fixture).chain(&arguments.recording.files));
    let page_path = arguments.output.join("report.html");
    origin::add(&mut file, context);
    outputs.add_json(arguments.output.join("stiffness.json"), &file);
    outputs.add(&page_path, page);
    outputs.write()?;
    let mut lines = context.notes.clone();
    lines.extend(found);
    lines.push(page_path.display().to_string());
    Ok(lines.join("\n"))
}

/// All joints at once, or the one named, which lies in a loop.
fn several(
    arguments: &DecomposeArguments,
    file: &FixtureFile,
    fixture: &Fixture,
    measured: MeasuredFrfs,
) -> Result<String, Refusal> {
    let names = arguments.joint.as_ref().map(std::slice::from_ref);
    let options = JointFitOptions { band: arguments.band, exact: arguments.exact, laws: true };
    let fit = fit_joints(fixture, &measured.frfs, names, options).map_err(|error| match error {
        SeveralError::NothingRecorded | SeveralError::Noise(_) | SeveralError::Undetermined { .. } => {
            arguments.recording.refusal(error)
        }
        error => file.refusal(error),
    })?;
    let files = std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
    let mut notes = measured.notes;
    if arguments.relation == Relation::Paper {
        notes.push(
            "--relation paper has no meaning for several joints at once: no line is decomposed, all are fitted"
                .to_owned(),
        );
    }
    let context = origin::context(files, notes, measured.hammer_test)?;
    let page = joints_page(&fit, fixture, &context).map_err(Refusal::new)?;
    written(arguments, &context, (joints_file(&fit), page), summary_of_several(&fit))
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
