//! How sizes of error go on from round to round of a fit: parameters and sizes ask for each other in turn.

use crate::settings::modal::turns::{ALIKE, ONWARD, TURNED_BACK};
use jointscope_model_error::{ErrorSizes, KINDS};

/// Whether parameters fitted at one of these sizes are as good as fitted at the other.
pub(super) fn are_alike(a: &ErrorSizes, b: &ErrorSizes) -> bool {
    a.to_array().iter().zip(b.to_array()).all(|(a, b)| (a / b).ln().abs() < ALIKE)
}

/// How a fit goes from sizes to those that it asks for.
pub(super) struct Turns {
    /// The change of each size's logarithm that was made last.
    last: [f64; KINDS],
    /// Share of what is asked for that is gone.
    shares: [f64; KINDS],
}

impl Turns {
    /// The whole way, for a start.
    pub(super) fn none() -> Self {
        Turns { last: [0.0; KINDS], shares: [1.0; KINDS] }
    }

    /// The sizes to go on with. Where one turns back it goes less far, and a little farther again where it
    /// does not: parameters and sizes that ask for each other in turn come to no rest otherwise.
    pub(super) fn toward(&mut self, asked: &ErrorSizes, from: &ErrorSizes) -> ErrorSizes {
        let (from, asked) = (from.to_array(), asked.to_array());
        ErrorSizes::from_array(std::array::from_fn(|kind| {
            let change = (asked[kind] / from[kind]).ln();
            let share = &mut self.shares[kind];
            *share = if change * self.last[kind] < 0.0 {
                TURNED_BACK * *share
            } else {
                (ONWARD * *share).min(1.0)
            };
            self.last[kind] = *share * change;
            if *share == 1.0 { asked[kind] } else { from[kind] * self.last[kind].exp() }
        }))
    }
}
