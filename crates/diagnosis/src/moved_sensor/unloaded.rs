//! A recording without the sensor that loads the structure while it is taken.
//!
//! Where a sensor of mass m sits at the response, the recorded accelerance is H/(1 + m·A), A being the
//! structure's own accelerance at that point. A is the model's with its poles where the recording has them:
//! at s = iω it is taken at iω·ω_m/ω_r + (ζ_r − ζ_m)·ω_m, which is as far from the model's pole (m) as s is
//! from the recorded one (r), in units of either's frequency; between modes both go on smoothly.

use super::by_response::loads;
use super::told::MovedSensor;
use crate::Observation;
use jointscope_lumped::{Instrument, ModelledTest};
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

impl MovedSensor {
    /// The accelerance of the structure where a response is read, on all lines.
    fn accelerance(&self, observation: &Observation, response: &Channel) -> Option<Vec<Complex64>> {
        let hz = observation.lines().hz();
        let driven = FrfPair::new(response.clone(), response.clone());
        let fixture = self.model.to_fixture().ok()?;
        let test = ModelledTest::new(&fixture, &[driven], *hz.last()?, Instrument::Perfect).ok()?;
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
            let s = Complex64::new(between(&damping, omega.ln()) * own, own);
            frfs.at(s, &mut value).then_some(value[0])
        };
        observation.lines().omegas().map(&mut at).collect()
    }

    /// The recording as it would be without the sensor; `None` where the model has no finite FRFs.
    pub(crate) fn taken_off(&self, observation: &Observation) -> Option<Observation> {
        let mass = self.effect.value(0);
        let mut factors = Vec::with_capacity(observation.values().len());
        for pair in observation.pairs() {
            match loads(&self.effect.place, &pair.response) {
                true => factors
                    .extend(self.accelerance(observation, &pair.response)?.iter().map(|a| 1.0 + mass * a)),
                false => factors.extend(vec![Complex64::ONE; observation.lines().len()]),
            }
        }
        observation.times(&factors)
    }
}
