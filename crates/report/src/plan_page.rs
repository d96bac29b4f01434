//! The page of a plan: the first thing to do, what every other would bring, and every FRF that could be
//! recorded.

use jointscope_fixture::Fixture;
use jointscope_plan::{BEYOND_DOUBT, ExpectedInterval, FrfGain, Measure, Plan, Suggestion};
use jointscope_spectra::FrfPair;
use jointscope_wording::effect_name;
use maud::{Markup, PreEscaped, html};

use crate::context::PageContext;
use crate::drawing::{Drawing, Highlight, SideView};
use crate::error::PageError;
use crate::format::{in_column, percent, quantity_in, significant};
use crate::section::Section;
use crate::table::{Cell, Table};
use crate::tone::Tone;
use crate::unit::Scale;

/// Suggestions that are drawn and listed.
const LISTED: usize = 12;
/// Suggestions that are shown in the side view.
const SHOWN: usize = 3;

/// The page of a plan as one self-contained HTML file.
///
/// # Errors
/// None that a plan can cause.
pub fn plan_page(plan: &Plan, fixture: &Fixture, context: &PageContext) -> Result<String, PageError> {
    let promised = plan.suggestions.first().is_some_and(Suggestion::is_promising);
    let tone = if promised { Tone::Ok } else { Tone::Attention };
    let details = std::iter::once(plan.question.clone()).chain(plan.remarks.iter().cloned());
    let page = context.page(
        "Plan: what to measure next",
        context.subtitle(fixture),
        context.verdict(tone, plan.says.clone(), details),
    );
    page.sections([suggestions(plan, fixture)])
        .sections((!plan.names.is_empty()).then(|| names(plan)))
        .sections((!plan.frfs.is_empty()).then(|| frfs(plan)))
        .to_html()
}

fn suggestions(plan: &Plan, fixture: &Fixture) -> Section {
    let section = Section::new("What to measure next").drawing(
        view(plan, fixture),
        "Side view with the channels recorded so far, responses (sensors) in blue and references (hammer) in green; the first suggestions are marked where they are \
         carried out.",
    );
    if plan.suggestions.is_empty() {
        return section.paragraph(&plan.says);
    }
    let listed = || plan.suggestions.iter().take(LISTED);
    let section = section.drawing(
        bars(&listed().collect::<Vec<_>>()),
        if plan.names.is_empty() {
            "Half of the 95 % interval that each would leave, beside the present one (dashed)."
        } else {
            "Expected ln of the odds for the true name against its nearest rival, nats, and the probability that one name has 90 % or more thereafter."
        },
    );
    let table = Table::of(listed()).words("What to do", |suggestion| suggestion.to_do.clone());
    let table = match plan.names.is_empty() {
        true => {
            let scale = unit_of(listed());
            table.numbers("95 % interval, ±", scale.unit(), |suggestion| {
                suggestion.interval.as_ref().map_or(String::new(), |i| in_column(i.then, None, &scale))
            })
        }
        false => table
            .numbers("One name ≥ 90 %", "", |suggestion| suggestion.sure.map_or(String::new(), promise))
            .numbers("Expected ln of the odds", "nats", |suggestion| {
                suggestion.expected_log_odds.map_or(String::new(), nats)
            }),
    };
    section.with(table.numbers("Effort", "FRFs", |suggestion| format!("{:.0}", suggestion.effort)))
}

/// The unit of the intervals that suggestions leave, which are all of one number of the joint.
fn unit_of<'a>(suggestions: impl Iterator<Item = &'a Suggestion>) -> Scale {
    let intervals: Vec<&ExpectedInterval> = suggestions.filter_map(|s| s.interval.as_ref()).collect();
    let unit = intervals.first().map_or("", |interval| interval.unit);
    Scale::for_values(intervals.iter().map(|interval| interval.then), unit)
}

/// A probability that a few hundred draws tell.
fn promise(share: f64) -> String {
    if share > 0.99 { "> 99 %".to_owned() } else { percent(share, 0) }
}

fn nats(value: f64) -> String {
    if value > BEYOND_DOUBT { format!("> {BEYOND_DOUBT:.0}") } else { significant(value, 3) }
}

