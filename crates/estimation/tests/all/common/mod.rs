//! A structure that answers exactly as its poles say, and hammer tests on it.

use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_spectra::Channel;
use num_complex::Complex64;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Sampling interval, s.
pub(crate) const INTERVAL: f64 = 1.0 / 2048.0;

/// A sampled structure of two modes and a direct part, y[n] = d·x[n] + Σ 2 Re Σ_k a p^k x[n − k]: its FRF at
/// any s is known in closed form.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Structure {
    /// Frequency in Hz, decay σ in 1/s and residue of each mode.
    pub modes: [(f64, f64, f64); 2],
    pub direct: f64,
}

pub(crate) const TWO_MODES: Structure =
    Structure { modes: [(87.3, 9.0, 0.11), (311.7, 14.0, -0.07)], direct: 0.4 };

impl Structure {
    fn poles(&self) -> [(Complex64, f64); 2] {
        self.modes.map(|(f, sigma, a)| {
            (Complex64::new(-sigma * INTERVAL, std::f64::consts::TAU * f * INTERVAL).exp(), a)
        })
    }

    /// The FRF at s = decay + iω.
    pub(crate) fn frf(&self, decay: f64, hz: f64) -> Complex64 {
        let delay = (-Complex64::new(decay, std::f64::consts::TAU * hz) * INTERVAL).exp();
        let mode = |(pole, a): (Complex64, f64)| {
            a / Complex64::I / (1.0 - pole * delay) - a / Complex64::I / (1.0 - pole.conj() * delay)
        };
        self.poles().map(mode).iter().sum::<Complex64>() + self.direct
    }

    /// The response to a force, from rest.
    pub(crate) fn answer(&self, force: &[f64]) -> Vec<f64> {
        let mut state = [Complex64::ZERO; 2];
        let poles = self.poles();
        let step = |x: &f64| {
            let mut y = self.direct * x;
            for (state, (pole, a)) in state.iter_mut().zip(poles) {
                *state = *state * pole + x;
                y += 2.0 * a * state.im;
            }
            y
        };
        force.iter().map(step).collect()
    }
}

/// How a test is carried out.
#[derive(Debug, Clone)]
pub(crate) struct Test {
    pub structure: Structure,
    pub samples: usize,
    /// Peak force of every hit, N.
    pub strengths: Vec<f64>,
    /// Standard deviation of the response's noise, m/s², of every hit.
    pub response_noise: Vec<f64>,
    /// Standard deviation of the force's noise, N, of every hit.
    pub force_noise: Vec<f64>,
    pub seed: u64,
}

impl Test {
    /// Hits of 100 N without noise.
    pub(crate) fn quiet(hits: usize, samples: usize) -> Self {
        Test {
            structure: TWO_MODES,
            samples,
            strengths: vec![100.0; hits],
            response_noise: vec![0.0; hits],
            force_noise: vec![0.0; hits],
            seed: 1,
        }
    }

    pub(crate) fn hits(&self) -> Vec<Hit> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        (0..self.strengths.len())
            .map(|k| {
                let clean = pulse(self.samples, 80, 4, self.strengths[k]);
                let answer = self.structure.answer(&clean);
                let noisy = |values: &[f64], std: f64, random: &mut ChaCha8Rng| {
                    values.iter().map(|v| v + std * normal(random)).collect::<Vec<f64>>()
                };
                let force = noisy(&clean, self.force_noise[k], &mut random);
                let response = noisy(&answer, self.response_noise[k], &mut random);
                hit(k as u32 + 1, force, response)
            })
            .collect()
    }
}

/// A hit at 1 with the acceleration at 4.
pub(crate) fn hit(number: u32, force: Vec<f64>, response: Vec<f64>) -> Hit {
    let response = Response::new(Channel::transverse("4"), MeasuredMotion::Acceleration, response);
    Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), force, vec![response]).unwrap()
}

/// Half a sine of so many samples.
pub(crate) fn pulse(samples: usize, at: usize, width: usize, peak: f64) -> Vec<f64> {
    let value = |i: usize| match i.checked_sub(at) {
        Some(i) if i < width => peak * (std::f64::consts::PI * (i as f64 + 0.5) / width as f64).sin(),
        _ => 0.0,
    };
    (0..samples).map(value).collect()
}

/// A standard normal (Box–Muller).
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
    (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos()
}
