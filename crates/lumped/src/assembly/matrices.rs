//! Mass and stiffness of an assembly from its bodies, joints and the springs that its modes hold.

use super::coordinates::Coordinates;
use crate::effects::{Action, Change, actions};
use crate::held::held_by_modes;
use crate::mesh::Mesh;
use crate::nominal_stiffness::nominal_stiffness;
use jointscope_beam::{
    Matrix4, consistent_mass, consistent_rotary_inertia, element_stiffness, from_end_stiffness,
    shear_element_stiffness,
};
use jointscope_fixture::{BeamBody, Body, BodyKind, Fixture, Joint};
use jointscope_spectra::Dof;

/// Mass and stiffness under construction.
pub(super) struct Matrices {
    order: usize,
    pub(super) mass: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
}

impl Matrices {
    pub(super) fn of(fixture: &Fixture, places: &[Coordinates], order: usize, with_effects: bool) -> Self {
        let mut all = Matrices { order, mass: vec![0.0; order * order], stiffness: vec![0.0; order * order] };
        for (body, place) in fixture.bodies().iter().zip(places) {
            all.add_body(fixture, body, place, with_effects);
        }
        for joint in fixture.joints() {
            all.add_joint(fixture, joint, places);
        }
        for held in held_by_modes(fixture) {
            let mut read = Vec::new();
            places[held.station.body].add_entries(held.station.x, held.station.dof, &mut read);
            add_product(&mut all.stiffness, order, &read, held.stiffness);
        }
        all
    }

    fn add_body(&mut self, fixture: &Fixture, body: &Body, place: &Coordinates, with_effects: bool) {
        match (&body.kind, place) {
            (BodyKind::Rigid(rigid), Coordinates::Rigid { first, .. }) => {
                self.mass[first * self.order + first] += rigid.mass.value;
                let inertia = rigid.inertia.map_or(0.0, |q| q.value);
                self.mass[(first + 1) * self.order + first + 1] += inertia;
            }
            (BodyKind::Rigid(rigid), Coordinates::Translating { first }) => {
                self.mass[first * self.order + first] += rigid.mass.value;
            }
            (BodyKind::Beam(beam), Coordinates::Beam { first, mesh }) => {
                let altered = BodyEffects::on(fixture, &body.name, with_effects);
                self.add_beam(beam, *first, mesh, &altered);
            }
            // Coordinates are made from the same bodies, so the kinds always match.
            _ => {}
        }
        for point in &body.masses {
            let mut read = Vec::new();
            place.add_entries(point.x.value, Dof::Translation, &mut read);
            add_product(&mut self.mass, self.order, &read, point.mass.value);
        }
    }

    fn add_beam(&mut self, beam: &BeamBody, first: usize, mesh: &Mesh, altered: &BodyEffects) {
        let bending = beam.youngs_modulus.value * beam.second_moment.value * altered.factor;
        for (element, pair) in mesh.nodes.windows(2).enumerate() {
            let length = pair[1] - pair[0];
            let stiffness = match altered.shear_stiffness {
                Some(shear) => shear_element_stiffness(bending, shear * altered.factor, length),
                None => element_stiffness(bending, length),
            };
            let at = first + 2 * element;
            add_block(&mut self.stiffness, self.order, at, &stiffness);
            add_block(&mut self.mass, self.order, at, &consistent_mass(beam.mass_per_length.value, length));
            if altered.rotary_inertia != 0.0 {
                let rotary = consistent_rotary_inertia(altered.rotary_inertia, length);
                add_block(&mut self.mass, self.order, at, &rotary);
            }
        }
    }

    fn add_joint(&mut self, fixture: &Fixture, joint: &Joint, places: &[Coordinates]) {
        let length = fixture.joint_length(joint);
        let matrix = from_end_stiffness(nominal_stiffness(&joint.law, length), length);
        // The entries of all four motions at its ends, one motion's after another's.
        let mut read: Vec<(usize, f64)> = Vec::with_capacity(8);
        let mut until = [0; 5];
        for (motion, (point, dof)) in [joint.from, joint.to]
            .into_iter()
            .flat_map(|point| [Dof::Translation, Dof::Rotation].map(|dof| (&fixture.points()[point], dof)))
            .enumerate()
        {
            places[point.body].add_entries(point.x.value, dof, &mut read);
            until[motion + 1] = read.len();
        }
        let of = |motion: usize| &read[until[motion]..until[motion + 1]];
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            for &(i, of_a) in of(a) {
                for &(j, of_b) in of(b) {
                    self.stiffness[i * self.order + j] += of_a * matrix[a][b] * of_b;
                }
            }
        }
    }
}

/// Adds `factor` times the product of a row of so many coordinates, of which few entries are not zero, with
/// itself.
fn add_product(matrix: &mut [f64], order: usize, read: &[(usize, f64)], factor: f64) {
    for (i, a) in read {
        read.iter().for_each(|(j, b)| matrix[i * order + j] += factor * a * b);
    }
}

fn add_block(matrix: &mut [f64], order: usize, at: usize, block: &Matrix4) {
    for i in 0..4 {
        for j in 0..4 {
            matrix[(at + i) * order + at + j] += block[i][j];
        }
    }
}

/// Effects that change a beam body as a whole.
pub(super) struct BodyEffects {
    pub(super) factor: f64,
    pub(super) shear_stiffness: Option<f64>,
    pub(super) rotary_inertia: f64,
}

impl BodyEffects {
    pub(super) fn on(fixture: &Fixture, body: &str, with_effects: bool) -> Self {
        let mut all = BodyEffects { factor: 1.0, shear_stiffness: None, rotary_inertia: 0.0 };
        for action in actions(fixture).filter(|_| with_effects) {
            match action {
                Action::OnBeam { body: index, change } if fixture.bodies()[index].name == body => {
                    match change {
                        Change::Factor(factor) => all.factor *= factor,
                        Change::Shear { stiffness, rotary_inertia } => {
                            all.shear_stiffness = Some(stiffness);
                            all.rotary_inertia += rotary_inertia;
                        }
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        all
    }
}
