//! Where a fit left the fixture's quantities.

use crate::hypothesis::Hypothesis;
use jointscope_fixture::{Effect, Place};

impl Hypothesis {
    /// How far quantity `index` ended from what is stated, in standard deviations, an effect that calls it
    /// wrong included.
    pub fn deviations(&self, index: usize) -> f64 {
        self.restated(index).unwrap_or(self.coordinates[index])
    }

    /// Whether quantity `index` had to move farther from what is stated than chance takes one of a few.
    pub fn is_far(&self, index: usize) -> bool {
        let stated = self.tolerances().get(index).is_some_and(|tolerance| tolerance.quantity.std.is_some());
        stated && jointscope_tolerances::is_far(self.departure(index))
    }

    /// Where an effect that calls quantity `index` wrong takes it, in standard deviations from what is
    /// stated.
    pub(crate) fn restated(&self, index: usize) -> Option<f64> {
        let path = &self.tolerances().get(index)?.quantity.path;
        let is_of_it = |effect: &Effect| matches!(&effect.place, Place::Quantity(other, _) if other == path);
        let effect = self.effects().iter().position(is_of_it)?;
        self.coordinates.get(self.range_of(effect).start).copied()
    }

    /// Where quantity `index` of [`Hypothesis::tolerances`] stands, SI.
    pub fn ended_at(&self, index: usize) -> f64 {
        self.tolerances().get(index).map_or(f64::NAN, |tolerance| tolerance.value(self.deviations(index)))
    }
}
