//! A plot as the caller describes it: axes, series over spectral lines, reference lines and bands of frequency.

mod data;
mod figure;
mod range;
mod thin;

pub(crate) use data::{ColumnPool, PlotData};
pub(crate) use figure::write_figure;
pub use range::YRange;
pub use thin::kept_lines;

use serde::Serialize;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Spacing {
    /// Equal steps of the quantity.
    Linear,
    /// Equal steps of its logarithm; values that are not positive cannot be drawn and become gaps.
    Logarithmic,
    /// Linear and centred on zero (ordinates only; an abscissa takes it as linear).
    Symmetric,
}

/// An axis: what is drawn along it and in which SI unit the values are given.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    pub(crate) label: String,
    pub(crate) unit: String,
    pub(crate) spacing: Spacing,
}

impl Axis {
    /// An evenly divided axis. `unit` is that of the values as they are passed (`N/m`); an ordinate is drawn in a prefixed one (`MN/m`) where that reads better.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), spacing: Spacing::Linear }
    }

    /// A logarithmically divided axis, as for the modulus of a receptance.
    pub fn logarithmic(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { spacing: Spacing::Logarithmic, ..Self::linear(label, unit) }
    }

    /// A linear axis with zero in its middle, as for residuals.
    pub fn symmetric(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { spacing: Spacing::Symmetric, ..Self::linear(label, unit) }
    }

    /// The frequency axis of most plots here: linear, in Hz.
    pub fn frequency() -> Self {
        Self::linear("Frequency", "Hz")
    }
}

/// What a line stands for. The role sets the colour (told apart by readers with any common colour vision, on light and dark ground), so one meaning has
/// one colour throughout a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
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
    pub(crate) fn colour_name(self) -> &'static str {
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

/// An ordinate: a number, or nothing where a line is masked. Numbers that are not finite are nothing, too.
pub trait Ordinate {
    /// The number to be drawn, if there is one.
    fn drawn(self) -> Option<f64>;
}

impl Ordinate for f64 {
    fn drawn(self) -> Option<f64> {
        self.is_finite().then_some(self)
    }
}

impl Ordinate for &f64 {
    fn drawn(self) -> Option<f64> {
        (*self).drawn()
    }
}

impl Ordinate for Option<f64> {
    fn drawn(self) -> Option<f64> {
        self.and_then(Ordinate::drawn)
    }
}

impl Ordinate for &Option<f64> {
    fn drawn(self) -> Option<f64> {
        (*self).drawn()
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Style {
    Line,
    Dashed,
    Points,
    Step,
    Band,
}

/// One series; a gap is a NaN, so that a series stays one contiguous array.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    pub label: String,
    pub role: Role,
    pub style: Style,
    pub table: usize,
    pub values: Vec<f64>,
    /// Lower edge of a band, whose upper edge is `values`; empty for all other styles.
    pub low: Vec<f64>,
}

/// What is drawn across the plot rather than over spectral lines.
#[derive(Debug, Clone)]
pub(crate) enum Mark {
    Horizontal { label: String, role: Role, at: f64 },
    Vertical { label: String, role: Role, at: f64 },
    Shaded { label: String, from: f64, to: f64 },
}

/// Spectral lines above which a plot is drawn thinned.
const DEFAULT_LINE_LIMIT: usize = 8_000;

/// A plot of one or more series over a common abscissa.
///
/// Series are drawn in the order in which they are added, bands below all others. Lengths are checked when the page is
/// [rendered](crate::Page::to_html).
///
/// ```
/// use jointscope_report::{Axis, Plot, Role};
/// let plot = Plot::new("Transverse stiffness k₁₁", Axis::frequency(), Axis::linear("k₁₁", "N/m"))
///     .over([200.0, 201.0, 202.0])
///     .band("95 % interval", Role::Measured, [3.1e6, 3.2e6, 3.1e6], [3.5e6, 3.5e6, 3.4e6])
///     .line("measured", Role::Measured, [Some(3.3e6), None, Some(3.2e6)])
///     .horizontal("nominal", Role::Nominal, 3.31e6)
///     .shaded("averaging band", 200.5, 201.5)
///     .robust()
///     .caption("The stiffness of the joint is level over the averaging band.");
/// # let _ = plot;
/// ```
#[derive(Debug, Clone)]
pub struct Plot {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) y_range: YRange,
    pub(crate) tables: Vec<Vec<f64>>,
    pub(crate) series: Vec<Series>,
    pub(crate) marks: Vec<Mark>,
    pub(crate) caption: Option<String>,
    pub(crate) group: Option<String>,
    pub(crate) height: u32,
    pub(crate) line_limit: usize,
    pub(crate) masked: Option<usize>,
}

