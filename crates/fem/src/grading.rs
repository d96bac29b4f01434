//! Lines of a mesh: how an interval is divided into elements that grow away from where the strain is.

/// Ends of an interval at which elements are small, with their size there (m).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Ends {
    /// At its start.
    pub start: Option<f64>,
    /// At its end.
    pub end: Option<f64>,
}

/// Inner lines of an interval, ascending, its ends left out. Elements grow by `growth` from the fine ends and
/// never exceed `longest` (m) by much.
pub(crate) fn divide(from: f64, to: f64, ends: Ends, growth: f64, longest: f64) -> Vec<f64> {
    let length = to - from;
    let longest = longest.min(length);
    let (mut left, mut right): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let first = |size: Option<f64>| size.map(|size| size.min(longest));
    let (mut next_left, mut next_right) = (first(ends.start), first(ends.end));
    let mut covered = 0.0;
    // The last element may overshoot by half of itself; all are scaled to fit then.
    loop {
        let from_left = match (next_left, next_right) {
            (None, None) => {
                let count = (length / longest).ceil().max(1.0) as usize;
                return (1..count).map(|i| from + length * i as f64 / count as f64).collect();
            }
            (Some(l), Some(r)) => l <= r,
            (Some(_), None) => true,
            (None, Some(_)) => false,
        };
        let next = if from_left { &mut next_left } else { &mut next_right };
        let size = next.unwrap_or(longest);
        if covered + 0.5 * size >= length && !(left.is_empty() && right.is_empty()) {
            break;
        }
        covered += size;
        if from_left {
            left.push(size)
        } else {
            right.push(size)
        }
        *next = Some((size * growth).min(longest));
    }
    let mut sizes = left;
    sizes.extend(right.into_iter().rev());
    let mut at = 0.0;
    sizes.pop();
    let inner = sizes.iter().map(|size| {
        at += size;
        from + length * at / covered
    });
    inner.collect()
}

/// Values in ascending order, those that are equal to rounding once.
pub(crate) fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let span = values.last().unwrap_or(&0.0) - values.first().unwrap_or(&0.0);
    values.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * span);
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lines_ascend_within_the_interval_and_neighbours_differ_by_little_more_than_the_growth(
            length in 0.01f64..0.3, start in prop::option::of(0.0005f64..0.02), end in prop::option::of(0.0005f64..0.02),
            growth in 1.1f64..3.0, longest in 0.01f64..0.1
        ) {
            let mut lines = vec![0.2];
            lines.extend(divide(0.2, 0.2 + length, Ends { start, end }, growth, longest));
            lines.push(0.2 + length);
            let sizes: Vec<f64> = lines.windows(2).map(|w| w[1] - w[0]).collect();
            prop_assert!(sizes.iter().all(|size| *size > 0.0), "{:?}", sizes);
            prop_assert!(sizes.iter().all(|size| *size < 2.0 * longest), "{:?}", sizes);
            if let (Some(start), None) = (start, end) {
                for pair in sizes.windows(2) {
                    prop_assert!(pair[1] / pair[0] < growth * 1.001 && pair[1] / pair[0] > 0.999, "{} {:?}", start, sizes);
                }
            }
        }
    }

    #[test]
    fn equal_lines_are_one() {
        assert_eq!(distinct(vec![0.1, 0.0, 0.1 + 1e-13, 0.3]), [0.0, 0.1, 0.3]);
    }
}
