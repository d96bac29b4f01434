//! Long recordings with fewer lines, which tell the same.
//!
//! A zoomed or padded recording has far more lines than its resonances need. Over a block of neighbouring
//! lines on which every FRF is a polynomial of degree 7 within its noise, the polynomial by least squares
//! tells all that the lines do. It is read at the eight Gauss nodes x_k of the block's lines, with weights
//! W_k: for every other polynomial f of that degree
//!
//! Σ_i |H_i − f(x_i)|² = Σ_k W_k |H(x_k) − f(x_k)|² + what is left of H,
//!
//! and the errors of the eight values are independent, of variance σ²/W_k. A fit to the nodes is thus the fit
//! to the lines. σ² comes from what is left, or from variances or coherence where these are known.
//!
//! Blocks are halved until the last three coefficients of every FRF are noise: the coefficients of a function
//! with poles fall geometrically, so what the first one left out holds is below noise too. Blocks too short
//! for that, at resonances, keep their lines.

mod block;
mod line_noise;

use crate::noise::{self, NoiseSource};
use block::{Basis, Block, NODES};
use jointscope_spectra::{FrfSet, SpectraError, SpectralLines};
use line_noise::LineNoise;
use std::ops::Range;

/// A recording up to so many lines keeps them.
const MANY: usize = 6400;
/// Fewest lines of a block: so many more than nodes that a peak in it does not pass for noise.
const FEWEST: usize = 64;
/// Blocks that a recording is cut into at first.
const BLOCKS: usize = 32;

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
    /// FRF after FRF, each line's part of Σ|ε|² over the recorded lines of what merging took out of them, in
    /// the square of the set's unit.
    pub taken_out: Vec<f64>,
}

impl KnownNoise {
    /// The set with its noise [`known`](noise::known); of more than 6,400 lines, neighbours over which all
    /// FRFs are smooth are merged, none within the `band` (Hz) of interest with one outside.
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

/// What stands for some neighbouring lines.
enum Piece {
    Kept(Range<usize>),
    Merged(Block),
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
        let (all, known) = (frfs.values(frf), LineNoise::of(frfs, frf));
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
        noise.extend(match LineNoise::of(frfs, frf) {
            LineNoise::Variance(_) => None,
            LineNoise::Coherence(..) => Some(NoiseSource::Coherence),
            LineNoise::Scatter => Some(NoiseSource::Scatter),
        });
    }
    Ok(KnownNoise { frfs: set, noise, merged_from: Some(count), stands_for, taken_out })
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;
    use jointscope_spectra::{FrfForm, FrfPair};
    use num_complex::Complex64;

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
