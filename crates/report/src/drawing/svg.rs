//! The arrangement written as SVG.

use super::layout::{
    ARROW, LANE, Label, Layout, POINT_LANE, Row, SUPPORT, WIDTH, body_name, name_fits, text_width,
};
use super::{ChannelKind, FixtureDrawing, Joint};
use crate::html::{escaped, push_element};

/// Colours come from the page's variables; without a page the drawing is dark on light.
const STYLE: &str = "<style>\
.fx{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink,#1b1f24)}\
.fx text{text-anchor:middle;paint-order:stroke;stroke:var(--ground,#fff);stroke-width:4px;stroke-linejoin:round}.fx text.fx-inside{stroke:none;font-weight:600}.fx path,.fx line{fill:none;stroke-width:1.3}\
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

pub(super) fn draw(drawing: &FixtureDrawing) -> String {
    let layout = Layout::new(drawing);
    let mut svg = format!(
        "<svg class=\"fx\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {:.0}\" role=\"img\" aria-label=\"{}\">{STYLE}\n",
        layout.height,
        escaped(&description(drawing))
    );
    for support in drawing.supports.iter().filter(|support| support.x.is_finite()) {
        if let Some(body) = layout.body(support.body) {
            let top = layout.rows[body.row].middle + 0.5 * body.height;
            draw_support(&mut svg, layout.scale.px(support.x), top);
        }
    }
    for (body, placed) in drawing.bodies.iter().zip(&layout.bodies) {
        let Some(placed) = placed else { continue };
        let middle = layout.rows[placed.row].middle;
        svg.push_str(&format!(
            "<rect class=\"fx-body\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"3\"/>\n",
            placed.left,
            middle - 0.5 * placed.height,
            (placed.right - placed.left).max(1.0),
            placed.height
        ));
        let name = body_name(body);
        if name_fits(&name, placed) {
            // Joints between stacked rows run through the middle of their bodies.
            let centre = if layout.rows.len() > 1 {
                placed.left + 4.0 + 0.5 * text_width(&name)
            } else {
                0.5 * (placed.left + placed.right)
            };
            text(&mut svg, "fx-inside", centre, middle - 13.0, &name);
        }
    }
    for row in &layout.rows {
        draw_leaders(&mut svg, row);
    }
    for joint in &drawing.joints {
        let ends = (layout.point(drawing, joint.from), layout.point(drawing, joint.to));
        if let (Some(from), Some(to)) = ends {
            draw_joint(&mut svg, joint, from, to);
        }
    }
    for index in 0..drawing.points.len() {
        if let Some((x, y)) = layout.point(drawing, index) {
            svg.push_str(&format!("<circle class=\"fx-dot\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>\n"));
        }
    }
    for row in &layout.rows {
        draw_labels(&mut svg, row);
    }
    draw_scale_bar(&mut svg, layout.scale.per_metre, layout.height - 14.0);
    draw_axes(&mut svg, layout.height - 14.0);
    svg.push_str("</svg>\n");
    svg
}

/// The drawing in one sentence for who cannot see it.
fn description(drawing: &FixtureDrawing) -> String {
    let names = |names: Vec<&str>| names.join(", ");
    let bodies = names(drawing.bodies.iter().map(|b| b.name.as_str()).collect());
    let points = names(drawing.points.iter().map(|p| p.name.as_str()).collect());
    let joints = names(drawing.joints.iter().map(|j| j.name.as_str()).collect());
    format!("Side view of the fixture. Bodies: {bodies}. Points: {points}. Joints: {joints}.")
}

fn text(svg: &mut String, class: &str, x: f64, y: f64, text: &str) {
    svg.push_str(&format!("<g transform=\"translate({x:.1} {y:.1})\">"));
    push_element(svg, "text", class, text);
    svg.push_str("</g>\n");
}

fn line(svg: &mut String, class: &str, from: (f64, f64), to: (f64, f64)) {
    svg.push_str(&format!(
        "<line class=\"{class}\" x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\"/>",
        from.0, from.1, to.0, to.1
    ));
}

