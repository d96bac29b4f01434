//! Before and after: errors of the three models, on what was fitted and on what was not.

use super::subject::Subject;
use crate::format::{percent, significant};
use crate::section::{Card, Section};
use crate::table::Table;
use jointscope_diagnosis::{Diagnosis, HeldOut};
use jointscope_wording::{capitalised, held_out_part};

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let (errors, chi2) = (diagnosis.nrmse(), diagnosis.chi2_per_dof());
    let what = [
        "nominal: the fixture as stated",
        "refitted: within its tolerances, no effects",
        "repaired: tolerances and findings",
    ];
    let models = what.into_iter().zip(errors).zip(chi2).take(subject.models().len());
    let table = Table::of(models)
        .words("Model", |((what, _), _)| *what)
        .numbers("Relative error of the FRFs", "%", |((_, error), _)| significant(100.0 * error, 3))
        .numbers("χ² per degree of freedom", "", |(_, chi2)| significant(*chi2, 4))
        .footnote(format!(
            "Relative error: √(Σ|H model − H measured|²/Σ|H measured|²) over all FRFs and lines in use, as accelerance. χ² counts {} real values.",
            diagnosis.observation.degrees()
        ));
    let table = if diagnosis.model_error.is_some() {
        table.footnote(
            "The error of the model by modes decides, not these two: next to a resonance a small error of its frequency is a large one of the FRFs.",
        )
    } else {
        table
    };
    let section = Section::new("Before and after").with(table);
    match &diagnosis.held_out {
        None => section.paragraph(format!(
            "{}: the errors above are of what was fitted.",
            capitalised(why_nothing_held_out(diagnosis))
        )),
        Some(held_out) => with_held_out(section, diagnosis, held_out),
    }
}

/// Why the models were judged by nothing that no fit saw.
pub(super) fn why_nothing_held_out(diagnosis: &Diagnosis) -> &'static str {
    match diagnosis.ended_before_judgement() {
        true => "the search ended before it came to what is held out of the fit",
        false => "there were too few lines to hold any out of the fit",
    }
}

/// What was held out of the fit, how the models predicted it, and whether the search finds the same without
/// it.
fn with_held_out(section: Section, diagnosis: &Diagnosis, held_out: &HeldOut) -> Section {
    let same = match (held_out.same_findings, diagnosis.findings.is_empty()) {
        (None, _) => "",
        (Some(true), true) => "Without them the search finds nothing either.",
        (Some(true), false) => "Without them the search finds the same names.",
        (Some(false), _) => {
            "Without them the search finds other names: the findings hang on what was held out."
        }
    };
    let what: Vec<String> = held_out.what.iter().map(|what| held_out_part(what)).collect();
    let mut cards = vec![Card::text("Held out, refitted", percent(held_out.nrmse_refitted, 2))];
    if !diagnosis.findings.is_empty() {
        cards.push(
            Card::text("Held out, repaired", percent(held_out.nrmse_repaired, 2))
                .note(gain(held_out.nrmse_refitted, held_out.nrmse_repaired)),
        );
    }
    let searched = match diagnosis.model_error {
        Some(_) => "the search was done again without them, among the effects that came nearest with them",
        None => "the whole search was done again without them",
    };
    section
        .paragraph(format!(
            "Held out were {}: {searched}, and its models then predicted them. {same}",
            what.join(", ")
        ))
        .cards(cards)
}

pub(super) fn gain(refitted: f64, repaired: f64) -> String {
    match refitted / repaired {
        ratio if ratio > 1.05 => format!("{} times smaller than refitted", significant(ratio, 2)),
        ratio if ratio.is_finite() => "no smaller than refitted".to_owned(),
        _ => String::new(),
    }
}
