//! The FRFs of a test, recorded as such or estimated from its hits.

use std::path::Path;

use jointscope::FrfSet;
use jointscope::estimation::{Estimate, EstimateError, Estimator, ResponseWindow};
use jointscope::fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_recordings::{Hits, HitsError, Recording, RecordingError, Source, hits_of};
use jointscope_report::HammerTest;

use crate::arguments::RecordingArguments;
use crate::estimation_arguments::EstimationArguments;
use crate::input;
use crate::refusal::Refusal;

/// What a test gives to an analysis.
pub struct Measured {
    /// Its FRFs: those recorded, or those estimated on the lines that the hammer excites.
    pub frfs: FrfSet,
    /// What a reader of the results should know.
    pub notes: Vec<String>,
    /// Decay of the exponential window that lies on the FRFs, 1/s; 0 without one.
    pub window_decay: f64,
    /// The hits, where the FRFs were estimated from them.
    pub hits: Option<HammerTest>,
}

/// Reads the files of a test against the fixture `fixture`, read from `fixture_path`. Files with time histories alone are hits, of
/// which FRFs are estimated, with `window` where the command line states none.
pub fn measured(
    arguments: &RecordingArguments,
    estimation: &EstimationArguments,
    fixture: &Fixture,
    fixture_path: &Path,
    window: ResponseWindow,
) -> Result<Measured, Refusal> {
    let sources = input::sources(arguments)?;
    let recording = Recording::of(&sources, fixture, &arguments.options()?);
    of_recording(recording, &sources, arguments, estimation, (fixture, fixture_path), window)
}

/// As [`measured`], of files that were read already, and what they hold of FRFs.
pub fn of_recording(
    recording: Result<Recording, RecordingError>,
    sources: &[Source],
    arguments: &RecordingArguments,
    estimation: &EstimationArguments,
    (fixture, fixture_path): (&Fixture, &Path),
    window: ResponseWindow,
) -> Result<Measured, Refusal> {
    let names = input::names(&arguments.files);
    match recording {
        Ok(recording) => {
            let level = recording.level().map_err(|error| Refusal::new(format_args!("{names}: {error}")))?;
            let (frfs, window_decay) = (level.frfs.clone(), level.window_decay);
            let held = level.held;
            let mut notes = recording.notes;
            notes.extend(held.map(|held| {
                format!("the FRFs are those of one level ({held}): whether anything depends on amplitude they cannot tell")
            }));
            if estimation.are_given() {
                notes.push("the files hold FRFs: options for hammer hits do not apply".to_owned());
            }
            Ok(Measured { frfs, notes, window_decay, hits: None })
        }
        Err(RecordingError::OnlyTimeHistories { .. }) => {
            let (hits, estimate) = estimated(arguments, estimation, sources, Some(fixture), window).map_err(
                |error| match error {
                    Unreadable::Map(error) => Refusal::at(fixture_path, error),
                    Unreadable::Else(refusal) => refusal,
                },
            )?;
            let frfs = estimate.usable().ok_or_else(|| {
                Refusal::new(format_args!(
                    "{names}: the hits excite no spectral line; record harder or longer ones"
                ))
            })?;
            let mut notes = hits.notes;
            notes.push(what_was_estimated(&estimate, &frfs, estimation.options(window).estimator));
            notes.extend(estimate.remarks.iter().cloned());
            let window_decay = estimate.decay;
            let hits = Some(HammerTest { hits: hits.hits, estimate });
            Ok(Measured { frfs, notes, window_decay, hits })
        }
        Err(error) => Err(input::refusal(error, &arguments.files, Some(fixture_path))),
    }
}

/// Why hits could not be read.
pub enum Unreadable {
    /// The map names points that the fixture does not have.
    Map(RecordingError),
    /// Anything else.
    Else(Refusal),
}

/// The hits among `sources`, and the FRFs estimated from them.
pub fn estimated(
    arguments: &RecordingArguments,
    estimation: &EstimationArguments,
    sources: &[Source],
    fixture: Option<&Fixture>,
    window: ResponseWindow,
) -> Result<(Hits, Estimate), Unreadable> {
    let names = input::names(&arguments.files);
    let options = arguments.options().map_err(Unreadable::Else)?;
    let hits = hits_of(sources, fixture, &options).map_err(|error| match error {
        HitsError::Map(error @ RecordingError::MapPoint { .. }) => Unreadable::Map(error),
        HitsError::Map(error) => Unreadable::Else(Refusal::new(format_args!("{names}: {error}"))),
        error => Unreadable::Else(Refusal::new(error)),
    })?;
    let estimate = Estimate::of(&hits.hits, &estimation.options(window)).map_err(|error| {
        Unreadable::Else(match error {
            EstimateError::NoSuchHit { .. } => {
                Refusal::new(format_args!("{names}: {error}; give `--keep` and `--reject` numbers of these"))
            }
            EstimateError::Window { .. } => Refusal::new(error),
            _ => Refusal::new(format_args!("{names}: {error}")),
        })
    })?;
    Ok((hits, estimate))
}

/// `FRFs were estimated from the hits: H1, 9 hits at 1, 9 at 2, on 1975 lines from 0.78125 to 1543 Hz`.
pub fn what_was_estimated(estimate: &Estimate, frfs: &FrfSet, estimator: Estimator) -> String {
    let name = estimator.name();
    let points: Vec<String> = estimate
        .excitations
        .iter()
        .map(|e| format!("{} hit{} at {}", e.hits.len(), if e.hits.len() == 1 { "" } else { "s" }, e.struck))
        .collect();
    let hz = frfs.lines().hz();
    let (first, last) = (hz.first().copied().unwrap_or(0.0), hz.last().copied().unwrap_or(0.0));
    format!(
        "FRFs were estimated from the hits: {name}, {}, on {} lines from {first:.6} to {last:.6} Hz",
        points.join(", "),
        hz.len()
    )
}

/// The fixture as a recording under an exponential window shows it: with an effect `exponential_window` of that decay.
pub fn as_recorded(fixture: &Fixture, path: &Path, window_decay: f64) -> Result<Fixture, Refusal> {
    if window_decay == 0.0 {
        return Ok(fixture.clone());
    }
    let mut physics = fixture.physics().to_vec();
    physics.push(Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[window_decay]));
    fixture.clone().with_physics(physics).map_err(|error| Refusal::at(path, error))
}
