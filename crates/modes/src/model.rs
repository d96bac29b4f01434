//! FRFs rebuilt from modes and residual terms.

use num_complex::Complex64;

use crate::likelihood::Likelihood;

/// The accelerance of the FRF `frf`, which stands in `row` and `column`, at `omegas` (rad/s); residual terms
/// are of size one at `highest`.
pub(crate) fn rebuilt(
    omegas: &[f64],
    fit: &Likelihood,
    frf: usize,
    row: usize,
    column: usize,
    highest: f64,
) -> Vec<Complex64> {
    let at = |&omega: &f64| {
        let s = Complex64::new(0.0, omega);
        let mut sum = Complex64::ZERO;
        for (mode, pole) in fit.poles.poles.iter().enumerate() {
            let residue = fit.entries[mode][row] * fit.poles.participations[mode][column];
            sum += residue / (s - pole) + residue.conj() / (s - pole.conj());
        }
        sum *= s * s;
        for (size, value) in fit.residual_terms[frf].iter().zip(fit.terms.values(omega, highest)) {
            sum += size * value;
        }
        sum
    };
    omegas.iter().map(at).collect()
}
