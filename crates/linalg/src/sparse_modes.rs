//! The lowest modes of a sparse pencil.
//!
//! faer's own partial eigensolver is as exact, must be told how many modes there are, and is faster only
//! where there are ten or more (`docs/records/2026-11-26-partial-eigensolver.md`).

use crate::sparse::SparseError;
use crate::sparse_inertia::count_below;
use crate::sparse_space::{Random, Space};
use crate::{EigenError, SparseCholesky, SparseSymmetric, dot, generalized_symmetric_eigen};
use std::f64::consts::TAU;

/// How many modes are to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModesWanted {
    /// At least so many, besides the known ones.
    pub at_least: usize,
    /// And all whose eigenvalue is not above this, (rad/s)².
    pub up_to: f64,
}

/// The lowest undamped modes of a sparse pencil, mass-normalised, and the factor they were found with.
pub struct SparseModes {
    /// Motions without stiffness, M-orthonormal, one after the other; their eigenvalue is zero.
    pub rigid: Vec<Vec<f64>>,
    /// Eigenvalues λ_r of the other modes, ascending, (rad/s)².
    pub eigenvalues: Vec<f64>,
    /// Their shapes, Ξᵀ M Ξ = I.
    pub shapes: Vec<Vec<f64>>,
    /// Largest (1 + s/λ) ‖(K + sM)⁻¹(Kφ − λMφ)‖ in the norm of M over the modes: what bounds the relative
    /// error of λ.
    pub residual: f64,
    /// The shift s of the factor.
    pub shift: f64,
    /// The factor of K + s M.
    pub factor: SparseCholesky,
    /// A shift between the last mode and the next, (rad/s)²: below it no mode is missing, by count. Infinite
    /// where these are all modes there are.
    pub complete_below: f64,
}

impl SparseModes {
    /// Counts the eigenvalues below [`complete_below`](Self::complete_below) anew and compares with the modes
    /// at hand.
    ///
    /// # Errors
    /// [`SparseError::Missing`] where the count is another one; no certain count.
    pub fn check_complete(
        &self,
        stiffness: &SparseSymmetric,
        mass: &SparseSymmetric,
    ) -> Result<(), SparseError> {
        let found = self.rigid.len() + self.eigenvalues.len();
        let counted = match self.complete_below.is_finite() {
            true => count_below(stiffness, mass, self.complete_below, &self.factor.elimination)?,
            false => mass.order(),
        };
        if found == counted { Ok(()) } else { Err(missing(found, counted, self.complete_below)) }
    }
}

fn missing(found: usize, counted: usize, below: f64) -> SparseError {
    SparseError::Missing { found, counted, hz: below.max(0.0).sqrt() / TAU }
}

/// Vectors that are found at a time; of modes of higher multiplicity some are missed at first, and found
/// after the count.
const BLOCK: usize = 4;

/// The Krylov space ends at so many vectors for each mode that is wanted, and some.
const VECTORS_A_MODE: usize = 8;

/// Modes below the wanted frequency that are looked for at the most: a vector of each is held, and every step
/// works on all.
const MOST_MODES: usize = 400;

/// Modes known to lie below the wanted frequency from which on all of them are counted before the search goes
/// on: of moduli a million times too small every vector is such a mode.
const MANY_MODES: usize = 64;

/// Residual of a Ritz pair of (K + sM)⁻¹M, relative to its value, at which it counts as found.
const CONVERGED: f64 = 1e-10;

/// Largest residual of a mode that is handed out: half of it is the most that its frequency can be off by.
const RESIDUAL_ALLOWED: f64 = 1e-4;

/// Modes closer than this share of their eigenvalue are handed out together: the count is taken in a wider
/// gap, where it is certain.
const GAP: f64 = 1e-3;

