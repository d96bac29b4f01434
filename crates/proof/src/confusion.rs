//! Which kinds were taken for which.

use crate::{Judged, Role};
use std::collections::BTreeMap;

/// Where nothing is hidden, or found.
pub const NOTHING: &str = "nothing";

/// Kinds hidden and kinds found (the strongest finding's), with the number of cases.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Confusion(pub BTreeMap<&'static str, BTreeMap<&'static str, usize>>);

impl Confusion {
    /// Counts nulls, and single effects that show.
    pub fn of<'a>(judged: impl Iterator<Item = &'a Judged>) -> Self {
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
