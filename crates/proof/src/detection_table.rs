//! Detection, intervals and methods as text and as JSON.

use crate::{Detection, Method, Methods, Score, Share, SizeClass, Smallest};
use serde_json::{Value, json};
use std::fmt::{self, Display, Formatter};

/// "noticed", "named" of a class.
fn shown(share: Share) -> String {
    let [low, high] = share.interval();
    format!("{} of {} ({low:.2} to {high:.2})", share.of, share.all)
}

impl SizeClass {
    /// The class in words: `Δχ² 20 to 35`.
    pub fn name(&self) -> String {
        if self.to.is_finite() {
            format!("{} to {}", self.from, self.to)
        } else {
            format!("{} and more", self.from)
        }
    }
}

impl Smallest {
    /// Kind and degree of freedom.
    pub fn name(&self) -> String {
        match self.dof {
            Some(dof) => format!("{} {}", self.kind.name(), dof.name()),
            None => self.kind.name().to_owned(),
        }
    }
}

impl Detection {
    /// As JSON.
    pub fn to_value(&self) -> Value {
        let share = |share: Share| json!({ "count": share.of, "of": share.all, "ci95": share.interval() });
        json!({
            "classes": self.classes.iter().map(|class| json!({
                "from": class.from, "to": class.to.is_finite().then_some(class.to), "median": class.size,
                "noticed": share(class.noticed), "named": share(class.named),
            })).collect::<Vec<_>>(),
            "course": self.course,
            "half_named_from": self.size_of_share(0.5),
            "sure_from": self.sure_from(),
            "smallest": self.smallest.iter().map(|smallest| json!({
                "kind": smallest.kind.name(), "dof": smallest.dof.map(|dof| dof.name()),
                "parameter": smallest.parameter, "unit": smallest.unit, "median": smallest.value,
                "range": smallest.range, "upper": smallest.is_upper, "cases": smallest.cases,
            })).collect::<Vec<_>>(),
        })
    }
}

impl Score {
    pub(crate) fn write_detection(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nsingle effects by what they cost a fit without them, Δχ²: noticed, named:")?;
        for class in self.detection.classes.iter().filter(|class| class.named.all > 0) {
            writeln!(f, "  {:<16} {:<28} {}", class.name(), shown(class.noticed), shown(class.named))?;
        }
        if let (Some(half), Some(sure)) = (self.detection.size_of_share(0.5), self.detection.sure_from()) {
            writeln!(f, "  half are named from Δχ² = {half:.0}, nineteen of twenty from {sure:.0}")?;
        }
        writeln!(f, "\nsmallest effect named with 0.95, median (least to largest) of cases:")?;
        for smallest in &self.detection.smallest {
            let Smallest { parameter, unit, value, range: [least, largest], is_upper, cases, .. } = smallest;
            let relation = if *is_upper { "≤" } else { "≥" };
            let line = format!(
                "  {:<34} {parameter} {relation} {value:.2e} {unit} ({least:.1e} to {largest:.1e}) of {cases}",
                smallest.name()
            );
            writeln!(f, "{line}")?;
        }
        writeln!(f, "\nintervals of a level that hold the true parameter:")?;
        for (level, held) in self.coverage.by_level() {
            writeln!(f, "  {level:<6} {}", shown(held))?;
        }
        Ok(())
    }
}

impl Display for Methods {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "diagnosis and baselines: nulls left alone, right name, right kind, fits to the noise; then worst quantity in stated deviations, \
             worst joint stiffness, error on unmeasured FRFs (medians):"
        )?;
        for method in &self.0 {
            let share = |share: Option<Share>| {
                share.map_or_else(|| "–".to_owned(), |share| format!("{}/{}", share.of, share.all))
            };
            let number =
                |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2e}"));
            let Method {
                what, nulls, named, kind, fits, worst_quantity, joint_stiffness, unmeasured, ..
            } = method;
            writeln!(
                f,
                "  {what:<28} {:>8} {:>8} {:>8} {:>8}  {:>9} {:>9} {:>9}",
                share(*nulls),
                share(*named),
                share(*kind),
                share(*fits),
                number(*worst_quantity),
                number(*joint_stiffness),
                number(*unmeasured)
            )?;
        }
        Ok(())
    }
}
