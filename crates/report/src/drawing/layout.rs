//! Where things go: abscissae to pixels, overlapping bodies to rows, labels to lanes.

use super::{ChannelKind, FixtureDrawing};

/// Width of the drawing in its own pixels.
pub(super) const WIDTH: f64 = 860.0;
const MARGIN: f64 = 46.0;
/// Height of a block, and of a slender beam.
pub(super) const BLOCK: f64 = 64.0;
pub(super) const BEAM: f64 = 12.0;
/// Height of one lane of labels.
pub(super) const LANE: f64 = 17.0;
/// Room between a body's top and the first lane: the arrows.
pub(super) const ARROW: f64 = 32.0;
/// Room below a body for a spring to ground.
pub(super) const SUPPORT: f64 = 38.0;
/// Point name and abscissa below each other.
pub(super) const POINT_LANE: f64 = 31.0;
/// Narrowest block that is drawn, and the width of blocks that all lie at one abscissa.
const NARROWEST: f64 = 46.0;
const WITHOUT_EXTENT: f64 = 340.0;

/// Room a text takes, in pixels at 13 px type. Digits and capitals are wider than the average letter; labels may stand apart but not overlap.
pub(super) fn text_width(text: &str) -> f64 {
    7.4 * text.chars().count() as f64 + 4.0
}

/// From metres to pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    start: f64,
    /// Pixels per metre; zero when everything lies at one abscissa.
    pub per_metre: f64,
}

impl Scale {
    fn new(drawing: &FixtureDrawing) -> Self {
        let abscissae = (drawing.bodies.iter().flat_map(|body| [body.from, body.to]))
            .chain(drawing.points.iter().map(|point| point.x))
            .chain(drawing.supports.iter().map(|support| support.x))
            .chain(drawing.highlights.iter().map(|highlight| highlight.x))
            .filter(|x| x.is_finite());
        let (start, end) =
            abscissae.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let length = end - start;
        if length > 1e-9 && length < 1e9 {
            Self { start, per_metre: (WIDTH - 2.0 * MARGIN) / length }
        } else {
            Self { start: 0.0, per_metre: 0.0 }
        }
    }

    pub fn px(&self, x: f64) -> f64 {
        if self.per_metre == 0.0 { WIDTH / 2.0 } else { MARGIN + (x - self.start) * self.per_metre }
    }
}

/// A label in a lane.
#[derive(Debug, Clone)]
pub(super) struct Label {
    pub text: String,
    /// A second line below it, in small type.
    pub below: Option<String>,
    pub class: &'static str,
    /// Pixel abscissa of what it belongs to.
    pub anchor: f64,
    /// Half the height of the body it belongs to.
    pub half: f64,
    /// Where the arrow of a channel goes; other labels get a leader or nothing.
    pub channel: Option<ChannelKind>,
    /// Where a leader to the place ends: `true` at the middle of the body, `false` at its top.
    pub to_middle: bool,
    /// Whether it stands to the right of its place rather than centred on it.
    pub aside: bool,
    /// Filled by [`assign_lanes`].
    pub centre: f64,
    /// Filled by [`assign_lanes`]; 0 is next to the body.
    pub lane: usize,
}

impl Label {
    pub fn new(text: impl Into<String>, class: &'static str, anchor: f64) -> Self {
        Self {
            text: text.into(),
            below: None,
            class,
            anchor,
            half: 0.5 * BLOCK,
            channel: None,
            to_middle: false,
            aside: false,
            centre: anchor,
            lane: 0,
        }
    }

    fn width(&self) -> f64 {
        let below = self.below.as_deref().map_or(0.0, text_width);
        text_width(&self.text).max(below)
    }
}

