//! A few lines of a recording's band and what its residual terms are on them: enough to write by residual
//! terms what a model's modes in the band leave, at a fraction of the cost of all lines.
//!
//! They are spread evenly, and some stand on each resonance: what is left is written by residues, too, and of
//! these a peak says most. Each line stands for those that are nearest to it, with the weight of all of them.

use crate::basis::{Pole, row};
use crate::projection::Projection;
use crate::recording::WeightedFrfs;
use crate::settings::outline::{
    GRID_FROM, GRID_PER_POLE, GRID_TO, HALF_WIDTHS_AT_PEAKS, LEAST_GRID, LEAST_GRID_FROM, LEAST_LINES,
    LINES_PER_COLUMN,
};
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::ops::Range;

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
        let chosen = chosen(hz, (poles, inside), terms);
        let reference = TAU * hz[n - 1];
        let rows: Vec<Vec<Complex64>> =
            chosen.iter().map(|&line| row(poles, terms, TAU * hz[line], reference).collect()).collect();
        let frfs = recording.frfs.pairs().len();
        let of = |frf: usize| &recording.weights[frf * n..(frf + 1) * n];
        let mean = |frf: usize| of(frf).iter().sum::<f64>() / n as f64;
        let projection = |frf: usize| {
            // A line that does not count stands for its neighbours here.
            let weight = |line: usize| if of(frf)[line] > 0.0 { of(frf)[line] } else { mean(frf) };
            let weights = nearest(&chosen, n).map(|lines| lines.map(weight).sum());
            Projection::new(&rows, &weights.collect::<Vec<f64>>())
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

/// Places of the lines: evenly over all of them, and at each mode in the band.
fn chosen(hz: &[f64], (poles, inside): (&[Pole], usize), terms: usize) -> Vec<usize> {
    let n = hz.len();
    let count = LEAST_LINES.max(LINES_PER_COLUMN * (poles.len() + terms)).min(n);
    let even = (0..count).map(|k| (k * (n - 1)) / (count - 1).max(1));
    let at = |pole: &Pole| {
        let (omega, ratio) = (pole.omega, pole.damping_ratio);
        HALF_WIDTHS_AT_PEAKS.map(|k| omega * (1.0 + k * ratio) / TAU)
    };
    let next_to = |at: f64| {
        let above = hz.partition_point(|line| *line < at).clamp(1, n - 1);
        if at - hz[above - 1] < hz[above] - at { above - 1 } else { above }
    };
    let peaks = poles[..inside].iter().flat_map(at).filter(|at| (hz[0]..=hz[n - 1]).contains(at) && n > 1);
    let mut chosen: Vec<usize> = even.chain(peaks.map(next_to)).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// Of each chosen line the lines that are nearest to it, all `n` of them once.
fn nearest(chosen: &[usize], n: usize) -> impl Iterator<Item = Range<usize>> + '_ {
    let middle = |place: usize| (chosen[place - 1] + chosen[place]).div_ceil(2);
    (0..chosen.len()).map(move |place| {
        let from = if place == 0 { 0 } else { middle(place) };
        let to = if place + 1 == chosen.len() { n } else { middle(place + 1) };
        from..to
    })
}

/// Frequencies over the band and a little beyond, evenly on a logarithmic scale.
pub(crate) fn grid(low: f64, high: f64, poles: usize) -> Option<SpectralLines> {
    let (from, to) = ((GRID_FROM * low).max(LEAST_GRID_FROM * high).ln(), (GRID_TO * high).ln());
    let count = LEAST_GRID.max(GRID_PER_POLE * poles);
    let hz = (0..count).map(|k| (from + (to - from) * k as f64 / (count - 1) as f64).exp());
    SpectralLines::new(hz.collect()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, FrfPair, FrfSet};

    #[test]
    fn what_smooth_parts_leave_to_a_residue_is_what_all_lines_leave() {
        // Two sharp modes below 30 Hz of lines up to 800 Hz, noise as coherence tells it, and what a window leaves
        // of a mass line: it falls with frequency, as no residual term does.
        let pole = |omega: f64, damping_ratio: f64| Pole { omega, damping_ratio };
        let poles = [pole(66.6, 0.02), pole(175.3, 0.008)];
        let lines = SpectralLines::even(3.0, 1.5, 530).unwrap();
        let frf = |hz: f64| {
            let s = Complex64::new(0.0, TAU * hz);
            poles.iter().map(|pole| 0.1 * pole.accelerance(s)).sum::<Complex64>()
        };
        let values: Vec<Complex64> = lines.hz().iter().map(|hz| frf(*hz)).collect();
        let weights: Vec<f64> = values.iter().map(|value| 1.0 / (1e-4 + 1e-4 * value.norm_sqr())).collect();
        let pairs = vec![FrfPair::transverse("1", "1")];
        let frfs = FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs, values).unwrap();
        let recording = WeightedFrfs { frfs: &frfs, weights: &weights };
        let outline = Outline::of(recording, (&poles, 2), 2, Vec::new()).unwrap();
        let reference = TAU * lines.hz()[lines.len() - 1];
        let rows = |lines: &SpectralLines| -> Vec<Vec<Complex64>> {
            lines.hz().iter().map(|hz| row(&poles, 2, TAU * hz, reference).collect()).collect()
        };
        let all = Projection::new(&rows(&lines), &weights).unwrap();
        let left = |lines: &SpectralLines| -> Vec<Complex64> {
            lines.hz().iter().map(|hz| Complex64::new(0.0, 1.0 / hz)).collect()
        };
        let expected = all.with_last(&left(&lines)).0;
        let found = outline.projections[0].with_last(&left(&outline.lines)).0;
        for (found, expected) in found.iter().zip(&expected).take(2) {
            let off = (found - expected).norm();
            assert!(off < 0.3 * expected.norm() + 1e-5, "{found} for {expected}");
        }
    }

    #[test]
    fn each_line_is_nearest_to_one_that_is_chosen() {
        let chosen = [0, 3, 4, 10, 19];
        let all: Vec<Range<usize>> = nearest(&chosen, 20).collect();
        assert_eq!(all, [0..2, 2..4, 4..7, 7..15, 15..20]);
        assert_eq!(nearest(&[0], 1).next(), Some(0..1));
    }
}
