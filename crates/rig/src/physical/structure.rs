//! The laboratory's structure as it is tested: its FRFs between stations.

use super::bar_mode::BodyMode;
use super::body::Bodies;
use super::damping::{add_viscous, loss_factor};
use super::joint::assemble_joint;
use super::mesh::meshes;
use super::{Assembly, Law, Row, Station};
use crate::StructureError;
use crate::effects::{all, sum};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place, Side};
use jointscope_linalg::generalized_symmetric_eigen;
use jointscope_spectra::{Channel, Dof};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A structure in the laboratory: its dynamic stiffness, and the places where it can be struck and read.
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    assembly: Assembly,
    points: BTreeMap<String, Station>,
    displaced: [BTreeMap<String, Station>; 2],
}

impl Structure {
    /// A structure assembled by hand, with its measuring points by name.
    pub fn new(assembly: Assembly, points: impl IntoIterator<Item = (String, Station)>) -> Self {
        Structure { assembly, points: points.into_iter().collect(), displaced: Default::default() }
    }

    /// The structure that a fixture describes, every structural effect of its `physics` in place.
    ///
    /// # Errors
    /// A non-linear effect, or physics that cannot be built.
    pub fn of(fixture: &Fixture) -> Result<Self, StructureError> {
        Ok(Self::with_modes(fixture, &[])?.0)
    }

    /// The same with bending modes of blocks that no effect of a fixture describes, and the bodies, which say
    /// how any place moves.
    pub(crate) fn with_modes(
        fixture: &Fixture,
        modes: &[BodyMode<'_>],
    ) -> Result<(Self, Bodies), StructureError> {
        let effects = fixture.physics();
        if let Some(effect) = effects.iter().find(|e| e.kind.is_nonlinear()) {
            return Err(StructureError::Nonlinear {
                kind: effect.kind.name(),
                place: effect.place.to_string(),
            });
        }
        let meshes = meshes(fixture);
        let (free, plain) = free_assembly(fixture, &meshes, &[], &[])?;
        let mut supported = free.clone();
        add_supports(&mut supported, fixture, &plain)?;
        let (mut assembly, bodies) = free_assembly(fixture, &meshes, effects, modes)?;
        add_viscous(&mut assembly, &free, &supported, fixture.damping())?;
        add_supports(&mut assembly, fixture, &bodies)?;
        for effect in effects {
            attach(&mut assembly, fixture, &bodies, effect)?;
        }
        let mut structure = Structure::new(assembly, []);
        for point in fixture.points() {
            let x = point.x.value;
            structure.points.insert(point.name.clone(), bodies.station(point.body, x)?);
            for (places, side) in structure.displaced.iter_mut().zip([Side::Response, Side::Reference]) {
                let moved = all(effects, EffectKind::PointOffset);
                let moved = moved.filter(|effect| effect.place.holds_channel(&point.name, side));
                let dx: f64 = moved.map(|effect| effect.value(0)).sum();
                if dx != 0.0 {
                    places.insert(point.name.clone(), bodies.station(point.body, x + dx)?);
                }
            }
        }
        Ok((structure, bodies))
    }

    /// The same places on another assembly: `moves` says by the point's name how its motion, stated or as
    /// mounted, follows from that assembly's coordinates.
    pub(crate) fn on(&self, assembly: Assembly, moves: impl Fn(&str, &Row) -> Row) -> Self {
        let on = |places: &BTreeMap<String, Station>| {
            let moved = places.iter().map(|(name, station)| {
                let Station { y, theta } = station;
                (name.clone(), Station { y: moves(name, y), theta: moves(name, theta) })
            });
            moved.collect()
        };
        Structure { assembly, points: on(&self.points), displaced: self.displaced.each_ref().map(on) }
    }

    /// Masses, springs and dashpots on the coordinates.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// How the stated place of a channel moves.
    ///
    /// # Errors
    /// [`StructureError::UnknownPoint`].
    pub fn motion(&self, channel: &Channel) -> Result<&Row, StructureError> {
        motion(&self.points, channel).ok_or_else(|| StructureError::UnknownPoint(channel.point.clone()))
    }

    /// How the place moves where the channel's sensor or impact really is.
    ///
    /// # Errors
    /// [`StructureError::UnknownPoint`].
    pub(crate) fn motion_as_mounted(&self, channel: &Channel, side: Side) -> Result<&Row, StructureError> {
        match motion(&self.displaced[side as usize], channel) {
            Some(row) => Ok(row),
            None => self.motion(channel),
        }
    }

    /// Undamped natural frequencies in Hz, ascending, rigid motions first, of a structure in which every
    /// coordinate has mass.
    ///
    /// # Errors
    /// [`StructureError::Modes`].
    pub fn natural_frequencies(&self) -> Result<Vec<f64>, StructureError> {
        let mass = self.assembly.mass_matrix();
        let stiffness = self.assembly.stiffness_matrix();
        let basis = generalized_symmetric_eigen(self.assembly.order(), &mass, &stiffness)?;
        Ok(basis.eigenvalues().iter().map(|lambda| lambda.max(0.0).sqrt() / TAU).collect())
    }
}

fn motion<'a>(places: &'a BTreeMap<String, Station>, channel: &Channel) -> Option<&'a Row> {
    let station = places.get(&channel.point)?;
    Some(match channel.dof {
        Dof::Translation => &station.y,
        Dof::Rotation => &station.theta,
    })
}

