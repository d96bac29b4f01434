//! How the parameters of an effect move in a fit: by themselves or by their logarithms, and between which
//! bounds.

use crate::bodies::{extent, radius_of_gyration, turns};
use crate::settings::effects::bounds::{
    ABSCISSA_UNIT, ADDED_MASSES, BEYOND_BAR, FARTHEST_ACROSS, MISSING_LENGTH, MISSING_OF_BEAM,
};
use jointscope_fixture::{
    BodyKind, Effect, Fixture, Motion, NamedQuantity, ParameterSpec, Place, Possible, Quantity, QuantityKey,
    QuantityOwner,
};
use jointscope_inference::{Parameter, Transform};
use jointscope_tolerances::Tolerance;

/// A positive quantity that moves by its logarithm, between bounds of that.
fn logarithm(low: f64, high: f64) -> Parameter {
    Parameter::new(Transform::Logarithmic { centre: 1.0, scale: 1.0 }).between(low, high)
}

/// A quantity that moves in units of `scale`, between bounds of its value.
fn between(scale: f64, low: f64, high: f64) -> Parameter {
    Parameter::new(Transform::Linear { centre: 0.0, scale }).between(low / scale, high / scale)
}

/// How a fit moves a quantity that is stated wrong: as within its tolerance, what sits on a body no farther
/// than the body may reach.
pub(crate) fn if_wrong(fixture: &Fixture, tolerance: &Tolerance) -> Parameter {
    let parameter = tolerance.parameter;
    let Some(body) = sits_on(fixture, &tolerance.quantity) else { return parameter };
    let (low, high) = reach(fixture, body);
    let bound = |x: f64| parameter.transform.coordinate(x);
    match (bound(low), bound(high)) {
        // A body that has no extent says nothing of what it holds.
        (Some(low), Some(high)) if low < 0.0 && high > 0.0 => {
            parameter.between(parameter.low.max(low), parameter.high.min(high))
        }
        _ => parameter,
    }
}

/// The body on which a quantity is a place.
fn sits_on(fixture: &Fixture, quantity: &NamedQuantity) -> Option<usize> {
    match (quantity.owner, quantity.key) {
        (QuantityOwner::Point(point), QuantityKey::Abscissa) => Some(fixture.points()[point].body),
        (QuantityOwner::Support(support), QuantityKey::Abscissa) => {
            Some(fixture.support_place(&fixture.supports()[support]).0)
        }
        (QuantityOwner::Body(body), QuantityKey::PointMassAbscissa(_) | QuantityKey::CentreOfGravity) => {
            Some(body)
        }
        _ => None,
    }
}

/// Between which abscissae something may be on a body whose own extent is guessed of its mass and inertia.
fn reach(fixture: &Fixture, body: usize) -> (f64, f64) {
    let (low, high) = extent(fixture, body);
    let beyond = match &fixture.bodies()[body].kind {
        BodyKind::Rigid(_) => BEYOND_BAR * (high - low),
        BodyKind::Beam(_) => 0.0,
    };
    (low - beyond, high + beyond)
}

/// How a fit moves each of an effect's parameters, in their order; the value of a quantity that is `wrong` as
/// that quantity moves.
pub(crate) fn parameters_of(fixture: &Fixture, effect: &Effect, wrong: Parameter) -> Vec<Parameter> {
    let named = |name: &String| fixture.bodies().iter().position(|b| b.name == *name);
    let (body, second) = match &effect.place {
        Place::Body(name) => (named(name), None),
        Place::Between(one, other) => (named(one), named(other)),
        _ => (None, None),
    };
    let along = |body: Option<usize>| match body.filter(|b| turns(fixture, *b)) {
        Some(body) => {
            let (low, high) = extent(fixture, body);
            between(ABSCISSA_UNIT * (high - low).max(1e-6), low, high)
        }
        None => Parameter::new(Transform::Fixed),
    };
    let fixed = Parameter::new(Transform::Fixed);
    let of = |(parameter, quantity): (&ParameterSpec, &Quantity)| match parameter.motion {
        _ if parameter.of_bodies_only && body.is_none() => fixed,
        // What holds a whole body against rotation does so anywhere.
        Motion::AlongBody if effect.kind.spec().may_turn && effect.dof.is_some() => fixed,
        Motion::None => fixed,
        Motion::AlongBody => along(body),
        Motion::AlongSecondBody => along(second),
        Motion::AcrossBody => match body.and_then(|body| radius_of_gyration(fixture, body)) {
            Some(radius) => between(radius, 0.0, FARTHEST_ACROSS * radius),
            None => fixed,
        },
        Motion::OfQuantity => wrong,
        Motion::Logarithm { reach } => {
            let start = quantity.value.max(f64::MIN_POSITIVE).ln();
            // What hangs on a body is lighter than the body.
            let most = match (parameter.possible, body) {
                (Possible::MassOfBody, Some(body)) => fixture.bodies()[body].kind.mass().ln(),
                _ => f64::INFINITY,
            };
            logarithm(start - reach, (start + reach).min(most.max(start)))
        }
        Motion::Signed(scale) => {
            let (low, high) = possible(parameter.possible, fixture, &effect.place);
            between(scale.of(quantity.value), low, high)
        }
        Motion::NonNegative(scale) => {
            let most = match parameter.possible {
                Possible::UpTo(most) => most.max(quantity.value),
                _ => f64::INFINITY,
            };
            between(scale.of(quantity.value), 0.0, most)
        }
    };
    effect.kind.spec().parameters.iter().zip(&effect.parameters).map(of).collect()
}

