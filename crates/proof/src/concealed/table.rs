//! A reckoning as text and as JSON.

use super::{ConcealmentKind, ConcealmentPlan, Reckoned, Reckoning, Size};
use crate::case::describe;
use crate::{Name, Sealable, Share};
use serde_json::{Value, json};
use std::fmt::{self, Display, Formatter};

/// Shares by key, as a reader would put them.
const SHARES: [(&str, &str); 7] = [
    ("quiet", "further controls without a finding of their own"),
    ("found", "concealed and showing: kind and place found"),
    ("kind", "concealed and showing: kind found"),
    ("extra", "concealed and showing: something else found besides"),
    ("noticed", "what no effect describes: noticed, no effect named with certainty"),
    ("intervals", "95 % intervals that hold a planted size"),
    ("agreements", "95 % intervals that hold what a deleted entry said"),
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

impl Display for Reckoning {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let own = if self.own.is_empty() { "nothing".to_owned() } else { listed(&self.own) };
        writeln!(f, "found in the recording with nothing concealed, hence its own: {own}")?;
        for case in &self.cases {
            write!(f, "\n{case}")?;
        }
        writeln!(f, "\nshares (95 % binomial interval):")?;
        for (key, what) in SHARES {
            writeln!(f, "  {what:<66} {}", counted(self.share(key)))?;
        }
        Ok(())
    }
}

impl Display for Reckoned {
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
            writeln!(f, "  {size}")?;
        }
        match (self.shows, self.left) {
            (Some(shows), Some(left)) => {
                writeln!(f, "  objective over the control's: refitted {shows:.1}, repaired {left:.1}")
            }
            _ => Ok(()),
        }
    }
}

impl Display for Size {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: true {:.5e}, found {:.5e}", self.parameter, self.truth, self.found)?;
        match self.interval {
            Some([low, high]) => {
                let holds = if self.holds() { "holds it" } else { "misses it" };
                write!(f, " ({low:.5e} to {high:.5e} {holds})")
            }
            None => write!(f, " (no interval)"),
        }
    }
}

impl Reckoning {
    /// The reckoning as JSON.
    pub fn to_value(&self) -> Value {
        let share = |(key, what): (&str, &str)| {
            let share = self.share(key);
            let value = json!({
                "what": what, "count": share.of, "of": share.all, "share": share.value(), "ci95": share.interval(),
            });
            (key.to_owned(), value)
        };
        json!({
            "own": self.own.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "shares": Value::Object(SHARES.into_iter().map(share).collect()),
            "cases": self.cases.iter().map(Reckoned::to_value).collect::<Vec<_>>(),
        })
    }
}

impl Reckoned {
    /// The case as JSON.
    pub fn to_value(&self) -> Value {
        let names = |names: &[Name]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
        json!({
            "truth": self.truth.to_value(),
            "outcome": self.outcome.name(),
            "verdict": self.answer.as_ref().ok().map(|answer| answer.verdict.name()),
            "found": self.answer.as_ref().map_or_else(|_| Vec::new(), |answer| {
                answer.findings.iter()
                    .map(|found| json!({ "effect": describe(&found.effect), "probability": found.probability }))
                    .collect::<Vec<_>>()
            }),
            "sizes": self.sizes.iter().map(Size::to_value).collect::<Vec<_>>(),
            "extra": names(&self.extra),
            "own": names(&self.own),
            "objective_over_control": { "refitted": self.shows, "repaired": self.left },
        })
    }
}

fn listed(names: &[Name]) -> String {
    names.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

fn counted(share: Share) -> String {
    let Some(value) = share.value() else { return "no case".to_owned() };
    let [low, high] = share.interval();
    format!("{} of {}, {value:.3} ({low:.3} to {high:.3})", share.of, share.all)
}
