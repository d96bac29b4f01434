//! Modes of one uniform free beam: a problem without dimensions, solved once for a mesh.
//!
//! With EI, mass per length and length taken out, the matrices of a free beam are always the same for one
//! mesh, K̂ and M̂. Shear gives an element of length h the ratio Φ = 12EI/(κGA h²) and the stiffness
//! (K̂ + ΦB̂)/(1 + Φ), B̂ acting on its nodes' rotations alone; rotary inertia adds ρI/(mL²)·R̂. Both are
//! projected on the plain modes. Where all elements are equal, that is done once for all Φ, and a beam's
//! modes are then those of two matrices of half the size, one of the shapes that are symmetric about the
//! middle and one of the others.

use crate::LumpedError;
use jointscope_beam::{
    Matrix4, consistent_mass, consistent_rotary_inertia, element_stiffness, shear_element_stiffness,
};
use jointscope_linalg::{EigenError, ModalBasis, generalized_symmetric_eigen, products};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// Problems of each kind remembered by a thread: a fit moves many quantities that leave them alone.
const KEPT: usize = 8;
/// Of those with shear: derivatives solve several beside the one that they are taken at.
const KEPT_COUPLED: usize = 32;

/// A beam with everything that decides its modes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UniformBeam {
    /// Where its elements are.
    pub mesh: UnitMesh,
    /// m.
    pub length: f64,
    /// EI, N·m².
    pub bending_stiffness: f64,
    /// kg/m.
    pub mass_per_length: f64,
    /// EI/κGA, m²; zero without shear.
    pub shear: f64,
    /// ρI, kg·m.
    pub rotary_inertia: f64,
}

/// The mesh of a beam of length one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UnitMesh {
    /// So many equal elements.
    Even(usize),
    /// Nodes, from 0 to 1.
    Nodes(Vec<f64>),
}

impl UnitMesh {
    fn elements(&self) -> usize {
        match self {
            UnitMesh::Even(elements) => *elements,
            UnitMesh::Nodes(nodes) => nodes.len() - 1,
        }
    }

    /// Number of coordinates: y and Lθ of each node.
    fn order(&self) -> usize {
        2 * (self.elements() + 1)
    }

    fn node(&self, index: usize) -> f64 {
        match self {
            UnitMesh::Even(elements) => index as f64 / *elements as f64,
            UnitMesh::Nodes(nodes) => nodes[index],
        }
    }

    /// The matrix of all elements, `element` giving that of one by its length.
    fn assembled(&self, element: impl Fn(f64) -> Matrix4) -> Vec<f64> {
        let order = self.order();
        let mut matrix = vec![0.0; order * order];
        for index in 0..self.elements() {
            let element = element(self.step(index));
            for i in 0..4 {
                for j in 0..4 {
                    matrix[(2 * index + i) * order + 2 * index + j] += element[i][j];
                }
            }
        }
        matrix
    }

    fn step(&self, element: usize) -> f64 {
        match self {
            UnitMesh::Even(elements) => 1.0 / *elements as f64,
            UnitMesh::Nodes(nodes) => nodes[element + 1] - nodes[element],
        }
    }
}

/// Modes of a beam, and how much of each plain mode each of them holds.
pub(crate) struct BeamModes {
    pub basis: ModalBasis,
    of_plain: Option<Rc<Coupled>>,
}

impl BeamModes {
    /// The shares of the plain modes in mode `r`; `None` where it is plain itself.
    pub(crate) fn shares(&self, r: usize) -> Option<&[f64]> {
        let n = self.basis.order();
        self.of_plain.as_ref().map(|coupled| &coupled.shares[r * n..(r + 1) * n])
    }
}

/// Modes with shear and rotary inertia, without dimensions.
struct Coupled {
    mesh: UnitMesh,
    /// EI/(κGA L²).
    shear: f64,
    inertia: f64,
    eigenvalues: Vec<f64>,
    shapes: Vec<f64>,
    /// Coefficients in the plain modes, mode after mode.
    shares: Vec<f64>,
}

/// The problem without dimensions for a mesh.
struct Dimensionless {
    mesh: UnitMesh,
    order: usize,
    eigenvalues: Vec<f64>,
    /// Plain shapes over (y, Lθ) of the nodes, mode after mode.
    shapes: Vec<f64>,
    /// Φ̂ᵀB̂Φ̂ where all elements have one Φ, and Φ̂ᵀR̂Φ̂.
    shear: Option<Vec<f64>>,
    rotary: Vec<f64>,
}

