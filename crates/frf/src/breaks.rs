//! Lines at which FRFs break off their course.

use crate::local_rational::LocalRationalFit;
use crate::noise::{FOLLOWED, NEIGHBOURS};
use jointscope_spectra::FrfSet;

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
    let (hz, count) = (frfs.lines().hz(), frfs.pairs().len());
    let mut fit = LocalRationalFit::new();
    let mut breaking = vec![0; hz.len()];
    for index in 0..count {
        let (values, weights) = (frfs.values(index), &weights[index * hz.len()..(index + 1) * hz.len()]);
        for line in 0..hz.len() {
            let Some(local) = fit.about(hz, values, line, NEIGHBOURS) else { continue };
            let off = weights[line] * local.residual.norm_sqr() / (1.0 - local.leverage).max(1e-3);
            breaking[line] += usize::from(local.leverage < FOLLOWED && off > BREAKS);
        }
    }
    (0..hz.len()).filter(|&line| breaking[line] > 0 && 2 * breaking[line] >= count).collect()
}

/// The lines, by index, that at least half of the FRFs have far from where their neighbours on both sides
/// agree that they are: single lines of mains hum and of tones from elsewhere. A peak shows on the lines
/// beside it, however sharp. `weights` as for [`breaks`].
pub fn lone_lines(frfs: &FrfSet, weights: &[f64]) -> Vec<usize> {
    let (hz, count) = (frfs.lines().hz(), frfs.pairs().len());
    let mut fit = LocalRationalFit::new();
    let mut lone = vec![0; hz.len()];
    for index in 0..count {
        let (values, weights) = (frfs.values(index), &weights[index * hz.len()..(index + 1) * hz.len()]);
        for line in 0..hz.len() {
            let Some(expected) = fit.beside(hz, values, line, NEIGHBOURS) else { continue };
            let off = weights[line] * (values[line] - expected.value).norm_sqr() / (1.0 + expected.leverage);
            let beside = 0.5 * (weights[line - 1] + weights[line + 1]) * expected.variance;
            lone[line] += usize::from(off > BREAKS && expected.leverage < CERTAIN && beside < 2.0 * SMOOTH);
        }
    }
    (0..hz.len()).filter(|&line| lone[line] > 0 && 2 * lone[line] >= count).collect()
}
