//! How a joint's dynamic stiffness depends on frequency, in coordinates that a fit can move.

use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_lumped::Lines;
use num_complex::Complex64;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// How a joint's stiffness and damping depend on frequency. D, K₁ are symmetric matrices of their own, so
/// that every law holds a proportional one and any other distribution of the losses over the elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LawKind {
    /// K, without damping.
    Constant,
    /// K + sC.
    Viscous,
    /// K + iH: losses per cycle that do not depend on frequency (eq 17).
    Structural,
    /// K + D·sτ/(1 + sτ): a spring beside a spring and a dashpot in series.
    StandardLinearSolid,
    /// K + D·s^α, 0 < α < 1: a spring beside a springpot.
    Fractional,
    /// K + K₁·ω + sC.
    LinearStiffness,
}

impl LawKind {
    /// All of them.
    pub const ALL: [LawKind; 6] = [
        LawKind::Constant,
        LawKind::Viscous,
        LawKind::Structural,
        LawKind::StandardLinearSolid,
        LawKind::Fractional,
        LawKind::LinearStiffness,
    ];

    /// As result files write it.
    pub fn name(self) -> &'static str {
        match self {
            LawKind::Constant => "constant",
            LawKind::Viscous => "viscous",
            LawKind::Structural => "structural",
            LawKind::StandardLinearSolid => "standard_linear_solid",
            LawKind::Fractional => "fractional",
            LawKind::LinearStiffness => "linear_stiffness",
        }
    }
}

/// What is asked of one 2×2 matrix of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// The element (1,1) alone: bodies that do not rotate.
    Scalar,
    /// 11, 12, 22.
    Symmetric,
    /// 11, 12, 22, 21.
    Free,
    /// v vᵀ, the boundary of what is positive semidefinite.
    RankOne,
    /// Nothing, the boundary of what is not negative.
    Zero,
}

impl Form {
    pub(super) fn count(self) -> usize {
        match self {
            Form::Scalar => 1,
            Form::Symmetric => 3,
            Form::Free => 4,
            Form::RankOne => 2,
            Form::Zero => 0,
        }
    }

    /// The matrix at these coordinates, in units of its elements.
    fn matrix(self, at: &[f64]) -> RealMatrix2 {
        match (self, at) {
            (Form::Scalar, [a]) => Matrix2::new(*a, 0.0, 0.0, 0.0),
            (Form::Symmetric, [a, b, d]) => Matrix2::new(*a, *b, *b, *d),
            (Form::Free, [a, b, d, c]) => Matrix2::new(*a, *b, *c, *d),
            (Form::RankOne, [v, w]) => Matrix2::new(v * v, v * w, v * w, w * w),
            _ => RealMatrix2::zero(),
        }
    }

    /// Adds derivatives by the coordinates to `slots`, from those by the elements (11, 12, 21, 22).
    #[inline(always)]
    fn chain<T: Lines>(self, at: &[f64], by: [T; 4], slots: &mut [T]) {
        let [p11, p12, p21, p22] = by;
        match (self, at, slots) {
            (Form::Scalar, _, [a]) => *a = p11,
            (Form::Symmetric, _, [a, b, d]) => (*a, *b, *d) = (p11, p12 + p21, p22),
            (Form::Free, _, [a, b, d, c]) => (*a, *b, *d, *c) = (p11, p12, p22, p21),
            (Form::RankOne, [v, w], [a, b]) => {
                *a = p11 * (2.0 * v) + (p12 + p21) * *w;
                *b = (p12 + p21) * *v + p22 * (2.0 * w);
            }
            _ => {}
        }
    }
}

/// A law with the form of its matrices and the units of their elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dynamics {
    pub kind: LawKind,
    /// Form of K.
    pub stiffness: Form,
    /// Form of the damping matrix.
    pub damping: Form,
    /// Form of K₁.
    pub change: Form,
    /// √(k_ii k_jj) of a joint nearby.
    pub unit: RealMatrix2,
    /// Circular frequency in the middle of the band, rad/s: damping matrices are in units of stiffness there.
    pub middle: f64,
}

/// Most coordinates that a law has.
pub(super) const MOST: usize = 12;

impl Dynamics {
    pub(super) fn new(kind: LawKind, unit: RealMatrix2, middle: f64, scalar: bool) -> Self {
        let matrix = if scalar { Form::Scalar } else { Form::Symmetric };
        Dynamics {
            kind,
            stiffness: matrix,
            damping: if kind == LawKind::Constant { Form::Zero } else { matrix },
            change: if kind == LawKind::LinearStiffness { matrix } else { Form::Zero },
            unit,
            middle,
        }
    }

    /// A law of another kind in the same units.
    pub(super) fn of_kind(self, kind: LawKind) -> Self {
        Dynamics::new(kind, self.unit, self.middle, self.stiffness == Form::Scalar)
    }

    /// The same with K and the damping matrix free of symmetry; a law without damping stays without.
    pub(super) fn free(self) -> Self {
        let damping = if self.damping == Form::Zero { Form::Zero } else { Form::Free };
        Dynamics { stiffness: Form::Free, damping, ..self }
    }

