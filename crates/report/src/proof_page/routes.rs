//! A route of its own: scores, sizes, every case.

use jointscope_proof::{CaseLine, RouteScore};

use super::{ProofContext, counted, scores};
use crate::{Card, Cell, Column, Section, Table, Tone};

pub(super) fn section(route: &RouteScore, context: &ProofContext) -> Section {
    let cards = route.cases.iter().filter(|(_, all, _)| *all > 0).map(|(role, all, asked)| {
        let card = Card::text(format!("cases: {role}"), all.to_string());
        if *asked > 0 { card.note(format!("{asked} asked for")) } else { card }
    });
    let section = Section::new(title(route))
        .paragraph(paragraph(route))
        .cards(cards)
        .table(scores::rates(&route.rates))
        .table(scores::figures(&route.figures));
    let section = if route.sizes.is_empty() { section } else { section.table(sizes(route)) };
    section.table(cases(&route.lines, context))
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

fn sizes(route: &RouteScore) -> Table {
    let columns = [
        Column::text("size of what was found"),
        Column::numbers("median error", "%"),
        Column::numbers("within 10 %", ""),
        Column::numbers("95 % intervals that hold", ""),
    ];
    route.sizes.iter().fold(Table::new(columns), |table, size| {
        let error = format!("{:.2}", 100.0 * size.median);
        table.row([size.what.replace('_', " "), error, counted(size.within), counted(size.held)])
    })
}

fn cases(lines: &[CaseLine], context: &ProofContext) -> Table {
    let columns = [
        Column::text("case"),
        Column::text("hidden"),
        Column::text("how it shows"),
        Column::text("verdict"),
        Column::text("found, with its probability"),
        Column::text("went wrong"),
    ];
    let table = lines.iter().fold(Table::new(columns), |table, line| {
        let number = format!("{:03}", line.index);
        let number = match context.pages && line.answered {
            true => Cell::link(number.clone(), format!("cases/{number}/report.html")),
            false => number.into(),
        };
        let cells: [Cell; 6] = [
            number,
            line.hidden.as_str().into(),
            line.size.as_str().into(),
            line.verdict.as_str().into(),
            line.found.as_str().into(),
            line.faults.join(", ").into(),
        ];
        match tone(line) {
            Some(tone) => table.marked_row(tone, cells),
            None => table.row(cells),
        }
    });
    table.footnote(
        "How it shows: Δχ² of solids, the probability by chance of levels as different in hits. Findings are marked as hidden (=) or the same by \
         mechanics (≈).",
    )
}

/// Green where all is right, red where a fault would mislead a reader, amber where it is of the second order.
fn tone(line: &CaseLine) -> Option<Tone> {
    let lesser =
        ["unseen FRFs worse", "held-out lines worse", "held-out hits worse", "a size off by more than 10 %"];
    if line.faults.is_empty() {
        return line.asked.then_some(Tone::Ok);
    }
    let grave = line.faults.iter().any(|fault| !lesser.contains(&fault.as_str()));
    Some(if grave { Tone::Problem } else { Tone::Attention })
}
