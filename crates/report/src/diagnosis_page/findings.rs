//! What was found: parameters with intervals, probability, look-alikes.

use jointscope_diagnosis::{Estimate, Finding, Tried, Verdict};
use jointscope_wording::{effect_name, place_and_sizes, with_fitted_size};

use super::glance::{chance, scale};
use super::subject::Subject;
use crate::format::{self, NOT_DETERMINED, fixed, quantity_in, significant};
use crate::section::{Block, Section};
use crate::table::Table;

/// Look-alikes below this probability are not listed.
const LISTED: f64 = 1e-3;
/// Effects that are shown of those that were tried in vain.
const NEAREST: usize = 8;

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let section = Section::new("Findings");
    if diagnosis.findings.is_empty() {
        let section = section.paragraph(match diagnosis.verdict {
            Verdict::Consistent if diagnosis.model_error.is_some() => {
                "None of the effects tried here, at any legal place, makes the error of the model enough smaller: what the refit within the \
                 stated tolerances leaves is as large as such models are usually off by."
            }
            _ if diagnosis.is_only_departed() => {
                "None of the effects tried here, at any legal place, earns its parameters; but quantities would have to be far from what is \
                 stated, see the departures below."
            }
            Verdict::Consistent => {
                "Nothing is left out. None of the effects tried here, at any legal place, earns its parameters: what the refit within the \
                 stated tolerances leaves is noise."
            }
            _ => {
                "None of the effects tried here, at any legal place, explains the mismatch. It is real all the same: the maps below show where it \
                 sits and how it varies with frequency."
            }
        });
        return match diagnosis.tried_in_vain() {
            [] => section,
            all => section.with(tried(all)),
        };
    }
    section.with(parameters(subject)).with(names(subject)).paragraph(format!(
        "{} names were tried. A probability is of kind, place and dof together; what is missing to 100 % is something not listed.",
        diagnosis.search.candidates.len()
    ))
}

/// What was tried in vain, the nearest first.
fn tried(all: &[Tried]) -> impl Into<Block> {
    let table = Table::of(all.iter().take(NEAREST))
        .words("Tried in vain", |tried| with_fitted_size(&tried.effect))
        .numbers("Gain in ln p", "", |tried| fixed(tried.ln_gain, 1))
        .footnote(
            "Gain in ln p: how much more probable the recorded modes are with the effect than with the fixture alone, its quantities fitted and the error of the \
             model at its most probable size in both. None leaves so small an error that it could be named.",
        );
    match all.len() > NEAREST {
        true => table.footnote(format!("{} more stand in diagnosis.json.", all.len() - NEAREST)),
        false => table,
    }
}

/// One thing of each finding a row; the finding's own cells stand in its first row only.
fn by_finding<'a, T>(
    subject: &Subject<'a>,
    rows: impl Fn(&'a Finding) -> Vec<T>,
) -> Table<(Option<(usize, &'a Finding)>, T)> {
    let findings = subject.diagnosis.findings.iter().enumerate();
    let rows = findings.flat_map(|finding| {
        let rows = rows(finding.1).into_iter().enumerate();
        rows.map(move |(row, item)| ((row == 0).then_some(finding), item))
    });
    Table::of(rows).words("Finding", |(finding, _)| {
        finding.map_or(String::new(), |(index, finding)| {
            format!("{}. {}", index + 1, effect_name(&finding.effect))
        })
    })
}

fn parameters(subject: &Subject) -> impl Into<Block> {
    let by_modes = subject.diagnosis.model_error.is_some();
    // Half a gain in χ² is one in ln of the evidence.
    let (gained, share) = if by_modes { ("Evidence gained, ln", 0.5) } else { ("χ² gained", 1.0) };
    let footnote = if by_modes {
        "Intervals hold noise, the fixture's tolerances and the error of the model. Evidence gained: ln of the odds that the recorded modes lose \
         without the finding."
    } else {
        "Intervals hold noise, the fixture's tolerances and errors of the model's modes where these are larger; where the best model leaves χ² per \
         degree of freedom above 1 they are widened by its root. χ² gained: what the fit loses without the finding, priors included."
    };
    by_finding(subject, |finding| finding.estimates.iter().collect())
        .words("Parameter", |(_, estimate)| estimate.parameter.name.replace('_', " "))
        .words("Value ± standard deviation", |(_, e)| quantity_in(e.value, e.std, &scale(e)))
        .words("95 % interval", |(_, estimate)| interval(estimate))
        .numbers("Probability", "", |(finding, _)| {
            finding.map_or(String::new(), |(_, finding)| chance(finding.probability))
        })
        .numbers(gained, "", |(finding, _)| {
            finding.map_or(String::new(), |(_, finding)| significant(share * finding.evidence.gain, 4))
        })
        .footnote(footnote)
}

fn interval(estimate: &Estimate) -> String {
    if estimate.std.is_none() && estimate.value == 0.0 {
        return "not sought".to_owned();
    }
    match estimate.interval.filter(|[low, high]| low.is_finite() && high.is_finite()) {
        Some(ends) => format::ends(ends, &scale(estimate)),
        None => NOT_DETERMINED.to_owned(),
    }
}

fn names(subject: &Subject) -> impl Into<Block> {
    let others = |finding: &Finding| {
        let places = finding.evidence.elsewhere.iter();
        let places =
            places.map(|p| (format!("the same {}", place_and_sizes(p)), finding.probability * p.share));
        let names =
            finding.alternatives.iter().map(|(effect, probability)| (effect_name(effect), *probability));
        let listed = places.chain(names).filter(|(_, probability)| *probability >= LISTED);
        let listed: Vec<_> = listed.map(|(name, probability)| (name, chance(probability))).collect();
        let nothing = || vec![("nothing that was tried".to_owned(), String::new())];
        if listed.is_empty() { nothing() } else { listed }
    };
    by_finding(subject, others).words("What else it may be", |(_, (name, _))| name.clone()).numbers(
        "Probability",
        "",
        |(_, (_, probability))| probability.clone(),
    )
}