/// Baseline of a label above its row.
fn baseline_above(row: &Row, label: &Label) -> f64 {
    row.middle - row.half - ARROW - 4.0 - label.lane as f64 * LANE
}

/// Everything that ties a label to its place, drawn before the labels so that these stay on top.
fn draw_leaders(svg: &mut String, row: &Row) {
    for label in &row.above {
        let top = row.middle - label.half;
        let start = (label.anchor, baseline_above(row, label) + 4.0);
        match label.channel {
            Some(kind) => {
                // Beyond the first lane, or above a beam among blocks, a thin leader leads down to the arrow.
                if label.lane > 0 || label.half < row.half {
                    line(svg, "fx-leader", start, (label.anchor, top - ARROW + 2.0));
                }
                draw_arrow(svg, kind, label.anchor, top);
            }
            None if label.to_middle => {
                // Beside the arrow that may end at the same place.
                let x = label.anchor + 11.0;
                line(svg, "fx-highlight", (x, start.1), (x, row.middle - 9.0));
                svg.push_str(&format!(
                    "<circle class=\"fx-highlight\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"14\" fill=\"none\" stroke-width=\"2.2\"/>\n",
                    label.anchor, row.middle
                ));
            }
            None => line(svg, "fx-leader", start, (label.anchor, top)),
        }
    }
    for label in &row.below {
        let end = row.middle + row.half + below_offset(row) + label.lane as f64 * POINT_LANE;
        line(svg, "fx-leader", (label.anchor, row.middle + 4.0), (label.anchor, end + 2.0));
    }
    svg.push('\n');
}

fn below_offset(row: &Row) -> f64 {
    if row.supported { SUPPORT } else { 6.0 }
}

/// A force points at the body; a response stands on its sensor and points along y.
fn draw_arrow(svg: &mut String, kind: ChannelKind, x: f64, top: f64) {
    match kind {
        ChannelKind::Reference => svg.push_str(&format!(
            "<path class=\"fx-reference-line\" d=\"M{x:.1} {:.1}V{:.1}\" stroke-width=\"1.8\"/><polygon class=\"fx-reference\" points=\"{x:.1},{:.1} {:.1},{:.1} {:.1},{:.1}\"/>\n",
            top - ARROW + 3.0, top - 8.0, top - 1.0, x - 4.5, top - 10.0, x + 4.5, top - 10.0
        )),
        ChannelKind::Response => svg.push_str(&format!(
            "<rect class=\"fx-response\" x=\"{:.1}\" y=\"{:.1}\" width=\"10\" height=\"7\" rx=\"1\"/><path class=\"fx-response-line\" d=\"M{x:.1} {:.1}V{:.1}\" stroke-width=\"1.8\"/><polygon class=\"fx-response\" points=\"{x:.1},{:.1} {:.1},{:.1} {:.1},{:.1}\"/>\n",
            x - 5.0, top - 7.0, top - 7.0, top - ARROW + 10.0, top - ARROW + 2.0, x - 4.5, top - ARROW + 11.0, x + 4.5, top - ARROW + 11.0
        )),
    }
}

fn draw_labels(svg: &mut String, row: &Row) {
    for label in &row.above {
        text(svg, label.class, label.centre, baseline_above(row, label), &label.text);
    }
    for label in &row.below {
        let top = row.middle + row.half + below_offset(row) + label.lane as f64 * POINT_LANE;
        text(svg, label.class, label.centre, top + 14.0, &label.text);
        if let Some(below) = &label.below {
            text(svg, "fx-soft", label.centre, top + 27.0, below);
        }
    }
}

