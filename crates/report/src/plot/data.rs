//! A plot as the script on the page reads it: thinned, in display units, its columns shared between plots.

use std::collections::HashMap;
use std::fmt::Write;

use serde::Serialize;

use super::range::limits;
use super::{Mark, Plot, Series, Spacing, Style, YRange, kept_lines};
use crate::error::PageError;
use crate::html::push_number;
use crate::unit::Scale;

/// Digits of the ordinates; more than a screen can show at any sensible zoom.
const DIGITS: usize = 6;
/// Digits of a band's edges, which nobody reads to the last figure.
const BAND_DIGITS: usize = 5;
/// Digits of an abscissa: neighbouring lines must stay apart however fine the resolution is.
const ABSCISSA_DIGITS: usize = 9;

/// Columns of numbers of all plots of a page; equal columns are kept once.
#[derive(Debug, Default)]
pub(crate) struct ColumnPool {
    columns: Vec<String>,
    index: HashMap<String, usize>,
}

impl ColumnPool {
    fn add(&mut self, column: String) -> usize {
        let next = self.columns.len();
        *self.index.entry(column).or_insert_with_key(|column| {
            self.columns.push(column.clone());
            next
        })
    }

    /// The columns as one JSON array.
    pub fn to_json(&self) -> String {
        format!("[{}]", self.columns.join(",\n"))
    }
}

/// What the script needs to know of one plot. Ordinates are in the display unit.
#[derive(Debug, Serialize)]
pub(crate) struct PlotData {
    pub group: Option<String>,
    pub height: u32,
    pub x: AxisData,
    pub y: AxisData,
    /// Ordinate range at first, when the plot does not show everything.
    pub first: Option<(f64, f64)>,
    /// Whether `first` is to be found again among the lines in view when the reader zooms in: the percentiles.
    pub percentiles: Option<(f64, f64)>,
    /// Columns by table, abscissa first.
    pub tables: Vec<Vec<usize>>,
    pub series: Vec<SeriesData>,
    pub marks: Vec<MarkData>,
    /// What the reader must know of how it is drawn.
    #[serde(skip)]
    pub remarks: Vec<String>,
    #[serde(skip)]
    pub scale: Scale,
}

#[derive(Debug, Serialize)]
pub(crate) struct AxisData {
    pub label: String,
    pub unit: String,
    pub spacing: Spacing,
}

