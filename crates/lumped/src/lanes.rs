//! Spectral lines side by side: what the processor can compute at once.
//!
//! Everything that a line costs is written once, for a complex number [`Lines`], and runs on a single one or
//! on [`Lanes`] of several.

use jointscope_linalg::Field;
use num_complex::Complex64;
use std::ops::{Add, Mul, Neg, Sub};

/// Lines that are computed together.
pub(crate) const WIDTH: usize = 4;

/// A complex number on one spectral line, or one on each of several.
pub trait Lines: Field + Mul<f64, Output = Self> {
    /// How many lines.
    const COUNT: usize;
    /// A real number on each line.
    type Sizes: Copy;
    /// These values, the last of which stands on the lines that are left over. There must be one at least.
    fn of(values: &[Complex64]) -> Self;
    /// Writes the first lines over `to`.
    fn write(&self, to: &mut [Complex64]);
    /// The same number on all lines.
    fn constant(value: Complex64) -> Self;
    /// The number on line `index`.
    fn line(&self, index: usize) -> Complex64;
    /// Writes the number on line `index`.
    fn set_line(&mut self, index: usize, value: Complex64);
    /// |z|² on each line.
    fn sizes(self) -> Self::Sizes;
    /// The larger of two on each line.
    fn larger(a: Self::Sizes, b: Self::Sizes) -> Self::Sizes;
    /// Whether on every line `a` is more than `share` of `b`; never where one is not a number.
    fn all_exceed(a: Self::Sizes, share: f64, b: Self::Sizes) -> bool;
}

impl Lines for Complex64 {
    const COUNT: usize = 1;
    type Sizes = f64;

    #[inline(always)]
    fn of(values: &[Complex64]) -> Self {
        values[0]
    }

    #[inline(always)]
    fn write(&self, to: &mut [Complex64]) {
        to[0] = *self;
    }

    #[inline(always)]
    fn constant(value: Complex64) -> Self {
        value
    }

    #[inline(always)]
    fn line(&self, _: usize) -> Complex64 {
        *self
    }

    #[inline(always)]
    fn set_line(&mut self, _: usize, value: Complex64) {
        *self = value;
    }

    #[inline(always)]
    fn sizes(self) -> f64 {
        self.norm_sqr()
    }

    #[inline(always)]
    fn larger(a: f64, b: f64) -> f64 {
        if b > a { b } else { a }
    }

    #[inline(always)]
    fn all_exceed(a: f64, share: f64, b: f64) -> bool {
        a > share * b
    }
}

/// A complex number on each of four lines.
#[derive(Debug, Clone, Copy)]
pub struct Lanes {
    re: [f64; WIDTH],
    im: [f64; WIDTH],
}

impl Lanes {
    /// Whether all numbers on all lines are finite.
    #[inline(always)]
    pub(crate) fn all_finite(values: &[Lanes]) -> bool {
        // Zero times what is not finite is not zero; a sum for each line, so that none waits for the others.
        let mut nothing = [0.0; WIDTH];
        for value in values {
            for lane in 0..WIDTH {
                nothing[lane] += 0.0 * value.re[lane] + 0.0 * value.im[lane];
            }
        }
        nothing.iter().sum::<f64>() == 0.0
    }

    /// Writes all lines over the first of `re` and `im`.
    #[inline(always)]
    pub(crate) fn write_parts(&self, re: &mut [f64], im: &mut [f64]) {
        re[..WIDTH].copy_from_slice(&self.re);
        im[..WIDTH].copy_from_slice(&self.im);
    }
}

impl Lines for Lanes {
    const COUNT: usize = WIDTH;
    type Sizes = [f64; WIDTH];

    #[inline(always)]
    fn of(values: &[Complex64]) -> Self {
        let all: [Complex64; WIDTH] = match values.first_chunk() {
            Some(all) => *all,
            None => std::array::from_fn(|lane| values[lane.min(values.len() - 1)]),
        };
        Lanes { re: all.map(|value| value.re), im: all.map(|value| value.im) }
    }

    #[inline(always)]
    fn write(&self, to: &mut [Complex64]) {
        for ((to, re), im) in to.iter_mut().zip(self.re).zip(self.im) {
            *to = Complex64::new(re, im);
        }
    }

