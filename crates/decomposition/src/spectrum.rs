//! A joint's compliances line by line, by one of the relations (4) to (7).

use crate::settings::spectra::{INDICATIVE_NOISE, SINGULAR_CONDITION};
use crate::{Compliances, CrossingFrfs, DecompositionError, Relation, Sides};
use jointscope_frf::{BlockFrf, MaskReason, fit_rigid_motion};
use jointscope_linalg::{ComplexMatrix2, Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use serde::Serialize;

/// The joint at one spectral line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointLine {
    /// Index of the line in the recording.
    #[serde(skip)]
    pub line: usize,
    /// Its frequency, Hz.
    pub frequency: f64,
    /// K = Re of the dynamic stiffness K + sC (eq 33), under an exponential window less δC: N/m, N/rad;
    /// N·m/m, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C = Im/ω (eq 38): N·s/m and so on.
    pub damping: RealMatrix2,
    /// Standard deviation of each element of K; absent where the FRFs carry no variances.
    #[serde(skip)]
    pub stiffness_std: Option<RealMatrix2>,
    /// Standard deviation of each element of C.
    #[serde(skip)]
    pub damping_std: Option<RealMatrix2>,
    /// By how much relative errors of the FRFs and compliances are multiplied in the worst element of K, at
    /// the most.
    pub condition: f64,
}

impl JointLine {
    /// The largest standard deviation of an element of K relative to √|k_ii k_jj|; zero without variances.
    pub fn noise_share(&self) -> f64 {
        let Some(std) = self.stiffness_std else { return 0.0 };
        let size = |i: usize| self.stiffness.at(i, i).abs().sqrt();
        let mut worst = 0.0_f64;
        for i in 0..2 {
            for j in 0..2 {
                if std.at(i, j) > 0.0 {
                    worst = worst.max(std.at(i, j) / (size(i) * size(j)));
                }
            }
        }
        worst
    }

    /// Whether noise dominates the line, so that its first-order intervals are only indicative.
    pub fn is_noisy(&self) -> bool {
        self.noise_share() > INDICATIVE_NOISE
    }
}

/// A joint's stiffness and damping over the lines of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSpectrum {
    /// The relation used.
    pub relation: Relation,
    /// Receptances of side β's block due to loads on side α's, at s.
    pub h41: BlockFrf,
    /// Decay δ of the exponential window over force and responses, 1/s; 0 without one. Everything holds at
    /// s = δ + iω.
    pub decay: f64,
    /// Compliances of the sides.
    pub sides: Compliances,
    /// Lines that were solved, ascending.
    pub solved: Vec<JointLine>,
    /// Lines that were not, by index, ascending.
    pub masked: Vec<(usize, MaskReason)>,
    /// Whether the blocks do not rotate: only the elements (1,1) mean anything then (eq 5).
    pub scalar: bool,
}

/// Reasons with the lines that they mask, each once, in the order in which they come.
pub(crate) fn counted<R: Copy + PartialEq>(masked: &[(usize, R)]) -> Vec<(R, usize)> {
    let mut all: Vec<(R, usize)> = Vec::new();
    for (_, reason) in masked {
        match all.iter_mut().find(|(other, _)| other == reason) {
            Some((_, count)) => *count += 1,
            None => all.push((*reason, 1)),
        }
    }
    all
}

impl JointSpectrum {
    /// Reasons for masked lines with their counts, in words; empty where none was masked.
    pub fn masked_summary(&self) -> Vec<(MaskReason, usize)> {
        counted(&self.masked)
    }

    /// K and C of the dynamic stiffness K + sC on a line of the recording: C = Im/ω, K = Re − δC.
    pub fn stiffness_and_damping(&self, line: usize, dynamic: ComplexMatrix2) -> (RealMatrix2, RealMatrix2) {
        parts(dynamic, self.decay, self.h41.lines.omega(line))
    }
}

fn parts(dynamic: ComplexMatrix2, decay: f64, omega: f64) -> (RealMatrix2, RealMatrix2) {
    let damping = dynamic.im().map(|e| e / omega);
    (dynamic.re() - damping.scale(decay), damping)
}

