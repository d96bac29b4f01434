//! The figure around a plot: title, legend with the place of each read-out, caption.

use jointscope_wording::capitalised;
use maud::{Markup, html};

use super::drawing::Drawing;
use super::{Mark, Plot, Series, Style};
use crate::format::{significant, trimmed};
use crate::unit::{Scale, typeset};

/// The figure of a plot; the script finds it by its number and draws into it.
pub(super) fn figure(number: usize, plot: &Plot, drawing: &Drawing) -> Markup {
    let caption = caption(plot);
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
                aria-label={ (plot.title) ". " (caption) } {}
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
            let value = with_unit(trimmed(&significant(scale.of(*at), 4)), scale.unit());
            (label, line(colour.colour(), "M1 5H21"), value)
        }
        Mark::Vertical { label, colour, at } => {
            (label, line(colour.colour(), "M11 0V10"), with_unit(trimmed(&significant(*at, 5)), &unit))
        }
        Mark::Shaded { label, from, to } => {
            let [from, to] = [from, to].map(|end| trimmed(&significant(*end, 4)));
            let range = format!("{from} to {to}");
            let area = html! { rect x="1" y="0.5" width="20" height="9" fill="var(--shade)" {} };
            (label, swatch(area), with_unit(range, &unit))
        }
    }
}

fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
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
