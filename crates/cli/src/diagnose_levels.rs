//! `jointscope diagnose` of stepped-sine FRFs at several levels: what changes from level to level.

use jointscope::fixture::Fixture;
use jointscope::nonlinear::{
    Held, NonlinearOptions, SteppedDiagnosis, SteppedError, SteppedLevel, Verdict, pooled,
};
use jointscope::{Recording, stepped_file};
use jointscope_recordings::HeldAmplitude;
use jointscope_report::stepped_page;

use crate::arguments::DiagnoseArguments;
use crate::diagnosed::Diagnosed;
use crate::input;
use crate::measured::Measured;
use crate::refusal::Refusal;

/// What FRFs at several levels say of amplitude.
pub enum Told {
    /// Something changes with level: what `diagnose` answers.
    Changes(String),
    /// Nothing does, or it cannot be judged: the FRFs of all levels as one set, for a linear diagnosis, with what was said.
    Linear(Box<Measured>),
}

/// What a recording says that holds FRFs at several stated levels; `None` where it does not, and another analysis applies.
pub fn told(
    arguments: &DiagnoseArguments,
    fixture: &Fixture,
    recording: &Recording,
) -> Result<Option<Told>, Refusal> {
    if recording.levels.len() < 2 {
        return Ok(None);
    }
    let names = input::names(&arguments.recording.files);
    let levels: Option<Vec<SteppedLevel>> = recording
        .levels
        .iter()
        .map(|level| {
            let held = match level.held? {
                HeldAmplitude::Force(value) => Held::Force(value),
                HeldAmplitude::Response(value) => Held::Response(value),
            };
            Some(SteppedLevel { held, frfs: level.frfs.clone() })
        })
        .collect();
    // FRFs of no stated level among others: the reader of one level refuses them with what they are.
    let Some(mut levels) = levels else { return Ok(None) };
    let whole = levels.clone();
    for level in &mut levels {
        let hz: Vec<f64> = level.frfs.lines().hz().to_vec();
        let used = |line: usize| !arguments.exclude.iter().any(|band| band.contains(hz[line]));
        level.frfs = level.frfs.on_lines(used).ok_or_else(|| {
            Refusal::new(format_args!(
                "{names}: `--exclude` leaves no spectral line of level {}; choose it anew",
                level.held
            ))
        })?;
    }
    let options =
        NonlinearOptions { band: arguments.band.map(|band| (band.from, band.to)), exact: arguments.exact };
    let diagnosis = match SteppedDiagnosis::of(fixture, &levels, &options) {
        Ok(diagnosis) if diagnosis.verdict == Verdict::Homogeneous => {
            let said = std::iter::once(diagnosis.says()).chain(diagnosis.remarks()).collect();
            return Ok(linear(recording, &whole, said));
        }
        Ok(diagnosis) => diagnosis,
        Err(error @ (SteppedError::Alike { .. } | SteppedError::NoJoint)) => {
            let said = format!("whether anything depends on amplitude could not be judged: {error}");
            return Ok(linear(recording, &whole, vec![said]));
        }
        Err(error @ SteppedError::Model(_)) => return Err(Refusal::at(&arguments.fixture, error)),
        Err(error) => return Err(Refusal::new(format_args!("{names}: {error}"))),
    };
    let mut notes = recording.notes.clone();
    if !arguments.hold_out.is_empty() {
        notes.push(
            "`--hold-out` does not apply to FRFs at several levels: levels are left out one by one"
                .to_owned(),
        );
    }
    let [refitted, repaired] = &diagnosis.fixtures;
    Diagnosed {
        answer: stepped_file(&diagnosis),
        fixtures: [refitted, repaired],
        notes,
        hits: None,
        summary: summary(&diagnosis),
    }
    .written(arguments, |context| stepped_page(&diagnosis, fixture, context))
    .map(|answer| Some(Told::Changes(answer)))
}

/// The levels as one set of FRFs; `None` where they share none, which the reader of one level then says.
fn linear(recording: &Recording, levels: &[SteppedLevel], said: Vec<String>) -> Option<Told> {
    let frfs = pooled(levels)?;
    let mut notes = recording.notes.clone();
    notes.extend(said);
    notes.push(format!(
        "the FRFs diagnosed are the means over {} levels, weighted by their noise",
        levels.len()
    ));
    let window_decay = recording.levels.first().map_or(0.0, |level| level.window_decay);
    Some(Told::Linear(Box::new(Measured { frfs, notes, window_decay, hits: None })))
}

fn summary(diagnosis: &SteppedDiagnosis) -> Vec<String> {
    let mut lines = vec![format!("{}: {}", diagnosis.verdict.name().replace('_', " "), diagnosis.says())];
    for (index, finding) in diagnosis.findings.iter().enumerate() {
        lines.push(format!("{}. {} Probability {:.2}.", index + 1, finding.says(), finding.probability));
    }
    for level in &diagnosis.levels {
        lines.push(format!(
            "{}: {:.3} Hz, damping {:.4} %, relative motion {:.3e}, relative error {:.3} refitted, {:.3} repaired, {:.3} with a stiffness of its own",
            level.held,
            level.resonance.frequency.0,
            100.0 * level.resonance.damping_ratio.0,
            level.motion,
            level.nrmse[1],
            level.nrmse[2],
            level.nrmse[3]
        ));
    }
    let tried = diagnosis
        .tried
        .iter()
        .map(|t| format!("{} at {} in {} {:.3}", t.form, t.joint, t.dof.name(), t.nrmse));
    lines.push(format!("relative errors over all levels: {}", tried.collect::<Vec<_>>().join(", ")));
    for (name, chi2) in ["fixture as stated", "refitted", "repaired"].iter().zip(diagnosis.chi2_per_dof) {
        lines.extend(chi2.map(|chi2| format!("{name}: chi2 per degree of freedom {chi2:.4e}")));
    }
    if let Some([refitted, repaired]) = diagnosis.left_out {
        lines.push(format!(
            "levels left out one by one: relative error {refitted:.3} refitted, {repaired:.3} repaired"
        ));
    }
    lines.extend(diagnosis.remarks());
    lines
}
