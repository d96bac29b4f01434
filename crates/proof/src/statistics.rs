//! Shares with their binomial uncertainty.

/// How many of how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// Cases in which it was so.
    pub of: usize,
    /// Cases that count.
    pub all: usize,
}

impl Share {
    /// Counts the items for which `so` holds.
    pub fn count<T>(items: impl IntoIterator<Item = T>, so: impl Fn(T) -> bool) -> Self {
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

    /// Two-sided 95 % interval by Clopper and Pearson; everything where nothing was counted.
    pub fn interval(self) -> [f64; 2] {
        let Share { of, all } = self;
        if all == 0 {
            return [0.0, 1.0];
        }
        let tail = 0.025;
        // Below p the count is too high to be chance; above it, too low.
        let low = if of == 0 { 0.0 } else { bisect(|p| 1.0 - cumulative(of - 1, all, p) < tail) };
        let high = if of == all { 1.0 } else { bisect(|p| cumulative(of, all, p) > tail) };
        [low, high]
    }

    /// Probability, were both shares drawn alike, of two that differ at least as much (Fisher's exact test).
    pub fn agreement(self, other: Share) -> f64 {
        let (right, first, all) = (self.of + other.of, self.all, self.all + other.all);
        let log = log_factorials(all);
        let choose = |n: usize, k: usize| log[n] - log[k] - log[n - k];
        let probability =
            |k: usize| (choose(first, k) + choose(all - first, right - k) - choose(all, right)).exp();
        let possible = right.saturating_sub(all - first)..=right.min(first);
        let own = probability(self.of) * (1.0 + 1e-9);
        possible.map(probability).filter(|p| *p <= own).sum::<f64>().min(1.0)
    }
}

/// Where a condition that holds at 0 ceases to hold on its way to 1.
fn bisect(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Probability of at most `k` of `n` at a chance `p` each.
fn cumulative(k: usize, n: usize, p: f64) -> f64 {
    let log = log_factorials(n);
    let term = |i: usize| {
        let ways = log[n] - log[i] - log[n - i];
        (ways + i as f64 * p.ln() + (n - i) as f64 * (-p).ln_1p()).exp()
    };
    (0..=k.min(n)).map(term).sum::<f64>().min(1.0)
}

/// ln 0! to ln n!.
fn log_factorials(n: usize) -> Vec<f64> {
    let mut all = vec![0.0; n + 1];
    for i in 1..=n {
        all[i] = all[i - 1] + (i as f64).ln();
    }
    all
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
