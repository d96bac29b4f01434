//! A route of its own: scores, sizes, every case.

use jointscope_proof::{CaseLine, RouteScore};
use maud::Render;

use super::{ProofContext, case_number, counted, scores, tone};
use crate::section::{Card, Section};
use crate::table::Table;

/// Faults of the second order.
const LESSER: [&str; 4] =
    ["unseen FRFs worse", "held-out lines worse", "held-out hits worse", "a size off by more than 10 %"];

pub(super) fn section(route: &RouteScore, context: &ProofContext) -> Section {
    let cards = route.roles.iter().filter(|count| count.cases > 0).map(|count| {
        let card = Card::text(format!("cases: {}", count.role), count.cases.to_string());
        match count.asked {
            Some(asked) if asked > 0 => card.note(format!("{asked} asked for")),
            _ => card,
        }
    });
    let section = Section::new(title(route))
        .paragraph(paragraph(route))
        .cards(cards)
        .with(scores::rates(&route.rates))
        .with(scores::figures(&route.figures));
    let section = if route.sizes.is_empty() { section } else { section.with(sizes(route)) };
    section.with(cases(&route.lines, context))
}

fn title(route: &RouteScore) -> &'static str {
    match route.key {
        "solid" => "Recordings of solids",
        _ => "Hits over time",
    }
}

fn paragraph(route: &RouteScore) -> &'static str {
    match route.key {
        "solid" => {
            "The recording comes from a finite-element model of two solid blocks on a strip; the diagnosis believes in rigid blocks on a \
             massless beam. Of what the solid has beyond that only what is hidden is left on; its size follows in closed form from dimensions \
             and materials. A name is right if it is the hidden one, or the same by mechanics: shear of the strip and a layer that slides at either \
             end. Hidden things are asked for if the refitted fixture is worse than the solid's own FRFs by 50 in χ²."
        }
        _ => {
            "Structures of which a joint may have a cubic spring, friction or a gap are struck at three strengths, and their motion is integrated \
             step by step. The diagnosis has the fixture and the hits. A law is right if kind, joint and degree of freedom are. Idle laws are those \
             that the hits do not reach; nobody can name them. Where nothing depends on amplitude the FRFs of the hits are diagnosed."
        }
    }
}

/// A route in a sentence.
pub(super) fn sentence(route: &RouteScore) -> String {
    let share = |key: &str| counted(route.rate(key).map(|rate| rate.share).unwrap_or_default());
    match route.key {
        "solid" => format!(
            "In recordings of solids what was hidden got its right name in {}; of those that hide nothing something was found in {}.",
            share("single_place"),
            share("null_finding")
        ),
        _ => format!(
            "In hits over time laws got their right names in {}; linear structures were called non-linear in {}.",
            share("law_named"),
            share("linear_alarm")
        ),
    }
}

fn sizes(route: &RouteScore) -> impl Render {
    Table::of(&route.sizes)
        .words("size of what was found", |size| size.what.replace('_', " "))
        .numbers("median error", "%", |size| format!("{:.2}", 100.0 * size.median))
        .numbers("within 10 %", "", |size| counted(size.within))
        .numbers("95 % intervals that hold", "", |size| counted(size.held))
}

fn cases(lines: &[CaseLine], context: &ProofContext) -> impl Render {
    Table::of(lines)
        .words("case", |line| case_number(line.index, context.pages && line.answered))
        .words("hidden", |line| line.hidden.clone())
        .words("how it shows", |line| line.size.clone())
        .words("verdict", |line| line.verdict.clone())
        .words("found, with its probability", |line| line.found.clone())
        .words("went wrong", |line| line.faults.join(", "))
        .marked(|line| tone(&line.faults, line.asked, &LESSER))
        .footnote(
            "How it shows: Δχ² of solids, the probability by chance of levels as different in hits. Findings are marked as hidden (=) or the same by \
             mechanics (≈).",
        )
}
