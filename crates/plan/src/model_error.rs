//! What an error of the model itself leaves of a measurement.
//!
//! Where no fixture is right to the noise, names are weighed with an error of the model: of natural
//! frequencies, damping ratios and residues. Between lines such an error is not independent: of one FRF it
//! has three values a mode, not two a line. So it counts as noise so many times larger that all lines
//! together tell no more than those values would.

use crate::settings::noise::VALUES_OF_A_MODE;
use jointscope_diagnosis::{Hypothesis, ModelError, Observation};
use jointscope_lumped::{Assembly, Instrument, accelerances};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;

/// Relative errors of a model, and how many times the lines of an FRF are more than the values that these
/// move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ModelErrorNoise {
    frequency: f64,
    /// Of damping ratios and residues together.
    size: f64,
    times: f64,
}

impl ModelErrorNoise {
    /// That of a model which an observation was compared with by modes.
    pub(crate) fn of(error: &ModelError, model: &Hypothesis, observation: &Observation) -> Self {
        let hz = observation.lines().hz();
        let (first, last) = (hz[0], hz[hz.len() - 1]);
        let within = |assembly: &Assembly| {
            assembly.natural_frequencies_hz().iter().filter(|f| (first..=last).contains(*f)).count()
        };
        let assembly = model.to_fixture().ok().and_then(|fixture| Assembly::new(&fixture, last).ok());
        let modes = assembly.map_or(1, |assembly| within(&assembly).max(1));
        let times = 2.0 * hz.len() as f64 / (VALUES_OF_A_MODE * modes as f64);
        ModelErrorNoise {
            frequency: error.frequency,
            size: error.damping.hypot(error.residue),
            times: times.max(1.0),
        }
    }

    /// What it adds to the variances of FRFs as `model` predicts them; `None` where it predicts none.
    pub(crate) fn variance(
        &self,
        model: &Hypothesis,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        values: &[Complex64],
    ) -> Option<Vec<f64>> {
        let moved = lines.hz().iter().map(|hz| hz * (1.0 + self.frequency)).collect();
        let fixture = model.to_fixture().ok()?;
        let moved =
            accelerances(&fixture, pairs, &SpectralLines::new(moved).ok()?, Instrument::AsRecorded).ok()?;
        let of = |(here, there): (&Complex64, &Complex64)| {
            self.times * ((there - here).norm_sqr() + self.size * self.size * here.norm_sqr())
        };
        Some(values.iter().zip(&moved).map(of).collect())
    }

    /// An observation with that in its noise.
    pub(crate) fn with_model_error(
        &self,
        model: &Hypothesis,
        observation: &Observation,
    ) -> Option<Observation> {
        let predicted = model.predict(observation).ok()?;
        let more = self.variance(model, observation.pairs(), observation.lines(), &predicted)?;
        // What has no weight has no coherence, and is no value.
        let large = observation.values().iter().map(|v| v.norm_sqr()).fold(0.0, f64::max) * 1e12;
        let variance = observation.weights().iter().zip(&more).map(|(weight, more)| match *weight > 0.0 {
            true => 2.0 / weight + more,
            false => large,
        });
        let frfs = observation.frfs().clone().with_variance(variance.collect()).ok()?;
        Observation::new(&frfs, |_| true).ok()
    }
}
