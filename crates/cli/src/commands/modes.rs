//! `jointscope modes`: recordings in, modes with their standard deviations and a page out, and a fixture with
//! measured damping ratios if wanted.

use std::path::PathBuf;

use clap::Args;
use jointscope::check::fixture_frfs;
use jointscope::diagnosis::restored;
use jointscope::report::format::quantity;
use jointscope::report::{PageContext, modes_report};
use jointscope::screening::empty_lines;
use jointscope::spectra::in_text;
use jointscope::{
    Band, MeasuredDamping, ModalAnalysis, ModesOptions, Remarks, Says, measured_damping, modes_file,
    rebuilt_frfs,
};
use serde_json::{Value, json};

use crate::answered::{Also, Answered, Destination, PAGE};
use crate::input::FixtureFile;
use crate::origin;
use crate::output::{Outputs, counted, pretty};
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use crate::values::{band, positive};

#[derive(Debug, Args)]
pub(super) struct ModesArguments {
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band)]
    pub band: Option<Band>,
    /// Orders of the stabilisation chart: the highest, or the lowest and the highest.
    #[arg(long, value_name = "N1:N2", value_parser = orders)]
    pub orders: Option<(usize, usize)>,
    /// Frequencies in Hz of the poles to take from the chart, in place of the automatic selection.
    #[arg(long, value_name = "HZ", value_parser = picked, num_args = 1..)]
    pub pick: Vec<f64>,
    /// A fixture file (JSON) whose points the channels are; its elastic modes are matched with the measured
    /// ones.
    #[arg(long, value_name = "FIXTURE")]
    pub fixture: Option<PathBuf>,
    /// Write the fixture with the measured damping ratios to this file.
    #[arg(long, value_name = "OUT.json", requires = "fixture")]
    pub update: Option<PathBuf>,
    #[command(flatten)]
    pub destination: Destination,
}

/// Finds the modes and writes `modes.json` and `report.html`; answers with what was found and where the page
/// is, or with `modes.json` itself.
pub(super) fn run(arguments: &ModesArguments) -> Result<String, Refusal> {
    let fixture = arguments.fixture.as_ref().map(|path| FixtureFile::read(path)).transpose()?;
    let recording = match &fixture {
        Some(fixture) => arguments.recording.recording(fixture)?,
        None => arguments.recording.recording_of_nodes()?,
    };
    let frfs = recording.frfs().map_err(|error| arguments.recording.refusal(error))?;
    let files = || arguments.fixture.iter().chain(&arguments.recording.files);
    let folder = arguments.destination.output.iter();
    let answers = folder.flat_map(|folder| [folder.join(FILE), folder.join(PAGE)]);
    Outputs::foresee(files(), answers.chain(arguments.update.clone()))?;
    let options = ModesOptions {
        band: arguments.band.map(|band| (band.from, band.to)),
        orders: arguments.orders,
        pick: arguments.pick.clone(),
    };
    let mut notes = recording.notes.clone();
    notes.extend(empty_lines(frfs).map(|empty| empty.to_string()));
    let restored = restored(frfs);
    notes.extend(restored.as_ref().map(|(_, end)| end.says()));
    let frfs = restored.as_ref().map_or(frfs, |(frfs, _)| frfs);
    let analysis = ModalAnalysis::of(frfs, &options).map_err(|error| arguments.recording.refusal(error))?;
    let analysis = analysis.without_window(recording.window_decay());
    let damping = match fixture.as_ref().map(|fixture| (fixture, measured_damping(fixture, &analysis))) {
        None => None,
        Some((_, Ok(damping))) => Some(damping),
        // Modes are worth having where the fixture does not fit them.
        Some((fixture, Err(error))) if arguments.update.is_some() => return Err(fixture.refusal(error)),
        Some((fixture, Err(error))) => {
            notes.push(fixture.refusal(error).to_string());
            None
        }
    };
    let context = origin::context(files(), notes, None)?;
    let answer = answer(&analysis, damping.as_ref(), &context);
    let updated = arguments
        .update
        .iter()
        .zip(&damping)
        .map(|(path, damping)| (path.clone(), damping.fixture.to_json()));
    let elsewhere = updated.collect();
    let remarks = damping.as_ref().map_or(&[][..], |damping| &damping.remarks);
    let modelled = fixture.as_deref().and_then(|fixture| fixture_frfs(fixture, analysis.measured()));
    let report = modes_report(&analysis, fixture.as_deref(), (remarks, modelled.as_ref()), &context);
    let mut summary = summary(&analysis, damping.as_ref());
    summary.extend(arguments.update.iter().map(|path| path.display().to_string()));
    let frfs = match arguments.destination.also.contains(&Also::Uff) {
        true => rebuilt_frfs(&analysis).map_err(Refusal::new)?,
        false => Vec::new(),
    };
    let answered = Answered {
        notes: context.notes,
        answer: (FILE, pretty(&answer)),
        others: Vec::new(),
        elsewhere,
        report,
        frfs,
        summary,
    };
    answered.end(&arguments.destination, files())
}

const FILE: &str = "modes.json";

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
    origin::add(&mut answer, context);
    answer
}

/// What was found, a line each.
fn summary(analysis: &ModalAnalysis, damping: Option<&MeasuredDamping>) -> Vec<String> {
    let hz = analysis.lines().hz();
    let mut lines = vec![format!(
        "{} in {} from {} to {} Hz; chi2 per degree of freedom {:.3}",
        counted(analysis.modes.len(), "mode"),
        counted(analysis.pairs().len(), "FRF"),
        in_text(hz[0]),
        in_text(hz[hz.len() - 1]),
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

/// Reads `N` or `N1:N2`.
fn orders(text: &str) -> Result<(usize, usize), String> {
    let number = |text: &str| text.trim().parse().ok().filter(|n: &usize| *n > 0);
    let ends = match text.split_once(':') {
        None => number(text).map(|to| (to.min(2), to)),
        Some((from, to)) => number(from).zip(number(to)),
    };
    ends.filter(|(from, to)| from <= to).ok_or_else(|| {
        "whole numbers above zero are needed, the highest order or both ends, such as 40 or 4:40".to_owned()
    })
}

/// A frequency in Hz above zero.
fn picked(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "a frequency in Hz above zero is needed".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_the_highest_or_both_ends() {
        assert_eq!(orders("40"), Ok((2, 40)));
        assert_eq!(orders("1"), Ok((1, 1)));
        assert_eq!(orders("4:40"), Ok((4, 40)));
        for bad in ["0", "a", "5:4", "0:4", "-3", "4:"] {
            assert!(orders(bad).unwrap_err().contains("such as 40 or 4:40"), "{bad}");
        }
        assert!(picked("0").is_err() && picked("nan").is_err() && picked("112.5") == Ok(112.5));
    }
}
