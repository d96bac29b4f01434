//! Where things go: abscissae to pixels, overlapping bodies to rows, labels to lanes.

use std::collections::BTreeSet;

use jointscope_fixture::{Body, BodyKind, Fixture};

use super::outline::outlines;
use super::side_view::{ChannelKind, SideView};
use crate::format::{fixed, trimmed};
use crate::plot::Span;

/// Width of the drawing in its own pixels, and of the one for narrow windows, which shows letters as large in
/// less than half of the room.
pub(super) const WIDTH: f64 = 860.0;
pub(super) const NARROW: f64 = 400.0;
const MARGIN: f64 = 46.0;
/// Height of a block, and of a slender beam.
const BLOCK: f64 = 64.0;
const BEAM: f64 = 12.0;
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

/// Labels of one kind beside a row at the most: what a page has room for. More would stand in dozens of lanes
/// that nobody reads, and labels are placed pair by pair.
pub(super) const MOST_LABELS: usize = 60;

/// Room a letter takes, px.
const LETTER: f64 = 7.4;

/// Room a text takes, in pixels at 13 px type. Digits and capitals are wider than the average letter; labels
/// may stand apart but not overlap.
pub(super) fn text_width(text: &str) -> f64 {
    LETTER * text.chars().count() as f64 + 4.0
}

/// The text where there is room for it, px; else without its middle, for names of a kind differ at their
/// ends.
pub(super) fn shortened(text: &str, room: f64) -> String {
    if text_width(text) <= room {
        return text.to_owned();
    }
    let characters: Vec<char> = text.chars().collect();
    let kept = (room / LETTER).max(3.0) as usize - 1;
    let (front, back) = characters.split_at(kept - kept / 2);
    front.iter().chain(&['…']).chain(&back[back.len().saturating_sub(kept / 2)..]).collect()
}

/// From metres to pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    start: f64,
    /// Pixels per metre; zero when everything lies at one abscissa.
    pub per_metre: f64,
    /// Width of the drawing, px.
    pub width: f64,
}

impl Scale {
    fn new(view: &SideView, outlines: &[(f64, f64)], width: f64) -> Self {
        let fixture = view.fixture;
        let abscissae = (outlines.iter().flat_map(|(from, to)| [*from, *to]))
            .chain(fixture.points().iter().map(|point| point.x.value))
            .chain(fixture.supports().iter().map(|support| fixture.support_place(support).1))
            .chain(view.highlights.iter().map(|highlight| highlight.x));
        match Span::of(abscissae).0 {
            Some((start, end)) if end - start > 1e-9 && end - start < 1e9 => {
                Self { start, per_metre: (width - 2.0 * MARGIN) / (end - start), width }
            }
            _ => Self { start: 0.0, per_metre: 0.0, width },
        }
    }

    pub(super) fn px(&self, x: f64) -> f64 {
        if self.per_metre == 0.0 { self.width / 2.0 } else { MARGIN + (x - self.start) * self.per_metre }
    }
}

/// What ties a label to its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Tie {
    /// A channel's arrow at the top of the body.
    Arrow(ChannelKind),
    /// A line to the middle of the body, where a circle stands.
    Circle,
    /// A line to the body's edge.
    Line,
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
    pub tie: Tie,
    /// Whether it stands to the right of its place rather than centred on it.
    aside: bool,
    /// How far right of its place the line goes that ties it to it, px.
    lean: f64,
    /// Filled by [`assign_lanes`].
    pub centre: f64,
    /// Filled by [`assign_lanes`]; 0 is next to the body.
    pub lane: usize,
}

impl Label {
    fn new(text: impl Into<String>, class: &'static str, tie: Tie, anchor: f64) -> Self {
        let (below, half) = (None, 0.5 * BLOCK);
        Self {
            text: text.into(),
            below,
            class,
            anchor,
            half,
            tie,
            aside: false,
            lean: 0.0,
            centre: anchor,
            lane: 0,
        }
    }

    fn width(&self) -> f64 {
        let below = self.below.as_deref().map_or(0.0, text_width);
        text_width(&self.text).max(below)
    }

    /// Abscissa of the line that ties it to its place.
    pub(super) fn leader(&self) -> f64 {
        self.anchor + self.lean
    }

