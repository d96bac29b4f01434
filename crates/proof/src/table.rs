//! The scores as text and as JSON.

use crate::score::{CHANCE, Comparison};
use crate::{FAMILIES, Figure, Judged, Plan, Rate, Role, Score, Share, Standing, Target};
use serde_json::{Map, Value, json};
use std::fmt::{self, Display, Formatter};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut counts = vec![
            (self.cases, ""),
            (self.graded, "graded "),
            (self.solid, "solid "),
            (self.struck, "struck "),
        ];
        counts.retain(|(count, _)| *count > 0);
        let ((first, what), others) = counts.split_first().map_or(((0, ""), &[][..]), |(c, o)| (*c, o));
        match self.only {
            Some(only) => write!(f, "case {only} of {}, seed {}", self.all(), self.seed)?,
            None => {
                write!(f, "{first} {what}cases, seed {}", self.seed)?;
                others.iter().try_for_each(|(count, what)| write!(f, ", and {count} {}", what.trim_end()))?;
            }
        }
        if self.families != Plan::default().families {
            write!(f, ", {}", self.family_names().join(", "))?;
        }
        match &self.fresh_from {
            Some(text) => write!(f, "; the last {} drawn from {text}", self.fresh()),
            None => Ok(()),
        }
    }
}

impl Plan {
    fn family_names(&self) -> Vec<&'static str> {
        let name = |(name, family): &(&'static str, _)| self.families.contains(family).then_some(*name);
        FAMILIES.iter().filter_map(name).collect()
    }

    /// The plan as JSON.
    pub fn to_value(&self) -> Value {
        json!({
            "cases": self.cases, "graded": self.graded, "solid": self.solid, "struck": self.struck, "seed": self.seed, "only": self.only, "families": self.family_names(),
            "fresh_from": self.fresh_from, "fresh": self.fresh(),
        })
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Target::AtLeast(least) => write!(f, "≥ {least}"),
            Target::AtMost(most) => write!(f, "≤ {most}"),
            Target::Within(least, most) => write!(f, "{least} to {most}"),
        }
    }
}

pub(crate) fn counted(share: Share) -> String {
    let Some(value) = share.value() else { return "no case".to_owned() };
    let [low, high] = share.interval();
    format!("{:>4} of {:<4} {value:.3} ({low:.3} to {high:.3})", share.of, share.all)
}

impl Display for Score {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "cases, and those whose hidden physics shows:")?;
        for (role, all, visible) in &self.cases {
            match role {
                Role::Null => writeln!(f, "  {:<8} {all}", role.name())?,
                _ => writeln!(f, "  {:<8} {all}, {visible} show", role.name())?,
            }
        }
        writeln!(f, "\nshares (95 % binomial interval), target:")?;
        write_rates(f, &self.rates)?;
        writeln!(f, "\nfigures, target:")?;
        write_figures(f, &self.figures)?;
        self.write_detection(f)?;
        self.write_calibration(f)?;
        self.write_confusion(f)?;
        self.write_comparisons(f)
    }
}

/// Shares beside their targets, a line each.
pub(crate) fn write_rates(f: &mut Formatter<'_>, rates: &[Rate]) -> fmt::Result {
    for rate in rates {
        let target = rate.target.map_or_else(String::new, |target| target.to_string());
        let line = format!(
            "  {:<60} {:<36} {target:<14} {}",
            rate.what,
            counted(rate.share),
            rate.standing().map_or("", Standing::says)
        );
        writeln!(f, "{}", line.trim_end())?;
    }
    Ok(())
}

/// Figures beside their targets, a line each.
pub(crate) fn write_figures(f: &mut Formatter<'_>, figures: &[Figure]) -> fmt::Result {
    for Figure { what, value, from, target, .. } in figures {
        let shown = value.map_or_else(|| "no case".to_owned(), |value| format!("{value:.3} of {from}"));
        let standing = match (target, value) {
            (Some(target), Some(value)) if target.is_met(*value) => "met",
            (Some(_), Some(_)) => "missed",
            _ => "",
        };
        let target = target.map_or_else(String::new, |target| target.to_string());
        let line = format!("  {what:<60} {shown:<36} {target:<14} {standing}");
        writeln!(f, "{}", line.trim_end())?;
    }
    Ok(())
}

/// A share as JSON.
pub(crate) fn share_value(share: Share) -> Value {
    json!({ "count": share.of, "of": share.all, "share": share.value(), "ci95": share.interval() })
}

/// A rate as JSON, with its key.
pub(crate) fn rate_value(rate: &Rate) -> (String, Value) {
    let mut value = share_value(rate.share);
    value["what"] = json!(rate.what);
    value["target"] = json!(rate.target.map(|target| target.to_string()));
    value["met"] = json!(rate.target.zip(rate.share.value()).map(|(t, v)| t.is_met(v)));
    (rate.key.to_owned(), value)
}

