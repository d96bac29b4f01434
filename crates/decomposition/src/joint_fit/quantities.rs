//! What of the fixture a fit of the joint may move, and by how much.

use super::{FittedQuantity, UnmovedQuantity};
use jointscope_fixture::{Fixture, NamedQuantity, Nature, QuantityOwner};
use jointscope_inference::{Parameter, Transform};

/// An uncertain quantity of the fixture.
#[derive(Debug, Clone)]
pub(super) struct Uncertain {
    index: usize,
    pub quantity: NamedQuantity,
    /// Coordinate: standard deviations from the stated value, tenths of it where nothing is known of it.
    pub parameter: Parameter,
}

impl Uncertain {
    /// The name of the body that it belongs to.
    pub fn body(&self, fixture: &Fixture) -> Option<String> {
        let body = match self.quantity.owner {
            QuantityOwner::Body(body) => body,
            QuantityOwner::Point(point) => fixture.points()[point].body,
            _ => return None,
        };
        Some(fixture.bodies()[body].name.clone())
    }
}

impl Uncertain {
    /// As a fit has it, at a coordinate with this deviation.
    pub fn fitted(&self, fixture: &Fixture, coordinate: f64, deviation: f64) -> FittedQuantity {
        let transform = self.parameter.transform;
        let fitted = transform.value(coordinate).unwrap_or(self.quantity.value);
        FittedQuantity {
            path: self.quantity.path.clone(),
            body: self.body(fixture),
            stated: self.quantity.value,
            std: self.quantity.std,
            fitted,
            fitted_std: transform.slope(fitted).abs() * deviation,
            deviations: coordinate,
        }
    }

    /// As one that the FRFs tell nothing of.
    pub fn unmoved(&self, fixture: &Fixture) -> UnmovedQuantity {
        UnmovedQuantity {
            path: self.quantity.path.clone(),
            body: self.body(fixture),
            stated: self.quantity.value,
            std: self.quantity.std,
        }
    }
}

/// Relative deviation up to which a positive quantity moves by its logarithm.
const NARROW: f64 = 0.12;

/// The fixture's uncertain quantities but for those of the joints that are looked for.
pub(super) fn uncertain(fixture: &Fixture, joints: &[usize], exact: bool) -> Vec<Uncertain> {
    let own = |owner: QuantityOwner| joints.iter().any(|&joint| owner == QuantityOwner::Joint(joint));
    let all = fixture.uncertain_quantities(exact).into_iter();
    all.filter(|(_, quantity)| !own(quantity.owner))
        .map(|(index, quantity)| Uncertain { index, parameter: parameter_of(&quantity), quantity })
        .collect()
}

fn parameter_of(quantity: &NamedQuantity) -> Parameter {
    let NamedQuantity { value, std, nature, .. } = *quantity;
    let scale = std.unwrap_or(if value == 0.0 { 1.0 } else { 0.1 * value.abs() });
    let positive = !matches!(nature, Nature::Abscissa | Nature::Damping) && value > 0.0;
    let transform = match positive && scale <= NARROW * value {
        true => Transform::Logarithmic { centre: value, scale: scale / value },
        false => Transform::Linear { centre: value, scale },
    };
    let parameter = Parameter::new(transform).with_precision(f64::from(u8::from(std.is_some())));
    match nature {
        Nature::Damping if value > 0.0 => parameter.between(-value / scale, f64::INFINITY),
        _ => parameter,
    }
}

/// The fixture with its uncertain quantities at these coordinates.
pub(super) fn moved(fixture: &Fixture, quantities: &[Uncertain], coordinates: &[f64]) -> Fixture {
    let mut moved = fixture.clone();
    let value =
        |(q, at): (&Uncertain, &f64)| (q.index, q.parameter.transform.value(*at).unwrap_or(q.quantity.value));
    moved.set_quantities(quantities.iter().zip(coordinates).map(value));
    moved
}
