//! The cases that went wrong, told so that they can be worked on.

use crate::case::describe;
use crate::{Evidence, Judged, Role};
use jointscope_diagnosis::Verdict;
use std::fmt::Write;

/// Objective above that of the fit about the truth at which a fit of the same names has not found its minimum.
const SHORT: f64 = 2.0;

impl Judged {
    /// What went wrong, in a phrase each; empty where nothing did. Hidden effects that do not show are not asked for.
    pub fn faults(&self) -> Vec<String> {
        let Ok(answer) = &self.answer else { return vec!["no answer".to_owned()] };
        let mut faults = Vec::new();
        let found = self.found();
        match self.truth.role {
            Role::Null => {
                if answer.verdict != Verdict::Consistent {
                    faults.push(format!("called {}", answer.verdict.name()));
                }
            }
            Role::Single | Role::Graded => {
                let right = found.iter().any(|name| self.accepts(name));
                if self.is_visible() && !right {
                    faults.push(if found.is_empty() { "missed" } else { "wrong name" }.to_owned());
                }
                let extra = found.len() > 1 || (!found.is_empty() && !self.is_visible() && !right);
                if extra {
                    faults.push("extra finding".to_owned());
                }
            }
            Role::Double => {
                if self.is_visible() && !self.all_found() {
                    faults.push("not both".to_owned());
                }
                if found.len() > 2 {
                    faults.push("extra finding".to_owned());
                }
            }
            Role::Outside => {
                let certain = answer.findings.iter().filter(|found| found.probability >= 0.9).count();
                if certain > 0 && !self.cannot_be_told() {
                    faults.push("a wrong name with certainty".to_owned());
                }
            }
        }
        if self.stopped_short() {
            faults.push("false minimum".to_owned());
        }
        let worse = |errors: Option<[f64; 2]>| errors.is_some_and(|[refitted, repaired]| repaired > refitted);
        if !found.is_empty() && worse(self.evidence.unseen) {
            faults.push("unseen FRFs worse".to_owned());
        }
        if !found.is_empty() && worse(answer.held_out) {
            faults.push("held-out lines worse".to_owned());
        }
        faults
    }

    /// Whether the fit with all the right names, or of a null, ended higher than the fit about the truth: a false minimum.
    pub fn stopped_short(&self) -> bool {
        let (mut hidden, mut found) = (self.hidden(), self.found());
        hidden.sort();
        found.sort();
        let comparable = self.answer.is_ok() && self.truth.role != Role::Outside && hidden == found;
        comparable && self.evidence.repaired > self.evidence.truth + SHORT
    }

    /// Whether the repaired fixture fits as well as the truth although its names are not what was hidden.
    pub fn cannot_be_told(&self) -> bool {
        self.evidence.repaired <= self.evidence.truth + crate::AS_GOOD
    }

    /// The case in a few lines: what was hidden, what was found, and the objectives.
    pub fn account(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_account(&mut text);
        text
    }

    fn write_account(&self, text: &mut String) -> std::fmt::Result {
        let Evidence { refitted, repaired, truth, others, without, unseen, strained, .. } = &self.evidence;
        let faults = self.faults();
        let what = if faults.is_empty() { "right".to_owned() } else { faults.join(", ") };
        let fresh = if self.truth.fresh { ", fresh" } else { "" };
        writeln!(text, "case {} ({}{fresh}): {what}", self.truth.index, self.truth.role.name())?;
        writeln!(text, "  hidden: {}", self.truth.hidden())?;
        let answer = match &self.answer {
            Ok(answer) => answer,
            Err(why) => return writeln!(text, "  no answer: {why}"),
        };
        writeln!(text, "  answer: {}", answer.verdict.name())?;
        for found in &answer.findings {
            writeln!(text, "    p={:.3} {}", found.probability, describe(&found.effect))?;
            for (effect, probability) in &found.alternatives {
                writeln!(text, "      or p={probability:.3} {}", describe(effect))?;
            }
        }
        write!(
            text,
            "  objective: refitted {refitted:.1}, repaired {repaired:.1}, fit from the truth {truth:.1}"
        )?;
        let [stated_refitted, stated_repaired] = answer.objectives;
        writeln!(text, " (stated: {stated_refitted:.1}, {stated_repaired:.1})")?;
        for (name, objective) in others {
            writeln!(text, "    {name} alone: {objective:.1}")?;
        }
        for (effect, objective) in self.truth.effects().iter().zip(without) {
            writeln!(text, "    without {}: {objective:.1}", crate::Name::of(effect))?;
        }
        for (path, departure) in strained {
            writeln!(text, "    repaired bends {path} by {departure:+.1} standard deviations")?;
        }
        if let Some([refitted, repaired]) = unseen {
            writeln!(text, "  unseen FRFs: error {refitted:.2e} refitted, {repaired:.2e} repaired")?;
        }
        if let Some([refitted, repaired]) = answer.held_out {
            writeln!(text, "  held out: error {refitted:.2e} refitted, {repaired:.2e} repaired")?;
        }
        Ok(())
    }
}
