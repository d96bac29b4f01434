//! A plot as an SVG of its own: what the page shows at first, without its script.

use maud::{Markup, PreEscaped, html};

use super::data::{check, ordinate_scale};
use super::figure::{caption, mark_key, seen, series_swatch};
use super::range::limits;
use super::thin::kept_lines;
use super::{Axis, Mark, Plot, Series, Style};
use crate::error::PageError;
use crate::format::{fixed, significant, trimmed};
use crate::unit::{Scale, superscript, typeset};

const WIDTH: f64 = 900.0;
const LEFT: f64 = 76.0;
const RIGHT: f64 = 18.0;
/// Below the drawing: numbers and name of the abscissa.
const BOTTOM: f64 = 46.0;
const LEGEND_ROW: f64 = 20.0;
/// What a decade may miss an end of an axis by.
const ROUNDING: f64 = 1e-9;
/// Width of a letter of the legend, a little more than most have.
const LETTER: f64 = 7.2;

const STYLE: &str = "<style>.swatch{fill:none}.pl{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink)}\
.pl-title{font-size:16px;font-weight:600}.pl-x{text-anchor:middle}.pl-y{text-anchor:end}.pl-soft{fill:var(--soft)}\
.pl path,.pl line{fill:none;stroke-width:1.5;stroke-linejoin:round}.pl .pl-grid{stroke:var(--grid);stroke-width:1}\
.pl .pl-frame{stroke:var(--soft);stroke-width:1}.pl .pl-points{stroke-width:4;stroke-linecap:round}.pl .pl-band{stroke:none;opacity:.25}</style>";

/// An axis as drawn: from `low` to `high`, both in the unit shown.
struct Ruler {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Ruler {
    fn new((low, high): (f64, f64), axis: &Axis) -> Self {
        Ruler { low, high, logarithmic: axis.is_logarithmic() }
    }

    /// 0 to 1 along the axis; what lies far off stays at a finite place.
    fn at(&self, value: f64) -> f64 {
        let at = match self.logarithmic {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        at.clamp(-10.0, 11.0)
    }

    /// Places of the grid with their labels.
    fn ticks(&self, about: f64) -> Vec<(f64, String)> {
        if self.logarithmic {
            return self.decades();
        }
        let raw = (self.high - self.low) / about;
        let decade = 10f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= 0.999 * raw).unwrap_or(raw);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
        let label = |tick: f64| match tick.abs() >= 1e6 || step < 1e-9 {
            true => significant(tick, 2),
            false => format!("{tick:.decimals$}").replace('-', "−"),
        };
        (first..=last).map(|i| i as f64 * step).map(|tick| (tick, label(tick))).collect()
    }

    fn decades(&self) -> Vec<(f64, String)> {
        let (first, last) = (self.low.log10(), self.high.log10());
        let every = ((last - first) / 8.0).ceil().max(1.0) as i64;
        let powers = (first.ceil() as i64)..=(last.floor() as i64);
        // As on the page: powers of ten once plain numbers have many zeros.
        let is_plain = first >= -3.0 - ROUNDING && last <= 5.0 + ROUNDING;
        let label = |power: i64| match is_plain {
            true => trimmed(&fixed(10f64.powi(power as i32), (-power).max(0) as usize)),
            false => format!("10{}", power.to_string().chars().map(superscript).collect::<String>()),
        };
        let whole: Vec<_> = powers
            .filter(|power| power.rem_euclid(every) == 0)
            .map(|power| (10f64.powi(power as i32), label(power)))
            .collect();
        if whole.len() > 1 {
            return whole;
        }
        // Less than two powers of ten: their multiples too.
        let decades = (first.floor() as i32)..=(last.ceil() as i32);
        let multiples = decades.flat_map(|power| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(power)));
        let within = multiples.filter(|tick| *tick >= self.low && *tick <= self.high);
        within.map(|tick| (tick, crate::format::significant(tick, 1))).collect()
    }
}

/// Where values lie on the drawing.
struct Canvas<'a> {
    x: Ruler,
    y: Ruler,
    scale: &'a Scale,
    top: f64,
    floor: f64,
}

impl Canvas<'_> {
    fn px(&self, x: f64) -> f64 {
        LEFT + self.x.at(x) * (WIDTH - LEFT - RIGHT)
    }

    /// Of an ordinate in SI units.
    fn py(&self, y: f64) -> f64 {
        self.floor - self.y.at(self.scale.of(y)) * (self.floor - self.top)
    }
}