/// A figure as JSON, with its key.
pub(crate) fn figure_value(figure: &Figure) -> (String, Value) {
    let target = figure.target.map(|target| target.to_string());
    let met = figure.target.zip(figure.value).map(|(t, v)| t.is_met(v));
    let value = json!({
        "value": figure.value, "of": figure.from, "what": figure.what, "target": target, "met": met,
    });
    (figure.key.to_owned(), value)
}

impl Score {
    fn write_calibration(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nstated probabilities of names: number, mean stated, share that is the hidden name, share acceptable:"
        )?;
        for bin in self.reliability.0.iter().filter(|bin| bin.true_names.all > 0) {
            let share = |share: Share| share.value().unwrap_or(0.0);
            writeln!(
                f,
                "  {:.2} to {:.2} {:>5}  {:.3}  {:.3}  {:.3}",
                bin.from,
                bin.to,
                bin.true_names.all,
                bin.stated,
                share(bin.true_names),
                share(bin.acceptable)
            )?;
        }
        Ok(())
    }

    fn write_confusion(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nhidden kind: strongest kind found")?;
        for (hidden, found) in &self.confusion.0 {
            let mut found: Vec<_> = found.iter().collect();
            found.sort_by_key(|(kind, count)| (std::cmp::Reverse(**count), **kind));
            let found: Vec<String> = found.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
            writeln!(f, "  {hidden:<22} {}", found.join(", "))?;
        }
        writeln!(f, "\nverdicts:")?;
        for (role, verdicts) in &self.verdicts {
            let given: Vec<String> = verdicts
                .iter()
                .filter(|(_, count)| *count > 0)
                .map(|(name, count)| format!("{name} {count}"))
                .collect();
            writeln!(f, "  {:<8} {}", role.name(), given.join(", "))?;
        }
        Ok(())
    }

    fn write_comparisons(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.comparisons.is_empty() {
            return Ok(());
        }
        writeln!(f, "\nold and fresh cases, probability of a difference as large by chance:")?;
        for Comparison { key, old, fresh, probability } in &self.comparisons {
            let word = if *probability < CHANCE { "differ" } else { "agree" };
            writeln!(
                f,
                "  {key:<20} {:>4} of {:<4} {:>4} of {:<4} {probability:.3} {word}",
                old.of, old.all, fresh.of, fresh.all
            )?;
        }
        Ok(())
    }

    /// The scores as JSON.
    pub fn to_value(&self) -> Value {
        let roles: Map<String, Value> = self
            .cases
            .iter()
            .map(|(role, all, visible)| (role.name().to_owned(), json!({ "cases": all, "visible": visible })))
            .collect();
        let verdicts: Map<String, Value> = self
            .verdicts
            .iter()
            .map(|(role, given)| {
                let given: Map<String, Value> =
                    given.iter().map(|(name, count)| ((*name).to_owned(), json!(count))).collect();
                (role.name().to_owned(), Value::Object(given))
            })
            .collect();
        json!({
            "roles": roles,
            "rates": self.rates.iter().map(rate_value).collect::<Map<_, _>>(),
            "figures": self.figures.iter().map(figure_value).collect::<Map<_, _>>(),
            "reliability": self.reliability.0.iter().map(|bin| json!({
                "from": bin.from, "to": bin.to, "stated": bin.stated,
                "true_name": share_value(bin.true_names), "acceptable": share_value(bin.acceptable),
            })).collect::<Vec<_>>(),
            "confusion": self.confusion.0,
            "detection": self.detection.to_value(),
            "coverage_by_level": self.coverage.by_level().into_iter().map(|(level, held)| json!({
                "level": level, "held": share_value(held),
            })).collect::<Vec<_>>(),
            "verdicts": verdicts,
            "old_and_fresh": self.comparisons.iter().map(|comparison| (comparison.key.to_owned(), json!({
                "old": share_value(comparison.old), "fresh": share_value(comparison.fresh),
                "probability": comparison.probability, "agree": comparison.probability >= CHANCE,
            }))).collect::<Map<_, _>>(),
        })
    }
}

impl Judged {
    /// The case as JSON: truth, names found, objectives, faults.
    pub fn to_value(&self) -> Value {
        let evidence = &self.evidence;
        let findings = self.answer.iter().flat_map(|answer| &answer.findings);
        let named = |name: String, value: f64| json!({ "name": name, "objective": value });
        json!({
            "truth": self.truth.to_value(),
            "verdict": self.answer.as_ref().map(|answer| answer.verdict.name()).ok(),
            "found": findings.map(|found| json!({
                "name": crate::Name::of(&found.effect).to_string(), "probability": found.probability,
            })).collect::<Vec<_>>(),
            "visible": self.is_visible(),
            "faults": self.faults(),
            "objectives": {
                "refitted": evidence.refitted, "repaired": evidence.repaired, "truth": evidence.truth,
                "others": evidence.others.iter().map(|(n, v)| named(n.to_string(), *v)).collect::<Vec<_>>(),
                "without": evidence.without,
            },
            "unseen": evidence.unseen,
        })
    }
}
