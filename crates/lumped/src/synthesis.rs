//! Accelerances of a fixture on spectral lines, as perfect instruments or the stated ones would record them.

use crate::lanes::{Lines, WIDTH};
use crate::{Instrument, LumpedError, MeasuringChain, Model, Reading, Receptances, Station};
use jointscope_fixture::Fixture;
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

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
    ModelledTest::new(fixture, pairs, lines.hz()[lines.len() - 1], instrument)?.accelerances(lines)
}

/// A model with the channels of a test, ready to tell what would be recorded: on spectral lines, or anywhere
/// on the plane of complex frequencies.
#[derive(Debug, Clone)]
pub struct ModelledTest {
    pub(crate) model: Model,
    pub(crate) chain: MeasuringChain,
    pub(crate) stations: Stations,
    /// (output, input) of each receptance that is needed, those of the FRFs first.
    pub(crate) wanted: Vec<(usize, usize)>,
    loads: Vec<Option<SensorLoad>>,
}

impl ModelledTest {
    /// Models the fixture between the channels of `pairs`, beams meshed for lines up to `highest_hz`.
    ///
    /// # Errors
    /// Unknown points, rotations of bodies that have none, effects that depend on amplitude.
    pub fn new(
        fixture: &Fixture,
        pairs: &[FrfPair],
        highest_hz: f64,
        instrument: Instrument,
    ) -> Result<Self, LumpedError> {
        ModelledTest::of(Model::new(fixture, highest_hz)?, fixture, pairs, instrument)
    }

    /// A model of the fixture with the channels of `pairs`.
    pub(crate) fn of(
        model: Model,
        fixture: &Fixture,
        pairs: &[FrfPair],
        instrument: Instrument,
    ) -> Result<Self, LumpedError> {
        let chain = MeasuringChain::of(fixture, pairs, instrument)?;
        let (mut stations, mut wanted) = channels(&chain);
        let mut loads = Vec::with_capacity(pairs.len());
        for (index, reading) in chain.readings.iter().enumerate() {
            loads
                .push(reading.load.map(|(station, mass)| stations.sensor(mass, station, &mut wanted, index)));
        }
        Ok(ModelledTest { model, chain, stations, wanted, loads })
    }

    /// Whether modes were found to first order beside others, as a [`Vicinity`](crate::Vicinity) does where
    /// it can.
    pub fn is_first_order(&self) -> bool {
        self.model.is_first_order()
    }

    /// Decay of the exponential window over force and responses, 1/s; zero without one.
    pub fn window_decay(&self) -> f64 {
        self.chain.decay()
    }

    /// What gains and delays of its channels, but no filters, make of each FRF at a frequency, rad/s.
    pub fn gains_and_delays(&self, omega: f64) -> Vec<Complex64> {
        let of = |reading: &Reading| reading.gain * Complex64::cis(-omega * reading.delay);
        self.chain.readings.iter().map(of).collect()
    }

    fn receptances(&self) -> Receptances<'_> {
        self.model.receptances_of(&self.stations.outputs, &self.stations.inputs, self.wanted.clone())
    }

    /// What would be recorded: all lines of the first FRF, then of the second, …
    ///
    /// # Errors
    /// Undamped resonances on a line.
    pub fn accelerances(&self, lines: &SpectralLines) -> Result<Vec<Complex64>, LumpedError> {
        record(&self.chain, &mut self.receptances(), &self.loads, lines)
    }

    /// The recorded accelerances as analytic functions of the complex frequency.
    pub fn continued(&self) -> ContinuedFrfs<'_> {
        let receptances = self.receptances();
        let values = vec![Complex64::ZERO; receptances.count()];
        ContinuedFrfs { test: self, receptances, values, side_by_side: Vec::new() }
    }
}

/// Recorded accelerances continued from the spectral lines, where s = iω, to complex frequencies: there lie a
/// structure's poles, and the residues of the FRFs at them.
#[derive(Debug, Clone)]
pub struct ContinuedFrfs<'a> {
    test: &'a ModelledTest,
    receptances: Receptances<'a>,
    values: Vec<Complex64>,
    /// Receptances at several frequencies, one after another of each.
    side_by_side: Vec<Complex64>,
}

impl ContinuedFrfs<'_> {
    /// Writes all FRFs at complex frequency `s`, rad/s, over `frfs`; `false` where they are not finite, as at
    /// a pole.
    pub fn at(&mut self, s: Complex64, frfs: &mut [Complex64]) -> bool {
        self.receptances.at(s + self.test.chain.decay(), &mut self.values) && self.recorded(s, frfs)
    }

    /// As [`ContinuedFrfs::at`] at several frequencies side by side: all FRFs at the first, then at the
    /// second, …
    pub fn at_each(&mut self, frequencies: &[Complex64], frfs: &mut [Complex64]) -> bool {
        let (count, decay) = (frequencies.len(), self.test.chain.decay());
        let read: Vec<Complex64> = frequencies.iter().map(|s| s + decay).collect();
        self.side_by_side.resize(self.receptances.count() * count, Complex64::ZERO);
        if self.receptances.on_lines(&read, &mut self.side_by_side).is_err() {
            return false;
        }
        frequencies.iter().zip(frfs.chunks_exact_mut(self.test.loads.len())).enumerate().all(
            |(place, (s, frfs))| {
                let receptances = self.side_by_side.chunks_exact(count);
                self.values
                    .iter_mut()
                    .zip(receptances)
                    .for_each(|(value, receptance)| *value = receptance[place]);
                self.recorded(*s, frfs)
            },
        )
    }

    /// What the measuring chain makes of the receptances at `s`.
    fn recorded(&self, s: Complex64, frfs: &mut [Complex64]) -> bool {
        let read = s + self.test.chain.decay();
        let squared = read * read;
        for (index, (frf, reading)) in frfs.iter_mut().zip(&self.test.chain.readings).enumerate() {
            let receptance = match &self.test.loads[index] {
                Some(load) => load.change(read, self.values[index], &self.values),
                None => self.values[index],
            };
            *frf = squared * receptance * reading.gain;
            if reading.delay != 0.0 {
                *frf *= (-s * reading.delay).exp();
            }
            if !reading.filters.is_empty() {
                *frf *= reading.filtered(read);
            }
        }
        frfs.iter().all(|frf| frf.is_finite())
    }
}

