//! `jointscope diagnose`: a fixture and recordings in, what the fixture leaves out and a page out.

use std::io::{IsTerminal, Write};

use jointscope::diagnosis::Fit;
use jointscope::estimation::ResponseWindow;
use jointscope::{Diagnosis, DiagnosisError, DiagnosisOptions, FrfSet, diagnosis_file};
use jointscope_recordings::Recording;
use jointscope_report::diagnosis_page;

use crate::arguments::DiagnoseArguments;
use crate::diagnose_hits::{self, Told};
use crate::diagnose_levels;
use crate::diagnosed::Diagnosed;
use crate::input;
use crate::measured::{as_recorded, of_recording};
use crate::refusal::Refusal;

/// Diagnoses, and writes `diagnosis.json`, `refitted.json`, `repaired.json` and `report.html`; answers with what was found and where the page
/// is, or with `diagnosis.json` itself.
pub fn run(arguments: &DiagnoseArguments) -> Result<String, Refusal> {
    let fixture = input::fixture(&arguments.fixture)?;
    let sources = input::sources(&arguments.recording)?;
    let recording = Recording::of(&sources, &fixture, &arguments.recording.options()?);
    let levels = match &recording {
        Ok(recording) => diagnose_levels::told(arguments, &fixture, recording)?,
        Err(_) => None,
    };
    let mut measured = match levels {
        Some(diagnose_levels::Told::Changes(answer)) => return Ok(answer),
        Some(diagnose_levels::Told::Linear(measured)) => *measured,
        None => of_recording(
            recording,
            &sources,
            &arguments.recording,
            &arguments.estimation,
            (&fixture, &arguments.fixture),
            ResponseWindow::Auto,
        )?,
    };
    if let Some(test) = &measured.hits {
        match diagnose_hits::told(arguments, &fixture, test) {
            Told::Changes(diagnosis) => {
                return diagnose_hits::written(arguments, &fixture, &diagnosis, measured);
            }
            Told::Linear(remarks) => measured.notes.extend(remarks),
        }
    }
    let fixture = as_recorded(&fixture, &arguments.fixture, measured.window_decay)?;
    let names = input::names(&arguments.recording.files);
    let frfs = &measured.frfs;
    check_lines(arguments, frfs)?;
    let options = DiagnosisOptions {
        band: arguments.band.map(|band| (band.from, band.to)),
        exclude: arguments.exclude.iter().map(|band| (band.from, band.to)).collect(),
        hold_out: arguments.hold_out.clone(),
        exact: arguments.exact,
    };
    let progress = Progress::start(frfs);
    let diagnosis = Diagnosis::of(&fixture, frfs, &options).map_err(|error| match error {
        DiagnosisError::Model(_) => Refusal::at(&arguments.fixture, error),
        DiagnosisError::HoldOut(_) => Refusal::new(format_args!(
            "{names}: {error}; name FRFs of the recording with `--hold-out`, and leave one at the least"
        )),
        DiagnosisError::Lines(_) => Refusal::new(format_args!("{names}: {error}")),
    })?;
    drop(progress);
    let model =
        |fit: &Fit| fit.hypothesis.to_fixture().map_err(|error| Refusal::at(&arguments.fixture, error));
    let search = &diagnosis.search;
    let (refitted, repaired) = (model(&search.refitted)?, model(&search.repaired)?);
    Diagnosed {
        answer: diagnosis_file(&diagnosis),
        fixtures: [&refitted, &repaired],
        notes: measured.notes,
        hits: measured.hits,
        summary: summary(&diagnosis),
    }
    .written(arguments, |context| diagnosis_page(&diagnosis, &fixture, context))
}

/// Refuses a choice of lines that leaves none, with what there is.
fn check_lines(arguments: &DiagnoseArguments, frfs: &FrfSet) -> Result<(), Refusal> {
    let in_use = |hz: f64| {
        hz > 0.0
            && arguments.band.is_none_or(|band| band.contains(hz))
            && !arguments.exclude.iter().any(|band| band.contains(hz))
    };
    let hz = frfs.lines().hz();
    match (hz.first(), hz.last()) {
        (Some(first), Some(last)) if !hz.iter().any(|hz| in_use(*hz)) => Err(Refusal::new(format_args!(
            "{}: `--band` and `--exclude` leave no spectral line of the recording, which runs from {first} to {last} Hz; choose them anew",
            input::names(&arguments.recording.files)
        ))),
        _ => Ok(()),
    }
}

/// What was found, a line each.
fn summary(diagnosis: &Diagnosis) -> Vec<String> {
    let mut lines = vec![format!("{}: {}", diagnosis.verdict.name().replace('_', " "), diagnosis.says())];
    for (index, finding) in diagnosis.findings.iter().enumerate() {
        lines.push(format!("{}. {} Probability {:.2}.", index + 1, finding.says(), finding.probability));
    }
    let [nominal, refitted, repaired] = diagnosis.nrmse();
    let [chi2_nominal, chi2_refitted, chi2_repaired] = diagnosis.chi2_per_dof();
    let row = |name: &str, error: f64, chi2: f64| {
        let chi2 = if chi2 < 1e3 { format!("{chi2:.3}") } else { format!("{chi2:.2e}") };
        format!("{name}: relative error of the FRFs {error:.2e}, chi2 per degree of freedom {chi2}")
    };
    lines.push(row("fixture as stated", nominal, chi2_nominal));
    lines.push(row("refitted within its tolerances", refitted, chi2_refitted));
    if !diagnosis.findings.is_empty() {
        lines.push(row("repaired", repaired, chi2_repaired));
    }
    if let Some(held_out) = diagnosis.held_out.as_ref().filter(|_| !diagnosis.findings.is_empty()) {
        lines.push(format!(
            "held out ({}): relative error {:.2e} refitted, {:.2e} repaired",
            held_out.what.join(", "),
            held_out.nrmse_refitted,
            held_out.nrmse_repaired
        ));
    }
    lines.extend(diagnosis.remarks());
    lines
}

/// A word on standard error while the search runs, for whoever watches a terminal.
struct Progress(bool);

impl Progress {
    fn start(frfs: &FrfSet) -> Self {
        let watched = std::io::stderr().is_terminal();
        if watched {
            let (frfs, lines) = (frfs.pairs().len(), frfs.lines().len());
            let _ = write!(std::io::stderr(), "searching {frfs} FRFs on {lines} lines …");
        }
        Progress(watched)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.0 {
            // Back to the start of the line, and the line erased.
            let _ = write!(std::io::stderr(), "\r\x1b[2K");
        }
    }
}
