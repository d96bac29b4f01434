//! Which part of the ordinate is drawn at first.

use super::{Axis, Mark, Plot, Style};

/// The part of the ordinate that a plot shows before the reader asks for more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum YRange {
    /// All values, bands included.
    Full,
    /// From the tenth to the ninetieth percentile of each series, widened by that span on either side but
    /// never past the values: a resonance or a few noisy lines do not squash the rest. Gaussian scatter is
    /// drawn whole (±3.8 standard deviations). Bands do not count, reference lines always do. The reader is
    /// told how many values lie outside and can have the full range.
    Robust,
    /// Between two ordinates, SI.
    Fixed { low: f64, high: f64 },
    /// Between two ordinates, SI, however far the reader zooms in.
    Held { low: f64, high: f64 },
}

impl YRange {
    pub(crate) const ROBUST: (f64, f64) = (10.0, 90.0);

    /// A span with some room on either side; the robust range where there is no span to speak of.
    pub(crate) fn about(span: Span, room: f64) -> Self {
        match span.0 {
            Some((low, high)) if room > 0.0 && room.is_finite() => {
                YRange::Fixed { low: low - room, high: high + room }
            }
            _ => YRange::Robust,
        }
    }

    /// Whole decades about the values: a model's sharp antiresonance does not squash them, and the axis is
    /// labelled with powers of ten.
    pub(crate) fn decades(values: impl IntoIterator<Item = f64>) -> Self {
        match Span::of(values.into_iter().map(f64::log10)).0 {
            Some((low, high)) => {
                let (low, high) = ((low - 0.1).floor(), (high + 0.1).ceil());
                YRange::Fixed { low: 10f64.powf(low), high: 10f64.powf(high) }
            }
            None => YRange::Full,
        }
    }
}

/// Smallest and largest of some values; nothing of none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Span(pub Option<(f64, f64)>);

impl Span {
    /// Of those values that are finite.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        values.into_iter().filter(|value| value.is_finite()).fold(Self::default(), |span, value| {
            let (low, high) = span.0.unwrap_or((value, value));
            Span(Some((low.min(value), high.max(value))))
        })
    }

    /// Two percentiles (0 to 100) of those values that are finite.
    pub(crate) fn percentiles(values: impl IntoIterator<Item = f64>, (low, high): (f64, f64)) -> Self {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_unstable_by(f64::total_cmp);
        let last = values.len().saturating_sub(1) as f64;
        let at = |percent: f64| values.get((last * percent / 100.0).round() as usize).copied();
        Span(at(low).zip(at(high)))
    }

    pub(crate) fn and(self, other: Self) -> Self {
        Self::of([self.0, other.0].into_iter().flatten().flat_map(|(low, high)| [low, high]))
    }

    pub(crate) fn width(self) -> f64 {
        self.0.map_or(0.0, |(low, high)| high - low)
    }

    /// Its largest magnitude.
    pub(crate) fn magnitude(self) -> f64 {
        self.0.map_or(0.0, |(low, high)| low.abs().max(high.abs()))
    }
}

/// Ordinates between which a plot is drawn, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// At first.
    pub first: (f64, f64),
    /// All there is.
    pub full: (f64, f64),
    /// Values of all series, bands apart, which `first` leaves out.
    pub outside: usize,
}

/// A robust range this close to the full one gains nothing: the full one is drawn then.
const WORTH_CUTTING: f64 = 0.75;

pub(super) fn limits(plot: &Plot) -> Limits {
    let drawable = |value: &f64| plot.y.can_show(*value);
    let all = plot.series.iter().flat_map(|series| series.values.iter().chain(&series.low));
    let references = Span::of(plot.marks.iter().filter_map(|mark| match mark {
        Mark::Horizontal { at, .. } => Some(*at).filter(drawable),
        _ => None,
    }));
    let full = finish(Span::of(all.copied().filter(drawable)).and(references), &plot.y);
    let curves = || plot.series.iter().filter(|series| series.style != Style::Band).map(|s| &s.values);
    if let YRange::Held { low, high } = plot.y_range {
        return Limits { first: (low, high), full: (low, high), outside: 0 };
    }
    let first = match plot.y_range {
        YRange::Fixed { low, high } if low < high && drawable(&low) && high.is_finite() => (low, high),
        YRange::Full | YRange::Fixed { .. } | YRange::Held { .. } => full,
        YRange::Robust => {
            let robust = curves().map(|values| robust_span(values.iter().copied().filter(drawable), &plot.y));
            let robust = finish(robust.fold(references, Span::and), &plot.y);
            let length = |(low, high): (f64, f64)| {
                if plot.y.is_logarithmic() { (high / low).ln() } else { high - low }
            };
            if length(robust) < WORTH_CUTTING * length(full) { robust } else { full }
        }
    };
    let is_outside = |value: &&f64| drawable(value) && (**value < first.0 || **value > first.1);
    Limits { first, full, outside: curves().flatten().filter(is_outside).count() }
}

/// Percentiles of one series, widened by their span but not past its extremes.
fn robust_span(values: impl Iterator<Item = f64> + Clone, axis: &Axis) -> Span {
    let (whole, middle) = (Span::of(values.clone()), Span::percentiles(values, YRange::ROBUST));
    let (Some((smallest, largest)), Some((low, high))) = (whole.0, middle.0) else { return Span::default() };
    let (low, high) = if axis.is_logarithmic() {
        (low * low / high, high * high / low)
    } else {
        (low - (high - low), high + (high - low))
    };
    Span(Some((low.max(smallest), high.min(largest))))
}

/// A little air around the values, and never an empty range.
fn finish(span: Span, axis: &Axis) -> (f64, f64) {
    match (axis.is_logarithmic(), span.0) {
        (true, None) => (1.0, 10.0),
        (true, Some((low, high))) => {
            let air = (high / low).powf(0.04).max(1.05);
            (low / air, high * air)
        }
        (false, None) => (-1.0, 1.0),
        (false, Some((low, high))) => {
            let air = match high - low {
                width if width > 1e-9 * span.magnitude() => 0.05 * width,
                _ if high != 0.0 => 0.1 * high.abs(),
                _ => 1.0,
            };
            (low - air, high + air)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Role;

    fn stiffness(values: Vec<f64>) -> Plot {
        Plot::new("k", Axis::frequency(), Axis::linear("k", "N/m"))
            .over((0..values.len()).map(|line| line as f64))
            .line("measured", Role::Measured, values)
            .y_range(YRange::Robust)
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
    fn no_range_is_empty() {
        for values in [vec![], vec![0.0], vec![5.0, 5.0], vec![f64::NAN]] {
            let (low, high) = limits(&stiffness(values)).first;
            assert!(low < high);
        }
    }
}