impl Plot {
    /// An empty plot. Plots whose abscissae have the same label and unit share cursor and zoom unless
    /// [`synchronised_as`](Self::synchronised_as) or [`unsynchronised`](Self::unsynchronised) says otherwise.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        let group = format!("{} ({})", x.label, x.unit);
        Self {
            title: title.into(),
            x,
            y,
            y_range: YRange::Full,
            tables: Vec::new(),
            series: Vec::new(),
            marks: Vec::new(),
            caption: None,
            group: Some(group),
            height: 240,
            line_limit: DEFAULT_LINE_LIMIT,
            masked: None,
        }
    }

    /// The abscissa of the series added after it, finite and strictly ascending. May be called again for series over other lines.
    pub fn over<T: Ordinate>(mut self, abscissa: impl IntoIterator<Item = T>) -> Self {
        self.tables.push(gaps_as_nan(abscissa));
        self
    }

    /// A full line, interrupted where a value is missing.
    pub fn line<T: Ordinate>(
        self,
        label: impl Into<String>,
        role: Role,
        values: impl IntoIterator<Item = T>,
    ) -> Self {
        self.add(label, role, Style::Line, Vec::new(), gaps_as_nan(values))
    }

    /// A dashed line, as for models beside measurements.
    pub fn dashed<T: Ordinate>(
        self,
        label: impl Into<String>,
        role: Role,
        values: impl IntoIterator<Item = T>,
    ) -> Self {
        self.add(label, role, Style::Dashed, Vec::new(), gaps_as_nan(values))
    }

    /// Unconnected points.
    pub fn points<T: Ordinate>(
        self,
        label: impl Into<String>,
        role: Role,
        values: impl IntoIterator<Item = T>,
    ) -> Self {
        self.add(label, role, Style::Points, Vec::new(), gaps_as_nan(values))
    }

    /// A step line: each value holds from its abscissa to the next.
    pub fn step<T: Ordinate>(
        self,
        label: impl Into<String>,
        role: Role,
        values: impl IntoIterator<Item = T>,
    ) -> Self {
        self.add(label, role, Style::Step, Vec::new(), gaps_as_nan(values))
    }

    /// A translucent band between two edges, such as a 95 % interval. Where either edge is missing, so is the band.
    pub fn band<L: Ordinate, H: Ordinate>(
        self,
        label: impl Into<String>,
        role: Role,
        low: impl IntoIterator<Item = L>,
        high: impl IntoIterator<Item = H>,
    ) -> Self {
        self.add(label, role, Style::Band, gaps_as_nan(low), gaps_as_nan(high))
    }

    fn add(
        mut self,
        label: impl Into<String>,
        role: Role,
        style: Style,
        low: Vec<f64>,
        values: Vec<f64>,
    ) -> Self {
        self.series.push(Series {
            label: label.into(),
            role,
            style,
            table: self.tables.len().saturating_sub(1),
            values,
            low,
        });
        self
    }

    /// A horizontal reference line at an ordinate; left out when that is not finite.
    pub fn horizontal(mut self, label: impl Into<String>, role: Role, at: f64) -> Self {
        if at.is_finite() {
            let label = label.into();
            self.marks.push(Mark::Horizontal { label, role, at });
        }
        self
    }

    /// A vertical line at an abscissa, such as a natural frequency; left out when that is not finite.
    pub fn vertical(mut self, label: impl Into<String>, role: Role, at: f64) -> Self {
        if at.is_finite() {
            let label = label.into();
            self.marks.push(Mark::Vertical { label, role, at });
        }
        self
    }

    /// A shaded part of the abscissa, such as the band over which averages are taken; left out when an end is not finite.
    pub fn shaded(mut self, label: impl Into<String>, from: f64, to: f64) -> Self {
        if from.is_finite() && to.is_finite() {
            let label = label.into();
            let (from, to) = (from.min(to), from.max(to));
            self.marks.push(Mark::Shaded { label, from, to });
        }
        self
    }

    /// Draws only the readable part at first, so that a resonance or a few noisy lines do not squash it; see [`YRange::robust`]. The reader is told
    /// how many values lie outside and can have the full range.
    pub fn robust(self) -> Self {
        self.y_range(YRange::robust())
    }

    /// The part of the ordinate that is drawn at first.
    pub fn y_range(mut self, range: YRange) -> Self {
        self.y_range = range;
        self
    }

    /// One sentence which says what is seen; without it the sentence is made of the labels.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = Some(caption.into());
        self
    }

    /// Shares cursor and zoom with the plots of this name only.
    pub fn synchronised_as(mut self, group: impl Into<String>) -> Self {
        self.group = Some(group.into());
        self
    }

    /// Shares cursor and zoom with no other plot.
    pub fn unsynchronised(mut self) -> Self {
        self.group = None;
        self
    }

    /// Height of the drawing in CSS pixels (240 unless said otherwise, at least 80).
    pub fn height(mut self, pixels: u32) -> Self {
        self.height = pixels.max(80);
        self
    }

    /// How many lines are said to be masked. Unless stated, that is the number of gaps of the series with most of them, which
    /// is wrong where one curve is split into two series.
    pub fn masked(mut self, lines: usize) -> Self {
        self.masked = Some(lines);
        self
    }

    /// Lines above which the plot is drawn thinned, its peaks kept (8,000 unless said otherwise).
    pub fn line_limit(mut self, lines: usize) -> Self {
        self.line_limit = lines;
        self
    }
}

fn gaps_as_nan<T: Ordinate>(values: impl IntoIterator<Item = T>) -> Vec<f64> {
    values.into_iter().map(|value| value.drawn().unwrap_or(f64::NAN)).collect()
}