/// Where the count says that modes are missing, at most so many new start vectors are brought in at a time,
/// so many times, and each time the search goes on for as many steps before it asks again.
const FRESH: usize = 16;
const FRESH_BLOCKS: usize = 4;
const STEPS_A_FRESH_BLOCK: usize = 12;

/// The lowest modes of K φ = λ M φ by block Lanczos on (K + sM)⁻¹M with full reorthogonalisation,
/// s = `shift` > 0, none left out.
///
/// `rigid` are the motions that cost no energy, known beforehand; the search goes on in their complement, so
/// that no zero of multiplicity six competes with the modes. They need not be normalised. `progress` is told
/// how many modes are found, of how many wanted.
///
/// Lanczos alone may pass over a mode: one that its start vectors do not hold, or the fifth of five equal
/// ones. So the eigenvalues below a shift just above the last mode are counted by the signs of a second
/// factor's pivots ([`eigenvalues_below`](crate::eigenvalues_below)); if more are counted than were found,
/// the search goes on with new start vectors beside the old, and ends with an error if they do not turn up.
///
/// # Errors
/// A K + sM that is not positive definite, no convergence, more than 400 modes, residuals that are too large,
/// modes that the count says are missing.
pub fn lowest_modes(
    stiffness: &SparseSymmetric,
    mass: &SparseSymmetric,
    rigid: &[Vec<f64>],
    shift: f64,
    wanted: ModesWanted,
    mut progress: impl FnMut(usize, usize),
) -> Result<SparseModes, SparseError> {
    let factor = SparseCholesky::of(&stiffness.plus(shift, mass)?)?;
    let order = mass.order();
    let mut space = Space { mass, held: Vec::new(), vectors: Vec::new() };
    for motion in rigid {
        let (vector, image) = space.normalised(motion.clone(), 0.0).ok_or(EigenError::MassNotPositive)?;
        space.held.push((vector, image));
    }
    let at_least = wanted.at_least.min(order.saturating_sub(rigid.len()));
    let mut random = Random::new();
    let mut block: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for _ in 0..BLOCK.min(order - rigid.len().min(order)) {
        space.start(&mut random, &factor, &mut block);
    }
    // Projection of (K + sM)⁻¹M on the space, columns one by one as the space grows.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut census: Option<Census> = None;
    let most = MOST_MODES.max(2 * at_least);
    let mut are_counted = false;
    loop {
        let size = space.vectors.len();
        // Residuals of Ritz pairs are made of what the images of the newest vectors have outside the space.
        let outside = space.images(&factor, &block, &mut columns);
        let mut next = Vec::with_capacity(block.len());
        let ritz = ritz_pairs(&columns, size)?;
        // One product with M for each of them, and none for each pair.
        let gram = products_by_mass(space.mass, &outside);
        let converged = converged(&ritz, &gram, size - block.len());
        let eigenvalues: Vec<f64> = ritz[..converged].iter().map(|pair| 1.0 / pair.value - shift).collect();
        progress(converged.min(at_least), at_least);
        if size + rigid.len() >= order {
            // The space is all there is: nothing can be missing.
            let all = (converged == size).then_some((converged, f64::INFINITY));
            let (count, below) = complete_set(&eigenvalues, wanted.up_to, at_least)
                .or(all)
                .ok_or(EigenError::NoConvergence)?;
            return modes(space, stiffness, &ritz[..count], factor, shift, below);
        }
        let complete = match &census {
            None => complete_set(&eigenvalues, wanted.up_to, at_least),
            // The count holds for the shift where it was taken.
            Some(census) => Some((below(&eigenvalues, census.shift), census.shift)),
        };
        if let Some((count, below)) = complete {
            let census = match &mut census {
                Some(census) => census,
                None => census.insert(Census::at(stiffness, mass, below, &factor)?),
            };
            let found = rigid.len() + count;
            if found == census.counted {
                return modes(space, stiffness, &ritz[..count], factor, shift, below);
            }
            let fresh = census.fresh_vectors(found, size, block.len(), below)?;
            (0..fresh).for_each(|_| space.start(&mut random, &factor, &mut next));
        } else {
            // Ritz values lie above the eigenvalues: there are at least so many modes.
            let known = ritz.iter().filter(|pair| 1.0 / pair.value - shift <= wanted.up_to).count();
            let mut below = known;
            if known >= MANY_MODES && !are_counted {
                are_counted = true;
                // Where the shift is too close to an eigenvalue for a count, the search tells.
                let all = count_below(stiffness, mass, wanted.up_to, &factor.elimination).unwrap_or(0);
                below = all.saturating_sub(rigid.len()).max(known);
            }
            if below > most {
                return Err(SparseError::TooMany { most, hz: wanted.up_to.max(0.0).sqrt() / TAU });
            }
            if size >= VECTORS_A_MODE * known.max(converged).max(at_least) + 60 {
                return Err(EigenError::NoConvergence.into());
            }
        }
        for (index, rest) in outside.into_iter().enumerate() {
            // Where the block has run dry in a direction, another one.
            let vector = space.normalised_of(rest, gram[index][index], 1e-10);
            let Some(vector) = vector.or_else(|| space.normalised(random.vector(order), 1e-8)) else {
                continue;
            };
            space.vectors.push(vector.clone());
            next.push(vector);
        }
        if next.is_empty() {
            return Err(EigenError::NoConvergence.into());
        }
        block = next;
    }
}

