//! Tails of the distributions that tests compare with.

/// P(X > x) of the χ² distribution with `degrees` degrees of freedom, by Wilson and Hilferty's cube root.
pub(crate) fn chi_squared_tail(x: f64, degrees: f64) -> f64 {
    if degrees <= 0.0 || !x.is_finite() {
        return if x > 0.0 && degrees > 0.0 { 0.0 } else { 1.0 };
    }
    let spread = 2.0 / (9.0 * degrees);
    normal_tail(((x.max(0.0) / degrees).cbrt() - 1.0 + spread) / spread.sqrt())
}

/// P(F > f) of Fisher's distribution, by Paulson's approximation (cube roots of both χ²).
pub(crate) fn f_tail(f: f64, numerator: f64, denominator: f64) -> f64 {
    if numerator <= 0.0 || denominator <= 0.0 || f <= 0.0 {
        return 1.0;
    }
    if !f.is_finite() {
        return 0.0;
    }
    let (a, b) = (2.0 / (9.0 * numerator), 2.0 / (9.0 * denominator));
    let root = f.cbrt();
    normal_tail(((1.0 - b) * root - (1.0 - a)) / (a + b * root * root).sqrt())
}

/// P(Z > z) of the standard normal distribution: by its series near zero, by its continued fraction far out.
pub(crate) fn normal_tail(z: f64) -> f64 {
    let x = z.abs();
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let tail = if x < 3.0 {
        // Φ(x) − ½ = φ(x)·(x + x³/3 + x⁵/15 + …).
        let mut term = x;
        let mut sum = x;
        for k in 1..60 {
            term *= x * x / f64::from(2 * k + 1);
            sum += term;
        }
        0.5 - density * sum
    } else {
        let fraction = (1..60).rev().fold(x, |below, k| x + f64::from(k) / below);
        density / fraction
    };
    if z >= 0.0 { tail } else { 1.0 - tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_agree_with_tables() {
        // Values of scipy.stats: chi2.sf(130, 100), f.sf(1.5, 40, 80), norm.sf(3).
        for (found, expected) in [
            (chi_squared_tail(130.0, 100.0), 0.023512),
            (f_tail(1.5, 40.0, 80.0), 0.062559),
            (normal_tail(3.0), 0.00134990),
            (normal_tail(-1.0), 0.84134475),
        ] {
            assert!((found / expected - 1.0).abs() < 0.02, "{found} against {expected}");
        }
    }
}
