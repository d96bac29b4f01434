//! The laboratory's bodies: rigid blocks and meshed beams, with their stations.

use super::bar_mode::{BodyMode, Order, UniformBar};
use super::{Assembly, BeamElement, Law, Station};
use crate::StructureError;
use crate::effects::{at, product, shear_compliance};
use jointscope_fixture::{BeamBody, Body, BodyKind, Effect, EffectKind, Fixture, Place, RigidBody};

/// The bodies of an assembly, each able to say how any place on it moves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bodies {
    shapes: Vec<Shape>,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    /// A block: its centre of gravity, and the bending coordinates it was given.
    Block { centre: Station, x_cg: f64, bending: Vec<(UniformBar, Order, usize)> },
    /// A storey: one transverse coordinate.
    Storey { station: Station },
    /// A deformable body: its nodes and the element between neighbours (its length set for each).
    Beam { abscissae: Vec<f64>, nodes: Vec<Station>, element: BeamElement },
}

impl Bodies {
    /// Adds the bodies' own coordinates, first of all those of the bodies without effects, in the order of
    /// the fixture, then the bending coordinates of blocks that `effects` make flexible and those of `beyond`
    /// what effects can say; with masses and, for deformable bodies, elements that carry `loss_factor`.
    pub(crate) fn assemble(
        assembly: &mut Assembly,
        fixture: &Fixture,
        meshes: &[Vec<f64>],
        effects: &[Effect],
        beyond: &[BodyMode<'_>],
        loss_factor: f64,
    ) -> Result<Self, StructureError> {
        let mut shapes = Vec::with_capacity(meshes.len());
        for (body, mesh) in fixture.bodies().iter().zip(meshes) {
            shapes.push(match &body.kind {
                BodyKind::Rigid(rigid) => block(assembly, rigid),
                BodyKind::Beam(beam) => deformable(assembly, body, beam, mesh, effects, loss_factor)?,
            });
        }
        let mut bodies = Bodies { shapes };
        for (index, body) in fixture.bodies().iter().enumerate() {
            let stated =
                at(effects, EffectKind::BodyFlexibility, Place::Body(body.name.clone())).map(|effect| {
                    let (frequency, damping_ratio) = (effect.value(0), effect.value(1));
                    BodyMode { body: &body.name, order: Order::First, frequency, damping_ratio }
                });
            for mode in stated.chain(beyond.iter().copied().filter(|mode| mode.body == body.name)) {
                bodies.release_bending(assembly, index, body, mode)?;
            }
        }
        for (index, body) in fixture.bodies().iter().enumerate() {
            for mass in &body.masses {
                assembly.inertia(&bodies.station(index, mass.x.value)?.y, mass.mass.value);
            }
        }
        Ok(bodies)
    }

    /// The place at abscissa `x` (m) on the body at `index`.
    pub(crate) fn station(&self, index: usize, x: f64) -> Result<Station, StructureError> {
        match &self.shapes[index] {
            Shape::Storey { station } => Ok(station.clone()),
            Shape::Block { centre, x_cg, bending } => {
                let mut station = centre.rigidly_at(x - x_cg);
                for (bar, order, coordinate) in bending {
                    let (deflection, slope) = bar.mode(*order, x);
                    let coordinate = super::Row::coordinate(*coordinate);
                    station.y = station.y.plus(deflection, &coordinate);
                    station.theta = station.theta.plus(slope, &coordinate);
                }
                Ok(station)
            }
            Shape::Beam { abscissae, nodes, element } => {
                let right = abscissae.partition_point(|&node| node < x).clamp(1, nodes.len() - 1);
                let left = right - 1;
                let length = abscissae[right] - abscissae[left];
                // A place beyond the ends (a displaced sensor) moves with the end's tangent.
                let inside = (x - abscissae[left]).clamp(0.0, length);
                let element = BeamElement { length, ..*element };
                let beyond = x - abscissae[left] - inside;
                let near_node = 1e-9 * length;
                let station = if inside <= near_node {
                    nodes[left].clone()
                } else if inside >= length - near_node {
                    nodes[right].clone()
                } else {
                    element.station_at(inside, &nodes[left], &nodes[right])?
                };
                Ok(if beyond.abs() > near_node { station.rigidly_at(beyond) } else { station })
            }
        }
    }

    fn release_bending(
        &mut self,
        assembly: &mut Assembly,
        index: usize,
        body: &Body,
        mode: BodyMode<'_>,
    ) -> Result<(), StructureError> {
        let misplaced = StructureError::Misplaced {
            kind: EffectKind::BodyFlexibility.name(),
            place: body.name.clone(),
            why: "only a block that rotates can be taken for a uniform bar",
        };
        let (Shape::Block { x_cg, bending, .. }, BodyKind::Rigid(rigid)) =
            (&mut self.shapes[index], &body.kind)
        else {
            return Err(misplaced);
        };
        let Some(inertia) = rigid.inertia else { return Err(misplaced) };
        let (mass, omega) = (rigid.mass.value, mode.omega());
        let coordinate = assembly.coordinate();
        let motion = super::Row::coordinate(coordinate);
        assembly.inertia(&motion, mass);
        assembly.spring(&motion, mass * omega * omega, Law::ELASTIC);
        assembly.dashpot(&motion, 2.0 * mode.damping_ratio * omega * mass);
        bending.push((UniformBar::of(mass, inertia.value, *x_cg), mode.order, coordinate));
        Ok(())
    }
}

fn block(assembly: &mut Assembly, rigid: &RigidBody) -> Shape {
    let y = super::Row::coordinate(assembly.coordinate());
    assembly.inertia(&y, rigid.mass.value);
    match (rigid.rotates, rigid.inertia) {
        (true, Some(inertia)) => {
            let theta = super::Row::coordinate(assembly.coordinate());
            assembly.inertia(&theta, inertia.value);
            let x_cg = rigid.x_cg.map_or(0.0, |x| x.value);
            Shape::Block { centre: Station { y, theta }, x_cg, bending: Vec::new() }
        }
        _ => Shape::Storey { station: Station { y, theta: super::Row::zero() } },
    }
}

fn deformable(
    assembly: &mut Assembly,
    body: &Body,
    beam: &BeamBody,
    mesh: &[f64],
    effects: &[Effect],
    loss_factor: f64,
) -> Result<Shape, StructureError> {
    let at_body = |kind| at(effects, kind, Place::Body(body.name.clone()));
    let factor = product(at_body(EffectKind::StiffnessChange));
    let shear_compliance = shear_compliance(at_body(EffectKind::ShearDeformation));
    let element = BeamElement {
        length: 0.0,
        bending_stiffness: factor * beam.youngs_modulus.value * beam.second_moment.value,
        shear_stiffness: factor / shear_compliance,
        mass_per_length: beam.mass_per_length.value,
        rotary_inertia: at_body(EffectKind::ShearDeformation).map(|e| e.value(1)).sum(),
    };
    let nodes: Vec<Station> = mesh.iter().map(|_| assembly.node()).collect();
    let law = Law { loss_factor, ..Law::ELASTIC };
    for (span, ends) in mesh.windows(2).zip(nodes.windows(2)) {
        let element = BeamElement { length: span[1] - span[0], ..element };
        element.assemble(assembly, &ends[0], &ends[1], law)?;
    }
    Ok(Shape::Beam { abscissae: mesh.to_vec(), nodes, element })
}
