//! A recording without the sensor that loads the structure while it is taken.
//!
//! Where a sensor of mass m sits at the response, the recorded accelerance is H/(1 + m·A), A being the
//! structure's own accelerance at that point. A is the model's with its poles where the recording has them:
//! at s = iω it is taken at iω·ω_m/ω_r + (ζ_r − ζ_m)·ω_m, which is as far from the model's pole (m) as s is
//! from the recorded one (r), in units of either's frequency; between modes both go on smoothly. The model's
//! shapes are a little wrong at the sensor, so A counts as much as the recorded pole is lower there than the
//! structure's: else a pole would be left beside it. Under an exponential window FRFs are taken at s = decay + iω,
//! A too.

use super::by_response::loads;
use crate::drift::distinct;
use crate::settings::moved_sensor::SHAPES;
use crate::{Hypothesis, Observation};
use jointscope_fixture::Effect;
use jointscope_lumped::{Instrument, ModelledTest, window_decay};
use jointscope_spectra::{Channel, FrfPair};
use num_complex::Complex64;

/// A value given at ascending abscissae, straight between them and constant beyond.
fn between(known: &[(f64, f64)], at: f64) -> f64 {
    let above = known.partition_point(|(x, _)| *x < at);
    match (above.checked_sub(1).and_then(|below| known.get(below)), known.get(above)) {
        (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (at - x0) / (x1 - x0),
        (Some((_, y)), None) | (None, Some((_, y))) => *y,
        (None, None) => 0.0,
    }
}

/// What sensors do to a mode at one response, beside what they do to it by the model's shape there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    /// ln ω of the mode without the sensors.
    ln_omega: f64,
    /// The share of that which they do.
    share: f64,
    /// Its standard deviation.
    std: f64,
    /// Half-power bandwidth of the mode, rad/s.
    width: f64,
}

impl Share {
    /// Where no mode tells.
    const OF_MODEL: Share = Share { ln_omega: 0.0, share: 1.0, std: SHAPES, width: 0.0 };

    /// Of a mode with this ln ω and damping ratio.
    pub(super) fn of(ln_omega: f64, [share, std]: [f64; 2], ratio: f64) -> Self {
        Share { ln_omega, share, std, width: 2.0 * ratio * ln_omega.exp() }
    }
}

/// Sensors that load a structure while it is recorded, and how it moves without them.
#[derive(Debug, Clone)]
pub(crate) struct Load {
    /// The sensors: where they sit, and their masses.
    pub(crate) sensors: Vec<Effect>,
    /// The structure without them.
    pub(super) model: Hypothesis,
    /// Of each mode: natural frequency of the model, rad/s, ln ω of the structure without the sensors less
    /// that, and the difference of the damping ratios.
    pub(super) off: Vec<[f64; 3]>,
    /// Of each response, mode by mode: the share of what the sensors do by the model's shape there that they do.
    pub(super) shares: Vec<(Channel, Vec<Share>)>,
}

impl Load {
    /// The accelerance of the structure where a response is read, on all lines.
    fn accelerance(&self, observation: &Observation, response: &Channel) -> Option<Vec<Complex64>> {
        let hz = observation.lines().hz();
        let driven = FrfPair::new(response.clone(), response.clone());
        let fixture = self.model.to_fixture().ok()?;
        let test = ModelledTest::new(&fixture, &[driven], *hz.last()?, Instrument::Perfect).ok()?;
        let window = window_decay(&fixture);
        let mut frfs = test.continued();
        let mut off = self.off.clone();
        off.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let along = |which: usize| -> Vec<(f64, f64)> {
            off.iter().map(|mode| (mode[0].ln() + mode[1], mode[which])).collect()
        };
        let (frequency, damping) = (along(1), along(2));
        let mut value = [Complex64::ZERO];
        let mut at = |omega: f64| {
            let own = omega * (-between(&frequency, omega.ln())).exp();
            let s = Complex64::new(window + between(&damping, omega.ln()) * own, own);
            frfs.at(s, &mut value).then_some(value[0])
        };
        observation.lines().omegas().map(&mut at).collect()
    }

    /// What is known of the shares of a response, by ln ω; of one that shows no mode, what the model says.
    fn along(&self, response: &Channel, of: fn(&Share) -> f64) -> Vec<(f64, f64)> {
        let own = self.shares.iter().find(|(other, modes)| other == response && !modes.is_empty());
        let modes = own.map_or(&[Share::OF_MODEL][..], |(_, modes)| modes);
        let mut known: Vec<(f64, f64)> = modes.iter().map(|own| (own.ln_omega, of(own))).collect();
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        known
    }

    /// The recording as it would be without the sensors; `None` where the model has no finite FRFs.
    ///
    /// What the shares are not known to is in all lines of a resonance and in all FRFs of a response alike: as
    /// noise of each value by itself it counts so many times more.
    pub(crate) fn taken_off(&self, observation: &Observation) -> Option<Observation> {
        let lines = observation.lines();
        let spacing = lines.omegas().nth(1)? - lines.omegas().next()?;
        let mut factors = vec![Complex64::ONE; observation.values().len()];
        let mut variances = vec![0.0; factors.len()];
        for response in &distinct(observation.pairs().iter().map(|pair| &pair.response)) {
            let own = self.sensors.iter().filter(|sensor| loads(&sensor.place, response));
            let mass: f64 = own.map(|sensor| sensor.value(0)).sum();
            if mass == 0.0 {
                continue;
            }
            let shares = self.along(response, |own| own.share);
            let deviations = self.along(response, |own| own.std);
            let widths = self.along(response, |own| own.width);
            let frfs = observation.pairs().iter().enumerate().filter(|(_, pair)| pair.response == *response);
            let frfs: Vec<usize> = frfs.map(|(index, _)| index).collect();
            let accelerances = self.accelerance(observation, response)?;
            for ((line, accelerance), omega) in accelerances.iter().enumerate().zip(lines.omegas()) {
                let load = mass * accelerance;
                let [share, std, width] =
                    [&shares, &deviations, &widths].map(|known| between(known, omega.ln()));
                let times = (width / spacing).max(1.0) * frfs.len() as f64;
                for at in frfs.iter().map(|frf| frf * lines.len() + line) {
                    factors[at] += share * load;
                    variances[at] = times * (std * load * observation.values()[at]).norm_sqr();
                }
            }
        }
        Some(observation.times(&factors)?.with_variance_added(&variances))
    }
}
