//! Plots as the script on the page reads them: thinned, in display units, their columns shared.

use std::collections::HashMap;

use maud::Markup;
use serde::Serialize;

use super::drawing::Drawing;
use super::range::{Limits, limits};
use super::thin::kept_lines;
use super::{Axis, Mark, Plot, Role, Style, YRange};
use crate::error::PageError;
use crate::json::number;
use crate::unit::{Scale, typeset};

/// Digits of a band's edges, which nobody reads to the last figure.
const BAND_DIGITS: usize = 4;
/// Digits of an abscissa: neighbouring lines must stay apart however fine the resolution is.
const ABSCISSA_DIGITS: usize = 9;

/// All plots of a page in the order of their figures, with their columns of numbers; equal columns are kept
/// once.
#[derive(Debug, Default)]
pub(crate) struct PlotBook {
    plots: Vec<PlotData>,
    columns: Vec<String>,
    index: HashMap<String, usize>,
}

impl PlotBook {
    pub(crate) fn is_empty(&self) -> bool {
        self.plots.is_empty()
    }

    /// The figure of a plot, whose data are kept under its number.
    pub(crate) fn figure(&mut self, plot: &Plot) -> Result<Markup, PageError> {
        check(plot)?;
        let (data, drawing) = PlotData::new(plot, self);
        self.plots.push(data);
        Ok(super::figure::figure(self.plots.len() - 1, plot, &drawing))
    }

    fn add(&mut self, column: String) -> usize {
        let next = self.columns.len();
        *self.index.entry(column).or_insert_with_key(|column| {
            self.columns.push(column.clone());
            next
        })
    }

    /// What the script reads.
    pub(crate) fn to_json(&self) -> String {
        // Plain data without maps: serialising it cannot fail, and without plots the page would still be
        // readable.
        let described = serde_json::to_string(&self.plots).unwrap_or_else(|_| "[]".to_owned());
        format!("{{\"plots\":{described},\n\"columns\":[{}]}}", self.columns.join(",\n"))
    }
}

/// What the script needs to know of one plot. Ordinates are in the display unit.
#[derive(Debug, Serialize)]
struct PlotData {
    group: Option<String>,
    height: u32,
    x: Axis,
    y: Axis,
    /// Ordinate range at first, when the plot does not show everything.
    first: Option<(f64, f64)>,
    /// Whether `first` is to be found again among the lines in view when the reader zooms in: the
    /// percentiles.
    percentiles: Option<(f64, f64)>,
    /// Ordinate range at any zoom.
    held: Option<(f64, f64)>,
    /// Columns by table, abscissa first.
    tables: Vec<Vec<usize>>,
    series: Vec<SeriesData>,
    marks: Vec<Mark>,
}

#[derive(Debug, Serialize)]
struct SeriesData {
    style: Style,
    colour: Role,
    table: usize,
    /// Places of its columns in the table: one, or a band's lower and upper edge.
    places: Vec<usize>,
}

impl PlotData {
    /// Thins a plot and puts its columns into the book.
    fn new(plot: &Plot, book: &mut PlotBook) -> (Self, Drawing) {
        let Limits { first, full, outside } = limits(plot);
        let scale = ordinate_scale(plot, first);
        let is_cut = first != full;
        let mut drawing = Drawing { scale, is_cut, remarks: Vec::new() };
        let (tables, series) = columns(plot, book, &mut drawing);
        drawing.remark(outside, "value lies", "values lie", "outside the range drawn at first");
        let scale = &drawing.scale;
        let data = Self {
            group: plot.group.clone(),
            height: plot.height,
            x: Axis { unit: typeset(&plot.x.unit), ..plot.x.clone() },
            y: Axis { unit: scale.unit().to_owned(), ..plot.y.clone() },
            first: is_cut.then(|| (scale.of(first.0), scale.of(first.1))),
            percentiles: (plot.y_range == YRange::Robust).then_some(YRange::ROBUST),
            held: match plot.y_range {
                YRange::Held { low, high } => Some((scale.of(low), scale.of(high))),
                _ => None,
            },
            tables,
            series,
            marks: plot.marks.iter().map(|mark| mark.scaled(scale)).collect(),
        };
        (data, drawing)
    }
}

/// The unit in which ordinates between these ends are drawn.
pub(super) fn ordinate_scale(plot: &Plot, first: (f64, f64)) -> Scale {
    if plot.y.is_logarithmic() {
        // Decades are read off the powers of ten, which a prefix would only shift.
        return Scale::plain(&plot.y.unit);
    }
    Scale::for_values([first.0 * 0.95, first.1 * 0.95], &plot.y.unit)
}

