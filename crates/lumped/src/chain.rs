//! What stands between the structure and a recorded value: where sensors sit, their masses, gains, delays,
//! window.

use crate::effects::{Action, SignalFilter, actions};
use crate::{LumpedError, Station};
use jointscope_fixture::{Fixture, Place, Side};
use jointscope_spectra::{Channel, Dof, FrfPair};
use num_complex::Complex64;

/// Whether the measuring chain's effects are part of what is synthesised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    /// As this test's sensors and analyser would record it: offsets, gains, delays, sensor masses, window.
    AsRecorded,
    /// As a perfect instrument at the stated points would read it.
    Perfect,
}

/// How one FRF is read from the structure.
#[derive(Debug, Clone)]
pub struct Reading {
    /// Where the response is read.
    pub output: Station,
    /// Where the structure is struck.
    pub input: Station,
    /// Place and mass (kg) of a sensor that is there only while this FRF is measured.
    pub load: Option<(Station, f64)>,
    /// Factor on the FRF: a response is multiplied by its channel's gain, a reference divides.
    pub gain: f64,
    /// Delay of the response against the reference, s.
    pub delay: f64,
    /// Filters: those of the response as they are, those of reference and force with `true`: they divide.
    pub filters: Vec<(SignalFilter, bool)>,
}

impl Reading {
    /// Product of the filters at s, those of reference and force inverted.
    pub(crate) fn filtered(&self, s: Complex64) -> Complex64 {
        self.filters.iter().fold(Complex64::ONE, |all, (filter, divides)| {
            let own = filter.at(s);
            // At 0 Hz a high-pass passes nothing: no recorded value says anything there.
            if *divides && own != Complex64::ZERO { all / own } else { all * own }
        })
    }
}

impl Reading {
    /// Whether the signals of another reading pass the same gains, delays and filters, wherever they are
    /// taken.
    pub fn has_signals_of(&self, other: &Reading) -> bool {
        let (here, there) = (self, other);
        here.gain == there.gain && here.delay == there.delay && here.filters == there.filters
    }
}

/// How all FRFs of a recording are read.
#[derive(Debug, Clone)]
pub struct MeasuringChain {
    /// One reading a pair, in their order.
    pub readings: Vec<Reading>,
    decay: f64,
}

impl MeasuringChain {
    /// The chain that the fixture's effects describe, or a perfect one.
    ///
    /// # Errors
    /// Channels at points that do not exist, rotations of bodies that have none.
    pub fn of(fixture: &Fixture, pairs: &[FrfPair], instrument: Instrument) -> Result<Self, LumpedError> {
        let effects: Vec<Action> = match instrument {
            Instrument::AsRecorded => actions(fixture).collect(),
            Instrument::Perfect => Vec::new(),
        };
        let read = |pair| reading(fixture, &effects, pair);
        Ok(MeasuringChain {
            readings: pairs.iter().map(read).collect::<Result<_, _>>()?,
            decay: decay(effects),
        })
    }

    /// Decay of the responses' exponential window, 1/s.
    pub fn decay(&self) -> f64 {
        self.decay
    }

    /// Where on the s-plane a line is read.
    pub fn s(&self, omega: f64) -> Complex64 {
        Complex64::new(self.decay, omega)
    }

    /// Recorded accelerance per receptance of FRF `index`.
    pub fn factor(&self, index: usize, omega: f64) -> Complex64 {
        let s = self.s(omega);
        let Reading { gain, delay, .. } = &self.readings[index];
        let turned = if *delay == 0.0 { Complex64::ONE } else { Complex64::cis(-omega * delay) };
        s * s * turned * self.readings[index].filtered(s) * *gain
    }
}

/// Decay of the responses' exponential window, 1/s; zero where there is none.
pub fn window_decay(fixture: &Fixture) -> f64 {
    decay(actions(fixture))
}

/// Where a channel sits, offsets of its point included; `None` where its point does not exist.
pub fn channel_station(fixture: &Fixture, channel: &Channel, side: Side) -> Option<Station> {
    station(fixture, actions(fixture), channel, side)
}

fn decay<'a>(effects: impl IntoIterator<Item = Action<'a>>) -> f64 {
    let of = |action| if let Action::Window { decay } = action { decay } else { 0.0 };
    effects.into_iter().map(of).sum()
}

fn station<'a>(
    fixture: &Fixture,
    effects: impl IntoIterator<Item = Action<'a>>,
    channel: &Channel,
    side: Side,
) -> Option<Station> {
    let point = fixture.point(&channel.point)?;
    let offset = |action| match action {
        Action::Offset { place, dx } if place.holds_channel(&channel.point, side) => dx,
        _ => 0.0,
    };
    let x = point.x.value + effects.into_iter().map(offset).sum::<f64>();
    Some(Station { body: point.body, x, dof: channel.dof })
}

fn reading(fixture: &Fixture, effects: &[Action], pair: &FrfPair) -> Result<Reading, LumpedError> {
    let at = |channel: &Channel, side: Side| placed(fixture, effects, pair, (channel, side));
    let (mut gain, mut delay, mut load) = (1.0, 0.0, 0.0);
    let mut filters = Vec::new();
    for effect in effects {
        match *effect {
            Action::Signal { channel, gain: g, delay: t } => match signal_power(channel, pair) {
                1 => {
                    gain *= g;
                    delay += t;
                }
                -1 => {
                    gain *= 1.0 / g;
                    delay -= t;
                }
                _ => {}
            },
            Action::Filtered { channel, filter } => match signal_power(channel, pair) {
                1 => filters.push((filter, false)),
                -1 => filters.push((filter, true)),
                _ => {}
            },
            Action::SensorLoad { response, mass } if signal_power(response, pair) == 1 => load += mass,
            _ => {}
        }
    }
    let load = match load {
        0.0 => None,
        mass => Some((at(&Channel::transverse(pair.response.point.clone()), Side::Response)?, mass)),
    };
    let output = at(&pair.response, Side::Response)?;
    let input = at(&pair.reference, Side::Reference)?;
    Ok(Reading { output, input, load, gain, delay, filters })
}

/// The power with which what a channel does to its signal enters an FRF: 1 of its own response, of what all
/// responses have in common and of its own record, which multiply it, −1 of its own reference and of the
/// force of all references, which divide it, 0 of what it does not pass.
pub fn signal_power(channel: &Place, pair: &FrfPair) -> i32 {
    match channel {
        Place::Response(name) => i32::from(pair.response.is_named(name)),
        Place::Responses => 1,
        Place::Record(name) => i32::from(pair.is_named(name)),
        Place::Reference(name) => -i32::from(pair.reference.is_named(name)),
        Place::Force => -1,
        _ => 0,
    }
}

fn placed(
    fixture: &Fixture,
    effects: &[Action],
    pair: &FrfPair,
    (channel, side): (&Channel, Side),
) -> Result<Station, LumpedError> {
    let station = station(fixture, effects.iter().copied(), channel, side).ok_or_else(|| {
        LumpedError::UnknownPoint {
            frf: pair.to_string(),
            point: channel.point.clone(),
            known: fixture.points().iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", "),
        }
    })?;
    if channel.dof == Dof::Rotation && !fixture.bodies()[station.body].kind.rotates() {
        return Err(LumpedError::NoRotation { frf: pair.to_string(), point: channel.point.clone() });
    }
    Ok(station)
}
