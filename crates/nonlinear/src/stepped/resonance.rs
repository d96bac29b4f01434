//! One resonance of FRFs on the lines about it: natural frequency and damping ratio.

use super::least_squares::{deviations, minimum};
use super::level::SteppedLevel;
use crate::settings::levels::DAMPING_STARTS;
use num_complex::Complex64;
use serde::Serialize;
use std::f64::consts::TAU;

/// Natural frequency and damping ratio at one level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Resonance {
    /// Natural frequency, Hz, and its standard deviation.
    #[serde(serialize_with = "jointscope_findings::with_std")]
    pub frequency: (f64, f64),
    /// Damping ratio and its standard deviation.
    #[serde(serialize_with = "jointscope_findings::with_std")]
    pub damping_ratio: (f64, f64),
    /// √(Σ|fitted − measured|²/Σ|measured|²).
    #[serde(rename = "nrmse_of_one_mode")]
    pub nrmse: f64,
}

/// Fits −ω²A/(ω₀² − ω² + 2iζω₀ω) + R to every FRF of the level, ω₀ and ζ shared, A and R complex: what other
/// modes add is a constant on the few lines about one resonance. Standard deviations come from what the fit
/// leaves.
pub(crate) fn resonance(level: &SteppedLevel) -> Option<Resonance> {
    let lines = level.frfs.lines();
    let omegas: Vec<f64> = lines.omegas().collect();
    let frfs = level.frfs.pairs().len();
    let unknowns = 2 + 4 * frfs;
    let count = 2 * frfs * omegas.len();
    if count <= unknowns {
        return None;
    }
    let residual = |x: &[f64]| {
        let (omega0, ratio) = (x[0] * TAU, x[1]);
        let shape: Vec<Complex64> = omegas
            .iter()
            .map(|w| -w * w / Complex64::new(omega0 * omega0 - w * w, 2.0 * ratio * omega0 * w))
            .collect();
        let mut all = Vec::with_capacity(count);
        for frf in 0..frfs {
            all.extend(left_of(level.frfs.values(frf), &shape)?);
        }
        (omega0 > 0.0 && ratio > 0.0 && all.iter().all(|r: &f64| r.is_finite())).then_some(all)
    };
    let (top, width) = level.peak();
    let scale = [width, 0.5 * width / top];
    let starts = DAMPING_STARTS.map(|part| [top, part * width / top]);
    let fits = starts.iter().filter_map(|start| minimum(&residual, start, &scale));
    let best = fits.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let std = deviations(&residual, &best.x, &scale, count - unknowns)?;
    let total: f64 = level.frfs.all_values().iter().map(|v| v.norm_sqr()).sum();
    Some(Resonance {
        frequency: (best.x[0], std[0]),
        damping_ratio: (best.x[1], std[1]),
        nrmse: (best.cost / total).sqrt(),
    })
}

/// What A·shape + R, both best, leaves of `values`: real and imaginary parts.
fn left_of(values: &[Complex64], shape: &[Complex64]) -> Option<Vec<f64>> {
    let n = values.len() as f64;
    let mean = |of: &dyn Fn(usize) -> Complex64| (0..values.len()).map(of).sum::<Complex64>() / n;
    let (middle, level) = (mean(&|i| shape[i]), mean(&|i| values[i]));
    let power: f64 = shape.iter().map(|s| (s - middle).norm_sqr()).sum();
    let along: Complex64 = shape.iter().zip(values).map(|(s, v)| (s - middle).conj() * (v - level)).sum();
    (power > 0.0).then(|| {
        let factor = along / power;
        let left = shape.iter().zip(values).map(|(s, v)| v - level - factor * (s - middle));
        left.flat_map(|r| [r.re, r.im]).collect()
    })
}
