//! What a reader wants first: what is missing and how sure that is, how much better the model is for it, what
//! to do next; and where it sits.

use jointscope_diagnosis::{Departure, Estimate, Finding, Verdict};
use jointscope_wording::{Remarks, advice, capitalised, effect_name, held_out_part};
use maud::html;

use super::fixture_view;
use super::judgement::{gain, why_nothing_held_out};
use super::subject::Subject;
use crate::format::{NOT_DETERMINED, ends, percent, significant};
use crate::section::{Card, Section};
use crate::table::with_commands;
use crate::tone::Tone;
use crate::unit::Scale;

/// Findings that are shown at the most, and names beside each.
const SHOWN: usize = 3;
/// Probability from which another name is told.
const TOLD: f64 = 0.01;

/// `notes` are remarks from reading the recordings.
pub(super) fn section(subject: &Subject, notes: &[String]) -> Section {
    let (drawing, caption) = fixture_view::drawing(subject);
    let steps = steps(subject);
    let cards = findings(&subject.diagnosis.findings).into_iter().chain([error(subject)]);
    let section = Section::new("At a glance").cards(cards);
    let section = match steps.is_empty() {
        true => section,
        false => section.with(html! { div.next { strong { "What to do next" } ul { @for step in &steps { li { (with_commands(step)) } } } } }),
    };
    section.drawing(drawing, caption).notes(subject.diagnosis.remarks().iter().chain(notes))
}

/// A probability without digits that nobody can vouch for.
pub(super) fn chance(probability: f64) -> String {
    match probability {
        p if p >= 0.9995 => "above 99.9 %".to_owned(),
        p if (0.0995..0.9895).contains(&p) => percent(p, 0),
        p => percent(p, 1),
    }
}

/// Each with its size and interval, and its probability with what else it could be: a card of its own where
/// there is one finding.
fn findings(findings: &[Finding]) -> Vec<Card> {
    let tone = |finding: &Finding| finding.is_doubtful().then_some(Tone::Problem);
    match findings {
        [one] => {
            let sure = Card::text("How probable", chance(one.probability)).note(others(one)).tone(tone(one));
            vec![size(0, one).note(known(one)), sure]
        }
        several => {
            let card = |(index, own): (usize, &Finding)| {
                let sure =
                    format!("{}; probability {}, {}", known(own), chance(own.probability), others(own));
                size(index, own).note(sure).tone(tone(own))
            };
            several.iter().take(SHOWN).enumerate().map(card).collect()
        }
    }
}

fn main_parameter(finding: &Finding) -> Option<&Estimate> {
    let spec = finding.effect.kind.spec();
    finding.estimate(spec.parameters[spec.size.parameter].name)
}

/// An end of an interval beyond so many times the value is no part of what its unit has to suit.
const FAR: f64 = 1e3;

/// The unit of a parameter and of its interval.
pub(super) fn scale(estimate: &Estimate) -> Scale {
    let known = estimate.interval.into_iter().flatten().chain(estimate.std);
    let value = estimate.value;
    let near = known.filter(|other| value == 0.0 || other.abs() < FAR * value.abs());
    Scale::for_values(near.chain([value]), estimate.unit)
}

fn size(index: usize, finding: &Finding) -> Card {
    let label = format!("{}. {}", index + 1, effect_name(&finding.effect));
    match main_parameter(finding) {
        Some(main) => Card::quantity_in(label, main.value, main.std, &scale(main)),
        None => Card::text(label, NOT_DETERMINED),
    }
}

fn known(finding: &Finding) -> String {
    let interval = main_parameter(finding).and_then(|main| Some((main, main.interval?)));
    match interval.filter(|(_, interval)| interval.iter().all(|end| end.is_finite())) {
        Some((main, interval)) => {
            format!("95 %: {}", ends(interval, &scale(main)))
        }
        None => format!("95 %: {NOT_DETERMINED}"),
    }
}

