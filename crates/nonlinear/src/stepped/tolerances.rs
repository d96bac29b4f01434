//! What the fixture's own uncertainty does to a law found.

use super::location::location_of;
use super::problem::{Change, Problem};
use jointscope_fixture::{Fixture, NamedQuantity};
use jointscope_inference::each;

/// Variances of the change's parameters from the fixture's quantities, each moved by its standard deviation
/// and the change fitted again. Base stiffness, base loss and gain are free in every fit, so that what acts
/// as these costs nothing. `exact` takes bare numbers as exact. A quantity whose change cannot be followed
/// adds nothing.
pub(crate) fn tolerance_variances(
    fixture: &Fixture,
    exact: bool,
    problem: &Problem,
    change: &Change,
) -> Vec<f64> {
    let stated = change.parameters();
    let measured: Vec<_> = problem.levels.iter().map(|level| &level.measured).collect();
    let moved = |(index, quantity): &(usize, NamedQuantity), by: f64| -> Option<Vec<f64>> {
        let mut other = fixture.clone();
        other.set_quantities([(*index, quantity.value + by)]);
        // As a file would be, so that what is impossible is not modelled.
        let physics = other.physics().to_vec();
        let other = other.with_physics(physics).ok()?;
        let moved = Problem::new(location_of(&other, (&problem.joint, problem.dof), &measured)?, &measured)?;
        let (fitted, _) = moved.fitted(&moved.carried_from(problem, change))?;
        let shift = fitted.parameters().iter().zip(&stated).map(|(a, b)| a - b).collect::<Vec<f64>>();
        shift.iter().all(|s| s.is_finite()).then_some(shift)
    };
    let shift = |quantity: &(usize, NamedQuantity)| {
        let std = quantity.1.std?;
        moved(quantity, std).or_else(|| moved(quantity, -std))
    };
    let quantities: Vec<(usize, NamedQuantity)> = fixture.uncertain_quantities(exact);
    let shifts: Vec<Vec<f64>> = each(&quantities, shift).into_iter().flatten().collect();
    (0..stated.len()).map(|p| shifts.iter().map(|shift| shift[p] * shift[p]).sum()).collect()
}
