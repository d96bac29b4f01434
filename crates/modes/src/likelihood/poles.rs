//! Poles with their participations, and what holds them.

use num_complex::Complex64;

/// Poles and how strongly their modes show in each column of the FRFs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Poles {
    /// rad/s.
    pub poles: Vec<Complex64>,
    /// Largest entry one.
    pub participations: Vec<Vec<Complex64>>,
}

impl Poles {
    pub(crate) fn keep(&self, keep: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.poles.len()).filter(|&r| keep(r)).collect();
        Poles {
            poles: kept.iter().map(|&r| self.poles[r]).collect(),
            participations: kept.iter().map(|&r| self.participations[r].clone()).collect(),
        }
    }
}

/// Holds poles near a place while one FRF alone decides on them.
#[derive(Debug, Clone)]
pub(crate) struct Prior {
    pub poles: Vec<Complex64>,
    /// Standard deviations of the frequency, in half-widths, and of ln σ.
    pub std: (f64, f64),
}
