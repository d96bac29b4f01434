//! Which part of the ordinate is drawn at first.

use super::{Mark, Plot, Spacing, Style};

/// The part of the ordinate that a plot shows before the reader asks for more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum YRange {
    /// All values, bands included.
    Full,
    /// From the `low` to the `high` percentile of each series (0–100), widened by that span on either side but never past the values. Bands do
    /// not count, reference lines always do.
    Percentiles {
        /// Lower percentile.
        low: f64,
        /// Upper percentile.
        high: f64,
    },
    /// Between two ordinates, SI.
    Fixed {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl YRange {
    /// Percentiles 10 to 90: Gaussian scatter is drawn whole (±3.8 standard deviations), while a tenth of the lines may run away on either side.
    pub fn robust() -> Self {
        Self::Percentiles { low: 10.0, high: 90.0 }
    }
}

/// Ordinates between which a plot is drawn, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// At first.
    pub first: (f64, f64),
    /// All there is.
    pub full: (f64, f64),
    /// Values of all series, bands apart, which `first` leaves out.
    pub outside: usize,
}

/// A robust range this close to the full one gains nothing: the full one is drawn then.
const WORTH_CUTTING: f64 = 0.75;

pub(crate) fn limits(plot: &Plot) -> Limits {
    let logarithmic = plot.y.spacing == Spacing::Logarithmic;
    let drawable = |value: &f64| value.is_finite() && (!logarithmic || *value > 0.0);
    let mut full = Extent::default();
    for series in &plot.series {
        for value in series.values.iter().chain(&series.low).filter(|v| drawable(v)) {
            full.include(*value);
        }
    }
    let mut references = Extent::default();
    for mark in &plot.marks {
        if let Mark::Horizontal { at, .. } = mark
            && drawable(at)
        {
            references.include(*at);
        }
    }
    full.join(references);
    let full_limits = finish(full, plot.y.spacing);

    let first = match plot.y_range {
        YRange::Full => full_limits,
        YRange::Fixed { low, high } if low < high && drawable(&low) && high.is_finite() => (low, high),
        YRange::Fixed { .. } => full_limits,
        YRange::Percentiles { low, high } => {
            let mut robust = references;
            for series in plot.series.iter().filter(|s| s.style != Style::Band) {
                let values = series.values.iter().copied().filter(drawable);
                robust.join(robust_extent(values.collect(), low, high, logarithmic));
            }
            let robust = finish(robust, plot.y.spacing);
            if span(robust, logarithmic) < WORTH_CUTTING * span(full_limits, logarithmic) {
                robust
            } else {
                full_limits
            }
        }
    };
    let outside = plot
        .series
        .iter()
        .filter(|series| series.style != Style::Band)
        .flat_map(|series| &series.values)
        .filter(|value| drawable(value) && (**value < first.0 || **value > first.1))
        .count();
    Limits { first, full: full_limits, outside }
}

/// Percentiles of one series, widened by their span but not past its extremes.
fn robust_extent(mut values: Vec<f64>, low: f64, high: f64, logarithmic: bool) -> Extent {
    values.sort_unstable_by(f64::total_cmp);
    let (Some(&smallest), Some(&largest)) = (values.first(), values.last()) else {
        return Extent::default();
    };
    let at = |percent: f64| {
        let place = (values.len() - 1) as f64 * (percent / 100.0).clamp(0.0, 1.0);
        values[place.round() as usize]
    };
    let (low, high) = (at(low.min(high)), at(low.max(high)));
    let (low, high) = if logarithmic {
        (low * low / high, high * high / low)
    } else {
        (low - (high - low), high + (high - low))
    };
    Extent(Some((low.max(smallest), high.min(largest))))
}

/// A little air around the values, zero in the middle of a symmetric axis, and never an empty range.
fn finish(extent: Extent, spacing: Spacing) -> (f64, f64) {
    match (spacing, extent.0) {
        (Spacing::Logarithmic, None) => (1.0, 10.0),
        (Spacing::Logarithmic, Some((low, high))) => {
            let air = (high / low).powf(0.04).max(1.05);
            (low / air, high * air)
        }
        (_, None) => (-1.0, 1.0),
        (Spacing::Symmetric, Some((low, high))) => {
            let largest = low.abs().max(high.abs());
            let largest = if largest > 0.0 { 1.05 * largest } else { 1.0 };
            (-largest, largest)
        }
        (Spacing::Linear, Some((low, high))) => {
            let air = match high - low {
                span if span > 1e-9 * low.abs().max(high.abs()) => 0.05 * span,
                _ if high != 0.0 => 0.1 * high.abs(),
                _ => 1.0,
            };
            (low - air, high + air)
        }
    }
}

fn span((low, high): (f64, f64), logarithmic: bool) -> f64 {
    if logarithmic { (high / low).ln() } else { high - low }
}

/// Smallest and largest value met so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Extent(Option<(f64, f64)>);

impl Extent {
    fn include(&mut self, value: f64) {
        let (low, high) = self.0.unwrap_or((value, value));
        self.0 = Some((low.min(value), high.max(value)));
    }

    fn join(&mut self, other: Self) {
        if let Some((low, high)) = other.0 {
            self.include(low);
            self.include(high);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Role};

    fn stiffness(values: Vec<f64>) -> Plot {
        Plot::new("k", Axis::frequency(), Axis::linear("k", "N/m"))
            .over((0..values.len()).map(|line| line as f64))
            .line("measured", Role::Measured, values)
            .robust()
    }

    #[test]
    fn a_few_wild_lines_do_not_squash_the_readable_part() {
        let mut values: Vec<f64> = (0..1000).map(|line| 3.3e6 + f64::from(line % 10) * 1e3).collect();
        values[500] = 1e12;
        values[501] = -1e12;
        let limits = limits(&stiffness(values));
        assert!(limits.first.0 > 3.2e6 && limits.first.1 < 3.4e6, "{limits:?}");
        assert!(limits.full.1 > 1e12);
        assert_eq!(limits.outside, 2);
    }

    #[test]
    fn a_reference_line_is_always_within_the_range() {
        let values: Vec<f64> = (0..100).map(|line| 1e6 + f64::from(line)).collect();
        let limits = limits(&stiffness(values).horizontal("nominal", Role::Nominal, 3e6));
        assert!(limits.first.1 > 3e6, "{limits:?}");
    }

    #[test]
    fn scatter_without_wild_lines_is_drawn_whole() {
        let values: Vec<f64> = (0..100).map(|line| f64::from(line * line % 17)).collect();
        let limits = limits(&stiffness(values));
        assert_eq!(limits.first, limits.full);
        assert_eq!(limits.outside, 0);
    }

    #[test]
    fn a_symmetric_axis_has_zero_in_its_middle_and_no_range_is_empty() {
        let mut plot = stiffness(vec![1.0, -3.0]);
        plot.y = Axis::symmetric("residual", "1");
        let (low, high) = limits(&plot).first;
        assert_eq!(low, -high);
        for values in [vec![], vec![0.0], vec![5.0, 5.0], vec![f64::NAN]] {
            let (low, high) = limits(&stiffness(values)).first;
            assert!(low < high);
        }
    }
}
