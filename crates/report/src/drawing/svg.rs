//! The arrangement written as SVG.

use jointscope_fixture::{Fixture, Joint, JointLaw};
use maud::{Markup, PreEscaped, html};

use super::layout::{
    ARROW, LANE, Label, Layout, MOST_LABELS, POINT_LANE, Row, SUPPORT, Tie, body_name, name_fits, shortened,
    text_width,
};
use super::side_view::{ChannelKind, Highlight, SideView};
use crate::format::significant;

/// Colours come from the page's variables; without a page the drawing is dark on light.
const STYLE: &str = "<style>\
.fx{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink,#1b1f24)}\
.fx text{text-anchor:middle;paint-order:stroke;stroke:var(--ground,#fff);stroke-width:4px;stroke-linejoin:round}.fx text.fx-inside{stroke:none;font-weight:600}.fx path,.fx line{fill:none;stroke-width:1.3}.fx .fx-thick{stroke-width:1.8}.fx .fx-beam{stroke-width:5}\
.fx-body{fill:var(--block,#dfe4ea);stroke:var(--block-edge,#77828e);stroke-width:1.2}\
.fx-name,.fx-point-name{font-weight:600}\
.fx-soft{fill:var(--soft,#5a636e);font-size:11.5px}\
.fx-leader{stroke:var(--soft,#5a636e);stroke-dasharray:2 2;opacity:.7}\
.fx-line{stroke:var(--ink,#1b1f24)}\
.fx-ground{stroke:var(--soft,#5a636e)}\
.fx-dot{fill:var(--ground,#fff);stroke:var(--ink,#1b1f24);stroke-width:1.5}\
.fx-joint{stroke:var(--joint,#c65300)}.fx-joint-name{fill:var(--joint,#c65300);font-weight:600}\
.fx-response{fill:var(--measured,#0072b2)}.fx-response-line{stroke:var(--measured,#0072b2)}\
.fx-reference{fill:var(--estimate,#00845f)}.fx-reference-line{stroke:var(--estimate,#00845f)}\
.fx-highlight{stroke:var(--highlight,#b0257e)}.fx-highlight-name{fill:var(--highlight,#b0257e);font-weight:600}\
</style>";

type Place = (f64, f64);

/// A drawing of this width, of a class of its own.
pub(super) fn draw(view: &SideView, width: f64, class: &str) -> Markup {
    let (layout, fixture) = (Layout::new(view, width), view.fixture);
    let base = layout.height - 14.0;
    let point = |index: usize| layout.point(fixture, index);
    html! {
        svg class={ "fx " (class) } xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (width) " " (format!("{:.0}", layout.height)) }
            role="img" aria-label=(description(view)) {
            (PreEscaped(STYLE))
            @for (body, x) in fixture.supports().iter().map(|support| fixture.support_place(support)) {
                @if let Some(body) = layout.bodies[body] {
                    (ground(layout.scale.px(x), layout.rows[body.row].middle + 0.5 * body.height))
                }
            }
            (bodies(fixture, &layout))
            @for row in &layout.rows { (leaders(row)) }
            @for joint in fixture.joints() {
                @if let Some((from, to)) = point(joint.from).zip(point(joint.to)) {
                    (line_of_joint(joint, view.joints.contains(&joint.name.as_str()), (from, to), width))
                }
            }
            @for (x, y) in (0..fixture.points().len()).filter_map(point) {
                circle.fx-dot cx=(px(x)) cy=(px(y)) r="4" {}
            }
            @for row in &layout.rows { (labels(row)) }
            @if layout.unlabelled > 0 {
                @let says = format!("{} more points or channels without a label", layout.unlabelled);
                (text("fx-soft", (0.5 * width, base - 26.0), &says))
            }
            @if layout.scale.per_metre > 0.0 { (scale_bar(layout.scale.per_metre, base)) }
            (axes(width, base))
        }
    }
}

/// A coordinate, or several in a path, to the tenth of a pixel.
fn px(at: f64) -> String {
    format!("{at:.1}")
}

/// The drawing in one sentence for who cannot see it: what is pointed out, then what there is.
fn description(view: &SideView) -> String {
    let fixture = view.fixture;
    let marked = view.highlights.iter().filter(|highlight| highlight.x.is_finite());
    let place = |highlight: &Highlight| {
        let body =
            highlight.body.map_or_else(String::new, |body| format!(" on {}", fixture.bodies()[body].name));
        format!("{}{body} at x = {} mm", highlight.label, significant(1e3 * highlight.x, 4))
    };
    let bodies = fixture.bodies().iter().map(|body| body.name.clone()).collect();
    let points = match fixture.points().len() {
        count if count > MOST_LABELS => vec![format!("{count} of them")],
        _ => fixture.points().iter().map(|point| point.name.clone()).collect(),
    };
    let joints = fixture.joints().iter().map(|joint| joint.name.clone()).collect();
    let listed = [
        ("Marked", marked.map(place).collect::<Vec<_>>()),
        ("Bodies", bodies),
        ("Points", points),
        ("Joints", joints),
    ];
    let listed = listed.iter().filter(|(_, names)| !names.is_empty());
    let listed: String = listed.map(|(what, names)| format!(" {what}: {}.", names.join(", "))).collect();
    format!("Side view of the fixture.{listed}")
}

