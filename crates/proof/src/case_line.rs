//! A case in a line, and what else an account of it tells.

use crate::name::describe;
use crate::{Found, Name};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::fmt::{self, Display, Formatter};

/// A case in a line.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseLine {
    /// Its number.
    pub index: usize,
    /// How much was hidden, where a route tells it apart from what was hidden; else empty.
    pub role: String,
    /// What was hidden.
    pub hidden: String,
    /// How strongly it shows, in words; empty of nulls.
    pub size: String,
    /// The verdict.
    pub verdict: String,
    /// What was found, with its probability.
    pub found: String,
    /// What went wrong.
    pub faults: Vec<String>,
    /// Whether there is an answer, and with it a page.
    pub answered: bool,
    /// Whether something was to be found, or nothing, and not neither.
    pub asked: bool,
    /// What else an account of it tells, a line each.
    pub details: Vec<String>,
    /// The case as JSON.
    pub value: Value,
}

/// The case in a few lines: what was hidden, what was found.
impl Display for CaseLine {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let what = if self.faults.is_empty() { "right".to_owned() } else { self.faults.join(", ") };
        let role = if self.role.is_empty() { String::new() } else { format!(" ({})", self.role) };
        writeln!(f, "case {}{role}: {what}", self.index)?;
        let separator = if self.size.is_empty() { "" } else { "; " };
        writeln!(f, "  hidden: {}{separator}{}", self.hidden, self.size)?;
        writeln!(f, "  answer: {}", self.verdict)?;
        self.details.iter().try_for_each(|line| writeln!(f, "  {line}"))
    }
}

impl Serialize for CaseLine {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.value.serialize(serializer)
    }
}

/// Findings with their probabilities, each with a mark before its name.
pub(crate) fn marked(findings: &[Found], mark: impl Fn(&Found) -> &'static str) -> String {
    let listed = findings
        .iter()
        .map(|found| format!("{}{} ({:.2})", mark(found), Name::of(&found.effect), found.probability));
    let listed: Vec<String> = listed.collect();
    if listed.is_empty() { "nothing".to_owned() } else { listed.join(", ") }
}

/// Findings with their parameters and alternatives, a line each.
pub(crate) fn in_full(findings: &[Found]) -> Vec<String> {
    let mut lines = Vec::new();
    for found in findings {
        lines.push(format!("  p={:.3} {}", found.probability, describe(&found.effect)));
        let others = found.alternatives.iter();
        lines.extend(others.map(|(effect, p)| format!("    or p={p:.3} {}", describe(effect))));
    }
    lines
}

/// Findings by name as JSON, and whether they count as right.
pub(crate) fn named(findings: &[Found], is_right: impl Fn(&Found) -> bool) -> Value {
    let name = |found: &Found| {
        let name = Name::of(&found.effect);
        json!({ "name": name, "probability": found.probability, "true": is_right(found) })
    };
    findings.iter().map(name).collect()
}

/// "error of what is seen: 1e-1 refitted, 1e-2 repaired", where it was measured.
pub(crate) fn errors(what: &str, errors: Option<[f64; 2]>) -> Option<String> {
    errors
        .map(|[refitted, repaired]| format!("{what}: error {refitted:.2e} refitted, {repaired:.2e} repaired"))
}

/// Whether the repaired fixture's error is larger than the refitted one's.
pub(crate) fn is_worse([refitted, repaired]: [f64; 2]) -> bool {
    repaired > refitted
}