/// Finds K(ω) and C(ω) of the joint that `sides` were taken apart at (eq 7 or its exact form).
///
/// Standard deviations follow to first order from the variances that `frfs` carries; they are those of the
/// noise alone, with the fixture taken as exact.
///
/// # Errors
/// A recording that lacks FRFs, sides that cannot be modelled, or not one line that can be solved.
pub fn decompose(
    frfs: &FrfSet,
    sides: &Sides,
    relation: Relation,
) -> Result<JointSpectrum, DecompositionError> {
    let plan = CrossingFrfs::of(frfs, sides)?;
    let h41 = read_at_s(fit_rigid_motion(frfs, &plan.layout)?, sides);
    let compliances = sides.compliances(
        frfs.lines(),
        (plan.loaded.0, plan.loaded.1),
        (plan.responding.0, plan.responding.1),
    )?;
    spectrum((h41, sides.decay()), compliances, relation, plan.is_scalar())
}

/// Receptances at s from those that were made of accelerances by −1/ω².
pub(crate) fn read_at_s(mut h41: BlockFrf, sides: &Sides) -> BlockFrf {
    for (line, omega) in h41.lines.omegas().enumerate() {
        let factor = sides.integrated_at_s(omega);
        h41.values[line] = h41.values[line].map(|e| e * factor);
        if let Some(covariance) = &mut h41.covariance {
            covariance[line].iter_mut().flatten().for_each(|v| *v *= factor.norm_sqr());
        }
    }
    h41
}

fn spectrum(
    (h41, decay): (BlockFrf, f64),
    sides: Compliances,
    relation: Relation,
    scalar: bool,
) -> Result<JointSpectrum, DecompositionError> {
    let count = h41.lines.len();
    let mut stiffness = vec![Matrix2::zero(); count];
    if scalar {
        stiffness.iter_mut().enumerate().for_each(|(line, k)| {
            *k = scalar_stiffness(relation, h41.values[line], &sides, line);
        });
    } else {
        relation.decompose_lines(&h41.values, &sides, &mut stiffness);
    }
    let mut reasons = vec![None; count];
    h41.masked.iter().for_each(|(line, reason)| reasons[*line] = Some(*reason));
    let mut solved = Vec::with_capacity(count);
    for line in 0..count {
        if reasons[line].is_some() {
            continue;
        }
        let h = h41.values[line];
        let singular =
            if scalar { h.at(0, 0) == Complex64::ZERO } else { h.balanced_condition() > SINGULAR_CONDITION };
        if singular || !stiffness[line].is_finite() {
            reasons[line] = Some(MaskReason::SingularFrf);
            continue;
        }
        solved.push(joint_line(line, stiffness[line], (&h41, decay), &sides, relation, scalar));
    }
    let masked: Vec<_> = reasons.iter().enumerate().filter_map(|(line, r)| r.map(|r| (line, r))).collect();
    let spectrum = JointSpectrum { relation, h41, decay, sides, solved, masked, scalar };
    if spectrum.solved.is_empty() {
        let reasons: Vec<String> =
            spectrum.masked_summary().iter().map(|(r, n)| format!("{} ({n})", r.why())).collect();
        return Err(DecompositionError::NothingSolved { lines: count, reasons: reasons.join(", ") });
    }
    Ok(spectrum)
}

/// Eq (5): both sides and the joint are scalars, in the element (1,1).
pub(crate) fn scalar_stiffness(
    relation: Relation,
    h41: ComplexMatrix2,
    sides: &Compliances,
    line: usize,
) -> ComplexMatrix2 {
    let across = relation.transport(sides.length);
    let near = across * sides.alpha22[line] * across.transpose();
    let through = (across * sides.alpha21[line]).at(0, 0) * sides.beta43[line].at(0, 0) / h41.at(0, 0);
    let mut stiffness = Matrix2::zero();
    stiffness.0[0][0] = (through - near.at(0, 0) - sides.beta33[line].at(0, 0)).inv();
    stiffness
}

