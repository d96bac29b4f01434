//! The figure around a plot: title, legend with the place of each read-out, caption.

use super::{Mark, Plot, PlotData, Role, Series, Spacing, Style};
use crate::format::significant;
use crate::html::{push_element, push_escaped};
use crate::unit::typeset;

/// Writes the figure; the script finds it by its number and draws into it.
pub(crate) fn write_figure(html: &mut String, number: usize, plot: &Plot, data: &PlotData) {
    let caption = caption(plot);
    html.push_str(&format!("<figure class=\"plot\" data-plot=\"{number}\">\n<div class=\"plot-head\">"));
    push_element(html, "h3", "", &plot.title);
    html.push_str("<output class=\"at\"></output>");
    if data.first.is_some() {
        html.push_str("<button type=\"button\" class=\"range\" aria-pressed=\"false\">full range</button>");
    }
    html.push_str("</div>\n<ul class=\"legend\">");
    for (key, series) in plot.series.iter().enumerate() {
        let toggle = format!(" data-series=\"{key}\"");
        push_key(html, &toggle, &series_swatch(series), &series.label, "");
    }
    for (key, mark) in plot.marks.iter().enumerate() {
        let toggle = format!(" data-mark=\"{key}\"");
        let (label, swatch, value) = mark_key(mark, plot, data);
        push_key(html, &toggle, &swatch, label, &value);
    }
    html.push_str("</ul>\n");
    html.push_str(&format!(
        "<div class=\"drawing\" style=\"height:{}px\" tabindex=\"0\" role=\"group\" aria-roledescription=\"plot\" aria-label=\"",
        plot.height
    ));
    push_escaped(html, &plot.title);
    html.push_str(". ");
    push_escaped(html, &caption);
    html.push_str("\"></div>\n<figcaption>");
    push_escaped(html, &caption);
    if !data.remarks.is_empty() {
        html.push_str(" <small>");
        push_escaped(html, &sentence(&data.remarks.join("; ")));
        html.push_str("</small>");
    }
    html.push_str("</figcaption>\n</figure>\n");
}

fn push_key(html: &mut String, toggle: &str, swatch: &str, label: &str, value: &str) {
    html.push_str(&format!("<li><button type=\"button\" aria-pressed=\"true\"{toggle}>{swatch}"));
    push_escaped(html, label);
    html.push_str("</button>");
    push_element(html, "span", "value", value);
    html.push_str("</li>");
}

fn series_swatch(series: &Series) -> String {
    let stroke = |extra: &str| {
        format!("<path d=\"M1 5H21\" style=\"stroke:var(--{})\"{extra}/>", series.role.colour_name())
    };
    let fill = |shape: &str, opacity: &str| {
        format!(
            "<{shape} style=\"fill:var(--{});stroke:none\" opacity=\"{opacity}\"/>",
            series.role.colour_name()
        )
    };
    swatch(&match series.style {
        Style::Line => stroke(""),
        Style::Dashed => stroke(" stroke-dasharray=\"6 3\""),
        Style::Points => fill("circle cx=\"11\" cy=\"5\" r=\"2.6\"", "1"),
        Style::Step => {
            format!("<path d=\"M1 8H8V2H15V6H21\" style=\"stroke:var(--{})\"/>", series.role.colour_name())
        }
        Style::Band => fill("rect x=\"1\" y=\"0.5\" width=\"20\" height=\"9\"", "0.3"),
    })
}

/// Label, swatch and printed value of a mark.
fn mark_key<'a>(mark: &'a Mark, plot: &Plot, data: &PlotData) -> (&'a str, String, String) {
    let unit = typeset(&plot.x.unit);
    let line = |role: &Role, path: &str| {
        swatch(&format!(
            "<path d=\"{path}\" stroke-dasharray=\"4 2\" style=\"stroke:var(--{})\"/>",
            role.colour_name()
        ))
    };
    match mark {
        Mark::Horizontal { label, role, at } => {
            let value = with_unit(significant(data.scale.of(*at), 4), data.scale.unit());
            (label, line(role, "M1 5H21"), value)
        }
        Mark::Vertical { label, role, at } => {
            let value = with_unit(significant(*at, 5), &unit);
            (label, line(role, "M11 0V10"), value)
        }
        Mark::Shaded { label, from, to } => {
            let range = format!("{} to {}", significant(*from, 4), significant(*to, 4));
            let rect =
                "<rect x=\"1\" y=\"0.5\" width=\"20\" height=\"9\" style=\"fill:var(--shade);stroke:none\"/>";
            (label, swatch(rect), with_unit(range, &unit))
        }
    }
}

fn swatch(content: &str) -> String {
    format!("<svg class=\"swatch\" viewBox=\"0 0 22 10\" aria-hidden=\"true\">{content}</svg>")
}

fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// The caller's sentence, or one made of the labels.
fn caption(plot: &Plot) -> String {
    if let Some(caption) = &plot.caption {
        return caption.clone();
    }
    let labels: Vec<&str> = plot.series.iter().map(|s| s.label.as_str()).collect();
    let scale = match plot.y.spacing {
        Spacing::Logarithmic => " on a logarithmic scale",
        _ => "",
    };
    let shown = if labels.is_empty() { String::new() } else { format!(": {}", labels.join(", ")) };
    format!("{} over {}{scale}{shown}.", plot.y.label, plot.x.label.to_lowercase())
}

fn sentence(text: &str) -> String {
    let mut rest = text.chars();
    match rest.next() {
        Some(first) => format!("{}{}.", first.to_uppercase(), rest.as_str()),
        None => String::new(),
    }
}
