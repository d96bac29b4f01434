//! Accelerations of rigid bodies from sensors, and from the balance of momentum where sensors do not suffice.

use super::sides::free;
use crate::settings::map::DETERMINED;
use crate::spectra::Windowed;
use crate::time::structure::{abscissa_m, effects};
use jointscope_fixture::{BodyKind, Dof, EffectKind, Fixture, Place, Quantity, Side};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_linalg::Cholesky;
use num_complex::Complex64;
use serde::Serialize;

/// Where a body's motion is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
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
    let value = |q: &Option<Quantity>| q.as_ref().map_or(0.0, |q| q.value);
    let mut parts = vec![(rigid.mass.value, value(&rigid.x_cg), value(&rigid.inertia))];
    parts.extend(body.masses.iter().map(|m| (m.mass.value, m.x.value, 0.0)));
    let added = effects(fixture, EffectKind::AddedMass, Place::Body(body.name.clone()));
    parts.extend(added.map(|e| (e.value(1), e.value(0), e.inertia_about_axis())));
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

/// One equation: Σ coefficient·unknown = lines. Unknown 2b is the acceleration of body b's centre of gravity,
/// 2b + 1 the angular one times the length scale.
struct Equation {
    coefficients: Vec<f64>,
    value: Vec<Complex64>,
}

/// Accelerations of every body that sensors, or sensors and momentum, determine.
pub(super) fn measured(
    fixture: &Fixture,
    hit: &Hit,
    lines: &Windowed,
) -> Vec<Option<(MotionSource, BodyMotion)>> {
    let count = fixture.bodies().len();
    let bodies: Vec<Option<Inertia>> = (0..count).map(|index| inertia(fixture, index)).collect();
    let scale = extent(fixture);
    let readings = readings(fixture, hit, lines, &bodies, scale);
    let unknowns = |index: usize| match bodies[index] {
        Some(Inertia { rotates: true, .. }) => vec![2 * index, 2 * index + 1],
        Some(_) => vec![2 * index],
        None => Vec::new(),
    };
    let own = |index: usize| {
        let own = readings.iter().filter(|(body, _)| *body == index).map(|(_, equation)| equation);
        let motion = solved(&own.collect::<Vec<_>>(), &unknowns(index), scale)?;
        Some((MotionSource::Sensors, motion.into_iter().next()?))
    };
    let mut found: Vec<Option<(MotionSource, BodyMotion)>> = (0..count).map(own).collect();
    let all: Vec<usize> = (0..count).collect();
    if let Some(whole) = bodies.iter().copied().collect::<Option<Vec<Inertia>>>()
        && found.iter().any(Option::is_none)
        && free(fixture, &all)
    {
        let momentum = momentum(fixture, hit, lines, &whole, scale);
        let equations: Vec<&Equation> = readings.iter().map(|(_, e)| e).chain(&momentum).collect();
        let unknowns: Vec<usize> = all.into_iter().flat_map(unknowns).collect();
        for (found, motion) in found.iter_mut().zip(solved(&equations, &unknowns, scale).unwrap_or_default())
        {
            found.get_or_insert((MotionSource::Momentum, motion));
        }
    }
    found
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
    lines: &Windowed,
    bodies: &[Option<Inertia>],
    scale: f64,
) -> Vec<(usize, Equation)> {
    let reading = |response: &Response| {
        let point = fixture.point(&response.channel.point)?;
        let body = bodies[point.body].filter(|b| b.rotates || response.channel.dof == Dof::Translation)?;
        let mut coefficients = vec![0.0; 2 * bodies.len()];
        let mut factor = 1.0;
        match response.channel.dof {
            Dof::Translation => {
                coefficients[2 * point.body] = 1.0;
                coefficients[2 * point.body + 1] =
                    (abscissa_m(fixture, point, Side::Response) - body.x_cg) / scale;
            }
            Dof::Rotation => {
                coefficients[2 * point.body + 1] = 1.0;
                factor = scale;
            }
        }
        let rates = match response.motion {
            MeasuredMotion::Acceleration => 0,
            MeasuredMotion::Velocity => 1,
            MeasuredMotion::Displacement => 2,
        };
        let mut value = lines.lines(&response.values);
        value.iter_mut().enumerate().for_each(|(line, v)| *v *= lines.s(line).powi(rates) * factor);
        Some((point.body, Equation { coefficients, value }))
    };
    hit.responses().iter().filter_map(reading).collect()
}

/// Balance of force and, where every body rotates, of moment about x = 0, of a free assembly; divided by its
/// mass and the length scale.
fn momentum(fixture: &Fixture, hit: &Hit, lines: &Windowed, bodies: &[Inertia], scale: f64) -> Vec<Equation> {
    let mass: f64 = bodies.iter().map(|b| b.mass).sum();
    let load = lines.lines(hit.force());
    let [force, moment] = applied(fixture, hit, 0.0);
    let equation = |factor: f64, coefficients: &dyn Fn(&Inertia) -> [f64; 2]| Equation {
        coefficients: bodies.iter().flat_map(coefficients).collect(),
        value: load.iter().map(|f| f * factor).collect(),
    };
    let mut all = vec![equation(force / mass, &|b| [b.mass / mass, 0.0])];
    if bodies.iter().all(|b| b.rotates) {
        let own = |b: &Inertia| [b.mass * b.x_cg / (mass * scale), b.inertia / (mass * scale * scale)];
        all.push(equation(moment / (mass * scale), &own));
    }
    all
}

/// Force and moment about `x` that one unit of the hammer's signal applies.
pub(super) fn applied(fixture: &Fixture, hit: &Hit, x: f64) -> [f64; 2] {
    let at =
        fixture.point(&hit.struck().point).map_or(0.0, |point| abscissa_m(fixture, point, Side::Reference));
    match hit.struck().dof {
        Dof::Translation => [1.0, at - x],
        Dof::Rotation => [0.0, 1.0],
    }
}

/// Least squares of the equations for `unknowns`, a motion a body; `None` where they do not determine them.
fn solved(equations: &[&Equation], unknowns: &[usize], scale: f64) -> Option<Vec<BodyMotion>> {
    let n = unknowns.len();
    if n == 0 || equations.len() < n {
        return None;
    }
    let factor = |equation: &Equation, i: usize| equation.coefficients[unknowns[i]];
    let product = |k: usize| equations.iter().map(|e| factor(e, k / n) * factor(e, k % n)).sum();
    let normal: Vec<f64> = (0..n * n).map(product).collect();
    let inverse = Cholesky::of(n, &normal)?.inverse();
    let norm = |m: &[f64]| m.iter().map(|v| v * v).sum::<f64>().sqrt();
    let condition = norm(&normal) * norm(&inverse);
    if !condition.is_finite() || condition >= DETERMINED {
        return None;
    }
    // Row i of the pseudo-inverse, applied to the lines.
    let solution = |i: usize| {
        let mut all = vec![Complex64::ZERO; equations[0].value.len()];
        for equation in equations {
            let weight: f64 = (0..n).map(|j| inverse[i * n + j] * factor(equation, j)).sum();
            all.iter_mut().zip(&equation.value).for_each(|(to, v)| *to += v * weight);
        }
        all
    };
    let mut motions: Vec<BodyMotion> = Vec::new();
    for (i, unknown) in unknowns.iter().enumerate() {
        match (unknown % 2, motions.last_mut()) {
            (1, Some(last)) => last[1] = solution(i).iter().map(|v| v / scale).collect(),
            _ => motions.push([solution(i), vec![Complex64::ZERO; equations[0].value.len()]]),
        }
    }
    Some(motions)
}
