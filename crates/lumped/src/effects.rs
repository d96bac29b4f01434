//! What each effect does to the model: the one place that knows.

use crate::Station;
use crate::point_law::PointLaw;
use crate::term_station::TermStation;
use jointscope_fixture::{Dof, Effect, EffectKind as Kind, Fixture, Joint, Place};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// What an effect does.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Action<'a> {
    /// A dynamic stiffness through one motion.
    Through { motion: TermStation, law: PointLaw },
    /// A block gets its first free-free bending mode as a coordinate.
    Bending { body: usize, omega: f64, ratio: f64 },
    /// A beam body changes as a whole: its matrices are built again.
    OnBeam { body: usize, change: Change },
    /// A joint changes.
    OnJoint { joint: usize, change: Change },
    /// Channels at the place sit `dx` further along x.
    Offset { place: &'a Place, dx: f64 },
    /// A channel's signal is multiplied by `gain` and late by `delay`, s.
    Signal { channel: &'a Place, gain: f64, delay: f64 },
    /// A channel's signal passes a filter.
    Filtered { channel: &'a Place, filter: SignalFilter },
    /// A mass sits at the response while it is measured.
    SensorLoad { response: &'a Place, mass: f64 },
    /// Responses were multiplied by e^{−decay·t}.
    Window { decay: f64 },
    /// A force that depends on the amplitude, over time only.
    Amplitude,
}

/// A filter over frequency on a channel's signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SignalFilter {
    /// s/(s + ω_c): AC coupling. ω_c in rad/s.
    HighPass(f64),
    /// ω₀²/(s² + 2ζω₀s + ω₀²): a sensor on its mounting, with ω₀ in rad/s and ζ.
    Resonance(f64, f64),
}

impl SignalFilter {
    /// Its value at s; one where it is no filter at all.
    pub(crate) fn at(self, s: Complex64) -> Complex64 {
        match self {
            SignalFilter::HighPass(0.0) => Complex64::ONE,
            SignalFilter::HighPass(corner) => s / (s + corner),
            SignalFilter::Resonance(omega, ratio) => {
                let stiffness = omega * omega;
                stiffness / (s * s + s * (2.0 * ratio * omega) + stiffness)
            }
        }
    }
}

/// What changes in a joint or a beam body.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Change {
    /// The elastic stiffness by this factor.
    Factor(f64),
    /// The elastic stiffness by iη more.
    Loss(f64),
    /// The elastic stiffness by ratio·sτ/(1 + sτ) more.
    Relaxation { ratio: f64, time: f64 },
    /// Shear gives way too: κGA, N, and ρI, kg·m.
    Shear { stiffness: f64, rotary_inertia: f64 },
    /// Mass of its own, spread evenly.
    Mass(f64),
    /// The free length by dx more.
    Length(f64),
    /// A spring and dashpot in series with one end.
    Interface(Interface),
}

/// A spring and dashpot in series with one end of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interface {
    pub at_far_end: bool,
    pub dof: Dof,
    pub stiffness: f64,
    pub damping: f64,
    /// Zero where it turns at the joint's very end, one where it yields all along the foot of a joint that
    /// bends.
    pub spread: f64,
}

/// What the effects of a fixture do, in the order of its file.
pub(crate) fn actions(fixture: &Fixture) -> impl Iterator<Item = Action<'_>> {
    fixture
        .effects()
        .flat_map(|effect| match effect.kind {
            Kind::Footing => footing(fixture, effect),
            Kind::AddedMass => [action(fixture, effect), back_and_forth(fixture, effect)],
            _ => [action(fixture, effect), None],
        })
        .flatten()
}

/// Both ends of a joint turn on springs of one size.
fn footing<'a>(fixture: &'a Fixture, effect: &'a Effect) -> [Option<Action<'a>>; 2] {
    let (stiffness, damping) = (effect.value(0), effect.value(1));
    [false, true].map(|at_far_end| {
        let interface = Interface { at_far_end, dof: Dof::Rotation, stiffness, damping, spread: 0.0 };
        let joint = joint_of(fixture, &effect.place)?;
        Some(Action::OnJoint { joint, change: Change::Interface(interface) })
    })
}

/// A mass at a height above its body's axis goes back and forth along x as the body turns.
fn back_and_forth<'a>(fixture: &'a Fixture, effect: &'a Effect) -> Option<Action<'a>> {
    let inertia = effect.inertia_about_axis();
    let turns = |body: &usize| inertia != 0.0 && fixture.bodies()[*body].kind.rotates();
    let body = body_of(fixture, &effect.place).filter(turns)?;
    let station = Station { body, x: effect.value(0), dof: Dof::Rotation };
    Some(Action::Through { motion: TermStation::single(station), law: PointLaw::Mass(inertia) })
}

