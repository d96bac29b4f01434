//! What the fixture's own uncertainty does to a law found.

use super::location::location_of;
use super::problem::{Change, Problem};
use jointscope_fixture::{Fixture, NamedQuantity};
use jointscope_inference::each;

/// What the fixture's quantities, each moved by its standard deviation, make of a change that is fitted again.
pub(crate) struct ByTolerances {
    /// Variances of the change's parameters.
    pub variances: Vec<f64>,
    /// Relative error of the FRFs, root mean square over the levels: what is left of a law that is right.
    pub error: f64,
}

/// A quantity moved and the change fitted again: by how much its parameters moved, and the sum of squares by
/// which the residuals did.
struct Shift {
    parameters: Vec<f64>,
    residuals: f64,
}

/// Base stiffness, base loss and gain are free in every fit, so that what acts as these costs nothing. `exact`
/// takes bare numbers as exact. A quantity whose change cannot be followed adds nothing.
pub(crate) fn by_tolerances(
    fixture: &Fixture,
    exact: bool,
    problem: &Problem,
    change: &Change,
) -> ByTolerances {
    let stated = change.parameters();
    let left = problem.residuals(change).unwrap_or_default();
    let measured: Vec<_> = problem.levels.iter().map(|level| &level.measured).collect();
    let moved = |(index, quantity): &(usize, NamedQuantity), by: f64| -> Option<Shift> {
        let mut other = fixture.clone();
        other.set_quantities([(*index, quantity.value + by)]);
        // As a file would be, so that what is impossible is not modelled.
        let physics = other.physics().to_vec();
        let other = other.with_physics(physics).ok()?;
        let moved = Problem::new(location_of(&other, (&problem.joint, problem.dof), &measured)?, &measured)?;
        let (fitted, _) = moved.fitted(&moved.carried_from(problem, change))?;
        let parameters = fitted.parameters().iter().zip(&stated).map(|(a, b)| a - b).collect::<Vec<f64>>();
        let residuals = moved.residuals(&fitted)?.iter().zip(&left).map(|(a, b)| (a - b).powi(2)).sum();
        parameters.iter().all(|s| s.is_finite()).then_some(Shift { parameters, residuals })
    };
    let shift = |quantity: &(usize, NamedQuantity)| {
        let std = quantity.1.std?;
        moved(quantity, std).or_else(|| moved(quantity, -std))
    };
    let quantities: Vec<(usize, NamedQuantity)> = fixture.uncertain_quantities(exact);
    let shifts: Vec<Shift> = each(&quantities, shift).into_iter().flatten().collect();
    let squares = |p: usize| shifts.iter().map(|shift| shift.parameters[p].powi(2)).sum();
    let residuals: f64 = shifts.iter().map(|shift| shift.residuals).sum();
    ByTolerances {
        variances: (0..stated.len()).map(squares).collect(),
        error: (residuals / problem.levels.len() as f64).sqrt(),
    }
}