thread_local! {
    static SOLVED: RefCell<Vec<Rc<Dimensionless>>> = const { RefCell::new(Vec::new()) };
    static COUPLED: RefCell<VecDeque<Rc<Coupled>>> = const { RefCell::new(VecDeque::new()) };
}

impl UniformBeam {
    /// Its free modes, mass-normalised, over (y, θ) of the nodes.
    ///
    /// # Errors
    /// Matrices without modes, as those of an impossible mass or shear stiffness are.
    pub(crate) fn modes(&self) -> Result<BeamModes, LumpedError> {
        let plain = dimensionless(&self.mesh)?;
        let n = plain.order;
        let altered = self.shear != 0.0 || self.rotary_inertia != 0.0;
        let coupled = if altered { Some(self.coupled(&plain)?) } else { None };
        let (values, shapes) = match &coupled {
            Some(coupled) => (&coupled.eigenvalues, &coupled.shapes),
            None => (&plain.eigenvalues, &plain.shapes),
        };
        let stiffness = self.bending_stiffness / (self.mass_per_length * self.length.powi(4));
        let translation = 1.0 / (self.mass_per_length * self.length).sqrt();
        let rotation = translation / self.length;
        let scaled =
            shapes.iter().enumerate().map(|(k, s)| s * if k % 2 == 0 { translation } else { rotation });
        let basis = ModalBasis::new(values.iter().map(|v| v * stiffness).collect(), scaled.collect())
            .ok_or(EigenError::Shape { order: n })?;
        Ok(BeamModes { basis, of_plain: coupled })
    }

    fn coupled(&self, plain: &Dimensionless) -> Result<Rc<Coupled>, LumpedError> {
        let n = plain.order;
        let shear = self.shear / (self.length * self.length);
        let inertia = self.rotary_inertia / (self.mass_per_length * self.length * self.length);
        let known = COUPLED.with_borrow(|all| {
            let same = |c: &&Rc<Coupled>| c.shear == shear && c.inertia == inertia && c.mesh == self.mesh;
            all.iter().find(same).map(Rc::clone)
        });
        if let Some(known) = known {
            return Ok(known);
        }
        let stiffness = plain.sheared(shear);
        let mass = |i: usize, j: usize| f64::from(u8::from(i == j)) + inertia * plain.rotary[i * n + j];
        // Shapes that are symmetric about the middle and those that are not have nothing in common.
        let apart: Vec<Vec<usize>> = match plain.shear {
            Some(_) => (0..2).map(|parity| (parity..n).step_by(2).collect()).collect(),
            None => vec![(0..n).collect()],
        };
        let mut found: Vec<(f64, Vec<f64>)> = Vec::with_capacity(n);
        for members in apart {
            let block = |element: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
                members
                    .iter()
                    .flat_map(|&i| members.iter().map(move |&j| (i, j)))
                    .map(|(i, j)| element(i, j))
                    .collect()
            };
            let stiffness = block(&|i, j| stiffness[i * n + j]);
            let modes = generalized_symmetric_eigen(members.len(), &block(&mass), &stiffness)?;
            for (r, &value) in modes.eigenvalues().iter().enumerate() {
                let mut row = vec![0.0; n];
                members.iter().zip(modes.shape(r)).for_each(|(&i, share)| row[i] = *share);
                found.push((value, row));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut shapes = vec![0.0; n * n];
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                for (to, (_, row)) in shapes.chunks_exact_mut(n).zip(&found) {
                    let shares = row.iter().zip(plain.shapes.chunks_exact(n));
                    for (share, shape) in shares.filter(|(share, _)| **share != 0.0) {
                        to.iter_mut().zip(shape).for_each(|(to, s)| *to += share * s);
                    }
                }
            },
        );
        let coupled = Rc::new(Coupled {
            mesh: self.mesh.clone(),
            shear,
            inertia,
            eigenvalues: found.iter().map(|(value, _)| *value).collect(),
            shapes,
            shares: found.into_iter().flat_map(|(_, row)| row).collect(),
        });
        COUPLED.with_borrow_mut(|all| {
            all.truncate(KEPT_COUPLED - 1);
            all.push_front(Rc::clone(&coupled));
        });
        Ok(coupled)
    }
}

