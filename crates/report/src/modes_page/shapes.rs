//! Mode shapes: deflections at the channels, over their places.

use jointscope_fixture::Fixture;
use jointscope_modes::{ModalAnalysis, Mode};
use jointscope_spectra::{Channel, Dof};
use maud::{Markup, PreEscaped, html};
use num_complex::Complex64;

use super::frfs::SHOWN;
use crate::format::{fixed, significant};
use crate::plot::Span;
use crate::section::{Block, Section};
use crate::table::Table;

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
        let text = format!(
            "{caption}, damping ratio {} %: {}",
            significant(100.0 * mode.damping_ratio, 3),
            drawn_entries(mode, fixture)
        );
        section = section.drawing(draw(mode, fixture, &text), caption);
    }
    section.with(entries(analysis))
}

#[derive(Clone)]
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

/// Entries whose names have room beside each other where the drawing is as narrow as a telephone.
const FEW: usize = 12;

/// Translations of a mode, responses first, from left to right.
fn translations(mode: &Mode, fixture: Option<&Fixture>) -> Vec<Entry> {
    let mut names: Vec<&Channel> = mode.responses.iter().chain(&mode.references).map(|(c, _)| c).collect();
    names.sort_by_key(|channel| (channel.point.parse::<i64>().ok(), (*channel).clone()));
    names.dedup();
    let place = |channel: &Channel| {
        let beside = names.iter().position(|name| *name == channel).unwrap_or(0) as f64;
        fixture.and_then(|f| f.point(&channel.point)).map_or(beside, |point| point.x.value)
    };
    let listed = |shape: &[(Channel, Complex64)], response: bool| {
        let translations = shape.iter().filter(|(channel, _)| channel.dof == Dof::Translation);
        let entry = |(channel, value): &(Channel, Complex64)| Entry {
            name: channel.to_string(),
            x: place(channel),
            value: value.re,
            response,
        };
        translations.map(entry).collect::<Vec<_>>()
    };
    let mut all = [listed(&mode.responses, true), listed(&mode.references, false)].concat();
    all.sort_by(|a, b| a.x.total_cmp(&b.x));
    all
}

/// The deflections from left to right, for who cannot see them.
fn drawn_entries(mode: &Mode, fixture: Option<&Fixture>) -> String {
    let all = translations(mode, fixture);
    let each = |entry: &Entry| format!("{} {}", entry.name, significant(entry.value, 2));
    all.iter().filter(|entry| entry.response).map(each).collect::<Vec<_>>().join(", ")
}

fn draw(mode: &Mode, fixture: Option<&Fixture>, title: &str) -> Markup {
    let all = translations(mode, fixture);
    let (low, high) = Span::of(all.iter().map(|entry| entry.x)).0.unwrap_or((0.0, 0.0));
    let px = |x: f64| {
        if high > low { SIDE + (WIDTH - 2.0 * SIDE) * (x - low) / (high - low) } else { 0.5 * WIDTH }
    };
    let middle = 0.5 * HEIGHT;
    let py = |value: f64| middle - value.clamp(-1.0, 1.0) * (middle - 30.0);
    let points = |response: bool| -> Vec<String> {
        let shape = all.iter().filter(|entry| entry.response == response);
        shape.map(|entry| format!("{:.1},{:.1}", px(entry.x), py(entry.value))).collect()
    };
    html! {
        svg.fx.few[all.len() <= FEW] xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } data-middle=(middle) role="img" aria-label=(title) {
            (PreEscaped(STYLE))
            line.shape-rest x1=(SIDE) x2=(WIDTH - SIDE) y1=(middle) y2=(middle) {}
            polyline.shape-response points=(points(true).join(" ")) {}
            polyline.shape-reference points=(points(false).join(" ")) {}
            @for entry in &all {
                @let (x, y) = (format!("{:.1}", px(entry.x)), format!("{:.1}", py(entry.value)));
                @let label = py(entry.value) + if entry.value >= 0.0 { -9.0 } else { 18.0 };
                line.shape-stem x1=(x) x2=(x) y1=(middle) y2=(y) {}
                circle class=(if entry.response { "shape-response-dot" } else { "shape-reference-dot" }) cx=(x) cy=(y) r="4" {}
                text x=(x) y=(format!("{label:.1}")) { (entry.name) }
            }
        }
    }
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

fn shape<'a>(mode: &'a Mode, what: &str) -> &'a [(Channel, Complex64)] {
    if what == "response" { &mode.responses } else { &mode.references }
}

fn entries(analysis: &ModalAnalysis) -> impl Into<Block> {
    let first = analysis.modes.first();
    let rows = ["response", "reference"].into_iter().flat_map(|what| {
        let channels = first.map_or(&[][..], |mode| shape(mode, what)).iter().enumerate();
        channels.map(move |(row, (channel, _))| (what, row, format!("{what} {channel}")))
    });
    let table = Table::of(rows).words("Channel", |(_, _, name)| name.clone());
    let modes = analysis.modes.iter().enumerate();
    let table = modes.fold(table, |table, (index, mode)| {
        table.numbers(format!("Mode {}", index + 1), "", |(what, row, _)| {
            let value = shape(mode, what)[*row].1;
            format!("{} ∠ {}°", significant(value.norm(), 3), fixed(value.arg().to_degrees(), 1))
        })
    });
    table.footnote("Size and phase against the largest.")
}
