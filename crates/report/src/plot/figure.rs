//! The figure around a plot: title, legend with the place of each read-out, caption.

use jointscope_wording::capitalised;
use maud::{Markup, html};

use super::drawing::Drawing;
use super::{AVERAGING_BAND, Mark, Plot, Role, Series, Style};
use crate::format::{percent, plain};
use crate::unit::{Scale, typeset};

/// The figure of a plot; the script finds it by its number and draws into it.
pub(super) fn figure(number: usize, plot: &Plot, drawing: &Drawing) -> Markup {
    let caption = caption(plot);
    let seen = seen(plot, &drawing.scale);
    let remarks = drawing.remarks.join("; ");
    html! {
        figure.plot.strip[plot.is_strip] data-plot=(number) {
            div.plot-head {
                h3 { (plot.title) }
                output.at {}
                @if drawing.is_cut { button.range type="button" aria-pressed="false" { "full range" } }
            }
            ul.legend {
                @for (key, series) in plot.series.iter().enumerate() {
                    li {
                        button type="button" aria-pressed="true" data-series=(key) { (series_swatch(series)) (series.label) }
                        span.value {}
                    }
                }
                @for (key, mark) in plot.marks.iter().enumerate().filter(|(_, mark)| mark.is_named()) {
                    @let (label, swatch, value) = mark_key(mark, plot, &drawing.scale);
                    li {
                        button type="button" aria-pressed="true" data-mark=(key) { (swatch) (label) }
                        span.value { (value) }
                    }
                }
            }
            div.drawing tabindex="0" role="group" aria-roledescription="plot"
                aria-label={ (plot.title) ". " (caption) (seen) } {}
            figcaption { (caption) @if !remarks.is_empty() { " " small { (capitalised(&remarks)) "." } } }
        }
    }
}

fn swatch(content: Markup) -> Markup {
    html! { svg.swatch width="22" height="10" viewBox="0 0 22 10" fill="none" stroke-width="2" aria-hidden="true" { (content) } }
}

pub(super) fn series_swatch(series: &Series) -> Markup {
    let colour = format!("var(--{})", series.role.colour());
    swatch(html! {
        @match series.style {
            Style::Line => path d="M1 5H21" stroke=(colour) {},
            Style::Dashed => path d="M1 5H21" stroke=(colour) stroke-dasharray="6 3" {},
            Style::Dotted => path d="M1 5H21" stroke=(colour) stroke-dasharray="2 2.5" {},
            Style::Points => circle cx="11" cy="5" r="2.6" fill=(colour) {},
            Style::Band => rect x="1" y="0.5" width="20" height="9" fill=(colour) opacity="0.3" {},
        }
    })
}

/// Label, swatch and printed value of a mark.
pub(super) fn mark_key<'a>(mark: &'a Mark, plot: &Plot, scale: &Scale) -> (&'a str, Markup, String) {
    let unit = typeset(&plot.x.unit);
    let line = |colour: &str, path: &str| {
        swatch(html! { path d=(path) stroke-dasharray="4 2" stroke={ "var(--" (colour) ")" } {} })
    };
    match mark {
        Mark::Horizontal { label, colour, at } => {
            let value = with_unit(plain(scale.of(*at), 4), scale.unit());
            (label, line(colour.colour(), "M1 5H21"), value)
        }
        Mark::Vertical { label, colour, at } => {
            (label, line(colour.colour(), "M11 0V10"), with_unit(plain(*at, 5), &unit))
        }
        Mark::Shaded { label, from, to } => {
            let [from, to] = [from, to].map(|end| plain(*end, 4));
            let range = format!("{from} to {to}");
            let area = html! { rect x="1" y="0.5" width="20" height="9" fill="var(--shade)" {} };
            (label, swatch(area), with_unit(range, &unit))
        }
    }
}

fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// Curves of which it is said what is seen of them, at the most.
const TOLD: usize = 6;
/// Per cent of a curve's values that lie between the two that are told of it, from the one end and from the
/// other.
const MOSTLY: [usize; 2] = [5, 95];

