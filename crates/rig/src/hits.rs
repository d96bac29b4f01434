//! A hammer test: hits of varying strength, noise on both channels, H1 and coherence.

use crate::HammerError;
use crate::random::{normal, normal_pair};
use jointscope_spectra::{FrfForm, FrfSet, SpectralLines};
use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// How the hammer strikes and how noisy the channels are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HammerSetup {
    /// Hits averaged for an FRF, at least 2.
    pub averages: u32,
    /// Noise of the response channel: white in acceleration, relative to the rms of the acceleration over the
    /// lines.
    pub noise_response: f64,
    /// Noise of the force channel: white, relative to the rms of the force over the lines.
    pub noise_force: f64,
    /// Frequency in Hz at which the hit's force has fallen to about 70 %.
    pub corner: f64,
    /// Standard deviation of the hits' strength, relative.
    pub spread: f64,
    /// Whether all responses to a reference are recorded in the same hits, so that they share the noise of
    /// the force; otherwise every FRF has hits of its own (a roving hammer or sensor).
    pub common_hits: bool,
    /// Seed of strengths and noise; in files a text, for it has more digits than their numbers.
    #[serde(with = "as_text")]
    pub seed: u64,
}

mod as_text {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub(super) fn serialize<S: Serializer>(seed: &u64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(seed)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}

/// Noise of the force channel as a share of that of the responses, both relative to what their channel reads.
const NOISE_OF_FORCE: f64 = 0.1;

impl HammerSetup {
    /// A hammer test as those of the concealed cases are: `noise` on the responses and a tenth of it on the
    /// force, each relative to the channel's rms, white over the lines; blows whose force has fallen to about
    /// 70 % at `highest_hz` and whose strength scatters by a quarter; hits of its own for every FRF.
    pub fn ordinary(noise: f64, averages: u32, highest_hz: f64, seed: u64) -> Self {
        HammerSetup {
            averages,
            noise_response: noise,
            noise_force: NOISE_OF_FORCE * noise,
            corner: highest_hz.max(f64::MIN_POSITIVE),
            spread: 0.25,
            common_hits: false,
            seed,
        }
    }

    /// Measures noise-free FRFs: H1 = S_xf/S_ff over the hits, with coherence and the number of averages, as
    /// accelerance.
    ///
    /// # Errors
    /// A setting that no hammer test has.
    pub fn measure(&self, truth: &FrfSet) -> Result<FrfSet, HammerError> {
        self.check()?;
        let truth = truth.to_form(FrfForm::Accelerance)?;
        let lines = truth.lines();
        let pulse: Vec<f64> = lines.hz().iter().map(|&f| half_sine_spectrum(f / self.corner)).collect();
        let mut values = Vec::with_capacity(truth.all_values().len());
        let mut coherences = Vec::with_capacity(truth.pairs().len());
        for (index, pair) in truth.pairs().iter().enumerate() {
            // Hits are numbered by what they belong to: the FRF, or its reference alone.
            let first_of_reference =
                truth.pairs().iter().position(|p| p.reference == pair.reference).unwrap_or(index);
            let hits = if self.common_hits { first_of_reference } else { index };
            let strikes = self.strikes(hits as u64, &pulse, lines);
            let mut noise = self.generator(2 * index as u64 + 1);
            let (h1, coherence) = self.average(truth.values(index), &pulse, &strikes, &mut noise);
            values.extend(h1);
            coherences.push(coherence);
        }
        let mut measured = FrfSet::new(lines.clone(), FrfForm::Accelerance, truth.pairs().to_vec(), values)?;
        for (index, coherence) in coherences.into_iter().enumerate() {
            measured.set_coherence(index, coherence)?;
            measured.set_averages(index, Some(self.averages));
        }
        Ok(measured)
    }

    fn check(&self) -> Result<(), HammerError> {
        if self.averages < 2 {
            return Err(HammerError::TooFewAverages(self.averages));
        }
        let settings = [
            ("a response noise", self.noise_response),
            ("a force noise", self.noise_force),
            ("a spread of the hits", self.spread),
        ];
        let corner = if self.corner > 0.0 { self.corner } else { f64::NAN };
        for (what, value) in settings.into_iter().chain([("a corner frequency", corner)]) {
            if !value.is_finite() || value < 0.0 {
                return Err(HammerError::Impossible { what, value });
            }
        }
        Ok(())
    }

    fn generator(&self, stream: u64) -> ChaCha8Rng {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator.set_stream(stream);
        generator
    }

