//! Fixtures, recordings of them with noise, and recordings compared with models.

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_model_error::{
    ErrorSizes, Expected, ModelledModes, Pairing, RecordedModes, Shapes, SharedFeatures, WeightedFrfs,
};
use jointscope_modes::ModesOptions;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::TAU;

/// Masses of 2 kg and 3 kg on a spring of 5 MN/m, with modal damping.
pub(crate) fn two_masses(damping_ratio: f64, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
          "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
          "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] }} }},
          "damping": {{ "modal_ratios": [{damping_ratio}] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

/// Two rigid blocks of about a kilogram on a steel beam of 65 mm (EI = 76 N·m²): modes at 247 Hz and 908 Hz.
pub(crate) fn blocks(physics: &str) -> Fixture {
    blocks_with_sensor_at(0.125, physics)
}

/// The same with point 4 at another abscissa, m.
pub(crate) fn blocks_with_sensor_at(x: f64, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }},
                           "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 }} }},
          "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }},
                       "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": {x} }} }},
          "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
          "damping": {{ "modal_ratios": [0.004, 0.006] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

/// Blocks on soft supports: two modes at 2.4 Hz and 3.2 Hz.
pub(crate) fn suspended() -> Fixture {
    suspended_by("1.0")
}

/// The same on dashpots of so many N·s/m.
pub(crate) fn suspended_by(dashpot: &str) -> Fixture {
    let fixture = r#"{ "bodies": { "A": { "mass": 2.1, "inertia": 1.9e-3, "x_cg": -0.03 },
                           "B": { "mass": 2.3, "inertia": 2.1e-3, "x_cg": 0.095 } },
          "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 },
                       "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.09 } },
          "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
          "supports": { "left": { "point": "1", "stiffness": 605.6, "damping": 1.0 }, "right": { "point": "4", "stiffness": 626.0, "damping": 1.0 } },
          "damping": { "modal_ratios": [0.004, 0.006] } }"#;
    Fixture::from_json(&fixture.replace("\"damping\": 1.0", &format!("\"damping\": {dashpot}"))).unwrap()
}

/// `count` masses of one kilogram in a row on springs of 5 MN/m: `count` − 1 elastic modes below 712 Hz.
pub(crate) fn chain(count: usize) -> Fixture {
    let list = |of: &dyn Fn(usize) -> String, n: usize| (1..=n).map(of).collect::<Vec<_>>().join(", ");
    let bodies = list(&|k| format!(r#""B{k}": {{ "mass": 1.0, "rotates": false }}"#), count);
    let points = list(&|k| format!(r#""{k}": {{ "body": "B{k}", "x": {k} }}"#), count);
    let joint = |k: usize| {
        let next = k + 1;
        format!(r#""J{k}": {{ "from": "{k}", "to": "{next}", "stiffness": [[5e6, 0], [0, 0]] }}"#)
    };
    let joints = list(&joint, count - 1);
    let ratios = vec!["0.004"; count - 1].join(", ");
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ {bodies} }}, "points": {{ {points} }}, "joints": {{ {joints} }}, "damping": {{ "modal_ratios": [{ratios}] }} }}"#
    ))
    .unwrap()
}

/// Transverse FRFs by their points, response first.
pub(crate) fn pairs(names: &[(&str, &str)]) -> Vec<FrfPair> {
    names.iter().map(|(response, reference)| FrfPair::transverse(response, reference)).collect()
}

/// The FRFs of the blocks: responses 4 and 3, references 1 and 2.
pub(crate) fn four() -> Vec<FrfPair> {
    pairs(&[("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")])
}

/// Spectral lines 2.5 Hz apart from 20 Hz to `to`.
pub(crate) fn lines(to: f64) -> SpectralLines {
    SpectralLines::even(20.0, 2.5, ((to - 20.0) / 2.5) as usize + 1).unwrap()
}

/// Noise of each FRF value: a floor, (m/s²)/N, and a share of the value.
#[derive(Clone, Copy)]
pub(crate) struct Noise {
    pub floor: f64,
    pub share: f64,
    /// None: the recording states the noise's variance and has none.
    pub seed: Option<u64>,
}

/// 0.25 % and a floor of 10⁻³ (m/s²)/N.
pub(crate) fn noise(seed: Option<u64>) -> Noise {
    Noise { floor: 1e-3, share: 0.0025, seed }
}

/// A recording with the weight of each value.
pub(crate) struct Recorded {
    pub set: FrfSet,
    pub weights: Vec<f64>,
}

impl Recorded {
    pub(crate) fn of(fixture: &Fixture, pairs: &[FrfPair], lines: &SpectralLines, noise: Noise) -> Self {
        let clean = synthesize(fixture, pairs, lines, Instrument::AsRecorded).unwrap();
        let variance = |v: &Complex64| noise.floor.powi(2) + noise.share.powi(2) * v.norm_sqr();
        let variances: Vec<f64> = clean.all_values().iter().map(variance).collect();
        let mut values = clean.all_values().to_vec();
        if let Some(seed) = noise.seed {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            values.iter_mut().zip(&variances).for_each(|(v, s)| *v += s.sqrt() * circular(&mut random));
        }
        // Half of the variance of a complex value is that of its real part.
        let weights = variances.iter().map(|v| 2.0 / v).collect();
        let set = FrfSet::new(lines.clone(), clean.form(), pairs.to_vec(), values).unwrap();
        Recorded { set: set.with_variance(variances).unwrap(), weights }
    }