/// Gives each label the lane nearest to the body in which it meets no other, from left to right, and keeps it within the drawing. Returns how
/// many lanes were needed.
pub(super) fn assign_lanes(labels: &mut [Label]) -> usize {
    labels.sort_by(|a, b| (a.anchor.total_cmp(&b.anchor)).then_with(|| a.text.cmp(&b.text)));
    // Leaders of the far lanes must not run through labels of the near ones, so short labels go near.
    let mut order: Vec<usize> = (0..labels.len()).collect();
    order.sort_by(|a, b| labels[*a].width().total_cmp(&labels[*b].width()));
    let mut lanes: Vec<Vec<(f64, f64)>> = Vec::new();
    for index in order {
        let label = &mut labels[index];
        let half = 0.5 * label.width();
        let most = (WIDTH - half - 2.0).max(half);
        let wanted = label.anchor + if label.aside { half + 9.0 } else { 0.0 };
        label.centre = wanted.clamp(half.min(most) + 2.0, most.max(half + 2.0));
        let (from, to) =
            ((label.centre - half).min(label.anchor - 3.0), (label.centre + half).max(label.anchor + 3.0));
        let meets = |lane: &Vec<(f64, f64)>| lane.iter().any(|(a, b)| from < *b && to > *a);
        let lane = lanes.iter().position(|lane| !meets(lane)).unwrap_or(lanes.len());
        if lane == lanes.len() {
            lanes.push(Vec::new());
        }
        lanes[lane].push((from, to));
        label.lane = lane;
    }
    lanes.len()
}

/// A body as drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub left: f64,
    pub right: f64,
    pub row: usize,
    pub height: f64,
}

/// A row of bodies that do not overlap, with the labels above and below it.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    pub above: Vec<Label>,
    pub below: Vec<Label>,
    pub supported: bool,
    /// Vertical middle of its bodies, filled last.
    pub middle: f64,
    /// Half the height of its highest body.
    pub half: f64,
}

/// The whole arrangement.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub scale: Scale,
    /// By body; none where its abscissae are not finite.
    pub bodies: Vec<Option<Placed>>,
    pub rows: Vec<Row>,
    pub height: f64,
}

impl Layout {
    pub fn new(drawing: &FixtureDrawing) -> Self {
        let scale = Scale::new(drawing);
        let bodies = place_bodies(drawing, scale);
        let count = bodies.iter().flatten().map(|b| b.row + 1).max().unwrap_or(1);
        let mut layout = Self { scale, bodies, rows: vec![Row::default(); count], height: 0.0 };
        layout.collect_labels(drawing);
        layout.stack();
        layout
    }

    /// Row of a body, if it is drawn.
    pub fn body(&self, index: usize) -> Option<&Placed> {
        self.bodies.get(index)?.as_ref()
    }

    /// Pixel position of a point.
    pub fn point(&self, drawing: &FixtureDrawing, index: usize) -> Option<(f64, f64)> {
        let point = drawing.points.get(index).filter(|point| point.x.is_finite())?;
        let body = self.body(point.body)?;
        Some((self.scale.px(point.x), self.rows[body.row].middle))
    }

