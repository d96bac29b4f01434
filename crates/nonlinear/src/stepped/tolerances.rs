//! What the fixture's own uncertainty does to a law found.

use super::model::{Change, Subject};
use super::seat::seat_of;
use jointscope_fixture::Fixture;
use rayon::prelude::*;

/// Variances of the change's parameters from the fixture's quantities, each moved by its standard deviation and the change fitted again. Base
/// stiffness, base loss and gain are free in every fit, so that what acts as these costs nothing. `exact` takes bare numbers as exact. A quantity whose
/// change cannot be followed adds nothing.
pub(crate) fn tolerance_variances(
    fixture: &Fixture,
    exact: bool,
    subject: &Subject,
    change: &Change,
) -> Vec<f64> {
    let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
    let stated = change.parameters();
    let place = (subject.seat.joint.as_str(), subject.dof());
    let moved = |index: usize, by: f64| -> Option<Vec<f64>> {
        let mut other = fixture.clone();
        other.quantities_mut().into_iter().nth(index)?.quantity.value += by;
        // As a file would be, so that what is impossible is not modelled.
        let physics = other.physics().to_vec();
        let other = other.with_physics(physics).ok()?;
        let seat = seat_of(&other, place, &subject.levels)?;
        let moved = subject.in_another(seat)?;
        let (fitted, _) = moved.fitted(&moved.carried_from(subject, change), None)?;
        let shift = fitted.parameters().iter().zip(&stated).map(|(a, b)| a - b).collect::<Vec<f64>>();
        shift.iter().all(|s| s.is_finite()).then_some(shift)
    };
    let shifts: Vec<Vec<f64>> = quantities
        .par_iter()
        .enumerate()
        .filter_map(|(index, quantity)| {
            let std = quantity.std.filter(|std| *std > 0.0)?;
            moved(index, std).or_else(|| moved(index, -std))
        })
        .collect();
    (0..stated.len()).map(|p| shifts.iter().map(|shift| shift[p] * shift[p]).sum()).collect()
}
