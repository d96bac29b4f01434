//! Which coordinates the bodies of an assembly have, and what a point of a body reads of them.

use crate::LumpedError;
use crate::condensed::Stretch;
use crate::mesh::{Attachment, Mesh};
use jointscope_fixture::{BodyKind, Fixture};
use jointscope_spectra::Dof;

/// Where a body's coordinates stand in the assembly's.
#[derive(Debug, Clone)]
pub(super) enum Coordinates {
    /// y and θ of the centre of gravity.
    Rigid { first: usize, x_cg: f64 },
    /// y alone.
    Translating { first: usize },
    /// y and θ of every node.
    Beam { first: usize, mesh: Mesh },
}

impl Coordinates {
    /// How many there are.
    pub(super) fn count(&self) -> usize {
        match self {
            Coordinates::Rigid { .. } => 2,
            Coordinates::Translating { .. } => 1,
            Coordinates::Beam { mesh, .. } => mesh.coordinates(),
        }
    }

    /// Adds what a component of the motion at `x` reads of the assembly's coordinates to `entries`: the few
    /// that are not zero, by their place, ascending.
    pub(super) fn add_entries(&self, x: f64, dof: Dof, entries: &mut Vec<(usize, f64)>) {
        match (self, dof) {
            (Coordinates::Rigid { first, x_cg }, Dof::Translation) => {
                entries.push((*first, 1.0));
                let arm = x - x_cg;
                entries.extend((arm != 0.0).then_some((first + 1, arm)));
            }
            (Coordinates::Rigid { first, .. }, Dof::Rotation) => entries.push((first + 1, 1.0)),
            (Coordinates::Translating { first }, Dof::Translation) => entries.push((*first, 1.0)),
            (Coordinates::Translating { .. }, Dof::Rotation) => {}
            (Coordinates::Beam { first, mesh }, dof) => {
                let mut row = vec![0.0; mesh.coordinates()];
                mesh.interpolate(x, dof, &mut row);
                let read = row.into_iter().enumerate().filter(|(_, t)| *t != 0.0);
                entries.extend(read.map(|(i, t)| (first + i, t)));
            }
        }
    }
}

/// The coordinates of all bodies in their order, beams meshed finely enough for `highest_hz`.
pub(super) fn coordinates(fixture: &Fixture, highest_hz: f64) -> Result<Vec<Coordinates>, LumpedError> {
    let mut first = 0;
    let mut places = Vec::with_capacity(fixture.bodies().len());
    for (index, body) in fixture.bodies().iter().enumerate() {
        let place = match &body.kind {
            BodyKind::Rigid(rigid) if rigid.rotates => {
                Coordinates::Rigid { first, x_cg: rigid.x_cg.map_or(0.0, |q| q.value) }
            }
            BodyKind::Rigid(_) => Coordinates::Translating { first },
            BodyKind::Beam(beam) => {
                let mesh = Mesh::new(
                    beam.from.value,
                    beam.to.value,
                    beam.youngs_modulus.value * beam.second_moment.value,
                    beam.mass_per_length.value,
                    highest_hz,
                    &attachments(fixture, index),
                );
                let mesh = mesh.map_err(|elements| LumpedError::TooFine {
                    body: body.name.clone(),
                    elements,
                    most: crate::mesh::MOST,
                    frequency: highest_hz,
                })?;
                Coordinates::Beam { first, mesh }
            }
        };
        first += place.count();
        places.push(place);
    }
    Ok(places)
}

/// The stretches of all beams.
pub(super) fn stretches(places: &[Coordinates]) -> Vec<Stretch> {
    let of = |place| match place {
        &Coordinates::Beam { first, ref mesh } => mesh.stretches(first).collect(),
        _ => Vec::new(),
    };
    places.iter().flat_map(of).collect()
}

/// Where something holds the body, the most important first: joints bend it there. A bare beam is meshed
/// evenly.
fn attachments(fixture: &Fixture, body: usize) -> Vec<Attachment> {
    if is_bare(fixture) {
        return Vec::new();
    }
    let points = fixture.points();
    let ends = fixture.joints().iter().flat_map(|joint| [joint.from, joint.to]).map(|point| &points[point]);
    let joints = ends.map(|point| (point.body, Attachment { x: point.x.value, turns: true }));
    let supports = fixture.supports().iter().map(|support| {
        let (body, x) = fixture.support_place(support);
        (body, Attachment { x, turns: support.rotational_stiffness.is_some() })
    });
    let masses = fixture.bodies()[body].masses.iter();
    let masses = masses.map(|mass| (body, Attachment { x: mass.x.value, turns: false }));
    joints.chain(supports).chain(masses).filter(|(b, _)| *b == body).map(|(_, at)| at).collect()
}

/// Whether the fixture is one body with nothing on it: nothing that its deflection has a kink at.
pub(super) fn is_bare(fixture: &Fixture) -> bool {
    matches!(fixture.bodies(), [body] if body.masses.is_empty())
        && fixture.joints().is_empty()
        && fixture.supports().is_empty()
}