    /// Number of elements by which [`free`](Self::free) has more.
    pub(super) fn asymmetries(&self) -> usize {
        1 + usize::from(self.damping != Form::Zero)
    }

    /// Number of coordinates: K, damping, K₁, then ln(ωτ) in the middle of the band, or α − ½.
    pub(super) fn count(&self) -> usize {
        self.stiffness.count() + self.damping.count() + self.change.count() + self.shapes()
    }

    /// Whether the law has a time or an exponent besides its matrices.
    pub(super) fn shapes(&self) -> usize {
        usize::from(matches!(self.kind, LawKind::StandardLinearSolid | LawKind::Fractional))
    }

    /// Which of k11, k12, k22, c11, c12, c22 in the middle of the band its first coordinates are, in their
    /// order.
    pub(super) fn slots(&self) -> &'static [usize] {
        match (self.stiffness == Form::Scalar, self.damping == Form::Zero) {
            (true, true) => &[0],
            (true, false) => &[0, 3],
            (false, true) => &[0, 1, 2],
            (false, false) => &[0, 1, 2, 3, 4, 5],
        }
    }

    fn split<'a>(&self, at: &'a [f64]) -> [&'a [f64]; 4] {
        let (stiffness, rest) = at.split_at(self.stiffness.count());
        let (damping, rest) = rest.split_at(self.damping.count());
        let (change, rest) = rest.split_at(self.change.count());
        [stiffness, damping, change, &rest[..self.shapes()]]
    }

    fn in_units(&self, matrix: RealMatrix2) -> RealMatrix2 {
        let u = &self.unit;
        Matrix2::new(
            matrix.at(0, 0) * u.at(0, 0),
            matrix.at(0, 1) * u.at(0, 1),
            matrix.at(1, 0) * u.at(1, 0),
            matrix.at(1, 1) * u.at(1, 1),
        )
    }

    /// K and the damping matrix as an imaginary stiffness, both in the middle of the band; K₁·ω there. N/m
    /// and so on.
    pub(super) fn matrices(&self, at: &[f64]) -> [RealMatrix2; 3] {
        let [k, d, l, _] = self.split(at);
        [self.stiffness.matrix(k), self.damping.matrix(d), self.change.matrix(l)].map(|m| self.in_units(m))
    }

    /// τ in s, or α.
    pub(super) fn shape(&self, at: &[f64]) -> Option<f64> {
        let [.., shape] = self.split(at);
        let shape = shape.first()?;
        Some(if self.kind == LawKind::Fractional { 0.5 + shape } else { shape.exp() / self.middle })
    }

    /// The same with its standard deviation, from that of its coordinate.
    pub(super) fn shape_with_std(&self, at: &[f64], std: impl Fn(usize) -> f64) -> Option<(f64, f64)> {
        let (shape, own) = (self.shape(at)?, std(self.count() - 1));
        Some((shape, if self.kind == LawKind::Fractional { own } else { shape * own }))
    }

    /// What K₁ is multiplied by: none of it in the middle of the band, so that K is the stiffness there.
    fn change(&self, s: Complex64) -> Complex64 {
        Complex64::from(s.im / self.middle - 1.0)
    }

    /// What the damping matrix is multiplied by: i in the middle of the band, so that K is the stiffness
    /// there and a change of time or exponent leaves it.
    fn losses(&self, s: Complex64, shape: f64) -> Complex64 {
        let relative = s / self.middle;
        match self.kind {
            LawKind::Constant => Complex64::ZERO,
            LawKind::Viscous | LawKind::LinearStiffness => relative,
            LawKind::Structural => Complex64::I,
            LawKind::StandardLinearSolid => {
                let (turned, time) = (relative * shape.exp(), shape.exp());
                turned / (turned + 1.0) * ((1.0 + time * time) / time) - time
            }
            LawKind::Fractional => {
                let angle = FRAC_PI_2 * (0.5 + shape);
                relative.powf(0.5 + shape) / angle.sin() - angle.cos() / angle.sin()
            }
        }
    }

    /// By how much less than K in the middle of the band the law's own K is, as a share of the damping
    /// matrix.
    pub(super) fn stiffening(&self, at: &[f64]) -> f64 {
        let [.., shape] = self.split(at);
        match (self.kind, shape.first()) {
            (LawKind::StandardLinearSolid, Some(x)) => x.exp(),
            (LawKind::Fractional, Some(x)) => (FRAC_PI_2 * (0.5 + x)).tan().recip(),
            _ => 0.0,
        }
    }

    /// What the damping matrix in units of stiffness is multiplied by to be the law's own: C, H, D of the
    /// solid, D of the springpot.
    pub(super) fn own_damping(&self, at: &[f64]) -> f64 {
        let [.., shape] = self.split(at);
        match (self.kind, shape.first()) {
            (LawKind::StandardLinearSolid, Some(x)) => (1.0 + (2.0 * x).exp()) / x.exp(),
            (LawKind::Fractional, Some(x)) => {
                1.0 / ((FRAC_PI_2 * (0.5 + x)).sin() * self.middle.powf(0.5 + x))
            }
            (LawKind::Viscous | LawKind::LinearStiffness, _) => 1.0 / self.middle,
            _ => 1.0,
        }
    }

    /// The law at these coordinates, ready for many lines.
    pub(super) fn placed<'a>(&'a self, at: &'a [f64]) -> Placed<'a> {
        let [.., shape] = self.split(at);
        Placed { law: self, at, matrices: self.matrices(at), shape: shape.first().copied().unwrap_or(0.0) }
    }
}