/// The fixture with the first suggestions where they are carried out.
fn view(plan: &Plan, fixture: &Fixture) -> Drawing {
    let mut view = SideView::new(fixture, &plan.recorded);
    for (number, suggestion) in plan.suggestions.iter().take(SHOWN).enumerate() {
        view.highlights.extend(places(fixture, suggestion).into_iter().map(|(x, body, what)| Highlight {
            x,
            body,
            label: format!("{}. {what}", number + 1),
        }));
    }
    view.draw()
}

/// Where a suggestion is carried out: abscissa, body, what is there.
fn places(fixture: &Fixture, suggestion: &Suggestion) -> Vec<(f64, Option<usize>, String)> {
    let at = |point: &str, what: &str| {
        let point = fixture.point(point)?;
        Some((point.x.value, Some(point.body), what.to_owned()))
    };
    match &suggestion.action {
        Measure::Frf { frf } => {
            let same = frf.response.point == frf.reference.point;
            let what = if same { "hammer and sensor" } else { "hammer" };
            let sensor = at(&frf.response.point, "sensor").filter(|_| !same);
            at(&frf.reference.point, what).into_iter().chain(sensor).collect()
        }
        Measure::HammerAt { point, .. } => at(point, "hammer").into_iter().collect(),
        Measure::SensorAt { point, .. } => at(point, "sensor").into_iter().collect(),
        Measure::AddedMass { body, x, .. } => {
            let body = fixture.bodies().iter().position(|own| own.name == *body);
            vec![(*x, body, "mass".to_owned())]
        }
        _ => Vec::new(),
    }
}

const ROW: f64 = 26.0;
/// Room for a letter of a label.
const LETTER: f64 = 7.5;
const STYLE: &str = "<style>.pl{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif;fill:var(--ink,#1b1f24)}\
.pl-name{text-anchor:end}.pl-bar{fill:var(--measured,#0072b2)}.pl-line{stroke:var(--soft,#5a636e);stroke-dasharray:4 3;fill:none}.pl-base{stroke:var(--rule,#d9dde2)}</style>";

/// Widths of the chart of bars: all of it, the names' and the figures'.
#[derive(Debug, Clone, Copy)]
struct Widths {
    all: f64,
    left: f64,
    right: f64,
    class: &'static str,
}

const WIDE: Widths = Widths { all: 860.0, left: 270.0, right: 150.0, class: "pl wide" };
/// For narrow windows, with letters as large.
const NARROW: Widths = Widths { all: 400.0, left: 132.0, right: 140.0, class: "pl narrow" };

/// A bar a suggestion: what it is expected to bring, or the interval that it leaves beside the present one.
fn bars(all: &[&Suggestion]) -> Drawing {
    Drawing { wide: bars_within(all, WIDE), narrow: Some(bars_within(all, NARROW)) }
}

fn bars_within(all: &[&Suggestion], Widths { all: width, left, right, class }: Widths) -> Markup {
    let intervals = || all.iter().filter_map(|suggestion| suggestion.interval.as_ref());
    let now = intervals().filter_map(|interval| interval.now).fold(0.0, f64::max);
    let widest = intervals().map(|interval| interval.then).fold(now, f64::max).max(f64::MIN_POSITIVE);
    let nats_of = |suggestion: &&&Suggestion| suggestion.expected_log_odds.unwrap_or(0.0).min(BEYOND_DOUBT);
    let most = all.iter().map(|s| nats_of(&s)).fold(f64::MIN_POSITIVE, f64::max);
    let share = |suggestion: &Suggestion| match &suggestion.interval {
        Some(interval) => interval.then / widest,
        None => suggestion.expected_log_odds.unwrap_or(0.0).min(BEYOND_DOUBT) / most,
    };
    let scale = unit_of(all.iter().copied());
    let figure = |suggestion: &Suggestion| match &suggestion.interval {
        Some(interval) => format!("± {}", quantity_in(interval.then, None, &scale)),
        None => {
            let odds = nats(suggestion.expected_log_odds.unwrap_or(0.0));
            format!("{odds} nats, {}", promise(suggestion.sure.unwrap_or(0.0)))
        }
    };
    let height = ROW * all.len() as f64 + 8.0;
    let room = width - left - right;
    // What all bars are held against: the present interval.
    let mark = (now > 0.0).then(|| left + room * now / widest);
    let said: Vec<String> = all.iter().map(|s| format!("{}: {}", s.measure, figure(s))).collect();
    html! {
        svg class=(class) xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(said.join("; ")) {
            (PreEscaped(STYLE))
            @for (row, suggestion) in all.iter().enumerate() {
                @let top = ROW * row as f64 + 4.0;
                @let long = (room * share(suggestion)).clamp(0.0, room);
                text.pl-name x=(left - 10.0) y=(top + 16.0) { (row + 1) ". " (short(&suggestion.measure, left)) }
                rect.pl-bar x=(left) y=(top + 4.0) width=(format!("{long:.1}")) height=(ROW - 8.0) {}
                text x=(format!("{:.1}", left + long + 8.0)) y=(top + 16.0) { (figure(suggestion)) }
            }
            path.pl-base d={ "M" (left) " 0V" (height) } {}
            @if let Some(mark) = mark { path.pl-line d=(format!("M{mark:.1} 0V{height}")) {} }
        }
    }
}