fn others(finding: &Finding) -> String {
    let told = finding.alternatives.iter().filter(|(_, p)| *p >= TOLD).take(SHOWN);
    let told: Vec<String> =
        told.map(|(effect, p)| format!("{} {}", effect_name(effect), chance(*p))).collect();
    let rest = Some(1.0 - finding.stated())
        .filter(|rest| *rest >= TOLD)
        .map(|rest| format!("something not listed {}", chance(rest)));
    match told.into_iter().chain(rest).collect::<Vec<_>>() {
        none if none.is_empty() => "nothing else above 1 %".to_owned(),
        others => format!("or {}", others.join(", ")),
    }
}

/// How much better the repaired model is, on what no fit saw where anything was held out.
fn error(subject: &Subject) -> Card {
    let diagnosis = subject.diagnosis;
    let [_, refitted, repaired] = diagnosis.nrmse();
    let held_out = diagnosis.held_out.as_ref();
    let (label, refitted, repaired) = match held_out {
        Some(own) => ("Error on lines never fitted", own.nrmse_refitted, own.nrmse_repaired),
        None => ("Error of what was fitted", refitted, repaired),
    };
    let told = |error: f64| format!("{} %", significant(100.0 * error, 2));
    let what: Vec<String> =
        held_out.iter().flat_map(|own| &own.what).map(|what| held_out_part(what)).collect();
    let what = if what.is_empty() { why_nothing_held_out(diagnosis).to_owned() } else { what.join(", ") };
    match diagnosis.findings.is_empty() {
        true => Card::text(label, told(refitted)).note(format!("of the refitted fixture; {what}")),
        false => Card::text(label, format!("{} → {}", told(refitted), told(repaired)))
            .note(format!("{}; {what}", gain(refitted, repaired))),
    }
}

/// What the answer asks for, most urgent first.
fn steps(subject: &Subject) -> Vec<String> {
    let diagnosis = subject.diagnosis;
    let mut steps = Vec::new();
    let departed = diagnosis.departures.iter().filter(|departure| departure.remains()).take(SHOWN);
    let departed: Vec<&str> = departed.map(|Departure { path, .. }| path.as_str()).collect();
    if !departed.is_empty() {
        steps.push(format!(
            "Measure again what the model would have to take far from what is stated: {}.",
            departed.join(", ")
        ));
    }
    let shown = &diagnosis.findings[..diagnosis.findings.len().min(SHOWN)];
    for alike in shown.chunk_by(|a, b| advice(&a.effect) == advice(&b.effect)) {
        let names: Vec<String> = alike.iter().map(|finding| effect_name(&finding.effect)).collect();
        steps.push(format!("{}: {}.", capitalised(&names.join(", ")), advice(&alike[0].effect)));
    }
    let elsewhere = |finding: &&Finding| finding.evidence.may_be_elsewhere();
    let several: Vec<String> = shown.iter().filter(elsewhere).map(|f| effect_name(&f.effect)).collect();
    if !several.is_empty() {
        steps.push(format!(
            "An FRF of one more point tells where it sits ({}): away from the places marked, and no mirror image of a point in use.",
            several.join(", ")
        ));
    }
    if diagnosis.findings.iter().any(Finding::is_open) {
        steps.push("`jointscope plan` with this fixture and this folder ranks the measurements that tell the names apart.".to_owned());
    }
    steps.extend(match diagnosis.verdict {
        Verdict::Consistent => Some("Nothing needs repair: refitted.json has the quantities as the recording moves them within their tolerances."),
        Verdict::Explained => Some("repaired.json is the fixture with what was found, for predictions and for `jointscope export`."),
        Verdict::PartlyExplained => Some("repaired.json has what was found; what is left over is mapped under Misfit."),
        Verdict::Unexplained if diagnosis.is_only_departed() => None,
        Verdict::Unexplained => Some("Look at the test first (`jointscope check`), then at the FRF and band where the misfit is largest."),
    }.map(str::to_owned));
    steps
}
