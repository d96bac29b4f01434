//! What normal distributions say: intervals, tests, who is larger.

use jointscope_inference::{Z95, normal_below};
use std::f64::consts::TAU;

/// 95 % interval of the ratio b/a of two normal numbers (Fieller): every r that b − r·a does not exclude.
/// `None` where a cannot be told from zero.
pub(crate) fn ratio_interval(a: f64, b: f64, [aa, ab, bb]: [f64; 3]) -> Option<[f64; 2]> {
    let z2 = Z95 * Z95;
    let (first, middle, last) = (a * a - z2 * aa, a * b - z2 * ab, b * b - z2 * bb);
    if first <= 0.0 {
        return None;
    }
    let root = (middle * middle - first * last).max(0.0).sqrt();
    Some([(middle - root) / first, (middle + root) / first])
}

/// Steps of a bisection.
const BISECTIONS: usize = 80;

/// 95 % interval of a number that is normal by each of several laws: weight, mean and variance.
pub(crate) fn mixed_interval(parts: &[(f64, f64, f64)]) -> [f64; 2] {
    let total: f64 = parts.iter().map(|(weight, ..)| weight).sum();
    let below = |x: f64| {
        let of = |&(weight, mean, variance): &(f64, f64, f64)| {
            let z = (x - mean) / variance.max(0.0).sqrt();
            weight * if z.is_nan() { 0.5 } else { normal_below(z) }
        };
        parts.iter().map(of).sum::<f64>() / total
    };
    let reach = |sign: f64| {
        let ends = parts.iter().map(|(_, mean, variance)| sign * mean + FAR * variance.max(0.0).sqrt());
        sign * ends.fold(f64::NEG_INFINITY, f64::max)
    };
    let outside = normal_below(-Z95);
    [outside, 1.0 - outside].map(|share| bisected(reach(-1.0), reach(1.0), |x| below(x) > share))
}

