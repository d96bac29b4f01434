//! Which kinds were taken for which.

use crate::{Judged, Role};
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// Where nothing is hidden, or found.
pub const NOTHING: &str = "nothing";

/// Kinds hidden and kinds found (the strongest finding's), with the number of cases.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Confusion(pub BTreeMap<&'static str, BTreeMap<&'static str, usize>>);

impl Confusion {
    /// Counts nulls, and single effects that show.
    pub(crate) fn of<'a>(judged: impl Iterator<Item = &'a Judged>) -> Self {
        let mut counts: BTreeMap<&'static str, BTreeMap<&'static str, usize>> = BTreeMap::new();
        for judged in judged {
            let asked = match judged.truth.role {
                Role::Null => true,
                Role::Single => judged.is_visible(),
                Role::Double | Role::Outside | Role::Graded => false,
            };
            if asked {
                let hidden = judged.hidden().first().map_or(NOTHING, |name| name.kind.name());
                let found = judged.found().first().map_or(NOTHING, |name| name.kind.name());
                *counts.entry(hidden).or_default().entry(found).or_default() += 1;
            }
        }
        Confusion(counts)
    }

    /// Number of cases in which `hidden` was taken for `found`.
    pub fn count(&self, hidden: &str, found: &str) -> usize {
        self.0.get(hidden).and_then(|row| row.get(found)).copied().unwrap_or(0)
    }
}

impl Display for Confusion {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nhidden kind: strongest kind found")?;
        for (hidden, found) in &self.0 {
            let mut found: Vec<_> = found.iter().collect();
            found.sort_by_key(|(kind, count)| (Reverse(**count), **kind));
            let found: Vec<String> = found.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
            writeln!(f, "  {hidden:<22} {}", found.join(", "))?;
        }
        Ok(())
    }
}