/// Stations in use, each once.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stations {
    pub outputs: Vec<Station>,
    pub inputs: Vec<Station>,
}

/// The stations that a chain reads and pushes at, and the (output, input) of each FRF among them.
pub(crate) fn channels(chain: &MeasuringChain) -> (Stations, Vec<(usize, usize)>) {
    let mut stations = Stations::default();
    let of = |reading: &Reading| (stations.output(reading.output), stations.input(reading.input));
    let wanted = chain.readings.iter().map(of).collect();
    (stations, wanted)
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
        station: Station,
        wanted: &mut Vec<(usize, usize)>,
        frf: usize,
    ) -> SensorLoad {
        let (response, reference) = wanted[frf];
        let (sensor_in, sensor_out) = (self.input(station), self.output(station));
        let first = wanted.len();
        wanted.extend([(sensor_out, sensor_in), (response, sensor_in), (sensor_out, reference)]);
        SensorLoad { mass, first }
    }
}

/// A sensor's mass and where its three receptances stand among the wanted ones.
#[derive(Debug, Clone)]
struct SensorLoad {
    mass: f64,
    first: usize,
}

impl SensorLoad {
    /// H_oi − H_os δ H_si / (1 + δ H_ss), δ = s² m.
    #[inline(always)]
    fn change<T: Lines>(&self, s: T, receptance: T, all: &[T]) -> T {
        let inertia = s * s * self.mass;
        let (driving, to_response, from_reference) =
            (all[self.first], all[self.first + 1], all[self.first + 2]);
        let loaded = (T::ONE + inertia * driving).reciprocal();
        receptance - to_response * inertia * from_reference * loaded
    }
}

fn index_in(stations: &mut Vec<Station>, station: Station) -> usize {
    stations.iter().position(|s| *s == station).unwrap_or_else(|| {
        stations.push(station);
        stations.len() - 1
    })
}

/// What the chain makes of the receptances.
fn record(
    chain: &MeasuringChain,
    receptances: &mut Receptances,
    loads: &[Option<SensorLoad>],
    lines: &SpectralLines,
) -> Result<Vec<Complex64>, LumpedError> {
    let omegas = lines.hz().iter().map(|hz| TAU * hz.max(NEARLY_ZERO_HZ));
    let s: Vec<Complex64> = omegas.map(|omega| chain.s(omega)).collect();
    let count = lines.len();
    // Real and imaginary parts apart, as many as fill the last block: the kernel then stores whole blocks,
    // and nothing else in it is done line by line.
    let padded = count.next_multiple_of(WIDTH);
    let mut parts = [vec![0.0; loads.len() * padded], vec![0.0; loads.len() * padded]];
    let [re, im] = &mut parts;
    let recorded = receptances.in_blocks(
        &s,
        #[inline(always)]
        |first, s, block| {
            let squared = s * s;
            let frfs = re.chunks_exact_mut(padded).zip(im.chunks_exact_mut(padded));
            for (index, ((re, im), reading)) in frfs.zip(&chain.readings).enumerate() {
                let receptance = match &loads[index] {
                    Some(load) => load.change(s, block[index], block),
                    None => block[index],
                };
                let value = squared * receptance * reading.gain;
                value.write_parts(&mut re[first..first + WIDTH], &mut im[first..first + WIDTH]);
            }
        },
    );
    recorded.map_err(|line| LumpedError::Unbounded { frequency: lines.hz()[line] })?;
    let mut values = Vec::with_capacity(loads.len() * count);
    for (re, im) in parts[0].chunks_exact(padded).zip(parts[1].chunks_exact(padded)) {
        values.extend(re.iter().zip(im).take(count).map(|(re, im)| Complex64::new(*re, *im)));
    }
    for (frf, reading) in values.chunks_exact_mut(count).zip(&chain.readings).filter(|(_, r)| r.delay != 0.0)
    {
        for (value, s) in frf.iter_mut().zip(&s) {
            *value *= Complex64::cis(-s.im * reading.delay);
        }
    }
    for (frf, reading) in
        values.chunks_exact_mut(count).zip(&chain.readings).filter(|(_, r)| !r.filters.is_empty())
    {
        frf.iter_mut().zip(&s).for_each(|(value, s)| *value *= reading.filtered(*s));
    }
    Ok(values)
}
