//! The laboratory's joints: what effects and damping make of a stated law, interfaces at both ends.

use super::body::Bodies;
use super::{Assembly, BeamElement, Law, Row, Station};
use crate::StructureError;
use crate::effects::{at, product, shear_compliance, sum};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Joint, JointLaw, Place, Quantity};

/// Elements of a joint that has mass; six would give 1e-4.
const ELEMENTS: usize = 16;

/// What effects and damping make of a joint beyond its stated law.
struct Properties {
    length: f64,
    factor: f64,
    shear_compliance: f64,
    mass: f64,
    law: Law,
}

impl Properties {
    fn of(
        fixture: &Fixture,
        joint: &Joint,
        effects: &[Effect],
        loss_factor: f64,
    ) -> Result<Self, StructureError> {
        let here = |kind| at(effects, kind, Place::Joint(joint.name.clone()));
        let mut law = Law { loss_factor: loss_factor + sum(here(EffectKind::LossFactor)), ..Law::ELASTIC };
        let mut relaxations = here(EffectKind::Relaxation);
        if let Some(relaxation) = relaxations.next() {
            law.relaxation_ratio = relaxation.value(0);
            law.relaxation_time = relaxation.value(1);
        }
        if let Some(second) = relaxations.next() {
            return Err(StructureError::Misplaced {
                kind: second.kind.name(),
                place: joint.name.clone(),
                why: "the joint relaxes already, and one solid has one relaxation",
            });
        }
        Ok(Properties {
            length: fixture.joint_length(joint) + sum(here(EffectKind::JointLength)),
            factor: product(here(EffectKind::StiffnessChange)),
            shear_compliance: shear_compliance(here(EffectKind::ShearDeformation)),
            mass: sum(here(EffectKind::JointMass)),
            law,
        })
    }
}

/// Puts a joint between its points, through the interfaces that `effects` put at its ends.
pub(crate) fn assemble_joint(
    assembly: &mut Assembly,
    fixture: &Fixture,
    bodies: &Bodies,
    joint: &Joint,
    effects: &[Effect],
    loss_factor: f64,
) -> Result<(), StructureError> {
    let properties = Properties::of(fixture, joint, effects, loss_factor)?;
    let from = joint_end(assembly, fixture, bodies, joint, joint.from, effects)?;
    let to = joint_end(assembly, fixture, bodies, joint, joint.to, effects)?;
    add_parallel(assembly, fixture, bodies, joint, effects, properties.length)?;
    match &joint.law {
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let bending_stiffness = youngs_modulus.value * second_moment.value;
            strip(assembly, &from, &to, bending_stiffness, &properties)
        }
        JointLaw::Stiffness { stiffness, damping } => {
            spring_joint(assembly, &from, &to, stiffness, damping.as_ref(), &properties);
            Ok(())
        }
    }
}

/// Springs and dashpots beside a joint, from body to body past its interfaces.
fn add_parallel(
    assembly: &mut Assembly,
    fixture: &Fixture,
    bodies: &Bodies,
    joint: &Joint,
    effects: &[Effect],
    length: f64,
) -> Result<(), StructureError> {
    let station = |point: usize| {
        let point = &fixture.points()[point];
        bodies.station(point.body, point.x.value)
    };
    let [deflection, rotation] = station(joint.to)?.relative_to(&station(joint.from)?, length);
    for beside in at(effects, EffectKind::ParallelStiffness, Place::Joint(joint.name.clone())) {
        let stretch = if beside.dof == Some(Dof::Rotation) { &rotation } else { &deflection };
        assembly.spring(stretch, beside.value(0), Law::ELASTIC);
        assembly.dashpot(stretch, beside.value(1));
    }
    for pot in at(effects, EffectKind::Springpot, Place::Joint(joint.name.clone())) {
        let stretch = if pot.dof == Some(Dof::Rotation) { &rotation } else { &deflection };
        assembly.spring(stretch, pot.value(0), Law { exponent: pot.value(1), ..Law::ELASTIC });
    }
    Ok(())
}

/// The end of a joint at a point: the body's own place there, or, behind an interface, a place that can move
/// against it.
fn joint_end(
    assembly: &mut Assembly,
    fixture: &Fixture,
    bodies: &Bodies,
    joint: &Joint,
    point: usize,
    effects: &[Effect],
) -> Result<Station, StructureError> {
    let is_far = point == joint.to;
    let point = &fixture.points()[point];
    let mut end = bodies.station(point.body, point.x.value)?;
    let interfaces = at(effects, EffectKind::InterfaceCompliance, Place::Point(point.name.clone()));
    let footings = at(effects, EffectKind::Footing, Place::Joint(joint.name.clone()));
    for interface in interfaces.chain(footings) {
        let beyond = Row::coordinate(assembly.coordinate());
        let turns = interface.kind == EffectKind::Footing || interface.dof == Some(Dof::Rotation);
        let held = if turns { &mut end.theta } else { &mut end.y };
        let slip = beyond.minus(held);
        assembly.spring(&slip, interface.value(0), Law::ELASTIC);
        assembly.dashpot(&slip, interface.value(1));
        *held = beyond;
        let JointLaw::Beam { youngs_modulus, second_moment } = &joint.law else { continue };
        if interface.kind == EffectKind::InterfaceCompliance && interface.value(2) != 0.0 {
            // A layer along the foot turns about a centre inside the body: the end itself moves as well.
            let bending_stiffness = youngs_modulus.value * second_moment.value;
            let behind = interface.value(2) * bending_stiffness / (2.0 * interface.value(0));
            end.y = end.y.plus(if is_far { -behind } else { behind }, &slip);
        }
    }
    Ok(end)
}

/// A beam joint: one massless element, or a mesh of elements where it has mass.
fn strip(
    assembly: &mut Assembly,
    from: &Station,
    to: &Station,
    bending_stiffness: f64,
    properties: &Properties,
) -> Result<(), StructureError> {
    let count = if properties.mass == 0.0 { 1 } else { ELEMENTS };
    let element = BeamElement {
        length: properties.length / count as f64,
        bending_stiffness: properties.factor * bending_stiffness,
        shear_stiffness: properties.factor / properties.shear_compliance,
        mass_per_length: properties.mass / properties.length,
        rotary_inertia: 0.0,
    };
    let mut left = from.clone();
    for i in 1..=count {
        let right = if i == count { to.clone() } else { assembly.node() };
        element.assemble(assembly, &left, &right, properties.law)?;
        left = right;
    }
    Ok(())
}

/// A joint stated by its stiffness on d = u_to − R·u_from, its dashpots and half of its mass at each end.
fn spring_joint(
    assembly: &mut Assembly,
    from: &Station,
    to: &Station,
    stiffness: &[Quantity; 3],
    damping: Option<&[Quantity; 3]>,
    properties: &Properties,
) {
    let motions = to.relative_to(from, properties.length);
    let [a, b, d] = stiffness.map(|q| q.value);
    // A shear spring of 1/compliance in series with the transverse motion, also where k22 is zero.
    let softening = properties.shear_compliance / (1.0 + properties.shear_compliance * a);
    let sheared = [a - a * a * softening, b - a * b * softening, d - b * b * softening];
    let [a, b, d] = sheared.map(|k| k * properties.factor);
    assembly.springs(&motions, &[a, b, b, d], properties.law);
    if let Some(damping) = damping {
        let [a, b, d] = damping.map(|q| q.value);
        assembly.dashpots(&motions, &[a, b, b, d]);
    }
    if properties.mass != 0.0 {
        assembly.inertia(&from.y, properties.mass / 2.0);
        assembly.inertia(&to.y, properties.mass / 2.0);
    }
}
