//! What was measured, as accelerances with weights, and how the FRFs stand in a matrix of responses and
//! references.

use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet};
use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::settings::merged_lines::{FEW_LINES, SMOOTH};

/// The FRFs as rows of `columns` entries that share their poles' participations.
///
/// The columns are the references or the responses, whichever are fewer: a hammer that roves over thirty
/// points past one sensor is one column of thirty rows. A matrix with gaps is taken apart into FRFs that
/// share poles only.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    /// Indices of the FRFs, row after row.
    pub rows: Vec<Vec<usize>>,
    /// Number of columns.
    pub columns: usize,
    /// The channels of the rows and of the columns; empty where the matrix has gaps.
    pub row_channels: Vec<Channel>,
    pub column_channels: Vec<Channel>,
}

impl Grid {
    fn of(pairs: &[FrfPair]) -> Self {
        let distinct = |channel: fn(&FrfPair) -> &Channel| {
            let mut all: Vec<Channel> = Vec::new();
            for pair in pairs {
                if !all.contains(channel(pair)) {
                    all.push(channel(pair).clone());
                }
            }
            all
        };
        let (responses, references) = (distinct(|p| &p.response), distinct(|p| &p.reference));
        if responses.len() * references.len() != pairs.len() {
            let rows = (0..pairs.len()).map(|i| vec![i]).collect();
            return Grid { rows, columns: 1, row_channels: Vec::new(), column_channels: Vec::new() };
        }
        let by_reference = references.len() <= responses.len();
        let (rows, columns) = if by_reference { (responses, references) } else { (references, responses) };
        let index = |row: &Channel, column: &Channel| {
            let (response, reference) = if by_reference { (row, column) } else { (column, row) };
            // Complete, so every pair is there.
            pairs.iter().position(|p| p.response == *response && p.reference == *reference).unwrap_or(0)
        };
        Grid {
            rows: rows.iter().map(|row| columns.iter().map(|column| index(row, column)).collect()).collect(),
            columns: columns.len(),
            row_channels: rows,
            column_channels: columns,
        }
    }

    fn single() -> Self {
        Grid { rows: vec![vec![0]], columns: 1, row_channels: Vec::new(), column_channels: Vec::new() }
    }
}

/// Accelerances and weights at angular frequencies above zero.
#[derive(Debug, Clone)]
pub(crate) struct Observed {
    pub grid: Grid,
    /// rad/s, ascending.
    pub omegas: Vec<f64>,
    /// FRF after FRF.
    pub values: Vec<Complex64>,
    /// One over the variance E|ε|² of each value; zero where it is not used.
    pub weights: Vec<f64>,
    /// How many recorded lines each line stands for: 1 where none were merged.
    pub stands_for: Vec<f64>,
}

impl Observed {
    /// The lines above 0 Hz of a set that carries variances, each of which stands for so many; `None` where
    /// there are none.
    pub(crate) fn of(frfs: &FrfSet, stands_for: &[f64]) -> Option<Self> {
        let hz = frfs.lines().hz();
        let lines: Vec<usize> = (0..hz.len()).filter(|&i| hz[i] > 0.0).collect();
        if lines.is_empty() {
            return None;
        }
        let mut values = Vec::with_capacity(lines.len() * frfs.pairs().len());
        let mut weights = Vec::with_capacity(values.capacity());
        for index in 0..frfs.pairs().len() {
            let (all, variance) = (frfs.values(index), frfs.variance(index)?);
            for &line in &lines {
                let factor = frfs.form().factor_to(FrfForm::Accelerance, frfs.lines().omega(line))?;
                let spread = variance[line] * factor.norm_sqr();
                values.push(all[line] * factor);
                let weight = 1.0 / spread;
                let told = frfs.is_measured(index, line) && spread > 0.0 && weight.is_finite();
                weights.push(if told { weight } else { 0.0 });
            }
        }
        Some(Observed {
            grid: Grid::of(frfs.pairs()),
            omegas: lines.iter().map(|&i| TAU * hz[i]).collect(),
            values,
            weights,
            stands_for: lines.iter().map(|&i| stands_for[i]).collect(),
        })
    }

