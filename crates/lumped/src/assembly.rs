mod change;

pub(crate) use change::{AssemblyChange, has_meshed_bodies};

use crate::condensed::Stretch;
use crate::effects::{Action, Change, actions};
use crate::held::{held_by_modes, in_the_modes};
use crate::mesh::{Attachment, Mesh};
use crate::modes_cache::modes;
use crate::nominal_stiffness::nominal_stiffness;
use crate::uniform_beam::{UniformBeam, UnitMesh};
use crate::{LumpedError, Station};
use jointscope_beam::{
    Matrix4, consistent_mass, consistent_rotary_inertia, element_stiffness, from_end_stiffness,
    shear_element_stiffness,
};
use jointscope_damping::{DampingLaw, HeldMode, ModeDamping, elastic_modes, viscous_matrix};
use jointscope_fixture::{BeamBody, Body, BodyKind, Damping, Fixture, Joint};
use jointscope_linalg::{ModalBasis, products};
use jointscope_spectra::Dof;
use std::f64::consts::TAU;

/// Where a body's coordinates stand in the assembly's.
#[derive(Debug, Clone)]
enum Coordinates {
    /// y and θ of the centre of gravity.
    Rigid { first: usize, x_cg: f64 },
    /// y alone.
    Translating { first: usize },
    /// y and θ of every node.
    Beam { first: usize, mesh: Mesh },
}

/// The assembly as its modes have it: bodies with their known masses, and joints; the springs of supports where damping ratios are those of the assembly as it
/// stands, otherwise none; no effects but those that rebuild a beam body (its shear, its stiffness factor).
///
/// Coordinates are (y, θ) of each rigid body's centre of gravity, y of a body that does not rotate, and
/// (y, θ) of every node of a beam, in the order of the fixture's bodies.
#[derive(Debug, Clone)]
pub struct Assembly {
    order: usize,
    places: Vec<Coordinates>,
    mass: Vec<f64>,
    stiffness: Vec<f64>,
    basis: ModalBasis,
    damping: Vec<ModeDamping>,
    elastic: Vec<usize>,
    law: DampingLaw,
}

impl Assembly {
    /// Builds matrices and modes, beams meshed finely enough for `highest_hz`.
    ///
    /// # Errors
    /// [`LumpedError::Modes`] where the eigenproblem fails, as it does for impossible masses; [`LumpedError::TooFine`].
    pub fn new(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        Assembly::by(fixture, highest_hz, |_| Vec::new())
    }

    /// As [`Assembly::new`] for responses within the band, at a fraction of the cost: modes of meshed beams by [`condensed_modes`](crate::condensed::condensed_modes).
    pub(crate) fn condensed(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        // The viscous matrix of a beam that is rebuilt is Σ v (Mξ)(Mξ)ᵀ: where v grows with λ, the least that modes are not orthogonal by counts.
        let by_stiffness = matches!(damping_law(fixture.damping()), DampingLaw::Rayleigh { .. });
        Assembly::by(fixture, highest_hz, |places| if by_stiffness { Vec::new() } else { stretches(places) })
    }

    fn by(
        fixture: &Fixture,
        highest_hz: f64,
        stretches: impl Fn(&[Coordinates]) -> Vec<Stretch>,
    ) -> Result<Self, LumpedError> {
        let places = coordinates(fixture, highest_hz)?;
        let order = places.iter().map(Coordinates::count).sum();
        let free_beam = if in_the_modes(fixture) { None } else { free_beam(fixture, &places) };
        if let Some((beam, first)) = free_beam {
            return Assembly::of_free_beam(fixture, places, order, beam, &first);
        }
        let plain = Matrices::of(fixture, &places, order, false);
        let stretches = stretches(&places);
        let basis = modes(order, &plain.mass, &plain.stiffness, &stretches)?;
        let law = damping_law(fixture.damping());
        let mut assembly = Assembly {
            order,
            places,
            mass: plain.mass,
            stiffness: plain.stiffness,
            basis,
            damping: Vec::new(),
            elastic: Vec::new(),
            law,
        };
        let held = assembly.held_modes(fixture);
        (assembly.damping, assembly.elastic) = (assembly.law.of_held_modes(&held), elastic_modes(&held));
        if actions(fixture).any(|action| matches!(action, Action::OnBeam { .. })) {
            assembly.rebuilt(fixture, &stretches)
        } else {
            Ok(assembly)
        }
    }