impl Plot {
    /// The plot as a drawing.
    pub(crate) fn svg(&self) -> Result<Markup, PageError> {
        check(self)?;
        let first = limits(self).first;
        let scale = ordinate_scale(self, first);
        let entries = self.legend(&scale);
        let (legend, rows) = placed(&entries);
        let top = 34.0 + LEGEND_ROW * rows as f64 + 24.0;
        let floor = top + f64::from(self.height);
        let canvas = Canvas {
            x: Ruler::new(self.abscissa_range(), &self.x),
            y: Ruler::new((scale.of(first.0), scale.of(first.1)), &self.y),
            scale: &scale,
            top,
            floor,
        };
        let named = |label: &str, unit: &str| {
            if unit.is_empty() { label.to_owned() } else { format!("{label}, {unit}") }
        };
        let end = WIDTH - RIGHT;
        Ok(html! {
            svg.pl xmlns="http://www.w3.org/2000/svg" width=(WIDTH) height=(floor + BOTTOM)
                viewBox={ "0 0 " (WIDTH) " " (floor + BOTTOM) } role="img" aria-label={ (self.title) ". " (caption(self)) (seen(self, &scale)) } {
                title { (self.title) }
                desc { (caption(self)) }
                (PreEscaped(STYLE))
                rect width=(WIDTH) height=(floor + BOTTOM) style="fill:var(--ground)" {}
                text.pl-title x=(LEFT) y="22" { (self.title) }
                @for ((label, swatch, _), (x, row)) in entries.iter().zip(&legend) {
                    @let y = 46.0 + LEGEND_ROW * *row as f64;
                    g transform={ "translate(" (px(*x)) " " (px(y - 10.0)) ")" } { (swatch) }
                    text x=(px(x + 28.0)) y=(px(y)) { (label) }
                }
                text.pl-soft x=(LEFT) y=(top - 8.0) { (named(&self.y.label, scale.unit())) }
                @for (tick, label) in canvas.x.ticks(8.0) {
                    @let x = px(canvas.px(tick));
                    path.pl-grid d={ "M" (x) " " (top) "V" (floor) } {}
                    text.pl-x x=(x) y=(floor + 17.0) { (label) }
                }
                @for (tick, label) in canvas.y.ticks(5.0) {
                    @let y = floor - canvas.y.at(tick) * (floor - top);
                    path.pl-grid d={ "M" (LEFT) " " (px(y)) "H" (end) } {}
                    text.pl-y x=(LEFT - 6.0) y=(px(y + 4.5)) { (label) }
                }
                text.pl-x.pl-soft x=(0.5 * (LEFT + end)) y=(floor + 36.0) { (named(&self.x.label, &typeset(&self.x.unit))) }
                clipPath id="area" { rect x=(LEFT) y=(top) width=(end - LEFT) height=(floor - top) {} }
                g clip-path="url(#area)" {
                    @for mark in &self.marks { (drawn_mark(mark, &canvas)) }
                    @for series in self.series.iter().filter(|series| series.style == Style::Band) {
                        (self.drawn(series, &canvas))
                    }
                    @for series in self.series.iter().filter(|series| series.style != Style::Band) {
                        (self.drawn(series, &canvas))
                    }
                }
                path.pl-frame d={ "M" (LEFT) " " (top) "V" (floor) "H" (end) "V" (top) "Z" } {}
            }
        })
    }

    /// Label, swatch and width of each entry.
    fn legend(&self, scale: &Scale) -> Vec<(String, Markup, f64)> {
        let series = self.series.iter().map(|series| (series.label.clone(), series_swatch(series)));
        let marks = self.marks.iter().filter(|mark| mark.is_named()).map(|mark| {
            let (label, swatch, value) = mark_key(mark, self, scale);
            (format!("{label} {value}").trim_end().to_owned(), swatch)
        });
        let entry = |(label, swatch): (String, Markup)| {
            let width = 46.0 + LETTER * label.chars().count() as f64;
            (label, swatch, width)
        };
        series.chain(marks).map(entry).collect()
    }

    /// Ends of all abscissae that have a place on the axis.
    fn abscissa_range(&self) -> (f64, f64) {
        let all = self.tables.iter().flatten().copied().filter(|x| self.x.can_show(*x));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        match (low.is_finite(), high > low) {
            (true, true) => (low, high),
            (true, false) => (0.9 * low - f64::MIN_POSITIVE, 1.1 * low + f64::MIN_POSITIVE),
            (false, _) => (1.0, 2.0),
        }
    }

    /// A series, thinned as on the page.
    fn drawn(&self, series: &Series, canvas: &Canvas) -> Markup {
        let abscissa = &self.tables[series.table];
        let edges: Vec<&[f64]> = series.edges().collect();
        let mut lines = kept_lines(abscissa, &edges, self.line_limit, self.x.is_logarithmic());
        lines.retain(|line| self.x.can_show(abscissa[*line]));
        let place = |edge: &[f64], line: usize| {
            self.y
                .can_show(edge[line])
                .then(|| format!("{:.1} {:.1}", canvas.px(abscissa[line]), canvas.py(edge[line])))
        };
        let colour = format!("var(--{})", series.role.colour());
        match series.style {
            Style::Points => {
                let dots =
                    lines.iter().filter_map(|line| Some(format!("M{}h0", place(&series.values, *line)?)));
                html! { path.pl-points style={ "stroke:" (colour) } d=(dots.collect::<String>()) {} }
            }
            Style::Band => {
                let both = |line: &usize| Some((place(&series.low, *line)?, place(&series.values, *line)?));
                let areas = runs(lines.iter().map(both)).into_iter().map(|run| {
                    let (low, high): (Vec<_>, Vec<_>) = run.into_iter().unzip();
                    let back: Vec<String> = high.into_iter().rev().collect();
                    format!("M{}L{}Z", low.join("L"), back.join("L"))
                });
                html! { path.pl-band style={ "fill:" (colour) } d=(areas.collect::<String>()) {} }
            }
            Style::Line | Style::Dashed | Style::Dotted => {
                let dashes = match series.style {
                    Style::Dashed => Some("7 4"),
                    Style::Dotted => Some("2 3"),
                    _ => None,
                };
                let runs = runs(lines.iter().map(|line| place(&series.values, *line)));
                // A line between two gaps is a point.
                let d = runs.into_iter().map(|run| match run.as_slice() {
                    [alone] => format!("M{alone}h.1"),
                    run => format!("M{}", run.join("L")),
                });
                html! { path style={ "stroke:" (colour) } stroke-dasharray=[dashes] d=(d.collect::<String>()) {} }
            }
        }
    }
}

