//! A few lines of a recording's band and what its residual terms are on them: enough to write by residual
//! terms what a model's modes in the band leave, at a fraction of the cost of all lines.

use crate::basis::{Pole, row};
use crate::projection::Projection;
use crate::recording::WeightedFrfs;
use crate::settings::outline::{
    GRID_FROM, GRID_PER_POLE, GRID_TO, LEAST_GRID, LEAST_GRID_FROM, LEAST_LINES, LINES_PER_COLUMN,
};
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Few lines over the band on which what a model's modes in the band leave is written by residual terms.
#[derive(Debug, Clone)]
pub(crate) struct Outline {
    pub lines: SpectralLines,
    /// Frequencies on which a model's poles are looked for.
    pub grid: SpectralLines,
    /// One an FRF.
    pub projections: Vec<Projection>,
    /// Mean weight a line of each FRF, over all lines of the recording.
    pub weights: Vec<f64>,
    /// Number of lines of the recording.
    pub recorded: usize,
    /// Number of poles whose columns precede those of the residual terms.
    pub poles: usize,
    /// How many of them are modes in the band; they come first.
    pub inside: usize,
    /// The columns that make up the mass line.
    pub mass_line: Vec<usize>,
}

impl Outline {
    /// Of a recording that was fitted with `poles`, the first `inside` of them in the band, and so many
    /// residual terms.
    pub(crate) fn of(
        recording: WeightedFrfs,
        (poles, inside): (&[Pole], usize),
        terms: usize,
        mass_line: Vec<usize>,
    ) -> Option<Self> {
        let hz = recording.frfs.lines().hz();
        let n = hz.len();
        let count = LEAST_LINES.max(LINES_PER_COLUMN * (poles.len() + terms)).min(n);
        let chosen: Vec<usize> = (0..count).map(|k| (k * (n - 1)) / (count - 1).max(1)).collect();
        let reference = TAU * hz[n - 1];
        let rows: Vec<Vec<Complex64>> =
            chosen.iter().map(|&line| row(poles, terms, TAU * hz[line], reference).collect()).collect();
        let frfs = recording.frfs.pairs().len();
        let of = |frf: usize| &recording.weights[frf * n..(frf + 1) * n];
        let mean = |frf: usize| of(frf).iter().sum::<f64>() / n as f64;
        let projection = |frf: usize| {
            // A line that does not count stands for its neighbours here.
            let weight = |line: usize| if of(frf)[line] > 0.0 { of(frf)[line] } else { mean(frf) };
            let weights: Vec<f64> = chosen.iter().map(|&line| weight(line)).collect();
            Projection::new(&rows, &weights)
        };
        Some(Outline {
            lines: SpectralLines::new(chosen.iter().map(|&line| hz[line]).collect()).ok()?,
            grid: grid(hz[0], hz[n - 1], poles.len())?,
            projections: (0..frfs).map(projection).collect::<Option<_>>()?,
            weights: (0..frfs).map(mean).collect(),
            recorded: n,
            poles: poles.len(),
            inside,
            mass_line,
        })
    }
}

/// Frequencies over the band and a little beyond, evenly on a logarithmic scale.
pub(crate) fn grid(low: f64, high: f64, poles: usize) -> Option<SpectralLines> {
    let (from, to) = ((GRID_FROM * low).max(LEAST_GRID_FROM * high).ln(), (GRID_TO * high).ln());
    let count = LEAST_GRID.max(GRID_PER_POLE * poles);
    let hz = (0..count).map(|k| (from + (to - from) * k as f64 / (count - 1) as f64).exp());
    SpectralLines::new(hz.collect()).ok()
}
