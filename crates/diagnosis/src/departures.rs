//! Quantities that had to leave their stated values.

use crate::settings::effects::quantities::DEPARTED;
use crate::{Hypothesis, Tolerance};
use serde::Serialize;

/// A quantity that had to leave its stated value by more than chance makes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Departure {
    /// Its path in the fixture file.
    pub path: String,
    /// Stated value.
    pub stated: f64,
    /// Stated standard deviation.
    pub std: f64,
    /// Value that the fixture by itself asks for.
    pub refitted: f64,
    /// Value that it asks for beside what was found.
    pub repaired: f64,
    /// Departure of that value, in standard deviations.
    pub deviations: f64,
}

impl Departure {
    /// Whether the repaired model, too, takes it farther than chance does.
    pub fn remains(&self) -> bool {
        self.deviations.abs() > DEPARTED
    }
}

/// The stated quantity that a hypothesis takes farthest, and by how many standard deviations; `None` where
/// none is stated with one.
pub(crate) fn farthest(hypothesis: &Hypothesis) -> Option<(&str, f64)> {
    let stated = hypothesis.tolerances().iter().enumerate().filter(|(_, t)| t.quantity.std.is_some());
    let all = stated.map(|(index, t)| (t.quantity.path.as_str(), hypothesis.departure(index).abs()));
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether a hypothesis takes some stated quantity farther than chance does.
pub(crate) fn has_departed(hypothesis: &Hypothesis) -> bool {
    farthest(hypothesis).is_some_and(|(_, deviations)| deviations > DEPARTED)
}

/// Whether it does so with one of them.
pub(crate) fn departed(hypothesis: &Hypothesis, index: usize) -> bool {
    hypothesis.tolerances()[index].quantity.std.is_some() && hypothesis.departure(index).abs() > DEPARTED
}

/// Quantities that the refitted or the repaired model took farther from what is stated than chance does, the
/// farthest first.
pub(crate) fn departures([refitted, repaired]: &[Hypothesis; 2]) -> Vec<Departure> {
    let of = |(index, tolerance): (usize, &Tolerance)| {
        let deviations = repaired.restated(index).unwrap_or_else(|| repaired.departure(index));
        let largest = refitted.departure(index).abs().max(deviations.abs());
        let std = tolerance.quantity.std.filter(|_| largest > DEPARTED)?;
        Some(Departure {
            path: tolerance.quantity.path.clone(),
            stated: tolerance.quantity.value,
            std,
            refitted: refitted.ended_at(index),
            repaired: repaired.ended_at(index),
            deviations,
        })
    };
    let mut all: Vec<Departure> = repaired.tolerances().iter().enumerate().filter_map(of).collect();
    all.sort_by(|a, b| b.deviations.abs().total_cmp(&a.deviations.abs()));
    all
}
