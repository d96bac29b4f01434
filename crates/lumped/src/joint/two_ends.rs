//! A matrix on the motions of both ends of a joint.

use crate::lanes::Lines;
use jointscope_beam::transport;
use jointscope_linalg::Matrix2;

/// A complex 4×4 matrix on (y, θ) at the joint's near end, (y, θ) at its far end, by 2×2 blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TwoEnds<T> {
    pub(super) near: Matrix2<T>,
    pub(super) cross: Matrix2<T>,
    pub(super) far: Matrix2<T>,
}

impl<T: Lines> TwoEnds<T> {
    /// `[−R, I]ᵀ k [−R, I]`.
    #[inline(always)]
    pub(crate) fn from_end(stiffness: Matrix2<T>, length: f64) -> Self {
        let transport = transport(length).map(|element| T::ONE * element);
        let back = transport.transpose() * stiffness;
        TwoEnds { near: back * transport, cross: back.map(|e| -e), far: stiffness }
    }

    /// The element in row `i`, column `j` of the 4×4 matrix.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize, j: usize) -> T {
        match (i / 2, j / 2) {
            (0, 0) => self.near.at(i, j),
            (0, _) => self.cross.at(i, j - 2),
            (_, 0) => self.cross.at(j, i - 2),
            _ => self.far.at(i - 2, j - 2),
        }
    }

    #[inline(always)]
    pub(super) fn add_half_masses(&mut self, inertia: T) {
        self.near.0[0][0] = self.near.0[0][0] + inertia;
        self.far.0[0][0] = self.far.0[0][0] + inertia;
    }

    /// With a spring in series with a motion (y, θ) of one end.
    #[inline(always)]
    pub(super) fn in_series_with(self, at_far_end: bool, [y, theta]: [f64; 2], spring: T) -> Self {
        let first = 2 * usize::from(at_far_end);
        let column = [0, 1, 2, 3].map(|i| self.at(i, first) * y + self.at(i, first + 1) * theta);
        let factor = (spring + column[first] * y + column[first + 1] * theta).reciprocal();
        let [a, b, c, d] = column;
        let [fa, fb, fc, fd] = [a * factor, b * factor, c * factor, d * factor];
        let [[n00, n01], [_, n11]] = self.near.0;
        let [[c00, c01], [c10, c11]] = self.cross.0;
        let [[f00, f01], [_, f11]] = self.far.0;
        let (n01, f01) = (n01 - a * fb, f01 - c * fd);
        TwoEnds {
            near: Matrix2::new(n00 - a * fa, n01, n01, n11 - b * fb),
            cross: Matrix2::new(c00 - a * fc, c01 - a * fd, c10 - b * fc, c11 - b * fd),
            far: Matrix2::new(f00 - c * fc, f01, f01, f11 - d * fd),
        }
    }
}