/// The most that a body may lack at one place, kg: a block all of it, a beam a hole and the heaviest of the
/// masses that sit on it.
fn most_missing(fixture: &Fixture, body: usize) -> f64 {
    let mass = fixture.bodies()[body].kind.mass();
    match &fixture.bodies()[body].kind {
        BodyKind::Rigid(_) => mass,
        BodyKind::Beam(_) => {
            let on_it = fixture.bodies()[body].masses.iter().map(|point| point.mass.value);
            MISSING_OF_BEAM * mass + on_it.fold(0.0, f64::max)
        }
    }
}

/// Between which values a parameter of either sign is possible at a place.
fn possible(possible: Possible, fixture: &Fixture, place: &Place) -> (f64, f64) {
    let any = (f64::NEG_INFINITY, f64::INFINITY);
    match (possible, place) {
        (Possible::MassOfBody, Place::Body(name)) => {
            let masses = || (0..fixture.bodies().len()).map(|body| fixture.bodies()[body].kind.mass());
            let own = fixture.bodies().iter().position(|body| body.name == *name);
            let own = own.map_or(0.0, |body| most_missing(fixture, body));
            (-own, ADDED_MASSES * masses().sum::<f64>())
        }
        (Possible::OnBody, Place::Point(name) | Place::Response(name) | Place::Reference(name)) => {
            fixture.point(name).map_or(any, |point| {
                let (low, high) = reach(fixture, point.body);
                (low - point.x.value, high - point.x.value)
            })
        }
        (Possible::LengthOfJoint, Place::Joint(name)) => {
            let joint = fixture.joints().iter().find(|joint| joint.name == *name);
            joint.map_or(any, |joint| (-MISSING_LENGTH * fixture.joint_length(joint), f64::INFINITY))
        }
        _ => any,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn what_sits_on_a_body_may_be_wrong_as_far_as_the_body_reaches() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": 1.2, "inertia": 1e-3, "x_cg": 0.05 } },
                 "points": { "1": { "body": "A", "x": {"value": 0.01, "std": 1e-4} } },
                 "supports": { "wall": { "body": "A", "x": {"value": 0.0, "std": 1e-4}, "stiffness": 1e8 } } }"#,
        )
        .unwrap();
        // A bar of that mass and inertia is 100 mm long.
        let half = (3.0_f64 * 1e-3 / 1.2).sqrt();
        let beyond = BEYOND_BAR * 2.0 * half;
        let tolerances = Tolerance::all(&fixture, false);
        let of = |path: &str| tolerances.iter().find(|t| t.quantity.path == path).unwrap();
        for path in ["points/1/x", "supports/wall/x", "bodies/A/x_cg"] {
            let moves = if_wrong(&fixture, of(path));
            let ends = [moves.low, moves.high].map(|at| moves.transform.value(at).unwrap());
            let expected = [0.05 - half - beyond, 0.05 + half + beyond];
            assert!(ends.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-9), "{path}: {ends:?}");
        }
        let mass = of("bodies/A/mass");
        assert_eq!(if_wrong(&fixture, mass), mass.parameter, "it is no place");
    }
}
