//! What record 12 holds.

use num_complex::Complex64;

use super::header::Form;
use crate::Data;

/// What record 12 holds, taken apart.
pub(super) struct Values {
    /// The abscissa where its spacing is uneven.
    pub(super) abscissa: Vec<f64>,
    pub(super) data: Data,
}

impl Values {
    /// Takes apart numbers that follow one another as in the file: abscissa if uneven, real part, imaginary
    /// part.
    pub(super) fn from_interleaved(numbers: Vec<f64>, form: &Form) -> Self {
        let abscissa = |stride| numbers.iter().copied().step_by(stride).collect();
        match (form.even, form.complex) {
            (true, false) => Values { abscissa: Vec::new(), data: Data::Real(numbers) },
            (true, true) => {
                let pairs = numbers.as_chunks().0.iter().map(|&[re, im]| Complex64::new(re, im)).collect();
                Values { abscissa: Vec::new(), data: Data::Complex(pairs) }
            }
            (false, false) => {
                let ordinates = numbers.iter().copied().skip(1).step_by(2).collect();
                Values { abscissa: abscissa(2), data: Data::Real(ordinates) }
            }
            (false, true) => {
                let pairs = numbers.as_chunks().0.iter().map(|&[_, re, im]| Complex64::new(re, im)).collect();
                Values { abscissa: abscissa(3), data: Data::Complex(pairs) }
            }
        }
    }
}
