//! Modes of one uniform free beam: a problem without dimensions, solved once for a number of elements.
//!
//! With EI, mass per length and length taken out, the matrices of a free beam of N equal elements are always the same, K̂ and M̂. Shear gives
//! every element the same ratio Φ = 12EI/(κGA h²) and the stiffness (K̂ + ΦB̂)/(1 + Φ), B̂ acting on the nodes' rotations alone; rotary
//! inertia adds ρI/(mL²)·R̂. Both are projected on the plain modes once, and a beam's modes are then those of two matrices of half the size, one of the shapes
//! that are symmetric about the middle and one of the others.

use crate::LumpedError;
use jointscope_beam::{Matrix4, consistent_mass, consistent_rotary_inertia, element_stiffness};
use jointscope_linalg::{EigenError, ModalBasis, generalized_symmetric_eigen};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// Problems of each kind remembered by a thread: a fit moves many quantities that leave them alone.
const KEPT: usize = 8;

/// A beam with everything that decides its modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UniformBeam {
    /// Number of equal elements.
    pub elements: usize,
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

/// Modes of a beam, and how much of each plain mode each of them holds.
pub(crate) struct BeamModes {
    pub basis: ModalBasis,
    of_plain: Option<Rc<Coupled>>,
}

impl BeamModes {
    /// The shares of the plain modes in mode `r`; `None` where it is plain itself.
    pub fn shares(&self, r: usize) -> Option<&[f64]> {
        let n = self.basis.order();
        self.of_plain.as_ref().map(|coupled| &coupled.shares[r * n..(r + 1) * n])
    }
}

/// Modes with shear and rotary inertia, without dimensions.
struct Coupled {
    elements: usize,
    ratio: f64,
    inertia: f64,
    eigenvalues: Vec<f64>,
    shapes: Vec<f64>,
    /// Coefficients in the plain modes, mode after mode.
    shares: Vec<f64>,
}

/// The problem without dimensions for a number of elements.
struct Dimensionless {
    order: usize,
    eigenvalues: Vec<f64>,
    /// Plain shapes over (y, Lθ) of the nodes, mode after mode.
    shapes: Vec<f64>,
    /// Φ̂ᵀB̂Φ̂ and Φ̂ᵀR̂Φ̂.
    shear: Vec<f64>,
    rotary: Vec<f64>,
}

thread_local! {
    static SOLVED: RefCell<Vec<(usize, Rc<Dimensionless>)>> = const { RefCell::new(Vec::new()) };
    static COUPLED: RefCell<VecDeque<Rc<Coupled>>> = const { RefCell::new(VecDeque::new()) };
}

