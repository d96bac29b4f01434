//! The scores as text and as JSON.

use super::{ConcealmentKind, ConcealmentPlan, ConcealmentScores, ScoredConcealment};
use crate::name::describe;
use crate::sheet::Line;
use crate::{Found, Name, Rate, Sealable, Size};
use serde_json::{Map, Value, json};
use std::fmt::{self, Display, Formatter};

/// Shares by key, as a reader would put them.
const SHARES: [Line; 7] = [
    ("quiet", "further controls without a finding of their own", None),
    ("found", "concealed and showing: kind and place found", None),
    ("kind", "concealed and showing: kind found", None),
    ("extra", "concealed and showing: something else found besides", None),
    ("noticed", "what no effect describes: noticed, no effect named with certainty", None),
    ("intervals", "95 % intervals that hold a planted size", None),
    ("agreements", "95 % intervals that hold what a deleted entry said", None),
];

impl Display for ConcealmentPlan {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.only {
            Some(only) => write!(f, "case {only} of {}, and the control, seed {}", self.cases, self.seed)?,
            None => write!(f, "{} cases, seed {}", self.cases, self.seed)?,
        }
        match self.kinds == ConcealmentKind::ALL {
            true => Ok(()),
            false => write!(f, ", {}", self.kind_names().join(", ")),
        }
    }
}

impl ConcealmentPlan {
    fn kind_names(&self) -> Vec<&'static str> {
        self.kinds.iter().map(|kind| kind.name()).collect()
    }

    /// The plan as JSON.
    pub fn to_value(&self) -> Value {
        json!({ "cases": self.cases, "seed": self.seed, "only": self.only, "kinds": self.kind_names() })
    }
}

impl Display for ConcealmentScores {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let own = if self.own.is_empty() { "nothing".to_owned() } else { listed(&self.own) };
        writeln!(f, "found in the recording with nothing concealed, hence its own: {own}")?;
        for case in &self.cases {
            write!(f, "\n{case}")?;
        }
        writeln!(f, "\nshares (95 % binomial interval):")?;
        for Rate { what, share, .. } in self.rates() {
            let Some(value) = share.value() else {
                writeln!(f, "  {what:<66} no case")?;
                continue;
            };
            let ([low, high], of, all) = (share.interval(), share.of, share.all);
            writeln!(f, "  {what:<66} {of} of {all}, {value:.3} ({low:.3} to {high:.3})")?;
        }
        Ok(())
    }
}

impl Display for ScoredConcealment {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let kind = self.truth.kind.map_or("control", ConcealmentKind::name);
        writeln!(f, "case {}, {kind}: {}", self.truth.index, self.outcome.name())?;
        writeln!(f, "  concealed: {}", self.truth.what)?;
        for expected in &self.truth.expected {
            write!(f, "  to be found: {}", describe(&expected.effect))?;
            let same: Vec<String> = expected.same.iter().map(|effect| Name::of(effect).to_string()).collect();
            if same.is_empty() { writeln!(f) } else { writeln!(f, ", or {}", same.join(", or ")) }?;
        }
        if self.truth.expected.is_empty() && !self.truth.is_control() {
            writeln!(f, "  to be found: something is wrong; no effect describes it")?;
        }
        let answer = match &self.answer {
            Ok(answer) => answer,
            Err(why) => return writeln!(f, "  no answer: {why}"),
        };
        let verdict = answer.verdict.name().replace('_', " ");
        if answer.findings.is_empty() {
            writeln!(f, "  answer: {verdict}")?;
        }
        for (index, found) in answer.findings.iter().enumerate() {
            let before =
                if index == 0 { format!("  answer: {verdict}; ") } else { "          and ".to_owned() };
            let own = if self.own.contains(&Name::of(&found.effect)) { ", the recording's own" } else { "" };
            writeln!(f, "{before}{}, probability {:.2}{own}", describe(&found.effect), found.probability)?;
        }
        for size in &self.sizes {
            writeln!(f, "  {}", size_line(size))?;
        }
        match (self.shows, self.left) {
            (Some(shows), Some(left)) => {
                writeln!(f, "  objective over the control's: refitted {shows:.1}, repaired {left:.1}")
            }
            _ => Ok(()),
        }
    }
}

/// A size true and found, with what its interval says.
fn size_line(size: &Size) -> String {
    let interval = match size.interval {
        Some([low, high]) => {
            let holds = if size.is_held() { "holds it" } else { "misses it" };
            format!("{low:.5e} to {high:.5e} {holds}")
        }
        None => "no interval".to_owned(),
    };
    format!("{}: true {:.5e}, found {:.5e} ({interval})", size.what, size.truth, size.found)
}

impl ConcealmentScores {
    /// The shares of all keys.
    fn rates(&self) -> Vec<Rate> {
        Rate::all(&SHARES, |key| self.share(key))
    }

    /// The scores as JSON.
    pub fn to_value(&self) -> Value {
        let shares: Map<String, Value> =
            self.rates().iter().map(|rate| (rate.key.to_owned(), json!(rate))).collect();
        let cases: Value = self.cases.iter().map(ScoredConcealment::to_value).collect();
        json!({ "own": self.own, "shares": shares, "cases": cases })
    }
}

impl ScoredConcealment {
    /// The case as JSON.
    pub(crate) fn to_value(&self) -> Value {
        let answer = self.answer.as_ref().ok();
        let findings = answer.map_or(&[][..], |answer| &answer.findings);
        let found =
            |found: &Found| json!({ "effect": describe(&found.effect), "probability": found.probability });
        let size = |size: &Size| {
            json!({
                "parameter": size.what, "true": size.truth, "found": size.found, "ci95": size.interval,
                "holds": size.is_held(),
            })
        };
        json!({
            "truth": self.truth.to_value(),
            "outcome": self.outcome.name(),
            "verdict": answer.map(|answer| answer.verdict.name()),
            "found": findings.iter().map(found).collect::<Vec<_>>(),
            "sizes": self.sizes.iter().map(size).collect::<Vec<_>>(),
            "extra": self.extra,
            "own": self.own,
            "objective_over_control": { "refitted": self.shows, "repaired": self.left },
        })
    }
}

fn listed(names: &[Name]) -> String {
    names.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