    /// Where it may stand along x: about its leader, at its side.
    fn stretches(&self, width: f64) -> [Stretch; 5] {
        let half = 0.5 * self.width();
        // Names are bold, a little wider than other texts.
        let edge = 1.05 * half + 2.0;
        let most = (width - edge).max(half);
        let (over, beside) = ((half - 6.0).max(0.0), half + 9.0);
        let shifts = match self.aside {
            true => [beside, 0.0, -beside, over, -over],
            false => [0.0, over, -over, beside, -beside],
        };
        shifts.map(|shift| {
            let centre = (self.leader() + shift).clamp(edge.min(most), most.max(edge));
            (centre - half, centre + half)
        })
    }
}

/// Gives each label the lane nearest to the body in which it meets no other label and no other's leader, and
/// its own leader meets no label; keeps it within a drawing of this width, in which a text that is longer
/// loses its middle. Returns how many lanes were needed.
fn assign_lanes(labels: &mut [Label], width: f64) -> usize {
    labels.iter_mut().for_each(|label| label.text = shortened(&label.text, 0.92 * width));
    labels.sort_by(|a, b| (a.anchor.total_cmp(&b.anchor)).then_with(|| a.text.cmp(&b.text)));
    // How many others' leaders it would cover, at the place where it covers the fewest.
    let covered = |index: usize, (from, to): Stretch, others: &[usize]| -> usize {
        let leaders = others.iter().filter(|other| **other != index).map(|other| labels[*other].leader());
        leaders.filter(|x| (from - 3.0..to + 3.0).contains(x)).count()
    };
    let all: Vec<usize> = (0..labels.len()).collect();
    let in_the_way = |index: &usize| {
        let label = &labels[*index];
        label.stretches(width).map(|stretch| covered(*index, stretch, &all)).into_iter().min()
    };
    // The leaders of far lanes pass the near ones, so labels that are in no leader's way, and short ones, go
    // near.
    let mut order = all.clone();
    order.sort_by(|a, b| labels[*a].width().total_cmp(&labels[*b].width()));
    order.sort_by_key(in_the_way);
    let mut lanes = Lanes::default();
    let place = |(at, index): (usize, &usize)| {
        let label = &labels[*index];
        let mut stretches = label.stretches(width);
        stretches.sort_by_key(|stretch| covered(*index, *stretch, &order[at + 1..]));
        let leader = label.leader();
        (*index, lanes.take(&stretches, (leader - 3.0, leader + 3.0)))
    };
    let placed: Vec<_> = order.iter().enumerate().map(place).collect();
    for (index, (lane, (from, to))) in placed {
        labels[index].centre = 0.5 * (from + to);
        labels[index].lane = lane;
    }
    lanes.taken.len()
}

/// Stretches taken of each lane, px: by labels, and by leaders that pass.
#[derive(Default)]
struct Lanes {
    taken: Vec<Vec<Stretch>>,
    passed: Vec<Vec<Stretch>>,
}

type Stretch = (f64, f64);

impl Lanes {
    /// The first of some stretches, and the nearest lane, in which no label and no leader is met and whose
    /// nearer lanes have no label in the leader's way; where there is none, the first stretch in a new lane.
    fn take(&mut self, stretches: &[Stretch], leader: Stretch) -> (usize, Stretch) {
        let lanes = self.taken.len();
        let mut all = stretches.iter().flat_map(|stretch| (0..=lanes).map(move |lane| (lane, *stretch)));
        let fits = |(lane, stretch): &(usize, Stretch)| {
            is_free(&self.taken, *lane, *stretch)
                && is_free(&self.passed, *lane, *stretch)
                && (0..*lane).all(|near| is_free(&self.taken, near, leader))
        };
        let (lane, stretch) = all.find(fits).unwrap_or((lanes, stretches[0]));
        (0..lane).for_each(|near| put(&mut self.passed, near, leader));
        put(&mut self.taken, lane, stretch);
        (lane, stretch)
    }
}

fn is_free(lanes: &[Vec<Stretch>], lane: usize, (from, to): Stretch) -> bool {
    lanes.get(lane).is_none_or(|lane| !lane.iter().any(|(a, b)| from < *b && to > *a))
}

