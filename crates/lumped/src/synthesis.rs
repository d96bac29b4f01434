use crate::lanes::{Lanes, WIDTH};
use crate::{LumpedError, Model, Receptances, Station};
use jointscope_fixture::{BodyKind, EffectKind, Fixture, Place};
use jointscope_linalg::Field;
use jointscope_spectra::{Channel, Dof, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Whether the measuring chain's effects are part of what is synthesised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    /// As this test's sensors and analyser would record it: offsets, gains, delays, sensor masses, window.
    AsRecorded,
    /// As a perfect instrument at the stated points would read it.
    Perfect,
}

/// Accelerances stand in for their limit at 0 Hz by their value this close to it.
const NEARLY_ZERO_HZ: f64 = 1e-5;

/// Accelerances of the fixture with its effects, between the channels of `pairs` (eq 18, 41).
///
/// At 0 Hz the value is the limit of the accelerance. Variances are not part of it.
///
/// # Errors
/// Unknown points, rotations of bodies that have none, effects that depend on amplitude, undamped
/// resonances on a line.
pub fn synthesize(
    fixture: &Fixture,
    pairs: &[FrfPair],
    lines: &SpectralLines,
    instrument: Instrument,
) -> Result<FrfSet, LumpedError> {
    let values = accelerances(fixture, pairs, lines, instrument)?;
    Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?)
}

/// The values alone of what [`synthesize`] returns: all lines of the first pair, then of the second, …
///
/// # Errors
/// Those of [`synthesize`].
pub fn accelerances(
    fixture: &Fixture,
    pairs: &[FrfPair],
    lines: &SpectralLines,
    instrument: Instrument,
) -> Result<Vec<Complex64>, LumpedError> {
    let model = Model::new(fixture, lines.hz()[lines.len() - 1])?;
    let chain = MeasuringChain::of(fixture, instrument);
    let mut stations = Stations::default();
    let mut wanted = Vec::with_capacity(pairs.len());
    for pair in pairs {
        let output = stations.output(chain.station(fixture, pair, &pair.response)?);
        wanted.push((output, stations.input(chain.station(fixture, pair, &pair.reference)?)));
    }
    let mut loads = Vec::with_capacity(pairs.len());
    for (index, pair) in pairs.iter().enumerate() {
        let mass = chain.sensor_mass(&pair.response);
        if mass == 0.0 {
            loads.push(None);
            continue;
        }
        let seat = chain.station(fixture, pair, &Channel::transverse(pair.response.point.clone()))?;
        loads.push(Some(stations.sensor(mass, seat, &mut wanted, index)));
    }
    let mut receptances = model.receptances_of(&stations.outputs, &stations.inputs, wanted);
    chain.record(&mut receptances, pairs, &loads, lines)
}

/// Stations in use, each once.
#[derive(Default)]
struct Stations {
    outputs: Vec<Station>,
    inputs: Vec<Station>,
}

impl Stations {
    fn output(&mut self, station: Station) -> usize {
        index_in(&mut self.outputs, station)
    }

    fn input(&mut self, station: Station) -> usize {
        index_in(&mut self.inputs, station)
    }

    /// Asks for what a sensor's own mass changes its row through: the receptance where it sits, from there to
    /// the response, and from the reference to there.
    fn sensor(
        &mut self,
        mass: f64,
        seat: Station,
        wanted: &mut Vec<(usize, usize)>,
        frf: usize,
    ) -> SensorLoad {
        let (response, reference) = wanted[frf];
        let (seat_in, seat_out) = (self.input(seat), self.output(seat));
        let first = wanted.len();
        wanted.extend([(seat_out, seat_in), (response, seat_in), (seat_out, reference)]);
        SensorLoad { mass, first }
    }
}

/// A sensor's mass and where its three receptances stand among the wanted ones.
struct SensorLoad {
    mass: f64,
    first: usize,
}

impl SensorLoad {
    /// H_oi − H_os δ H_si / (1 + δ H_ss), δ = s² m.
    #[inline(always)]
    fn change(&self, s: Lanes, receptance: Lanes, all: &[Lanes]) -> Lanes {
        let inertia = s * s * self.mass;
        let (driving, to_response, from_reference) =
            (all[self.first], all[self.first + 1], all[self.first + 2]);
        let loaded = (Lanes::ONE + inertia * driving).reciprocal();
        receptance - to_response * inertia * from_reference * loaded
    }
}

