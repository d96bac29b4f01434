//! Averages over spectral lines of a stiffness or damping spectrum (eq 34–36, 39, 42).
//!
//! One unknown and one equation a line make the least squares of eq (34) and (39) an identity; over the lines
//! of a band they are a plain mean (eq 35, 42). The noise is anything but equal over the lines, so there is a
//! weighted mean beside it, its weights one over the variances.
//!
//! ```
//! use jointscope_averaging::{mean, weighted_mean};
//!
//! let (values, std) = ([3.0, 3.2, 9.0], [0.1, 0.1, 4.0]);
//! assert!((mean(&values, &std)?.value - 5.066_666).abs() < 1e-5);
//! let weighted = weighted_mean(&values, &std)?;
//! assert!((weighted.value - 3.1018).abs() < 1e-4 && (weighted.std - 0.0707).abs() < 1e-4);
//! # Ok::<(), jointscope_averaging::AveragingError>(())
//! ```

mod band;

use jointscope_spectra::in_text;

pub use band::{Band, quietest_band};

/// An average with one standard deviation, in the unit of what was averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Average {
    /// The average.
    pub value: f64,
    /// Its standard deviation, the lines' noise taken as independent.
    pub std: f64,
}

/// Why there is no average.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AveragingError {
    /// No line is left in the band.
    #[error(
        "the band from {from} to {to} Hz holds no usable spectral line; those there are lie from {} to {} Hz",
        in_text(*first),
        in_text(*last)
    )]
    EmptyBand {
        /// Lower end, Hz.
        from: f64,
        /// Upper end, Hz.
        to: f64,
        /// Lowest usable line, Hz.
        first: f64,
        /// Highest usable line, Hz.
        last: f64,
    },
    /// Nothing to average.
    #[error("there is no usable spectral line")]
    NoLines,
    /// Deviations of fewer or more lines than there are.
    #[error("{deviations} standard deviations do not go with {lines} spectral lines: one for each is needed")]
    Lengths {
        /// Lines.
        lines: usize,
        /// Deviations of a quantity.
        deviations: usize,
    },
    /// A weighted mean needs positive standard deviations.
    #[error("a standard deviation of {0} cannot weigh a line")]
    BadDeviation(f64),
}

/// Plain mean over lines (eq 35, 42), with the standard deviation that follows from those of the lines.
///
/// # Errors
/// [`AveragingError::NoLines`] on empty input.
pub fn mean(values: &[f64], std: &[f64]) -> Result<Average, AveragingError> {
    if values.is_empty() {
        return Err(AveragingError::NoLines);
    }
    let n = values.len() as f64;
    let variance: f64 = std.iter().map(|s| s * s).sum();
    Ok(Average { value: values.iter().sum::<f64>() / n, std: variance.sqrt() / n })
}

/// Mean with weights of one over the variances. The deviations must not be made from the values themselves: a
/// low reading would then count as a precise one.
///
/// # Errors
/// Empty input, or a deviation that is not positive and finite.
pub fn weighted_mean(values: &[f64], std: &[f64]) -> Result<Average, AveragingError> {
    if values.is_empty() {
        return Err(AveragingError::NoLines);
    }
    let (mut sum, mut total) = (0.0, 0.0);
    for (value, &s) in values.iter().zip(std) {
        if !(s > 0.0 && s.is_finite()) {
            return Err(AveragingError::BadDeviation(s));
        }
        sum += value / (s * s);
        total += 1.0 / (s * s);
    }
    Ok(Average { value: sum / total, std: total.sqrt().recip() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn equal_deviations_make_both_means_the_same(values in prop::collection::vec(-1e6f64..1e6, 1..50), s in 1e-3f64..1e3) {
            let std = vec![s; values.len()];
            let (plain, weighted) = (mean(&values, &std).unwrap(), weighted_mean(&values, &std).unwrap());
            prop_assert!((plain.value - weighted.value).abs() < 1e-9 * 1e6);
            prop_assert!((plain.std / weighted.std - 1.0).abs() < 1e-12);
        }

        #[test]
        fn a_weighted_mean_is_never_less_certain_than_a_plain_one(std in prop::collection::vec(1e-3f64..1e3, 1..50)) {
            let values = vec![1.0; std.len()];
            prop_assert!(weighted_mean(&values, &std).unwrap().std <= mean(&values, &std).unwrap().std * (1.0 + 1e-12));
        }
    }

    #[test]
    fn a_line_of_infinite_or_zero_deviation_cannot_be_weighted() {
        assert_eq!(weighted_mean(&[1.0], &[0.0]), Err(AveragingError::BadDeviation(0.0)));
        assert!(weighted_mean(&[1.0], &[f64::NAN]).is_err());
        assert_eq!(weighted_mean(&[1.0], &[f64::INFINITY]), Err(AveragingError::BadDeviation(f64::INFINITY)));
        assert_eq!(mean(&[], &[]), Err(AveragingError::NoLines));
        assert_eq!(weighted_mean(&[], &[]), Err(AveragingError::NoLines));
    }
}