    /// One uniform beam by itself, whose modes are those of a problem without dimensions.
    fn of_free_beam(
        fixture: &Fixture,
        mut places: Vec<Coordinates>,
        order: usize,
        plain: UniformBeam,
        name: &str,
    ) -> Result<Self, LumpedError> {
        let altered = BodyEffects::on(fixture, name, true);
        let shear = altered.shear_stiffness.map_or(0.0, |shear| plain.bending_stiffness / shear);
        let beam = UniformBeam {
            bending_stiffness: plain.bending_stiffness * altered.factor,
            shear,
            rotary_inertia: altered.rotary_inertia,
            ..plain.clone()
        };
        if let [Coordinates::Beam { mesh, .. }] = places.as_mut_slice() {
            mesh.shear = shear;
        }
        let law = damping_law(fixture.damping());
        let before = plain.modes()?.basis;
        let own = law.of_modes(before.eigenvalues());
        let (basis, damping) = if beam == plain {
            (before, own)
        } else {
            let modes = beam.modes()?;
            let structural = match law {
                DampingLaw::LossFactor(factor) => factor,
                _ => 0.0,
            };
            let viscous = |r: usize| match modes.shares(r) {
                Some(shares) => {
                    shares.iter().zip(&own).map(|(share, mode)| share * share * mode.viscous).sum()
                }
                None => own[r].viscous,
            };
            let eigenvalues = modes.basis.eigenvalues().iter().enumerate();
            let damping = eigenvalues
                .map(|(r, l)| ModeDamping { viscous: viscous(r), structural: structural * l })
                .collect();
            (modes.basis, damping)
        };
        let with = Matrices::of(fixture, &places, order, true);
        let elastic = (0..order).filter(|&r| basis.eigenvalues()[r] > 0.0).collect();
        Ok(Assembly {
            order,
            places,
            mass: with.mass,
            stiffness: with.stiffness,
            basis,
            damping,
            elastic,
            law,
        })
    }

    /// The assembly with the effects that rebuild a beam body. Its viscous matrix stays that of the
    /// assembly without them; in the new modes only its diagonal is kept, an error of the order of the
    /// damping ratio times the change of shape.
    fn rebuilt(self, fixture: &Fixture, stretches: &[Stretch]) -> Result<Self, LumpedError> {
        let with = Matrices::of(fixture, &self.places, self.order, true);
        let basis = modes(self.order, &with.mass, &with.stiffness, stretches)?;
        let structural = match self.law {
            DampingLaw::LossFactor(factor) => factor,
            _ => 0.0,
        };
        let viscous = self.viscous_diagonal(&basis);
        let damping = viscous.iter().zip(basis.eigenvalues());
        let damping = damping
            .map(|(&viscous, eigenvalue)| ModeDamping { viscous, structural: structural * eigenvalue })
            .collect();
        Ok(Assembly { mass: with.mass, stiffness: with.stiffness, basis, damping, ..self })
    }

    /// The modes with what supports are to them; nothing where no mode holds supports.
    fn held_modes(&self, fixture: &Fixture) -> Vec<HeldMode> {
        let eigenvalues = self.basis.eigenvalues().iter();
        let mut modes: Vec<HeldMode> =
            eigenvalues.map(|&eigenvalue| HeldMode { eigenvalue, in_supports: 0.0, dashpots: 0.0 }).collect();
        for held in held_by_modes(fixture) {
            for (mode, motion) in modes.iter_mut().zip(self.participation(&held.station)) {
                mode.in_supports += held.stiffness * motion * motion / mode.eigenvalue.max(f64::MIN_POSITIVE);
                mode.dashpots += held.damping * motion * motion;
            }
        }
        modes
    }