#[derive(Debug, Serialize)]
pub(crate) struct SeriesData {
    pub style: Style,
    pub colour: &'static str,
    pub table: usize,
    /// Places of its columns in the table: one, or a band's lower and upper edge.
    pub places: Vec<usize>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum MarkData {
    Horizontal { colour: &'static str, at: f64 },
    Vertical { colour: &'static str, at: f64 },
    Shaded { from: f64, to: f64 },
}

impl PlotData {
    /// Checks a plot, thins it and puts its columns into the pool.
    pub fn new(plot: &Plot, pool: &mut ColumnPool) -> Result<Self, PageError> {
        check(plot)?;
        let limits = limits(plot);
        let scale = if plot.y.spacing == Spacing::Logarithmic {
            // Decades are read off the powers of ten, which a prefix would only shift.
            Scale::plain(&plot.y.unit)
        } else {
            Scale::for_values([limits.first.0 * 0.95, limits.first.1 * 0.95], &plot.y.unit)
        };
        let mut data = Self {
            group: plot.group.clone(),
            height: plot.height,
            x: AxisData {
                label: plot.x.label.clone(),
                unit: crate::unit::typeset(&plot.x.unit),
                spacing: plot.x.spacing,
            },
            y: AxisData {
                label: plot.y.label.clone(),
                unit: scale.unit().to_owned(),
                spacing: plot.y.spacing,
            },
            first: (limits.first != limits.full)
                .then(|| (scale.of(limits.first.0), scale.of(limits.first.1))),
            percentiles: match plot.y_range {
                YRange::Percentiles { low, high } => Some((low, high)),
                _ => None,
            },
            tables: Vec::with_capacity(plot.tables.len()),
            series: Vec::with_capacity(plot.series.len()),
            marks: plot.marks.iter().map(|mark| mark_data(mark, &scale)).collect(),
            remarks: Vec::new(),
            scale,
        };
        data.add_tables(plot, pool);
        if limits.outside > 0 {
            let outside = limits.outside;
            let verb = if outside == 1 { "value lies" } else { "values lie" };
            data.remarks.push(format!("{outside} {verb} outside the range drawn at first"));
        }
        Ok(data)
    }

    fn add_tables(&mut self, plot: &Plot, pool: &mut ColumnPool) {
        let logarithmic_y = plot.y.spacing == Spacing::Logarithmic;
        let logarithmic_x = plot.x.spacing == Spacing::Logarithmic;
        let mut placed: Vec<Option<SeriesData>> = plot.series.iter().map(|_| None).collect();
        let mut undrawable = 0;
        for (table, abscissa) in plot.tables.iter().enumerate() {
            let members: Vec<(usize, &Series)> =
                (plot.series.iter().enumerate()).filter(|(_, series)| series.table == table).collect();
            if members.is_empty() {
                self.tables.push(Vec::new());
                continue;
            }
            let columns: Vec<&[f64]> = members.iter().flat_map(|(_, series)| edges(series)).collect();
            let mut kept = kept_lines(abscissa, &columns, plot.line_limit, logarithmic_x);
            if kept.len() < abscissa.len() {
                self.remarks.push(format!(
                    "drawn thinned to {} of {} lines, extremes kept",
                    kept.len(),
                    abscissa.len()
                ));
            }
            if logarithmic_x {
                kept.retain(|line| abscissa[*line] > 0.0);
            }
            let mut indices = vec![pool.add(abscissa_column(abscissa, &kept))];
            for (series_index, series) in members {
                let first_place = indices.len();
                for edge in edges(series) {
                    let digits = if series.style == Style::Band { BAND_DIGITS } else { DIGITS };
                    let drawable = |value: f64| !logarithmic_y || value > 0.0;
                    undrawable += edge.iter().filter(|v| !v.is_nan() && !drawable(**v)).count();
                    let column = column(
                        kept.iter()
                            .map(|line| edge[*line])
                            .map(|value| if drawable(value) { self.scale.of(value) } else { f64::NAN }),
                        digits,
                    );
                    indices.push(pool.add(column));
                }
                placed[series_index] = Some(SeriesData {
                    style: series.style,
                    colour: series.role.colour_name(),
                    table,
                    places: (first_place..indices.len()).collect(),
                });
            }
            self.tables.push(indices);
        }
        self.series = placed.into_iter().flatten().collect();
        if undrawable > 0 {
            let verb = if undrawable == 1 {
                "value is not positive and has"
            } else {
                "values are not positive and have"
            };
            self.remarks.push(format!("{undrawable} {verb} no place on a logarithmic axis"));
        }
        let gaps = plot.masked.unwrap_or_else(|| plot.series.iter().map(masked_lines).max().unwrap_or(0));
        if gaps > 0 {
            let lines = if gaps == 1 { "line is" } else { "lines are" };
            self.remarks.push(format!("{gaps} {lines} masked (gaps)"));
        }
    }
}

/// Lines at which a series has nothing to draw.
fn masked_lines(series: &Series) -> usize {
    series.values.iter().filter(|value| value.is_nan()).count()
}

/// The columns of a series: its values, or a band's lower and upper edge.
fn edges(series: &Series) -> impl Iterator<Item = &[f64]> {
    let low = (series.style == Style::Band).then_some(series.low.as_slice());
    low.into_iter().chain([series.values.as_slice()])
}

fn mark_data(mark: &Mark, scale: &Scale) -> MarkData {
    match mark {
        Mark::Horizontal { role, at, .. } => {
            MarkData::Horizontal { colour: role.colour_name(), at: scale.of(*at) }
        }
        Mark::Vertical { role, at, .. } => MarkData::Vertical { colour: role.colour_name(), at: *at },
        Mark::Shaded { from, to, .. } => MarkData::Shaded { from: *from, to: *to },
    }
}

/// Lengths and order of what the caller gave.
fn check(plot: &Plot) -> Result<(), PageError> {
    for abscissa in &plot.tables {
        for (index, value) in abscissa.iter().enumerate() {
            if !value.is_finite() || (index > 0 && *value <= abscissa[index - 1]) {
                let plot = plot.title.clone();
                return Err(PageError::Abscissa { plot, index });
            }
        }
    }
    for series in &plot.series {
        let Some(abscissa) = plot.tables.get(series.table) else {
            return Err(PageError::NoAbscissa { plot: plot.title.clone(), series: series.label.clone() });
        };
        for edge in edges(series) {
            if edge.len() != abscissa.len() {
                return Err(PageError::SeriesLength {
                    plot: plot.title.clone(),
                    series: series.label.clone(),
                    expected: abscissa.len(),
                    got: edge.len(),
                });
            }
        }
    }
    Ok(())
}

fn column(values: impl Iterator<Item = f64>, digits: usize) -> String {
    let mut json = String::from("[");
    for (index, value) in values.enumerate() {
        if index > 0 {
            json.push(',');
        }
        push_number(&mut json, value, digits);
    }
    json.push(']');
    json
}

/// An abscissa in equal steps is written as first value, step and count: that is what most spectra have.
fn abscissa_column(abscissa: &[f64], kept: &[usize]) -> String {
    let lines = kept.len();
    if lines == abscissa.len() && lines > 2 {
        let (first, last) = (abscissa[0], abscissa[lines - 1]);
        let step = (last - first) / (lines - 1) as f64;
        let tolerance = 1e-9 * first.abs().max(last.abs());
        let even = (abscissa.iter().enumerate())
            .all(|(line, x)| (x - (first + step * line as f64)).abs() <= tolerance);
        if even {
            let mut json = String::from("{\"from\":");
            push_number(&mut json, first, 17);
            json.push_str(",\"step\":");
            push_number(&mut json, step, 17);
            // Writing to a String does not fail.
            let _ = write!(json, ",\"count\":{lines}}}");
            return json;
        }
    }
    column(kept.iter().map(|line| abscissa[*line]), ABSCISSA_DIGITS)
}