/// How many of the first Ritz pairs have converged: their residuals are made of what the newest vectors, from
/// `first_new` on, have outside the space, of which `gram` holds the products.
fn converged(ritz: &[RitzPair], gram: &[Vec<f64>], first_new: usize) -> usize {
    let residual_of = |pair: &RitzPair| {
        let weights = &pair.vector[first_new..];
        let of_row = |(row, weight): (&Vec<f64>, &f64)| weight * dot(row, weights);
        gram.iter().zip(weights).map(of_row).sum::<f64>().max(0.0).sqrt() / pair.value
    };
    ritz.iter().take_while(|pair| residual_of(pair) <= CONVERGED).count()
}

/// The count of eigenvalues below a shift, and what was done because of it.
struct Census {
    shift: f64,
    counted: usize,
    fresh_blocks: usize,
    /// Vectors that the space must have before new directions are brought in again.
    fresh_after: usize,
}

impl Census {
    /// How many new start vectors a space of `size` vectors needs beside a block of `block` to find what is
    /// missing; none while the last ones are still at work.
    ///
    /// # Errors
    /// More modes than counted, or modes that do not turn up.
    fn fresh_vectors(
        &mut self,
        found: usize,
        size: usize,
        block: usize,
        below: f64,
    ) -> Result<usize, SparseError> {
        let due = size >= self.fresh_after;
        if found > self.counted || (due && self.fresh_blocks == FRESH_BLOCKS) {
            return Err(missing(found, self.counted, below));
        }
        if !due {
            return Ok(0);
        }
        let fresh = (self.counted - found).clamp(BLOCK, FRESH);
        self.fresh_blocks += 1;
        // A block of that many more needs as many more vectors for each of its steps.
        self.fresh_after = size + STEPS_A_FRESH_BLOCK * (block + fresh);
        Ok(fresh)
    }

    fn at(
        stiffness: &SparseSymmetric,
        mass: &SparseSymmetric,
        shift: f64,
        factor: &SparseCholesky,
    ) -> Result<Self, SparseError> {
        let counted = count_below(stiffness, mass, shift, &factor.elimination)?;
        Ok(Census { shift, counted, fresh_blocks: 0, fresh_after: 0 })
    }
}

fn below(eigenvalues: &[f64], limit: f64) -> usize {
    eigenvalues.iter().filter(|value| **value <= limit).count()
}

