//! What is known of a site's free scalars, and how they hang on the tolerances.

use super::problem::{Iterate, Problem};
use num_complex::Complex64;

/// A free state at its best and the directions in which it may still yield.
pub(super) struct FreeScalars {
    pub state: Iterate,
    /// Information about the coordinates with all scalars free, row-major; of the order of
    /// `FreeScalars::order`.
    pub information: Vec<f64>,
    /// Minus half the objective's gradient: what convergence has left.
    pub pull: Vec<f64>,
    /// dz/dq at fixed data, line after line, coordinate after coordinate.
    pub sensitivities: Vec<Complex64>,
    /// Σ w |slope|² by line: the information about z.
    pub weights: Vec<f64>,
    pub order: usize,
}

impl Problem<'_> {
    /// What is known about a free state; `exactly` where it will be stated.
    pub(super) fn free_scalars(&self, state: Iterate, exactly: bool) -> Option<FreeScalars> {
        let tangent = self.tangent(&state, exactly)?;
        let weights = &self.recorded.weights;
        let normal = self.normal(&state, &tangent, weights);
        let order = tangent.order;
        let lines = self.recorded.lines();
        let size = |line: usize| -> f64 {
            self.recorded.places(line).map(|p| weights[p] * state.slopes[p].norm_sqr()).sum()
        };
        let sizes: Vec<f64> = (0..lines).map(size).collect();
        let mut sensitivities = vec![Complex64::ZERO; lines * order];
        for a in 0..order {
            let column = tangent.column(a);
            for (line, size) in sizes.iter().enumerate().filter(|(_, size)| **size > 0.0) {
                let along = |p: usize| state.slopes[p].conj() * column[p] * weights[p];
                let along: Complex64 = self.recorded.places(line).map(along).sum();
                sensitivities[line * order + a] = -along / size;
            }
        }
        Some(FreeScalars {
            state,
            information: normal.information,
            pull: normal.right,
            sensitivities,
            weights: sizes,
            order,
        })
    }
}
