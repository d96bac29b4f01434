//! Natural frequencies response by response, beside those of a model.

use crate::modal::recorded;
use crate::settings::moved_sensor::{BESIDE_POLE, SAME_POLE};
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Fixture, Place};
use jointscope_model_error::{ModelledModes, Pairing, RecordedModes};
use jointscope_spectra::{Channel, Dof};

/// A mode of one response's FRFs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Which mode of the model it is, the same number in all responses.
    pub mode: usize,
    /// ln ω as recorded less that of the model.
    pub difference: f64,
    /// Its standard deviation by the noise.
    pub deviation: f64,
    /// Damping ratio as recorded less that of the model.
    pub damping: f64,
    /// The damping ratio as recorded.
    pub ratio: f64,
}

/// The FRFs of one response.
pub(super) struct OfResponse {
    pub response: Channel,
    recorded: RecordedModes,
    modelled: ModelledModes,
    /// (recorded, modelled, which mode of the model), ascending.
    pairs: Vec<(usize, usize, usize)>,
}

/// Whether a sensor at a place loads the structure in the FRFs of a response.
pub(super) fn loads(sensor: &Place, response: &Channel) -> bool {
    match sensor {
        Place::Response(name) => response.is_named(name),
        _ => true,
    }
}

impl OfResponse {
    fn of(observation: &Observation, model: &Hypothesis, response: &Channel) -> Option<Self> {
        let own = observation.reduced(|_| true, |pair| pair.response == *response)?;
        let recorded = recorded(&own, model)?;
        let modelled = ModelledModes::of(&model.to_fixture().ok()?, &recorded)?;
        let pairs = Pairing::of(&recorded, &modelled).pairs.into_iter().map(|(r, m)| (r, m, 0)).collect();
        Some(OfResponse { response: response.clone(), recorded, modelled, pairs })
    }

    /// Its modes beside those of the model.
    pub(super) fn seen(&self) -> impl Iterator<Item = Seen> {
        self.pairs.iter().map(|&(recorded, modelled, mode)| {
            let (own, other) = (&self.recorded.modes[recorded].pole, &self.modelled.modes[modelled].pole);
            Seen {
                mode,
                difference: (own.omega / other.omega).ln(),
                deviation: self.recorded.deviations(recorded)[0],
                damping: own.damping_ratio - other.damping_ratio,
                ratio: own.damping_ratio,
            }
        })
    }

    /// What another model makes of each [mode](OfResponse::seen): its ln ω less that of the model itself.
    /// `None` where a mode cannot be followed there.
    pub(super) fn shifts(&self, other: &Fixture) -> Option<Vec<f64>> {
        // A sensor's FRFs are made of those without it, which have no values at their poles.
        let beside = self.modelled.clone().beside(BESIDE_POLE);
        let moved = ModelledModes::near(other, &self.recorded, &beside)?;
        let shift = |&(_, at, _): &(usize, usize, usize)| {
            (moved.modes[at].pole.omega / self.modelled.modes[at].pole.omega).ln()
        };
        Some(self.pairs.iter().map(shift).collect())
    }
}

/// The modes of each response's FRFs by themselves, beside those of `model`; the natural frequencies, rad/s,
/// of the model's modes that they show, by their number. `None` where there is one response only, or where
/// one of them is a rotation or has no modes of its own.
pub(super) fn by_response(
    observation: &Observation,
    model: &Hypothesis,
) -> Option<(Vec<OfResponse>, Vec<f64>)> {
    let mut responses: Vec<&Channel> = observation.pairs().iter().map(|pair| &pair.response).collect();
    responses.sort();
    responses.dedup();
    if responses.len() < 2 || responses.iter().any(|response| response.dof != Dof::Translation) {
        return None;
    }
    let of = |response: &&Channel| OfResponse::of(observation, model, response);
    let mut all: Vec<OfResponse> = responses.iter().map(of).collect::<Option<_>>()?;
    let mut omegas: Vec<f64> = Vec::new();
    for own in &mut all {
        for (_, modelled, mode) in &mut own.pairs {
            let omega = own.modelled.modes[*modelled].pole.omega;
            let known = omegas.iter().position(|other| (omega / other).ln().abs() < SAME_POLE);
            *mode = known.unwrap_or_else(|| {
                omegas.push(omega);
                omegas.len() - 1
            });
        }
    }
    Some((all, omegas))
}
