//! An assembly: its matrices, its modes and what damps them.

mod beside;
mod change;
mod coordinates;
mod matrices;
mod turned;

pub(crate) use beside::Rows;
pub(crate) use change::{AssemblyChange, has_meshed_bodies};

use crate::condensed::Stretch;
use crate::effects::{Action, actions};
use crate::held::{held_by_modes, in_the_modes};
use crate::modes_cache::modes;
use crate::uniform_beam::{UniformBeam, UnitMesh};
use crate::{LumpedError, Station};
use coordinates::{Coordinates, coordinates, is_bare, stretches};
use jointscope_damping::{DampingLaw, HeldMode, ModeDamping, elastic_modes, viscous_matrix};
use jointscope_fixture::{BodyKind, Damping, Fixture};
use jointscope_linalg::{ModalBasis, products};
use matrices::{BodyEffects, Matrices};
use std::f64::consts::TAU;
use std::sync::Arc;
use turned::Turned;

/// The assembly as its modes have it: bodies with their known masses, and joints; the springs of supports
/// where damping ratios are those of the assembly as it stands, otherwise none; no effects but those that
/// rebuild a beam body (its shear, its stiffness factor).
///
/// Coordinates are (y, θ) of each rigid body's centre of gravity, y of a body that does not rotate, and
/// (y, θ) of every node of a beam, in the order of the fixture's bodies.
#[derive(Debug, Clone)]
pub struct Assembly {
    order: usize,
    places: Vec<Coordinates>,
    mass: Vec<f64>,
    stiffness: Vec<f64>,
    basis: Arc<ModalBasis>,
    /// What the modes differ by from the basis, where they were found beside another assembly's.
    turned: Option<Turned>,
    damping: Vec<ModeDamping>,
    elastic: Vec<usize>,
    law: DampingLaw,
    /// What it is rebuilt from, where effects rebuild a beam.
    plain: Option<Arc<Plain>>,
}

/// An assembly without the effects that rebuild a beam, whose viscous matrix is that of the assembly with
/// them.
#[derive(Debug, Clone)]
struct Plain {
    assembly: Assembly,
    /// (Mξ_r)ᵀ φ_k of its own mode r, row by row, and the rebuilt one k: by its square the one's viscosity is
    /// the other's.
    shares: Vec<f64>,
}

impl Plain {
    /// φᵀ C φ of every rebuilt mode: C = Σ v_r (Mξ_r)(Mξ_r)ᵀ over the modes of an assembly as this one, so
    /// `damped`.
    fn viscous_diagonal(&self, damped: &[ModeDamping]) -> Vec<f64> {
        let mut all = vec![0.0; damped.len()];
        for (row, mode) in self.shares.chunks_exact(damped.len()).zip(damped) {
            all.iter_mut().zip(row).for_each(|(all, share)| *all += mode.viscous * share * share);
        }
        all
    }
}

impl Assembly {
    /// Builds matrices and modes, beams meshed finely enough for `highest_hz`.
    ///
    /// # Errors
    /// [`LumpedError::Modes`] where the eigenproblem fails, as it does for impossible masses;
    /// [`LumpedError::TooFine`].
    pub fn new(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        Assembly::by(fixture, highest_hz, |_| Vec::new())
    }

