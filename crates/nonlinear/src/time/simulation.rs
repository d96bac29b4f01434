//! Responses of a fixture, amplitude-dependent effects included, to recorded forces.

use super::kernel::{Stepper, Steps};
use super::oversampling::{oversampled, oversampled_for_lines};
use super::structure::{Reading, Structure};
use crate::SimulationError;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_hits::{Hit, Motion, Response};
use jointscope_spectra::Channel;
use rayon::prelude::*;

/// Hits with simulated responses, and how well their steps resolve them.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// The forces given, with the accelerations asked for.
    pub hits: Vec<Hit>,
    /// Estimated error of the time steps, relative to each response's rms: the worst of all.
    pub error: f64,
}

/// Steps within a sampling interval to begin with and at the most.
const FEWEST: usize = 4;
const MOST: usize = 256;
/// Halvings of a step with an event.
const HALVINGS: usize = 12;
/// Error below which steps are not refined, relative to a response's rms.
const ENOUGH: f64 = 1e-5;

/// Accelerations at `outputs` that the fixture with its effects shows under the force of every hit; the hits' own responses are not
/// looked at. Each hit starts from rest. Between samples the force is the band-limited signal through them.
///
/// Steps are halved until halving changes no response by more than 1e-5 of its rms. Gains, delays, offsets and the
/// response window that the fixture names are those of the simulated instruments too.
///
/// # Errors
/// Channels that the fixture does not have, effects that have no form over time.
pub fn simulate(fixture: &Fixture, hits: &[Hit], outputs: &[Channel]) -> Result<Simulation, SimulationError> {
    if let Some(effect) = fixture.physics().iter().find(|e| e.kind == EffectKind::SensorMass) {
        return Err(SimulationError::SensorMass { place: effect.place.to_string() });
    }
    let readings: Vec<Reading> = outputs.iter().map(|c| (c.clone(), Motion::Acceleration)).collect();
    let simulated: Vec<(Hit, f64)> =
        hits.par_iter().map(|hit| simulate_one(fixture, hit, &readings)).collect::<Result<_, _>>()?;
    let error = simulated.iter().fold(0.0, |worst: f64, (_, error)| error.max(worst));
    Ok(Simulation { hits: simulated.into_iter().map(|(hit, _)| hit).collect(), error })
}

/// What `readings` read under one hit, and the estimated error of the steps.
pub(crate) fn simulate_one(
    fixture: &Fixture,
    hit: &Hit,
    readings: &[Reading],
) -> Result<(Hit, f64), SimulationError> {
    let structure = Structure::new(fixture, 0.5 / hit.interval())?;
    let system = structure.system(hit.struck(), readings)?;
    let real_force = unmeasured(fixture, hit);
    let run = |within: usize| {
        let steps = Steps { interval: hit.interval(), within, halvings: HALVINGS };
        let stepper = Stepper::new(&system, steps).ok_or(SimulationError::Unbounded { hit: hit.number() })?;
        let outputs = stepper.run(&oversampled_for_lines(&real_force, within), hit.samples()).outputs;
        match outputs.iter().flatten().all(|value| value.is_finite()) {
            true => Ok(outputs),
            false => Err(SimulationError::Unbounded { hit: hit.number() }),
        }
    };
    let mut within = FEWEST;
    let mut coarse = run(within)?;
    loop {
        within *= 2;
        let fine = run(within)?;
        // The error falls at least with the square of the step: that of the finer one is below a third of the difference.
        let error =
            coarse.iter().zip(&fine).map(|(a, b)| relative_difference(a, b) / 3.0).fold(0.0, f64::max);
        if error < ENOUGH || within >= MOST {
            return Ok((recorded(fixture, hit, readings, fine)?, error));
        }
        coarse = fine;
    }
}

fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = b.iter().map(|b| b * b).sum();
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    if square > 0.0 { (difference / square).sqrt() } else { 0.0 }
}

/// The force that acts, of which a gain or delay of the hammer's channel makes the one recorded.
fn unmeasured(fixture: &Fixture, hit: &Hit) -> Vec<f64> {
    let name = hit.struck().to_string();
    let chain = Chain::of(fixture, |place| matches!(place, Place::Reference(channel) if *channel == name));
    chain.applied(hit.force(), 1.0 / chain.gain, -chain.delay / hit.interval())
}

fn recorded(
    fixture: &Fixture,
    hit: &Hit,
    readings: &[Reading],
    outputs: Vec<Vec<f64>>,
) -> Result<Hit, SimulationError> {
    let window = |e: &&Effect| e.kind == EffectKind::ExponentialWindow;
    let decay: f64 = fixture.physics().iter().filter(window).map(|e| e.value(0)).sum();
    let responses = readings.iter().zip(outputs).map(|((channel, motion), values)| {
        let name = channel.to_string();
        let chain = Chain::of(fixture, |place| matches!(place, Place::Response(channel) if *channel == name));
        let mut values = chain.applied(&values, chain.gain, chain.delay / hit.interval());
        if decay > 0.0 {
            let at = |i: usize| (-decay * hit.interval() * i as f64).exp();
            values.iter_mut().enumerate().for_each(|(i, value)| *value *= at(i));
        }
        Response::new(channel.clone(), *motion, values)
    });
    let (interval, start) = (hit.interval(), hit.start());
    let force = hit.force().to_vec();
    Ok(Hit::new(hit.number(), interval, start, hit.struck().clone(), force, responses.collect())?)
}

/// Gain and delay of a channel.
struct Chain {
    gain: f64,
    delay: f64,
}

impl Chain {
    fn of(fixture: &Fixture, here: impl Fn(&Place) -> bool) -> Self {
        let mut chain = Chain { gain: 1.0, delay: 0.0 };
        for effect in fixture.physics().iter().filter(|e| here(&e.place)) {
            match effect.kind {
                EffectKind::ChannelGain => chain.gain *= effect.value(0),
                EffectKind::ChannelDelay => chain.delay += effect.value(0),
                _ => {}
            }
        }
        chain
    }

    /// Multiplies by `gain` and shifts by `shift` samples towards later times, band-limited.
    fn applied(&self, values: &[f64], gain: f64, shift: f64) -> Vec<f64> {
        const FINE: usize = 64;
        let mut all: Vec<f64> = values.iter().map(|v| v * gain).collect();
        if shift != 0.0 {
            let fine = oversampled(&all, FINE);
            for (i, value) in all.iter_mut().enumerate() {
                let at = (i as f64 - shift) * FINE as f64;
                let (low, part) = (at.floor(), at - at.floor());
                let read = |index: f64| {
                    if index < 0.0 { 0.0 } else { fine.get(index as usize).copied().unwrap_or(0.0) }
                };
                *value = read(low) * (1.0 - part) + read(low + 1.0) * part;
            }
        }
        all
    }
}