fn dimensionless(mesh: &UnitMesh) -> Result<Rc<Dimensionless>, LumpedError> {
    let known = SOLVED.with_borrow(|solved| solved.iter().find(|s| s.mesh == *mesh).map(Rc::clone));
    if let Some(known) = known {
        return Ok(known);
    }
    let new = Rc::new(Dimensionless::of(mesh.clone())?);
    SOLVED.with_borrow_mut(|solved| {
        if solved.len() >= KEPT {
            solved.remove(0);
        }
        solved.push(Rc::clone(&new));
    });
    Ok(new)
}

impl Dimensionless {
    fn of(mesh: UnitMesh) -> Result<Self, LumpedError> {
        let order = mesh.order();
        let mass = mesh.assembled(|step| consistent_mass(1.0, step));
        let stiffness = mesh.assembled(|step| element_stiffness(1.0, step));
        let basis = generalized_symmetric_eigen(order, &mass, &stiffness)?;
        let mut eigenvalues = basis.eigenvalues().to_vec();
        // The rigid motions come in any mixture; modes alternate between symmetric and not only if these do
        // too.
        eigenvalues[..2].fill(0.0);
        let node = |i: usize| mesh.node(i / 2) - 0.5;
        let mut shapes: Vec<f64> = (0..order).map(|i| if i % 2 == 0 { 1.0 } else { 0.0 }).collect();
        shapes.extend((0..order).map(|i| 12f64.sqrt() * if i % 2 == 0 { node(i) } else { 1.0 }));
        (2..order).for_each(|r| shapes.extend_from_slice(basis.shape(r)));
        let even = matches!(mesh, UnitMesh::Even(_));
        let shear = even.then(|| projected(&mesh.assembled(rotations), &shapes, order));
        let rotary = projected(&mesh.assembled(|step| consistent_rotary_inertia(1.0, step)), &shapes, order);
        Ok(Dimensionless { mesh, order, eigenvalues, shapes, shear, rotary })
    }

    /// The stiffness with EI/(κGA L²) = `shear`, between the plain modes.
    fn sheared(&self, shear: f64) -> Vec<f64> {
        let n = self.order;
        let mut matrix = match &self.shear {
            Some(rotations) => {
                let ratio = 12.0 * shear * (self.mesh.elements() as f64).powi(2);
                let mut matrix: Vec<f64> = rotations.iter().map(|b| b * ratio / (1.0 + ratio)).collect();
                (0..n).for_each(|i| matrix[i * n + i] += self.eigenvalues[i] / (1.0 + ratio));
                return matrix;
            }
            None if shear == 0.0 => self.mesh.assembled(|step| element_stiffness(1.0, step)),
            None => self.mesh.assembled(|step| shear_element_stiffness(1.0, 1.0 / shear, step)),
        };
        matrix = projected(&matrix, &self.shapes, n);
        // Rigid motions bend and shear nothing; rounding must not say otherwise.
        for i in 0..n {
            for rigid in 0..2 {
                matrix[i * n + rigid] = 0.0;
                matrix[rigid * n + i] = 0.0;
            }
        }
        matrix
    }
}

/// What shear adds to the stiffness of an element of EI = 1: 12, 6, 4, 2 stay, and the rotations get ±Φ.
fn rotations(step: f64) -> Matrix4 {
    let own = 1.0 / step;
    [[0.0; 4], [0.0, own, 0.0, -own], [0.0; 4], [0.0, -own, 0.0, own]]
}

/// Entries beside the diagonal of an assembled matrix: an element has four coordinates.
const BAND: usize = 3;

/// Φᵀ A Φ of a matrix of elements.
fn projected(matrix: &[f64], shapes: &[f64], order: usize) -> Vec<f64> {
    let image = |shape: &[f64]| -> Vec<f64> {
        let row = |i: usize| {
            let near = i.saturating_sub(BAND)..(i + BAND + 1).min(order);
            near.map(|j| matrix[i * order + j] * shape[j]).sum()
        };
        (0..order).map(row).collect()
    };
    let images: Vec<f64> = shapes.chunks_exact(order).flat_map(image).collect();
    products(order, shapes, &images)
}
