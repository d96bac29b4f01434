//! What the channels read: FRFs of a structure, by a perfect instrument or by the one the fixture describes.

use crate::effects::all;
use crate::physical::window_decay;
use crate::{Row, Structure, StructureError};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place, Side};
use jointscope_linalg::LuWorkspace;
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Who reads the structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    /// A perfect one, at the stated points.
    Perfect,
    /// The one of the fixture's `physics`: displaced points, gains, delays, sensor masses, window.
    AsDescribed,
}

impl Instrument {
    pub(crate) fn is_perfect(self) -> bool {
        self == Instrument::Perfect
    }

    /// The effects that it reads through.
    pub(crate) fn effects(self, fixture: &Fixture) -> &[Effect] {
        match self {
            Instrument::Perfect => &[],
            Instrument::AsDescribed => fixture.physics(),
        }
    }
}

/// Noise-free accelerances of the assembly that `fixture` describes, its structural effects included.
///
/// # Errors
/// A non-linear effect, an unknown point, a line at which the structure does not resist.
pub fn frfs(
    fixture: &Fixture,
    pairs: &[FrfPair],
    lines: &SpectralLines,
    instrument: Instrument,
) -> Result<FrfSet, StructureError> {
    let structure = Structure::of(fixture)?;
    read(&structure, instrument.effects(fixture), pairs, lines)
}

/// Noise-free accelerances of a structure, read through the instrumental ones among `effects`.
///
/// # Errors
/// As [`frfs`].
pub fn read(
    structure: &Structure,
    effects: &[Effect],
    pairs: &[FrfPair],
    lines: &SpectralLines,
) -> Result<FrfSet, StructureError> {
    let mut forces = Forces::default();
    let circuits = pairs
        .iter()
        .map(|pair| Circuit::of(structure, effects, pair, &mut forces))
        .collect::<Result<Vec<_>, _>>()?;
    let order = structure.assembly().order();
    let decay = window_decay(effects);
    let mut lu = LuWorkspace::new();
    let mut motions = vec![Complex64::ZERO; order * forces.0.len()];
    let mut values = vec![Complex64::ZERO; pairs.len() * lines.len()];
    for (line, omega) in lines.omegas().enumerate() {
        let s = Complex64::new(decay, omega);
        lu.factorize(order, |into| structure.assembly().dynamic_stiffness(s, into))
            .map_err(|_| StructureError::Singular { frequency: lines.hz()[line] })?;
        motions.fill(Complex64::ZERO);
        for (force, motion) in forces.0.iter().zip(motions.chunks_exact_mut(order.max(1))) {
            for &(index, factor) in force.terms() {
                motion[index] += factor;
            }
            lu.solve_in_place(motion);
        }
        for (frf, circuit) in circuits.iter().enumerate() {
            values[frf * lines.len() + line] = circuit.reading(&motions, order, s);
        }
    }
    Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?)
}

/// The distinct unit forces that have to be applied.
#[derive(Default)]
struct Forces(Vec<Row>);

impl Forces {
    fn index_of(&mut self, row: &Row) -> usize {
        self.0.iter().position(|known| known == row).unwrap_or_else(|| {
            self.0.push(row.clone());
            self.0.len() - 1
        })
    }
}

/// One FRF's way from the force to the reading.
struct Circuit {
    response: Row,
    reference: usize,
    gain: f64,
    delay: f64,
    /// Corners of high-passes (rad/s), and natural frequencies (rad/s) and damping ratios of resonating
    /// sensors, each with the power by which it enters.
    corners: Vec<(f64, i32)>,
    resonances: Vec<([f64; 2], i32)>,
    sensor: Option<Sensor>,
}

/// A roving sensor: its mass, and the place it sits at, as a motion and as a unit force.
struct Sensor {
    mass: f64,
    place: Row,
    force: usize,
}

impl Circuit {
    fn of(
        structure: &Structure,
        effects: &[Effect],
        pair: &FrfPair,
        forces: &mut Forces,
    ) -> Result<Self, StructureError> {
        let displaced = all(effects, EffectKind::PointOffset).next().is_some();
        let place = |channel: &Channel, side: Side| {
            if displaced { structure.motion_as_mounted(channel, side) } else { structure.motion(channel) }
        };
        let on = |kind: EffectKind| {
            let (response, reference) = (pair.response.to_string(), pair.reference.to_string());
            all(effects, kind).filter_map(move |effect| match &effect.place {
                Place::Response(name) if *name == response => Some((effect.value(0), 1)),
                Place::Reference(name) if *name == reference => Some((effect.value(0), -1)),
                Place::Record(name) if *name == format!("{response}/{reference}") => {
                    Some((effect.value(0), 1))
                }
                Place::Responses => Some((effect.value(0), 1)),
                Place::Force => Some((effect.value(0), -1)),
                _ => None,
            })
        };
        let power = |place: &Place| match place {
            Place::Response(name) if *name == pair.response.to_string() => Some(1),
            Place::Record(name) if *name == pair.to_string() => Some(1),
            Place::Responses => Some(1),
            Place::Reference(name) if *name == pair.reference.to_string() => Some(-1),
            Place::Force => Some(-1),
            _ => None,
        };
        let resonances = all(effects, EffectKind::ChannelResonance);
        let resonances =
            resonances.filter_map(|e| Some(([TAU * e.value(0), e.value(1)], power(&e.place)?))).collect();
        let mass: f64 = on(EffectKind::SensorMass).map(|(mass, _)| mass).sum();
        let sensor = if mass == 0.0 {
            None
        } else {
            let place = place(&Channel::transverse(&pair.response.point), Side::Response)?.clone();
            Some(Sensor { mass, force: forces.index_of(&place), place })
        };
        Ok(Circuit {
            response: place(&pair.response, Side::Response)?.clone(),
            reference: forces.index_of(place(&pair.reference, Side::Reference)?),
            gain: on(EffectKind::ChannelGain).map(|(factor, side): (f64, i32)| factor.powi(side)).product(),
            delay: on(EffectKind::ChannelDelay).map(|(seconds, side)| seconds * f64::from(side)).sum(),
            corners: on(EffectKind::ChannelHighpass).map(|(corner, side)| (TAU * corner, side)).collect(),
            resonances,
            sensor,
        })
    }

    /// Acceleration read per force read, at s = decay + iω.
    fn reading(&self, motions: &[Complex64], order: usize, s: Complex64) -> Complex64 {
        let receptance = |row: &Row, force: usize| {
            row.terms().iter().map(|&(i, factor)| motions[force * order + i] * factor).sum::<Complex64>()
        };
        let mut value = receptance(&self.response, self.reference);
        if let Some(sensor) = &self.sensor {
            // The sensor's inertia force s²m·y pulls on the structure only while this response is read.
            let inertia = s * s * sensor.mass;
            let unloaded = receptance(&sensor.place, self.reference);
            let loaded = unloaded / (1.0 + inertia * receptance(&sensor.place, sensor.force));
            value -= inertia * receptance(&self.response, sensor.force) * loaded;
        }
        let mut signal = s * s * value * self.gain;
        for &(corner, power) in &self.corners {
            signal *= (1.0 + corner / s).powi(-power);
        }
        for &([omega, ratio], power) in &self.resonances {
            let scaled = s / omega;
            signal *= (1.0 + 2.0 * ratio * scaled + scaled * scaled).powi(-power);
        }
        // Most channels are not late, and a sine and cosine cost as much as the rest.
        if self.delay == 0.0 { signal } else { signal * Complex64::from_polar(1.0, -s.im * self.delay) }
    }
}