fn index_in(stations: &mut Vec<Station>, station: Station) -> usize {
    stations.iter().position(|s| *s == station).unwrap_or_else(|| {
        stations.push(station);
        stations.len() - 1
    })
}

/// The effects between the structure and the file.
struct MeasuringChain<'a> {
    fixture: &'a Fixture,
    active: bool,
}

impl<'a> MeasuringChain<'a> {
    fn of(fixture: &'a Fixture, instrument: Instrument) -> Self {
        MeasuringChain { fixture, active: instrument == Instrument::AsRecorded }
    }

    /// Sum, over the effects of this kind that `applies` to, of the parameter.
    fn sum(&self, kind: EffectKind, applies: impl Fn(&Place) -> bool) -> f64 {
        let effects = self.fixture.physics().iter().filter(|e| self.active && e.kind == kind);
        effects.filter(|e| applies(&e.place)).map(|e| e.value(0)).sum()
    }

    fn station(&self, fixture: &Fixture, pair: &FrfPair, channel: &Channel) -> Result<Station, LumpedError> {
        let point = fixture.point(&channel.point).ok_or_else(|| LumpedError::UnknownPoint {
            frf: pair.to_string(),
            point: channel.point.clone(),
            known: fixture.points().iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", "),
        })?;
        if channel.dof == Dof::Rotation
            && matches!(&fixture.bodies()[point.body].kind, BodyKind::Rigid(rigid) if !rigid.rotates)
        {
            return Err(LumpedError::NoRotation { frf: pair.to_string(), point: channel.point.clone() });
        }
        let offset = self.sum(
            EffectKind::PointOffset,
            |place| matches!(place, Place::Point(name) if *name == channel.point),
        );
        Ok(Station { body: point.body, x: point.x.value + offset, dof: channel.dof })
    }

    fn sensor_mass(&self, response: &Channel) -> f64 {
        self.sum(
            EffectKind::SensorMass,
            |place| matches!(place, Place::Response(name) if response.is_named(name)),
        )
    }

    /// Gain and delay (s) of an FRF: a response is multiplied, a reference divides.
    fn gain_and_delay(&self, pair: &FrfPair) -> (f64, f64) {
        let (mut gain, mut delay) = (1.0, 0.0);
        for effect in self.fixture.physics().iter().filter(|_| self.active) {
            let sign = match &effect.place {
                Place::Response(name) if pair.response.is_named(name) => 1.0,
                Place::Reference(name) if pair.reference.is_named(name) => -1.0,
                _ => continue,
            };
            match effect.kind {
                EffectKind::ChannelGain => {
                    gain *= if sign > 0.0 { effect.value(0) } else { 1.0 / effect.value(0) }
                }
                EffectKind::ChannelDelay => delay += sign * effect.value(0),
                _ => {}
            }
        }
        (gain, delay)
    }

    fn record(
        &self,
        receptances: &mut Receptances,
        pairs: &[FrfPair],
        loads: &[Option<SensorLoad>],
        lines: &SpectralLines,
    ) -> Result<Vec<Complex64>, LumpedError> {
        let decay = self.sum(EffectKind::ExponentialWindow, |_| true);
        let chain: Vec<(f64, f64)> = pairs.iter().map(|pair| self.gain_and_delay(pair)).collect();
        let omegas = lines.hz().iter().map(|hz| TAU * hz.max(NEARLY_ZERO_HZ));
        let s: Vec<Complex64> = omegas.map(|omega| Complex64::new(decay, omega)).collect();
        let count = lines.len();
        let mut values = vec![Complex64::ZERO; pairs.len() * count];
        let recorded = receptances.in_blocks(
            &s,
            #[inline(always)]
            |first, s, block| {
                let last = (first + WIDTH).min(count);
                let squared = s * s;
                let courses = values.chunks_exact_mut(count).map(|course| &mut course[first..last]);
                for (index, (course, (gain, _))) in courses.zip(&chain).enumerate() {
                    let receptance = match &loads[index] {
                        Some(load) => load.change(s, block[index], block),
                        None => block[index],
                    };
                    (squared * receptance * *gain).write(course);
                }
            },
        );
        recorded.map_err(|line| LumpedError::Unbounded { frequency: lines.hz()[line] })?;
        for (course, (_, delay)) in values.chunks_exact_mut(count).zip(chain).filter(|(_, c)| c.1 != 0.0) {
            for (value, s) in course.iter_mut().zip(&s) {
                *value *= Complex64::cis(-s.im * delay);
            }
        }
        Ok(values)
    }
}