    #[inline(always)]
    fn constant(value: Complex64) -> Self {
        Lanes { re: [value.re; WIDTH], im: [value.im; WIDTH] }
    }

    #[inline(always)]
    fn line(&self, index: usize) -> Complex64 {
        Complex64::new(self.re[index], self.im[index])
    }

    #[inline(always)]
    fn set_line(&mut self, index: usize, value: Complex64) {
        (self.re[index], self.im[index]) = (value.re, value.im);
    }

    #[inline(always)]
    fn sizes(self) -> [f64; WIDTH] {
        let mut sizes = [0.0; WIDTH];
        for lane in 0..WIDTH {
            sizes[lane] = self.re[lane] * self.re[lane] + self.im[lane] * self.im[lane];
        }
        sizes
    }

    #[inline(always)]
    fn larger(a: [f64; WIDTH], b: [f64; WIDTH]) -> [f64; WIDTH] {
        let mut larger = a;
        for lane in 0..WIDTH {
            larger[lane] = if b[lane] > a[lane] { b[lane] } else { a[lane] };
        }
        larger
    }

    #[inline(always)]
    fn all_exceed(a: [f64; WIDTH], share: f64, b: [f64; WIDTH]) -> bool {
        let mut all = true;
        for lane in 0..WIDTH {
            all &= a[lane] > share * b[lane];
        }
        all
    }
}

impl Field for Lanes {
    const ZERO: Self = Lanes { re: [0.0; WIDTH], im: [0.0; WIDTH] };
    const ONE: Self = Lanes { re: [1.0; WIDTH], im: [0.0; WIDTH] };

    #[inline(always)]
    fn reciprocal(self) -> Self {
        let mut inverse = self;
        for lane in 0..WIDTH {
            let (re, im) = (self.re[lane], self.im[lane]);
            let factor = 1.0 / (re * re + im * im);
            (inverse.re[lane], inverse.im[lane]) = (re * factor, -im * factor);
        }
        inverse
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for lane in 0..WIDTH {
            self.re[lane] += other.re[lane];
            self.im[lane] += other.im[lane];
        }
        self
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        for lane in 0..WIDTH {
            self.re[lane] -= other.re[lane];
            self.im[lane] -= other.im[lane];
        }
        self
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut product = self;
        for lane in 0..WIDTH {
            let (a, b, c, d) = (self.re[lane], self.im[lane], other.re[lane], other.im[lane]);
            product.re[lane] = a * c - b * d;
            product.im[lane] = a * d + b * c;
        }
        product
    }
}

impl Mul<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, factor: f64) -> Self {
        for lane in 0..WIDTH {
            self.re[lane] *= factor;
            self.im[lane] *= factor;
        }
        self
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self * -1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn complex() -> impl Strategy<Value = Complex64> {
        (-3.0..3.0, -3.0..3.0).prop_map(|(re, im)| Complex64::new(re, im))
    }

    proptest! {
        #[test]
        fn lanes_calculate_on_every_line_as_single_numbers_do(
            a in prop::collection::vec(complex(), 1..=WIDTH), b in complex(), factor in -2.0f64..2.0
        ) {
            let (lanes, other) = (Lanes::of(&a), Lanes::constant(b));
            let result = (lanes * other - -lanes) * factor + other.reciprocal();
            for (line, &a) in a.iter().enumerate() {
                let expected = (a * b + a) * factor + b.inv();
                prop_assert!((result.line(line) - expected).norm() < 1e-12 * (1.0 + b.inv().norm() + a.norm()));
            }
            let mut written = vec![Complex64::ZERO; a.len()];
            lanes.write(&mut written);
            prop_assert_eq!(written, a);
        }
    }

    #[test]
    fn a_line_that_is_not_a_number_exceeds_nothing() {
        let mut lanes = Lanes::ONE;
        assert!(Lanes::all_exceed(lanes.sizes(), 0.5, Lanes::ONE.sizes()));
        lanes.set_line(3, Complex64::new(f64::NAN, 0.0));
        assert!(!Lanes::all_exceed(lanes.sizes(), 0.5, Lanes::ONE.sizes()));
    }
}
