//! Sensors that a fixture states and that were moved from response to response: their mass is taken off the FRFs
//! that it loads.
//!
//! Each response then shows natural frequencies of its own, and poles that all FRFs share are of no structure.
//! Lines of a model that is right to the noise do not mind. Of one that is a little wrong modes have to be
//! compared, and records' ends and drift are told by the poles of many FRFs too, so the recording is made one
//! of the structure without its sensors before all that.

use super::unloaded::Load;
use crate::evidence::lacks_much;
use crate::fitter::Fitter;
use crate::record_end::without_ends_of_responses;
use crate::settings::moved_sensor::STATED_WELL;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind, Fixture, Spread};
use jointscope_model_error::RecordEnd;
use std::borrow::Cow;

/// A recording without the sensors that a fixture states, and what it is then held against.
pub(crate) struct WithoutSensors {
    /// The sensors, and how the structure moves without them.
    load: Load,
    /// The fixture without them.
    pub nominal: Hypothesis,
    /// The end of the records, where it came too early.
    pub early_end: Option<RecordEnd>,
}

impl WithoutSensors {
    /// Of a recording that the fixture as refitted does not explain down to its noise; `None` where it does, where
    /// no sensors are stated or not well, and where natural frequencies do not differ as these make them differ.
    pub(crate) fn of(fitter: &Fitter, nominal: &Hypothesis, exact: bool) -> Option<(Self, Observation)> {
        let (without, sensors) = without_sensors(nominal.fixture())?;
        let refitted = fitter.local(nominal, None, f64::INFINITY);
        if refitted.is_some_and(|refitted| !lacks_much(fitter, &refitted)) {
            return None;
        }
        let nominal = Hypothesis::nominal(&without, exact);
        let (whole, early_end) = as_if_ended_late(fitter.observation, &nominal);
        let load = Load::stated(&whole, &nominal, &sensors)?;
        let observation = load.taken_off(&whole)?;
        Some((WithoutSensors { load, nominal, early_end }, observation))
    }

    /// The sensors.
    pub(crate) fn sensors(&self) -> &[Effect] {
        &self.load.sensors
    }

    /// Another recording of the structure without them.
    pub(crate) fn as_well(&self, other: Observation) -> Observation {
        let (other, _) = as_if_ended_late(&other, &self.nominal);
        let own = Load::stated(&other, &self.nominal, self.sensors());
        own.as_ref().unwrap_or(&self.load).taken_off(&other).unwrap_or_else(|| other.into_owned())
    }
}

/// The recording as if its records had not ended too early, by the poles that each response has by itself: a
/// sensor is taken off what has the poles that it makes.
fn as_if_ended_late<'a>(
    observation: &'a Observation,
    nominal: &Hypothesis,
) -> (Cow<'a, Observation>, Option<RecordEnd>) {
    match without_ends_of_responses(observation, nominal.fixture()) {
        Some((whole, end)) => (Cow::Owned(whole), Some(end)),
        None => (Cow::Borrowed(observation), None),
    }
}

/// The fixture without the sensors that it states at responses, and these, where each is stated well and no
/// effect but a window comes after them: it would be numbered anew.
fn without_sensors(fixture: &Fixture) -> Option<(Fixture, Vec<Effect>)> {
    let is_sensor = |effect: &Effect| effect.kind == EffectKind::SensorMass;
    let first = fixture.physics().iter().position(is_sensor)?;
    let (before, after) = fixture.physics().split_at(first);
    let (sensors, others): (Vec<Effect>, Vec<Effect>) = after.iter().cloned().partition(is_sensor);
    let is_stated_well = |effect: &Effect| match effect.parameters[0].spread {
        Spread::Stated(std) => std <= STATED_WELL * effect.value(0),
        Spread::Default => true,
        Spread::Unknown => false,
    };
    let is_in_order = others.iter().all(|effect| effect.kind == EffectKind::ExponentialWindow);
    let can_go = is_in_order && sensors.iter().all(is_stated_well);
    let without = can_go.then(|| fixture.clone().with_physics([before, &others].concat()).ok()).flatten()?;
    Some((without, sensors))
}