/// A label that fits into `room`, px, beside its number.
fn short(text: &str, room: f64) -> String {
    let most = (room / LETTER) as usize;
    match text.chars().count() > most {
        true => text.chars().take(most - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

fn names(plan: &Plan) -> Section {
    let table = Table::of(&plan.names).words("Name", |name| effect_name(&name.effect)).numbers(
        "Probability",
        "",
        |name| percent(name.probability, 1),
    );
    let section = Section::new("The names that are left").with(table);
    let pairs: Vec<String> = plan.not_by_frfs.iter().map(|[a, b]| format!("{a} and {b}")).collect();
    match pairs.is_empty() {
        true => section,
        false => section.paragraph(format!(
            "All FRFs between the points considered, recorded together, do not tell apart: {}.",
            pairs.join("; ")
        )),
    }
}

/// A row a response, a column a reference.
fn frfs(plan: &Plan) -> Section {
    let ends = |end: fn(&FrfPair) -> String| {
        let mut all: Vec<String> = plan.frfs.iter().map(|gain| end(&gain.frf)).collect();
        all.extend(plan.recorded.iter().map(end));
        all.sort();
        all.dedup();
        all
    };
    let (responses, references) =
        (ends(|pair| pair.response.to_string()), ends(|pair| pair.reference.to_string()));
    let intervals = plan.names.is_empty();
    let gain = |response: &str, reference: &str| {
        let is_it =
            |gain: &&FrfGain| gain.frf.response.is_named(response) && gain.frf.reference.is_named(reference);
        plan.frfs.iter().find(is_it).map(|gain| gain.gain)
    };
    let most = plan.frfs.iter().map(|gain| gain.gain.min(BEYOND_DOUBT)).fold(f64::MIN_POSITIVE, f64::max);
    let recorded = |response: &str, reference: &str| {
        plan.recorded
            .iter()
            .any(|pair| pair.response.is_named(response) && pair.reference.is_named(reference))
    };
    let mut table = Table::of(&responses).names("Response", |response| response.to_string());
    for reference in &references {
        table = table.shaded(format!("hammer at {reference}"), |response| match gain(response, reference) {
            Some(gain) if intervals => Cell::Shaded(percent(gain, 0), 70.0 * (1.0 - gain).clamp(0.0, 1.0)),
            Some(gain) => Cell::Shaded(nats(gain), 70.0 * (gain.min(BEYOND_DOUBT) / most).clamp(0.0, 1.0)),
            None if recorded(response, reference) => "recorded".into(),
            None => "–".into(),
        });
    }
    let footnote = match intervals {
        true => "The 95 % interval that each FRF by itself would leave, as a share of the present one.",
        false => {
            "Expected ln of the odds for the true name against its nearest rival, nats, that each FRF by itself would bring."
        }
    };
    Section::new("Every FRF that could be recorded").with(table.footnote(footnote))
}
