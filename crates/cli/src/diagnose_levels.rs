//! `jointscope diagnose` of stepped-sine FRFs at several levels: what changes from level to level.

use jointscope::fixture::Fixture;
use jointscope::nonlinear::{Held, SteppedDiagnosis, SteppedError, SteppedLevel, Verdict};
use jointscope::{Recording, stepped_file};
use jointscope_recordings::HeldAmplitude;
use jointscope_report::{PageContext, stepped_page};
use serde_json::{Value, json};

use crate::arguments::DiagnoseArguments;
use crate::input;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// The answer where the files hold FRFs at several stated levels; `None` where they do not, and another analysis applies.
pub fn answered(arguments: &DiagnoseArguments, fixture: &Fixture) -> Result<Option<String>, Refusal> {
    let sources = input::sources(&arguments.recording)?;
    let recording = match Recording::of(&sources, fixture, &arguments.recording.options()?) {
        Ok(recording) if recording.levels.len() > 1 => recording,
        // Whatever is wrong with the files is said where they are read for good.
        _ => return Ok(None),
    };
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
    let band = arguments.band.map(|band| (band.from, band.to));
    let diagnosis = SteppedDiagnosis::of(fixture, &levels, band).map_err(|error| match error {
        SteppedError::Model(_) => Refusal::at(&arguments.fixture, error),
        _ => Refusal::new(format_args!("{names}: {error}")),
    })?;
    let mut notes = recording.notes;
    if !arguments.hold_out.is_empty() {
        notes.push(
            "`--hold-out` does not apply to FRFs at several levels: levels are left out one by one"
                .to_owned(),
        );
    }
    written(arguments, fixture, &diagnosis, notes).map(Some)
}

fn written(
    arguments: &DiagnoseArguments,
    fixture: &Fixture,
    diagnosis: &SteppedDiagnosis,
    notes: Vec<String>,
) -> Result<String, Refusal> {
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.recording.files);
    let context = PageContext {
        program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
        command: input::command_line(),
        inputs: files().map(|path| input::hash(path)).collect::<Result<_, _>>()?,
        notes,
        hits: None,
    };
    let mut answer = stepped_file(diagnosis);
    answer["notes"] = json!(context.notes);
    answer["made"] = json!({
        "program": context.program,
        "command": context.command,
        "inputs": context.inputs.iter().map(|i| json!({"file": i.name, "sha256": i.sha256})).collect::<Value>(),
    });
    let answer = serde_json::to_string_pretty(&answer).map_err(Refusal::new)? + "\n";
    let Some(folder) = &arguments.output else { return Ok(answer.trim_end().to_owned()) };
    let page_path = folder.join("report.html");
    let page = stepped_page(diagnosis, fixture, &context).map_err(Refusal::new)?;
    let mut outputs = Outputs::new(files());
    outputs.add(folder.join("diagnosis.json"), answer.clone());
    let [refitted, repaired] = &diagnosis.fixtures;
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
    if diagnosis.verdict != Verdict::Homogeneous {
        let tried = diagnosis
            .tried
            .iter()
            .map(|t| format!("{} at {} in {} {:.3}", t.form, t.joint, t.dof.name(), t.nrmse));
        lines.push(format!("relative errors over all levels: {}", tried.collect::<Vec<_>>().join(", ")));
    }
    if let Some([refitted, repaired]) = diagnosis.left_out {
        lines.push(format!(
            "levels left out one by one: relative error {refitted:.3} refitted, {repaired:.3} repaired"
        ));
    }
    lines.extend(diagnosis.remarks());
    lines
}