/// How many of the modes found so far are handed out, and a shift in the gap behind them; `None` while no
/// mode beyond such a gap is known.
fn complete_set(eigenvalues: &[f64], up_to: f64, at_least: usize) -> Option<(usize, f64)> {
    let least = below(eigenvalues, up_to).max(at_least);
    (least..eigenvalues.len()).find_map(|count| {
        let (last, next) = (count.checked_sub(1).map_or(0.0, |i| eigenvalues[i]), eigenvalues[count]);
        (next - last > GAP * next).then_some((count, 0.5 * (last + next)))
    })
}

/// Products vᵢᵀ M vⱼ of all vectors, row by row.
fn products_by_mass(mass: &SparseSymmetric, vectors: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (blocks, rest) = vectors.as_chunks::<BLOCK>();
    let images = blocks.iter().flat_map(|block| mass.multiply_each(block.each_ref().map(Vec::as_slice)));
    let images = images.chain(rest.iter().map(|vector| mass.multiply(vector)));
    images.map(|image| vectors.iter().map(|other| dot(&image, other)).collect()).collect()
}

struct RitzPair {
    value: f64,
    vector: Vec<f64>,
}

/// Eigenpairs of the projected operator, largest value (lowest mode) first.
fn ritz_pairs(columns: &[Vec<f64>], size: usize) -> Result<Vec<RitzPair>, EigenError> {
    let mut projected = vec![0.0; size * size];
    let mut identity = vec![0.0; size * size];
    for (j, column) in columns.iter().enumerate() {
        identity[j * size + j] = 1.0;
        for (i, value) in column.iter().enumerate() {
            // A column knows the space up to its own block; what lies below is its mirror image.
            projected[i * size + j] = *value;
            projected[j * size + i] = *value;
        }
    }
    let basis = generalized_symmetric_eigen(size, &identity, &projected)?;
    let pairs =
        (0..size).rev().map(|r| RitzPair { value: basis.eigenvalues()[r], vector: basis.shape(r).to_vec() });
    Ok(pairs.filter(|pair| pair.value > 0.0).collect())
}

/// Modes of the assembly from Ritz pairs, their residuals looked at.
fn modes(
    space: Space,
    stiffness: &SparseSymmetric,
    pairs: &[RitzPair],
    factor: SparseCholesky,
    shift: f64,
    complete_below: f64,
) -> Result<SparseModes, SparseError> {
    let order = space.mass.order();
    let (mut eigenvalues, mut shapes) = (Vec::new(), Vec::new());
    let mut residual = 0.0_f64;
    for pair in pairs {
        let mut shape = vec![0.0; order];
        for ((vector, _), weight) in space.vectors.iter().zip(&pair.vector) {
            shape.iter_mut().zip(vector).for_each(|(s, v)| *s += weight * v);
        }
        let eigenvalue = 1.0 / pair.value - shift;
        // K φ as it stands, carried through the factor: what is left of Kφ − λMφ as a motion. Unsmoothed it
        // is mostly the rounding of stiffness that cancels, which grows with the finest element and says
        // nothing of the mode.
        let (mut left, inertia) = (stiffness.multiply(&shape), space.mass.multiply(&shape));
        left.iter_mut().zip(&inertia).for_each(|(f, m)| *f -= eigenvalue * m);
        factor.solve_in_place(&mut left);
        let size = space.mass.quadratic(&left).max(0.0).sqrt();
        residual = residual.max(size * (eigenvalue.abs() + shift) / eigenvalue.abs());
        eigenvalues.push(eigenvalue);
        shapes.push(shape);
    }
    // A comparison that a residual of NaN fails as well.
    if pairs.is_empty() || residual <= RESIDUAL_ALLOWED {
        let rigid = space.held.into_iter().map(|(vector, _)| vector).collect();
        return Ok(SparseModes { rigid, eigenvalues, shapes, residual, shift, factor, complete_below });
    }
    Err(EigenError::Inaccurate { residual, allowed: RESIDUAL_ALLOWED }.into())
}
