//! What stands between the structure and a recorded value: seats, sensors' masses, gains, delays, window.

use jointscope_fixture::{EffectKind, Fixture, Place};
use jointscope_lumped::Station;
use jointscope_spectra::{Channel, Dof, FrfPair};
use num_complex::Complex64;

/// How one FRF is read from the structure.
#[derive(Debug, Clone)]
pub(super) struct Reading {
    pub output: Station,
    pub input: Station,
    /// Seat and mass (kg) of a sensor that is there only while this FRF is measured.
    pub load: Option<(Station, f64)>,
    gain: f64,
    delay: f64,
}

/// How all FRFs of an observation are read.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    pub readings: Vec<Reading>,
    decay: f64,
}

impl Chain {
    /// The chain that the fixture's effects describe; `None` where a channel's point does not exist.
    pub fn of(fixture: &Fixture, pairs: &[FrfPair]) -> Option<Self> {
        let read = |pair: &FrfPair| {
            let mut reading = Reading {
                output: station(fixture, &pair.response)?,
                input: station(fixture, &pair.reference)?,
                load: None,
                gain: 1.0,
                delay: 0.0,
            };
            let (response, reference) = (pair.response.to_string(), pair.reference.to_string());
            for effect in fixture.physics() {
                let response_side = match &effect.place {
                    Place::Response(name) if *name == response => true,
                    Place::Reference(name) if *name == reference => false,
                    _ => continue,
                };
                let value = effect.value(0);
                match (effect.kind, response_side) {
                    (EffectKind::ChannelGain, true) => reading.gain *= value,
                    (EffectKind::ChannelGain, false) => reading.gain /= value,
                    (EffectKind::ChannelDelay, true) => reading.delay += value,
                    (EffectKind::ChannelDelay, false) => reading.delay -= value,
                    (EffectKind::SensorMass, true) => {
                        let seat = station(fixture, &Channel::transverse(pair.response.point.clone()))?;
                        let earlier = reading.load.map_or(0.0, |(_, mass)| mass);
                        reading.load = Some((seat, earlier + value));
                    }
                    _ => {}
                }
            }
            Some(reading)
        };
        let windows = fixture.physics().iter().filter(|e| e.kind == EffectKind::ExponentialWindow);
        Some(Chain {
            readings: pairs.iter().map(read).collect::<Option<_>>()?,
            decay: windows.map(|e| e.value(0)).sum(),
        })
    }

    /// Where on the s-plane a line is read.
    pub fn s(&self, omega: f64) -> Complex64 {
        Complex64::new(self.decay, omega)
    }

    /// Recorded accelerance per receptance of FRF `index`.
    pub fn factor(&self, index: usize, omega: f64) -> Complex64 {
        let s = self.s(omega);
        let reading = &self.readings[index];
        let turned = if reading.delay == 0.0 {
            Complex64::ONE
        } else {
            Complex64::new(0.0, -omega * reading.delay).exp()
        };
        s * s * turned * reading.gain
    }
}

/// Where a channel sits, offsets included.
pub(super) fn station(fixture: &Fixture, channel: &Channel) -> Option<Station> {
    let point = fixture.point(&channel.point)?;
    let offsets = fixture.physics().iter().filter(|e| {
        e.kind == EffectKind::PointOffset && matches!(&e.place, Place::Point(name) if *name == channel.point)
    });
    let x = point.x.value + offsets.map(|e| e.value(0)).sum::<f64>();
    let dof = match channel.dof {
        Dof::Translation => Station::transverse(point.body, x),
        Dof::Rotation => Station::rotational(point.body, x),
    };
    Some(dof)
}
