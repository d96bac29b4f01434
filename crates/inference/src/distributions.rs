//! Tails of the distributions that intervals and tests rest on.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, Normal, StudentsT};

/// Halvings that find a quantile to rounding.
const HALVINGS: usize = 200;

/// P(x < `z`) of a standard normal x.
pub fn normal_below(z: f64) -> f64 {
    Normal::standard().cdf(z)
}

/// P(x > `z`) of a standard normal x.
pub fn normal_above(z: f64) -> f64 {
    Normal::standard().sf(z)
}

/// P(X > `x`) of the χ² distribution with `degrees` degrees of freedom; 1 without any.
pub fn chi_squared_above(x: f64, degrees: f64) -> f64 {
    match ChiSquared::new(degrees) {
        Ok(_) if x == f64::INFINITY => 0.0,
        Ok(law) => law.sf(x),
        Err(_) => 1.0,
    }
}

/// The value that χ² of `degrees` degrees of freedom exceeds with probability `above`, 0 without any degree;
/// by bisection, for the library's own is no number at 0.975 of one degree.
pub fn chi_squared_exceeded(above: f64, degrees: f64) -> f64 {
    if degrees <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 10.0 + 2.0 * degrees);
    while chi_squared_above(high, degrees) > above {
        high *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if chi_squared_above(middle, degrees) > above { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// P(F > `f`) of Fisher's distribution; 1 without degrees of freedom.
pub fn fisher_above(f: f64, numerator: f64, denominator: f64) -> f64 {
    match FisherSnedecor::new(numerator, denominator) {
        Ok(_) if !f.is_finite() => 0.0,
        Ok(law) => law.sf(f),
        Err(_) => 1.0,
    }
}

/// The value that Student's t of `degrees` degrees of freedom exceeds with probability `above`; infinite
/// without any.
pub fn student_exceeded(above: f64, degrees: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees).map_or(f64::INFINITY, |law| law.inverse_cdf(1.0 - above))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_and_quantiles_agree_with_tables() {
        // Values of scipy.stats: chi2.sf(130, 100), f.sf(1.5, 40, 80), norm.sf(3), t.isf(0.025, 4), and below
        // chi2.isf(0.05, 6), chi2.isf(0.975, 1), norm.cdf.
        for (found, expected) in [
            (chi_squared_above(130.0, 100.0), 0.023512),
            (fisher_above(1.5, 40.0, 80.0), 0.062559),
            (normal_above(3.0), 1.349898e-3),
            (normal_below(-3.0), 1.349898e-3),
            (student_exceeded(0.025, 4.0), 2.776445),
        ] {
            assert!((found / expected - 1.0).abs() < 2e-5, "{found} against {expected}");
        }
        assert!((chi_squared_exceeded(0.05, 6.0) - 12.591_587).abs() < 1e-5);
        assert!((chi_squared_exceeded(0.975, 1.0) - 9.820_69e-4).abs() < 1e-8);
        assert!((normal_below(1.959_963_984_540_054) - 0.975).abs() < 1e-9);
    }

    #[test]
    fn far_tails_are_small_and_nothing_refutes_without_degrees_of_freedom() {
        assert_eq!((chi_squared_above(-1.0, 3.0), chi_squared_above(f64::INFINITY, 3.0)), (1.0, 0.0));
        assert_eq!((chi_squared_above(9.0, 0.0), fisher_above(9.0, 0.0, 3.0)), (1.0, 1.0));
        assert_eq!(fisher_above(f64::INFINITY, 2.0, 3.0), 0.0);
        // Of which half of the digits would be lost as 1 − Φ.
        assert!((normal_above(10.0) / 7.619853e-24 - 1.0).abs() < 1e-6);
    }
}
