//! Every case: what was hidden, what was found, and its own page.

use jointscope_proof::{Judged, Role};

use super::cells::{case_number, tone};
use super::context::ProofContext;
use crate::section::Section;
use crate::table::Table;

/// Faults of the second order.
const LESSER: [&str; 3] = ["false minimum", "unseen FRFs worse", "held-out lines worse"];

pub(super) fn section(judged: &[Judged], context: &ProofContext) -> Section {
    let table = Table::of(judged)
        .words("case", |j| case_number(j.truth.index, context.pages && j.answer.is_ok()))
        .words("hidden", |j| j.truth.hidden())
        .numbers("Δχ²", "", |j| match j.truth.role {
            Role::Null => "–".to_owned(),
            _ => format!("{:.0}", j.size()),
        })
        .words("verdict", |j| match &j.answer {
            Ok(answer) => answer.verdict.name().replace('_', " "),
            Err(_) => "no answer".to_owned(),
        })
        .words("found, with its probability", |j| match &j.answer {
            Ok(_) => found(j),
            Err(why) => why.to_string(),
        })
        .words("went wrong", |j| j.faults().join(", "))
        .marked(|j| {
            // What does not show and was not found was not asked for.
            let asked = j.truth.role == Role::Null || j.is_visible() || !j.found().is_empty();
            tone(&j.faults(), asked, &LESSER)
        });
    let section = Section::new("Every case");
    let section = if context.pages {
        section.paragraph(
            "A case's number leads to its page; beside that page lie fixture.json and hammer-test.uff, all that the diagnosis was given, \
             to be diagnosed again by anyone:",
        )
        .command("cd cases/000 && jointscope diagnose fixture.json hammer-test.uff -o again")
    } else {
        section
    };
    section.with(table.footnote(
        "Δχ²: what the hidden physics costs a fit that does without it; below 50 it is not asked for. Every finding is marked as right if it was hidden (=) \
         or fits as well (≈).",
    ))
}

fn found(judged: &Judged) -> String {
    let hidden = judged.hidden();
    let findings = judged.answer.iter().flat_map(|answer| &answer.findings);
    let listed = findings.map(|finding| {
        let name = jointscope_proof::Name::of(&finding.effect);
        let mark = match (hidden.contains(&name), judged.accepts(&name)) {
            (true, _) => "= ",
            (false, true) => "≈ ",
            (false, false) => "",
        };
        format!("{mark}{name} ({:.2})", finding.probability)
    });
    let listed: Vec<String> = listed.collect();
    if listed.is_empty() { "nothing".to_owned() } else { listed.join(", ") }
}
