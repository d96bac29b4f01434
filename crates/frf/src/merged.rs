//! Long recordings with fewer lines, which tell the same.
//!
//! A zoomed or padded recording has far more lines than its resonances need. Over a block of neighbouring lines on which every FRF is a polynomial of degree 7
//! within its noise, the polynomial by least squares tells all that the lines do. It is read at the eight Gauss nodes x_k of the block's lines, with weights W_k:
//! for every other polynomial f of that degree
//!
//! Σ_i |H_i − f(x_i)|² = Σ_k W_k |H(x_k) − f(x_k)|² + what is left of H,
//!
//! and the errors of the eight values are independent, of variance σ²/W_k. A fit to the nodes is thus the fit to the lines. σ² comes from what is left, or from
//! variances or coherence where these are known.
//!
//! Blocks are halved until the last three coefficients of every FRF are noise: the coefficients of a function with poles fall geometrically, so what the first
//! one left out holds is below noise too. Blocks too short for that, at resonances, keep their lines.

use crate::noise::{self, FLOOR, NoiseSource, from_coherence, from_scatter, of_lines};
use jointscope_linalg::generalized_symmetric_eigen;
use jointscope_spectra::{FrfSet, SpectraError, SpectralLines};
use num_complex::Complex64;
use std::ops::Range;

/// A recording up to so many lines keeps them.
const MANY: usize = 6400;
/// Nodes of a block, one more than its polynomials' degree.
const NODES: usize = 8;
/// Fewest lines of a block: so many more than nodes that a peak in it does not pass for noise.
const FEWEST: usize = 64;
/// Blocks that a recording is cut into at first.
const BLOCKS: usize = 32;
/// Last coefficients that have to be noise, and their squares over its variance at the most.
const LAST: usize = 3;
const IS_NOISE: f64 = 9.0;
/// Squared error of a line over their mean beyond which it is no noise.
const PEAK: f64 = 20.0;
/// Correlation of neighbouring errors beyond which they are no noise.
const CORRELATED: f64 = 0.5;
/// Lines on either side that the noise of lines kept is taken from too.
const AROUND: usize = 30;

/// FRFs with the variances that their noise gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownNoise {
    /// The set with variances, its lines merged if there were many.
    pub frfs: FrfSet,
    /// Where each FRF's came from; empty where the set brought them.
    pub noise: Vec<NoiseSource>,
    /// Number of lines recorded, where they were merged.
    pub merged_from: Option<usize>,
    /// How many recorded lines each line stands for, which need not be a whole number; they add up to all.
    pub stands_for: Vec<f64>,
    /// FRF after FRF, each line's part of Σ|ε|² over the recorded lines of what merging took out of them, in the square of the set's unit.
    pub taken_out: Vec<f64>,
}

impl KnownNoise {
    /// The set with its noise [`known`](noise::known); of more than 6,400 lines, neighbours over which all FRFs are smooth are merged, none within the
    /// `band` (Hz) of interest with one outside.
    ///
    /// # Errors
    /// Only those of a set that cannot be converted.
    pub fn of(frfs: &FrfSet, band: Option<(f64, f64)>) -> Result<Self, SpectraError> {
        let recorded = frfs.lines().len();
        if recorded > MANY {
            return merged(frfs, band);
        }
        let (frfs, noise) = noise::known(frfs)?;
        let taken_out = vec![0.0; frfs.all_values().len()];
        Ok(KnownNoise { frfs, noise, merged_from: None, stands_for: vec![1.0; recorded], taken_out })
    }
}