    /// φᵀ C φ of every shape of `basis`: C = Σ v_r (Mξ_r)(Mξ_r)ᵀ over this assembly's own modes.
    fn viscous_diagonal(&self, basis: &ModalBasis) -> Vec<f64> {
        let n = self.order;
        let momenta = products(n, self.basis.shapes(), &self.mass);
        let shares = products(n, &momenta, basis.shapes());
        let mut all = vec![0.0; n];
        for (row, mode) in shares.chunks_exact(n).zip(&self.damping) {
            all.iter_mut().zip(row).for_each(|(all, share)| *all += mode.viscous * share * share);
        }
        all
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Mass matrix M, row-major; kg, kg·m, kg·m².
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// Stiffness matrix K, row-major; N/m, N, N·m.
    pub fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    /// Viscous damping matrix C, row-major (eq 27); zero for structural damping.
    pub fn viscous_damping(&self) -> Vec<f64> {
        viscous_matrix(&self.mass, &self.basis, &self.damping)
    }

    /// The undamped modes, mass-normalised.
    pub fn modes(&self) -> &ModalBasis {
        &self.basis
    }

    /// Damping of each mode.
    pub fn mode_damping(&self) -> &[ModeDamping] {
        &self.damping
    }

    /// Undamped natural frequencies in Hz, ascending; motions of a free assembly as rigid are exactly zero.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        self.basis.eigenvalues().iter().map(|l| l.max(0.0).sqrt() / TAU).collect()
    }

    /// The modes that have a damping ratio of their own, by place: not those as rigid, nor those of a suspension.
    pub fn elastic_modes(&self) -> &[usize] {
        &self.elastic
    }

    /// How the assembly is damped.
    pub fn damping_law(&self) -> &DampingLaw {
        &self.law
    }

    /// The row vector t that reads the motion at `station` from the coordinates (and spreads a load over them).
    pub fn station_row(&self, station: &Station) -> Vec<f64> {
        let mut row = vec![0.0; self.order];
        self.places[station.body].read(station.x, station.dof, &mut row);
        row
    }

    /// The station's participation in each mode, Ξᵀ t.
    pub fn participation(&self, station: &Station) -> Vec<f64> {
        let mut all = vec![0.0; self.order];
        self.add_participation(station, 1.0, &mut all);
        all
    }

    /// Adds `weight` times the station's participation in each mode to `all`.
    pub(crate) fn add_participation(&self, station: &Station, weight: f64, all: &mut [f64]) {
        let row = self.station_row(station);
        // A station reads a few coordinates only.
        let read: Vec<(usize, f64)> = row.into_iter().enumerate().filter(|(_, t)| *t != 0.0).collect();
        for (r, value) in all.iter_mut().enumerate() {
            let shape = self.basis.shape(r);
            *value += weight * read.iter().map(|(i, t)| shape[*i] * t).sum::<f64>();
        }
    }
}

impl Coordinates {
    fn count(&self) -> usize {
        match self {
            Coordinates::Rigid { .. } => 2,
            Coordinates::Translating { .. } => 1,
            Coordinates::Beam { mesh, .. } => mesh.coordinates(),
        }
    }

    fn read(&self, x: f64, dof: Dof, row: &mut [f64]) {
        match (self, dof) {
            (Coordinates::Rigid { first, x_cg }, Dof::Translation) => {
                row[*first] = 1.0;
                row[first + 1] = x - x_cg;
            }
            (Coordinates::Rigid { first, .. }, Dof::Rotation) => row[first + 1] = 1.0,
            (Coordinates::Translating { first }, Dof::Translation) => row[*first] = 1.0,
            (Coordinates::Translating { .. }, Dof::Rotation) => {}
            (Coordinates::Beam { first, mesh }, dof) => {
                mesh.interpolate(x, dof, &mut row[*first..first + mesh.coordinates()]);
            }
        }
    }
}

/// The fixture's only body where that is a beam without known masses, and its name. Supports are no part of the free assembly.
fn free_beam(fixture: &Fixture, places: &[Coordinates]) -> Option<(UniformBeam, String)> {
    let ([body], [Coordinates::Beam { mesh, .. }]) = (fixture.bodies(), places) else { return None };
    let BodyKind::Beam(beam) = &body.kind else { return None };
    if !body.masses.is_empty() || !fixture.joints().is_empty() {
        return None;
    }
    let length = beam.to.value - beam.from.value;
    let bending_stiffness = beam.youngs_modulus.value * beam.second_moment.value;
    let mass_per_length = beam.mass_per_length.value;
    let unit_mesh = match is_bare(fixture) {
        true => UnitMesh::Even(mesh.nodes.len() - 1),
        false => UnitMesh::Nodes(mesh.unit.clone()),
    };
    let beam = UniformBeam {
        mesh: unit_mesh,
        length,
        bending_stiffness,
        mass_per_length,
        shear: 0.0,
        rotary_inertia: 0.0,
    };
    Some((beam, body.name.clone()))
}

