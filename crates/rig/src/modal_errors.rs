//! A structure that is a little wrong in every mode: what no fixture describes, and every real structure has.
//!
//! The structure is written on its undamped modes, M = I and K = diag ω²; coordinates without mass follow the
//! others statically, K_mm⁻¹K_mi, and keep what they do beyond that. This changes nothing: damping and laws
//! are carried over whole, VᵀCV. Then every natural frequency, damping ratio and shape gets an error of its
//! own.

use crate::physical::RIGID;
use crate::random::normal;
use crate::{Assembly, Instrument, Law, Row, Structure, StructureError, read};
use jointscope_fixture::Fixture;
use jointscope_linalg::{Cholesky, generalized_symmetric_eigen};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use rand::Rng;
use serde::{Deserialize, Serialize};

/// Standard deviations of the errors, relative.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UsualErrors {
    /// Of natural frequencies.
    pub frequency: f64,
    /// Of damping ratios.
    pub damping: f64,
    /// Of the shape at a point, against its root mean square over the points.
    pub shape: f64,
}

/// Errors of every mode with a frequency, in ascending order; modes beyond the lists have none.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ModalErrors {
    /// Of natural frequencies, relative.
    pub frequency: Vec<f64>,
    /// Of damping ratios, relative.
    pub damping: Vec<f64>,
    /// Of shapes, mode by mode, at the fixture's points in their order, relative to the root mean square over
    /// these.
    pub shape: Vec<Vec<f64>>,
}

impl ModalErrors {
    /// Normal errors for all modes of a structure.
    ///
    /// # Errors
    /// As [`ModalErrors::frfs`].
    pub fn draw(rng: &mut impl Rng, fixture: &Fixture, usual: &UsualErrors) -> Result<Self, StructureError> {
        let count = OnModes::of(&Structure::of(fixture)?)?.elastic().count();
        let mut normals = |count: usize, deviation: f64| -> Vec<f64> {
            (0..count).map(|_| deviation * normal(rng)).collect()
        };
        Ok(ModalErrors {
            frequency: normals(count, usual.frequency),
            // A ratio keeps its sign.
            damping: normals(count, usual.damping).into_iter().map(|error| error.max(-0.9)).collect(),
            shape: (0..count).map(|_| normals(fixture.points().len(), usual.shape)).collect(),
        })
    }

