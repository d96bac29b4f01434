//! The Cramér–Rao bound of frequencies and damping ratios by central differences of the model, and how an
//! estimator compares with it.

use super::{TrueMode, accelerances, noisy, without_variances};
use jointscope_linalg::Cholesky;
use jointscope_modes::{ModalAnalysis, ModesOptions};
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A test that is simulated many times.
pub(crate) struct Scenario {
    pub name: &'static str,
    pub modes: Vec<TrueMode>,
    pub pairs: Vec<(usize, usize)>,
    pub lines: SpectralLines,
    /// Noise: a floor, and a share of each value.
    pub noise: (f64, f64),
    /// Whether the variances are told; else they come from the scatter of the lines.
    pub told: bool,
}

/// Of one number of one mode: true value, bound, mean error and spread over the bound, rms of (error/its
/// stated deviation).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Score {
    pub truth: f64,
    #[allow(dead_code)] // printed by the example
    pub bound: f64,
    pub bias: f64,
    pub spread: f64,
    pub pull: f64,
}

impl Scenario {
    /// Standard deviations that no unbiased estimator beats: (Hz, ratio) of each mode. Unknown are poles,
    /// complex entries over responses and references (the first reference's one), and complex residual terms
    /// s⁻² and 1 of each FRF.
    pub(crate) fn bounds(&self) -> Vec<(f64, f64)> {
        let responses = distinct(self.pairs.iter().map(|p| p.0));
        let references = distinct(self.pairs.iter().map(|p| p.1));
        let (no, ni, nm) = (responses.len(), references.len(), self.modes.len());
        assert_eq!(no * ni, self.pairs.len());
        let mut parameters = Vec::new();
        for mode in &self.modes {
            let omega = TAU * mode.frequency * (1.0 - mode.ratio * mode.ratio).sqrt();
            let first = mode.shape[references[0] - 1];
            parameters.extend([mode.frequency, mode.ratio]);
            for o in &responses {
                // φφ/(2iω_d).
                let entry = mode.shape[o - 1] * first / Complex64::new(0.0, 2.0 * omega);
                parameters.extend([entry.re, entry.im]);
            }
            for i in &references[1..] {
                parameters.extend([mode.shape[i - 1] / first, 0.0]);
            }
        }
        let per_mode = 2 + 2 * no + 2 * (ni - 1);
        assert_eq!(parameters.len(), per_mode * nm);
        parameters.extend(vec![0.0; 4 * self.pairs.len()]);
        let highest = TAU * self.lines.hz()[self.lines.len() - 1];
        let model = |p: &[f64]| -> Vec<Complex64> {
            let complex = |k: usize| Complex64::new(p[k], p[k + 1]);
            let mut values = Vec::new();
            for (index, &(o, i)) in self.pairs.iter().enumerate() {
                let (o, i) = (
                    responses.iter().position(|r| *r == o).unwrap(),
                    references.iter().position(|r| *r == i).unwrap(),
                );
                for omega in self.lines.omegas() {
                    let s = Complex64::new(0.0, omega);
                    let mut sum = Complex64::ZERO;
                    for mode in 0..nm {
                        let first = per_mode * mode;
                        let (natural, ratio) = (TAU * p[first], p[first + 1]);
                        let pole = Complex64::new(-ratio * natural, natural * (1.0 - ratio * ratio).sqrt());
                        let l =
                            if i == 0 { Complex64::ONE } else { complex(first + 2 + 2 * no + 2 * (i - 1)) };
                        let residue = complex(first + 2 + 2 * o) * l;
                        sum += residue / (s - pole) + residue.conj() / (s - pole.conj());
                    }
                    let term = per_mode * nm + 4 * index;
                    values.push(sum * s * s + complex(term) + complex(term + 2) * (omega / highest).powi(2));
                }
            }
            values
        };
        let n = parameters.len();
        let clean = accelerances(&self.modes, 2.0, &self.pairs, &self.lines);
        let weight: Vec<f64> = clean
            .iter()
            .map(|v| (2.0 / (self.noise.0.powi(2) + self.noise.1.powi(2) * v.norm_sqr())).sqrt())
            .collect();
        let columns: Vec<Vec<Complex64>> = (0..n)
            .map(|k| {
                // A small part of a half-width, of an entry, of a term.
                let of_mode = k / per_mode;
                let step = match k % per_mode {
                    _ if of_mode >= nm => 1e-6,
                    0 => 1e-3 * self.modes[of_mode].ratio * self.modes[of_mode].frequency,
                    1 => 1e-3 * self.modes[of_mode].ratio,
                    _ => 1e-6,
                };
                let (mut up, mut down) = (parameters.clone(), parameters.clone());
                up[k] += step;
                down[k] -= step;
                let (up, down) = (model(&up), model(&down));
                up.iter().zip(down).zip(&weight).map(|((u, d), w)| (u - d) / (2.0 * step) * w).collect()
            })
            .collect();
        let mut information = vec![0.0; n * n];
        for a in 0..n {
            for b in 0..=a {
                information[a * n + b] =
                    columns[a].iter().zip(&columns[b]).map(|(x, y)| x.re * y.re + x.im * y.im).sum();
            }
        }
        let inverse = Cholesky::of(n, &information).unwrap().inverse();
        let std = |k: usize| inverse[k * n + k].sqrt();
        (0..nm).map(|m| (std(per_mode * m), std(per_mode * m + 1))).collect()
    }