/// Where `is_beyond` begins to hold between two ends.
fn bisected(mut low: f64, mut high: f64, is_beyond: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_beyond(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// The same of the ratio b/a, normal by each law with a weight, a, b and their variances and covariance:
/// every r that b − r·a does not exclude. `None` where a cannot be told from zero by one of them.
pub(crate) fn mixed_ratio_interval(parts: &[(f64, [f64; 2], [f64; 3])]) -> Option<[f64; 2]> {
    let each: Option<Vec<[f64; 2]>> =
        parts.iter().map(|&(_, [a, b], variances)| ratio_interval(a, b, variances)).collect();
    let each = each?;
    if let [only] = each[..] {
        return Some(only);
    }
    let total: f64 = parts.iter().map(|(weight, ..)| weight).sum();
    let below = |r: f64| {
        let of = |&(weight, [a, b], [aa, ab, bb]): &(f64, [f64; 2], [f64; 3])| {
            let z = (r * a - b) / (bb - 2.0 * r * ab + r * r * aa).max(0.0).sqrt();
            weight * if z.is_nan() { 0.5 } else { normal_below(a.signum() * z) }
        };
        parts.iter().map(of).sum::<f64>() / total
    };
    let outside = normal_below(-Z95);
    // Every part's interval holds all but this share of it: the mixture's lies between the outermost of their
    // ends.
    let low = each.iter().map(|[low, _]| *low).fold(f64::INFINITY, f64::min);
    let high = each.iter().map(|[_, high]| *high).fold(f64::NEG_INFINITY, f64::max);
    Some([outside, 1.0 - outside].map(|share| bisected(low, high, |r| below(r) > share)))
}

/// Standard deviations beyond which a normal number is not looked for.
const FAR: f64 = 9.0;
/// Intervals between two kinks.
const STEPS: usize = 2000;

/// P(|b| > |a|) of two normal numbers with these variances and covariance.
pub(crate) fn larger_magnitude(a: f64, b: f64, [aa, ab, bb]: [f64; 3]) -> f64 {
    // |b| > |a| where b − a and b + a have the same sign.
    let (difference, sum) = (b - a, b + a);
    let variance = [(aa + bb - 2.0 * ab).max(0.0), (aa + bb + 2.0 * ab).max(0.0)];
    let [sd, ss] = variance.map(f64::sqrt);
    let positive = |mean: f64, std: f64| match std > 0.0 {
        true => normal_below(mean / std),
        false if mean == 0.0 => 0.5,
        false => f64::from(u8::from(mean > 0.0)),
    };
    if ss == 0.0 || sd == 0.0 {
        let (p, q) = (positive(difference, sd), positive(sum, ss));
        return p * q + (1.0 - p) * (1.0 - q);
    }
    let slope = (bb - aa) / ss;
    let rest = (sd * sd - slope * slope).max(0.0).sqrt();
    let integrand = |t: f64, sign: f64| {
        let density = (-0.5 * t * t).exp() / TAU.sqrt();
        density * positive(sign * (difference + slope * t), rest)
    };
    // Simpson's rule between the sum's sign change and the conditional difference's.
    let kinks =
        [-sum / ss, -difference / slope].map(|t| if t.is_finite() { t.clamp(-FAR, FAR) } else { FAR });
    let mut ends = [-FAR, kinks[0].min(kinks[1]), kinks[0].max(kinks[1]), FAR];
    ends.sort_by(f64::total_cmp);
    let piece = |pair: &[f64]| {
        let step = (pair[1] - pair[0]) / STEPS as f64;
        let sign = if 0.5 * (pair[0] + pair[1]) * ss + sum > 0.0 { 1.0 } else { -1.0 };
        let weight = |i: usize| match i {
            0 | STEPS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..=STEPS).map(|i| weight(i) * integrand(pair[0] + step * i as f64, sign)).sum::<f64>() * step / 3.0
    };
    ends.windows(2).map(piece).sum::<f64>().clamp(0.0, 1.0)
}

/// χ² of a vector of mean zero and this covariance, row-major, with its degrees of freedom. Numbers without a
/// variance and combinations that others fix are left out; `None` where none is left.
pub(crate) fn mahalanobis(values: &[f64], covariance: &[f64]) -> Option<(f64, usize)> {
    let n = values.len();
    let largest = |i: usize| covariance[i * n + i] > 0.0;
    let mut left: Vec<usize> = (0..n).filter(|&i| largest(i)).collect();
    let scale: Vec<f64> =
        (0..n).map(|i| if largest(i) { covariance[i * n + i].sqrt() } else { 1.0 }).collect();
    // Cholesky's factor with the largest pivot first, of the correlations.
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    let (mut chi2, mut solved) = (0.0, Vec::<f64>::new());
    let row = |i: usize, rows: &[(usize, Vec<f64>)]| {
        let mut entries: Vec<f64> = Vec::with_capacity(rows.len() + 1);
        for (k, (pivot, above)) in rows.iter().enumerate() {
            let dot: f64 = entries.iter().zip(above).map(|(a, b)| a * b).sum();
            entries.push((covariance[i * n + pivot] / (scale[i] * scale[*pivot]) - dot) / above[k]);
        }
        let rest = 1.0 - entries.iter().map(|e| e * e).sum::<f64>();
        (entries, rest)
    };
    while !left.is_empty() {
        let candidates = left.iter().map(|&i| (i, row(i, &rows)));
        let (index, (mut entries, rest)) = candidates.max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        if rest <= FIXED {
            break;
        }
        let dot: f64 = entries.iter().zip(&solved).map(|(a, b)| a * b).sum();
        let value = (values[index] / scale[index] - dot) / rest.sqrt();
        chi2 += value * value;
        solved.push(value);
        entries.push(rest.sqrt());
        rows.push((index, entries));
        left.retain(|other| *other != index);
    }
    (!rows.is_empty()).then_some((chi2, rows.len()))
}

/// Share of a variance that is rounding: what is left of it is fixed by other numbers.
const FIXED: f64 = 1e-10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_magnitude_of_two_is_as_probable_as_the_closed_form_says() {
        // Far from zero: Φ of the difference in its deviations.
        let p = larger_magnitude(100.0, 103.0, [4.0, 3.0, 9.0]);
        assert!((p - normal_below(3.0 / 7f64.sqrt())).abs() < 1e-9, "{p}");
        let negative = larger_magnitude(-100.0, -103.0, [4.0, 3.0, 9.0]);
        assert!((p - negative).abs() < 1e-9);
        // Equal distributions, correlated or not, negative or positive: one half.
        for ab in [-0.9, 0.0, 0.99] {
            assert!((larger_magnitude(0.3, 0.3, [1.0, ab, 1.0]) - 0.5).abs() < 1e-6, "{ab}");
        }
        // Means of zero, independent: (2/π) atan(ratio of deviations).
        let p = larger_magnitude(0.0, 0.0, [1.0, 0.0, 4.0]);
        assert!((p - 2.0 / std::f64::consts::PI * 2f64.atan()).abs() < 1e-6, "{p}");
        assert_eq!(larger_magnitude(1.0, 2.0, [0.0; 3]), 1.0);
    }

    #[test]
    fn the_interval_of_a_ratio_is_fiellers_and_open_where_the_divisor_may_be_zero() {
        // Errors in common cancel: both a tenth off in the same direction.
        let [low, high] = ratio_interval(10.0, 20.0, [0.01, 0.02, 0.04]).unwrap();
        assert!((low - 2.0).abs() < 1e-7 && (high - 2.0).abs() < 1e-7, "{low} {high}");
        let [low, high] = ratio_interval(1e3, 9e2, [1.0, 0.0, 1.0]).unwrap();
        let first_order = Z95 * (1.0f64 + 0.81).sqrt() / 1e3;
        assert!((high - low - 2.0 * first_order).abs() < 1e-6, "{low} {high}");
        assert!(ratio_interval(1.0, 5.0, [1.0, 0.0, 1.0]).is_none());
    }

    #[test]
    fn a_number_that_others_fix_counts_no_degree_of_freedom() {
        // The third is the sum of the first two; the fourth has no variance.
        let rows = [[1.0, 0.0, 1.0, 0.0], [0.0, 4.0, 4.0, 0.0], [1.0, 4.0, 5.0, 0.0], [0.0; 4]];
        let (chi2, degrees) = mahalanobis(&[2.0, 2.0, 4.0, 0.0], rows.as_flattened()).unwrap();
        assert_eq!(degrees, 2);
        assert!((chi2 - 5.0).abs() < 1e-9, "{chi2}");
        assert!(mahalanobis(&[1.0], &[0.0]).is_none());
    }
}
