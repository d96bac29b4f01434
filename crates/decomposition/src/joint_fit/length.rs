//! The length of a joint as a fit has it.

use super::law::Dynamics;
use jointscope_fixture::{Fixture, Joint, QuantityKey, QuantityOwner};
use jointscope_inference::Covariance;
use jointscope_tolerances::Tolerance;
use serde::{Serialize, Serializer};

/// The joint's length as a fit has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FittedLength {
    /// L, m.
    pub value: f64,
    /// Its variance after the fit, m²; zero where both ends are exact.
    #[serde(rename = "std", serialize_with = "root")]
    pub variance: f64,
    /// Its covariance with (k11, k12, k22).
    #[serde(skip)]
    pub with_stiffness: [f64; 3],
}

fn root<S: Serializer>(variance: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    variance.max(0.0).sqrt().serialize(serializer)
}

/// A joint's length, to which K is tied by the ends' places: from the quantities and all coordinates, of
/// which the first `own` are not quantities', and K's begin at `first`.
pub(super) fn length_between(
    (fixture, joint): (&Fixture, &Joint),
    (quantities, coordinates): (&[Tolerance], &[f64]),
    (own, first, law): (usize, usize, &Dynamics),
    covariance: &Covariance,
) -> FittedLength {
    let ends: Vec<(usize, f64, f64)> = quantities
        .iter()
        .enumerate()
        .filter_map(|(index, uncertain)| {
            let sign = match (uncertain.quantity.key, uncertain.quantity.owner) {
                (QuantityKey::Abscissa, QuantityOwner::Point(point)) if point == joint.to => 1.0,
                (QuantityKey::Abscissa, QuantityOwner::Point(point)) if point == joint.from => -1.0,
                _ => return None,
            };
            let (transform, stated) = (uncertain.parameter.transform, uncertain.quantity.value);
            let value = transform.value(coordinates[own + index]).unwrap_or(stated);
            Some((own + index, sign * (value - stated), sign * transform.slope(value)))
        })
        .collect();
    let u = &law.unit;
    let elements = [u.at(0, 0), u.at(0, 1), u.at(1, 1)];
    let mut with_stiffness = [0.0; 3];
    for (element, unit) in elements.into_iter().enumerate().take(law.stiffness.count()) {
        with_stiffness[element] =
            ends.iter().map(|(end, _, slope)| unit * slope * covariance.at(first + element, *end)).sum();
    }
    let products =
        ends.iter().flat_map(|(a, _, s)| ends.iter().map(move |(b, _, t)| s * t * covariance.at(*a, *b)));
    FittedLength {
        value: fixture.joint_length(joint) + ends.iter().map(|(_, moved, _)| moved).sum::<f64>(),
        variance: products.sum::<f64>().max(0.0),
        with_stiffness,
    }
}