/// What is seen of the curves, for who does not see them: on a logarithmic axis where each is highest, and
/// how often it exceeds a line drawn across, on a linear one between which values it mostly lies, over the
/// averaging band where there is one. Of phases nothing: where they turn the magnitude peaks.
pub(super) fn seen(plot: &Plot, scale: &Scale) -> String {
    // Points in the colour of a reference mark lines of a curve.
    let is_mark = |series: &Series| series.style == Style::Points && series.role == Role::Reference;
    let curves = plot.series.iter().filter(|series| series.style != Style::Band && !is_mark(series));
    let told: Vec<String> = curves.filter_map(|series| seen_of(series, plot, scale)).take(TOLD).collect();
    let how = match (plot.y.is_logarithmic(), averaged(plot)) {
        (true, _) => "Highest".to_owned(),
        (false, None) => "Mostly".to_owned(),
        (false, Some((from, to))) => {
            let [from, to] = [from, to].map(|end| plain(end, 4));
            format!("Mostly, from {}", with_unit(format!("{from} to {to}"), &typeset(&plot.x.unit)))
        }
    };
    if told.is_empty() || plot.y.unit == "°" {
        String::new()
    } else {
        format!(" {how}: {}.", told.join("; "))
    }
}

/// The band over which averages are taken, where the plot shades it.
fn averaged(plot: &Plot) -> Option<(f64, f64)> {
    plot.marks.iter().find_map(|mark| match mark {
        Mark::Shaded { label, from, to } if label == AVERAGING_BAND => Some((*from, *to)),
        _ => None,
    })
}

fn seen_of(series: &Series, plot: &Plot, scale: &Scale) -> Option<String> {
    let abscissa = plot.tables.get(series.table)?;
    let lines = abscissa.iter().zip(&series.values).filter(|(_, y)| plot.y.can_show(**y));
    let lines = lines.map(|(x, y)| (*x, scale.of(*y)));
    let band = averaged(plot).filter(|_| !plot.y.is_logarithmic());
    let mut lines: Vec<(f64, f64)> =
        lines.filter(|(x, _)| band.is_none_or(|(from, to)| (from..=to).contains(x))).collect();
    lines.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (last, label) = (lines.len().checked_sub(1)?, &series.label);
    let number = |y: f64| plain(y, 3);
    if !plot.y.is_logarithmic() {
        let [low, high] = MOSTLY.map(|share| number(lines[last * share / 100].1));
        let range = if low == high { low } else { format!("{low} to {high}") };
        return Some(format!("{label} {}", with_unit(range, scale.unit())));
    }
    let (x, y) = lines[last];
    let (height, place) = (with_unit(number(y), scale.unit()), plain(x, 4));
    let exceeded = plot.marks.iter().find_map(|mark| match mark {
        Mark::Horizontal { label, at, .. } if !label.is_empty() => Some(scale.of(*at)),
        _ => None,
    });
    let exceeded = exceeded.map_or_else(String::new, |at| {
        let above = lines.iter().filter(|(_, y)| *y > at).count();
        format!(", above {} on {} of the lines", number(at), percent(above as f64 / lines.len() as f64, 0))
    });
    Some(format!("{label} {height} at {}{exceeded}", with_unit(place, &typeset(&plot.x.unit))))
}

/// The caller's sentence, or one made of the labels.
pub(super) fn caption(plot: &Plot) -> String {
    if let Some(caption) = &plot.caption {
        return caption.clone();
    }
    let labels: Vec<&str> = plot.series.iter().map(|s| s.label.as_str()).collect();
    let scale = if plot.y.is_logarithmic() { " on a logarithmic scale" } else { "" };
    let shown = if labels.is_empty() { String::new() } else { format!(": {}", labels.join(", ")) };
    format!("{} over {}{scale}{shown}.", plot.y.label, plot.x.label.to_lowercase())
}
