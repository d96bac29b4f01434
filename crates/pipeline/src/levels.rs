//! Whether anything changes from level to level of a stepped-sine test.

use crate::homogeneity::{Homogeneity, not_judged};
use crate::{Answer, Error, MeasuredFrfs, Options};
use jointscope_fixture::Fixture;
use jointscope_nonlinear::{Held, SteppedDiagnosis, SteppedError, SteppedLevel, Verdict, pooled};
use jointscope_recordings::{HeldAmplitude, Recording};
use jointscope_wording::{Remarks, Says};

/// Tests whether the FRFs of `recording` change with level; if so, the law is sought. FRFs of one level are
/// passed on as they are.
pub(crate) fn homogeneity(
    fixture: &Fixture,
    recording: &Recording,
    options: &Options,
) -> Result<Homogeneity, Error> {
    let one_level = || -> Result<Homogeneity, Error> {
        Ok(Homogeneity::Linear(Box::new(MeasuredFrfs::recorded(recording)?), None))
    };
    // FRFs of no stated level among others are refused there, with what they are.
    let Some(levels) = stepped_levels(recording) else { return one_level() };
    let in_use =
        levels.iter().map(|level| without_excluded(level, options)).collect::<Result<Vec<_>, _>>()?;
    let (remarks, p_value) = match SteppedDiagnosis::of(fixture, &in_use, &options.nonlinear()) {
        Ok(diagnosis) if diagnosis.verdict != Verdict::Consistent => {
            let answer = Answer::of_levels(fixture, diagnosis, notes(recording, options));
            return Ok(Homogeneity::Changes(Box::new(answer)));
        }
        Ok(diagnosis) => {
            (std::iter::once(diagnosis.says()).chain(diagnosis.remarks()).collect(), Some(diagnosis.change.0))
        }
        Err(error @ (SteppedError::Alike { .. } | SteppedError::NoJoint)) => (vec![not_judged(&error)], None),
        Err(error) => return Err(error.into()),
    };
    match mean(recording, &levels, remarks) {
        Some(measured) => Ok(Homogeneity::Linear(Box::new(measured), p_value)),
        None => one_level(),
    }
}

/// The levels of a stepped-sine test; `None` of one level, or where not all are stated.
fn stepped_levels(recording: &Recording) -> Option<Vec<SteppedLevel>> {
    if recording.levels.len() < 2 {
        return None;
    }
    let stepped = |level: &jointscope_recordings::Level| {
        let held = match level.held? {
            HeldAmplitude::Force(value) => Held::Force(value),
            HeldAmplitude::Response(value) => Held::Response(value),
        };
        Some(SteppedLevel { held, frfs: level.frfs.clone() })
    };
    recording.levels.iter().map(stepped).collect()
}

fn without_excluded(level: &SteppedLevel, options: &Options) -> Result<SteppedLevel, Error> {
    let hz = level.frfs.lines().hz();
    let excluded =
        |line: usize| options.diagnosis.exclude.iter().any(|&(from, to)| hz[line] >= from && hz[line] <= to);
    let frfs = level.frfs.on_lines(|line| !excluded(line)).ok_or(Error::NoLineOfLevel(level.held))?;
    Ok(SteppedLevel { held: level.held, frfs })
}

fn notes(recording: &Recording, options: &Options) -> Vec<String> {
    let mut notes = recording.notes.clone();
    if !options.diagnosis.hold_out.is_empty() {
        notes.push(
            "`--hold-out` does not apply to FRFs at several levels: levels are left out one by one"
                .to_owned(),
        );
    }
    notes
}

/// The levels as one set of FRFs; `None` where they share none.
fn mean(recording: &Recording, levels: &[SteppedLevel], remarks: Vec<String>) -> Option<MeasuredFrfs> {
    let frfs = pooled(levels)?;
    let mut notes = recording.notes.clone();
    notes.extend(remarks);
    notes.push(format!(
        "the FRFs diagnosed are the means over {} levels, weighted by their noise",
        levels.len()
    ));
    Some(MeasuredFrfs { frfs, notes, window_decay: recording.window_decay(), hammer_test: None })
}