fn drawn_mark(mark: &Mark, canvas: &Canvas) -> Markup {
    let line = |colour: &str, d: String| {
        html! { path style={ "stroke:var(--" (colour) ")" } stroke-dasharray="4 2" d=(d) {} }
    };
    match mark {
        Mark::Horizontal { colour, at, .. } => {
            line(colour.colour(), format!("M{LEFT} {:.1}H{:.1}", canvas.py(*at), WIDTH - RIGHT))
        }
        Mark::Vertical { colour, at, .. } => {
            line(colour.colour(), format!("M{:.1} {:.1}V{:.1}", canvas.px(*at), canvas.top, canvas.floor))
        }
        Mark::Shaded { from, to, .. } => {
            let (from, to) = (canvas.px(*from), canvas.px(*to));
            let height = canvas.floor - canvas.top;
            html! {
                rect x=(px(from)) y=(px(canvas.top)) width=(px((to - from).max(0.0))) height=(px(height)) style="fill:var(--shade)" {}
            }
        }
    }
}

fn px(at: f64) -> String {
    format!("{at:.1}")
}

/// What lies between gaps.
fn runs<T>(values: impl Iterator<Item = Option<T>>) -> Vec<Vec<T>> {
    let mut runs: Vec<Vec<T>> = vec![Vec::new()];
    for value in values {
        match (value, runs.last_mut()) {
            (Some(value), Some(run)) => run.push(value),
            (None, Some(run)) if !run.is_empty() => runs.push(Vec::new()),
            _ => {}
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Places of the entries of a legend, x and row, and how many rows there are.
fn placed(entries: &[(String, Markup, f64)]) -> (Vec<(f64, usize)>, usize) {
    let (mut x, mut row) = (LEFT, 0);
    let places = entries.iter().map(|(_, _, width)| {
        if x > LEFT && x + width > WIDTH - RIGHT {
            (x, row) = (LEFT, row + 1);
        }
        let place = (x, row);
        x += width;
        place
    });
    let places: Vec<_> = places.collect();
    (places, if entries.is_empty() { 0 } else { row + 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Role;

    #[test]
    fn a_gap_interrupts_a_line_and_what_lies_on_the_axis_ends_is_drawn_there() {
        let plot = Plot::new("H <4/1>", Axis::frequency(), Axis::logarithmic("|H|", "m/N"))
            .over([0.0, 100.0, 200.0, 300.0, 400.0])
            .line("measured", Role::Measured, [Some(1e-6), Some(1e-3), None, Some(1e-5), Some(1e-4)])
            .shaded("band", 100.0, 200.0)
            .vertical("1", Role::Highlight, 250.0);
        let svg = plot.svg().unwrap().into_string();
        let line = svg.split(" d=\"").find(|part| part.matches('L').count() == 2).unwrap();
        let d = line.split('"').next().unwrap();
        assert!(d.starts_with(&format!("M{LEFT:.1} ")) && d.matches('M').count() == 2, "{d}");
        assert!(d.contains(&format!("L{:.1} ", WIDTH - RIGHT)), "{d}");
        for part in
            ["H &lt;4/1&gt;", ">10⁻⁴<", ">Frequency, Hz<", ">|H|, m/N<", ">300<", "band 100 to 200 Hz"]
        {
            assert!(svg.contains(part), "{part} in {svg}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn a_plot_of_one_line_or_of_none_is_drawn_with_finite_places() {
        for values in [vec![], vec![5.0], vec![f64::NAN]] {
            let axis = || Axis::linear("k", "N/m");
            let plot = Plot::new("k", Axis::frequency(), axis())
                .over((0..values.len()).map(|line| line as f64))
                .line("measured", Role::Measured, values);
            let svg = plot.svg().unwrap().into_string();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }

    #[test]
    fn entries_of_a_legend_that_do_not_fit_beside_each_other_go_to_the_next_row() {
        let entry = |width| (String::new(), Markup::default(), width);
        let (places, rows) = placed(&[entry(500.0), entry(400.0), entry(100.0)]);
        assert_eq!((places[1], places[2].1, rows), ((LEFT, 1), 1, 2));
    }
}