/// What is known of an FRF's noise.
enum Known<'a> {
    Variance(&'a [f64]),
    Coherence(&'a [f64], u32),
    Scatter,
}

impl<'a> Known<'a> {
    fn of(frfs: &'a FrfSet, index: usize) -> Self {
        match (frfs.variance(index), frfs.coherence(index), frfs.averages(index)) {
            (Some(variance), ..) => Known::Variance(variance),
            (None, Some(coherence), Some(averages @ 2..)) => Known::Coherence(coherence, averages),
            _ => Known::Scatter,
        }
    }

    /// Variance of a line in the mean over some, of which `left` is that of what a polynomial leaves.
    fn over(&self, lines: Range<usize>, values: &[Complex64], left: f64) -> f64 {
        let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
        match self {
            Known::Variance(variance) => mean(&variance[lines]),
            Known::Coherence(coherence, averages) => {
                let (values, coherence) = (&values[lines.clone()], &coherence[lines]);
                mean(&of_lines(values, coherence, *averages)).max(believed(values))
            }
            Known::Scatter => left,
        }
    }

    /// Variances of lines that are kept.
    fn by_line(&self, lines: Range<usize>, hz: &[f64], values: &[Complex64]) -> Vec<f64> {
        let near = lines.start.saturating_sub(AROUND)..(lines.end + AROUND).min(hz.len());
        let own = lines.start - near.start..lines.end - near.start;
        let all = match self {
            Known::Variance(variance) => return variance[lines].to_vec(),
            Known::Coherence(coherence, averages) => {
                from_coherence(&values[near.clone()], &coherence[near], *averages)
            }
            Known::Scatter => from_scatter(&hz[near.clone()], &values[near]),
        };
        all[own].to_vec()
    }
}

/// Smallest variance that is believed of a line.
fn believed(values: &[Complex64]) -> f64 {
    let size = values.iter().map(|v| v.norm_sqr()).sum::<f64>() / values.len() as f64;
    (FLOOR * FLOOR * size).max(f64::MIN_POSITIVE)
}

/// What stands for some neighbouring lines.
enum Piece {
    Kept(Range<usize>),
    Merged(Block),
}

/// A block of lines, by its nodes.
struct Block {
    lines: Range<usize>,
    /// Frequencies of the nodes, Hz.
    hz: [f64; NODES],
    /// W_k.
    weights: [f64; NODES],
    /// By FRF, values at the nodes and the variance of what is left of a line.
    frfs: Vec<([Complex64; NODES], f64)>,
}

/// All lines in pieces: blocks over which all FRFs are smooth, and lines that are kept.
fn pieces(frfs: &FrfSet, band: Option<(f64, f64)>) -> Vec<Piece> {
    let count = frfs.lines().len();
    let mut pieces: Vec<Piece> = Vec::new();
    let mut basis = Basis::default();
    let inside = band.map_or(0..count, |(from, to)| frfs.lines().range(from, to));
    let cut = |part: Range<usize>| {
        let at = move |block: usize| part.start + block * part.len() / BLOCKS;
        (0..BLOCKS).map(move |block| at(block)..at(block + 1))
    };
    // Blocks yet to be looked at, the next one last.
    let mut open: Vec<Range<usize>> =
        [0..inside.start, inside.clone(), inside.end..count].into_iter().flat_map(cut).collect();
    open.reverse();
    while let Some(lines) = open.pop() {
        if lines.len() < FEWEST {
            match pieces.last_mut() {
                _ if lines.is_empty() => {}
                Some(Piece::Kept(before)) => before.end = lines.end,
                _ => pieces.push(Piece::Kept(lines)),
            }
            continue;
        }
        match basis.block(frfs, lines.clone()) {
            Some(block) => pieces.push(Piece::Merged(block)),
            None => {
                let middle = lines.start + lines.len() / 2;
                open.extend([middle..lines.end, lines.start..middle]);
            }
        }
    }
    pieces
}

fn merged(frfs: &FrfSet, band: Option<(f64, f64)>) -> Result<KnownNoise, SpectraError> {
    let (hz, count, pieces) = (frfs.lines().hz(), frfs.lines().len(), pieces(frfs, band));
    let on_all = |kept: &dyn Fn(&Range<usize>) -> Vec<f64>, block: &dyn Fn(&Block) -> [f64; NODES]| {
        let of = |piece: &Piece| match piece {
            Piece::Kept(lines) => kept(lines),
            Piece::Merged(own) => block(own).to_vec(),
        };
        pieces.iter().flat_map(of).collect::<Vec<f64>>()
    };
    let lines = SpectralLines::new(on_all(&|kept| hz[kept.clone()].to_vec(), &|block| block.hz))?;
    let (mut values, mut variances) = (Vec::new(), Vec::new());
    for frf in 0..frfs.pairs().len() {
        let (all, known) = (frfs.values(frf), Known::of(frfs, frf));
        for piece in &pieces {
            match piece {
                Piece::Kept(lines) => values.extend_from_slice(&all[lines.clone()]),
                Piece::Merged(block) => values.extend_from_slice(&block.frfs[frf].0),
            }
        }
        variances.extend(on_all(&|kept| known.by_line(kept.clone(), hz, all), &|block| {
            let of_line = known.over(block.lines.clone(), all, block.frfs[frf].1);
            block.weights.map(|weight| of_line / weight)
        }));
    }
    let mut set = FrfSet::new(lines, frfs.form(), frfs.pairs().to_vec(), values)?.with_variance(variances)?;
    let stands_for = on_all(&|kept| vec![1.0; kept.len()], &|block| block.weights);
    let (mut noise, mut taken_out) = (Vec::new(), Vec::new());
    for frf in 0..frfs.pairs().len() {
        let taken =
            |block: &Block| [block.frfs[frf].1 * (block.lines.len() - NODES) as f64 / NODES as f64; NODES];
        taken_out.extend(on_all(&|kept| vec![0.0; kept.len()], &taken));
        set.set_averages(frf, frfs.averages(frf));
        if let Some(coherence) = frfs.coherence(frf) {
            let mean = |block: &Block| {
                [coherence[block.lines.clone()].iter().sum::<f64>() / block.lines.len() as f64; NODES]
            };
            set.set_coherence(frf, on_all(&|kept| coherence[kept.clone()].to_vec(), &mean))?;
        }
        noise.extend(match Known::of(frfs, frf) {
            Known::Variance(_) => None,
            Known::Coherence(..) => Some(NoiseSource::Coherence),
            Known::Scatter => Some(NoiseSource::Scatter),
        });
    }
    Ok(KnownNoise { frfs: set, noise, merged_from: Some(count), stands_for, taken_out })
}

/// Polynomials that are orthonormal over the lines of a block, with room for those of the next.
#[derive(Default)]
struct Basis {
    /// α_j and β_j of β_{j+1} p_{j+1} = (x − α_j) p_j − β_j p_{j−1}; β_0 is that of p_0.
    diagonal: [f64; NODES],
    beside: [f64; NODES],
    /// p_j on every line, polynomial after polynomial.
    values: Vec<f64>,
    x: Vec<f64>,
    left: Vec<Complex64>,
}

impl Basis {
    /// The block by its nodes; `None` where an FRF is no polynomial over it, or has a line without coherence.
    fn block(&mut self, frfs: &FrfSet, lines: Range<usize>) -> Option<Block> {
        let count = lines.len();
        let hz = &frfs.lines().hz()[lines.clone()];
        let (middle, half) = (0.5 * (hz[0] + hz[count - 1]), 0.5 * (hz[count - 1] - hz[0]));
        self.orthonormal(hz, middle, half);
        let mut coefficients = Vec::with_capacity(frfs.pairs().len());
        for frf in 0..frfs.pairs().len() {
            if frfs.coherence(frf).is_some_and(|coherence| coherence[lines.clone()].contains(&0.0)) {
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

    /// Coefficients of an FRF and the variance of what they leave of a line; `None` where that is more than noise.
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

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;
    use jointscope_spectra::{FrfForm, FrfPair};

    const COUNT: usize = 20_000;
    const POLES: [(f64, f64); 2] = [(130.0, 0.004), (641.3, 0.002)];

    /// Accelerance of one mode per unit residue.
    fn mode(hz: f64, (natural, ratio): (f64, f64)) -> Complex64 {
        -hz * hz / Complex64::new(natural * natural - hz * hz, 2.0 * ratio * natural * hz)
    }

    fn truth(hz: f64) -> Complex64 {
        0.3 + mode(hz, POLES[0]) - 0.7 * mode(hz, POLES[1])
    }

    /// One FRF of `frf` with noise of this standard deviation, 50 to 1050 Hz.
    fn recorded(frf: impl Fn(f64) -> Complex64, noise: f64, seed: u64) -> FrfSet {
        let lines = SpectralLines::even(50.0, 1000.0 / COUNT as f64, COUNT).unwrap();
        let mut normals = Noise::from_state(seed);
        let values = lines.hz().iter().map(|hz| frf(*hz) + noise * normals.complex(1.0)).collect();
        FrfSet::new(lines, FrfForm::Accelerance, vec![FrfPair::transverse("2", "1")], values).unwrap()
    }

    /// Least-squares residues of both modes and a constant, with their variances.
    fn residues(set: &FrfSet, variance: &[f64]) -> Vec<(Complex64, f64)> {
        let mut fit = jointscope_linalg::LeastSquares::new();
        fit.begin(3);
        for ((hz, value), variance) in set.lines().hz().iter().zip(set.values(0)).zip(variance) {
            let row = [Complex64::ONE, mode(*hz, POLES[0]), mode(*hz, POLES[1])];
            fit.equation(&row.map(|c| c.re), value.re.into(), 2.0 / variance);
            fit.equation(&row.map(|c| c.im), value.im.into(), 2.0 / variance);
        }
        let mut x = vec![Complex64::ZERO; 3];
        fit.solve(&mut x).unwrap();
        x.into_iter().enumerate().map(|(i, x)| (x, fit.covariance(i, i))).collect()
    }

    #[test]
    fn a_fit_to_the_lines_left_is_the_fit_to_all() {
        let all = recorded(truth, 1e-2, 3).with_variance(vec![1e-4; COUNT]).unwrap();
        let KnownNoise { frfs, merged_from, .. } = KnownNoise::of(&all, None).unwrap();
        assert_eq!(merged_from, Some(COUNT));
        assert!(frfs.lines().len() < COUNT / 8, "{} lines left", frfs.lines().len());
        let of_all = residues(&all, &vec![1e-4; COUNT]);
        let of_left = residues(&frfs, frfs.variance(0).unwrap());
        for ((a, variance), (b, other)) in of_all.into_iter().zip(of_left) {
            assert!((a - b).norm() < 0.02 * variance.sqrt(), "{a} ± {} against {b}", variance.sqrt());
            assert!((other / variance - 1.0).abs() < 1e-3, "variances {variance:e} and {other:e}");
        }
    }

    #[test]
    fn errors_of_merged_lines_are_as_large_as_their_variances_say_and_independent() {
        let (mut sum, mut together, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..10 {
            let KnownNoise { frfs, .. } = KnownNoise::of(&recorded(truth, 1e-2, seed), None).unwrap();
            let errors = frfs.lines().hz().iter().zip(frfs.values(0)).zip(frfs.variance(0).unwrap());
            let errors: Vec<Complex64> =
                errors.map(|((hz, value), variance)| (value - truth(*hz)) / variance.sqrt()).collect();
            sum += errors.iter().map(|e| e.norm_sqr()).sum::<f64>();
            together += errors.windows(2).map(|e| (e[0] * e[1].conj()).re).sum::<f64>();
            count += errors.len() as f64;
        }
        assert!((sum / count - 1.0).abs() < 0.05, "mean square {}", sum / count);
        assert!((together / count).abs() < 0.03, "correlation {}", together / count);
    }

    #[test]
    fn a_resonance_sharper_than_a_line_keeps_its_lines() {
        let sharp = |hz: f64| 0.3 + 1e-3 * mode(hz, (500.01, 2e-5));
        let KnownNoise { frfs, .. } = KnownNoise::of(&recorded(sharp, 1e-4, 1), None).unwrap();
        let near = frfs.lines().range(499.5, 500.5);
        assert_eq!(near.len(), 21, "all lines of the peak");
        assert!(frfs.lines().len() < COUNT / 8, "{} lines left", frfs.lines().len());
    }

    #[test]
    fn without_noise_what_is_left_lies_on_the_frf() {
        let KnownNoise { frfs, .. } = KnownNoise::of(&recorded(truth, 0.0, 1), None).unwrap();
        assert!(frfs.lines().len() < COUNT / 2, "{} lines left", frfs.lines().len());
        for (hz, value) in frfs.lines().hz().iter().zip(frfs.values(0)) {
            assert!((value - truth(*hz)).norm() < 1e-6 * truth(*hz).norm(), "{value} at {hz} Hz");
        }
    }

    #[test]
    fn what_is_left_stands_for_all_lines_and_squares_over_them_are_those_of_all() {
        let all = recorded(truth, 1e-2, 3);
        let known = KnownNoise::of(&all, None).unwrap();
        assert!((known.stands_for.iter().sum::<f64>() / COUNT as f64 - 1.0).abs() < 1e-9);
        // Of a model that is off by a little everywhere.
        let squares = |set: &FrfSet, lines: &mut dyn Iterator<Item = f64>| -> f64 {
            let values = set.lines().hz().iter().zip(set.values(0)).zip(lines);
            values.map(|((hz, value), lines)| lines * (value - 1.01 * truth(*hz)).norm_sqr()).sum()
        };
        let of_all = squares(&all, &mut std::iter::repeat(1.0));
        let of_left = squares(&known.frfs, &mut known.stands_for.iter().copied());
        let together = of_left + known.taken_out.iter().sum::<f64>();
        assert!((together / of_all - 1.0).abs() < 1e-6, "{together} of {of_all}");
    }

    #[test]
    fn lines_without_coherence_are_not_merged() {
        let mut all = recorded(truth, 1e-2, 3);
        let mut coherence = vec![0.9; COUNT];
        coherence[15_000] = 0.0;
        all.set_coherence(0, coherence).unwrap();
        all.set_averages(0, Some(4));
        let KnownNoise { frfs, noise, .. } = KnownNoise::of(&all, None).unwrap();
        assert_eq!(noise, [NoiseSource::Coherence]);
        let coherence = frfs.coherence(0).unwrap();
        let dead = coherence.iter().position(|gamma2| *gamma2 == 0.0).unwrap();
        assert_eq!(frfs.lines().hz()[dead], all.lines().hz()[15_000]);
    }
}
