//! Eq (7) and its exact form by general libraries.

use faer::linalg::solvers::DenseSolveCore;
use jointscope_decomposition::Compliances;
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use nalgebra::Matrix2 as Small;
use num_complex::Complex64;

/// The exact relation with nalgebra's fixed-size matrices and `try_inverse`.
pub(crate) struct Nalgebra {
    h41: Vec<Small<Complex64>>,
    sides: [Vec<Small<Complex64>>; 4],
    across: Small<Complex64>,
    out: Vec<Small<Complex64>>,
}

impl Nalgebra {
    /// The same input in the library's own type.
    pub(crate) fn new(h41: &[ComplexMatrix2], sides: &Compliances) -> Self {
        let own = |matrices: &[ComplexMatrix2]| -> Vec<Small<Complex64>> {
            matrices.iter().map(|m| Small::new(m.at(0, 0), m.at(0, 1), m.at(1, 0), m.at(1, 1))).collect()
        };
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        Nalgebra {
            h41: own(h41),
            sides: [&sides.alpha21, &sides.alpha22, &sides.beta33, &sides.beta43].map(|m| own(m)),
            across: Small::new(one, Complex64::new(sides.length, 0.0), zero, one),
            out: vec![Small::zeros(); h41.len()],
        }
    }

    /// All lines, into memory that is kept.
    pub(crate) fn decompose_lines(&mut self) {
        let nan = Small::repeat(Complex64::new(f64::NAN, f64::NAN));
        let (r, [alpha21, alpha22, beta33, beta43]) = (self.across, &self.sides);
        for (line, out) in self.out.iter_mut().enumerate() {
            let inverse = self.h41[line].try_inverse().unwrap_or(nan);
            let through = r * alpha21[line] * inverse * beta43[line];
            let near = r * alpha22[line] * r.transpose();
            *out = (through - beta33[line] - near).try_inverse().unwrap_or(nan);
        }
    }

    /// The result at one line.
    pub(crate) fn at(&self, line: usize) -> ComplexMatrix2 {
        let m = &self.out[line];
        Matrix2::new(m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)])
    }
}

/// The exact relation with faer's matrices and partially pivoted LU.
pub(crate) fn faer_line(
    h41: ComplexMatrix2,
    alpha21: ComplexMatrix2,
    alpha22: ComplexMatrix2,
    beta33: ComplexMatrix2,
    beta43: ComplexMatrix2,
    length: f64,
) -> ComplexMatrix2 {
    let own = |m: ComplexMatrix2| faer::Mat::from_fn(2, 2, |i, j| m.at(i, j));
    let zero_one = [Complex64::ZERO, Complex64::ONE];
    let across = Matrix2::new(zero_one[1], Complex64::new(length, 0.0), zero_one[0], zero_one[1]);
    let r = own(across);
    let through = &r * own(alpha21) * own(h41).partial_piv_lu().inverse() * own(beta43);
    let near = &r * own(alpha22) * r.transpose();
    let k = (through - own(beta33) - near).partial_piv_lu().inverse();
    Matrix2::new(k[(0, 0)], k[(0, 1)], k[(1, 0)], k[(1, 1)])
}

/// The exact relation on all lines with faer.
pub(crate) fn faer_lines(h41: &[ComplexMatrix2], sides: &Compliances, out: &mut [ComplexMatrix2]) {
    for (line, out) in out.iter_mut().enumerate() {
        let s = sides;
        let (alpha21, alpha22) = (s.alpha21[line], s.alpha22[line]);
        *out = faer_line(h41[line], alpha21, alpha22, s.beta33[line], s.beta43[line], s.length);
    }
}
