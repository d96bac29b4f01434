//! Shares with their binomial uncertainty.

use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF, Discrete, Hypergeometric};
use statrs::statistics::{Max, Min};

/// How many of how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(into = "StatedShare")]
pub struct Share {
    /// Cases in which it was so.
    pub of: usize,
    /// Cases that count.
    pub all: usize,
}

/// A share as files state it.
#[derive(Serialize)]
struct StatedShare {
    count: usize,
    of: usize,
    share: Option<f64>,
    ci95: [f64; 2],
}

impl From<Share> for StatedShare {
    fn from(share: Share) -> Self {
        StatedShare { count: share.of, of: share.all, share: share.value(), ci95: share.interval() }
    }
}

impl Share {
    /// Counts the items for which `so` holds.
    pub(crate) fn count<T>(items: impl IntoIterator<Item = T>, so: impl Fn(T) -> bool) -> Self {
        let mut share = Share::default();
        for item in items {
            share.all += 1;
            share.of += usize::from(so(item));
        }
        share
    }

    /// The share itself; `None` of nothing.
    pub fn value(self) -> Option<f64> {
        (self.all > 0).then(|| self.of as f64 / self.all as f64)
    }

    /// How many of how many with the interval, in a few words.
    pub(crate) fn briefly(self) -> String {
        let [low, high] = self.interval();
        format!("{} of {} ({low:.2} to {high:.2})", self.of, self.all)
    }

    /// Two-sided 95 % interval by Clopper and Pearson, quantiles of the beta distribution; everything where
    /// nothing was counted.
    pub fn interval(self) -> [f64; 2] {
        let quantile = |successes: usize, failures: usize, at: f64| {
            Beta::new(successes as f64, failures as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(at))
        };
        let failures = self.all - self.of;
        let low = if self.of == 0 { 0.0 } else { quantile(self.of, failures + 1, 0.025) };
        let high = if failures == 0 { 1.0 } else { quantile(self.of + 1, failures, 0.975) };
        [low, high]
    }

    /// Probability, were both shares drawn alike, of two that differ at least as much (Fisher's exact test).
    pub(crate) fn agreement(self, other: Share) -> f64 {
        let (all, right) = ((self.all + other.all) as u64, (self.of + other.of) as u64);
        // More right ones, or more drawn, than there are: two shares of the same cases have neither.
        let Ok(drawn) = Hypergeometric::new(all, right, self.all as u64) else { return f64::NAN };
        let own = drawn.ln_pmf(self.of as u64) + 1e-9;
        let possible = (drawn.min()..=drawn.max()).map(|k| drawn.ln_pmf(k));
        possible.filter(|ln| *ln <= own).map(f64::exp).sum::<f64>().min(1.0)
    }
}

/// Quantile of values by the nearest rank; `None` of none.
pub(crate) fn quantile(values: &[f64], at: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = ((at * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len().max(1));
    sorted.get(rank - 1).copied()
}

/// The middle value, the mean of the two middle ones of an even number; `None` of none.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    (n > 0).then(|| 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]))
}

/// The median of values, and their number.
pub(crate) fn middle(values: impl Iterator<Item = f64>) -> (Option<f64>, usize) {
    let values: Vec<f64> = values.collect();
    (median(&values), values.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_share_is_that_of_the_tables() {
        // Clopper and Pearson for 8 of 10: 0.4439 to 0.9748; for 0 of 20: to 1 − 0.025^(1/20).
        let [low, high] = Share { of: 8, all: 10 }.interval();
        assert!((low - 0.4439).abs() < 1e-4 && (high - 0.9748).abs() < 1e-4, "{low} to {high}");
        let [low, high] = Share { of: 0, all: 20 }.interval();
        assert!(low == 0.0 && (high - (1.0 - 0.025f64.powf(0.05))).abs() < 1e-9, "{low} to {high}");
        assert_eq!(Share::default().interval(), [0.0, 1.0]);
    }

    #[test]
    fn equal_shares_agree_and_opposite_ones_do_not() {
        assert!(Share { of: 9, all: 10 }.agreement(Share { of: 90, all: 100 }) > 0.99);
        assert!(Share { of: 0, all: 10 }.agreement(Share { of: 10, all: 10 }) < 1e-4);
        // Fisher's tea: three of four against one of four, 34/70.
        let tea = Share { of: 3, all: 4 }.agreement(Share { of: 1, all: 4 });
        assert!((tea - 34.0 / 70.0).abs() < 1e-12, "{tea}");
    }

    #[test]
    fn quantiles_are_values_and_the_median_lies_between() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.95), Some(3.0));
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(median(&[4.0, 1.0]), Some(2.5));
    }
}