    /// Scores of frequency and damping ratio of each mode over so many seeds, and how often the right number
    /// of modes was found.
    pub(crate) fn scores(&self, seeds: u64) -> (Vec<[Score; 2]>, f64) {
        let bounds = self.bounds();
        let clean = accelerances(&self.modes, 2.0, &self.pairs, &self.lines);
        let mut errors: Vec<[Vec<(f64, f64)>; 2]> = vec![Default::default(); self.modes.len()];
        let mut found = 0.0;
        for seed in 0..seeds {
            let set = noisy(&clean, &self.pairs, &self.lines, self.noise.0, self.noise.1, seed);
            let set = if self.told { set } else { without_variances(&set) };
            let Ok(analysis) = ModalAnalysis::of(&set, &ModesOptions::default()) else { continue };
            if analysis.modes.len() != self.modes.len() {
                continue;
            }
            found += 1.0;
            for ((mode, truth), errors) in analysis.modes.iter().zip(&self.modes).zip(&mut errors) {
                errors[0].push((mode.frequency - truth.frequency, mode.frequency_std));
                errors[1].push((mode.damping_ratio - truth.ratio, mode.damping_std));
            }
        }
        let score = |errors: &[(f64, f64)], truth: f64, bound: f64| {
            let n = errors.len() as f64;
            let mean = errors.iter().map(|e| e.0).sum::<f64>() / n;
            let spread = (errors.iter().map(|e| (e.0 - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
            let pull = (errors.iter().map(|e| (e.0 / e.1).powi(2)).sum::<f64>() / n).sqrt();
            Score { truth, bound, bias: mean / bound, spread: spread / bound, pull }
        };
        let scores = errors
            .iter()
            .zip(&self.modes)
            .zip(bounds)
            .map(|((e, m), b)| [score(&e[0], m.frequency, b.0), score(&e[1], m.ratio, b.1)])
            .collect();
        (scores, found / seeds as f64)
    }
}

fn distinct(all: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut found = Vec::new();
    all.for_each(|one| {
        if !found.contains(&one) {
            found.push(one);
        }
    });
    found
}

/// Damping ratios from 0.01 to 3 %, close pairs, coarse lines, one FRF and four, noise of 1 %.
pub(crate) fn scenarios() -> Vec<Scenario> {
    use super::mode;
    let four = vec![(4, 1), (3, 1), (4, 2), (3, 2)];
    let shapes = [[1.0, 0.2, -0.3, -0.9], [0.8, -0.7, 0.6, 0.9], [0.3, 0.7, 0.9, -0.5]];
    let modes = |of: [(f64, f64); 3]| (0..3).map(|k| mode(of[k].0, of[k].1, &shapes[k])).collect::<Vec<_>>();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let coarse = SpectralLines::even(10.0, 10.0, 100).unwrap();
    let scenario = |name, modes, pairs: &[(usize, usize)], lines: &SpectralLines, noise| Scenario {
        name,
        modes,
        pairs: pairs.to_vec(),
        lines: lines.clone(),
        noise,
        told: true,
    };
    let untold = |scenario: Scenario| Scenario { told: false, ..scenario };
    vec![
        scenario(
            "0.3 to 1 %",
            modes([(120.0, 0.003), (410.0, 0.006), (700.0, 0.01)]),
            &four,
            &lines,
            (0.0, 0.01),
        ),
        scenario(
            "0.01 to 3 %",
            modes([(121.1, 1e-4), (411.0, 2e-4), (700.3, 0.03)]),
            &four,
            &lines,
            (0.0, 0.01),
        ),
        scenario(
            "0.01 to 3 %, noise floor",
            modes([(121.1, 1e-4), (411.0, 2e-4), (700.3, 0.03)]),
            &four,
            &lines,
            (0.02, 0.0),
        ),
        scenario("3 % all", modes([(120.0, 0.03), (410.0, 0.03), (700.0, 0.03)]), &four, &lines, (0.0, 0.01)),
        scenario(
            "close pair, 1.5 half-widths apart",
            modes([(400.0, 0.005), (403.0, 0.005), (700.3, 0.01)]),
            &four,
            &lines,
            (0.0, 0.01),
        ),
        scenario(
            "close pair, 0.5 half-widths apart",
            modes([(400.0, 0.005), (401.0, 0.005), (700.3, 0.01)]),
            &four,
            &lines,
            (0.0, 0.01),
        ),
        scenario(
            "close pair in one FRF",
            modes([(400.0, 0.005), (403.0, 0.005), (700.3, 0.01)]),
            &four[..1],
            &lines,
            (0.0, 0.01),
        ),
        scenario(
            "lines ten half-widths apart",
            modes([(123.0, 0.008), (412.0, 0.0024), (708.0, 0.0015)]),
            &four,
            &coarse,
            (0.0, 0.01),
        ),
        untold(scenario(
            "0.3 to 1 %, noise not told",
            modes([(120.0, 0.003), (410.0, 0.006), (700.0, 0.01)]),
            &four,
            &lines,
            (0.0, 0.01),
        )),
        untold(scenario(
            "0.01 to 3 %, noise not told",
            modes([(121.1, 1e-4), (411.0, 2e-4), (700.3, 0.03)]),
            &four,
            &lines,
            (0.02, 0.005),
        )),
        scenario(
            "one FRF, 0.1 %",
            modes([(120.7, 0.001), (410.3, 0.001), (701.0, 0.001)]),
            &four[..1],
            &lines,
            (0.0, 0.01),
        ),
    ]
}
