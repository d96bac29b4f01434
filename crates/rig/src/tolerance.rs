//! What the structure really is, when the analyst knows it only within tolerances.

use crate::StructureError;
use crate::random::normal;
use jointscope_fixture::{Fixture, NamedQuantity, Nature};
use rand::Rng;

/// Draws of a whole truth before giving up: a stiffness matrix stated near singular can be drawn indefinite.
const DRAWS: usize = 50;

/// A fixture of which every quantity is drawn from the normal distribution that `fixture` states for it, its
/// default where none is stated; what is unknown and what is zero stays as it is. No quantity changes its
/// sign, and no damping falls below three tenths of what was stated.
///
/// # Errors
/// [`StructureError::Fixture`] where no draw gives a possible fixture.
pub fn drawn_within_tolerance(fixture: &Fixture, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
    let mut attempt = drawn_once(fixture, rng);
    for _ in 1..DRAWS {
        if attempt.is_ok() {
            break;
        }
        attempt = drawn_once(fixture, rng);
    }
    attempt
}

fn drawn_once(fixture: &Fixture, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
    let stated = fixture.quantities();
    let mut truth = fixture.clone();
    for (entry, stated) in truth.quantities_mut().into_iter().zip(&stated) {
        entry.quantity.value = drawn(stated, rng);
    }
    // Checks the fixture anew, as a file would be.
    let physics = truth.physics().to_vec();
    Ok(truth.with_physics(physics)?)
}

fn drawn(stated: &NamedQuantity, rng: &mut impl Rng) -> f64 {
    let Some(std) = stated.std else { return stated.value };
    if std == 0.0 {
        return stated.value;
    }
    let possible = |value: f64| match stated.nature {
        Nature::Abscissa | Nature::Effect => true,
        Nature::Damping => value.abs() >= 0.3 * stated.value.abs() && value * stated.value >= 0.0,
        _ => value * stated.value >= 0.0,
    };
    (0..DRAWS)
        .map(|_| stated.value + std * normal(rng))
        .find(|value| possible(*value))
        .unwrap_or(stated.value)
}
