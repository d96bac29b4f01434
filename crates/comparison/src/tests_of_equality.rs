//! By what joints are tested for being the same: FRFs alone, at one law, with C free, as if on one valley of the quantities.

use crate::at_law::with_free_damping;
use crate::one_slope::of_one_slope;
use crate::{Compared, Decomposed, LawOfAll, Number, Together};

/// The Gaussians of which equality is tested.
pub(crate) struct Tests<'a> {
    /// Of all joints; nothing where they have no law in common.
    pub of_all: Option<Together>,
    /// The joints as given.
    given: &'a [Decomposed],
    numbers: &'a [Number],
    independent: bool,
    is_of_fits: bool,
}

impl<'a> Tests<'a> {
    /// Of joints as given and at the law of all of them, if there `is_of_one_law`.
    pub(crate) fn of(
        (given, placed): (&'a [Decomposed], &[Decomposed]),
        is_of_one_law: bool,
        numbers: &'a [Number],
        (compared, independent): (Compared, bool),
    ) -> Self {
        let is_of_fits = compared == Compared::AllFrfs;
        let of_all = (is_of_fits && is_of_one_law)
            .then(|| Together::of(&with_free_damping(&of_one_slope(placed)), numbers, independent));
        Tests { of_all, given, numbers, independent, is_of_fits }
    }

    /// Of two joints at a law of their own, where not all have one in common.
    pub(crate) fn of_pair(&self, (a, b): (usize, usize)) -> Option<Together> {
        if !self.is_of_fits || self.of_all.is_some() {
            return None;
        }
        let two = [self.given[a].clone(), self.given[b].clone()];
        let placed = LawOfAll::of(&two)?.placed(&two);
        Some(Together::of(&with_free_damping(&of_one_slope(&placed)), self.numbers, self.independent))
    }
}
