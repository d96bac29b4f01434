//! `jointscope diagnose` of time histories: whether anything changes with the strength of the hits, and what.

use jointscope::fixture::Fixture;
use jointscope::nonlinear::{NonlinearDiagnosis, NonlinearOptions, Verdict};
use jointscope::nonlinear_file;
use jointscope_hits::Hit;
use jointscope_report::{HammerTest, PageContext, hits_page};
use serde_json::{Value, json};

use crate::arguments::DiagnoseArguments;
use crate::input;
use crate::measured::Measured;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// What hits say of amplitude.
pub enum Told {
    /// Something changes with the strength of the hits.
    Changes(Box<NonlinearDiagnosis>),
    /// Nothing does, or it cannot be judged, in sentences: a linear diagnosis of the FRFs applies.
    Linear(Vec<String>),
}

/// Whether anything changes with the strength of the hits in use.
pub fn told(arguments: &DiagnoseArguments, fixture: &Fixture, test: &HammerTest) -> Told {
    let options =
        NonlinearOptions { band: arguments.band.map(|band| (band.from, band.to)), exact: arguments.exact };
    let in_use = test.hits.iter().zip(&test.estimate.hits).filter(|(_, report)| report.used);
    let hits: Vec<Hit> = in_use.map(|(hit, _)| hit.clone()).collect();
    match NonlinearDiagnosis::of(fixture, &hits, &options) {
        Err(error) => {
            Told::Linear(vec![format!("whether anything depends on amplitude could not be judged: {error}")])
        }
        Ok(diagnosis) if diagnosis.verdict == Verdict::Homogeneous => {
            Told::Linear(std::iter::once(diagnosis.says()).chain(diagnosis.remarks()).collect())
        }
        Ok(diagnosis) => Told::Changes(Box::new(diagnosis)),
    }
}

/// Writes what `diagnose` writes of joints that depend on amplitude; answers with what was found.
pub fn written(
    arguments: &DiagnoseArguments,
    fixture: &Fixture,
    diagnosis: &NonlinearDiagnosis,
    measured: Measured,
) -> Result<String, Refusal> {
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
    let context = PageContext {
        program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
        command: input::command_line(),
        inputs: files().map(|path| input::hash(path)).collect::<Result<_, _>>()?,
        notes: measured.notes,
        hits: measured.hits,
    };
    let mut answer = nonlinear_file(diagnosis);
    answer["notes"] = json!(context.notes);
    answer["made"] = json!({
        "program": context.program,
        "command": context.command,
        "inputs": context.inputs.iter().map(|i| json!({"file": i.name, "sha256": i.sha256})).collect::<Value>(),
    });
    let answer = serde_json::to_string_pretty(&answer).map_err(Refusal::new)? + "\n";
    let Some(folder) = &arguments.output else { return Ok(answer.trim_end().to_owned()) };
    let page_path = folder.join("report.html");
    let page = hits_page(diagnosis, fixture, &context).map_err(Refusal::new)?;
    let mut outputs = Outputs::new(files());
    outputs.add(folder.join("diagnosis.json"), answer.clone());
    let [refitted, repaired] = match &diagnosis.models {
        Some([_, refitted, repaired]) => [&refitted.fixture, &repaired.fixture],
        None => [fixture, fixture],
    };
    outputs.add(folder.join("refitted.json"), refitted.to_json());
    outputs.add(folder.join("repaired.json"), repaired.to_json());
    outputs.add(&page_path, page);
    outputs.write()?;
    if arguments.json {
        return Ok(answer.trim_end().to_owned());
    }
    let mut lines = context.notes;
    lines.extend(summary(diagnosis));
    lines.push(page_path.display().to_string());
    Ok(lines.join("\n"))
}

fn summary(diagnosis: &NonlinearDiagnosis) -> Vec<String> {
    let mut lines = vec![format!("{}: {}", diagnosis.verdict.name().replace('_', " "), diagnosis.says())];
    for (index, finding) in diagnosis.findings.iter().enumerate() {
        lines.push(format!("{}. {} Probability {:.2}.", index + 1, finding.says(), finding.probability));
    }
    let models = ["fixture as stated", "refitted within its tolerances", "repaired"];
    for (name, model) in models.iter().zip(diagnosis.models.iter().flatten()) {
        lines.push(format!(
            "{name}: relative error of the responses {:.2e}, chi2 per degree of freedom {:.3e}",
            model.nrmse, model.chi2_per_dof
        ));
    }
    if let Some(held) = &diagnosis.held_out {
        lines.push(format!(
            "held out ({} hits): relative error {:.2e} refitted, {:.2e} repaired",
            held.hits.len(),
            held.nrmse_refitted,
            held.nrmse_repaired
        ));
    }
    lines.extend(diagnosis.remarks());
    lines
}
