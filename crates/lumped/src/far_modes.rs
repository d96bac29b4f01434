//! Modes far above the band, whose terms are smooth there: one short power series for all of them together.

use crate::denominator::Denominator;
use crate::lanes::Lines;
use num_complex::Complex64;

/// Powers of s that are kept.
const POWERS: usize = 9;
/// A mode is far where |s|(|s| + viscous) is at most this share of its stiffness over the whole band: with
/// the powers above its term is then right to about 1e-7.
const SHARE: f64 = 0.04;
/// Far modes for which a series pays.
const ENOUGH: usize = 2 * POWERS;

/// Which modes are far from a band.
#[derive(Debug, Clone)]
pub(crate) struct FarModes {
    /// |s| up to which the series holds, rad/s.
    limit: f64,
    /// Coefficients of 1/(stiffness + s·viscous + s²) by mode, with the modes' numbers.
    series: Vec<(usize, [Complex64; POWERS])>,
}

impl FarModes {
    /// The modes far above |s| ≤ `limit`; `None` where they are too few to matter.
    pub(crate) fn of(modes: &[Denominator], limit: f64) -> Option<Self> {
        let far = |mode: &Denominator| {
            mode.stiffness.re > 0.0 && limit * (limit + mode.viscous.abs()) <= SHARE * mode.stiffness.norm()
        };
        let series: Vec<_> =
            modes.iter().enumerate().filter(|(_, m)| far(m)).map(|(i, m)| (i, coefficients(m))).collect();
        (series.len() >= ENOUGH).then_some(FarModes { limit, series })
    }

    /// Whether the series holds at `s`.
    pub(crate) fn hold(&self, s: Complex64) -> bool {
        s.norm_sqr() <= self.limit * self.limit
    }

    /// Whether mode `index` is one of them.
    pub(crate) fn contain(&self, index: usize) -> bool {
        self.series.binary_search_by_key(&index, |(mode, _)| *mode).is_ok()
    }

    /// Sums of `products` of participations (a row over `count` entries for each mode) with the series'
    /// coefficients: a real row for each power of s and, where there is structural damping, an imaginary one
    /// after each.
    pub(crate) fn rows(&self, products: &[f64], count: usize) -> Vec<f64> {
        if self.series.iter().all(|(_, coefficients)| coefficients.iter().all(|c| c.im == 0.0)) {
            let mut rows = vec![0.0; POWERS * count];
            for (mode, coefficients) in &self.series {
                let product = &products[mode * count..(mode + 1) * count];
                for (row, coefficient) in rows.chunks_exact_mut(count).zip(coefficients) {
                    row.iter_mut().zip(product).for_each(|(to, p)| *to += coefficient.re * p);
                }
            }
            return rows;
        }
        let mut rows = vec![0.0; 2 * POWERS * count];
        for (mode, coefficients) in &self.series {
            let product = &products[mode * count..(mode + 1) * count];
            for (pair, coefficient) in rows.chunks_exact_mut(2 * count).zip(coefficients) {
                let (re, im) = pair.split_at_mut(count);
                re.iter_mut().zip(product).for_each(|(to, p)| *to += coefficient.re * p);
                im.iter_mut().zip(product).for_each(|(to, p)| *to += coefficient.im * p);
            }
        }
        rows
    }

    /// Adds the series at `s`, made of `rows`, to the sums.
    #[inline(always)]
    pub(crate) fn add<T: Lines>(&self, s: T, rows: &[f64], sums: &mut [T]) {
        let count = sums.len();
        let mut power = T::ONE;
        let structural = rows.len() > POWERS * count;
        for row in rows.chunks_exact(if structural { 2 * count } else { count }) {
            let (real, imaginary) = row.split_at(count);
            for (sum, value) in sums.iter_mut().zip(real) {
                *sum = *sum + power * *value;
            }
            let turned = power * T::constant(Complex64::I);
            for (sum, value) in sums.iter_mut().zip(imaginary) {
                *sum = *sum + turned * *value;
            }
            power = power * s;
        }
    }
}

/// Of 1/(κ + v s + s²): κ a_j = −v a_{j−1} − a_{j−2}, a_0 = 1/κ.
fn coefficients(mode: &Denominator) -> [Complex64; POWERS] {
    let compliance = mode.stiffness.inv();
    let mut all = [Complex64::ZERO; POWERS];
    all[0] = compliance;
    all[1] = -compliance * compliance * mode.viscous;
    for j in 2..POWERS {
        all[j] = -compliance * (all[j - 1] * mode.viscous + all[j - 2]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_far_modes_is_their_sum_and_near_modes_are_none_of_them() {
        check(0.0);
        check(5.0);
    }

    fn check(structural: f64) {
        let mode = |r: usize| Denominator {
            stiffness: Complex64::new((1e3 * r as f64).powi(2), structural * (r * r) as f64),
            viscous: 0.02 * 1e3 * r as f64,
        };
        let modes: Vec<Denominator> = (1..60).map(mode).collect();
        let products: Vec<f64> = (0..2 * modes.len()).map(|i| ((i * i) as f64).sin()).collect();
        let far = FarModes::of(&modes, 2e3).unwrap();
        assert!(!far.contain(8) && far.contain(20) && !far.hold(Complex64::new(0.0, 2.1e3)));
        let rows = far.rows(&products, 2);
        let s = Complex64::new(3.0, 1.99e3);
        let mut sums = [Complex64::ZERO; 2];
        far.add(s, &rows, &mut sums);
        for entry in 0..2 {
            let term =
                |r: usize| products[2 * r + entry] / (modes[r].stiffness + s * modes[r].viscous + s * s);
            let size: f64 = (0..modes.len()).filter(|r| far.contain(*r)).map(|r| term(r).norm()).sum();
            let sum: Complex64 = (0..modes.len()).filter(|r| far.contain(*r)).map(term).sum();
            let error = (sums[entry] - sum).norm();
            assert!(error < 1e-7 * size, "entry {entry}: {error} of {size}");
        }
    }
}
