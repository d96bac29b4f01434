//! A fixture as a deformable solid: its mesh, matrices and lowest modes.

use crate::assembly::Matrices;
use crate::{BrickOwner, FemError, Mesh, MeshOptions};
use jointscope_fixture::{BodyKind, Fixture};
use jointscope_linalg::{ModesWanted, SparseModes, lowest_modes};
use std::f64::consts::TAU;

/// A fixture's finite-element twin: its mesh, matrices and lowest modes.
pub struct Twin {
    pub(crate) fixture: Fixture,
    /// The mesh.
    pub mesh: Mesh,
    /// Mass and stiffness.
    pub matrices: Matrices,
    /// The lowest modes of the free assembly, without supports and point masses.
    pub modes: SparseModes,
    /// How each mode is counted, in their order.
    pub kinds: Vec<ModeKind>,
    /// All modes up to this frequency are known, Hz.
    pub complete_to: f64,
}

/// What a mode is to a transverse hammer test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeKind {
    /// It moves some point of the fixture transversely: a mode of interest, with a damping ratio of its own.
    Transverse,
    /// It does not: axial, torsional or sideways.
    Other,
}

/// φ²·m at the points below which a mode does not count as transverse, m the mass of the assembly.
const BARELY_MOVES: f64 = 1e-4;

/// How far the work has come, for whoever watches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// The mesh is made: nodes, elements.
    Meshed(usize, usize),
    /// The matrices are assembled: equations.
    Assembled(usize),
    /// So many modes are found, of so many wanted at the least.
    Modes(usize, usize),
}

/// How many modes are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeRange {
    /// At least so many besides the rigid ones.
    pub at_least: usize,
    /// And all up to this frequency, Hz.
    pub up_to: f64,
}

impl Twin {
    /// Meshes a fixture's geometry and finds its modes.
    ///
    /// # Errors
    /// See [`FemError`].
    pub fn of(
        fixture: &Fixture,
        options: &MeshOptions,
        range: ModeRange,
        progress: impl FnMut(Progress),
    ) -> Result<Self, FemError> {
        if let Some((index, effect)) = fixture.physics().iter().enumerate().next() {
            return Err(FemError::Effect { index, kind: effect.kind.name() });
        }
        let mesh = Mesh::of(fixture, options)?;
        Self::of_mesh(fixture, mesh, range, progress)
    }

    /// Finds the modes of a mesh of the fixture's geometry, whose materials may have been changed since
    /// [`Mesh::of`] made it.
    ///
    /// # Errors
    /// See [`FemError`].
    pub fn of_mesh(
        fixture: &Fixture,
        mesh: Mesh,
        range: ModeRange,
        mut progress: impl FnMut(Progress),
    ) -> Result<Self, FemError> {
        progress(Progress::Meshed(mesh.nodes.len(), mesh.elements.len()));
        let matrices = Matrices::of(&mesh, |_, _| false)?;
        progress(Progress::Assembled(matrices.order()));
        // Low against the first elastic mode, high enough for the factor to keep its digits.
        let shift = (TAU * 0.1 * range.up_to.max(1.0)).powi(2);
        let wanted = ModesWanted { at_least: range.at_least, up_to: (TAU * range.up_to).powi(2) };
        let modes = lowest_modes(
            &matrices.stiffness,
            &matrices.mass,
            &matrices.rigid,
            shift,
            wanted,
            |found, of| {
                progress(Progress::Modes(found, of));
            },
        )?;
        let mut twin = Twin {
            fixture: fixture.clone(),
            mesh,
            matrices,
            modes,
            kinds: Vec::new(),
            complete_to: range.up_to,
        };
        twin.kinds = twin.classify()?;
        Ok(twin)
    }

    fn classify(&self) -> Result<Vec<ModeKind>, FemError> {
        let points = self.fixture.points();
        let rows: Vec<_> = (0..points.len()).map(|i| self.point(i, false)).collect::<Result<_, _>>()?;
        let mass = self.mass() * if self.mesh.whole { 1.0 } else { 0.5 };
        let kind = |shape: &Vec<f64>| {
            let largest = rows.iter().map(|row| read(row, shape).powi(2)).fold(0.0, f64::max);
            if largest * mass > BARELY_MOVES { ModeKind::Transverse } else { ModeKind::Other }
        };
        Ok(self.modes.shapes.iter().map(kind).collect())
    }