impl UniformBeam {
    /// Its free modes, mass-normalised, over (y, θ) of the nodes.
    ///
    /// # Errors
    /// Matrices without modes, as those of an impossible mass or shear stiffness are.
    pub fn modes(&self) -> Result<BeamModes, LumpedError> {
        let plain = dimensionless(self.elements)?;
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

    /// Eigenvalues, ascending, and coefficients in the plain modes.
    fn coupled(&self, plain: &Dimensionless) -> Result<Rc<Coupled>, LumpedError> {
        let n = plain.order;
        let step = self.length / self.elements as f64;
        let ratio = 12.0 * self.shear / (step * step);
        let inertia = self.rotary_inertia / (self.mass_per_length * self.length * self.length);
        let known = COUPLED.with_borrow(|all| {
            let same = |c: &&Rc<Coupled>| (c.elements, c.ratio, c.inertia) == (self.elements, ratio, inertia);
            all.iter().find(same).map(Rc::clone)
        });
        if let Some(known) = known {
            return Ok(known);
        }
        let stiffness = |i: usize, j: usize| {
            let own = if i == j { plain.eigenvalues[i] } else { 0.0 };
            (own + ratio * plain.shear[i * n + j]) / (1.0 + ratio)
        };
        let mass = |i: usize, j: usize| f64::from(u8::from(i == j)) + inertia * plain.rotary[i * n + j];
        let mut found: Vec<(f64, Vec<f64>)> = Vec::with_capacity(n);
        for parity in [0, 1] {
            let members: Vec<usize> = (parity..n).step_by(2).collect();
            let block = |element: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
                members
                    .iter()
                    .flat_map(|&i| members.iter().map(move |&j| (i, j)))
                    .map(|(i, j)| element(i, j))
                    .collect()
            };
            let modes = generalized_symmetric_eigen(members.len(), &block(&mass), &block(&stiffness))?;
            for (r, &value) in modes.eigenvalues().iter().enumerate() {
                let mut row = vec![0.0; n];
                members.iter().zip(modes.shape(r)).for_each(|(&i, share)| row[i] = *share);
                found.push((value, row));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut shapes = vec![0.0; n * n];
        for (to, (_, row)) in shapes.chunks_exact_mut(n).zip(&found) {
            for (share, shape) in row.iter().zip(plain.shapes.chunks_exact(n)).filter(|(c, _)| **c != 0.0) {
                to.iter_mut().zip(shape).for_each(|(to, s)| *to += share * s);
            }
        }
        let coupled = Rc::new(Coupled {
            elements: self.elements,
            ratio,
            inertia,
            eigenvalues: found.iter().map(|(value, _)| *value).collect(),
            shapes,
            shares: found.into_iter().flat_map(|(_, row)| row).collect(),
        });
        COUPLED.with_borrow_mut(|all| {
            all.truncate(KEPT - 1);
            all.push_front(Rc::clone(&coupled));
        });
        Ok(coupled)
    }
}

fn dimensionless(elements: usize) -> Result<Rc<Dimensionless>, LumpedError> {
    let known = SOLVED.with_borrow(|solved| solved.iter().find(|s| s.0 == elements).map(|s| Rc::clone(&s.1)));
    if let Some(known) = known {
        return Ok(known);
    }
    let new = Rc::new(solve(elements)?);
    SOLVED.with_borrow_mut(|solved| {
        if solved.len() >= KEPT {
            solved.remove(0);
        }
        solved.push((elements, Rc::clone(&new)));
    });
    Ok(new)
}

fn solve(elements: usize) -> Result<Dimensionless, LumpedError> {
    let order = 2 * (elements + 1);
    let step = 1.0 / elements as f64;
    // What shear adds to the stiffness of an element of EI = 1: 12, 6, 4, 2 stay, and the rotations get ±Φ.
    let sheared: Matrix4 = {
        let own = 1.0 / step;
        [[0.0; 4], [0.0, own, 0.0, -own], [0.0; 4], [0.0, -own, 0.0, own]]
    };
    let assembled = |element: &Matrix4| {
        let mut matrix = vec![0.0; order * order];
        for first in (0..elements).map(|e| 2 * e) {
            for i in 0..4 {
                for j in 0..4 {
                    matrix[(first + i) * order + first + j] += element[i][j];
                }
            }
        }
        matrix
    };
    let mass = assembled(&consistent_mass(1.0, step));
    let basis = generalized_symmetric_eigen(order, &mass, &assembled(&element_stiffness(1.0, step)))?;
    let mut eigenvalues = basis.eigenvalues().to_vec();
    // The rigid motions come in any mixture; modes alternate between symmetric and not only if these do too.
    eigenvalues[..2].fill(0.0);
    let node = |i: usize| (i / 2) as f64 * step - 0.5;
    let mut shapes: Vec<f64> = (0..order).map(|i| if i % 2 == 0 { 1.0 } else { 0.0 }).collect();
    shapes.extend((0..order).map(|i| 12f64.sqrt() * if i % 2 == 0 { node(i) } else { 1.0 }));
    (2..order).for_each(|r| shapes.extend_from_slice(basis.shape(r)));
    let shear = projected(&assembled(&sheared), &shapes, order);
    let rotary = projected(&assembled(&consistent_rotary_inertia(1.0, step)), &shapes, order);
    Ok(Dimensionless { order, eigenvalues, shapes, shear, rotary })
}

/// Φᵀ A Φ.
fn projected(matrix: &[f64], shapes: &[f64], order: usize) -> Vec<f64> {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut all = vec![0.0; order * order];
    for (j, shape) in shapes.chunks_exact(order).enumerate() {
        let image: Vec<f64> = matrix.chunks_exact(order).map(|row| product(row, shape)).collect();
        for (i, other) in shapes.chunks_exact(order).enumerate() {
            all[i * order + j] = product(other, &image);
        }
    }
    all
}
