//! A plan in a line and as JSON.

use crate::{FAMILIES, Plan};
use serde_json::{Value, json};
use std::fmt::{self, Display, Formatter};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut counts = vec![
            (self.cases, ""),
            (self.graded, "graded "),
            (self.solid, "solid "),
            (self.struck, "struck "),
            (self.solid_as_is, "solid-as-is "),
            (self.modal_errors, "modal-errors "),
            (self.channel_flaws, "channel-flaws "),
            (self.load_paths, "load-paths "),
            (self.unknown_physics, "unknown-physics "),
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
            "cases": self.cases, "graded": self.graded, "solid": self.solid, "struck": self.struck,
            "solid_as_is": self.solid_as_is, "modal_errors": self.modal_errors, "channel_flaws": self.channel_flaws,
            "load_paths": self.load_paths, "unknown_physics": self.unknown_physics,
            "seed": self.seed, "only": self.only, "families": self.family_names(),
            "fresh_from": self.fresh_from, "fresh": self.fresh(),
        })
    }
}
