//! The frequencies at which FRFs are known, and how a frequency is written.

use crate::SpectraError;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The spectral lines of a test: frequencies in Hz, strictly ascending, zero or above. Cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralLines(Arc<[f64]>);

/// A frequency for text, Hz: nine significant digits, for the last ones of start + k·step are rounding.
///
/// ```
/// assert_eq!(jointscope_spectra::in_text(356.80000000000007).to_string(), "356.8");
/// ```
pub fn in_text(hz: f64) -> f64 {
    to_digits(hz, 9)
}

/// A frequency for a sentence, Hz: four significant digits, as resonances are told apart by.
///
/// ```
/// assert_eq!(jointscope_spectra::in_sentence(1034.375).to_string(), "1034");
/// assert_eq!(jointscope_spectra::in_sentence(0.78129).to_string(), "0.7813");
/// ```
pub fn in_sentence(hz: f64) -> f64 {
    to_digits(hz, 4)
}

fn to_digits(hz: f64, digits: usize) -> f64 {
    format!("{hz:.*e}", digits - 1).parse().unwrap_or(hz)
}

impl SpectralLines {
    /// Takes frequencies in Hz.
    ///
    /// # Errors
    /// None at all, a negative or non-finite one, or one that does not ascend.
    pub fn new(frequencies_hz: Vec<f64>) -> Result<Self, SpectraError> {
        if frequencies_hz.is_empty() {
            return Err(SpectraError::NoLines);
        }
        let mut previous = f64::NEG_INFINITY;
        for (index, &frequency) in frequencies_hz.iter().enumerate() {
            if !frequency.is_finite() || frequency < 0.0 {
                return Err(SpectraError::BadFrequency { index, frequency });
            }
            if frequency <= previous {
                return Err(SpectraError::NotAscending { index, frequency, previous });
            }
            previous = frequency;
        }
        Ok(SpectralLines(frequencies_hz.into()))
    }

    /// `count` lines from `start_hz` in steps of `step_hz`.
    ///
    /// # Errors
    /// As [`SpectralLines::new`].
    pub fn even(start_hz: f64, step_hz: f64, count: usize) -> Result<Self, SpectraError> {
        Self::new((0..count).map(|i| start_hz + step_hz * i as f64).collect())
    }

    /// Frequencies in Hz.
    pub fn hz(&self) -> &[f64] {
        &self.0
    }

    /// Number of lines, at least one.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Angular frequency of line `index`, rad/s.
    pub fn omega(&self, index: usize) -> f64 {
        TAU * self.0[index]
    }

    /// Angular frequencies, rad/s.
    pub fn omegas(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().map(|f| TAU * f)
    }

    /// Indices of the lines from `from_hz` to `to_hz`, both included.
    pub fn range(&self, from_hz: f64, to_hz: f64) -> std::ops::Range<usize> {
        let start = self.0.partition_point(|&f| f < from_hz);
        let end = self.0.partition_point(|&f| f <= to_hz);
        start..end.max(start)
    }

