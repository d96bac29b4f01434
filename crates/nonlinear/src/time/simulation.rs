//! Responses of a fixture, amplitude-dependent effects included, to recorded forces.

use super::kernel::{Stepper, Steps};
use super::structure::{Reading, Structure, effects};
use crate::SimulationError;
use crate::settings::simulation::{ENOUGH, FEWEST_STEPS, FINE_SAMPLES, HALVINGS, MOST_STEPS};
use crate::spectra::{oversampled, oversampled_for_lines};
use jointscope_fixture::{EffectKind, Fixture, Place};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_inference::each;
use jointscope_spectra::Channel;

/// Hits with simulated responses, and how well their steps resolve them.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// The forces given, with the accelerations asked for.
    pub hits: Vec<Hit>,
    /// Estimated error of the time steps, relative to each response's rms: the worst of all.
    pub error: f64,
}

/// Accelerations at `outputs` that the fixture with its effects shows under the force of every hit; the hits'
/// own responses are not looked at. Each hit starts from rest. Between samples the force is the band-limited
/// signal through them.
///
/// Steps are halved until halving changes no response by more than 1e-5 of its rms. Gains, delays, offsets
/// and the response window that the fixture names are those of the simulated instruments too.
///
/// # Errors
/// Channels that the fixture does not have, effects that have no form over time.
pub fn simulate(fixture: &Fixture, hits: &[Hit], outputs: &[Channel]) -> Result<Simulation, SimulationError> {
    if let Some(effect) = fixture.physics().iter().find(|e| e.kind == EffectKind::SensorMass) {
        return Err(SimulationError::SensorMass(effect.place.to_string()));
    }
    let readings: Vec<Reading> = outputs.iter().map(|c| (c.clone(), MeasuredMotion::Acceleration)).collect();
    let simulated: Vec<(Hit, f64)> =
        each(hits, |hit| simulate_one(fixture, hit, &readings)).into_iter().collect::<Result<_, _>>()?;
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
    let system = structure.system(structure.load(hit.struck())?, readings, &[])?;
    // The force that acts, of which a gain or delay of the hammer's channel makes the one recorded.
    let hammer = Chain::of(fixture, Place::Reference(hit.struck().to_string()));
    let all = Chain::of(fixture, Place::Force);
    let (gain, delay_s) = (hammer.gain * all.gain, hammer.delay_s + all.delay_s);
    let real_force = shifted(hit.force(), 1.0 / gain, -delay_s / hit.interval());
    let run = |within: usize| {
        let steps = Steps { interval: hit.interval(), within, halvings: HALVINGS };
        let stepper = Stepper::new(&system, steps)?;
        let outputs = stepper.run(&oversampled_for_lines(&real_force, within), hit.samples());
        outputs.iter().flatten().all(|value| value.is_finite()).then_some(outputs)
    };
    let run = |within: usize| run(within).ok_or(SimulationError::Unbounded { hit: hit.number() });
    let mut within = FEWEST_STEPS;
    let mut coarse = run(within)?;
    loop {
        within *= 2;
        let fine = run(within)?;
        // The error falls at least with the square of the step: that of the finer one is below a third of the
        // difference.
        let error =
            coarse.iter().zip(&fine).map(|(a, b)| relative_difference(a, b) / 3.0).fold(0.0, f64::max);
        if error < ENOUGH || within >= MOST_STEPS {
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

fn recorded(
    fixture: &Fixture,
    hit: &Hit,
    readings: &[Reading],
    outputs: Vec<Vec<f64>>,
) -> Result<Hit, SimulationError> {
    let windows = effects(fixture, EffectKind::ExponentialWindow, Place::All);
    let decay: f64 = windows.map(|e| e.value(0)).sum();
    let responses = readings.iter().zip(outputs).map(|((channel, motion), values)| {
        let chain = Chain::of(fixture, Place::Response(channel.to_string()));
        let mut values = shifted(&values, chain.gain, chain.delay_s / hit.interval());
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
    delay_s: f64,
}

impl Chain {
    fn of(fixture: &Fixture, channel: Place) -> Self {
        let values = |kind| effects(fixture, kind, channel.clone()).map(|e| e.value(0));
        let gain = values(EffectKind::ChannelGain).product();
        Chain { gain, delay_s: values(EffectKind::ChannelDelay).sum() }
    }
}

/// The signal times `gain`, `shift` samples later, band-limited.
fn shifted(values: &[f64], gain: f64, shift: f64) -> Vec<f64> {
    let scaled: Vec<f64> = values.iter().map(|v| v * gain).collect();
    if shift == 0.0 {
        return scaled;
    }
    let fine = oversampled(&scaled, FINE_SAMPLES);
    let read = |index: f64| if index < 0.0 { 0.0 } else { fine.get(index as usize).copied().unwrap_or(0.0) };
    let value = |i: usize| {
        let at = (i as f64 - shift) * FINE_SAMPLES as f64;
        let (low, part) = (at.floor(), at - at.floor());
        read(low) * (1.0 - part) + read(low + 1.0) * part
    };
    (0..values.len()).map(value).collect()
}
