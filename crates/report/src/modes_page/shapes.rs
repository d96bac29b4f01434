//! Mode shapes: deflections at the channels, over their places.

use jointscope_fixture::Fixture;
use jointscope_modes::{ModalAnalysis, Mode};
use jointscope_spectra::{Channel, Dof};
use num_complex::Complex64;

use super::SHOWN;
use crate::drawing::Svg;
use crate::format::significant;
use crate::html::escaped;
use crate::{Column, Section, Table};

pub(super) fn section(analysis: &ModalAnalysis, fixture: Option<&Fixture>) -> Section {
    let section = Section::new("Mode shapes");
    if analysis.modes.iter().all(|mode| mode.responses.is_empty()) {
        return section.paragraph(
            "Not every response was measured to every reference, so there is no shape over the channels; the residues of each FRF are in modes.json.",
        );
    }
    let places = if fixture.is_some() {
        "Channels stand where the fixture has their points."
    } else {
        "Without a fixture nothing is known of where the channels are: they stand side by side."
    };
    let scales = if analysis.modes.iter().any(|mode| mode.modal_mass.is_some()) {
        "A driving point tells what one is against the other: both are one shape."
    } else {
        "Each of the two has its largest entry at 1: what one is against the other is told by driving points only, and there is none."
    };
    let mut section = section.paragraph(format!(
        "Deflection at resonance, real part of the shape turned to its largest; responses filled, references open. {scales} {places}"
    ));
    for (index, mode) in analysis.modes.iter().enumerate().take(SHOWN) {
        let caption = format!("Mode {} at {} Hz", index + 1, significant(mode.frequency, 5));
        section = section.drawing(draw(mode, fixture, &caption), caption);
    }
    section.table(entries(analysis))
}

struct Entry {
    name: String,
    x: f64,
    value: f64,
    response: bool,
}

/// Size of the drawing in its own units, and what is left free at its sides.
const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 170.0;
const SIDE: f64 = 30.0;

fn draw(mode: &Mode, fixture: Option<&Fixture>, title: &str) -> Svg {
    let mut names: Vec<&Channel> = mode.responses.iter().chain(&mode.references).map(|(c, _)| c).collect();
    names.sort_by_key(|channel| (channel.point.parse::<i64>().ok(), (*channel).clone()));
    names.dedup();
    let place = |channel: &Channel| {
        let beside = names.iter().position(|name| *name == channel).unwrap_or(0) as f64;
        fixture.and_then(|f| f.point(&channel.point)).map_or(beside, |point| point.x.value)
    };
    let listed = |shape: &[(Channel, Complex64)], response: bool| {
        let translations = shape.iter().filter(|(channel, _)| channel.dof == Dof::Translation);
        translations
            .map(|(channel, value)| Entry {
                name: channel.to_string(),
                x: place(channel),
                value: value.re,
                response,
            })
            .collect::<Vec<_>>()
    };
    let mut all = listed(&mode.responses, true);
    all.extend(listed(&mode.references, false));
    all.sort_by(|a, b| a.x.total_cmp(&b.x));
    let (low, high) =
        all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), e| (low.min(e.x), high.max(e.x)));
    let width = (high - low).max(f64::MIN_POSITIVE);
    let px = |x: f64| if high > low { SIDE + (WIDTH - 2.0 * SIDE) * (x - low) / width } else { 0.5 * WIDTH };
    let py = |value: f64| 0.5 * HEIGHT - value.clamp(-1.0, 1.0) * (0.5 * HEIGHT - 30.0);
    let middle = 0.5 * HEIGHT;
    let mut svg = format!(
        "<svg class=\"fx\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">{STYLE}\n\
         <line class=\"shape-rest\" x1=\"{SIDE}\" x2=\"{}\" y1=\"{middle}\" y2=\"{middle}\"/>\n",
        escaped(title),
        WIDTH - SIDE
    );
    for response in [true, false] {
        let points: Vec<String> = all
            .iter()
            .filter(|e| e.response == response)
            .map(|e| format!("{:.1},{:.1}", px(e.x), py(e.value)))
            .collect();
        let class = if response { "shape-response" } else { "shape-reference" };
        svg.push_str(&format!("<polyline class=\"{class}\" points=\"{}\"/>\n", points.join(" ")));
    }
    for entry in &all {
        let (x, y) = (px(entry.x), py(entry.value));
        let class = if entry.response { "shape-response-dot" } else { "shape-reference-dot" };
        let label = if entry.value >= 0.0 { y - 9.0 } else { y + 18.0 };
        svg.push_str(&format!(
            "<line class=\"shape-stem\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{y:.1}\"/>\
             <circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>\
             <text x=\"{x:.1}\" y=\"{label:.1}\">{}</text>\n",
            middle,
            escaped(&entry.name)
        ));
    }
    svg.push_str("</svg>\n");
    Svg::trusted(svg)
}

/// Colours come from the page's variables; without a page the drawing is dark on light.
const STYLE: &str = "<style>\
.fx{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink,#1b1f24)}\
.fx text{text-anchor:middle}\
.shape-rest{stroke:var(--soft,#5a636e);stroke-dasharray:4 3}\
.shape-stem{stroke:var(--soft,#5a636e);opacity:.5}\
.shape-response{fill:none;stroke:var(--measured,#0072b2);stroke-width:1.6}\
.shape-reference{fill:none;stroke:var(--estimate,#00845f);stroke-width:1.6;stroke-dasharray:6 3}\
.shape-response-dot{fill:var(--measured,#0072b2)}\
.shape-reference-dot{fill:var(--ground,#fff);stroke:var(--estimate,#00845f);stroke-width:1.8}\
</style>";

fn entries(analysis: &ModalAnalysis) -> Table {
    let mut columns = vec![Column::text("Channel")];
    columns.extend((0..analysis.modes.len()).map(|index| Column::numbers(format!("Mode {}", index + 1), "")));
    let mut table = Table::new(columns);
    let Some(first) = analysis.modes.first() else { return table };
    type Shape = fn(&Mode) -> &[(Channel, Complex64)];
    let parts: [(&str, Shape); 2] =
        [("response", |mode| &mode.responses), ("reference", |mode| &mode.references)];
    for (what, shape) in parts {
        for (row, (channel, _)) in shape(first).iter().enumerate() {
            let mut cells = vec![format!("{what} {channel}")];
            cells.extend(analysis.modes.iter().map(|mode| {
                let value = shape(mode)[row].1;
                format!("{} ∠ {}°", significant(value.norm(), 3), significant(value.arg().to_degrees(), 2))
            }));
            table = table.row(cells);
        }
    }
    table.footnote("Size and phase against the largest.")
}