/// A law with its coordinates.
pub(super) struct Placed<'a> {
    law: &'a Dynamics,
    at: &'a [f64],
    matrices: [RealMatrix2; 3],
    shape: f64,
}

impl Placed<'_> {
    /// Number of coordinates.
    pub(super) fn count(&self) -> usize {
        self.law.count()
    }

    /// K + losses·D + K₁·(ω − ω₀) at s, ω₀ being the middle of the band, on all of these lines.
    #[inline(always)]
    pub(super) fn stiffness<T: Lines>(&self, s: &[Complex64]) -> Matrix2<T> {
        let [k, d, l] = &self.matrices;
        let losses: T = on_lines(s, |s| self.law.losses(s, self.shape));
        let relative: T = on_lines(s, |s| self.law.change(s));
        let at = |i: usize, j: usize| {
            losses * d.at(i, j) + (T::constant(k.at(i, j).into()) + relative * l.at(i, j))
        };
        Matrix2::new(at(0, 0), at(0, 1), at(1, 0), at(1, 1))
    }

    /// Losses at s, their derivative by the law's time or exponent, and what K₁ is multiplied by: what
    /// derivatives need of lines.
    #[inline(always)]
    pub(super) fn factors<T: Lines>(&self, s: &[Complex64]) -> [T; 3] {
        const STEP: f64 = 1e-5;
        let by_shape = match self.law.shapes() {
            0 => T::ZERO,
            _ => on_lines(s, |s| {
                let losses = |shape: f64| self.law.losses(s, shape);
                (losses(self.shape + STEP) - losses(self.shape - STEP)) / (2.0 * STEP)
            }),
        };
        let losses = on_lines(s, |s| self.law.losses(s, self.shape));
        [losses, by_shape, on_lines(s, |s| self.law.change(s))]
    }

    /// Writes derivatives by the coordinates over `slots`, from those by the elements (11, 12, 21, 22) of the
    /// dynamic stiffness.
    #[inline(always)]
    pub(super) fn chain<T: Lines>(&self, by: [T; 4], [losses, by_shape, relative]: [T; 3], slots: &mut [T]) {
        let u = &self.law.unit;
        let scaled = [by[0] * u.at(0, 0), by[1] * u.at(0, 1), by[2] * u.at(1, 0), by[3] * u.at(1, 1)];
        let [k, d, l, _] = self.law.split(self.at);
        let (own, rest) = slots.split_at_mut(k.len());
        self.law.stiffness.chain(k, scaled, own);
        let (own, rest) = rest.split_at_mut(d.len());
        self.law.damping.chain(d, scaled.map(|p| p * losses), own);
        let (own, rest) = rest.split_at_mut(l.len());
        self.law.change.chain(l, scaled.map(|p| p * relative), own);
        if let Some(own) = rest.first_mut() {
            let d = &self.matrices[1];
            let elements = [d.at(0, 0), d.at(0, 1), d.at(1, 0), d.at(1, 1)];
            *own = by_shape * by.into_iter().zip(elements).fold(T::ZERO, |sum, (p, e)| sum + p * e);
        }
    }
}

/// A number on each of these lines.
#[inline(always)]
fn on_lines<T: Lines>(s: &[Complex64], value: impl Fn(Complex64) -> Complex64) -> T {
    let mut all = T::ZERO;
    s.iter().enumerate().for_each(|(line, s)| all.set_line(line, value(*s)));
    all
}

/// Coordinates of K and of an imaginary stiffness D.
pub(super) fn coordinates(law: &Dynamics, k: RealMatrix2, d: RealMatrix2) -> Vec<f64> {
    let of = |form: Form, m: RealMatrix2| {
        let e = |i: usize, j: usize| m.at(i, j) / law.unit.at(i, j);
        match form {
            Form::Scalar => vec![e(0, 0)],
            Form::Symmetric => vec![e(0, 0), 0.5 * (e(0, 1) + e(1, 0)), e(1, 1)],
            Form::Free => vec![e(0, 0), e(0, 1), e(1, 1), e(1, 0)],
            Form::RankOne => rank_one(e(0, 0), 0.5 * (e(0, 1) + e(1, 0)), e(1, 1)),
            Form::Zero => Vec::new(),
        }
    };
    [of(law.stiffness, k), of(law.damping, d)].concat()
}

/// v of the nearest v vᵀ to [[a, b], [b, d]].
fn rank_one(a: f64, b: f64, d: f64) -> Vec<f64> {
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let largest = (mean + half.hypot(b)).max(0.0).sqrt();
    let angle = 0.5 * b.atan2(half);
    vec![largest * angle.cos(), largest * angle.sin()]
}
