//! Lines at which FRFs break off their course.

use crate::local_rational::LocalRationalFit;
use crate::noise::{FOLLOWED, NEIGHBOURS};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// χ² of a line against its neighbours from which it breaks off.
const BREAKS: f64 = 200.0;
/// χ² per value of the neighbours about their own course, up to which they say what lies between them.
const SMOOTH: f64 = 4.0;
/// Variance of what they say, for noise of variance 1, up to which a sharp peak may not lie there unseen.
const CERTAIN: f64 = 1.5;

/// The lines, by index, on which at least half of the FRFs break off their course: as they do at the edges of
/// mains hum and of peaks that were clipped, and where no mode of a structure makes them. `weights` are
/// 1/variance of the real part, and of the imaginary part, FRF after FRF.
pub fn breaks(frfs: &FrfSet, weights: &[f64]) -> Vec<usize> {
    let (hz, mut fit) = (frfs.lines().hz(), LocalRationalFit::new());
    let having = frfs_having(frfs, weights, |values, weights, line| {
        fit.about(hz, values, line, NEIGHBOURS).is_some_and(|local| {
            let off = weights[line] * local.residual.norm_sqr() / (1.0 - local.leverage).max(1e-3);
            local.leverage < FOLLOWED && off > BREAKS
        })
    });
    in_at_least(half_of(frfs), &having)
}

/// The lines, by index, that any of the FRFs has far from where their neighbours on both sides agree that they
/// are, as where a value was spoilt by itself; and those of them that at least half of the FRFs have there:
/// single lines of mains hum and of tones from elsewhere. A peak shows on the lines beside it, however sharp.
/// `weights` as for [`breaks`].
pub fn lone_lines(frfs: &FrfSet, weights: &[f64]) -> [Vec<usize>; 2] {
    let (hz, mut fit) = (frfs.lines().hz(), LocalRationalFit::new());
    let having = frfs_having(frfs, weights, |values, weights, line| {
        fit.beside(hz, values, line, NEIGHBOURS).is_some_and(|expected| {
            let off = weights[line] * (values[line] - expected.value).norm_sqr() / (1.0 + expected.leverage);
            let beside = 0.5 * (weights[line - 1] + weights[line + 1]) * expected.variance;
            off > BREAKS && expected.leverage < CERTAIN && beside < 2.0 * SMOOTH
        })
    });
    [1, half_of(frfs)].map(|least| in_at_least(least, &having))
}

fn half_of(frfs: &FrfSet) -> usize {
    frfs.pairs().len().div_ceil(2)
}

/// How many of the FRFs, by their values and weights, have each line `off`.
fn frfs_having(
    frfs: &FrfSet,
    weights: &[f64],
    mut off: impl FnMut(&[Complex64], &[f64], usize) -> bool,
) -> Vec<usize> {
    let (lines, count) = (frfs.lines().len(), frfs.pairs().len());
    let mut having = vec![0; lines];
    for index in 0..count {
        let (values, weights) = (frfs.values(index), &weights[index * lines..(index + 1) * lines]);
        having.iter_mut().enumerate().for_each(|(line, n)| *n += usize::from(off(values, weights, line)));
    }
    having
}

/// The lines, by index, that at least so many of the FRFs have off.
fn in_at_least(least: usize, having: &[usize]) -> Vec<usize> {
    (0..having.len()).filter(|&line| having[line] >= least).collect()
}
