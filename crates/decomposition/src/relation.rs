//! The relations (4) to (7) between FRFs across a joint and its compliances.

use jointscope_beam::transport;
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use serde::Serialize;

/// Which relation connects the assembly's FRFs with the joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// k⁻¹ = R α21 H41⁻¹ β43 − β33 − R α22 Rᵀ: the stiffness on d = u_to − R·u_from.
    Exact,
    /// K⁻¹ = α21 H41⁻¹ β43 − α22 − β33 (eq 7), signs included.
    Paper,
}

/// Compliances of the two sides on every line (eq 8–12), rows (y, θ), columns (force, moment).
#[derive(Debug, Clone, PartialEq)]
pub struct Compliances {
    /// Side α at the joint's near end, due to loads at its loaded block's reference point.
    pub alpha21: Vec<ComplexMatrix2>,
    /// Side α at the joint's near end, driving point.
    pub alpha22: Vec<ComplexMatrix2>,
    /// Side β at the joint's far end, driving point.
    pub beta33: Vec<ComplexMatrix2>,
    /// Side β's responding block's reference point, due to loads at the joint's far end.
    pub beta43: Vec<ComplexMatrix2>,
    /// The joint's length L, m.
    pub length: f64,
}

impl Relation {
    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Relation::Exact => "exact",
            Relation::Paper => "paper",
        }
    }

    /// The joint's dynamic stiffness K + sC at one line, s = iω or, with all its matrices, δ + iω; `None`
    /// where a matrix is singular.
    pub fn decompose(
        self,
        h41: ComplexMatrix2,
        alpha21: ComplexMatrix2,
        alpha22: ComplexMatrix2,
        beta33: ComplexMatrix2,
        beta43: ComplexMatrix2,
        length: f64,
    ) -> Option<ComplexMatrix2> {
        h41.inverse()?;
        let stiffness = self.decompose_unchecked(h41, alpha21, alpha22, beta33, beta43, length);
        stiffness.is_finite().then_some(stiffness)
    }

    /// H41 of the assembly from its components (eq 4 in its matrix form, with the transport R); `None` where
    /// a matrix is singular.
    pub fn synthesize(
        stiffness: ComplexMatrix2,
        alpha21: ComplexMatrix2,
        alpha22: ComplexMatrix2,
        beta33: ComplexMatrix2,
        beta43: ComplexMatrix2,
        length: f64,
    ) -> Option<ComplexMatrix2> {
        let across = transport(length).to_complex();
        let total = stiffness.inverse()? + beta33 + across * alpha22 * across.transpose();
        Some(beta43 * total.inverse()? * across * alpha21)
    }

    /// What this relation uses for R: the transport, or the identity of eq (7).
    pub(crate) fn transport(self, length: f64) -> ComplexMatrix2 {
        match self {
            Relation::Exact => transport(length).to_complex(),
            Relation::Paper => Matrix2::identity(),
        }
    }

    // Inlined by force: as a call, its five matrices would be copied for every line, which costs as much as
    // the formula.
    #[inline(always)]
    pub(crate) fn decompose_unchecked(
        self,
        h41: ComplexMatrix2,
        alpha21: ComplexMatrix2,
        alpha22: ComplexMatrix2,
        beta33: ComplexMatrix2,
        beta43: ComplexMatrix2,
        length: f64,
    ) -> ComplexMatrix2 {
        let through = alpha21 * inverse(h41) * beta43;
        inverse(match self {
            Relation::Paper => through - alpha22 - beta33,
            Relation::Exact => carried(length, through) - carried_both(length, alpha22) - beta33,
        })
    }

    /// The joint's dynamic stiffness on all lines, written over `stiffness`; where a matrix is singular the
    /// elements are not finite.
    ///
    /// All slices have one matrix a line; nothing is allocated.
    pub fn decompose_lines(
        self,
        h41: &[ComplexMatrix2],
        sides: &Compliances,
        stiffness: &mut [ComplexMatrix2],
    ) {
        // Told apart here and not line by line, so that either loop is free of branches.
        match self {
            Relation::Paper => on_lines(Relation::Paper, h41, sides, stiffness),
            Relation::Exact => on_lines(Relation::Exact, h41, sides, stiffness),
        }
    }
}

#[inline(always)]
fn on_lines(
    relation: Relation,
    h41: &[ComplexMatrix2],
    sides: &Compliances,
    stiffness: &mut [ComplexMatrix2],
) {
    let Compliances { alpha21, alpha22, beta33, beta43, length } = sides;
    let inputs = h41.iter().zip(alpha21).zip(alpha22).zip(beta33).zip(beta43);
    for (out, ((((h41, alpha21), alpha22), beta33), beta43)) in stiffness.iter_mut().zip(inputs) {
        *out = relation.decompose_unchecked(*h41, *alpha21, *alpha22, *beta33, *beta43, *length);
    }
}

/// The inverse, not finite where the matrix is singular.
///
/// A determinant is squared here, which receptances below 1e-77 m/N would not survive; in exchange there is
/// one division instead of the two in a row of [`Matrix2::inverse_unchecked`].
#[inline(always)]
fn inverse(m: ComplexMatrix2) -> ComplexMatrix2 {
    let [[a, b], [c, d]] = m.0;
    let determinant = a * d - b * c;
    let factor = determinant.conj() * (1.0 / determinant.norm_sqr());
    Matrix2([[d * factor, -b * factor], [-c * factor, a * factor]])
}

/// R m for R = [[1, L],[0, 1]].
#[inline(always)]
fn carried(length: f64, m: ComplexMatrix2) -> ComplexMatrix2 {
    let [[a, b], [c, d]] = m.0;
    Matrix2::new(a + c * length, b + d * length, c, d)
}

/// R m Rᵀ for R = [[1, L],[0, 1]].
#[inline(always)]
fn carried_both(length: f64, m: ComplexMatrix2) -> ComplexMatrix2 {
    let [[a, b], [c, d]] = carried(length, m).0;
    Matrix2::new(a + b * length, b, c + d * length, d)
}
