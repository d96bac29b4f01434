//! By what joints are tested for being the same: FRFs alone, at one law, with C free, as if on one valley of the quantities.
//!
//! Where several laws are probable for all, the p-value is the mean of those under each, as often as it is probable.

use crate::at_law::with_free_damping;
use crate::by_law::{Choice, choices};
use crate::one_slope::of_one_slope;
use crate::{Compared, Decomposed, LawOfAll, Number, Together};

/// The Gaussians of which equality is tested, the one of the law compared at first, and how probable each law is.
pub(crate) type ByLaw = Vec<(f64, Together)>;

/// The Gaussians of which equality is tested.
pub(crate) struct Tests<'a> {
    /// Of all joints; nothing where they have no law in common.
    pub of_all: Option<ByLaw>,
    /// The joints as given.
    given: &'a [Decomposed],
    numbers: &'a [Number],
    independent: bool,
    is_of_fits: bool,
}

impl<'a> Tests<'a> {
    /// Of joints as given and by each choice of their laws, if there `is_of_one_law`.
    pub(crate) fn of(
        (given, choices): (&'a [Decomposed], &[Choice]),
        is_of_one_law: bool,
        numbers: &'a [Number],
        (compared, independent): (Compared, bool),
    ) -> Self {
        let is_of_fits = compared == Compared::AllFrfs;
        let of_all = (is_of_fits && is_of_one_law).then(|| by_law(choices, given, numbers, independent));
        Tests { of_all, given, numbers, independent, is_of_fits }
    }

    /// Of two joints at a law of their own, where not all have one in common.
    pub(crate) fn of_pair(&self, (a, b): (usize, usize)) -> Option<ByLaw> {
        if !self.is_of_fits || self.of_all.is_some() {
            return None;
        }
        let two = [self.given[a].clone(), self.given[b].clone()];
        let law = LawOfAll::of(&two)?;
        let choices = choices(&two, &law.placed(&two), Some(&law));
        Some(by_law(&choices, &two, self.numbers, self.independent))
    }
}

fn by_law(choices: &[Choice], given: &[Decomposed], numbers: &[Number], independent: bool) -> ByLaw {
    let known = choices.iter().filter(|choice| choice.apart.is_none());
    let of = |choice: &Choice| {
        let tested = with_free_damping(&of_one_slope(&choice.joints));
        (choice.weight, Together::of((&tested, given), numbers, independent))
    };
    known.map(of).collect()
}