    pub(crate) fn lines(&self) -> usize {
        self.omegas.len()
    }

    pub(crate) fn frfs(&self) -> usize {
        self.values.len() / self.lines()
    }

    pub(crate) fn values(&self, frf: usize) -> &[Complex64] {
        &self.values[frf * self.lines()..(frf + 1) * self.lines()]
    }

    pub(crate) fn weights(&self, frf: usize) -> &[f64] {
        &self.weights[frf * self.lines()..(frf + 1) * self.lines()]
    }

    /// Variances E|ε|² of all values; those that are not used get the largest.
    pub(crate) fn variances(&self) -> Vec<f64> {
        let least = self.weights.iter().copied().filter(|w| *w > 0.0).fold(f64::INFINITY, f64::min);
        let least = if least.is_finite() { least } else { 1.0 };
        self.weights.iter().map(|w| 1.0 / if *w > 0.0 { *w } else { least }).collect()
    }

    /// Number of real numbers that count.
    pub(crate) fn degrees(&self) -> usize {
        2 * self.weights.iter().filter(|w| **w > 0.0).count()
    }

    /// One FRF by itself.
    pub(crate) fn single(&self, frf: usize) -> Self {
        Observed {
            grid: Grid::single(),
            omegas: self.omegas.clone(),
            values: self.values(frf).to_vec(),
            weights: self.weights(frf).to_vec(),
            stands_for: self.stands_for.clone(),
        }
    }

    /// The same with neighbouring lines averaged where the FRFs are smooth: far from every one of the
    /// `poles`. A sum of weighted lines keeps what they tell of everything that is straight over them.
    pub(crate) fn condensed(&self, poles: &[Complex64]) -> Self {
        let n = self.lines();
        if n <= FEW_LINES {
            return self.clone();
        }
        let mut starts = Vec::new();
        let mut next = 0;
        while next < n {
            starts.push(next);
            let omega = self.omegas[next];
            let distance =
                poles.iter().map(|p| (Complex64::new(0.0, omega) - p).norm()).fold(omega, f64::min);
            let end = omega + SMOOTH * distance;
            next += 1;
            while next < n && self.omegas[next] < end {
                next += 1;
            }
        }
        starts.push(n);
        // By the lines that each stands for and alike for all FRFs, so that a point's frequency is their
        // mean.
        let many: Vec<f64> =
            starts.windows(2).map(|ends| self.stands_for[ends[0]..ends[1]].iter().sum()).collect();
        let count = many.len();
        let frfs = self.frfs();
        let mut values = Vec::with_capacity(count * frfs);
        let mut weights = Vec::with_capacity(count * frfs);
        let shares = |ends: &[usize], many: f64| {
            self.stands_for[ends[0]..ends[1]].iter().map(move |lines| lines / many)
        };
        for frf in 0..frfs {
            let (all, weight) = (self.values(frf), self.weights(frf));
            for (ends, many) in starts.windows(2).zip(&many) {
                let lines = ends[0]..ends[1];
                let mean = all[lines.clone()].iter().zip(shares(ends, *many)).map(|(v, share)| v * share);
                values.push(mean.sum::<Complex64>());
                let parts = weight[lines].iter().zip(shares(ends, *many));
                let variance: f64 = parts.map(|(weight, share)| share * share / weight).sum();
                weights.push(if variance.is_finite() { 1.0 / variance } else { 0.0 });
            }
        }
        let omegas = starts.windows(2).zip(&many).map(|(ends, many)| {
            let parts = self.omegas[ends[0]..ends[1]].iter().zip(shares(ends, *many));
            parts.map(|(omega, share)| omega * share).sum()
        });
        Observed { grid: self.grid.clone(), omegas: omegas.collect(), values, weights, stands_for: many }
    }
}