/// What an effect does; `None` where its place does not exist.
pub(crate) fn action<'a>(fixture: &'a Fixture, effect: &'a Effect) -> Option<Action<'a>> {
    let value = |index: usize| effect.value(index);
    let on_body = |law: PointLaw| {
        let body = body_of(fixture, &effect.place)?;
        let station = Station { body, x: value(0), dof: effect.dof.unwrap_or(Dof::Translation) };
        Some(Action::Through { motion: TermStation::single(station), law })
    };
    let on_joint = |law: PointLaw| {
        let joint = &fixture.joints()[joint_of(fixture, &effect.place)?];
        let [deflection, rotation] = relative_motion(fixture, joint);
        let motion = if effect.dof == Some(Dof::Rotation) { rotation } else { deflection };
        Some(Action::Through { motion, law })
    };
    let changed = |change: Change| match joint_of(fixture, &effect.place) {
        Some(joint) => Some(Action::OnJoint { joint, change }),
        None => Some(Action::OnBeam { body: body_of(fixture, &effect.place)?, change }),
    };
    let filtered = |filter: SignalFilter| Some(Action::Filtered { channel: &effect.place, filter });
    match effect.kind {
        Kind::AddedMass => on_body(PointLaw::Mass(value(1))),
        Kind::Support => on_body(PointLaw::Spring { stiffness: value(1), damping: value(2) }),
        Kind::AttachedResonator => {
            on_body(PointLaw::Resonator { mass: value(1), omega: TAU * value(2), ratio: value(3) })
        }
        Kind::BodyFlexibility => {
            let body = body_of(fixture, &effect.place)?;
            Some(Action::Bending { body, omega: TAU * value(0), ratio: value(1) })
        }
        Kind::InterfaceCompliance => interface(fixture, effect),
        Kind::ShearDeformation => changed(Change::Shear { stiffness: value(0), rotary_inertia: value(1) }),
        Kind::JointMass => changed(Change::Mass(value(0))),
        Kind::StiffnessChange => changed(Change::Factor(value(0))),
        Kind::LossFactor => changed(Change::Loss(value(0))),
        Kind::Relaxation => changed(Change::Relaxation { ratio: value(0), time: value(1) }),
        Kind::JointLength => changed(Change::Length(value(0))),
        Kind::PointOffset => Some(Action::Offset { place: &effect.place, dx: value(0) }),
        Kind::ChannelGain => Some(Action::Signal { channel: &effect.place, gain: value(0), delay: 0.0 }),
        Kind::ChannelDelay => Some(Action::Signal { channel: &effect.place, gain: 1.0, delay: value(0) }),
        Kind::SensorMass => Some(Action::SensorLoad { response: &effect.place, mass: value(0) }),
        Kind::ExponentialWindow => Some(Action::Window { decay: value(0) }),
        Kind::ParallelStiffness => on_joint(PointLaw::Spring { stiffness: value(0), damping: value(1) }),
        Kind::Springpot => on_joint(PointLaw::Springpot { stiffness: value(0), exponent: value(1) }),
        Kind::Bypass => bypass(fixture, effect),
        Kind::ChannelHighpass => filtered(SignalFilter::HighPass(TAU * value(0))),
        Kind::ChannelResonance => filtered(SignalFilter::Resonance(TAU * value(0), value(1))),
        // A footing does two things at once; a wrong quantity has its value in the fixture already.
        Kind::Footing | Kind::QuantityError => None,
        Kind::CubicStiffness | Kind::Friction | Kind::Gap => Some(Action::Amplitude),
    }
}

/// A yielding end of a joint.
fn interface<'a>(fixture: &Fixture, effect: &Effect) -> Option<Action<'a>> {
    let (joint, at_far_end) = end_of(fixture, &effect.place)?;
    let dof = effect.dof.unwrap_or(Dof::Translation);
    let [stiffness, damping, spread] = [0, 1, 2].map(|index| effect.value(index));
    let interface = Interface { at_far_end, dof, stiffness, damping, spread };
    Some(Action::OnJoint { joint, change: Change::Interface(interface) })
}

/// A spring and dashpot from one body to another.
fn bypass<'a>(fixture: &Fixture, effect: &Effect) -> Option<Action<'a>> {
    let Place::Between(one, other) = &effect.place else { return None };
    let value = |index: usize| effect.value(index);
    let body = |name: &String| fixture.bodies().iter().position(|body| body.name == *name);
    let motion = TermStation::between((body(one)?, value(0)), (body(other)?, value(1)));
    let law = PointLaw::Spring { stiffness: value(2), damping: value(3) };
    Some(Action::Through { motion, law })
}

/// d = u_to − R·u_from over the joint's free length, all that lengthens it included.
fn relative_motion(fixture: &Fixture, joint: &Joint) -> [TermStation; 2] {
    let longer = |effect: &&Effect| {
        effect.kind == Kind::JointLength && matches!(&effect.place, Place::Joint(name) if *name == joint.name)
    };
    let extra: f64 = fixture.physics().iter().filter(longer).map(|effect| effect.value(0)).sum();
    let [from, to] = [joint.from, joint.to].map(|p| &fixture.points()[p]).map(|p| (p.body, p.x.value));
    TermStation::relative(from, to, fixture.joint_length(joint) + extra, false)
}

fn body_of(fixture: &Fixture, place: &Place) -> Option<usize> {
    let Place::Body(name) = place else { return None };
    fixture.bodies().iter().position(|body| body.name == *name)
}

fn joint_of(fixture: &Fixture, place: &Place) -> Option<usize> {
    let Place::Joint(name) = place else { return None };
    fixture.joints().iter().position(|joint| joint.name == *name)
}

/// The joint that ends at a point, and whether with its far end.
fn end_of(fixture: &Fixture, place: &Place) -> Option<(usize, bool)> {
    let Place::Point(name) = place else { return None };
    let is_here = |point: usize| fixture.points()[point].name == *name;
    let joint = fixture.joints().iter().position(|joint| is_here(joint.from) || is_here(joint.to))?;
    Some((joint, is_here(fixture.joints()[joint].to)))
}