    /// Strength and recorded force spectrum of every hit.
    fn strikes(&self, hits: u64, pulse: &[f64], lines: &SpectralLines) -> Vec<(f64, Vec<Complex64>)> {
        let mut generator = self.generator(2 * hits);
        let floor = self.noise_force * rms(pulse.iter().map(|p| p * p));
        (0..self.averages)
            .map(|_| {
                // A hit is never negligible: the operator repeats those.
                let strength = (1.0 + self.spread * normal(&mut generator)).max(0.2);
                let recorded = (0..lines.len())
                    .map(|line| strength * pulse[line] + floor * circular_noise(&mut generator))
                    .collect();
                (strength, recorded)
            })
            .collect()
    }

    fn average(
        &self,
        truth: &[Complex64],
        pulse: &[f64],
        strikes: &[(f64, Vec<Complex64>)],
        noise: &mut ChaCha8Rng,
    ) -> (Vec<Complex64>, Vec<f64>) {
        let floor = self.noise_response * rms(truth.iter().zip(pulse).map(|(h, p)| h.norm_sqr() * p * p));
        let mut cross = vec![Complex64::ZERO; truth.len()];
        let mut force = vec![0.0; truth.len()];
        let mut response = vec![0.0; truth.len()];
        for (strength, recorded) in strikes {
            for line in 0..truth.len() {
                let x = truth[line] * (strength * pulse[line]) + floor * circular_noise(noise);
                let f = recorded[line];
                cross[line] += x * f.conj();
                force[line] += f.norm_sqr();
                response[line] += x.norm_sqr();
            }
        }
        let coherence = (0..truth.len())
            .map(|i| {
                let product = force[i] * response[i];
                if product > 0.0 { (cross[i].norm_sqr() / product).min(1.0) } else { 0.0 }
            })
            .collect();
        let h1 =
            cross.iter().zip(&force).map(|(x, f)| if *f > 0.0 { x / f } else { Complex64::ZERO }).collect();
        (h1, coherence)
    }
}

/// Magnitude of a half-sine pulse's spectrum relative to 0 Hz, at `ratio` times the frequency at which it has
/// fallen to 70 %: |cos(π·a)/(1 − 4a²)|, a = 0.595·ratio being frequency times pulse length.
///
/// Past its first zero a real pulse, which is never quite a half sine, keeps some force.
fn half_sine_spectrum(ratio: f64) -> f64 {
    let a = 0.595 * ratio;
    let denominator = 1.0 - 4.0 * a * a;
    // The removable singularity at a = 1/2.
    let ideal = if denominator.abs() < 1e-6 {
        std::f64::consts::FRAC_PI_4
    } else {
        ((std::f64::consts::PI * a).cos() / denominator).abs()
    };
    ideal.max(0.03)
}

/// Complex noise of unit mean square.
fn circular_noise(generator: &mut ChaCha8Rng) -> Complex64 {
    let (re, im) = normal_pair(generator);
    Complex64::new(re, im) * std::f64::consts::FRAC_1_SQRT_2
}

fn rms(squares: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = squares.len().max(1) as f64;
    (squares.sum::<f64>() / count).sqrt()
}

/// Variance E|ε|² of the complex values of FRF `index`, from coherence and averages: (1 − γ²)/((n −
/// 1)γ²)·|H|², averaged over `2·half_width + 1` neighbouring lines; `None` where coherence or averages are
/// missing.
///
/// Line by line the estimate has few degrees of freedom, and weights drawn from it would favour the lines
/// whose noise happens to look small.
pub fn smoothed_variance(set: &FrfSet, index: usize, half_width: usize) -> Option<Vec<f64>> {
    let (coherence, averages) = (set.coherence(index)?, set.averages(index)?);
    if averages < 2 {
        return None;
    }
    let raw: Vec<f64> = set
        .values(index)
        .iter()
        .zip(coherence)
        .map(|(h, &g)| (1.0 - g).max(0.0) / (f64::from(averages - 1) * g.max(1e-12)) * h.norm_sqr())
        .collect();
    let smoothed = (0..raw.len()).map(|i| {
        let window = &raw[i.saturating_sub(half_width)..(i + half_width + 1).min(raw.len())];
        window.iter().sum::<f64>() / window.len() as f64
    });
    Some(smoothed.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pulse_has_fallen_to_seventy_per_cent_at_its_corner() {
        assert!((half_sine_spectrum(1.0) - 0.707).abs() < 0.01, "{}", half_sine_spectrum(1.0));
        assert!((half_sine_spectrum(0.0) - 1.0).abs() < 1e-12);
        let (below, at) = (half_sine_spectrum(0.5 / 0.595 - 1e-5), half_sine_spectrum(0.5 / 0.595));
        assert!((below - at).abs() < 1e-4, "{below} beside {at}");
    }
}
