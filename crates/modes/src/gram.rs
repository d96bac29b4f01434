//! Inner products, FRF by FRF, of everything that the modal model and its derivatives are linear combinations
//! of.
//!
//! The accelerance of an FRF is s²·Σ_r [ρ_r/(s − λ_r) + ρ̄_r/(s − λ̄_r)] and the residual terms. Residues,
//! derivatives with respect to poles and derivatives with respect to participations all combine the same
//! columns, so one pass over the lines for a set of poles gives the best residues, χ², its gradient and its
//! curvature.

use num_complex::Complex64;

use crate::observed::Observed;

/// Residual terms in use, of the receptance: s⁻², s⁻⁴, … (rigid motions, modes below the band) and 1, s², …
/// (modes above).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Terms {
    pub lower: usize,
    pub upper: usize,
}

impl Terms {
    /// What an analyst adds by hand: a rigid mass and a static flexibility.
    pub(crate) const USUAL: Terms = Terms { lower: 1, upper: 1 };

    pub(crate) fn count(self) -> usize {
        self.lower + self.upper
    }

    /// Powers of s² that the terms of the accelerance are, the lower residual's own, 0, first.
    pub(crate) fn powers(self) -> impl Iterator<Item = i32> {
        (0..self.lower as i32).map(|k| -k).chain(1..=self.upper as i32)
    }

    /// The accelerances of the terms at `omega`, each of size one at the highest line.
    pub(crate) fn values(self, omega: f64, highest: f64) -> impl Iterator<Item = f64> {
        let squared = (omega / highest).powi(2);
        self.powers().map(move |power| squared.powi(power))
    }
}

/// Weighted inner products Re Σ w c̄_a c_b, one matrix for each FRF, weights twice those of the complex
/// values: one over the variance of a part.
#[derive(Debug, Clone)]
pub(crate) struct Gram {
    width: usize,
    modes: usize,
    all: Vec<f64>,
}

/// The four columns of a mode: of Re ρ and Im ρ, and the same over (s − λ)² for the derivatives.
pub(crate) const OF_MODE: usize = 4;

impl Gram {
    /// The products for `poles` (rad/s) with so many residual terms.
    pub(crate) fn of(observed: &Observed, poles: &[Complex64], terms: Terms) -> Self {
        let (n, frfs) = (observed.lines(), observed.frfs());
        let data = OF_MODE * poles.len() + 2 * terms.count();
        let width = data + 1;
        let highest = observed.omegas[n - 1];
        let mut all = vec![0.0; frfs * width * width];
        let (mut re, mut im) = (vec![0.0; width], vec![0.0; width]);
        let mut products = vec![0.0; width * width];
        for (line, &omega) in observed.omegas.iter().enumerate() {
            columns(omega, poles, terms, highest, &mut re, &mut im);
            for a in 0..data {
                let (x, y) = (re[a], im[a]);
                let row = &mut products[a * width..a * width + a + 1];
                for ((product, u), v) in row.iter_mut().zip(&re).zip(&im) {
                    *product = x * u + y * v;
                }
            }
            for frf in 0..frfs {
                let weight = 2.0 * observed.weights[frf * n + line];
                if weight <= 0.0 {
                    continue;
                }
                let value = observed.values[frf * n + line];
                let gram = &mut all[frf * width * width..(frf + 1) * width * width];
                for a in 0..data {
                    let row = &mut gram[a * width..a * width + a + 1];
                    for (target, product) in row.iter_mut().zip(&products[a * width..]) {
                        *target += weight * product;
                    }
                }
                let row = &mut gram[data * width..(data + 1) * width];
                for ((target, u), v) in row.iter_mut().zip(&re).zip(&im) {
                    *target += weight * (value.re * u + value.im * v);
                }
                row[data] += weight * value.norm_sqr();
            }
        }
        Gram { width, modes: poles.len(), all }
    }

    fn at(&self, frf: usize, a: usize, b: usize) -> f64 {
        let (a, b) = if a >= b { (a, b) } else { (b, a) };
        self.all[(frf * self.width + a) * self.width + b]
    }

    /// Inner product of two combinations of columns.
    pub(crate) fn product(&self, frf: usize, left: &[(usize, f64)], right: &[(usize, f64)]) -> f64 {
        let row = |&(a, x): &(usize, f64)| -> f64 {
            x * right.iter().map(|&(b, y)| y * self.at(frf, a, b)).sum::<f64>()
        };
        left.iter().map(row).sum()
    }

    /// The first of the residual terms' columns.
    pub(crate) fn first_term(&self) -> usize {
        OF_MODE * self.modes
    }

    /// The column of what was measured.
    pub(crate) fn data(&self) -> usize {
        self.width - 1
    }
}

fn columns(omega: f64, poles: &[Complex64], terms: Terms, highest: f64, re: &mut [f64], im: &mut [f64]) {
    let squared = -omega * omega;
    let s = Complex64::new(0.0, omega);
    let mut set = |index: usize, value: Complex64| {
        re[index] = value.re;
        im[index] = value.im;
    };
    for (mode, pole) in poles.iter().enumerate() {
        let (one, other) = ((s - pole).inv(), (s - pole.conj()).inv());
        let (f, g) = (one * squared, other * squared);
        set(OF_MODE * mode, f + g);
        set(OF_MODE * mode + 1, Complex64::I * (f - g));
        let (f, g) = (f * one, g * other);
        set(OF_MODE * mode + 2, f + g);
        set(OF_MODE * mode + 3, Complex64::I * (f - g));
    }
    for (term, value) in terms.values(omega, highest).enumerate() {
        let value = Complex64::from(value);
        set(OF_MODE * poles.len() + 2 * term, value);
        set(OF_MODE * poles.len() + 2 * term + 1, Complex64::I * value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_over_the_squared_denominator_are_derivatives_of_the_others() {
        let pole = Complex64::new(-3.0, 100.0);
        let at = |pole: Complex64| {
            let (mut re, mut im) = (vec![0.0; 4], vec![0.0; 4]);
            columns(90.0, &[pole], Terms { lower: 0, upper: 0 }, 100.0, &mut re, &mut im);
            (0..4).map(|k| Complex64::new(re[k], im[k])).collect::<Vec<_>>()
        };
        let (here, step) = (at(pole), 1e-4);
        let along = |direction: Complex64| {
            let (up, down) = (at(pole + direction * step), at(pole - direction * step));
            (up[0] - down[0]) / (2.0 * step)
        };
        // A residue of one: ∂/∂ω of the mode is column 3, ∂/∂σ is minus column 2.
        assert!((along(Complex64::I) - here[3]).norm() < 1e-6 * here[3].norm());
        assert!((along(-Complex64::ONE) + here[2]).norm() < 1e-6 * here[2].norm());
    }
}
