//! Quantities of the repaired model that are farther from what is stated than chance takes them.

use crate::format::significant;
use crate::numbers::{decimals, listed, rounded, with_unit};
use crate::unit::Scale;
use jointscope_diagnosis::{Departure, Diagnosis};
use jointscope_findings::Verdict;

/// Further quantities that are named at the most.
const NAMES: usize = 3;

/// What the repaired model still asks of the stated quantities, and what to do about it, with a space behind;
/// nothing where it asks nothing.
pub(crate) fn departed(diagnosis: &Diagnosis) -> String {
    let mut remaining = remaining(diagnosis);
    let Some(first) = remaining.next() else { return String::new() };
    let others: Vec<String> = remaining.map(|departure| departure.path.clone()).collect();
    let again = if others.is_empty() { "measure it again" } else { "measure them again" };
    let to_do = match diagnosis.verdict {
        _ if diagnosis.is_only_departed() => again.to_owned(),
        Verdict::Consistent | Verdict::Unexplained => {
            format!("{again}, or take it as a sign of what is left out")
        }
        Verdict::Explained | Verdict::PartlyExplained => {
            format!("{again}, or look for more that is left out, for what was found does not account for it")
        }
    };
    format!("{}{}: {to_do}. ", moved(diagnosis, first), also(&others))
}

/// The departures that the effects found neither take away nor name, the farthest first.
pub(crate) fn remaining(diagnosis: &Diagnosis) -> impl Iterator<Item = &Departure> {
    let named =
        |path: &str| diagnosis.findings.iter().any(|finding| finding.effect.place.to_string() == path);
    diagnosis.departures.iter().filter(move |departure| departure.remains() && !named(&departure.path))
}

/// `bodies/F1/mass would have to be 4.23 kg, 10 standard deviations from the stated 3.50 kg`.
fn moved(diagnosis: &Diagnosis, departure: &Departure) -> String {
    let tolerances = diagnosis.search.repaired.hypothesis.tolerances();
    let own = tolerances.iter().find(|tolerance| tolerance.quantity.path == departure.path);
    let unit = own.map_or("", |tolerance| tolerance.quantity.key.unit());
    let Departure { path, stated, std, repaired, deviations, .. } = departure;
    would_be(path, unit, [*stated, *std, *repaired], *deviations)
}

/// `bodies/F1/mass would have to be 4.23 kg, 10 standard deviations from the stated 3.50 kg`, of what is
/// stated, its deviation and what it would be.
pub(crate) fn would_be(path: &str, unit: &str, [stated, std, repaired]: [f64; 3], deviations: f64) -> String {
    let scale = Scale::of_stated([stated], unit);
    // One digit of the standard deviation.
    let number = |value: f64| with_unit(&rounded(scale.of(value), decimals(scale.of(std)) - 1), &scale);
    format!(
        "{path} would have to be {}, {} standard deviations from the stated {}",
        number(repaired),
        significant(deviations.abs(), 2),
        number(stated)
    )
}

/// ` (as would be too far from what is stated: joints/J/length and 2 more)`.
pub(crate) fn also(others: &[String]) -> String {
    let mut names = others[..others.len().min(NAMES)].to_vec();
    if others.len() > NAMES {
        names.push(format!("{} more", others.len() - NAMES));
    }
    if names.is_empty() {
        String::new()
    } else {
        format!(" (also too far from what is stated: {})", listed(&names))
    }
}