    /// Noise-free accelerances of the assembly that `fixture` describes with these errors in its modes.
    ///
    /// # Errors
    /// As [`crate::frfs`]; [`StructureError::Modes`] where a structure has no undamped modes, such as one
    /// with a negative mass.
    pub fn frfs(
        &self,
        fixture: &Fixture,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Result<FrfSet, StructureError> {
        let structure = Structure::of(fixture)?;
        read(&self.within(fixture, &structure)?, instrument.effects(fixture), pairs, lines)
    }

    fn within(&self, fixture: &Fixture, structure: &Structure) -> Result<Structure, StructureError> {
        let modes = OnModes::of(structure)?;
        let mut assembly = structure.assembly().on_shapes(&modes.shapes);
        let mut factors = vec![1.0; modes.shapes.len()];
        let mut departures = vec![Vec::new(); modes.shapes.len()];
        let of = |list: &[f64], which: usize| list.get(which).copied().unwrap_or(0.0);
        for (which, mode) in modes.elastic().enumerate() {
            let (faster, eigenvalue) = (1.0 + of(&self.frequency, which), modes.eigenvalues[mode]);
            assembly.spring(&Row::coordinate(mode), (faster * faster - 1.0) * eigenvalue, Law::ELASTIC);
            // 2ζω on the diagonal.
            factors[mode] = ((1.0 + of(&self.damping, which)) * faster).sqrt();
            if let Some(errors) = self.shape.get(which) {
                let motions =
                    fixture.points().iter().map(|point| modes.at_point(structure, &point.name, mode));
                let squares: Vec<f64> = motions.map(|motion| motion * motion).collect();
                let rms = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
                departures[mode] = errors.iter().map(|error| rms * error).collect();
            }
        }
        assembly.scale_damping(|i, j| factors[i] * factors[j]);
        let points = fixture.points();
        Ok(structure.on(assembly, |name, row| {
            let index = points.iter().position(|point| point.name == name);
            let off = |mode: usize| index.and_then(|i| departures[mode].get(i)).copied().unwrap_or(0.0);
            let coordinates = (0..modes.shapes.len()).map(|mode| (mode, modes.along(row, mode) + off(mode)));
            coordinates.fold(Row::zero(), |sum, (mode, factor)| sum.plus(factor, &Row::coordinate(mode)))
        }))
    }
}

/// Modes as shapes over the coordinates, and after them what coordinates without mass do by themselves.
struct OnModes {
    eigenvalues: Vec<f64>,
    shapes: Vec<Vec<f64>>,
}

impl OnModes {
    fn of(structure: &Structure) -> Result<Self, StructureError> {
        let assembly: &Assembly = structure.assembly();
        let order = assembly.order();
        let (mass, stiffness) = (assembly.mass_matrix(), assembly.stiffness_matrix());
        let (heavy, light): (Vec<usize>, Vec<usize>) =
            (0..order).partition(|i| (0..order).any(|j| mass[i * order + j] != 0.0));
        let shapes = followed(&stiffness, order, &heavy, &light)?;
        let reduced = assembly.on_shapes(&shapes);
        let basis =
            generalized_symmetric_eigen(heavy.len(), &reduced.mass_matrix(), &reduced.stiffness_matrix())?;
        let of_mode = |mode: usize| {
            let mut shape = vec![0.0; order];
            for (factor, motion) in basis.shape(mode).iter().zip(&shapes) {
                shape.iter_mut().zip(motion).for_each(|(s, m)| *s += factor * m);
            }
            shape
        };
        let alone = light.iter().map(|&i| {
            let mut shape = vec![0.0; order];
            shape[i] = 1.0;
            shape
        });
        Ok(OnModes {
            eigenvalues: basis.eigenvalues().to_vec(),
            shapes: (0..heavy.len()).map(of_mode).chain(alone).collect(),
        })
    }

    /// The modes that have a frequency.
    fn elastic(&self) -> impl Iterator<Item = usize> {
        let largest = self.eigenvalues.last().copied().unwrap_or(0.0);
        (0..self.eigenvalues.len()).filter(move |mode| self.eigenvalues[*mode] > RIGID * largest)
    }

    /// A motion in a mode of unit amplitude.
    fn along(&self, row: &Row, mode: usize) -> f64 {
        row.terms().iter().map(|&(i, factor)| factor * self.shapes[mode][i]).sum()
    }

    fn at_point(&self, structure: &Structure, point: &str, mode: usize) -> f64 {
        let channel = jointscope_spectra::Channel::transverse(point);
        structure.motion(&channel).map_or(0.0, |row| self.along(row, mode))
    }
}

/// Motions of one coordinate with mass each, those without following statically.
fn followed(
    stiffness: &[f64],
    order: usize,
    heavy: &[usize],
    light: &[usize],
) -> Result<Vec<Vec<f64>>, StructureError> {
    let own: Vec<f64> =
        light.iter().flat_map(|i| light.iter().map(move |j| stiffness[i * order + j])).collect();
    let factor = if light.is_empty() { None } else { Some(Cholesky::of(light.len(), &own)) };
    heavy
        .iter()
        .map(|&moved| {
            let mut shape = vec![0.0; order];
            shape[moved] = 1.0;
            if let Some(factor) = &factor {
                let held = factor.as_ref().ok_or(StructureError::Singular { frequency: 0.0 })?;
                let mut pulled: Vec<f64> = light.iter().map(|i| -stiffness[i * order + moved]).collect();
                held.solve_in_place(&mut pulled);
                light.iter().zip(pulled).for_each(|(i, value)| shape[*i] = value);
            }
            Ok(shape)
        })
        .collect()
}
