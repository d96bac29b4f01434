//! Random physics outside the vocabulary: one function draws place and size of each kind, `None` where the
//! fixture or the recording has no place for it.

use super::Outside;
use crate::random::{choice, log_uniform, sign, uniform};
use jointscope_fixture::{Body, BodyKind, Fixture, Joint, JointLaw};
use jointscope_spectra::FrfPair;
use rand::Rng;
use std::f64::consts::TAU;

/// The kinds that [`Outside::draw`] counts, in their order: what a seed stands for must not change when a
/// kind is added.
const COUNTED: [&str; 5] = ["inerter", "drift", "bypass", "gyroscope", "springpot"];

impl Outside {
    /// Number of kinds that [`Outside::draw`] counts.
    pub const KINDS: usize = COUNTED.len();
    /// Kinds that no effect of a fixture file is: those of [`Outside::draw`] but a bypass and a springpot,
    /// which files have names for, and more.
    pub const UNLISTED: [&str; 8] = [
        "cross_axis",
        "inerter",
        "clock_error",
        "second_bending",
        "cable",
        "drift",
        "base_motion",
        "gyroscope",
    ];

    /// A random one of kind `kind` (counted modulo [`Outside::KINDS`]); `None` where the fixture has no place
    /// for it or `recorded` has one reference only. Whether it shows is for the caller to judge: sizes run
    /// over two decades.
    pub fn draw(rng: &mut impl Rng, fixture: &Fixture, kind: usize, recorded: &[FrfPair]) -> Option<Self> {
        Self::draw_kind(rng, fixture, COUNTED[kind % COUNTED.len()], recorded)
    }

    /// A random one of the kind of this name; `None` as of [`Outside::draw`], and of a kind that there is
    /// not.
    pub fn draw_kind(
        rng: &mut impl Rng,
        fixture: &Fixture,
        kind: &str,
        recorded: &[FrfPair],
    ) -> Option<Self> {
        // Whatever the kind, a joint is drawn: what a seed stands for must not change.
        let joint = choice(rng, fixture.joints())?;
        match kind {
            "inerter" => Some(inerter(rng, fixture, joint)),
            "drift" => drift(rng, joint, recorded),
            "bypass" => bypass(rng, fixture, joint),
            "gyroscope" => gyroscope(rng, fixture),
            "springpot" => Some(springpot(rng, fixture, joint)),
            "cross_axis" => cross_axis(rng, recorded),
            "second_bending" => second_bending(rng, fixture),
            "cable" => cable(rng, fixture),
            "clock_error" => clock_error(rng, recorded),
            "base_motion" => base_motion(rng, fixture),
            _ => None,
        }
    }
}

fn inerter(rng: &mut impl Rng, fixture: &Fixture, joint: &Joint) -> Outside {
    let masses = fixture.bodies().iter().map(|body| body.kind.mass());
    let lightest = masses.fold(f64::INFINITY, f64::min);
    Outside::Inerter { joint: joint.name.clone(), inertance: lightest * log_uniform(rng, 0.003, 0.3) }
}

fn drift(rng: &mut impl Rng, joint: &Joint, recorded: &[FrfPair]) -> Option<Outside> {
    let last = &recorded.last()?.reference;
    if recorded.iter().all(|pair| pair.reference == *last) {
        return None;
    }
    let factor = (sign(rng) * log_uniform(rng, 0.005, 0.2)).exp();
    Some(Outside::Drift { joint: joint.name.clone(), reference: last.point.clone(), factor })
}

fn bypass(rng: &mut impl Rng, fixture: &Fixture, joint: &Joint) -> Option<Outside> {
    let points = fixture.points();
    Some(Outside::Bypass {
        from: points.first()?.name.clone(),
        to: points.last()?.name.clone(),
        stiffness: transverse_stiffness(fixture, joint) * log_uniform(rng, 0.0003, 0.1),
    })
}

fn gyroscope(rng: &mut impl Rng, fixture: &Fixture) -> Option<Outside> {
    let turning: Vec<_> =
        fixture.points().iter().filter(|p| fixture.bodies()[p.body].kind.rotates()).collect();
    let point = choice(rng, &turning)?;
    let arm = 0.03 * fixture.bodies()[point.body].kind.mass();
    let coupling = sign(rng) * arm * TAU * log_uniform(rng, 3.0, 100.0);
    Some(Outside::Gyroscope { point: point.name.clone(), coupling })
}

fn springpot(rng: &mut impl Rng, fixture: &Fixture, joint: &Joint) -> Outside {
    Outside::Springpot {
        joint: joint.name.clone(),
        stiffness: transverse_stiffness(fixture, joint) * log_uniform(rng, 0.003, 0.3),
        order: uniform(rng, 0.25, 0.75),
    }
}

fn cross_axis(rng: &mut impl Rng, recorded: &[FrfPair]) -> Option<Outside> {
    Some(Outside::CrossAxis {
        response: choice(rng, recorded)?.response.point.clone(),
        coupling: sign(rng) * log_uniform(rng, 3e-4, 0.1),
        ratio: (sign(rng) * log_uniform(rng, 0.3, 3.0)).exp(),
    })
}

fn second_bending(rng: &mut impl Rng, fixture: &Fixture) -> Option<Outside> {
    let is_block = |body: &&Body| matches!(body.kind, BodyKind::Rigid(_)) && body.kind.rotates();
    let blocks: Vec<&Body> = fixture.bodies().iter().filter(is_block).collect();
    Some(Outside::SecondBending {
        body: choice(rng, &blocks)?.name.clone(),
        frequency: log_uniform(rng, 700.0, 15e3),
        damping_ratio: log_uniform(rng, 0.002, 0.01),
    })
}

fn cable(rng: &mut impl Rng, fixture: &Fixture) -> Option<Outside> {
    let on = choice(rng, fixture.points())?;
    let body = &fixture.bodies()[on.body];
    Some(Outside::Cable {
        body: body.name.clone(),
        x: on.x.value,
        mass: body.kind.mass() * log_uniform(rng, 3e-4, 0.03),
        frequency: log_uniform(rng, 15.0, 250.0),
        damping_ratio: log_uniform(rng, 0.01, 0.05),
    })
}

fn clock_error(rng: &mut impl Rng, recorded: &[FrfPair]) -> Option<Outside> {
    Some(Outside::ClockError {
        response: choice(rng, recorded)?.response.point.clone(),
        rate: sign(rng) * log_uniform(rng, 1e-6, 3e-3),
    })
}

fn base_motion(rng: &mut impl Rng, fixture: &Fixture) -> Option<Outside> {
    fixture.supports().first()?;
    let whole: f64 = fixture.bodies().iter().map(|body| body.kind.mass()).sum();
    Some(Outside::BaseMotion {
        mass: whole * log_uniform(rng, 1.0, 100.0),
        frequency: log_uniform(rng, 3.0, 50.0),
        damping_ratio: log_uniform(rng, 0.01, 0.1),
    })
}

/// Transverse stiffness of a joint at its far end, its rotation held, N/m.
fn transverse_stiffness(fixture: &Fixture, joint: &Joint) -> f64 {
    match &joint.law {
        JointLaw::Stiffness { stiffness, .. } => stiffness[0].value,
        JointLaw::Beam { youngs_modulus, second_moment } => {
            12.0 * youngs_modulus.value * second_moment.value / fixture.joint_length(joint).powi(3)
        }
    }
}
