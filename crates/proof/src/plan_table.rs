//! A plan in a line and as JSON.

use crate::{FAMILIES, Plan};
use serde_json::{Value, json};
use std::fmt::{self, Display, Formatter};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let laboratory =
            [("", self.cases), ("graded ", self.graded)].map(|(what, count)| (what.to_owned(), count));
        let others =
            self.by_route().into_iter().map(|(key, count)| (format!("{} ", key.replace('_', "-")), count));
        let mut counts = laboratory.into_iter().chain(others).filter(|(_, count)| *count > 0);
        match self.only {
            Some(only) => write!(f, "case {only} of {}, seed {}", self.all(), self.seed)?,
            None => {
                let (what, first) = counts.next().unwrap_or_default();
                write!(f, "{first} {what}cases, seed {}", self.seed)?;
                counts.try_for_each(|(what, count)| write!(f, ", and {count} {}", what.trim_end()))?;
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
        let counts = [("cases", self.cases), ("graded", self.graded)].into_iter().chain(self.by_route());
        let mut value: Value = counts.collect();
        value["seed"] = json!(self.seed);
        value["only"] = json!(self.only);
        value["families"] = json!(self.family_names());
        value["fresh_from"] = json!(self.fresh_from);
        value["fresh"] = json!(self.fresh());
        value
    }
}