    /// The same recording with weights and variances as if the noise were `times` as large.
    pub(crate) fn with_noise_stated_as(self, times: f64) -> Self {
        let frfs = 0..self.set.pairs().len();
        let variances =
            frfs.flat_map(|frf| self.set.variance(frf).unwrap()).map(|v| v * times * times).collect();
        let weights = self.weights.iter().map(|w| w / (times * times)).collect();
        Recorded { set: self.set.with_variance(variances).unwrap(), weights }
    }

    pub(crate) fn modes(&self) -> RecordedModes {
        let recording = WeightedFrfs { frfs: &self.set, weights: &self.weights };
        RecordedModes::of(recording, &ModesOptions::default(), |_| Expected::default()).unwrap()
    }
}

/// A complex normal of variance one.
pub(crate) fn circular(random: &mut ChaCha8Rng) -> Complex64 {
    let (u, v): (f64, f64) = (random.random(), random.random());
    Complex64::from_polar((-(1.0 - u).ln()).sqrt(), TAU * v)
}

/// A real normal of variance one.
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    circular(random).re * 2f64.sqrt()
}

/// A model without errors.
pub(crate) fn no_error() -> ErrorSizes {
    ErrorSizes::from_array([0.0; 8])
}

fn both_triangles(comparison: &SharedFeatures, sizes: &ErrorSizes) -> Vec<f64> {
    let (n, mut whole) = (comparison.count(), comparison.covariance(sizes));
    for i in 0..n {
        (0..i).for_each(|j| whole[j * n + i] = whole[i * n + j]);
    }
    whole
}

/// A recording's modes compared with those of a model.
pub(crate) struct Compared {
    pub recorded: RecordedModes,
    pub modelled: ModelledModes,
    pub pairing: Pairing,
    pub comparison: SharedFeatures,
}

impl Compared {
    pub(crate) fn of(fixture: &Fixture, recorded: RecordedModes) -> Self {
        let modelled = modelled(fixture, &recorded);
        let pairing = Pairing::of(&recorded, &modelled);
        let shapes = Shapes::of(fixture, &recorded, &modelled.poles()).unwrap();
        let comparison = SharedFeatures::new(&recorded, &pairing, &modelled, &shapes);
        Compared { recorded, modelled, pairing, comparison }
    }

    /// Recorded less modelled features.
    pub(crate) fn difference(&self) -> Vec<f64> {
        self.comparison.residual(&self.recorded, &self.recorded.features(), &self.modelled, &self.pairing)
    }

    /// The model's features alone.
    pub(crate) fn model(&self) -> Vec<f64> {
        let nothing = vec![0.0; self.recorded.count()];
        let negative = self.comparison.residual(&self.recorded, &nothing, &self.modelled, &self.pairing);
        negative.into_iter().map(|f| -f).collect()
    }

    /// Covariance of the features of a model whose error has these sizes, both triangles.
    pub(crate) fn covariance(&self, sizes: &ErrorSizes) -> Vec<f64> {
        both_triangles(&self.comparison, sizes)
    }

    /// Covariance of the recorded features.
    pub(crate) fn noise(&self) -> Vec<f64> {
        both_triangles(&self.comparison.clone().with_damping_as_modelled(), &no_error())
    }

    /// What each compared feature is: its kind, and its name for messages.
    pub(crate) fn names(&self) -> Vec<(&'static str, String)> {
        let mut names = Vec::new();
        let hz = |r: usize| self.recorded.modes[r].pole.omega / TAU;
        for &(r, _) in &self.pairing.pairs {
            names.push(("frequency", format!("ln f of the mode at {:.1} Hz", hz(r))));
            names.push(("damping", format!("ln ζ of the mode at {:.1} Hz", hz(r))));
        }
        for &(r, _) in &self.pairing.pairs {
            for frf in 0..self.recorded.frfs() {
                for part in ["real", "imaginary"] {
                    names.push(("residue", format!("{part} residue of FRF {frf} at {:.1} Hz", hz(r))));
                }
            }
        }
        for frf in 0..self.recorded.frfs() {
            names.push(("mass line", format!("mass line of FRF {frf}")));
            names.push(("upper residual", format!("upper residual of FRF {frf}")));
        }
        names
    }

    /// Each difference over its standard deviation.
    pub(crate) fn normalised(&self) -> Vec<f64> {
        let (n, noise) = (self.comparison.count(), self.noise());
        self.difference().iter().enumerate().map(|(k, d)| d / noise[k * (n + 1)].sqrt()).collect()
    }
}

pub(crate) fn modelled(fixture: &Fixture, recorded: &RecordedModes) -> ModelledModes {
    ModelledModes::of(fixture, recorded).unwrap()
}

/// χ² = dᵀS⁻¹d and ln det S by Gaussian elimination of the dense matrix.
pub(crate) fn chi2_and_ln_determinant(covariance: &[f64], difference: &[f64]) -> (f64, f64) {
    let n = difference.len();
    let (mut a, mut b) = (covariance.to_vec(), difference.to_vec());
    let mut ln_determinant = 0.0;
    for k in 0..n {
        ln_determinant += a[k * n + k].ln();
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k..n {
                a[i * n + j] -= factor * a[k * n + j];
            }
            b[i] -= factor * b[k];
        }
    }
    let chi2 = (0..n).map(|k| b[k] * b[k] / a[k * n + k]).sum();
    (chi2, ln_determinant)
}
