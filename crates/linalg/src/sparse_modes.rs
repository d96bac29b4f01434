//! The lowest modes of a sparse pencil.
//!
//! faer's own partial eigensolver is as exact, must be told how many modes there are, and is faster only
//! where there are ten or more (`docs/records/2026-11-26-partial-eigensolver.md`).

use crate::sparse::SparseError;
use crate::sparse_inertia::count_below;
use crate::sparse_lanczos::{BLOCK, Lanczos, RitzPair};
use crate::{EigenError, SparseCholesky, SparseSymmetric};
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

/// The Krylov space ends at so many vectors for each mode that is wanted, and some.
const VECTORS_A_MODE: usize = 8;

/// Modes below the wanted frequency that are looked for at the most: a vector of each is held, and every step
/// works on all.
const MOST_MODES: usize = 400;

/// Modes known to lie below the wanted frequency from which on all of them are counted before the search goes
/// on: of moduli a million times too small every vector is such a mode.
const MANY_MODES: usize = 64;

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
    let order = mass.order();
    let at_least = wanted.at_least.min(order.saturating_sub(rigid.len()));
    let up_to = wanted.up_to;
    let mut search = Lanczos::begin(stiffness, mass, rigid, shift)?;
    let mut census: Option<Census> = None;
    let mut bound = ModeBound { most: MOST_MODES.max(2 * at_least), up_to, is_counted: false };
    loop {
        let projection = search.projected()?;
        let converged = projection.converged;
        let eigenvalues: Vec<f64> =
            projection.ritz[..converged].iter().map(|pair| pair.eigenvalue(shift)).collect();
        progress(converged.min(at_least), at_least);
        if search.size() + rigid.len() >= order {
            // The space is all there is: nothing can be missing.
            let all = (converged == search.size()).then_some((converged, f64::INFINITY));
            let (count, below) =
                complete_set(&eigenvalues, up_to, at_least).or(all).ok_or(EigenError::NoConvergence)?;
            return modes(search, &projection.ritz[..count], below);
        }
        let complete = match &census {
            None => complete_set(&eigenvalues, up_to, at_least),
            // The count holds for the shift where it was taken.
            Some(census) => Some((below(&eigenvalues, census.shift), census.shift)),
        };
        let mut fresh = 0;
        if let Some((count, below)) = complete {
            let census = match &mut census {
                Some(census) => census,
                None => census.insert(Census::at(stiffness, mass, below, &search.factor)?),
            };
            let found = rigid.len() + count;
            if found == census.counted {
                return modes(search, &projection.ritz[..count], below);
            }
            fresh = census.fresh_vectors(found, search.size(), search.block.len(), below)?;
        } else {
            let known = bound.checked(&search, &projection.ritz)?;
            if search.size() >= VECTORS_A_MODE * known.max(converged).max(at_least) + 60 {
                return Err(EigenError::NoConvergence.into());
            }
        }
        search.extend(projection, fresh)?;
    }
}

/// The bound on how many modes a search may have to find.
struct ModeBound {
    most: usize,
    up_to: f64,
    /// Whether all modes below the wanted frequency were counted already.
    is_counted: bool,
}

impl ModeBound {
    /// How many modes are known to lie below the wanted frequency.
    ///
    /// # Errors
    /// More than may be looked for.
    fn checked(&mut self, search: &Lanczos, ritz: &[RitzPair]) -> Result<usize, SparseError> {
        // Ritz values lie above the eigenvalues: there are at least so many modes.
        let known = ritz.iter().filter(|pair| pair.eigenvalue(search.shift) <= self.up_to).count();
        let mut below = known;
        if known >= MANY_MODES && !self.is_counted {
            self.is_counted = true;
            // Where the shift is too close to an eigenvalue for a count, the search tells.
            let (stiffness, mass) = (search.stiffness, search.space.mass);
            let all = count_below(stiffness, mass, self.up_to, &search.factor.elimination).unwrap_or(0);
            below = all.saturating_sub(search.space.held.len()).max(known);
        }
        match below > self.most {
            true => Err(SparseError::TooMany { most: self.most, hz: self.up_to.max(0.0).sqrt() / TAU }),
            false => Ok(known),
        }
    }
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

/// Modes of the assembly from Ritz pairs, their residuals looked at.
fn modes(search: Lanczos, pairs: &[RitzPair], complete_below: f64) -> Result<SparseModes, SparseError> {
    let Lanczos { stiffness, shift, factor, space, .. } = search;
    let order = space.mass.order();
    let (mut eigenvalues, mut shapes) = (Vec::new(), Vec::new());
    let mut residual = 0.0_f64;
    for pair in pairs {
        let mut shape = vec![0.0; order];
        for ((vector, _), weight) in space.vectors.iter().zip(&pair.vector) {
            shape.iter_mut().zip(vector).for_each(|(s, v)| *s += weight * v);
        }
        let eigenvalue = pair.eigenvalue(shift);
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