fn text(class: &str, (x, y): Place, text: &str) -> Markup {
    html! { g transform={ "translate(" (px(x)) " " (px(y)) ")" } { text class=(class) { (text) } } }
}

fn path(class: &str, d: String) -> Markup {
    html! { path class=(class) d=(d) {} }
}

fn leader(class: &str, from: Place, to: Place) -> Markup {
    path(class, format!("M{:.1} {:.1}L{:.1} {:.1}", from.0, from.1, to.0, to.1))
}

fn bodies(fixture: &Fixture, layout: &Layout) -> Markup {
    let placed =
        fixture.bodies().iter().zip(&layout.bodies).filter_map(|(body, at)| Some((body, at.as_ref()?)));
    html! {
        @for (body, at) in placed {
            @let middle = layout.rows[at.row].middle;
            @let name = body_name(body);
            // Joints between stacked rows run through the middle of their bodies.
            @let stacked = layout.rows.len() > 1;
            @let centre = if stacked { at.left + 4.0 + 0.5 * text_width(&name) } else { 0.5 * (at.left + at.right) };
            rect.fx-body x=(px(at.left)) y=(px(middle - 0.5 * at.height)) width=(px((at.right - at.left).max(1.0)))
                height=(px(at.height)) rx="3" {}
            @if name_fits(&name, at) { (text("fx-inside", (centre, middle - 13.0), &name)) }
        }
    }
}

/// Baseline of a label above its row.
fn baseline_above(row: &Row, label: &Label) -> f64 {
    row.middle - row.half - ARROW - 4.0 - label.lane as f64 * LANE
}

/// Top of a label below its row.
fn top_below(row: &Row, label: &Label) -> f64 {
    let offset = if row.supported { SUPPORT } else { 6.0 };
    row.middle + row.half + offset + label.lane as f64 * POINT_LANE
}

/// Everything that ties a label to its place, drawn before the labels so that these stay on top.
fn leaders(row: &Row) -> Markup {
    html! {
        @for label in &row.above { (leader_above(row, label)) }
        @for label in &row.below {
            (leader("fx-leader", (label.anchor, row.middle + 4.0), (label.anchor, top_below(row, label) + 2.0)))
        }
    }
}

fn leader_above(row: &Row, label: &Label) -> Markup {
    let (x, top, start) = (label.anchor, row.middle - label.half, baseline_above(row, label) + 4.0);
    match label.tie {
        Tie::Arrow(kind) => html! {
            // Beyond the first lane, or above a beam among blocks, a thin leader leads down to the arrow.
            @if label.lane > 0 || label.half < row.half { (leader("fx-leader", (x, start), (x, top - ARROW + 2.0))) }
            (arrow(kind, x, top))
        },
        Tie::Circle => html! {
            // Down to the body or to the circle about a beam: a block's name stands in between.
            (leader("fx-highlight", (label.leader(), start), (label.leader(), top.min(row.middle - 9.0))))
            circle.fx-highlight cx=(px(x)) cy=(px(row.middle)) r="14" fill="none" stroke-width="2.2" {}
        },
        Tie::Line => leader("fx-leader", (x, start), (x, top)),
    }
}

/// A force points at the body; a response stands on its sensor and points along y.
fn arrow(kind: ChannelKind, x: f64, top: f64) -> Markup {
    let head = |tip: f64, end: f64| {
        let (left, right) = (x - 4.5, x + 4.5);
        format!("{x:.1},{tip:.1} {left:.1},{end:.1} {right:.1},{end:.1}")
    };
    let shaft = |from: f64, to: f64| format!("M{x:.1} {from:.1}V{to:.1}");
    match kind {
        ChannelKind::Reference => html! {
            (path("fx-reference-line fx-thick", shaft(top - ARROW + 3.0, top - 8.0)))
            polygon.fx-reference points=(head(top - 1.0, top - 10.0)) {}
        },
        ChannelKind::Response => html! {
            rect.fx-response x=(px(x - 5.0)) y=(px(top - 7.0)) width="10" height="7" rx="1" {}
            (path("fx-response-line fx-thick", shaft(top - 7.0, top - ARROW + 10.0)))
            polygon.fx-response points=(head(top - ARROW + 2.0, top - ARROW + 11.0)) {}
        },
    }
}