/// Bodies and joints, without supports and without damping other than the loss factor and the joints' own.
fn free_assembly(
    fixture: &Fixture,
    meshes: &[Vec<f64>],
    effects: &[Effect],
    modes: &[BodyMode<'_>],
) -> Result<(Assembly, Bodies), StructureError> {
    let mut assembly = Assembly::new();
    let loss_factor = loss_factor(fixture.damping());
    let bodies = Bodies::assemble(&mut assembly, fixture, meshes, effects, modes, loss_factor)?;
    for joint in fixture.joints() {
        assemble_joint(&mut assembly, fixture, &bodies, joint, effects, loss_factor)?;
    }
    Ok((assembly, bodies))
}

fn add_supports(assembly: &mut Assembly, fixture: &Fixture, bodies: &Bodies) -> Result<(), StructureError> {
    for support in fixture.supports() {
        let (body, x) = fixture.support_place(support);
        let station = bodies.station(body, x)?;
        let value = |quantity: &Option<jointscope_fixture::Quantity>| quantity.map_or(0.0, |q| q.value);
        assembly.spring(&station.y, support.stiffness.value, Law::ELASTIC);
        assembly.dashpot(&station.y, value(&support.damping));
        assembly.spring(&station.theta, value(&support.rotational_stiffness), Law::ELASTIC);
        assembly.dashpot(&station.theta, value(&support.rotational_damping));
    }
    Ok(())
}

/// Hangs masses, springs and resonators on the bodies.
fn attach(
    assembly: &mut Assembly,
    fixture: &Fixture,
    bodies: &Bodies,
    effect: &Effect,
) -> Result<(), StructureError> {
    let number = |name: &str| fixture.bodies().iter().position(|b| b.name == name);
    if let Place::Between(one, other) = &effect.place {
        let (Some(one), Some(other)) = (number(one), number(other)) else { return Ok(()) };
        let [from, to] = [bodies.station(one, effect.value(0))?, bodies.station(other, effect.value(1))?];
        let stretch = to.y.minus(&from.y);
        assembly.spring(&stretch, effect.value(2), Law::ELASTIC);
        assembly.dashpot(&stretch, effect.value(3));
        return Ok(());
    }
    let Place::Body(name) = &effect.place else { return Ok(()) };
    let Some(body) = number(name) else { return Ok(()) };
    let place = || {
        let station = bodies.station(body, effect.value(0))?;
        Ok::<Row, StructureError>(if effect.dof == Some(Dof::Rotation) { station.theta } else { station.y })
    };
    match effect.kind {
        EffectKind::AddedMass => {
            let (station, mass, height) =
                (bodies.station(body, effect.value(0))?, effect.value(1), effect.value(2));
            assembly.inertia(&station.y, mass);
            assembly.inertia(&station.theta, mass * height * height);
        }
        EffectKind::Support => {
            let place = place()?;
            assembly.spring(&place, effect.value(1), Law::ELASTIC);
            assembly.dashpot(&place, effect.value(2));
        }
        EffectKind::AttachedResonator => {
            let (mass, omega) = (effect.value(1), TAU * effect.value(2));
            let resonator = Row::coordinate(assembly.coordinate());
            assembly.inertia(&resonator, mass);
            let stretch = resonator.minus(&place()?);
            assembly.spring(&stretch, mass * omega * omega, Law::ELASTIC);
            assembly.dashpot(&stretch, 2.0 * effect.value(3) * omega * mass);
        }
        _ => {}
    }
    Ok(())
}

/// Decay rate (1/s) of the response window, zero where there is none.
pub(crate) fn window_decay(effects: &[Effect]) -> f64 {
    sum(all(effects, EffectKind::ExponentialWindow))
}
