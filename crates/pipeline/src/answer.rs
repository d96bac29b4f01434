//! The answer, whichever way it was found.

use crate::{Error, HammerTest, MeasuredFrfs};
use jointscope_diagnosis::{Diagnosis, Fit, as_known};
use jointscope_fixture::{Effect, Fixture, FixtureError};
use jointscope_nonlinear::{NonlinearDiagnosis, SteppedDiagnosis};
use jointscope_wording::Summary;

/// The fixture with sensors that were taken off it for the diagnosis, where `stated` has them.
fn with_sensors(fixture: Fixture, sensors: &[Effect], stated: &Fixture) -> Result<Fixture, FixtureError> {
    let Some(first) = sensors.first() else { return Ok(fixture) };
    let mut physics = fixture.physics().to_vec();
    let place = stated.physics().iter().position(|own| own == first).unwrap_or(physics.len());
    physics.splice(place..place, sensors.iter().cloned());
    fixture.with_moved_physics(physics)
}

/// What a fixture leaves out of a test.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer {
    /// The fixture that was diagnosed: the one given, under the recording's exponential window where its FRFs
    /// have one.
    pub fixture: Fixture,
    /// What was found.
    pub outcome: Outcome,
    /// Probability that responses proportional to the force change as much between strengths or levels;
    /// `None` where that was not judged.
    pub homogeneity: Option<f64>,
    /// The fixture refitted within its tolerances, its own effects kept.
    pub refitted: Fixture,
    /// The same with the effects found, which follow its own.
    pub repaired: Fixture,
    /// What a reader should know of the recording and of the way taken, one plain sentence each.
    pub notes: Vec<String>,
    /// The hits, where it was made from such.
    pub hammer_test: Option<HammerTest>,
}

/// What was found, by the way taken.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// Nothing was seen to depend on amplitude: the diagnosis of the FRFs.
    Linear(Box<Diagnosis>),
    /// Responses change with the strength of the hits: what they say of a joint's law.
    Hits(Box<NonlinearDiagnosis>),
    /// FRFs change from level to level: what they say of a joint's law.
    Levels(Box<SteppedDiagnosis>),
}

impl Answer {
    /// What was found, a line each, for a terminal.
    pub fn summary(&self) -> Vec<String> {
        match &self.outcome {
            Outcome::Linear(diagnosis) => diagnosis.summary(),
            Outcome::Hits(diagnosis) => diagnosis.summary(),
            Outcome::Levels(diagnosis) => diagnosis.summary(),
        }
    }

    pub(crate) fn linear(
        fixture: Fixture,
        diagnosis: Diagnosis,
        homogeneity: Option<f64>,
        measured: MeasuredFrfs,
    ) -> Result<Self, Error> {
        let search = &diagnosis.search;
        let whole = |of: &Fit| {
            let found = with_sensors(of.hypothesis.to_fixture()?, &diagnosis.sensors_off, &fixture)?;
            Ok::<Fixture, FixtureError>(as_known(found, &fixture))
        };
        Ok(Answer {
            refitted: whole(&search.refitted)?,
            repaired: whole(&search.repaired)?,
            fixture,
            outcome: Outcome::Linear(Box::new(diagnosis)),
            homogeneity,
            notes: measured.notes,
            hammer_test: measured.hammer_test,
        })
    }

    pub(crate) fn of_hits(fixture: &Fixture, diagnosis: NonlinearDiagnosis, measured: MeasuredFrfs) -> Self {
        let [refitted, repaired] = match &diagnosis.models {
            Some([_, refitted, repaired]) => [&refitted.fixture, &repaired.fixture],
            None => [fixture, fixture],
        };
        Answer {
            fixture: fixture.clone(),
            refitted: refitted.clone(),
            repaired: repaired.clone(),
            homogeneity: Some(diagnosis.homogeneity.p_value),
            outcome: Outcome::Hits(Box::new(diagnosis)),
            notes: measured.notes,
            hammer_test: measured.hammer_test,
        }
    }

    pub(crate) fn of_levels(fixture: &Fixture, diagnosis: SteppedDiagnosis, notes: Vec<String>) -> Self {
        let [refitted, repaired] = diagnosis.fixtures.clone();
        Answer {
            fixture: fixture.clone(),
            refitted,
            repaired,
            homogeneity: Some(diagnosis.change.0),
            outcome: Outcome::Levels(Box::new(diagnosis)),
            notes,
            hammer_test: None,
        }
    }
}