/// Whether the fixture is one body with nothing on it: nothing that its deflection has a kink at.
fn is_bare(fixture: &Fixture) -> bool {
    matches!(fixture.bodies(), [body] if body.masses.is_empty())
        && fixture.joints().is_empty()
        && fixture.supports().is_empty()
}

fn coordinates(fixture: &Fixture, highest_hz: f64) -> Result<Vec<Coordinates>, LumpedError> {
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
fn stretches(places: &[Coordinates]) -> Vec<Stretch> {
    let of = |place| match place {
        &Coordinates::Beam { first, ref mesh } => mesh.stretches(first).collect(),
        _ => Vec::new(),
    };
    places.iter().flat_map(of).collect()
}

/// Where something holds the body, the most important first: joints bend it there. A bare beam is meshed evenly.
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

pub(crate) fn damping_law(damping: &Damping) -> DampingLaw {
    match damping {
        Damping::Undamped => DampingLaw::Undamped,
        Damping::ModalRatios { ratios, .. } => {
            DampingLaw::ModalRatios(ratios.iter().map(|r| r.value).collect())
        }
        Damping::Rayleigh { mass, stiffness } => {
            DampingLaw::Rayleigh { mass: mass.value, stiffness: stiffness.value }
        }
        Damping::LossFactor(factor) => DampingLaw::LossFactor(factor.value),
    }
}

/// Mass and stiffness under construction.
struct Matrices {
    order: usize,
    mass: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Matrices {
    fn of(fixture: &Fixture, places: &[Coordinates], order: usize, with_effects: bool) -> Self {
        let mut all = Matrices { order, mass: vec![0.0; order * order], stiffness: vec![0.0; order * order] };
        for (body, place) in fixture.bodies().iter().zip(places) {
            all.add_body(fixture, body, place, with_effects);
        }
        for joint in fixture.joints() {
            all.add_joint(fixture, joint, places);
        }
        for held in held_by_modes(fixture) {
            let mut row = vec![0.0; order];
            places[held.station.body].read(held.station.x, held.station.dof, &mut row);
            add_product(&mut all.stiffness, &row, held.stiffness);
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
            let mut row = vec![0.0; self.order];
            place.read(point.x.value, Dof::Translation, &mut row);
            add_product(&mut self.mass, &row, point.mass.value);
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
        let mut row = vec![0.0; self.order];
        let mut read = |point: usize, dof: Dof| {
            let point = &fixture.points()[point];
            row.fill(0.0);
            places[point.body].read(point.x.value, dof, &mut row);
            not_zero(&row)
        };
        let ends =
            [joint.from, joint.to].map(|point| [Dof::Translation, Dof::Rotation].map(|dof| (point, dof)));
        let rows = ends.as_flattened().iter().map(|&(point, dof)| read(point, dof)).collect::<Vec<_>>();
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            for &(i, of_a) in &rows[a] {
                for &(j, of_b) in &rows[b] {
                    self.stiffness[i * self.order + j] += of_a * matrix[a][b] * of_b;
                }
            }
        }
    }
}

/// The few entries of a row that are not zero, with their places.
fn not_zero(row: &[f64]) -> Vec<(usize, f64)> {
    row.iter().copied().enumerate().filter(|(_, t)| *t != 0.0).collect()
}

/// Adds `factor` times the product of a row, of which few entries are not zero, with itself.
fn add_product(matrix: &mut [f64], row: &[f64], factor: f64) {
    let read = not_zero(row);
    for (i, a) in &read {
        read.iter().for_each(|(j, b)| matrix[i * row.len() + j] += factor * a * b);
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
struct BodyEffects {
    factor: f64,
    shear_stiffness: Option<f64>,
    rotary_inertia: f64,
}

impl BodyEffects {
    fn on(fixture: &Fixture, body: &str, with_effects: bool) -> Self {
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
