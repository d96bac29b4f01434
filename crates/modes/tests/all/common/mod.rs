//! FRFs with known poles and noise, made without the crate under test.

pub(crate) mod bound;

use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::TAU;

/// A mode: natural frequency (Hz), damping ratio, mass-normalised shape over the points.
#[derive(Debug, Clone)]
pub(crate) struct TrueMode {
    pub frequency: f64,
    pub ratio: f64,
    pub shape: Vec<f64>,
}

pub(crate) fn mode(frequency: f64, ratio: f64, shape: &[f64]) -> TrueMode {
    TrueMode { frequency, ratio, shape: shape.to_vec() }
}

/// Accelerances of modes and of rigid motions 1/mass, FRF after FRF; points are named 1, 2, ….
pub(crate) fn accelerances(
    modes: &[TrueMode],
    mass: f64,
    pairs: &[(usize, usize)],
    lines: &SpectralLines,
) -> Vec<Complex64> {
    let mut values = Vec::new();
    for &(o, i) in pairs {
        for omega in lines.omegas() {
            let s = Complex64::new(0.0, omega);
            let mut sum = Complex64::from(1.0 / mass);
            for mode in modes {
                let natural = TAU * mode.frequency;
                let denominator = s * s + 2.0 * mode.ratio * natural * s + natural * natural;
                sum += s * s * mode.shape[o - 1] * mode.shape[i - 1] / denominator;
            }
            values.push(sum);
        }
    }
    values
}

/// Independent circular noise: a floor and a share of each value; the set carries its variances.
pub(crate) fn noisy(
    clean: &[Complex64],
    pairs: &[(usize, usize)],
    lines: &SpectralLines,
    floor: f64,
    share: f64,
    seed: u64,
) -> FrfSet {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let variance: Vec<f64> = clean.iter().map(|v| floor * floor + share * share * v.norm_sqr()).collect();
    let values = clean.iter().zip(&variance).map(|(v, s)| v + s.sqrt() * normal(&mut random)).collect();
    let pairs = pairs.iter().map(|(o, i)| FrfPair::transverse(&o.to_string(), &i.to_string())).collect();
    FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs, values).unwrap().with_variance(variance).unwrap()
}

/// A complex normal of variance one.
pub(crate) fn normal(random: &mut ChaCha8Rng) -> Complex64 {
    let (u, v): (f64, f64) = (random.random(), random.random());
    Complex64::from_polar((-(1.0 - u).ln()).sqrt(), TAU * v)
}

/// The same FRFs, of whose noise nothing is said.
pub(crate) fn without_variances(set: &FrfSet) -> FrfSet {
    FrfSet::new(set.lines().clone(), set.form(), set.pairs().to_vec(), set.all_values().to_vec()).unwrap()
}
