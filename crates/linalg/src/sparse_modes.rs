use crate::sparse::SparseError;
use crate::{EigenError, SparseCholesky, SparseSymmetric, generalized_symmetric_eigen};

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
    /// Largest (1 + s/λ) ‖(K + sM)⁻¹(Kφ − λMφ)‖ in the norm of M over the modes: what bounds the relative error of λ.
    pub residual: f64,
    /// The shift s of the factor.
    pub shift: f64,
    /// The factor of K + s M.
    pub factor: SparseCholesky,
}

/// Vectors that are found at a time; a mode of higher multiplicity may be missed.
const BLOCK: usize = 4;

/// The Krylov space ends at so many vectors for each mode that is wanted, and some.
const VECTORS_A_MODE: usize = 8;

/// Residual of a Ritz pair of (K + sM)⁻¹M, relative to its value, at which it counts as found.
const CONVERGED: f64 = 1e-10;

/// Largest residual of a mode that is handed out: half of it is the most that its frequency can be off by.
const RESIDUAL_ALLOWED: f64 = 1e-4;

/// The lowest modes of K φ = λ M φ by block Lanczos on (K + sM)⁻¹M with full reorthogonalisation, s = `shift` > 0.
///
/// `rigid` are the motions that cost no energy, known beforehand; the search goes on in their complement, so that no zero of multiplicity
/// six competes with the modes. They need not be normalised. `progress` is told how many modes are found, of how many wanted.
///
/// # Errors
/// A K + sM that is not positive definite, no convergence, or residuals that are too large.
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
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut block: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for _ in 0..BLOCK.min(order - rigid.len().min(order)) {
        let mut start = mass.multiply(&random.vector(order));
        factor.solve_in_place(&mut start);
        if let Some(next) = space.normalised(start, 1e-8) {
            space.vectors.push(next.clone());
            block.push(next);
        }
    }
    // Projection of (K + sM)⁻¹M on the space, columns one by one as the space grows.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    loop {
        let size = space.vectors.len();
        let mut images: Vec<f64> = block.iter().flat_map(|(_, image)| image.iter().copied()).collect();
        factor.solve_in_place(&mut images);
        let mut next = Vec::with_capacity(block.len());
        // Components of the new vectors outside the space: the residuals of Ritz pairs are made of them.
        let mut outside = Vec::with_capacity(block.len());
        for image in images.chunks(order) {
            columns.push(space.coefficients(image));
            outside.push(space.remainder(image.to_vec()));
        }
        let ritz = ritz_pairs(&columns, size)?;
        let first_new = size - block.len();
        let residual_of = |pair: &RitzPair| {
            let mut sum = vec![0.0; order];
            for (rest, weight) in outside.iter().zip(&pair.vector[first_new..]) {
                sum.iter_mut().zip(rest).for_each(|(s, r)| *s += weight * r);
            }
            space.mass.quadratic(&sum).max(0.0).sqrt() / pair.value
        };
        let converged = ritz.iter().take_while(|pair| residual_of(pair) <= CONVERGED).count();
        let eigenvalue = |pair: &RitzPair| 1.0 / pair.value - shift;
        // One mode beyond the limit proves that none below it is left out.
        let beyond = ritz[..converged].iter().any(|pair| eigenvalue(pair) > wanted.up_to);
        let exhausted = size + rigid.len() >= order;
        progress(converged.min(at_least), at_least);
        if (converged >= at_least && beyond) || exhausted {
            let count = match beyond {
                true => ritz[..converged].iter().filter(|p| eigenvalue(p) <= wanted.up_to).count(),
                false => converged,
            };
            return space.modes(stiffness, &ritz[..count.max(at_least).min(converged)], factor, shift);
        }
        let most = VECTORS_A_MODE * converged.max(at_least) + 60;
        if size >= most {
            return Err(EigenError::NoConvergence.into());
        }
        for rest in outside {
            let vector = match space.normalised(rest, 1e-10) {
                Some(vector) => vector,
                // The block has run dry in this direction: another one.
                None => match space.normalised(random.vector(order), 1e-8) {
                    Some(vector) => vector,
                    None => continue,
                },
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

/// M-orthonormal vectors with their images under M: the known motions, and those of the search.
struct Space<'a> {
    mass: &'a SparseSymmetric,
    held: Vec<(Vec<f64>, Vec<f64>)>,
    vectors: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Space<'_> {
    fn coefficients(&self, vector: &[f64]) -> Vec<f64> {
        self.vectors.iter().map(|(_, image)| dot(image, vector)).collect()
    }

    /// What is left of a vector outside the space; twice, because once leaves rounding of the removed part.
    fn remainder(&self, mut vector: Vec<f64>) -> Vec<f64> {
        for _ in 0..2 {
            for (known, image) in self.held.iter().chain(&self.vectors) {
                let part = dot(image, &vector);
                vector.iter_mut().zip(known).for_each(|(v, k)| *v -= part * k);
            }
        }
        vector
    }

    /// A vector's remainder at unit modal mass, with its image; `None` where less than `least` of it is left.
    fn normalised(&self, vector: Vec<f64>, least: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let before = self.mass.quadratic(&vector).max(0.0).sqrt();
        let mut rest = self.remainder(vector);
        let norm = self.mass.quadratic(&rest).max(0.0).sqrt();
        if !(norm > least * before && norm > 0.0 && norm.is_finite()) {
            return None;
        }
        rest.iter_mut().for_each(|v| *v /= norm);
        let mut rest = self.remainder(rest);
        let norm = self.mass.quadratic(&rest).max(0.0).sqrt();
        rest.iter_mut().for_each(|v| *v /= norm);
        let image = self.mass.multiply(&rest);
        Some((rest, image))
    }

    fn modes(
        self,
        stiffness: &SparseSymmetric,
        pairs: &[RitzPair],
        factor: SparseCholesky,
        shift: f64,
    ) -> Result<SparseModes, SparseError> {
        let order = self.mass.order();
        let (mut eigenvalues, mut shapes) = (Vec::new(), Vec::new());
        let mut residual = 0.0_f64;
        for pair in pairs {
            let mut shape = vec![0.0; order];
            for ((vector, _), weight) in self.vectors.iter().zip(&pair.vector) {
                shape.iter_mut().zip(vector).for_each(|(s, v)| *s += weight * v);
            }
            let eigenvalue = 1.0 / pair.value - shift;
            // K φ as it stands, carried through the factor: what is left of Kφ − λMφ as a motion. Unsmoothed it is mostly the rounding of
            // stiffness that cancels, which grows with the finest element and says nothing of the mode.
            let (mut left, inertia) = (stiffness.multiply(&shape), self.mass.multiply(&shape));
            left.iter_mut().zip(&inertia).for_each(|(f, m)| *f -= eigenvalue * m);
            factor.solve_in_place(&mut left);
            let size = self.mass.quadratic(&left).max(0.0).sqrt();
            residual = residual.max(size * (eigenvalue.abs() + shift) / eigenvalue.abs());
            eigenvalues.push(eigenvalue);
            shapes.push(shape);
        }
        // A comparison that a residual of NaN fails as well.
        if pairs.is_empty() || residual <= RESIDUAL_ALLOWED {
            let rigid = self.held.into_iter().map(|(vector, _)| vector).collect();
            return Ok(SparseModes { rigid, eigenvalues, shapes, residual, shift, factor });
        }
        Err(EigenError::Inaccurate { residual, allowed: RESIDUAL_ALLOWED }.into())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// SplitMix64: start vectors that are the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, order: usize) -> Vec<f64> {
        (0..order).map(|_| self.next()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SparsePattern;
    use std::f64::consts::PI;

    /// A free chain of n unit masses on unit springs, stiffness scaled.
    fn free_chain(n: usize, stiffness: f64) -> (SparseSymmetric, SparseSymmetric) {
        let couples: Vec<Vec<usize>> = (1..n).map(|i| vec![i - 1, i]).collect();
        let pattern = SparsePattern::of_elements(n, couples.iter().map(Vec::as_slice)).unwrap();
        let (mut k, mut m) = (SparseSymmetric::zero(&pattern), SparseSymmetric::zero(&pattern));
        for i in 0..n {
            m.add_element(&[Some(i)], &[1.0]).unwrap();
            if i > 0 {
                let s = stiffness;
                k.add_element(&[Some(i - 1), Some(i)], &[s, -s, -s, s]).unwrap();
            }
        }
        (k, m)
    }

    #[test]
    fn a_free_chain_of_stiff_springs_has_its_closed_form_frequencies() {
        let (n, stiffness) = (2000, 1e12);
        let (k, m) = free_chain(n, stiffness);
        let exact = |r: usize| 4.0 * stiffness * (PI * r as f64 / (2 * n) as f64).sin().powi(2);
        let wanted = ModesWanted { at_least: 12, up_to: 0.0 };
        let modes = lowest_modes(&k, &m, &[vec![3.0; n]], 0.3 * exact(1), wanted, |_, _| {}).unwrap();
        assert_eq!(modes.eigenvalues.len(), 12);
        for (r, value) in modes.eigenvalues.iter().enumerate() {
            let error = (value / exact(r + 1) - 1.0).abs();
            assert!(error < 1e-8, "mode {}: {value:e} instead of {:e}", r + 1, exact(r + 1));
        }
    }

    #[test]
    fn every_mode_below_the_limit_is_found_and_the_masses_are_one() {
        let (k, m) = free_chain(300, 1.0);
        let exact = |r: usize| 4.0 * (PI * r as f64 / 600.0).sin().powi(2);
        let limit = 0.5 * (exact(20) + exact(21));
        let wanted = ModesWanted { at_least: 1, up_to: limit };
        let modes = lowest_modes(&k, &m, &[vec![1.0; 300]], 1e-4, wanted, |_, _| {}).unwrap();
        assert_eq!(modes.eigenvalues.len(), 20);
        for (r, shape) in modes.shapes.iter().enumerate() {
            for (q, other) in modes.shapes.iter().enumerate() {
                let product = dot(&m.multiply(shape), other);
                assert!((product - f64::from(r == q)).abs() < 1e-9, "({r}, {q}): {product}");
            }
        }
    }

    #[test]
    fn a_system_as_small_as_the_block_is_solved_too() {
        let (k, m) = free_chain(3, 1.0);
        let wanted = ModesWanted { at_least: 10, up_to: 0.0 };
        let modes = lowest_modes(&k, &m, &[vec![1.0; 3]], 1.0, wanted, |_, _| {}).unwrap();
        assert_eq!(modes.eigenvalues.len(), 2);
        assert!((modes.eigenvalues[0] - 1.0).abs() < 1e-12 && (modes.eigenvalues[1] - 3.0).abs() < 1e-12);
    }
}
