//! How the parameters of an effect move in a fit: by themselves or by their logarithms, and between which bounds.

use jointscope_fixture::{BodyKind, Effect, EffectKind, Fixture, ParameterRange, ParameterSpec, Place};

/// A parameter of an effect that a fit may move, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Freedom {
    /// Positive: moved by its logarithm, between bounds.
    Logarithm { low: f64, high: f64 },
    /// Moved as it is, in units of the scale, between bounds.
    Linear { scale: f64, low: f64, high: f64 },
    /// Stays.
    Fixed,
}

impl Freedom {
    /// The coordinate of `value`; nothing where it stays.
    pub fn coordinate(&self, value: f64) -> Option<f64> {
        match self {
            Freedom::Logarithm { .. } => Some(value.max(f64::MIN_POSITIVE).ln()),
            Freedom::Linear { scale, .. } => Some(value / scale),
            Freedom::Fixed => None,
        }
    }

    /// The value at `coordinate`; nothing where it stays.
    pub fn value(&self, coordinate: f64) -> Option<f64> {
        match self {
            Freedom::Logarithm { .. } => Some(coordinate.exp()),
            Freedom::Linear { scale, .. } => Some(coordinate * scale),
            Freedom::Fixed => None,
        }
    }
}

/// How far a logarithm may move from its start.
const REACH: f64 = 9.0;

/// The freedom of each of an effect's parameters, in their order.
pub(crate) fn freedoms(fixture: &Fixture, effect: &Effect) -> Vec<Freedom> {
    let spec = effect.kind.spec();
    let body = match &effect.place {
        Place::Body(name) => fixture.bodies().iter().position(|b| b.name == *name),
        _ => None,
    };
    let turns = |body: usize| match &fixture.bodies()[body].kind {
        BodyKind::Rigid(rigid) => rigid.rotates,
        BodyKind::Beam(_) => true,
    };
    let linear = |scale: f64| Freedom::Linear { scale, low: f64::NEG_INFINITY, high: f64::INFINITY };
    let not_negative = |scale: f64| Freedom::Linear { scale, low: 0.0, high: f64::INFINITY };
    let of = |(index, parameter): (usize, &ParameterSpec)| {
        let value = effect.value(index);
        match (effect.kind, parameter.name) {
            (_, "x") => match body.filter(|b| turns(*b)) {
                Some(body) => {
                    let (low, high) = extent(fixture, body);
                    Freedom::Linear { scale: 0.1 * (high - low).max(1e-6), low, high }
                }
                None => Freedom::Fixed,
            },
            // Below the band a resonator is a support, above it a mass: it must resonate near where it set out.
            (EffectKind::AttachedResonator, "frequency") => {
                Freedom::Logarithm { low: value.ln() - 0.35, high: value.ln() + 0.35 }
            }
            (EffectKind::AddedMass | EffectKind::SensorMass, "mass") => linear(value.abs().max(1e-6)),
            (EffectKind::JointMass, "mass") => not_negative(value.abs().max(1e-6)),
            (_, "dx") => linear(1e-3),
            (_, "seconds") => linear(1e-5),
            (EffectKind::ChannelGain, "factor") => linear(0.1),
            (_, "rotary_inertia") if !matches!(effect.place, Place::Body(_)) => Freedom::Fixed,
            (_, "rotary_inertia") => not_negative(value.max(1e-9)),
            (EffectKind::LossFactor, _) => not_negative(0.01),
            (EffectKind::ExponentialWindow, _) => not_negative(1.0),
            (EffectKind::Relaxation, "ratio") => not_negative(0.1),
            // Zero is a dashpot or a ratio too: linear, bounded, in units of what would be felt.
            (_, "damping" | "damping_ratio") => not_negative(value.max(1e-9)),
            _ if parameter.range == ParameterRange::Positive => {
                // Four decades about the start: beyond them an effect is another one, or none.
                let centre = value.max(f64::MIN_POSITIVE).ln();
                Freedom::Logarithm { low: centre - REACH, high: centre + REACH }
            }
            _ => not_negative(value.abs().max(1e-9)),
        }
    };
    spec.parameters.iter().enumerate().map(of).collect()
}

/// Abscissae between which something may sit on a body: a bar of its mass and inertia, and its points.
pub(crate) fn extent(fixture: &Fixture, body: usize) -> (f64, f64) {
    let points = fixture.points().iter().filter(|p| p.body == body).map(|p| p.x.value);
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    match &fixture.bodies()[body].kind {
        BodyKind::Beam(beam) => (beam.from.value, beam.to.value),
        BodyKind::Rigid(rigid) => match (rigid.rotates, rigid.x_cg, rigid.inertia) {
            (true, Some(x_cg), Some(inertia)) => {
                let half = (3.0 * inertia.value / rigid.mass.value).sqrt();
                (low.min(x_cg.value - half), high.max(x_cg.value + half))
            }
            _ => (low.min(0.0), high.max(0.0)),
        },
    }
}
