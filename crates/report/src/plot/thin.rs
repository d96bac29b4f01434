//! Thinning of very long series: what the eye would see of all lines, from far fewer.

/// Indices of the lines to draw, ascending, when there are more than `limit`; all of them otherwise.
///
/// The abscissa is cut into buckets of equal width as drawn (equal ratio on a `logarithmic` axis), and in
/// each bucket every series keeps its lowest and its highest line, so that no resonance and no antiresonance
/// is lost, and its first gap, so that masked lines stay visible as gaps. First and last line are kept. A gap
/// is a NaN. The result depends on nothing but the arguments; at most about `limit` lines remain, gaps apart.
pub(super) fn kept_lines(abscissa: &[f64], series: &[&[f64]], limit: usize, logarithmic: bool) -> Vec<usize> {
    let lines = abscissa.len();
    if lines <= limit {
        return (0..lines).collect();
    }
    let buckets = (limit.saturating_sub(2) / (2 * series.len().max(1))).max(1);
    let place = |x: f64| if logarithmic { x.max(f64::MIN_POSITIVE).ln() } else { x };
    let (start, end) = (place(first_drawable(abscissa, logarithmic)), place(abscissa[lines - 1]));
    let per_bucket = buckets as f64 / (end - start);
    // Float-to-integer casts saturate: lines before the first drawable one fall into bucket 0.
    let bucket_of = |x: f64| (((place(x) - start) * per_bucket) as usize).min(buckets - 1);

    let mut keep = vec![false; lines];
    keep[0] = true;
    keep[lines - 1] = true;
    let mut from = 0;
    while from < lines {
        let bucket = bucket_of(abscissa[from]);
        let to = from + abscissa[from..].iter().take_while(|x| bucket_of(**x) == bucket).count().max(1);
        for values in series {
            for line in extremes(values, from, to).into_iter().flatten() {
                keep[line] = true;
            }
        }
        from = to;
    }
    (0..lines).filter(|line| keep[*line]).collect()
}

/// Lowest line, highest line and first gap of a series between two lines; the first of equals.
fn extremes(values: &[f64], from: usize, to: usize) -> [Option<usize>; 3] {
    let (mut lowest, mut highest, mut gap) = (None::<usize>, None::<usize>, None);
    for line in from..to.min(values.len()) {
        let value = values[line];
        if value.is_nan() {
            gap = gap.or(Some(line));
            continue;
        }
        if lowest.is_none_or(|lowest| value < values[lowest]) {
            lowest = Some(line);
        }
        if highest.is_none_or(|highest| value > values[highest]) {
            highest = Some(line);
        }
    }
    [lowest, highest, gap]
}

fn first_drawable(abscissa: &[f64], logarithmic: bool) -> f64 {
    abscissa.iter().copied().find(|x| !logarithmic || *x > 0.0).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lines(count: usize) -> Vec<f64> {
        (0..count).map(|line| line as f64 * 0.125).collect()
    }

    #[test]
    fn short_series_are_drawn_line_by_line() {
        assert_eq!(kept_lines(&lines(5), &[&[1.0; 5]], 5, false), [0, 1, 2, 3, 4]);
        assert!(kept_lines(&[], &[], 10, false).is_empty());
    }

    #[test]
    fn a_single_masked_line_stays_a_gap() {
        let mut values = vec![1.0; 50_000];
        values[31_415] = f64::NAN;
        assert!(kept_lines(&lines(50_000), &[&values], 4_000, false).contains(&31_415));
    }

    #[test]
    fn low_frequencies_are_not_thinned_on_a_logarithmic_axis() {
        let values: Vec<f64> = (0..50_000).map(|line| f64::from(line % 7)).collect();
        let kept = kept_lines(&lines(50_000), &[&values], 4_000, true);
        assert!((1..100).all(|line| kept.contains(&line)));
        assert!(kept.len() <= 4_000);
    }

    #[test]
    fn a_resonance_of_one_line_is_kept() {
        let mut receptance = vec![1.0; 10_000];
        receptance[7_321] = 50.0;
        let kept = kept_lines(&lines(10_000), &[&receptance], 500, false);
        assert!(kept.len() <= 500 && kept.contains(&7_321));
    }

    proptest! {
        #[test]
        fn the_extremes_of_every_series_survive_and_the_limit_holds(
            first in prop::collection::vec(-1e3..1e3f64, 300..2_000),
            limit in 8usize..200,
            logarithmic: bool,
        ) {
            let second: Vec<f64> = first.iter().rev().map(|value| value * value).collect();
            let kept = kept_lines(&lines(first.len()), &[&first, &second], limit, logarithmic);
            prop_assert!(kept.len() <= limit && kept.is_sorted());
            for values in [&first, &second] {
                let extreme = |of: fn(f64, f64) -> f64| (
                    values.iter().copied().reduce(of),
                    kept.iter().map(|line| values[*line]).reduce(of),
                );
                let (all, drawn) = extreme(f64::max);
                prop_assert_eq!(all, drawn);
                let (all, drawn) = extreme(f64::min);
                prop_assert_eq!(all, drawn);
            }
        }
    }
}