    /// As [`Assembly::new`] for responses within the band, at a fraction of the cost: modes of meshed beams
    /// by [`condensed_modes`](crate::condensed::condensed_modes).
    pub(crate) fn condensed(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        // The viscous matrix of a beam that is rebuilt is Σ v (Mξ)(Mξ)ᵀ: where v grows with λ, the least that
        // modes are not orthogonal by counts.
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
        if let Some((beam, first)) = free_beam(fixture, &places) {
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
            turned: None,
            damping: Vec::new(),
            elastic: Vec::new(),
            law,
            plain: None,
        };
        assembly.damp_by_modes(fixture);
        if rebuilds(fixture) { assembly.rebuilt(fixture, &stretches) } else { Ok(assembly) }
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
            let viscous = |r: usize| match modes.shares(r) {
                Some(shares) => {
                    shares.iter().zip(&own).map(|(share, mode)| share * share * mode.viscous).sum()
                }
                None => own[r].viscous,
            };
            let eigenvalues = modes.basis.eigenvalues();
            let damping = rebuilt_damping(&law, (0..eigenvalues.len()).map(viscous), eigenvalues);
            (modes.basis, damping)
        };
        let with = Matrices::of(fixture, &places, order, true);
        let elastic = (0..order).filter(|&r| basis.eigenvalues()[r] > 0.0).collect();
        Ok(Assembly {
            order,
            places,
            mass: with.mass,
            stiffness: with.stiffness,
            basis: Arc::new(basis),
            turned: None,
            damping,
            elastic,
            law,
            plain: None,
        })
    }

    /// The assembly with the effects that rebuild a beam body. Its viscous matrix stays that of the
    /// assembly without them; in the new modes only its diagonal is kept, an error of the order of the
    /// damping ratio times the change of shape.
    fn rebuilt(self, fixture: &Fixture, stretches: &[Stretch]) -> Result<Self, LumpedError> {
        let with = Matrices::of(fixture, &self.places, self.order, true);
        let basis = modes(self.order, &with.mass, &with.stiffness, stretches)?;
        let shares = self.shares(&basis);
        let (places, elastic) = (self.places.clone(), self.elastic.clone());
        let (order, law) = (self.order, self.law.clone());
        let plain = Plain { assembly: self, shares };
        let damping =
            rebuilt_damping(&law, plain.viscous_diagonal(&plain.assembly.damping), basis.eigenvalues());
        let plain = Some(Arc::new(plain));
        Ok(Assembly {
            order,
            places,
            mass: with.mass,
            stiffness: with.stiffness,
            basis,
            turned: None,
            damping,
            elastic,
            law,
            plain,
        })
    }

    /// Damps the modes by the fixture's law.
    fn damp_by_modes(&mut self, fixture: &Fixture) {
        let held = self.held_modes(fixture);
        (self.damping, self.elastic) = (self.law.of_held_modes(&held), elastic_modes(&held));
    }

    /// The modes with what supports are to them; nothing where no mode holds supports.
    fn held_modes(&self, fixture: &Fixture) -> Vec<HeldMode> {
        let eigenvalues = self.eigenvalues().iter();
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

    /// (Mξ_r)ᵀ φ_k of this assembly's own modes r and of every shape k of `basis`.
    fn shares(&self, basis: &ModalBasis) -> Vec<f64> {
        let momenta = products(self.order, self.basis.shapes(), &self.mass);
        products(self.order, &momenta, basis.shapes())
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

    /// λ of each mode, in no order where they were found beside another assembly's.
    pub(crate) fn eigenvalues(&self) -> &[f64] {
        self.turned.as_ref().map_or(self.basis.eigenvalues(), |turned| &turned.eigenvalues)
    }

    /// Damping of each mode.
    pub fn mode_damping(&self) -> &[ModeDamping] {
        &self.damping
    }

    /// Undamped natural frequencies in Hz, ascending; motions of a free assembly as rigid are exactly zero.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        self.basis.eigenvalues().iter().map(|l| l.max(0.0).sqrt() / TAU).collect()
    }

    /// The modes that have a damping ratio of their own, by place: not those as rigid, nor those of a
    /// suspension.
    pub fn elastic_modes(&self) -> &[usize] {
        &self.elastic
    }

    /// How the assembly is damped.
    pub fn damping_law(&self) -> &DampingLaw {
        &self.law
    }

    /// The row vector t that reads the motion at `station` from the coordinates (and spreads a load over
    /// them).
    pub fn station_row(&self, station: &Station) -> Vec<f64> {
        let mut row = vec![0.0; self.order];
        let mut read = Vec::with_capacity(2);
        self.places[station.body].add_entries(station.x, station.dof, &mut read);
        read.into_iter().for_each(|(place, t)| row[place] = t);
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
        // A station reads a few coordinates only.
        let mut read = Vec::with_capacity(2);
        self.places[station.body].add_entries(station.x, station.dof, &mut read);
        if let Some(turned) = &self.turned {
            turned.scale(&mut read);
        }
        let of_mode = |r: usize| {
            let shape = self.basis.shape(r);
            read.iter().map(|(i, t)| shape[*i] * t).sum::<f64>()
        };
        if let Some(turned) = &self.turned {
            let own: Vec<f64> = (0..self.order).map(of_mode).collect();
            return turned.add(&own, weight, all);
        }
        all.iter_mut().enumerate().for_each(|(r, value)| *value += weight * of_mode(r));
    }
}

/// Whether effects rebuild a beam.
fn rebuilds(fixture: &Fixture) -> bool {
    actions(fixture).any(|action| matches!(action, Action::OnBeam { .. }))
}

/// What damps the modes of a beam that effects rebuild.
fn rebuilt_damping(
    law: &DampingLaw,
    viscous: impl IntoIterator<Item = f64>,
    eigenvalues: &[f64],
) -> Vec<ModeDamping> {
    let structural = match law {
        DampingLaw::LossFactor(factor) => *factor,
        _ => 0.0,
    };
    let damping = viscous.into_iter().zip(eigenvalues);
    damping
        .map(|(viscous, eigenvalue)| ModeDamping { viscous, structural: structural * eigenvalue })
        .collect()
}

/// Whether the modes are those of one body without known masses.
fn is_one_free_body(fixture: &Fixture) -> bool {
    matches!(fixture.bodies(), [body] if body.masses.is_empty())
        && fixture.joints().is_empty()
        && !in_the_modes(fixture)
}

/// The fixture's only body where that is a beam without known masses, and its name. Supports are no part of
/// the free assembly.
fn free_beam(fixture: &Fixture, places: &[Coordinates]) -> Option<(UniformBeam, String)> {
    let ([body], [Coordinates::Beam { mesh, .. }]) = (fixture.bodies(), places) else { return None };
    let BodyKind::Beam(beam) = &body.kind else { return None };
    if !is_one_free_body(fixture) {
        return None;
    }
    let length = beam.length();
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