    /// Counts the modes of the mesh below a frequency just above the last one anew, and compares with those
    /// at hand, as was done when they were found.
    ///
    /// # Errors
    /// A mode that is missing, or no certain count.
    pub fn check_complete(&self) -> Result<(), FemError> {
        Ok(self.modes.check_complete(&self.matrices.stiffness, &self.matrices.mass)?)
    }

    /// Frequencies of the elastic modes, Hz, ascending.
    pub fn frequencies(&self) -> Vec<f64> {
        self.modes.eigenvalues.iter().map(|value| value.max(0.0).sqrt() / TAU).collect()
    }

    /// Mass of the meshed assembly, both halves, kg.
    pub fn mass(&self) -> f64 {
        let unit: Vec<f64> = {
            let mut unit = vec![0.0; self.matrices.order()];
            for equation in self.matrices.equations.iter().skip(1).step_by(3).flatten() {
                unit[*equation] = 1.0;
            }
            unit
        };
        self.matrices.mass.quadratic(&unit) * if self.mesh.whole { 1.0 } else { 2.0 }
    }

    /// Largest frequency that a rigid motion shows in the strains of the mesh, relative to the first elastic
    /// mode's: zero but for rounding.
    pub fn rigid_frequency(&self) -> f64 {
        let first = self.modes.eigenvalues.first().copied().unwrap_or(f64::INFINITY);
        let quotient = |motion: &Vec<f64>| self.matrices.rayleigh_quotient(&self.mesh, motion).abs();
        (self.modes.rigid.iter().map(quotient).fold(0.0, f64::max) / first).sqrt()
    }

    /// What reads the transverse motion (or slope) of a fixture's point, on the upper face of its body unless
    /// `geometry` says otherwise.
    pub(crate) fn point(&self, index: usize, slope: bool) -> Result<Vec<(usize, f64)>, FemError> {
        let point = &self.fixture.points()[index];
        let geometry = self.fixture.geometry().ok_or(FemError::NoGeometry)?;
        let body = &geometry.bodies[point.body];
        let stated = geometry.point_heights.iter().find(|(i, _)| *i == index).map(|(_, y)| y.value);
        let y = stated.unwrap_or(body.y.value + 0.5 * body.height.value);
        self.station(point.body, point.x.value, y, slope)
    }

    /// What reads the transverse motion (or slope) of a body at an abscissa, on its upper face.
    pub(crate) fn on_body(&self, body: usize, x: f64, slope: bool) -> Result<Vec<(usize, f64)>, FemError> {
        let geometry = self.fixture.geometry().ok_or(FemError::NoGeometry)?;
        let solid = &geometry.bodies[body];
        self.station(body, x, solid.y.value + 0.5 * solid.height.value, slope)
    }

    fn station(&self, body: usize, x: f64, y: f64, slope: bool) -> Result<Vec<(usize, f64)>, FemError> {
        self.matrices.observation(&self.mesh, BrickOwner::Body(body), x, y, slope).ok_or(FemError::NoGeometry)
    }

    /// Where the boxes of `geometry` and the fixture's rigid bodies differ in mass, inertia or centre of
    /// gravity by more than the share `tolerance`, a sentence for each.
    pub fn disagreements(&self, tolerance: f64) -> Vec<String> {
        let Some(geometry) = self.fixture.geometry() else { return Vec::new() };
        let mut found = Vec::new();
        for (body, solid) in self.fixture.bodies().iter().zip(&geometry.bodies) {
            let BodyKind::Rigid(rigid) = &body.kind else { continue };
            let material = &geometry.materials[solid.material].1;
            let mut compare = |what: &str, stated: f64, solid: f64, scale: f64, unit: &str| {
                if (stated - solid).abs() > tolerance * scale {
                    found.push(format!(
                        "body {}: the fixture states {what} {stated:.6} {unit}, its box has {solid:.6} {unit}",
                        body.name
                    ));
                }
            };
            let mass = solid.mass(material);
            compare("a mass of", rigid.mass.value, mass, mass, "kg");
            if let Some(inertia) = &rigid.inertia {
                let own = solid.inertia(material);
                compare("an inertia of", inertia.value, own, own, "kg m^2");
            }
            if let Some(x) = &rigid.x_cg {
                compare(
                    "a centre of gravity at",
                    x.value,
                    solid.x_cg(),
                    solid.to.value - solid.from.value,
                    "m",
                );
            }
        }
        found
    }
}

/// Value of a functional on a vector over the equations.
pub(crate) fn read(row: &[(usize, f64)], vector: &[f64]) -> f64 {
    row.iter().map(|(equation, weight)| weight * vector[*equation]).sum()
}
