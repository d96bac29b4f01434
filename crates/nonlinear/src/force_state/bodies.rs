//! Accelerations of rigid bodies from sensors, and from the balance of momentum where sensors do not suffice.

use super::sides::{abscissa, free};
use super::signals::Lines;
use jointscope_fixture::{BodyKind, Dof, EffectKind, Fixture, Place};
use jointscope_hits::{Hit, Motion};
use jointscope_linalg::inverse;
use num_complex::Complex64;

/// Where a body's motion is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionSource {
    /// Its own sensors.
    Sensors,
    /// The balance of momentum of the free assembly, from the hammer's force and the sensors on other bodies.
    Momentum,
    /// The fitted fixture, simulated: sensors do not determine it.
    Model,
}

/// Mass properties of a rigid body, point masses on it included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inertia {
    pub mass: f64,
    /// About the centre of gravity, kg·m².
    pub inertia: f64,
    pub x_cg: f64,
    pub rotates: bool,
}

/// Mass properties of body `index`; `None` for a deformable one.
pub(super) fn inertia(fixture: &Fixture, index: usize) -> Option<Inertia> {
    let body = &fixture.bodies()[index];
    let BodyKind::Rigid(rigid) = &body.kind else { return None };
    let value = |q: &Option<jointscope_fixture::Quantity>| q.as_ref().map_or(0.0, |q| q.value);
    let mut parts = vec![(rigid.mass.value, value(&rigid.x_cg), value(&rigid.inertia))];
    parts.extend(body.masses.iter().map(|m| (m.mass.value, m.x.value, 0.0)));
    let added = fixture.physics().iter().filter(|e| {
        e.kind == EffectKind::AddedMass && matches!(&e.place, Place::Body(name) if *name == body.name)
    });
    parts.extend(added.map(|e| (e.value(1), e.value(0), 0.0)));
    let mass: f64 = parts.iter().map(|p| p.0).sum();
    let x_cg = match rigid.rotates {
        true => parts.iter().map(|p| p.0 * p.1).sum::<f64>() / mass,
        false => value(&rigid.x_cg),
    };
    let inertia = parts.iter().map(|p| p.2 + p.0 * (p.1 - x_cg).powi(2)).sum();
    Some(Inertia { mass, inertia, x_cg, rotates: rigid.rotates })
}

/// Lines of a body's acceleration: of its centre of gravity, and angular.
pub(super) type BodyMotion = [Vec<Complex64>; 2];

/// One equation: Σ coefficient·unknown = lines.
struct Equation {
    coefficients: Vec<(usize, f64)>,
    value: Vec<Complex64>,
}

/// Accelerations of every body that sensors, or sensors and momentum, determine.
pub(super) fn measured(
    fixture: &Fixture,
    hit: &Hit,
    lines: &Lines,
) -> Vec<Option<(MotionSource, BodyMotion)>> {
    let count = fixture.bodies().len();
    let bodies: Vec<Option<Inertia>> = (0..count).map(|index| inertia(fixture, index)).collect();
    let scale = extent(fixture);
    let readings = readings(fixture, hit, lines, &bodies, scale);
    let mut found: Vec<Option<(MotionSource, BodyMotion)>> = (0..count)
        .map(|index| {
            let own = readings.iter().filter(|(body, _)| *body == index).map(|(_, e)| e);
            let unknowns = unknowns(&bodies, index);
            let motion = solved(&own.collect::<Vec<_>>(), &unknowns, scale)?;
            Some((MotionSource::Sensors, motion.into_iter().next()?))
        })
        .collect();
    let whole: Option<Vec<Inertia>> = bodies.iter().copied().collect();
    let all: Vec<usize> = (0..count).collect();
    if let Some(whole) = whole
        && found.iter().any(Option::is_none)
        && free(fixture, &all)
    {
        let momentum = momentum(fixture, hit, lines, &whole, scale);
        let equations: Vec<&Equation> = readings.iter().map(|(_, e)| e).chain(&momentum).collect();
        let unknowns: Vec<usize> = all.iter().flat_map(|&i| unknowns(&bodies, i)).collect();
        if let Some(motions) = solved(&equations, &unknowns, scale) {
            for (found, motion) in found.iter_mut().zip(motions) {
                found.get_or_insert((MotionSource::Momentum, motion));
            }
        }
    }
    found
}

/// Unknown 2b is the acceleration of body b's centre of gravity, 2b + 1 the angular one times the length scale.
fn unknowns(bodies: &[Option<Inertia>], body: usize) -> Vec<usize> {
    match bodies[body] {
        Some(Inertia { rotates: true, .. }) => vec![2 * body, 2 * body + 1],
        Some(_) => vec![2 * body],
        None => Vec::new(),
    }
}

/// Length by which angular motion compares with transverse, m.
fn extent(fixture: &Fixture) -> f64 {
    let x = || fixture.points().iter().map(|p| p.x.value);
    let extent = x().fold(f64::NEG_INFINITY, f64::max) - x().fold(f64::INFINITY, f64::min);
    if extent.is_finite() && extent > 0.0 { extent } else { 1.0 }
}

