//! Tails of the distributions that tests compare with.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// P(X > x) of the χ² distribution with `degrees` degrees of freedom; 1 without any.
pub(crate) fn chi_squared_tail(x: f64, degrees: f64) -> f64 {
    ChiSquared::new(degrees).map_or(1.0, |chi_squared| chi_squared.sf(x))
}

/// P(F > f) of Fisher's distribution; 1 without degrees of freedom.
pub(crate) fn f_tail(f: f64, numerator: f64, denominator: f64) -> f64 {
    if !f.is_finite() {
        return 0.0;
    }
    FisherSnedecor::new(numerator, denominator).map_or(1.0, |fisher| fisher.sf(f))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_agree_with_tables() {
        // Values of scipy.stats: chi2.sf(130, 100), f.sf(1.5, 40, 80).
        for (found, expected) in
            [(chi_squared_tail(130.0, 100.0), 0.023512), (f_tail(1.5, 40.0, 80.0), 0.062559)]
        {
            assert!((found / expected - 1.0).abs() < 2e-5, "{found} against {expected}");
        }
    }
}
