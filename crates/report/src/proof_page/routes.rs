//! A route of its own: scores, sizes, every case.

use jointscope_proof::{CaseLine, RouteScore};

use super::cells::{case_number, counted, tone};
use super::context::ProofContext;
use super::scores;
use crate::section::{Block, Card, Section};
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
        "solid_as_is" => "Recordings of solids as they are",
        "modal_errors" => "Recordings of structures with an error in every mode",
        "channel_flaws" => "Flaws of the measuring chain",
        "load_paths" => "Load paths and footings",
        "unknown_physics" => "Physics without a name, small and large",
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
        "solid_as_is" => {
            "The recording comes from a finite-element model of two solid blocks on a strip, of which nothing is idealised: blocks yield under the \
             strip, which weighs, shears and bends as a plate. The fixture states mass, shear and footings of the strip with their standard deviations (gaps: \
             not all of them). No such model is right to the noise. Right is the hidden name first with nothing untrue beside it; true are also shear, springs across \
             the strip's ends, a block's bending near its own first mode, and what a gap leaves out."
        }
        "modal_errors" => {
            "Lumped structures of which every natural frequency, damping ratio and shape has an error of its own: frequencies of 0.05 to 0.5 %, damping \
             of 1 to 10 %, shapes of 0.1 to 1 %. Right is the hidden name first, with nothing untrue beside it; a name that fits as well as the true one \
             counts as right. Hidden things are asked for if without them χ² is ten times as large."
        }
        "channel_flaws" => {
            "Lumped structures, three of four read through one flaw: a gain, a delay, a high-pass or a resonance of a response, a reference or the force, a \
             roving sensor's mass, a response window, a point that is elsewhere. Two of five tests strike one point only, or read one only, where an equal flaw \
             elsewhere is exactly the same thing. Right is the hidden name, one that is the same thing or one that fits as well, first and alone."
        }
        "load_paths" => {
            "Lumped structures, three of four with one thing about a joint that the fixture leaves out: a spring or a springpot beside it, a spring past it from body \
             to body, footings that turn alike, a rotational spring to ground. Right is the hidden name, or one that fits as well, first and alone."
        }
        "unknown_physics" => {
            "Lumped structures with physics that no effect of a fixture file is, in turn: a sensor that reads across its axis, an inerter, a sample clock of its own, a second \
             bending mode of a block, a cable that resonates, a joint that changed between references, supports on a table, a rotor. The FRFs change by 0.01 to 80 %. A name \
             is untrue where the repaired fixture fits worse than the structure itself by more than 9 in χ²."
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
        "solid_as_is" | "modal_errors" => format!(
            "In {} what was hidden was named first, with nothing untrue beside it, in {}; an untrue name got 0.9 or more in {}.",
            if route.key == "solid_as_is" {
                "solids as they are"
            } else {
                "structures with an error in every mode"
            },
            share("single_right"),
            share("untrue_claimed")
        ),
        "channel_flaws" | "load_paths" => format!(
            "{} were named first and alone in {}; of the cases that hide nothing something was found in {}.",
            if route.key == "channel_flaws" {
                "Flaws of the measuring chain"
            } else {
                "Load paths and footings"
            },
            share("single_alone"),
            share("null_named")
        ),
        "unknown_physics" => format!(
            "Physics without a name, small and large, got an untrue name with 0.9 or more in {}.",
            share("untrue_claimed")
        ),
        _ => format!(
            "In hits over time laws got their right names in {}; linear structures were called non-linear in {}.",
            share("law_named"),
            share("linear_alarm")
        ),
    }
}

fn sizes(route: &RouteScore) -> impl Into<Block> {
    Table::of(&route.sizes)
        .words("size of what was found", |size| size.what.replace('_', " "))
        .numbers("median error", "%", |size| format!("{:.2}", 100.0 * size.median))
        .numbers("within 10 %", "", |size| counted(size.within))
        .numbers("95 % intervals that hold", "", |size| counted(size.held))
}

fn cases(lines: &[CaseLine], context: &ProofContext) -> impl Into<Block> {
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
