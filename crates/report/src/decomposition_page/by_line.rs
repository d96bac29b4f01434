//! K and C over the spectral lines.

use jointscope_averaging::Band;
use jointscope_decomposition::Analysis;

use super::Subject;
use super::element::{Element, Kind};
use super::estimate::{Estimate, Method};
use crate::{Axis, Plot, Role, Section, YRange};

/// Lines beyond which panes are drawn thinned, so that a page of long recordings stays small.
pub(super) const LINE_LIMIT: usize = 2_000;

pub(super) fn sections(subject: &Subject) -> [Section; 2] {
    let columns = if subject.is_scalar() { 1 } else { 2 };
    let symbols = if subject.is_paper() { ("K", "C") } else { ("k", "c") };
    [(Kind::Stiffness, "Stiffness", symbols.0), (Kind::Damping, "Damping", symbols.1)].map(
        |(kind, word, symbol)| {
            let mut section = Section::new(format!("{word} by line")).paragraph(introduction(subject, kind, symbol));
            if kind == Kind::Stiffness && subject.is_paper() {
                section = section.paragraph(
                    "Eq (7) takes the motion at both ends of the joint as that of one place. It leaves out the transport \
                     R = [[1, L],[0, 1]] over the joint's length: a rotation of the near end moves the far end by L·θ, and a \
                     force there is a moment F·L here. On a beam of length L the result varies with frequency, has peaks, is \
                     not symmetric, and tends to EI/L³·[[12, 6L],[−6L, −2L²]] at high frequency: K₂₁ and K₂₂ are negative \
                     there. Signs are those of eq (7).",
                );
            }
            let elements = Element::all(subject.is_scalar());
            section.plots(columns, elements.iter().map(|element| plot(subject, kind, *element)))
        },
    )
}

fn introduction(subject: &Subject, kind: Kind, symbol: &str) -> String {
    let analysis = subject.analysis;
    let noisy = analysis.noisy_lines();
    let of = match kind {
        Kind::Stiffness => "the real part of the dynamic stiffness",
        Kind::Damping => "its imaginary part over ω",
    };
    let solved = analysis.spectrum.solved.len();
    let dots = match noisy {
        0 => String::new(),
        n => format!(
            " Dots: {n} of {solved} lines on which noise exceeds 30 % of an element of k; the interval is only indicative there."
        ),
    };
    format!(
        "{symbol} on each line, {of}, by {}. The light band is the 95 % interval from noise alone, gaps are masked lines.{dots}",
        subject.relation_words()
    )
}

fn plot(subject: &Subject, kind: Kind, element: Element) -> Plot {
    let analysis = subject.analysis;
    let paper = subject.is_paper();
    let symbol = kind.symbol(element, paper);
    let columns = Columns::of(analysis, kind, element);
    let level = level(subject, kind, element);
    let range = columns.range(analysis, level.map(|(_, value)| value));
    let band = analysis.averages.band;
    let axis = Axis::linear(symbol.clone(), kind.unit(element));
    let mut plot = Plot::new(format!("{symbol}, {}", kind.meaning(element)), Axis::frequency(), axis)
        .over(analysis.spectrum.h41.lines.hz());
    if columns.low.iter().any(Option::is_some) {
        plot = plot.band("95 % interval", Role::Uncertainty, columns.low, columns.high);
    }
    if columns.noisy.iter().any(Option::is_some) {
        plot = plot.points("noise dominates", Role::Uncertainty, columns.noisy);
    }
    plot = plot.line("by line", Role::Measured, columns.quiet);
    if columns.nominal.iter().any(Option::is_some) {
        plot = plot.dashed("nominal", Role::Nominal, columns.nominal);
    } else if let Some(nominal) = kind.nominal_average(analysis, element, paper) {
        plot = plot.horizontal("nominal", Role::Nominal, nominal);
    }
    if let Some((label, value)) = level {
        plot = plot.horizontal(label, Role::Estimate, value);
    }
    plot.shaded("averaging band", band.from, band.to)
        .y_range(range)
        .masked(analysis.spectrum.masked.len())
        .line_limit(LINE_LIMIT)
        .caption(caption(subject, kind, element))
}