    /// The lines of which `keep` holds true, by index; `None` where that leaves none.
    pub fn retain(&self, keep: impl Fn(usize) -> bool) -> Option<Self> {
        let kept: Arc<[f64]> = self.0.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, &f)| f).collect();
        (!kept.is_empty()).then_some(SpectralLines(kept))
    }

    /// The least distance of neighbouring lines, Hz; `None` of a single one.
    pub fn least_spacing(&self) -> Option<f64> {
        self.0.windows(2).map(|pair| pair[1] - pair[0]).min_by(f64::total_cmp)
    }

    /// Whether `other` has the same lines to within a hundredth of the smallest spacing: analysers
    /// print the same step with different roundings.
    pub fn agrees_with(&self, other: &SpectralLines) -> bool {
        self.len() == other.len() && self.place_of(other) == Some(0)
    }

    /// The index from which on `other`, which ends no later, has the lines that follow here; `None` where it
    /// has others.
    pub fn place_of(&self, other: &SpectralLines) -> Option<usize> {
        let start = self.begin_of(other)?;
        (start + other.len() <= self.len()).then_some(start)
    }

    /// The lines of both, where these are parts of one axis that overlap by two lines or more; `None`
    /// elsewhere.
    pub fn joined(&self, other: &SpectralLines) -> Option<Self> {
        let [(first, start, second)] = match (self.begin_of(other), other.begin_of(self)) {
            (Some(start), _) => [(self, start, other)],
            (None, Some(start)) => [(other, start, self)],
            (None, None) => return None,
        };
        let overlap = (first.len() - start).min(second.len());
        let all = first.0.iter().chain(&second.0[overlap..]).copied();
        (overlap >= 2).then(|| SpectralLines(all.collect()))
    }

    /// The index at which `other` begins, if its lines and these are the same from there to where the first
    /// of them end.
    fn begin_of(&self, other: &SpectralLines) -> Option<usize> {
        if Arc::ptr_eq(&self.0, &other.0) {
            return Some(0);
        }
        let of_one = 1e-6 * self.0[0].max(1.0);
        let tolerance = self.least_spacing().map_or(of_one, |spacing| 0.01 * spacing);
        let start = self.0.partition_point(|hz| *hz < other.0[0] - tolerance);
        let both = self.0[start..].iter().zip(other.0.iter());
        (start < self.len() && both.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)).then_some(start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_do_not_ascend_or_are_not_numbers_cannot_be_built() {
        assert!(matches!(SpectralLines::new(vec![]), Err(SpectraError::NoLines)));
        assert!(matches!(
            SpectralLines::new(vec![2.0, 2.0]),
            Err(SpectraError::NotAscending { index: 1, .. })
        ));
        assert!(matches!(
            SpectralLines::new(vec![1.0, f64::NAN]),
            Err(SpectraError::BadFrequency { index: 1, .. })
        ));
        assert!(matches!(SpectralLines::new(vec![-1.0]), Err(SpectraError::BadFrequency { index: 0, .. })));
    }

    #[test]
    fn a_band_includes_both_its_ends() {
        let lines = SpectralLines::even(0.0, 2.5, 401).unwrap();
        assert_eq!(lines.range(2.5, 10.0), 1..5);
        assert_eq!(lines.range(2000.0, 3000.0).len(), 0);
        assert_eq!(lines.range(10.0, 2.5).len(), 0);
    }

    #[test]
    fn parts_of_one_axis_are_joined_and_found_in_it() {
        let part = |start: f64, count| SpectralLines::even(start, 2.5, count).unwrap();
        let whole = part(2.5, 400);
        let (low, high) = (part(2.5, 300), part(500.0, 201));
        assert_eq!(low.joined(&high).unwrap(), whole);
        assert_eq!(high.joined(&low).unwrap(), whole);
        assert_eq!(whole.joined(&part(100.0, 7)).unwrap(), whole);
        assert_eq!([&low, &high, &whole].map(|lines| whole.place_of(lines)), [Some(0), Some(199), Some(0)]);
        assert_eq!(low.place_of(&high), None, "it ends beyond");
        // Another step, an axis between the lines, parts apart, or that touch in a line alone.
        let others =
            [SpectralLines::even(5.0, 5.0, 200).unwrap(), part(3.0, 300), part(755.0, 9), part(750.0, 9)];
        assert_eq!(others.map(|other| low.joined(&other)), [None, None, None, None]);
    }

    #[test]
    fn lines_printed_with_other_roundings_agree_and_shifted_ones_do_not() {
        let lines = SpectralLines::even(10.0, 0.019531, 50_000).unwrap();
        let exact = SpectralLines::even(10.0, 0.01953125, 50_000).unwrap();
        assert!(!lines.agrees_with(&exact), "a quarter of a microhertz a line adds up to 12 mHz");
        let nearly = SpectralLines::new(exact.hz().iter().map(|f| f * (1.0 + 1e-8)).collect()).unwrap();
        assert!(nearly.agrees_with(&exact));
    }
}
