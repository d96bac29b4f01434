//! `jointscope diagnose` of time histories: whether anything changes with the strength of the hits, and what.

use jointscope::fixture::Fixture;
use jointscope::nonlinear::{NonlinearDiagnosis, NonlinearOptions, Verdict};
use jointscope::nonlinear_file;
use jointscope_hits::Hit;
use jointscope_report::{HammerTest, hits_page};

use crate::arguments::DiagnoseArguments;
use crate::diagnosed::Diagnosed;
use crate::measured::Measured;
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
    let fixtures = match &diagnosis.models {
        Some([_, refitted, repaired]) => [&refitted.fixture, &repaired.fixture],
        None => [fixture, fixture],
    };
    Diagnosed {
        answer: nonlinear_file(diagnosis),
        fixtures,
        notes: measured.notes,
        hits: measured.hits,
        summary: summary(diagnosis),
    }
    .written(arguments, |context| hits_page(diagnosis, fixture, context))
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
