use jointscope_linalg::Cholesky;

/// Logarithm of the marginal likelihood of a hypothesis by Laplace's approximation about its optimum, up to a constant that depends on
/// the data alone: −½·objective − ½ ln det(Σ₀·I), with the objective −2 ln(likelihood × prior) without normalisation, I the information there,
/// priors included, and Σ₀ the parameters' prior covariance, diagonal, as variances.
///
/// Parameters need proper priors: each pays by how much narrower the data make it. `None` where the information is not positive definite
/// or a variance is not positive.
pub fn laplace_evidence(objective: f64, information: &[f64], prior_variances: &[f64]) -> Option<f64> {
    let factor = Cholesky::of(prior_variances.len(), information)?;
    if !prior_variances.iter().all(|variance| *variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let widths: f64 = prior_variances.iter().map(|variance| variance.ln()).sum();
    Some(-0.5 * (objective + factor.ln_determinant() + widths))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn of_a_linear_model_the_evidence_is_the_integral_over_its_parameter(
            slope in 0.5f64..3.0, datum in -3.0f64..3.0, variance in 0.2f64..4.0
        ) {
            // y = slope·q + noise of variance one, q of mean zero: y is normal of variance 1 + slope²·variance.
            let information = slope * slope + 1.0 / variance;
            let best = slope * datum / information;
            let objective = (datum - slope * best).powi(2) + best * best / variance;
            let exact = 1.0 + slope * slope * variance;
            let expected = -0.5 * (datum * datum / exact + exact.ln());
            let found = laplace_evidence(objective, &[information], &[variance]).unwrap();
            prop_assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn an_undetermined_or_improper_parameter_has_no_evidence() {
        assert_eq!(laplace_evidence(1.0, &[0.0], &[1.0]), None);
        assert_eq!(laplace_evidence(1.0, &[1.0], &[f64::INFINITY]), None);
    }
}
