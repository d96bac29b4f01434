//! Where a fit left the fixture's quantities.

use crate::hypothesis::Hypothesis;

impl Hypothesis {
    /// Where quantity `index` of [`Hypothesis::tolerances`] stands, SI.
    pub fn ended_at(&self, index: usize) -> f64 {
        self.tolerances().get(index).map_or(f64::NAN, |tolerance| tolerance.value(self.departure(index)))
    }
}
