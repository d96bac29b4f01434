//! A joint's K and C as means over a band, plain (35, 42) and weighted, with the deviations that noise gives
//! them.

use crate::spectrum::{element_std, sensitivity};
use crate::{DecompositionError, JointSpectrum, Relation};
use jointscope_averaging::{AveragingError, Band, mean, quietest_band, weighted_mean};
use jointscope_linalg::{ComplexMatrix2, Matrix2, RealMatrix2};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Averaged K and C with the standard deviations that the FRFs' noise gives them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixAverage {
    /// K, N/m and so on.
    pub stiffness: RealMatrix2,
    /// C, N·s/m and so on.
    pub damping: RealMatrix2,
    /// Standard deviations of K.
    pub stiffness_std: RealMatrix2,
    /// Standard deviations of C.
    pub damping_std: RealMatrix2,
}

/// Averages of a joint's spectrum over a band.
#[derive(Debug, Clone, PartialEq)]
pub struct Averages {
    /// The band, Hz.
    pub band: Band,
    /// Number of lines in it that could be solved.
    pub lines: usize,
    /// Plain means (eq 35, 42).
    pub plain: MatrixAverage,
    /// Means with weights of one over the variances that a constant joint would give; absent without
    /// variances.
    pub weighted: Option<MatrixAverage>,
}

impl Averages {
    /// Averages over `band`, or over the band in which plain means come out most precise.
    ///
    /// The weights are those of `model`, a dynamic stiffness K and C for the exact relation: taken from the
    /// measured values themselves they would be biased.
    ///
    /// # Errors
    /// A band without usable lines.
    pub fn of(
        spectrum: &JointSpectrum,
        band: Option<Band>,
        model: (RealMatrix2, RealMatrix2),
    ) -> Result<Self, DecompositionError> {
        let frequencies: Vec<f64> = spectrum.solved.iter().map(|l| l.frequency).collect();
        let expected = expected_std(spectrum, model);
        let band = match (band, &expected) {
            (Some(band), _) => band,
            (None, Some(expected)) => {
                let elements = elements(spectrum.scalar);
                let column = |&(i, j): &(usize, usize)| expected.iter().map(|s| s.at(i, j)).collect();
                quietest_band(&frequencies, &elements.iter().map(column).collect::<Vec<_>>())?
            }
            (None, None) => {
                let ends = frequencies.first().zip(frequencies.last());
                let (&from, &to) = ends.ok_or(AveragingError::NoLines)?;
                Band { from, to }
            }
        };
        let range = band.lines(&frequencies)?;
        // Deviations of single lines are made from their own readings; the model's are free of that.
        let own = |line: usize| {
            let solved = &spectrum.solved[line];
            solved.damping_std.map_or(RealMatrix2::zero(), |std| std.scale(TAU * solved.frequency))
        };
        let of_line = |line: usize| expected.as_ref().map_or_else(|| own(line), |e| e[line]);
        let plain = average(spectrum, range.clone(), |line, i, j| of_line(line).at(i, j), mean)?;
        let weighted = match &expected {
            Some(expected) => {
                Some(average(spectrum, range.clone(), |line, i, j| expected[line].at(i, j), weighted_mean)?)
            }
            None => None,
        };
        Ok(Averages { band, lines: range.len(), plain, weighted })
    }
}

fn elements(scalar: bool) -> &'static [(usize, usize)] {
    if scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 0), (1, 1)] }
}

type Mean = fn(&[f64], &[f64]) -> Result<jointscope_averaging::Average, AveragingError>;

/// Averages every element over the solved lines in `range`; `std` is that of the dynamic stiffness's real
/// part and of its imaginary one.
fn average(
    spectrum: &JointSpectrum,
    range: std::ops::Range<usize>,
    std: impl Fn(usize, usize, usize) -> f64,
    mean: Mean,
) -> Result<MatrixAverage, AveragingError> {
    let zero = RealMatrix2::zero();
    let mut result = MatrixAverage { stiffness: zero, damping: zero, stiffness_std: zero, damping_std: zero };
    let omega = |line: usize| TAU * spectrum.solved[line].frequency;
    for &(i, j) in elements(spectrum.scalar) {
        let lines = || range.clone();
        let k: Vec<f64> = lines().map(|l| spectrum.solved[l].stiffness.at(i, j)).collect();
        let c: Vec<f64> = lines().map(|l| spectrum.solved[l].damping.at(i, j)).collect();
        let k_std: Vec<f64> =
            lines().map(|l| std(l, i, j) * (spectrum.decay / omega(l)).hypot(1.0)).collect();
        let c_std: Vec<f64> = lines().map(|l| std(l, i, j) / omega(l)).collect();
        let (k, c) = (mean(&k, &k_std)?, mean(&c, &c_std)?);
        (result.stiffness.0[i][j], result.stiffness_std.0[i][j]) = (k.value, k.std);
        (result.damping.0[i][j], result.damping_std.0[i][j]) = (c.value, c.std);
    }
    Ok(result)
}

/// Standard deviations of the real (and of the imaginary) part of the dynamic stiffness's elements on each
/// solved line if the joint were `model`; `None` without variances.
fn expected_std(spectrum: &JointSpectrum, model: (RealMatrix2, RealMatrix2)) -> Option<Vec<RealMatrix2>> {
    let covariance = spectrum.h41.covariance.as_ref()?;
    let sides = &spectrum.sides;
    let across = spectrum.relation.transport(sides.length);
    let std = spectrum.solved.iter().map(|solved| {
        let line = solved.line;
        let s = Complex64::new(spectrum.decay, spectrum.h41.lines.omega(line));
        let joint = dynamic_stiffness(model, s);
        let modelled = if spectrum.scalar { None } else { modelled(spectrum, joint, line) };
        // A model with a singular line falls back on what was measured there.
        let (h41, stiffness) = modelled.unwrap_or_else(|| {
            (spectrum.h41.values[line], dynamic_stiffness((solved.stiffness, solved.damping), s))
        });
        let (p, q) =
            sensitivity(stiffness, h41, sides.alpha21[line], sides.beta43[line], across, spectrum.scalar);
        element_std(p, q, &covariance[line])
    });
    Some(std.collect())
}

/// H41 and what the spectrum's relation makes of it, for a joint of dynamic stiffness `joint`.
fn modelled(
    spectrum: &JointSpectrum,
    joint: ComplexMatrix2,
    line: usize,
) -> Option<(ComplexMatrix2, ComplexMatrix2)> {
    let s = &spectrum.sides;
    let (a21, a22, b33, b43) = (s.alpha21[line], s.alpha22[line], s.beta33[line], s.beta43[line]);
    let h41 = Relation::synthesize(joint, a21, a22, b33, b43, s.length)?;
    Some((h41, spectrum.relation.decompose(h41, a21, a22, b33, b43, s.length)?))
}

/// k + s·c.
pub(crate) fn dynamic_stiffness((k, c): (RealMatrix2, RealMatrix2), s: Complex64) -> ComplexMatrix2 {
    let element = |i: usize, j: usize| s * c.at(i, j) + k.at(i, j);
    Matrix2::new(element(0, 0), element(0, 1), element(1, 0), element(1, 1))
}
