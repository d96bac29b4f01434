//! What was found: parameters with intervals, probability, look-alikes.

use jointscope_diagnosis::{Estimate, Verdict};

use super::Subject;
use crate::format::{NOT_DETERMINED, percent, quantity, significant};
use crate::{Column, Scale, Section, Table};

/// Look-alikes below this probability are not listed.
const LISTED: f64 = 1e-3;

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let section = Section::new("Findings");
    if diagnosis.findings.is_empty() {
        return section.paragraph(match diagnosis.verdict {
            Verdict::Consistent => {
                "Nothing is left out. None of the effects tried here, at any legal place, earns its parameters: what the refit within the \
                 stated tolerances leaves is noise."
            }
            _ => {
                "None of the effects tried here, at any legal place, explains the mismatch. It is real all the same: the maps below show where it \
                 sits and how it varies with frequency."
            }
        });
    }
    let section = section.table(parameters(subject));
    let names = section.table(names(subject));
    names.paragraph(format!(
        "{} names were tried. A probability is of kind, place and dof together; what is missing to 100 % is something not listed.",
        diagnosis.search.candidates.len()
    ))
}

fn parameters(subject: &Subject) -> Table {
    let columns = [
        Column::text("Finding"),
        Column::text("Parameter"),
        Column::text("Value ± standard deviation"),
        Column::text("95 % interval"),
        Column::numbers("Probability", ""),
        Column::numbers("χ² gained", ""),
    ];
    let mut table = Table::new(columns);
    for (index, finding) in subject.diagnosis.findings.iter().enumerate() {
        for (row, estimate) in finding.estimates.iter().enumerate() {
            let first = row == 0;
            let only_first = |text: String| if first { text } else { String::new() };
            table = table.row([
                only_first(format!("{}. {}", index + 1, finding.name())),
                estimate.parameter.name.replace('_', " "),
                quantity(estimate.value, estimate.std, estimate.unit),
                interval(estimate),
                only_first(percent(finding.probability, 1)),
                only_first(significant(finding.gain, 4)),
            ]);
        }
    }
    table.footnote(
        "Intervals hold noise and the fixture's tolerances; where the best model leaves χ² per degree of freedom above 1 they are widened by its \
         root. χ² gained: what the fit loses without the finding, priors included.",
    )
}

fn interval(estimate: &Estimate) -> String {
    if estimate.std.is_none() && estimate.value == 0.0 {
        return "not sought".to_owned();
    }
    let Some([low, high]) = estimate.interval.filter(|[low, high]| low.is_finite() && high.is_finite())
    else {
        return NOT_DETERMINED.to_owned();
    };
    let scale = Scale::for_values([low, high, estimate.value], estimate.unit);
    let digits = |value: f64| significant(scale.of(value), 4);
    let unit = if scale.unit().is_empty() { String::new() } else { format!(" {}", scale.unit()) };
    format!("{} to {}{unit}", digits(low), digits(high))
}

fn names(subject: &Subject) -> Table {
    let columns =
        [Column::text("Finding"), Column::text("What else it may be"), Column::numbers("Probability", "")];
    let mut table = Table::new(columns);
    for (index, finding) in subject.diagnosis.findings.iter().enumerate() {
        let others: Vec<(String, f64)> =
            finding.other_names().into_iter().filter(|(_, probability)| *probability >= LISTED).collect();
        let of = format!("{}. {}", index + 1, finding.name());
        if others.is_empty() {
            table = table.row([of.clone(), "nothing that was tried".to_owned(), String::new()]);
        }
        for (row, (name, probability)) in others.into_iter().enumerate() {
            let of = if row == 0 { of.clone() } else { String::new() };
            table = table.row([of, name, percent(probability, 1)]);
        }
    }
    table
}
