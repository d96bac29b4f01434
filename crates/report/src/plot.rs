//! A plot as a page describes it: axes, series over spectral lines, reference lines and bands of frequency.

mod data;
mod drawing;
mod figure;
mod frf;
mod range;
mod svg;
mod table;
mod thin;

pub(crate) use data::PlotBook;
pub(crate) use frf::{Curve, FrfPanes, over_unity, worst};
pub(crate) use range::{Span, YRange};

use serde::{Serialize, Serializer};

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Spacing {
    /// Equal steps of the quantity.
    Linear,
    /// Equal steps of its logarithm; values that are not positive cannot be drawn and become gaps.
    Logarithmic,
}

/// An axis: what is drawn along it and in which SI unit the values are given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Axis {
    pub label: String,
    pub unit: String,
    pub spacing: Spacing,
}

impl Axis {
    /// An evenly divided axis. `unit` is that of the values as they are passed (`N/m`); an ordinate is drawn
    /// in a prefixed one (`MN/m`) where that reads better.
    pub(crate) fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), spacing: Spacing::Linear }
    }

    /// A logarithmically divided axis, as for the modulus of a receptance.
    pub(crate) fn logarithmic(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { spacing: Spacing::Logarithmic, ..Self::linear(label, unit) }
    }

    /// The frequency axis of most plots here: linear, in Hz.
    pub(crate) fn frequency() -> Self {
        Self::linear("Frequency", "Hz")
    }

    fn is_logarithmic(&self) -> bool {
        self.spacing == Spacing::Logarithmic
    }

    /// Whether a value has a place on the axis.
    fn can_show(&self, value: f64) -> bool {
        value.is_finite() && (value > 0.0 || !self.is_logarithmic())
    }
}

/// What a line stands for. The role sets the colour (told apart by readers with any common colour vision, on
/// light and dark ground), so one meaning has one colour throughout a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// What was measured.
    Measured,
    /// What the fixture file says.
    Nominal,
    /// What the program found: a fit, an average.
    Estimate,
    /// How well it is known; usually a band.
    Uncertainty,
    /// A value to compare with, such as a textbook or a datasheet value.
    Reference,
    /// What the reader must look at.
    Highlight,
    /// One of several equal curves, such as the FRFs of one test; colours repeat after six.
    Trace(usize),
}

impl Role {
    /// The name under which the style sheet keeps the colour.
    pub(crate) fn colour(self) -> &'static str {
        const TRACES: [&str; 6] = ["trace-1", "trace-2", "trace-3", "trace-4", "trace-5", "trace-6"];
        match self {
            Role::Measured => "measured",
            Role::Nominal => "nominal",
            Role::Estimate => "estimate",
            Role::Uncertainty => "uncertainty",
            Role::Reference => "reference",
            Role::Highlight => "highlight",
            Role::Trace(index) => TRACES[index % TRACES.len()],
        }
    }
}

impl Serialize for Role {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.colour())
    }
}

/// An ordinate: a number, or nothing where a line is masked. Numbers that are not finite are nothing, too.
pub(crate) trait Ordinate: Copy {
    /// The number to be drawn, if there is one.
    fn drawn(self) -> Option<f64>;
}

impl Ordinate for f64 {
    fn drawn(self) -> Option<f64> {
        self.is_finite().then_some(self)
    }
}

impl Ordinate for Option<f64> {
    fn drawn(self) -> Option<f64> {
        self.and_then(f64::drawn)
    }
}

impl<T: Ordinate> Ordinate for &T {
    fn drawn(self) -> Option<f64> {
        (*self).drawn()
    }
}

/// Numbers to draw, one a line.
pub(crate) trait Values {
    /// A series is one contiguous array: a gap is a NaN.
    fn gaps_as_nan(self) -> Vec<f64>;
}

