//! How the parameters of an effect move in a fit: by themselves or by their logarithms, and between which bounds.

use crate::bodies::{extent, mass_of, turns};
use jointscope_fixture::{BodyKind, Effect, Fixture, Motion, ParameterSpec, Place, Possible, Quantity};
use jointscope_inference::{Parameter, Transform};

/// A positive quantity that moves by its logarithm, between bounds of that.
fn logarithm(low: f64, high: f64) -> Parameter {
    Parameter::new(Transform::Logarithmic { centre: 1.0, scale: 1.0 }).between(low, high)
}

/// A quantity that moves in units of `scale`, between bounds of its value.
fn between(scale: f64, low: f64, high: f64) -> Parameter {
    Parameter::new(Transform::Linear { centre: 0.0, scale }).between(low / scale, high / scale)
}

/// How a fit moves each of an effect's parameters, in their order; the value of a quantity that is `wrong` as that quantity moves.
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
            between(0.1 * (high - low).max(1e-6), low, high)
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
        Motion::OfQuantity => wrong,
        Motion::Logarithm { reach } => {
            let start = quantity.value.max(f64::MIN_POSITIVE).ln();
            // What hangs on a body is lighter than the body.
            let most = match (parameter.possible, body) {
                (Possible::MassOfBody, Some(body)) => mass_of(fixture, body).ln(),
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

/// Share of a joint's length that may be missing.
const MISSING: f64 = 0.95;
/// Share of a beam's mass that may be missing at one place: a hole that takes more is no point, and takes stiffness with it.
const HOLE: f64 = 0.1;
/// Masses of the whole structure that may be added.
const ADDED: f64 = 2.0;

/// Share of a bar's length by which a body of the bar's mass and inertia is longer at either end if half of its mass is in its middle.
const LONGER: f64 = 0.5 * (std::f64::consts::SQRT_2 - 1.0);

/// The most that a body may lack at one place, kg: a block all of it, a beam a hole and the heaviest of the masses that sit on it.
fn most_missing(fixture: &Fixture, body: usize) -> f64 {
    let mass = mass_of(fixture, body);
    match &fixture.bodies()[body].kind {
        BodyKind::Rigid(_) => mass,
        BodyKind::Beam(_) => {
            let on_it = fixture.bodies()[body].masses.iter().map(|point| point.mass.value);
            HOLE * mass + on_it.fold(0.0, f64::max)
        }
    }
}

/// Between which values a parameter of either sign is possible at a place.
fn possible(possible: Possible, fixture: &Fixture, place: &Place) -> (f64, f64) {
    let any = (f64::NEG_INFINITY, f64::INFINITY);
    match (possible, place) {
        (Possible::MassOfBody, Place::Body(name)) => {
            let masses = || (0..fixture.bodies().len()).map(|body| mass_of(fixture, body));
            let own = fixture.bodies().iter().position(|body| body.name == *name);
            let own = own.map_or(0.0, |body| most_missing(fixture, body));
            (-own, ADDED * masses().sum::<f64>())
        }
        (Possible::OnBody, Place::Point(name)) => fixture.point(name).map_or(any, |point| {
            let (low, high) = extent(fixture, point.body);
            let beyond = match &fixture.bodies()[point.body].kind {
                BodyKind::Rigid(_) => LONGER * (high - low),
                BodyKind::Beam(_) => 0.0,
            };
            (low - beyond - point.x.value, high + beyond - point.x.value)
        }),
        (Possible::LengthOfJoint, Place::Joint(name)) => {
            let joint = fixture.joints().iter().find(|joint| joint.name == *name);
            joint.map_or(any, |joint| (-MISSING * fixture.joint_length(joint), f64::INFINITY))
        }
        _ => any,
    }
}