/// The horizontal line: the best figure of the same relation as the spectrum.
fn level(subject: &Subject, kind: Kind, element: Element) -> Option<(&'static str, f64)> {
    let estimate = if subject.best.paper == subject.is_paper() {
        *subject.best
    } else {
        Estimate::weighted(subject.analysis).unwrap_or_else(|| Estimate::plain(subject.analysis))
    };
    let label = match estimate.method {
        Method::MaximumLikelihood => "maximum likelihood",
        Method::WeightedMean => "weighted mean",
        Method::PlainMean => "mean",
    };
    Some((label, estimate.figure(kind, element).value)).filter(|(_, value)| value.is_finite())
}

fn caption(subject: &Subject, kind: Kind, element: Element) -> String {
    let symbol = kind.symbol(element, subject.is_paper());
    let what = if subject.is_paper() {
        "eq (7) varies over the lines even for a constant joint; the dashed curve is what it makes of the fixture's".to_owned()
    } else {
        "a constant joint would be level".to_owned()
    };
    format!("{symbol}: {what}.")
}

/// One element over all lines of the recording.
struct Columns {
    quiet: Vec<Option<f64>>,
    noisy: Vec<Option<f64>>,
    low: Vec<Option<f64>>,
    high: Vec<Option<f64>>,
    nominal: Vec<Option<f64>>,
}

impl Columns {
    fn of(analysis: &Analysis, kind: Kind, element: Element) -> Self {
        let count = analysis.spectrum.h41.lines.len();
        let empty = || vec![None; count];
        let mut columns =
            Columns { quiet: empty(), noisy: empty(), low: empty(), high: empty(), nominal: empty() };
        for line in &analysis.spectrum.solved {
            let (value, std) = kind.at(line, element);
            let column = if line.is_noisy() { &mut columns.noisy } else { &mut columns.quiet };
            column[line.line] = Some(value);
            if let Some(std) = std {
                columns.low[line.line] = Some(value - 1.96 * std);
                columns.high[line.line] = Some(value + 1.96 * std);
            }
        }
        for (line, nominal) in columns.nominal.iter_mut().enumerate() {
            *nominal = kind.nominal(analysis, line, element);
        }
        columns
    }

    /// What is drawn at first: the middle of the averaging band's lines, the level and nominal curves there, and some room about
    /// them for the other lines. Poles and noisy lines would squash all of it.
    fn range(&self, analysis: &Analysis, level: Option<f64>) -> YRange {
        let hz = analysis.spectrum.h41.lines.hz();
        let band = Some(analysis.averages.band);
        let mut inside = within(&self.quiet, hz, band);
        inside.extend(within(&self.noisy, hz, band));
        let Some((mut low, mut high)) = percentiles(inside, 0.1, 0.9) else { return YRange::robust() };
        let scatter = high - low;
        if let Some((a, b)) = percentiles(within(&self.nominal, hz, band), 0.05, 0.95) {
            (low, high) = (low.min(a), high.max(b));
        }
        if let Some(level) = level {
            (low, high) = (low.min(level), high.max(level));
        }
        let room = (scatter + 0.5 * (high - low)).max(0.02 * low.abs().max(high.abs()));
        let all = within(&self.quiet, hz, None);
        let (a, b) = percentiles(all, 0.05, 0.95).unwrap_or((low, high));
        YRange::Fixed {
            low: (low - 0.3 * room).min(a.max(low - room)),
            high: (high + 0.3 * room).max(b.min(high + room)),
        }
    }
}

fn within(values: &[Option<f64>], hz: &[f64], band: Option<Band>) -> Vec<f64> {
    let inside = |hz: f64| band.is_none_or(|band| band.contains(hz));
    values.iter().zip(hz).filter_map(|(value, hz)| value.filter(|v| v.is_finite() && inside(*hz))).collect()
}

fn percentiles(mut values: Vec<f64>, low: f64, high: f64) -> Option<(f64, f64)> {
    values.sort_unstable_by(f64::total_cmp);
    let at =
        |share: f64| values.get((share * (values.len().saturating_sub(1)) as f64).round() as usize).copied();
    at(low).zip(at(high))
}