impl<I: IntoIterator<Item: Ordinate>> Values for I {
    fn gaps_as_nan(self) -> Vec<f64> {
        self.into_iter().map(|value| value.drawn().unwrap_or(f64::NAN)).collect()
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Style {
    /// A full line, interrupted where a value is missing.
    Line,
    /// A dashed line, as for models beside measurements.
    Dashed,
    /// A dotted line, as for a second model.
    Dotted,
    /// Unconnected points.
    Points,
    /// A translucent area between two edges.
    Band,
}

/// One series.
#[derive(Debug, Clone)]
struct Series {
    label: String,
    role: Role,
    style: Style,
    table: usize,
    values: Vec<f64>,
    /// Lower edge of a band, whose upper edge is `values`; empty for all other styles.
    low: Vec<f64>,
}

impl Series {
    /// Its values, or a band's lower and upper edge.
    fn edges(&self) -> impl Iterator<Item = &[f64]> {
        let low = (self.style == Style::Band).then_some(self.low.as_slice());
        low.into_iter().chain([self.values.as_slice()])
    }
}

/// What is drawn across the plot rather than over spectral lines.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "lowercase")]
enum Mark {
    Horizontal {
        #[serde(skip)]
        label: String,
        colour: Role,
        at: f64,
    },
    Vertical {
        #[serde(skip)]
        label: String,
        colour: Role,
        at: f64,
    },
    Shaded {
        #[serde(skip)]
        label: String,
        from: f64,
        to: f64,
    },
}

/// What the shaded band is called over which averages are taken.
pub(crate) const AVERAGING_BAND: &str = "averaging band";

/// Digits of the ordinates; more than a screen can show at any sensible zoom.
const DIGITS: usize = 5;

impl Mark {
    /// Whether the legend has it.
    fn is_named(&self) -> bool {
        let (Mark::Horizontal { label, .. } | Mark::Vertical { label, .. } | Mark::Shaded { label, .. }) =
            self;
        !label.is_empty()
    }
}

/// Spectral lines above which a plot is drawn thinned, so that a page of long recordings stays small.
const LINE_LIMIT: usize = 2_000;

/// A plot of one or more series over a common abscissa.
///
/// Series are drawn in the order in which they are added, bands below all others. Lengths are checked when
/// the page is [rendered](crate::page::Page::to_html).
#[derive(Debug, Clone)]
pub(crate) struct Plot {
    title: String,
    x: Axis,
    y: Axis,
    y_range: YRange,
    tables: Vec<Vec<f64>>,
    series: Vec<Series>,
    marks: Vec<Mark>,
    caption: Option<String>,
    group: Option<String>,
    height: u32,
    line_limit: usize,
    digits: usize,
    step: Option<f64>,
    masked: Option<usize>,
    is_strip: bool,
}

impl Plot {
    /// An empty plot. Plots whose abscissae have the same label and unit share cursor and zoom unless they
    /// stand [`alone`](Self::alone).
    pub(crate) fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            group: Some(format!("{} ({})", x.label, x.unit)),
            x,
            y,
            y_range: YRange::Full,
            tables: Vec::new(),
            series: Vec::new(),
            marks: Vec::new(),
            caption: None,
            height: 240,
            line_limit: LINE_LIMIT,
            digits: DIGITS,
            step: None,
            masked: None,
            is_strip: false,
        }
    }

    /// The abscissa of the series added after it, finite and strictly ascending. May be called again for
    /// series over other lines.
    pub(crate) fn over(mut self, abscissa: impl Values) -> Self {
        self.tables.push(abscissa.gaps_as_nan());
        self
    }

    /// A full line, interrupted where a value is missing.
    pub(crate) fn line(self, label: impl Into<String>, role: Role, values: impl Values) -> Self {
        self.series(Style::Line, label, role, values)
    }

    /// A dashed line, as for models beside measurements.
    pub(crate) fn dashed(self, label: impl Into<String>, role: Role, values: impl Values) -> Self {
        self.series(Style::Dashed, label, role, values)
    }

