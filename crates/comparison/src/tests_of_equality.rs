//! By what joints are tested for being the same: FRFs alone, at one law, with C free, as if on one valley of
//! the quantities.
//!
//! Two joints are tested by their own two tests. With a third on the same blocks the quantities would be
//! known better, but combinations of K are known a hundred times better than its elements, and the mean slope
//! of three valleys follows none of two between them to second order. All joints are the same where every two
//! are: the p-value of the pair that differs most, times the number of pairs.
//!
//! Where several laws are probable for both, the p-value is the mean of those under each, as often as it is
//! probable.

use crate::at_law::with_free_damping;
use crate::by_law::ByLaw;
use crate::choices::{Choice, choices};
use crate::one_slope::of_one_slope;
use crate::{Decomposed, LawOfAll, Number, Together};

/// The Gaussians of which it is tested whether two joints are the same; nothing where they have no law in
/// common.
pub(crate) fn of_two(two: &[Decomposed; 2], numbers: &[Number], independent: bool) -> Option<ByLaw> {
    let law = LawOfAll::of(two)?;
    let all = choices(two, &law.placed(two), Some(&law));
    let known = all.iter().filter(|choice| choice.apart.is_none());
    let of = |choice: &Choice| {
        let tested = with_free_damping(&of_one_slope(&choice.joints));
        (choice.weight, Together::of((&tested, &all), numbers, independent))
    };
    Some(known.map(of).collect())
}
