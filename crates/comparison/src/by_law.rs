//! Joints by each of the laws over frequency that they may follow.
//!
//! K and C of different laws are different numbers, and which law holds is not known for certain. Joints of
//! one law follow it together: where another one holds, it holds for all of them, on the same blocks. So what
//! the choice of a law leaves open is a mixture: for each law the posterior of all joints by it, as often as
//! it is probable. An improbable law with numbers far away then counts in an interval for its probability
//! only; the square of its distance, in a variance, would count for more than all the rest.

use crate::at_law::certain;
use crate::choices::Choice;
use crate::{Number, Together};

/// The posterior of all joints under each choice of their laws and how probable it is, the laws compared at
/// first.
pub(crate) type ByLaw = Vec<(f64, Together)>;

/// These posteriors.
pub(crate) fn posteriors(choices: &[Choice], numbers: &[Number], independent: bool) -> ByLaw {
    let total: f64 = choices.iter().map(|choice| choice.weight).sum();
    let of = |choice: &Choice| {
        let mut together = Together::of((&certain(&choice.joints), choices), numbers, independent);
        for (joint, by) in choice.apart.iter().flatten().enumerate() {
            together.shift(joint, &numbers.iter().map(|number| by[number.slot()]).collect::<Vec<_>>());
        }
        (choice.weight / total, together)
    };
    choices.iter().map(of).collect()
}