fn put(lanes: &mut Vec<Vec<Stretch>>, lane: usize, stretch: Stretch) {
    lanes.resize(lanes.len().max(lane + 1), Vec::new());
    lanes[lane].push(stretch);
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
    /// By body; none where nothing is known to lie on it.
    pub bodies: Vec<Option<Placed>>,
    pub rows: Vec<Row>,
    pub height: f64,
    /// Number of points and channels that have no label.
    pub unlabelled: usize,
}

impl Layout {
    pub(super) fn new(view: &SideView, width: f64) -> Self {
        let outlines = outlines(view.fixture);
        let scale = Scale::new(view, &outlines, width);
        let bodies = place_bodies(view.fixture, &outlines, scale);
        let count = bodies.iter().flatten().map(|b| b.row + 1).max().unwrap_or(1);
        let mut layout =
            Self { scale, bodies, rows: vec![Row::default(); count], height: 0.0, unlabelled: 0 };
        layout.label_bodies(view.fixture);
        layout.label_points(view);
        for highlight in view.highlights.iter().filter(|highlight| highlight.x.is_finite()) {
            let row = highlight.body.and_then(|body| layout.bodies[body]).map_or(0, |body| body.row);
            let anchor = layout.scale.px(highlight.x);
            let label = Label::new(&highlight.label, "fx-highlight-name", Tie::Circle, anchor);
            let lean = beside_arrows(anchor, &layout.rows[row].above);
            layout.rows[row].above.push(Label { lean, ..label });
        }
        layout.stack();
        layout
    }

    /// Pixel position of a point.
    pub(super) fn point(&self, fixture: &Fixture, index: usize) -> Option<(f64, f64)> {
        let point = &fixture.points()[index];
        Some((self.scale.px(point.x.value), self.rows[self.bodies[point.body]?.row].middle))
    }

    fn label_bodies(&mut self, fixture: &Fixture) {
        for (body, placed) in fixture.bodies().iter().zip(&self.bodies) {
            let Some(placed) = placed else { continue };
            let row = &mut self.rows[placed.row];
            row.half = row.half.max(0.5 * placed.height);
            if !name_fits(&body_name(body), placed) {
                let middle = 0.5 * (placed.left + placed.right);
                let label = Label::new(body_name(body), "fx-name", Tie::Line, middle);
                row.above.push(Label { half: 0.5 * placed.height, ..label });
            }
        }
        for support in fixture.supports() {
            if let Some(body) = &self.bodies[fixture.support_place(support).0] {
                self.rows[body.row].supported = true;
            }
        }
    }

    fn label_points(&mut self, view: &SideView) {
        // Between stacked rows joints run along y, where point names would stand.
        let aside = self.rows.len() > 1;
        let points = view.fixture.points();
        let mut in_use: BTreeSet<usize> = view.fixture.held_points().collect();
        in_use.extend(view.channels.iter().map(|(index, _)| *index));
        let rows: Vec<Option<usize>> =
            points.iter().map(|point| self.bodies[point.body].as_ref().map(|body| body.row)).collect();
        for row in 0..self.rows.len() {
            let (first, others): (Vec<usize>, Vec<usize>) = (0..points.len())
                .filter(|index| rows[*index] == Some(row))
                .partition(|at| in_use.contains(at));
            let all = first.len() + others.len();
            let mut named = thinned(first, MOST_LABELS);
            named.extend(thinned(others, MOST_LABELS - named.len()));
            self.unlabelled += all - named.len();
            for index in named {
                let point = &points[index];
                let label = Label::new(&point.name, "fx-point-name", Tie::Line, self.scale.px(point.x.value));
                let below = Some(format!("{} mm", millimetres(point.x.value)));
                self.rows[row].below.push(Label { below, aside, ..label });
            }
            let channels = (0..view.channels.len()).filter(|at| rows[view.channels[*at].0] == Some(row));
            let channels: Vec<usize> = channels.collect();
            let all = channels.len();
            let named = thinned(channels, MOST_LABELS);
            self.unlabelled += all - named.len();
            named.into_iter().for_each(|at| self.label_channel(view, at));
        }
    }

