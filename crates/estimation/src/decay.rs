//! What of a response is left when its record ends.

use crate::settings::ringing_left::{
    FEWEST_ON_LINE, FEWEST_SHOWN, NOISE_OVER_QUIETEST, PARTS, RINGING_SHOWS,
};

/// The amplitude left at the record's end relative to the loudest part, from the course of the power over the
/// record. Where the ringing is lost in noise before the end it is continued as it last fell.
///
/// `begin` is the hit's onset, `noise` the power of the noise, if the samples before the hit tell it.
pub(crate) fn left_at_end(values: &[f64], begin: usize, noise: Option<f64>) -> f64 {
    let ringing = &values[begin.min(values.len())..];
    let length = ringing.len() / PARTS;
    if length == 0 {
        return 0.0;
    }
    let power = |part: &[f64]| part.iter().map(|v| v * v).sum::<f64>() / part.len() as f64;
    let powers: Vec<f64> = ringing.chunks_exact(length).map(power).take(PARTS).collect();
    let largest = powers.iter().copied().fold(0.0, f64::max);
    let last = powers.last().copied().unwrap_or(0.0);
    if largest <= 0.0 {
        return 0.0;
    }
    // Louder than the quietest part the noise cannot be.
    let quietest = powers.iter().copied().fold(f64::INFINITY, f64::min);
    let floor = noise.map_or(quietest, |noise| noise.min(quietest * NOISE_OVER_QUIETEST));
    let shows = |power: &f64| *power > (1.0 + RINGING_SHOWS) * floor;
    if noise.is_some() && shows(&last) {
        return (last / largest).sqrt();
    }
    // The last run of parts that show it, its slower half.
    let loudest = powers.iter().position(|p| *p == largest).unwrap_or(0);
    let shown = powers[loudest..].iter().take_while(|p| shows(p)).count();
    if shown < FEWEST_SHOWN {
        return 0.0;
    }
    let half = shown.div_ceil(2).max(FEWEST_ON_LINE);
    let from = loudest + shown - half;
    let points: Vec<(f64, f64)> =
        (from..loudest + shown).map(|i| (i as f64, (powers[i] - floor).ln())).collect();
    let (slope, level) = straight_line(&points);
    let end = (PARTS - 1) as f64;
    (0.5 * (level + slope.min(0.0) * end - largest.ln())).exp().min(1.0)
}

/// Slope and value at 0.
fn straight_line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xx, xy) =
        points.iter().fold((0.0, 0.0), |(xx, xy), p| (xx + (p.0 - x).powi(2), xy + (p.0 - x) * (p.1 - y)));
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    (slope, y - slope * x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;

    fn ringing(decay: f64, noise: f64) -> Vec<f64> {
        let mut random = Noise::from_state(1);
        (0..8000)
            .map(|i| {
                (-decay * i as f64 / 8000.0).exp() * (0.4 * i as f64).sin()
                    + noise * (random.uniform() - 0.5) * 12f64.sqrt()
            })
            .collect()
    }

    #[test]
    fn what_is_left_is_e_to_the_minus_decay_in_view_or_below_the_noise() {
        for (decay, noise) in [(2.0, 1e-3), (4.0, 1e-3), (7.0, 5e-3), (10.0, 1e-2)] {
            let left = left_at_end(&ringing(decay, noise), 0, Some(noise * noise));
            let expected = f64::exp(-decay);
            assert!((0.4..2.5).contains(&(left / expected)), "decay {decay}: {left} for {expected}");
        }
    }

    #[test]
    fn without_samples_before_the_hit_a_record_that_is_still_loud_is_told_all_the_same() {
        let left = left_at_end(&ringing(1.5, 1e-3), 0, None);
        assert!((0.1..0.4).contains(&left), "{left}");
        assert!(left_at_end(&ringing(20.0, 1e-3), 0, None) < 1e-3);
    }
}