impl Mark {
    fn scaled(&self, scale: &Scale) -> Self {
        let mut mark = self.clone();
        if let Mark::Horizontal { at, .. } = &mut mark {
            *at = scale.of(*at);
        }
        mark
    }
}

/// Columns of all tables, and which of them make each series.
fn columns(plot: &Plot, book: &mut PlotBook, drawing: &mut Drawing) -> (Vec<Vec<usize>>, Vec<SeriesData>) {
    let mut undrawable = 0;
    let mut tables = Vec::with_capacity(plot.tables.len());
    let mut series: Vec<SeriesData> = (plot.series.iter())
        .map(|s| SeriesData { style: s.style, colour: s.role, table: s.table, places: Vec::new() })
        .collect();
    for (table, abscissa) in plot.tables.iter().enumerate() {
        let members = || plot.series.iter().enumerate().filter(|(_, series)| series.table == table);
        let edges: Vec<&[f64]> = members().flat_map(|(_, series)| series.edges()).collect();
        if edges.is_empty() {
            tables.push(Vec::new());
            continue;
        }
        let mut kept = kept_lines(abscissa, &edges, plot.line_limit, plot.x.is_logarithmic());
        if kept.len() < abscissa.len() {
            let (some, all) = (kept.len(), abscissa.len());
            drawing.remarks.push(format!("drawn thinned to {some} of {all} lines, extremes kept"));
        }
        kept.retain(|line| plot.x.can_show(abscissa[*line]));
        let mut indices = vec![book.add(abscissa_column(abscissa, &kept))];
        for (index, member) in members() {
            let digits = if member.style == Style::Band { BAND_DIGITS.min(plot.digits) } else { plot.digits };
            for edge in member.edges() {
                undrawable += edge.iter().filter(|v| !v.is_nan() && !plot.y.can_show(**v)).count();
                let rounded = |v: f64| plot.step.map_or(v, |step| (v / step).round() * step);
                let shown = |v: f64| if plot.y.can_show(v) { rounded(drawing.scale.of(v)) } else { f64::NAN };
                series[index].places.push(indices.len());
                indices.push(book.add(column(kept.iter().map(|line| shown(edge[*line])), digits)));
            }
        }
        tables.push(indices);
    }
    let (one, several) = ("value is not positive and has", "values are not positive and have");
    drawing.remark(undrawable, one, several, "no place on a logarithmic axis");
    let gaps = |values: &[f64]| values.iter().filter(|value| value.is_nan()).count();
    let most = || plot.series.iter().map(|series| gaps(&series.values)).max().unwrap_or(0);
    drawing.remark(plot.masked.unwrap_or_else(most), "line is", "lines are", "masked (gaps)");
    (tables, series)
}

/// Lengths and order of what the caller gave.
pub(super) fn check(plot: &Plot) -> Result<(), PageError> {
    let title = || plot.title.clone();
    for abscissa in &plot.tables {
        let ascends = |i: usize| abscissa[i].is_finite() && (i == 0 || abscissa[i] > abscissa[i - 1]);
        if let Some(index) = (0..abscissa.len()).find(|index| !ascends(*index)) {
            return Err(PageError::Abscissa { plot: title(), index });
        }
    }
    for series in &plot.series {
        let label = || series.label.clone();
        let Some(abscissa) = plot.tables.get(series.table) else {
            return Err(PageError::NoAbscissa { plot: title(), series: label() });
        };
        let expected = abscissa.len();
        if let Some(got) = series.edges().map(<[f64]>::len).find(|got| *got != expected) {
            return Err(PageError::SeriesLength { plot: title(), series: label(), expected, got });
        }
    }
    Ok(())
}

fn column(values: impl Iterator<Item = f64>, digits: usize) -> String {
    let numbers: Vec<String> = values.map(|value| number(value, digits)).collect();
    format!("[{}]", numbers.join(","))
}

/// An abscissa in equal steps is written as first value, step and count: that is what most spectra have.
fn abscissa_column(abscissa: &[f64], kept: &[usize]) -> String {
    let count = kept.len();
    if count == abscissa.len() && count > 2 {
        let (first, last) = (abscissa[0], abscissa[count - 1]);
        let step = (last - first) / (count - 1) as f64;
        let tolerance = 1e-9 * first.abs().max(last.abs());
        let expected = (0..count).map(|line| first + step * line as f64);
        if abscissa.iter().zip(expected).all(|(x, expected)| (x - expected).abs() <= tolerance) {
            let (from, step) = (number(first, 17), number(step, 17));
            return format!("{{\"from\":{from},\"step\":{step},\"count\":{count}}}");
        }
    }
    column(kept.iter().map(|line| abscissa[*line]), ABSCISSA_DIGITS)
}