    fn label_channel(&mut self, view: &SideView, at: usize) {
        let (index, kind) = view.channels[at];
        let point = &view.fixture.points()[index];
        let Some(body) = &self.bodies[point.body] else { return };
        let (word, class, side) = match kind {
            ChannelKind::Response => ("response", "fx-response", 7.0),
            ChannelKind::Reference => ("reference", "fx-reference", -7.0),
        };
        // Both kinds of one point stand side by side in the sorted list.
        let beside = [at.checked_sub(1), Some(at + 1)].into_iter().flatten();
        let both = beside.filter_map(|at| view.channels.get(at)).any(|(other, _)| *other == index);
        let anchor = self.scale.px(point.x.value) + if both { side } else { 0.0 };
        let label = Label::new(format!("{word} {}", point.name), class, Tie::Arrow(kind), anchor);
        self.rows[body.row].above.push(Label { half: 0.5 * body.height, ..label });
    }

    /// Rows from top to bottom, each as high as its labels need.
    fn stack(&mut self) {
        let mut top = 6.0;
        for row in &mut self.rows {
            let above = assign_lanes(&mut row.above, self.scale.width);
            let below = assign_lanes(&mut row.below, self.scale.width);
            let arrows = if above > 0 { ARROW } else { 8.0 };
            row.middle = top + above as f64 * LANE + arrows + row.half;
            let support = if row.supported { SUPPORT } else { 6.0 };
            top = row.middle + row.half + support + below as f64 * POINT_LANE + 12.0;
        }
        // The scale bar and the axes, and a line on what has no label.
        self.height = top + 40.0 + if self.unlabelled > 0 { LANE } else { 0.0 };
    }
}

/// Px from a circle's middle at which the line to it runs beside the arrow that may end there, and beside
/// others.
fn beside_arrows(anchor: f64, labels: &[Label]) -> f64 {
    const BESIDE: [f64; 4] = [11.0, 7.0, -7.0, -11.0];
    const APART: f64 = 4.0;
    let arrows = || labels.iter().filter(|label| matches!(label.tie, Tie::Arrow(_)));
    let is_free = |lean: &f64| arrows().all(|arrow| (arrow.anchor - anchor - lean).abs() > APART);
    BESIDE.into_iter().find(is_free).unwrap_or(BESIDE[0])
}

/// As many of some things as there is room for, evenly from the first to the last.
fn thinned(all: Vec<usize>, room: usize) -> Vec<usize> {
    let count = all.len();
    if count <= room {
        return all;
    }
    (0..room).map(|at| all[at * (count - 1) / (room - 1).max(1)]).collect()
}

/// The name as drawn; what cannot rotate says so.
pub(super) fn body_name(body: &Body) -> String {
    match &body.kind {
        BodyKind::Rigid(rigid) if !rigid.rotates => format!("{} (y only)", body.name),
        _ => body.name.clone(),
    }
}

/// Whether a name has room inside its body.
pub(super) fn name_fits(name: &str, placed: &Placed) -> bool {
    placed.height >= BLOCK && text_width(name) + 8.0 < placed.right - placed.left
}

/// An abscissa in millimetres to the hundredth, which is finer than any tape, without zeros at its end.
fn millimetres(x: f64) -> String {
    trimmed(&fixed(x * 1e3, 2))
}

fn place_bodies(fixture: &Fixture, outlines: &[(f64, f64)], scale: Scale) -> Vec<Option<Placed>> {
    let narrowest = if scale.per_metre == 0.0 { WITHOUT_EXTENT.min(scale.width) } else { NARROWEST };
    let mut rows: Vec<Vec<Stretch>> = Vec::new();
    let place = |(body, (from, to)): (&Body, &(f64, f64))| {
        let is_beam = body.kind.is_beam();
        let (mut left, mut right) = Span::of([*from, *to]).0.map(|(a, b)| (scale.px(a), scale.px(b)))?;
        if right - left < narrowest && !is_beam {
            let middle = (0.5 * (left + right)).clamp(0.5 * narrowest, scale.width - 0.5 * narrowest);
            (left, right) = (middle - 0.5 * narrowest, middle + 0.5 * narrowest);
        }
        // Bodies that touch stand side by side.
        let stretch = (left + 0.25, right - 0.25);
        let row = (0..rows.len()).find(|row| is_free(&rows, *row, stretch)).unwrap_or(rows.len());
        put(&mut rows, row, stretch);
        Some(Placed { left, right, row, height: if is_beam { BEAM } else { BLOCK } })
    };
    fixture.bodies().iter().zip(outlines).map(place).collect()
}