/// The dynamic stiffness that a spectrum's relation makes of another H41 and other sides, on one line; not
/// finite where a matrix is singular.
pub(crate) fn dynamic_stiffness_on(
    spectrum: &JointSpectrum,
    h41: ComplexMatrix2,
    sides: &Compliances,
    line: usize,
) -> ComplexMatrix2 {
    if spectrum.scalar {
        return scalar_stiffness(spectrum.relation, h41, sides, line);
    }
    let (a21, a22, b33, b43) =
        (sides.alpha21[line], sides.alpha22[line], sides.beta33[line], sides.beta43[line]);
    spectrum.relation.decompose_unchecked(h41, a21, a22, b33, b43, sides.length)
}

/// How an error of H41 reaches the joint: δk = P δH Q, with P = k R α21 H⁻¹ and Q = H⁻¹ β43 k.
pub(crate) fn sensitivity(
    stiffness: ComplexMatrix2,
    h41: ComplexMatrix2,
    alpha21: ComplexMatrix2,
    beta43: ComplexMatrix2,
    across: ComplexMatrix2,
    scalar: bool,
) -> (ComplexMatrix2, ComplexMatrix2) {
    let inverse = if scalar {
        Matrix2::new(h41.at(0, 0).inv(), Complex64::ZERO, Complex64::ZERO, Complex64::ZERO)
    } else {
        h41.inverse_unchecked()
    };
    (stiffness * across * alpha21 * inverse, inverse * beta43 * stiffness)
}

/// Standard deviation of the real (and of the imaginary) part of each element of k: the noise of an FRF is
/// circular, the map from H to k is analytic, so k's noise is circular too.
pub(crate) fn element_std(p: ComplexMatrix2, q: ComplexMatrix2, covariance: &[[f64; 4]; 4]) -> RealMatrix2 {
    let mut std = Matrix2::zero();
    for i in 0..2 {
        for j in 0..2 {
            let mut weight = [Complex64::ZERO; 4];
            for a in 0..2 {
                for b in 0..2 {
                    weight[2 * a + b] = p.at(i, a) * q.at(b, j);
                }
            }
            let mut variance = 0.0;
            for m in 0..4 {
                for n in 0..4 {
                    variance += (weight[m] * weight[n].conj()).re * covariance[m][n];
                }
            }
            std.0[i][j] = (0.5 * variance.max(0.0)).sqrt();
        }
    }
    std
}

fn joint_line(
    line: usize,
    stiffness: ComplexMatrix2,
    (h41, decay): (&BlockFrf, f64),
    sides: &Compliances,
    relation: Relation,
    scalar: bool,
) -> JointLine {
    let omega = h41.lines.omega(line);
    let across = relation.transport(sides.length);
    let h = h41.values[line];
    let (p, q) = sensitivity(stiffness, h, sides.alpha21[line], sides.beta43[line], across, scalar);
    let part_std = h41.covariance.as_ref().map(|covariance| element_std(p, q, &covariance[line]));
    let (real, damping) = parts(stiffness, decay, omega);
    JointLine {
        line,
        frequency: h41.lines.hz()[line],
        stiffness: real,
        damping,
        // Re and Im have independent errors of one size.
        stiffness_std: part_std.map(|std| std.scale((decay / omega).hypot(1.0))),
        damping_std: part_std.map(|std| std.map(|e| e / omega)),
        condition: condition(stiffness, h, p, q, sides, line, across, scalar),
    }
}

/// max_ij (|P| |H| |Q| + |k| (|β33| + |R α22 Rᵀ|) |k|)_ij / |k_ij|: the componentwise condition number of
/// the relation, whatever the units.
#[allow(clippy::too_many_arguments)]
fn condition(
    stiffness: ComplexMatrix2,
    h: ComplexMatrix2,
    p: ComplexMatrix2,
    q: ComplexMatrix2,
    sides: &Compliances,
    line: usize,
    across: ComplexMatrix2,
    scalar: bool,
) -> f64 {
    let size = |m: ComplexMatrix2| m.map(|e| e.norm());
    let k = size(stiffness);
    let near = size(across * sides.alpha22[line] * across.transpose());
    let all = size(p) * size(h) * size(q) + k * (size(sides.beta33[line]) + near) * k;
    let elements: &[(usize, usize)] = if scalar { &[(0, 0)] } else { &[(0, 0), (0, 1), (1, 0), (1, 1)] };
    elements.iter().map(|&(i, j)| all.at(i, j) / k.at(i, j)).fold(0.0, f64::max)
}
