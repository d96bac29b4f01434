//! A test that drifted, in a sentence.

use crate::Says;
use crate::format::significant;
use crate::numbers::{decimals, listed, rounded};
use jointscope_diagnosis::{ReferenceChange, TestDrift};

/// Names of what may have drifted are given up to so many.
const NAMES: usize = 4;

impl Says for TestDrift {
    fn says(&self) -> String {
        let [alike, others]: [Vec<&ReferenceChange>; 2] =
            [true, false].map(|agrees| self.references.iter().filter(|own| own.agrees == agrees).collect());
        let named = |references: &[&ReferenceChange]| {
            let names: Vec<String> = references.iter().map(|own| own.reference.to_string()).collect();
            format!("reference{} {}", if names.len() == 1 { "" } else { "s" }, listed(&names))
        };
        let course: Vec<String> = match &self.what {
            Some(_) => others.iter().map(|own| stiffness(own)).collect(),
            None => others.iter().filter_map(|own| frequencies(self, own)).collect(),
        };
        let subject = self.what.as_deref().map_or_else(String::new, subject);
        let unknown = match (&self.what, self.could_be.len()) {
            (None, 0) => ". Which stiffness it was the modes do not tell".to_owned(),
            (None, 1..=NAMES) => {
                format!(". Which stiffness it was the modes cannot tell: {}", self.could_be.join(" or "))
            }
            (None, _) => ". Which stiffness it was the modes cannot tell".to_owned(),
            (Some(_), _) => String::new(),
        };
        let (alike, were) = (named(&alike), if alike.len() == 1 { "was" } else { "were" });
        let drifted = format!(
            "The test drifted: {subject}{} than while {alike} {were} struck (poles differ as much by chance with a probability {}){unknown}. ",
            listed(&course),
            by_chance(self.p_value),
        );
        match self.taken_out {
            true => {
                drifted
                    + "That is as little as some kelvins make; what follows is of FRFs with the difference taken out."
            }
            false => format!(
                "{drifted}Measure again, or give each reference's FRFs alone; a joint that depends on amplitude and was struck with other strength would \
                 look the same. What follows is of the FRFs of {alike} alone."
            ),
        }
    }
}

/// `the natural frequencies were 0.8 % lower (51.2 Hz) to 0.1 % higher (80.1 Hz) while reference 2 was struck`.
fn frequencies(drift: &TestDrift, own: &ReferenceChange) -> Option<String> {
    let at = drift.references.iter().position(|other| other == own)?;
    let changes = drift.modes.iter().filter_map(|mode| Some((mode.frequency, mode.changes[at]?)));
    let mut changes: Vec<(f64, f64)> = changes.collect();
    changes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let of = |(hz, change): &(f64, f64)| {
        let direction = if *change < 0.0 { "lower" } else { "higher" };
        format!("{} % {direction} ({} Hz)", significant(100.0 * change.abs(), 2), significant(*hz, 4))
    };
    let range = match &changes[..] {
        [] => return None,
        [only] => format!("a natural frequency was {}", of(only)),
        [lowest, .., highest] => format!("natural frequencies were {} to {}", of(lowest), of(highest)),
    };
    Some(format!("{range} while reference {} was struck", own.reference))
}

/// `of 0.0003`, or `below 10⁻⁹`.
fn by_chance(p_value: f64) -> String {
    match p_value < 1e-9 {
        true => "below 10⁻⁹".to_owned(),
        false => format!("of {}", significant(p_value, 2)),
    }
}

/// `joint J was `.
fn subject(what: &str) -> String {
    match what.split_once('/') {
        Some(("joints", name)) => format!("joint {name} was "),
        Some(("bodies", name)) => format!("beam {name} was "),
        _ => format!("{what} were "),
    }
}

/// `1.2 % (1.1 to 1.3 %) softer while reference 2 was struck`.
fn stiffness(own: &ReferenceChange) -> String {
    let direction = if own.change < 0.0 { "softer" } else { "stiffer" };
    let sign = own.change.signum();
    let mut ends = own.ci95.map(|end| 100.0 * sign * end);
    ends.sort_by(f64::total_cmp);
    let digits = decimals(0.5 * (ends[1] - ends[0]));
    format!(
        "{} % ({} to {} %) {direction} while reference {} was struck",
        rounded(100.0 * own.change.abs(), digits),
        rounded(ends[0], digits),
        rounded(ends[1], digits),
        own.reference
    )
}
