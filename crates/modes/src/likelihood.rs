//! Maximum likelihood of the modal model: poles and participations by Gauss–Newton, residues and residual
//! terms eliminated.
//!
//! Noise is circular and Gaussian with known variances, so the likelihood is weighted least squares. For
//! given poles and participations, everything else is linear, row of FRFs by row of FRFs; it is solved for
//! and taken out of the normal equations (Schur complement). What remains is the Fisher information of poles
//! and participations with all else unknown, and its inverse their Cramér–Rao bound.

mod point;
mod poles;

pub(crate) use poles::{Poles, Prior};

use jointscope_inference::{DerivativePrecision, LeastSquares, Settings, descend};
use jointscope_linalg::Cholesky;
use num_complex::Complex64;

use crate::gram::Terms;
use crate::observed::Observed;
use crate::settings::likelihood::{CONVERGED, MOST_STEPS, STEP_DAMPING};
use point::Point;

/// Poles at their most likely place.
#[derive(Debug, Clone)]
pub(crate) struct Likelihood {
    pub poles: Poles,
    pub terms: Terms,
    /// Σ|residual|² over the variance of a part.
    pub chi2: f64,
    /// Information about (δω/σ, δ ln σ) of every mode, then about participations, row-major.
    information: Cholesky,
    /// Mode by mode: entries of the rows of FRFs.
    pub entries: Vec<Vec<Complex64>>,
    /// FRF by FRF: residual terms of the accelerance, each in units of its size at the highest line.
    pub residual_terms: Vec<Vec<Complex64>>,
    /// Rise of χ² without each mode, all other poles where they are.
    pub significance: Vec<f64>,
    /// Variance of |entry|²'s parts, mode by mode and row by row, poles included.
    pub entry_std: Vec<Vec<f64>>,
}

/// The most likely poles and participations; everything linear is solved for anew at every point (variable
/// projection).
struct Search<'a> {
    observed: &'a Observed,
    terms: Terms,
    prior: Option<&'a Prior>,
}

impl LeastSquares for Search<'_> {
    type Point = Point;
    type Weights = ();
    type Derivatives = ();
    type Equations = ();
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Point) {}

    fn objective(&self, point: &Point, _: &()) -> f64 {
        point.target()
    }

    /// In closed form, and found with the point.
    fn derivatives(&self, _: &Point, _: DerivativePrecision) -> Option<()> {
        Some(())
    }

    fn equations(&self, _: &Point, _: &(), _: &()) {}

    fn stepped(&self, point: &Point, _: &(), damping: f64) -> Option<Point> {
        let moved = point.moved(&point.normal.step(damping)?);
        Point::of(self.observed, moved, self.terms, self.prior)
    }
}

impl Likelihood {
    /// Searches from `start`; `None` where the equations have no solution, as with more unknowns than
    /// numbers.
    pub(crate) fn search(
        observed: &Observed,
        start: Poles,
        terms: Terms,
        steps: usize,
        prior: Option<&Prior>,
    ) -> Option<Self> {
        let here = Point::of(observed, start, terms, prior)?;
        if here.normal.order == 0 {
            return here.finish(observed);
        }
        let settings = Settings {
            steps: steps.min(MOST_STEPS),
            damping: STEP_DAMPING,
            convergence: CONVERGED,
            ..Settings::default()
        };
        descend(&Search { observed, terms, prior }, here, None, &settings)?.point.finish(observed)
    }

    /// Variance of δω/σ and of δ ln σ, and their covariance, for each mode: the Cramér–Rao bound at the
    /// estimate.
    pub(crate) fn pole_covariance(&self) -> Vec<[[f64; 2]; 2]> {
        let inverse = self.information.inverse();
        let n = self.information.order();
        let at = |a: usize, b: usize| inverse[a * n + b];
        (0..self.poles.poles.len())
            .map(|r| {
                let (a, b) = (2 * r, 2 * r + 1);
                [[at(a, a), at(a, b)], [at(b, a), at(b, b)]]
            })
            .collect()
    }

    /// Number of real unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        let entries: usize = self.entries.iter().map(|e| 2 * e.len()).sum();
        let terms: usize = self.residual_terms.iter().map(|t| 2 * t.len()).sum();
        self.information.order() + entries + terms
    }

    /// χ² per degree of freedom.
    pub(crate) fn chi2_per_dof(&self, observed: &Observed) -> f64 {
        self.chi2 / observed.degrees().saturating_sub(self.unknowns()).max(1) as f64
    }
}

/// The factor of an information matrix; directions that nothing is known of get a deviation that says so.
fn factorised(n: usize, information: &[f64]) -> Option<Cholesky> {
    Cholesky::of(n, information).or_else(|| {
        let mut loosened = information.to_vec();
        for i in 0..n {
            loosened[i * n + i] = loosened[i * n + i] * (1.0 + 1e-9) + 1e-12;
        }
        Cholesky::of(n, &loosened)
    })
}

impl Point {
    fn finish(self, observed: &Observed) -> Option<Likelihood> {
        let count = self.poles.poles.len();
        let own = 2 * self.terms.count();
        let n = self.normal.order;
        let information = factorised(n, &self.normal.information)?;
        let complex = |x: &[f64], k: usize| Complex64::new(x[2 * k], x[2 * k + 1]);
        let mut entries = vec![Vec::new(); count];
        let mut entry_std = vec![Vec::new(); count];
        let mut significance = vec![0.0; count];
        let mut residual_terms = vec![Vec::new(); observed.frfs()];
        let parameters = information.inverse();
        for ((row, mixed), frfs) in self.rows.iter().zip(&self.mixed).zip(&observed.grid.rows) {
            let x = &row.unknowns;
            let covariance = row.factor.inverse();
            let size = row.factor.order();
            for mode in 0..count {
                let entry = complex(x, mode);
                entries[mode].push(entry);
                let [a, b] = [2 * mode, 2 * mode + 1];
                let (caa, cab, cbb) =
                    (covariance[a * size + a], covariance[b * size + a], covariance[b * size + b]);
                let determinant = caa * cbb - cab * cab;
                if determinant > 0.0 {
                    significance[mode] += (entry.re * entry.re * cbb - 2.0 * entry.re * entry.im * cab
                        + entry.im * entry.im * caa)
                        / determinant;
                }
                // A_ll⁻¹ and what the poles' uncertainty brings along.
                let variance = |u: usize| {
                    let gain: Vec<f64> = (0..n)
                        .map(|k| (0..size).map(|j| covariance[u * size + j] * mixed[k * size + j]).sum())
                        .collect();
                    let through: f64 = (0..n)
                        .map(|k| gain[k] * (0..n).map(|m| parameters[k * n + m] * gain[m]).sum::<f64>())
                        .sum();
                    covariance[u * size + u] + through
                };
                let own_variance: f64 = [a, b].into_iter().map(variance).sum();
                entry_std[mode].push((0.5 * own_variance).max(0.0).sqrt());
            }
            for (i, &frf) in frfs.iter().enumerate() {
                residual_terms[frf] =
                    (0..self.terms.count()).map(|t| complex(&x[2 * count + own * i..], t)).collect();
            }
        }
        Some(Likelihood {
            poles: self.poles,
            terms: self.terms,
            chi2: self.chi2,
            information,
            entries,
            residual_terms,
            significance,
            entry_std,
        })
    }
}
