//! `jointscope modes`: recordings in, modes with their standard deviations and a page out, and a fixture with measured damping ratios if wanted.

use jointscope::{
    Fixture, MeasuredDamping, ModalAnalysis, ModesOptions, Recording, measured_damping, modes_file,
};
use jointscope_report::{PageContext, modes_page};
use serde_json::{Value, json};

use crate::arguments::ModesArguments;
use crate::input;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// Finds the modes and writes `modes.json` and `report.html`; answers with what was found and where the page is, or with `modes.json` itself.
pub fn run(arguments: &ModesArguments) -> Result<String, Refusal> {
    let fixture = arguments.fixture.as_ref().map(|path| input::fixture(path)).transpose()?;
    let recording = recording(arguments, fixture.as_ref())?;
    let names = input::names(&arguments.recording.files);
    let at_files = |error: &dyn std::fmt::Display| Refusal::new(format_args!("{names}: {error}"));
    let frfs = recording.frfs().map_err(|error| at_files(&error))?;
    let options = ModesOptions {
        band: arguments.band.map(|band| (band.from, band.to)),
        orders: arguments.orders,
        pick: arguments.pick.clone(),
    };
    let analysis = ModalAnalysis::of(frfs, &options).map_err(|error| at_files(&error))?;
    let mut notes = recording.notes.clone();
    let damping = match (&fixture, &arguments.fixture) {
        (Some(fixture), Some(path)) => match measured_damping(fixture, &analysis) {
            Ok(damping) => Some(damping),
            // Modes are worth having where the fixture does not fit them.
            Err(error) if arguments.update.is_some() => return Err(Refusal::at(path, error)),
            Err(error) => {
                notes.push(format!("{}: {error}", path.display()));
                None
            }
        },
        _ => None,
    };
    let files = || arguments.fixture.iter().chain(&arguments.recording.files);
    let context = input::context(files(), notes, None)?;
    let answer = answer(&analysis, damping.as_ref(), &context);
    let answer = serde_json::to_string_pretty(&answer).map_err(Refusal::new)? + "\n";
    let mut outputs = Outputs::new(files());
    if let (Some(path), Some(damping)) = (&arguments.update, &damping) {
        outputs.add(path, damping.fixture.to_json());
    }
    let mut page_path = None;
    if let Some(folder) = &arguments.output {
        let remarks = damping.as_ref().map_or(&[][..], |damping| &damping.remarks);
        let page = modes_page(&analysis, fixture.as_ref(), remarks, &context).map_err(Refusal::new)?;
        let path = folder.join("report.html");
        outputs.add(folder.join("modes.json"), answer.clone());
        outputs.add(&path, page);
        page_path = Some(path);
    }
    outputs.write()?;
    if arguments.json {
        return Ok(answer.trim_end().to_owned());
    }
    let mut lines = context.notes;
    lines.extend(summary(&analysis, damping.as_ref()));
    lines.extend(arguments.update.iter().chain(&page_path).map(|path| path.display().to_string()));
    Ok(lines.join("\n"))
}

fn recording(arguments: &ModesArguments, fixture: Option<&Fixture>) -> Result<Recording, Refusal> {
    match (fixture, &arguments.fixture) {
        (Some(fixture), Some(path)) => input::recording(&arguments.recording, fixture, path),
        _ => input::recording_of_nodes(&arguments.recording),
    }
}

/// `modes.json`: the modes, which of them are the fixture's, and what they were made from.
fn answer(analysis: &ModalAnalysis, damping: Option<&MeasuredDamping>, context: &PageContext) -> Value {
    let mut answer = modes_file(analysis);
    if let Some(damping) = damping {
        let matches = damping.matches.pairs.iter().map(|pair| {
            json!({
                "mode": pair.measured + 1,
                "elastic_mode": pair.expected + 1,
                "frequency": damping.elastic[pair.expected],
                "mac": pair.mac,
            })
        });
        answer["fixture"] = json!({"matches": matches.collect::<Value>(), "remarks": damping.remarks});
    }
    input::add_origin(&mut answer, context);
    answer
}

/// What was found, a line each.
fn summary(analysis: &ModalAnalysis, damping: Option<&MeasuredDamping>) -> Vec<String> {
    use jointscope_report::format::quantity;
    let hz = analysis.lines().hz();
    let mut lines = vec![format!(
        "{} in {} from {} to {} Hz; chi2 per degree of freedom {:.3}",
        counted(analysis.modes.len(), "mode"),
        counted(analysis.pairs().len(), "FRF"),
        hz[0],
        hz[hz.len() - 1],
        analysis.chi2_per_dof
    )];
    for (index, mode) in analysis.modes.iter().enumerate() {
        lines.push(format!(
            "{}. {} Hz, damping ratio {} %",
            index + 1,
            quantity(mode.frequency, mode.frequency_std, ""),
            quantity(100.0 * mode.damping_ratio, 100.0 * mode.damping_std, "")
        ));
    }
    lines.extend(damping.iter().flat_map(|damping| damping.remarks.clone()));
    lines.extend(analysis.remarks());
    lines
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