    fn collect_labels(&mut self, drawing: &FixtureDrawing) {
        // Between stacked rows joints run along y, where point names would stand.
        let stacked = self.rows.len() > 1;
        for (body, placed) in drawing.bodies.iter().zip(&self.bodies) {
            let Some(placed) = placed else { continue };
            let row = &mut self.rows[placed.row];
            row.half = row.half.max(0.5 * placed.height);
            if !name_fits(&body_name(body), placed) {
                let middle = 0.5 * (placed.left + placed.right);
                let mut label = Label::new(body_name(body), "fx-name", middle);
                label.half = 0.5 * placed.height;
                row.above.push(label);
            }
        }
        for point in drawing.points.iter().filter(|point| point.x.is_finite()) {
            let Some(row) = self.body(point.body).map(|body| body.row) else {
                continue;
            };
            let mut label = Label::new(&point.name, "fx-point-name", self.scale.px(point.x));
            label.below = Some(format!("{} mm", millimetres(point.x)));
            label.aside = stacked;
            self.rows[row].below.push(label);
        }
        for channel in &drawing.channels {
            let Some(point) = drawing.points.get(channel.point).filter(|p| p.x.is_finite()) else {
                continue;
            };
            let Some(&Placed { row, height, .. }) = self.body(point.body) else {
                continue;
            };
            let (word, class) = match channel.kind {
                ChannelKind::Response => ("response", "fx-response"),
                ChannelKind::Reference => ("reference", "fx-reference"),
            };
            let both = (drawing.channels.iter())
                .any(|other| other.point == channel.point && other.kind != channel.kind);
            let aside = match (both, channel.kind) {
                (false, _) => 0.0,
                (true, ChannelKind::Response) => 7.0,
                (true, ChannelKind::Reference) => -7.0,
            };
            let anchor = self.scale.px(point.x) + aside;
            let mut label = Label::new(format!("{word} {}", point.name), class, anchor);
            label.channel = Some(channel.kind);
            label.half = 0.5 * height;
            self.rows[row].above.push(label);
        }
        for highlight in drawing.highlights.iter().filter(|h| h.x.is_finite()) {
            let row = highlight.body.and_then(|body| self.body(body)).map_or(0, |b| b.row);
            let mut label = Label::new(&highlight.label, "fx-highlight-name", self.scale.px(highlight.x));
            label.to_middle = true;
            self.rows[row].above.push(label);
        }
        for support in drawing.supports.iter().filter(|support| support.x.is_finite()) {
            if let Some(row) = self.body(support.body).map(|body| body.row) {
                self.rows[row].supported = true;
            }
        }
    }

    /// Rows from top to bottom, each as high as its labels need.
    fn stack(&mut self) {
        let mut top = 6.0;
        for row in &mut self.rows {
            let above = assign_lanes(&mut row.above);
            let below = assign_lanes(&mut row.below);
            let arrows = if above > 0 { ARROW } else { 8.0 };
            row.middle = top + above as f64 * LANE + arrows + row.half;
            let support = if row.supported { SUPPORT } else { 6.0 };
            top = row.middle + row.half + support + below as f64 * POINT_LANE + 12.0;
        }
        // The scale bar and the axes.
        self.height = top + 40.0;
    }
}

/// The name as drawn; what cannot rotate says so.
pub(super) fn body_name(body: &super::Body) -> String {
    if body.rotates || body.is_beam { body.name.clone() } else { format!("{} (y only)", body.name) }
}

/// Whether a name has room inside its body.
pub(super) fn name_fits(name: &str, placed: &Placed) -> bool {
    placed.height >= BLOCK && text_width(name) + 8.0 < placed.right - placed.left
}

/// An abscissa in millimetres to the hundredth, which is finer than any tape, without zeros at its end.
fn millimetres(x: f64) -> String {
    let text = crate::format::fixed(x * 1e3, 2);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn place_bodies(drawing: &FixtureDrawing, scale: Scale) -> Vec<Option<Placed>> {
    let mut rows: Vec<Vec<(f64, f64)>> = Vec::new();
    drawing
        .bodies
        .iter()
        .map(|body| {
            if !body.from.is_finite() || !body.to.is_finite() {
                return None;
            }
            let (a, b) = (scale.px(body.from), scale.px(body.to));
            let (mut left, mut right) = (a.min(b), a.max(b));
            let narrowest = if scale.per_metre == 0.0 { WITHOUT_EXTENT } else { NARROWEST };
            if right - left < narrowest && !body.is_beam {
                let middle = (0.5 * (left + right)).clamp(0.5 * narrowest, WIDTH - 0.5 * narrowest);
                (left, right) = (middle - 0.5 * narrowest, middle + 0.5 * narrowest);
            }
            let overlaps =
                |row: &Vec<(f64, f64)>| row.iter().any(|(from, to)| left < *to - 0.5 && right > *from + 0.5);
            let row = rows.iter().position(|row| !overlaps(row)).unwrap_or(rows.len());
            if row == rows.len() {
                rows.push(Vec::new());
            }
            rows[row].push((left, right));
            Some(Placed { left, right, row, height: if body.is_beam { BEAM } else { BLOCK } })
        })
        .collect()
}
