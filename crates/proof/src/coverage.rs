//! How often stated intervals hold the true parameter, at every level, and how wide they are.

use crate::{Judged, Name, Share};
use jointscope_inference::Z95;
use serde::{Serialize, Serializer};
use serde_json::json;

/// Levels with the half widths, in standard deviations, of their intervals.
const LEVELS: [(f64, f64); 9] = [
    (0.2, 0.2533),
    (0.4, 0.5244),
    (0.5, 0.6745),
    (0.6, 0.8416),
    (0.7, 1.0364),
    (0.8, 1.2816),
    (0.9, 1.6449),
    (0.95, Z95),
    (0.99, 2.5758),
];

/// The intervals of all hidden effects that show and were found under their own names, of parameters that the
/// recording determines.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Coverage(pub(crate) Vec<Interval>);

/// A stated interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    /// Whether it holds the true value; an interval that was not stated holds nothing.
    pub holds: bool,
    /// Its width over that of the Cramér–Rao bound's.
    pub width: Option<f64>,
    /// True less estimated value, in stated standard deviations.
    pub deviation: Option<f64>,
}

impl Coverage {
    /// Collects the intervals of the given cases.
    pub(crate) fn of<'a>(judged: impl Iterator<Item = &'a Judged>) -> Self {
        let mut intervals = Vec::new();
        for judged in judged {
            for (hidden, bounds) in judged.truth.effects().iter().zip(&judged.fits.bounds) {
                let name = Name::of(hidden);
                let mut own = judged.findings().iter().filter(|found| Name::of(&found.effect) == name);
                let Some(found) = own.next() else { continue };
                for (parameter, bound) in bounds.iter().enumerate() {
                    let Some(bound) = bound else { continue };
                    let (truth, estimate) = (hidden.value(parameter), found.effect.value(parameter));
                    let stated = found.intervals.get(parameter).copied().flatten();
                    intervals.push(Interval {
                        holds: stated.is_some_and(|[low, high]| (low..=high).contains(&truth)),
                        width: stated.map(|[low, high]| (high - low) / (2.0 * Z95 * bound)),
                        deviation: stated.map(|interval| deviation(truth, estimate, interval)),
                    });
                }
            }
        }
        Coverage(intervals)
    }

    /// How many hold.
    pub(crate) fn share(&self) -> Share {
        Share::count(&self.0, |interval| interval.holds)
    }

    /// Nominal levels and how many intervals of that level would have held the true value, were they made
    /// from the same estimate and deviation as those of 95 %.
    pub fn by_level(&self) -> Vec<(f64, Share)> {
        let share =
            |half: f64| Share::count(&self.0, |interval| interval.deviation.is_some_and(|d| d.abs() <= half));
        LEVELS.iter().map(|(level, half)| (*level, share(*half))).collect()
    }

    /// Widths over those by the Cramér–Rao bound.
    pub(crate) fn widths(&self) -> Vec<f64> {
        self.0.iter().filter_map(|interval| interval.width).collect()
    }
}

impl Serialize for Coverage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let levels = self.by_level().into_iter();
        serializer.collect_seq(levels.map(|(level, held)| json!({ "level": level, "held": held })))
    }
}

/// Departure of the truth in standard deviations. An interval that is lopsided about its estimate as that of
/// a logarithm is taken as one.
fn deviation(truth: f64, estimate: f64, [low, high]: [f64; 2]) -> f64 {
    let about_the_middle = 0.5 * (low + high);
    let even = (estimate - about_the_middle).abs() <= 1e-6 * (high - low);
    if even || low <= 0.0 || truth <= 0.0 {
        return (truth - estimate) / ((high - low) / (2.0 * Z95));
    }
    (truth / estimate).ln() / ((high / low).ln() / (2.0 * Z95))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_truth_at_the_end_of_an_interval_is_1_96_deviations_off() {
        assert!((deviation(12.0, 10.0, [8.0, 12.0]) - Z95).abs() < 1e-12);
        assert!((deviation(5.0, 10.0, [5.0, 20.0]) + Z95).abs() < 1e-12);
        assert!((deviation(-12.0, -10.0, [-12.0, -8.0]) + Z95).abs() < 1e-12);
    }
}
