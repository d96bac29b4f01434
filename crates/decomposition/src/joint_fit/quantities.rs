//! What of the fixture a fit of the joint may move, and by how much.

use super::{FittedQuantity, UnmovedQuantity};
use jointscope_fixture::{Fixture, QuantityOwner};
use jointscope_tolerances::Tolerance;

/// The fixture's uncertain quantities but for those of the joints that are looked for.
pub(super) fn uncertain(fixture: &Fixture, joints: &[usize], exact: bool) -> Vec<Tolerance> {
    let own = |owner: QuantityOwner| joints.iter().any(|&joint| owner == QuantityOwner::Joint(joint));
    let mut all = Tolerance::all(fixture, exact);
    all.retain(|tolerance| !own(tolerance.quantity.owner));
    all
}

/// The name of the body that a quantity belongs to.
fn body(fixture: &Fixture, owner: QuantityOwner) -> Option<String> {
    let body = match owner {
        QuantityOwner::Body(body) => body,
        QuantityOwner::Point(point) => fixture.points()[point].body,
        _ => return None,
    };
    Some(fixture.bodies()[body].name.clone())
}

impl FittedQuantity {
    /// As a fit has it, at a coordinate with this deviation.
    pub(super) fn of(own: &Tolerance, fixture: &Fixture, coordinate: f64, deviation: f64) -> Self {
        let fitted = own.value(coordinate);
        FittedQuantity {
            path: own.quantity.path.clone(),
            body: body(fixture, own.quantity.owner),
            stated: own.quantity.value,
            std: own.quantity.std,
            fitted,
            fitted_std: own.parameter.transform.slope(fitted).abs() * deviation,
            deviations: coordinate,
        }
    }
}

impl UnmovedQuantity {
    /// As one that the FRFs tell nothing of.
    pub(super) fn of(own: &Tolerance, fixture: &Fixture) -> Self {
        UnmovedQuantity {
            path: own.quantity.path.clone(),
            body: body(fixture, own.quantity.owner),
            stated: own.quantity.value,
            std: own.quantity.std,
        }
    }
}
