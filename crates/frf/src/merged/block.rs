//! A block of neighbouring lines by the Gauss nodes of the polynomials that are orthonormal over it.

use super::line_noise::believed;
use jointscope_linalg::generalized_symmetric_eigen;
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use std::ops::Range;

/// Nodes of a block, one more than its polynomials' degree.
pub(super) const NODES: usize = 8;
/// Last coefficients that have to be noise, and their squares over its variance at the most.
const LAST: usize = 3;
const IS_NOISE: f64 = 9.0;
/// Squared error of a line over their mean beyond which it is no noise.
const PEAK: f64 = 20.0;
/// Correlation of neighbouring errors beyond which they are no noise.
const CORRELATED: f64 = 0.5;

/// A block of lines, by its nodes.
pub(super) struct Block {
    pub lines: Range<usize>,
    /// Frequencies of the nodes, Hz.
    pub hz: [f64; NODES],
    /// W_k.
    pub weights: [f64; NODES],
    /// By FRF, values at the nodes and the variance of what is left of a line.
    pub frfs: Vec<([Complex64; NODES], f64)>,
}

/// Polynomials that are orthonormal over the lines of a block, with room for those of the next.
#[derive(Default)]
pub(super) struct Basis {
    /// α_j and β_j of β_{j+1} p_{j+1} = (x − α_j) p_j − β_j p_{j−1}; β_0 is that of p_0.
    diagonal: [f64; NODES],
    beside: [f64; NODES],
    /// p_j on every line, polynomial after polynomial.
    values: Vec<f64>,
    x: Vec<f64>,
    left: Vec<Complex64>,
}

impl Basis {
    /// The block by its nodes; `None` where an FRF is no polynomial over it, or was not measured on a line.
    pub(super) fn block(&mut self, frfs: &FrfSet, lines: Range<usize>) -> Option<Block> {
        let count = lines.len();
        let hz = &frfs.lines().hz()[lines.clone()];
        let (middle, half) = (0.5 * (hz[0] + hz[count - 1]), 0.5 * (hz[count - 1] - hz[0]));
        self.orthonormal(hz, middle, half);
        let mut coefficients = Vec::with_capacity(frfs.pairs().len());
        for frf in 0..frfs.pairs().len() {
            if !lines.clone().all(|line| frfs.is_measured(frf, line)) {
                return None;
            }
            coefficients.push(self.coefficients(&frfs.values(frf)[lines.clone()])?);
        }
        let nodes = self.nodes()?;
        let at: [[f64; NODES]; NODES] = nodes.map(|x| self.at(x));
        let on_nodes = |c: [Complex64; NODES]| at.map(|p| c.iter().zip(p).map(|(c, p)| c * p).sum());
        Some(Block {
            lines,
            hz: nodes.map(|x| middle + half * x),
            weights: at.map(|p| 1.0 / p.iter().map(|p| p * p).sum::<f64>()),
            frfs: coefficients.into_iter().map(|(c, left)| (on_nodes(c), left)).collect(),
        })
    }

    /// Makes the polynomials of x = (f − middle)/half (Stieltjes).
    fn orthonormal(&mut self, hz: &[f64], middle: f64, half: f64) {
        let count = hz.len();
        self.x.clear();
        self.x.extend(hz.iter().map(|hz| (hz - middle) / half));
        self.values.clear();
        self.values.resize(NODES * count, 0.0);
        self.values[..count].fill((count as f64).sqrt().recip());
        self.beside[0] = (count as f64).sqrt();
        for j in 0..NODES {
            let (done, rest) = self.values.split_at_mut((j + 1) * count);
            let own = &done[j * count..];
            let alpha: f64 = own.iter().zip(&self.x).map(|(p, x)| p * p * x).sum();
            self.diagonal[j] = alpha;
            let Some(next) = rest.get_mut(..count) else { break };
            let mut square = 0.0;
            for (i, next) in next.iter_mut().enumerate() {
                let before = if j > 0 { self.beside[j] * done[(j - 1) * count + i] } else { 0.0 };
                *next = (self.x[i] - alpha) * own[i] - before;
                square += *next * *next;
            }
            self.beside[j + 1] = square.sqrt();
            next.iter_mut().for_each(|p| *p /= square.sqrt());
        }
    }

    /// Coefficients of an FRF and the variance of what they leave of a line; `None` where that is more than
    /// noise.
    fn coefficients(&mut self, values: &[Complex64]) -> Option<([Complex64; NODES], f64)> {
        let count = values.len();
        let polynomial = |j: usize| &self.values[j * count..(j + 1) * count];
        let coefficients: [Complex64; NODES] =
            std::array::from_fn(|j| values.iter().zip(polynomial(j)).map(|(v, p)| v * p).sum());
        self.left.clear();
        self.left.extend_from_slice(values);
        for (j, c) in coefficients.iter().enumerate() {
            self.left.iter_mut().zip(polynomial(j)).for_each(|(left, p)| *left -= c * p);
        }
        let (mut sum, mut most, mut together) = (0.0, 0.0_f64, 0.0);
        let mut before = Complex64::ZERO;
        for left in &self.left {
            sum += left.norm_sqr();
            most = most.max(left.norm_sqr());
            together += (left * before.conj()).re;
            before = *left;
        }
        let variance = (sum / (count - NODES) as f64).max(believed(values));
        let is_noise = coefficients[NODES - LAST..].iter().all(|c| c.norm_sqr() <= IS_NOISE * variance)
            && most <= PEAK * variance
            && together <= CORRELATED * count as f64 * variance;
        is_noise.then_some((coefficients, variance))
    }

    /// The zeros of the polynomial after the last: eigenvalues of the recurrence's matrix.
    fn nodes(&self) -> Option<[f64; NODES]> {
        let (mut unit, mut matrix) = ([0.0; NODES * NODES], [0.0; NODES * NODES]);
        for j in 0..NODES {
            unit[j * NODES + j] = 1.0;
            matrix[j * NODES + j] = self.diagonal[j];
            if j > 0 {
                matrix[j * NODES + j - 1] = self.beside[j];
                matrix[(j - 1) * NODES + j] = self.beside[j];
            }
        }
        let basis = generalized_symmetric_eigen(NODES, &unit, &matrix).ok()?;
        basis.eigenvalues().try_into().ok()
    }

    /// All polynomials at x.
    fn at(&self, x: f64) -> [f64; NODES] {
        let mut p = [0.0; NODES];
        p[0] = 1.0 / self.beside[0];
        for j in 1..NODES {
            let before = if j > 1 { self.beside[j - 1] * p[j - 2] } else { 0.0 };
            p[j] = ((x - self.diagonal[j - 1]) * p[j - 1] - before) / self.beside[j];
        }
        p
    }
}