fn readings(
    fixture: &Fixture,
    hit: &Hit,
    lines: &Lines,
    bodies: &[Option<Inertia>],
    scale: f64,
) -> Vec<(usize, Equation)> {
    let mut all = Vec::new();
    for response in hit.responses() {
        let Some(point) = fixture.point(&response.channel.point) else { continue };
        let Some(body) = bodies[point.body] else { continue };
        let mut value = lines.of(&response.values);
        let rates = match response.motion {
            Motion::Acceleration => 0,
            Motion::Velocity => 1,
            Motion::Displacement => 2,
        };
        value.iter_mut().enumerate().for_each(|(line, v)| *v *= lines.s(line).powi(rates));
        let (first, arm) = (2 * point.body, (abscissa(fixture, point) - body.x_cg) / scale);
        let coefficients = match (response.channel.dof, body.rotates) {
            (Dof::Translation, true) => vec![(first, 1.0), (first + 1, arm)],
            (Dof::Translation, false) => vec![(first, 1.0)],
            (Dof::Rotation, true) => {
                value.iter_mut().for_each(|v| *v *= scale);
                vec![(first + 1, 1.0)]
            }
            (Dof::Rotation, false) => continue,
        };
        all.push((point.body, Equation { coefficients, value }));
    }
    all
}

/// Balance of force and, where every body rotates, of moment about x = 0, of a free assembly; divided by its mass and the length scale.
fn momentum(fixture: &Fixture, hit: &Hit, lines: &Lines, bodies: &[Inertia], scale: f64) -> Vec<Equation> {
    let mass: f64 = bodies.iter().map(|b| b.mass).sum();
    let load = lines.of(hit.force());
    let [force, moment] = applied(fixture, hit, 0.0);
    let per = |factor: f64| load.iter().map(|f| f * factor).collect::<Vec<_>>();
    let forces = bodies.iter().enumerate().map(|(i, b)| (2 * i, b.mass / mass));
    let mut all = vec![Equation { coefficients: forces.collect(), value: per(force / mass) }];
    if bodies.iter().all(|b| b.rotates) {
        let moments = bodies.iter().enumerate().flat_map(|(i, b)| {
            let own = b.inertia / (mass * scale * scale);
            [(2 * i, b.mass * b.x_cg / (mass * scale)), (2 * i + 1, own)]
        });
        all.push(Equation { coefficients: moments.collect(), value: per(moment / (mass * scale)) });
    }
    all
}

/// Force and moment about `x` that one unit of the hammer's signal applies.
pub(super) fn applied(fixture: &Fixture, hit: &Hit, x: f64) -> [f64; 2] {
    let at = fixture.point(&hit.struck().point).map_or(0.0, |point| abscissa(fixture, point));
    match hit.struck().dof {
        Dof::Translation => [1.0, at - x],
        Dof::Rotation => [0.0, 1.0],
    }
}

/// Largest condition number, squared, of equations that determine their unknowns.
const DETERMINED: f64 = 1e7;

/// Least squares of the equations for `unknowns`, a motion a body; `None` where they do not determine them.
fn solved(equations: &[&Equation], unknowns: &[usize], scale: f64) -> Option<Vec<BodyMotion>> {
    let n = unknowns.len();
    if n == 0 || equations.len() < n {
        return None;
    }
    let mut normal = vec![0.0; n * n];
    let length = equations.first()?.value.len();
    let mut right = vec![vec![Complex64::ZERO; length]; n];
    let place = |unknown: usize| unknowns.iter().position(|u| *u == unknown);
    for equation in equations {
        for (a, factor) in &equation.coefficients {
            let i = place(*a)?;
            for (b, other) in &equation.coefficients {
                normal[i * n + place(*b)?] += factor * other;
            }
            right[i].iter_mut().zip(&equation.value).for_each(|(to, v)| *to += v * *factor);
        }
    }
    let inverse = inverse(&normal, n)?;
    let norm = |m: &[f64]| m.iter().map(|v| v * v).sum::<f64>().sqrt();
    let condition = norm(&normal) * norm(&inverse);
    if !condition.is_finite() || condition >= DETERMINED {
        return None;
    }
    let solution = |i: usize| {
        let mut all = vec![Complex64::ZERO; length];
        for (factor, right) in inverse[i * n..(i + 1) * n].iter().zip(&right) {
            all.iter_mut().zip(right).for_each(|(to, v)| *to += v * *factor);
        }
        all
    };
    let mut motions: Vec<BodyMotion> = Vec::new();
    for (i, unknown) in unknowns.iter().enumerate() {
        match (unknown % 2, motions.last_mut()) {
            (1, Some(last)) => last[1] = solution(i).iter().map(|v| v / scale).collect(),
            _ => motions.push([solution(i), vec![Complex64::ZERO; length]]),
        }
    }
    Some(motions)
}
