//! Bands of frequency.

use crate::AveragingError;
use serde::Serialize;

/// A band of frequencies, both ends included, Hz.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "[f64; 2]")]
pub struct Band {
    /// Lower end, Hz.
    pub from: f64,
    /// Upper end, Hz.
    pub to: f64,
}

impl From<Band> for [f64; 2] {
    fn from(band: Band) -> Self {
        [band.from, band.to]
    }
}

impl Band {
    /// Whether a frequency lies in the band.
    pub fn contains(&self, hz: f64) -> bool {
        hz >= self.from && hz <= self.to
    }

    /// Indices of the frequencies (ascending, Hz) in the band.
    ///
    /// # Errors
    /// [`AveragingError::EmptyBand`] where there are none, [`AveragingError::NoLines`] where there are none
    /// at all.
    pub fn lines(&self, frequencies: &[f64]) -> Result<std::ops::Range<usize>, AveragingError> {
        let start = frequencies.partition_point(|&f| f < self.from);
        let end = frequencies.partition_point(|&f| f <= self.to);
        let (Some(&first), Some(&last)) = (frequencies.first(), frequencies.last()) else {
            return Err(AveragingError::NoLines);
        };
        if start >= end {
            return Err(AveragingError::EmptyBand { from: self.from, to: self.to, first, last });
        }
        Ok(start..end)
    }
}

/// Number of steps along the lines at which a band may start or end.
const STEPS: usize = 48;
/// A band holds at least this share of the lines: a few quiet ones are luck.
const SMALLEST_SHARE: f64 = 0.2;

/// The contiguous band in which plain means come out with the smallest standard deviations, all quantities
/// weighed alike (product of their deviations).
///
/// `frequencies` ascend, Hz; `deviations` holds, for each quantity, one expected standard deviation a line.
/// They must come from a model of the noise, not from the values.
///
/// # Errors
/// [`AveragingError::NoLines`] where there are no lines or no finite deviations, [`AveragingError::Lengths`]
/// where a quantity has not one for each line.
pub fn quietest_band(frequencies: &[f64], deviations: &[Vec<f64>]) -> Result<Band, AveragingError> {
    let n = frequencies.len();
    if n == 0 || deviations.is_empty() {
        return Err(AveragingError::NoLines);
    }
    if let Some(other) = deviations.iter().find(|all| all.len() != n) {
        return Err(AveragingError::Lengths { lines: n, deviations: other.len() });
    }
    // Running sums of variances make every candidate band one subtraction.
    let sums: Vec<Vec<f64>> = deviations
        .iter()
        .map(|deviation| {
            let running = deviation.iter().scan(0.0, |sum, s| {
                *sum += s * s;
                Some(*sum)
            });
            std::iter::once(0.0).chain(running).collect()
        })
        .collect();
    let edge = |step: usize| step * n / STEPS.min(n);
    let smallest = ((n as f64 * SMALLEST_SHARE) as usize).max(1);
    let mut best: Option<(f64, usize, usize)> = None;
    for from in 0..STEPS.min(n) {
        for to in from + 1..=STEPS.min(n) {
            let (start, end) = (edge(from), edge(to));
            if end - start < smallest {
                continue;
            }
            let score: f64 =
                sums.iter().map(|s| 0.5 * (s[end] - s[start]).ln() - ((end - start) as f64).ln()).sum();
            if score.is_finite() && best.is_none_or(|(lowest, ..)| score < lowest) {
                best = Some((score, start, end));
            }
        }
    }
    let (_, start, end) = best.ok_or(AveragingError::NoLines)?;
    Ok(Band { from: frequencies[start], to: frequencies[end - 1] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_quietest_band_leaves_out_the_noisy_ends_and_takes_all_of_the_middle() {
        let frequencies: Vec<f64> = (0..400).map(|i| 2.5 * (i + 1) as f64).collect();
        let noisy = |f: f64| if (300.0..=800.0).contains(&f) { 1.0 } else { 30.0 };
        let deviations = vec![frequencies.iter().map(|&f| noisy(f)).collect::<Vec<_>>()];
        let band = quietest_band(&frequencies, &deviations).unwrap();
        assert!((300.0..330.0).contains(&band.from) && (770.0..=800.0).contains(&band.to), "{band:?}");
    }

    #[test]
    fn deviations_of_other_lines_are_refused() {
        let short = quietest_band(&[10.0, 20.0, 30.0], &[vec![1.0; 3], vec![1.0; 2]]);
        assert_eq!(short, Err(AveragingError::Lengths { lines: 3, deviations: 2 }));
    }

    proptest! {
        /// Every band of whole lines is tried where each line may be an end, and plain means are taken of it.
        #[test]
        fn no_band_of_a_fifth_of_the_lines_has_smaller_deviations_than_the_quietest(
            logs in prop::collection::vec(prop::array::uniform2(-3.0f64..3.0), 1..=48)
        ) {
            let frequencies: Vec<f64> = (0..logs.len()).map(|i| 10.0 + 2.5 * i as f64).collect();
            let deviations: Vec<Vec<f64>> = (0..2).map(|q| logs.iter().map(|l| l[q].exp()).collect()).collect();
            let size = |lines: std::ops::Range<usize>| -> f64 {
                deviations.iter().map(|d| crate::mean(&d[lines.clone()], &d[lines.clone()]).unwrap().std.ln()).sum()
            };
            let band = quietest_band(&frequencies, &deviations).unwrap();
            let found = band.lines(&frequencies).unwrap();
            let smallest = (logs.len() / 5).max(1);
            prop_assert!(found.len() >= smallest && band.to == frequencies[found.end - 1]);
            for start in 0..logs.len() {
                for end in start + smallest..=logs.len() {
                    prop_assert!(size(found.clone()) <= size(start..end) + 1e-9, "{:?} against {}..{}", found, start, end);
                }
            }
        }
    }

    #[test]
    fn a_band_holds_both_of_its_ends_and_is_written_as_two_numbers() {
        let band = Band { from: 2.0, to: 4.0 };
        assert_eq!([1.9, 2.0, 3.0, 4.0, 4.1].map(|hz| band.contains(hz)), [false, true, true, true, false]);
        assert_eq!(<[f64; 2]>::from(band), [2.0, 4.0]);
        assert_eq!(band.lines(&[]), Err(AveragingError::NoLines));
    }

    #[test]
    fn there_is_no_quietest_band_of_nothing() {
        assert_eq!(quietest_band(&[], &[vec![]]), Err(AveragingError::NoLines));
        assert_eq!(quietest_band(&[1.0], &[]), Err(AveragingError::NoLines));
        assert_eq!(quietest_band(&[1.0], &[vec![f64::NAN]]), Err(AveragingError::NoLines));
    }

    #[test]
    fn a_band_without_lines_says_so() {
        let band = Band { from: 5.0, to: 6.0 };
        assert_eq!(
            band.lines(&[1.0, 2.0]),
            Err(AveragingError::EmptyBand { from: 5.0, to: 6.0, first: 1.0, last: 2.0 })
        );
        assert_eq!(Band { from: 1.0, to: 2.0 }.lines(&[1.0, 2.0, 3.0]), Ok(0..2));
    }

    #[test]
    fn a_handful_of_lines_still_has_a_band() {
        let band = quietest_band(&[10.0, 20.0, 30.0], &[vec![1.0, 1.0, 1.0]]).unwrap();
        assert_eq!((band.from, band.to), (10.0, 30.0));
    }
}
