//! 2×2 matrices of numbers, or of the numbers of several spectral lines side by side.

use num_complex::Complex64;
use serde::Serialize;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a [`Matrix2`] can hold: numbers, or the numbers of several spectral lines side by side.
pub trait Field:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// One over the number.
    fn reciprocal(self) -> Self;
}

/// A single number: `f64` or [`Complex64`].
pub trait Scalar: Field + PartialEq + Div<Output = Self> {
    /// Squared absolute value.
    fn abs_squared(self) -> f64;
}

impl Field for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    #[inline]
    fn reciprocal(self) -> Self {
        1.0 / self
    }
}

impl Scalar for f64 {
    #[inline]
    fn abs_squared(self) -> f64 {
        self * self
    }
}

impl Scalar for Complex64 {
    #[inline]
    fn abs_squared(self) -> f64 {
        self.norm_sqr()
    }
}

impl Field for Complex64 {
    const ZERO: Self = Complex64::new(0.0, 0.0);
    const ONE: Self = Complex64::new(1.0, 0.0);
    #[inline]
    fn reciprocal(self) -> Self {
        // |z|² of a determinant of receptances can underflow, so the components are scaled first.
        let largest = self.re.abs().max(self.im.abs());
        let scale = 1.0 / largest;
        let (re, im) = (self.re * scale, self.im * scale);
        let factor = scale / (re * re + im * im);
        Complex64::new(re * factor, -im * factor)
    }
}

/// A 2×2 matrix on (transverse, rotation), row by row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[repr(transparent)]
pub struct Matrix2<T>(pub [[T; 2]; 2]);

/// A 2×2 compliance or dynamic stiffness at one spectral line.
pub type ComplexMatrix2 = Matrix2<Complex64>;
/// A static stiffness, a damping matrix or a transport.
pub type RealMatrix2 = Matrix2<f64>;

// Always inlined: of several lines these are compiled with the instructions that their caller is compiled
// for.
impl<T: Field> Matrix2<T> {
    /// The matrix `[[a, b], [c, d]]`.
    #[inline(always)]
    pub const fn new(a: T, b: T, c: T, d: T) -> Self {
        Matrix2([[a, b], [c, d]])
    }

    /// All zeros.
    #[inline]
    pub const fn zero() -> Self {
        Matrix2([[T::ZERO; 2]; 2])
    }

    /// The identity.
    #[inline]
    pub const fn identity() -> Self {
        Matrix2([[T::ONE, T::ZERO], [T::ZERO, T::ONE]])
    }

    /// The element in row `i`, column `j` (0 transverse, 1 rotation).
    #[inline(always)]
    pub fn at(&self, i: usize, j: usize) -> T {
        self.0[i][j]
    }

    /// The transpose (no conjugation: structural matrices are complex symmetric, not Hermitian).
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [[a, b], [c, d]] = self.0;
        Matrix2([[a, c], [b, d]])
    }

    /// The determinant.
    #[inline(always)]
    pub fn determinant(self) -> T {
        let [[a, b], [c, d]] = self.0;
        a * d - b * c
    }

    /// The inverse without a check: of a singular matrix, non-finite numbers.
    #[inline(always)]
    pub fn inverse_unchecked(self) -> Self {
        let [[a, b], [c, d]] = self.0;
        let factor = (a * d - b * c).reciprocal();
        Matrix2([[d * factor, -b * factor], [-c * factor, a * factor]])
    }

    /// The matrix with every element multiplied by `factor`.
    #[inline]
    pub fn scale(self, factor: T) -> Self {
        self.map(|element| element * factor)
    }

    /// The matrix with `f` applied to every element.
    #[inline(always)]
    pub fn map<U>(self, f: impl Fn(T) -> U) -> Matrix2<U> {
        let [[a, b], [c, d]] = self.0;
        Matrix2([[f(a), f(b)], [f(c), f(d)]])
    }
}

impl<T: Scalar> Matrix2<T> {
    /// The inverse; `None` where the matrix is singular or holds a non-finite number.
    #[inline]
    pub fn inverse(self) -> Option<Self> {
        let inverse = self.inverse_unchecked();
        inverse.is_finite().then_some(inverse)
    }

    /// Whether every element is finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.0.iter().flatten().all(|e| e.abs_squared().is_finite())
    }

    /// Squared Frobenius norm.
    #[inline]
    pub fn norm_squared(&self) -> f64 {
        self.0.iter().flatten().map(|e| e.abs_squared()).sum()
    }

    /// Condition number in the 2-norm after rows and columns were scaled to equal size.
    ///
    /// The scaling makes the number independent of the units of length and angle: it is that of
    /// `[[1, r], [r, e^{iφ}]]`, the form that every 2×2 matrix takes when its rows and columns are
    /// balanced. Infinite for a singular matrix.
    pub fn balanced_condition(&self) -> f64 {
        let magnitude = self.map(|e| e.abs_squared().sqrt()).0;
        let diagonal = magnitude[0][0] * magnitude[1][1];
        let cross = magnitude[0][1] * magnitude[1][0];
        let determinant = self.determinant().abs_squared().sqrt();
        if determinant == 0.0 || !determinant.is_finite() {
            return f64::INFINITY;
        }
        // With balanced rows and columns the squared singular values sum to 2 (|ad| + |bc|).
        let half_sum = diagonal + cross;
        let root = (half_sum * half_sum - determinant * determinant).max(0.0).sqrt();
        (half_sum + root) / determinant
    }
}

impl RealMatrix2 {
    /// The same matrix with complex elements.
    #[inline]
    pub fn to_complex(self) -> ComplexMatrix2 {
        self.map(|e| Complex64::new(e, 0.0))
    }
}

impl ComplexMatrix2 {
    /// The real part.
    #[inline]
    pub fn re(self) -> RealMatrix2 {
        self.map(|e| e.re)
    }

    /// The imaginary part.
    #[inline]
    pub fn im(self) -> RealMatrix2 {
        self.map(|e| e.im)
    }
}

impl<T: Field> Mul for Matrix2<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let [[a, b], [c, d]] = self.0;
        let [[e, f], [g, h]] = other.0;
        Matrix2([[a * e + b * g, a * f + b * h], [c * e + d * g, c * f + d * h]])
    }
}

impl<T: Field> Add for Matrix2<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.0, other.0);
        Matrix2([[a + e, b + f], [c + g, d + h]])
    }
}

impl<T: Field> Sub for Matrix2<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.0, other.0);
        Matrix2([[a - e, b - f], [c - g, d - h]])
    }
}
