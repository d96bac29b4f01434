//! `jointscope decompose`: a fixture and recordings in, the joint's stiffness and damping and a page out.

use jointscope::estimation::ResponseWindow;
use jointscope::{Analysis, AnalysisOptions, Relation, stiffness_file};
use jointscope_report::format::quantity;
use jointscope_report::{PageContext, decomposition_page};

use crate::arguments::{DecomposeArguments, RelationName};
use crate::input;
use crate::measured::{as_recorded, measured};
use crate::output::Outputs;
use crate::refusal::Refusal;

/// Decomposes and writes `stiffness.json` and `report.html`; answers with what was found and where the page is.
pub fn run(arguments: &DecomposeArguments) -> Result<String, Refusal> {
    let fixture = input::fixture(&arguments.fixture)?;
    let measured = measured(
        &arguments.recording,
        &arguments.estimation,
        &fixture,
        &arguments.fixture,
        ResponseWindow::Auto,
    )?;
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
    let names = input::names(&arguments.recording.files);
    let fixture = as_recorded(&fixture, &arguments.fixture, measured.window_decay)?;
    let options = AnalysisOptions {
        joint: arguments.joint.clone(),
        relation: match arguments.relation {
            RelationName::Exact => Relation::Exact,
            RelationName::Paper => Relation::Paper,
        },
        band: arguments.band,
        exact: arguments.exact,
    };
    let analysis = Analysis::of(&fixture, &measured.frfs, &options).map_err(|error| match error {
        jointscope::DecompositionError::Sides(_) | jointscope::DecompositionError::Model(_) => {
            Refusal::at(&arguments.fixture, error)
        }
        _ => Refusal::new(format_args!("{names}: {error}")),
    })?;
    let context = PageContext {
        program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
        command: input::command_line(),
        inputs: files().map(|path| input::hash(path)).collect::<Result<_, _>>()?,
        notes: measured
            .notes
            .iter()
            .cloned()
            .chain(window(&analysis))
            .chain(lost_tolerances(&analysis))
            .collect(),
        hits: measured.hits,
    };
    let page = decomposition_page(&analysis, &fixture, &context).map_err(Refusal::new)?;
    let stiffness = serde_json::to_string_pretty(&stiffness_file(&analysis)).map_err(Refusal::new)?;
    let mut outputs = Outputs::new(files());
    let page_path = arguments.output.join("report.html");
    outputs.add(arguments.output.join("stiffness.json"), stiffness + "\n");
    outputs.add(&page_path, page);
    outputs.write()?;
    let mut lines = context.notes.clone();
    lines.extend(summary(&analysis));
    lines.push(page_path.display().to_string());
    Ok(lines.join("\n"))
}

/// `1 line`, `2 lines`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
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

/// χ² per degree of freedom above which the reader is told what it means.
const POOR_FIT: f64 = 1.3;

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
    let elements: &[(usize, usize)] = if spectrum.scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 1)] };
    match &analysis.likelihood {
        Ok(fit) => {
            let (k_fixture, c_fixture) = analysis.tolerance_of_likelihood();
            let (k_model, c_model) = fit.model_std();
            let units = [["N/m", "N/rad", "N*m/rad"], ["N*s/m", "N*s/rad", "N*m*s/rad"]];
            let parts = [
                ("k", &fit.stiffness, [fit.stiffness_std, k_fixture, k_model]),
                ("c", &fit.damping, [fit.damping_std, c_fixture, c_model]),
            ];
            for ((symbol, value, shares), units) in parts.into_iter().zip(units) {
                for &(i, j) in elements {
                    let std = shares.iter().map(|share| share.at(i, j).powi(2)).sum::<f64>().sqrt();
                    let text = quantity(value.at(i, j), std, units[i + j]);
                    lines.push(format!("{symbol}{}{} = {text}", i + 1, j + 1));
                }
            }
            lines.push(format!("chi2 per degree of freedom of this constant joint: {:.3}", fit.chi2_per_dof));
            if fit.chi2_per_dof > POOR_FIT {
                lines.push(
                    "with the fixture as stated, a constant joint does not explain the FRFs within their noise; the ± allow for \
                     it as far as the band shows, and the page says what may be behind it"
                        .to_owned(),
                );
            }
        }
        Err(error) => lines.push(error.to_string()),
    }
    lines
}
