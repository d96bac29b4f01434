//! Points in a plane with curves over them, as inline SVG: for signals drawn against each other, which have
//! no ascending abscissa.

use maud::{Markup, PreEscaped, html};

use crate::unit::Scale;

/// A panel: clouds of points and a curve over two quantities.
pub(crate) struct Scatter {
    pub title: String,
    /// Name and SI unit along x, then along y.
    pub axes: [(String, &'static str); 2],
    /// Points of one colour each: the page's variable, and where they lie.
    pub clouds: Vec<(&'static str, Vec<[f64; 2]>)>,
    /// Drawn over the points.
    pub curve: Vec<[f64; 2]>,
}

const WIDTH: f64 = 380.0;
const HEIGHT: f64 = 340.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 54.0;

const STYLE: &str = "<style>.sc{font:14px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink,#1b1f24)}\
.sc text{text-anchor:middle}.sc .sc-y{text-anchor:end}.sc .sc-title{font-weight:600;text-anchor:start}.sc path{fill:none}\
.sc-grid{stroke:var(--grid,#e9ebee)}.sc-zero{stroke:var(--soft,#5a636e);stroke-width:.8}\
.sc-points{stroke-width:2.6;stroke-linecap:round;opacity:.6}.sc-curve{stroke:var(--highlight,#b0257e);stroke-width:2}</style>";

/// Panels side by side in one drawing, described by `description` for those who do not see it.
pub(crate) fn draw(panels: &[Scatter], description: &str) -> Markup {
    let width = WIDTH * panels.len() as f64;
    html! {
        svg.sc xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (width) " " (HEIGHT) } role="img"
            aria-label=(description) {
            (PreEscaped(STYLE))
            @for (index, panel) in panels.iter().enumerate() {
                g transform={ "translate(" (WIDTH * index as f64) " 0)" } { (panel.draw()) }
            }
        }
    }
}

/// What an axis shows: its unit, its range and the step of its ticks, in that unit.
struct Range {
    scale: Scale,
    low: f64,
    high: f64,
    step: f64,
}

impl Range {
    fn of(values: impl Iterator<Item = f64> + Clone, unit: &str) -> Self {
        let finite = values.filter(|v| v.is_finite());
        let scale = Scale::for_values(finite.clone(), unit);
        let ends = finite.fold([0.0f64, 0.0f64], |[a, b], v| [a.min(scale.of(v)), b.max(scale.of(v))]);
        let span = if ends[1] > ends[0] { ends[1] - ends[0] } else { 1.0 };
        let raw = span / 4.0;
        let decade = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= raw).unwrap_or(raw);
        Range { scale, low: ends[0] - 0.04 * span, high: ends[1] + 0.04 * span, step }
    }

    /// 0 to 1 along the axis.
    fn at(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    fn ticks(&self) -> impl Iterator<Item = f64> + '_ {
        let first = (self.low / self.step).ceil() as i64;
        let last = (self.high / self.step).floor() as i64;
        (first..=last).map(|i| i as f64 * self.step)
    }

    fn label(&self, tick: f64) -> String {
        if tick.abs() >= 1e5 || self.step < 1e-4 {
            return format!("{tick:.1e}");
        }
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        format!("{tick:.decimals$}")
    }
}

impl Scatter {
    fn draw(&self) -> Markup {
        let all = || self.clouds.iter().flat_map(|(_, points)| points).chain(&self.curve);
        let x = Range::of(all().map(|p| p[0]), self.axes[0].1);
        let y = Range::of(all().map(|p| p[1]), self.axes[1].1);
        let px = |value: f64| LEFT + x.at(value) * (WIDTH - LEFT - RIGHT);
        let py = |value: f64| HEIGHT - BOTTOM - y.at(value) * (HEIGHT - TOP - BOTTOM);
        let grid = |tick: f64, d: String| {
            html! { path class=(if tick == 0.0 { "sc-zero" } else { "sc-grid" }) d=(d) {} }
        };
        let (floor, end) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
        let place = |p: &[f64; 2]| {
            let at = [px(x.scale.of(p[0])), py(y.scale.of(p[1]))];
            at.iter().all(|v| v.is_finite()).then_some(at)
        };
        let dots = |points: &[[f64; 2]]| -> String {
            points.iter().filter_map(place).map(|[x, y]| format!("M{x:.1} {y:.1}h0")).collect()
        };
        let line: Vec<String> =
            self.curve.iter().filter_map(place).map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
        let named = |axis: usize, range: &Range| format!("{}, {}", self.axes[axis].0, range.scale.unit());
        html! {
            @for tick in x.ticks() {
                @let at = format!("{:.1}", px(tick));
                (grid(tick, format!("M{at} {TOP}V{floor}")))
                text x=(at) y=(floor + 17.0) { (x.label(tick)) }
            }
            @for tick in y.ticks() {
                @let at = py(tick);
                (grid(tick, format!("M{LEFT} {at:.1}H{end}")))
                text.sc-y x=(LEFT - 6.0) y=(format!("{:.1}", at + 5.0)) { (y.label(tick)) }
            }
            @for (colour, points) in &self.clouds {
                path.sc-points style={ "stroke:var(" (colour) ")" } d=(dots(points)) {}
            }
            @if !line.is_empty() { path.sc-curve d={ "M" (line.join("L")) } {} }
            text.sc-title x=(LEFT) y="14" { (self.title) }
            text.sc-title style="font-weight:400" x=(LEFT) y="29" { (named(1, &y)) }
            text x=(0.5 * (LEFT + end)) y=(HEIGHT - 14.0) { (named(0, &x)) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_ticks_and_curve_lie_within_the_panel_and_names_are_escaped() {
        let panel = Scatter {
            title: "<J>".into(),
            axes: [("d".into(), "m"), ("force".into(), "N")],
            clouds: vec![("--trace-1", (0..50).map(|i| [1e-6 * f64::from(i - 25), f64::from(i)]).collect())],
            curve: vec![[-2e-5, 0.0], [2e-5, 40.0], [f64::NAN, 1.0]],
        };
        let svg = draw(&[panel], "a map");
        let svg = svg.into_string();
        assert_eq!(svg.matches("h0").count(), 50);
        assert!(svg.contains("&lt;J&gt;") && svg.contains("d, µm") && svg.contains(">-20<"), "{svg}");
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn points_that_are_all_alike_are_drawn() {
        let clouds = vec![("--trace-1", vec![[0.0, 0.0]; 3])];
        let axes = [("d".into(), "m"), ("force".into(), "N")];
        let svg =
            draw(&[Scatter { title: String::new(), axes, clouds, curve: Vec::new() }], "").into_string();
        assert!(!svg.contains("NaN") && svg.matches("h0").count() == 3);
    }
}