    /// Unconnected points.
    pub(crate) fn points(self, label: impl Into<String>, role: Role, values: impl Values) -> Self {
        self.series(Style::Points, label, role, values)
    }

    /// A translucent band between two edges, such as a 95 % interval. Where either edge is missing, so is the
    /// band.
    pub(crate) fn band(
        self,
        label: impl Into<String>,
        role: Role,
        low: impl Values,
        high: impl Values,
    ) -> Self {
        self.add(Style::Band, label.into(), role, low.gaps_as_nan(), high.gaps_as_nan())
    }

    /// A series in the style given.
    pub(crate) fn series(
        self,
        style: Style,
        label: impl Into<String>,
        role: Role,
        values: impl Values,
    ) -> Self {
        self.add(style, label.into(), role, Vec::new(), values.gaps_as_nan())
    }

    fn add(mut self, style: Style, label: String, role: Role, low: Vec<f64>, values: Vec<f64>) -> Self {
        let table = self.tables.len().saturating_sub(1);
        self.series.push(Series { label, role, style, table, values, low });
        self
    }

    /// A horizontal reference line at an ordinate; left out when that is not finite.
    pub(crate) fn horizontal(mut self, label: impl Into<String>, colour: Role, at: f64) -> Self {
        let line = at.is_finite().then(|| Mark::Horizontal { label: label.into(), colour, at });
        self.marks.extend(line);
        self
    }

    /// A vertical line at an abscissa, such as a natural frequency; left out when that is not finite.
    pub(crate) fn vertical(mut self, label: impl Into<String>, colour: Role, at: f64) -> Self {
        self.marks.extend(at.is_finite().then(|| Mark::Vertical { label: label.into(), colour, at }));
        self
    }

    /// A shaded part of the abscissa, such as the band over which averages are taken; left out when an end is
    /// not finite. What has no label has no entry in the legend.
    pub(crate) fn shaded(mut self, label: impl Into<String>, from: f64, to: f64) -> Self {
        let ends = Some((from.min(to), from.max(to))).filter(|_| from.is_finite() && to.is_finite());
        self.marks.extend(ends.map(|(from, to)| Mark::Shaded { label: label.into(), from, to }));
        self
    }

    /// The part of the ordinate that is drawn at first.
    pub(crate) fn y_range(self, y_range: YRange) -> Self {
        Self { y_range, ..self }
    }

    /// One sentence which says what is seen; without it the sentence is made of the labels.
    pub(crate) fn caption(self, caption: impl Into<String>) -> Self {
        Self { caption: Some(caption.into()), ..self }
    }

    /// Shares cursor and zoom with no other plot.
    pub(crate) fn alone(self) -> Self {
        Self { group: None, ..self }
    }

    /// Height of the drawing in CSS pixels (240 unless said otherwise).
    pub(crate) fn height(self, height: u32) -> Self {
        Self { height, ..self }
    }

    /// A strip below the first of the plots before it: in rows of several, nothing stands beside it.
    pub(crate) fn strip(self) -> Self {
        Self { is_strip: true, ..self }
    }

    /// How many lines are said to be masked. Unless stated, that is the number of gaps of the series with
    /// most of them, which is wrong where one curve is split into two series.
    pub(crate) fn masked(self, lines: usize) -> Self {
        Self { masked: Some(lines), ..self }
    }

    /// Digits of the ordinates on the page (5 unless said otherwise).
    pub(crate) fn digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// Rounds the ordinates on the page to multiples of a step.
    pub(crate) fn rounded_to(self, step: f64) -> Self {
        Self { step: Some(step), ..self }
    }

    /// Its heading.
    pub(crate) fn title(&self) -> &str {
        &self.title
    }

    /// Lines above which the plot is drawn thinned, its peaks kept.
    pub(crate) fn line_limit(self, line_limit: usize) -> Self {
        Self { line_limit, ..self }
    }
}
