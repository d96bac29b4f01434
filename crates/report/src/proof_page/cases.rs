//! Every case: what was hidden, what was found, and its own page.

use jointscope_proof::{Judged, Role};

use crate::{Cell, Column, Section, Table, Tone};

use super::ProofContext;

pub(super) fn section(judged: &[Judged], context: &ProofContext) -> Section {
    let columns = [
        Column::text("case"),
        Column::text("hidden"),
        Column::numbers("Δχ²", ""),
        Column::text("verdict"),
        Column::text("found, with its probability"),
        Column::text("went wrong"),
    ];
    let table = judged.iter().fold(Table::new(columns), |table, judged| {
        let cells = cells(judged, context);
        match tone(judged) {
            Some(tone) => table.marked_row(tone, cells),
            None => table.row(cells),
        }
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
    section.table(table.footnote(
        "Δχ²: what the hidden physics costs a fit that does without it; below 50 it is not asked for. Every finding is marked as right if it was hidden (=) \
         or fits as well (≈).",
    ))
}

fn cells(judged: &Judged, context: &ProofContext) -> Vec<Cell> {
    let number = judged.truth.index;
    let case = match context.pages && judged.answer.is_ok() {
        true => Cell::link(format!("{number:03}"), format!("cases/{number:03}/report.html")),
        false => format!("{number:03}").into(),
    };
    let (verdict, found) = match &judged.answer {
        Ok(answer) => (answer.verdict.name().replace('_', " "), found(judged)),
        Err(why) => ("no answer".to_owned(), why.to_string()),
    };
    let size = match judged.truth.role {
        Role::Null => "–".to_owned(),
        _ => format!("{:.0}", judged.size()),
    };
    let faults = judged.faults().join(", ");
    vec![case, judged.truth.hidden().into(), size.into(), verdict.into(), found.into(), faults.into()]
}

fn found(judged: &Judged) -> String {
    let hidden = judged.hidden();
    let findings = judged.answer.iter().flat_map(|answer| &answer.findings);
    let told = findings.map(|finding| {
        let name = jointscope_proof::Name::of(&finding.effect);
        let mark = match (hidden.contains(&name), judged.accepts(&name)) {
            (true, _) => "= ",
            (false, true) => "≈ ",
            (false, false) => "",
        };
        format!("{mark}{name} ({:.2})", finding.probability)
    });
    let told: Vec<String> = told.collect();
    if told.is_empty() { "nothing".to_owned() } else { told.join(", ") }
}

/// Green where all is right, red where a fault would mislead a reader, amber where it is of the second order.
fn tone(judged: &Judged) -> Option<Tone> {
    let faults = judged.faults();
    let lesser = ["false minimum", "unseen FRFs worse", "held-out lines worse"];
    if faults.is_empty() {
        // What does not show and was not found was not asked for.
        let asked = judged.truth.role == Role::Null || judged.is_visible() || !judged.found().is_empty();
        return asked.then_some(Tone::Ok);
    }
    let grave = faults.iter().any(|fault| !lesser.contains(&fault.as_str()));
    Some(if grave { Tone::Problem } else { Tone::Attention })
}