fn labels(row: &Row) -> Markup {
    html! {
        @for label in &row.above {
            (text(label.class, (label.centre, baseline_above(row, label)), &label.text))
        }
        @for label in &row.below {
            @let top = top_below(row, label);
            (text(label.class, (label.centre, top + 14.0), &label.text))
            @if let Some(below) = &label.below { (text("fx-soft", (label.centre, top + 27.0), below)) }
        }
    }
}

fn line_of_joint(joint: &Joint, highlight: bool, (from, to): (Place, Place), drawing: f64) -> Markup {
    let (class, name_class) =
        if highlight { ("fx-highlight", "fx-highlight-name") } else { ("fx-joint", "fx-joint-name") };
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    let start = format!("M{:.1} {:.1}", from.0, from.1);
    let is_beam = matches!(joint.law, JointLaw::Beam { .. });
    let line = if is_beam || length < 30.0 {
        path(&format!("{class} fx-beam"), format!("{start}L{:.1} {:.1}", to.0, to.1))
    } else {
        path(&format!("{class} fx-thick"), start + &zigzag(from, (dx / length, dy / length), length, 7.0))
    };
    let (x, y) = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
    let upwards = dy.abs() > dx.abs();
    let room = if upwards { x - 14.0 } else { 2.0 * x.min(drawing - x) };
    let name = shortened(&joint.name, room);
    let width = text_width(&name);
    // Beside a line that runs upwards, above one that runs along x; above a short joint stand the sensors at
    // its ends.
    let place = match upwards {
        true => (x - 14.0 - 0.5 * width, y + 4.0),
        false if dx.abs() < width + 14.0 => (x, y + 24.0),
        false => (x, y - 13.0),
    };
    html! { (line) (text(name_class, place, &name)) }
}

/// The rest of a path along a unit direction: straight ends, zigzag between.
fn zigzag(from: Place, along: Place, length: f64, amplitude: f64) -> String {
    let coils = ((length - 16.0) / 10.0).round().clamp(4.0, 12.0) as usize;
    let end = (0.15 * length).max(6.0);
    let pitch = (length - 2.0 * end) / coils as f64;
    let at = |(s, side): (f64, f64)| {
        format!("L{:.1} {:.1}", from.0 + along.0 * s - along.1 * side, from.1 + along.1 * s + along.0 * side)
    };
    let coil = |coil: usize| {
        let side = if coil.is_multiple_of(2) { amplitude } else { -amplitude };
        (end + (coil as f64 + 0.5) * pitch, side)
    };
    let ends = [(length - end, 0.0), (length, 0.0)];
    std::iter::once((end, 0.0)).chain((0..coils).map(coil)).chain(ends).map(at).collect()
}

/// A spring down to hatched ground.
fn ground(x: f64, top: f64) -> Markup {
    let ground = top + SUPPORT - 12.0;
    let spring = zigzag((x, top), (0.0, 1.0), ground - top, 5.0);
    let hatching =
        (0..5).map(|stroke| format!("M{:.1} {ground:.1}l-5 6", x - 10.0 + 6.0 * f64::from(stroke)));
    let left = x - 14.0;
    let d = format!("M{x:.1} {top:.1}{spring}M{left:.1} {ground:.1}h28{}", hatching.collect::<String>());
    path("fx-ground", d)
}

/// A bar of 1, 2 or 5 times a power of ten millimetres, some 80 to 200 pixels long.
fn scale_bar(per_metre: f64, y: f64) -> Markup {
    let most = 200.0 / per_metre * 1e3;
    let decade = 10f64.powf(most.log10().floor());
    let lengths = [5.0, 2.0, 1.0].into_iter().map(|factor| factor * decade);
    let length = lengths.into_iter().find(|length| *length <= most).unwrap_or(decade);
    let (top, end) = (y - 3.0, 24.0 + length * 1e-3 * per_metre);
    let bar = format!("M24 {top:.1}v6M24 {y:.1}H{end:.1}M{end:.1} {top:.1}v6");
    let label = format!("{} mm", significant(length, 1));
    html! { (path("fx-line", bar)) (text("fx-soft", (0.5 * (24.0 + end), y - 6.0), &label)) }
}

/// The directions of the convention: x along the fixture, y transverse.
fn axes(width: f64, y: f64) -> Markup {
    let (x, top, right) = (width - 62.0, y - 26.0, width - 34.0);
    let lines = format!(
        "M{x:.1} {top:.1}V{y:.1}H{right:.1}M{right:.1} {y:.1}l-5 -3m5 3l-5 3M{x:.1} {top:.1}l-3 5m3 -5l3 5"
    );
    html! {
        (path("fx-line", lines))
        (text("fx-soft", (x + 38.0, y + 4.0), "x"))
        (text("fx-soft", (x - 9.0, y - 20.0), "y"))
    }
}