fn draw_joint(svg: &mut String, joint: &Joint, from: (f64, f64), to: (f64, f64)) {
    let class = if joint.highlight { "fx-highlight" } else { "fx-joint" };
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    if joint.is_beam || length < 30.0 {
        svg.push_str(&format!(
            "<path class=\"{class}\" style=\"stroke-width:5\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>\n",
            from.0, from.1, to.0, to.1
        ));
    } else {
        svg.push_str(&format!(
            "<path class=\"{class}\" style=\"stroke-width:1.8\" d=\"M{:.1} {:.1}",
            from.0, from.1
        ));
        svg.push_str(&zigzag(from, (dx / length, dy / length), length, 7.0));
        svg.push_str("\"/>\n");
    }
    let name_class = if joint.highlight { "fx-highlight-name" } else { "fx-joint-name" };
    // Beside a line that runs upwards, above one that runs along x.
    let beside = dy.abs() > dx.abs();
    let (x, y) = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
    if beside {
        text(svg, name_class, x - 14.0 - 0.5 * text_width(&joint.name), y + 4.0, &joint.name);
    } else {
        // Above a short joint stand the sensors at its ends.
        let short = dx.abs() < text_width(&joint.name) + 14.0;
        let baseline = if short { y + 24.0 } else { y - 13.0 };
        text(svg, name_class, x, baseline, &joint.name);
    }
}

/// The rest of a path along a unit direction: straight ends, zigzag between.
fn zigzag(from: (f64, f64), along: (f64, f64), length: f64, amplitude: f64) -> String {
    let coils = ((length - 16.0) / 10.0).round().clamp(4.0, 12.0) as usize;
    let end = (0.15 * length).max(6.0);
    let pitch = (length - 2.0 * end) / coils as f64;
    let at = |s: f64, side: f64| {
        format!("L{:.1} {:.1}", from.0 + along.0 * s - along.1 * side, from.1 + along.1 * s + along.0 * side)
    };
    let mut path = at(end, 0.0);
    for coil in 0..coils {
        let side = if coil % 2 == 0 { amplitude } else { -amplitude };
        path.push_str(&at(end + (coil as f64 + 0.5) * pitch, side));
    }
    path.push_str(&at(length - end, 0.0));
    path.push_str(&at(length, 0.0));
    path
}

/// A spring down to hatched ground.
fn draw_support(svg: &mut String, x: f64, top: f64) {
    let ground = top + SUPPORT - 12.0;
    svg.push_str(&format!("<path class=\"fx-ground\" d=\"M{x:.1} {top:.1}"));
    svg.push_str(&zigzag((x, top), (0.0, 1.0), ground - top, 5.0));
    svg.push_str(&format!("M{:.1} {ground:.1}h28", x - 14.0));
    for stroke in 0..5 {
        svg.push_str(&format!("M{:.1} {ground:.1}l-5 6", x - 10.0 + 6.0 * f64::from(stroke)));
    }
    svg.push_str("\"/>\n");
}

/// A bar of 1, 2 or 5 times a power of ten millimetres, some 80 to 200 pixels long.
fn draw_scale_bar(svg: &mut String, per_metre: f64, y: f64) {
    if per_metre == 0.0 {
        return;
    }
    let most = 200.0 / per_metre * 1e3;
    let decade = 10f64.powf(most.log10().floor());
    let length = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|factor| factor * decade)
        .find(|length| *length <= most)
        .unwrap_or(decade);
    let end = 24.0 + length * 1e-3 * per_metre;
    svg.push_str(&format!(
        "<path class=\"fx-line\" d=\"M24 {:.1}v6M24 {y:.1}H{end:.1}M{end:.1} {:.1}v6\"/>",
        y - 3.0,
        y - 3.0
    ));
    let label = format!("{} mm", crate::format::significant(length, 1));
    text(svg, "fx-soft", 0.5 * (24.0 + end), y - 6.0, &label);
}

/// The directions of the convention: x along the fixture, y transverse.
fn draw_axes(svg: &mut String, y: f64) {
    let x = WIDTH - 62.0;
    svg.push_str(&format!(
        "<path class=\"fx-line\" d=\"M{x:.1} {:.1}V{y:.1}H{:.1}M{:.1} {:.1}l-5 -3m5 3l-5 3M{x:.1} {:.1}l-3 5m3 -5l3 5\"/>",
        y - 26.0, x + 28.0, x + 28.0, y, y - 26.0
    ));
    text(svg, "fx-soft", x + 38.0, y + 4.0, "x");
    text(svg, "fx-soft", x - 9.0, y - 20.0, "y");
}
