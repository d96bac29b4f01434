//! The block Lanczos method on (K + sM)⁻¹M with full reorthogonalisation.

use crate::sparse::SparseError;
use crate::sparse_space::{Random, Space};
use crate::{EigenError, SparseCholesky, SparseSymmetric, dot, generalized_symmetric_eigen};

/// Vectors that are found at a time; of modes of higher multiplicity some are missed at first, and found
/// after the count.
pub(crate) const BLOCK: usize = 4;

/// Residual of a Ritz pair of (K + sM)⁻¹M, relative to its value, at which it counts as found.
const CONVERGED: f64 = 1e-10;

/// Block Lanczos on (K + sM)⁻¹M under way.
pub(crate) struct Lanczos<'a> {
    pub(crate) stiffness: &'a SparseSymmetric,
    pub(crate) shift: f64,
    pub(crate) factor: SparseCholesky,
    pub(crate) space: Space<'a>,
    random: Random,
    /// The newest vectors of the space, with their images under M.
    pub(crate) block: Vec<(Vec<f64>, Vec<f64>)>,
    /// Projection of (K + sM)⁻¹M on the space, columns one by one as the space grows.
    columns: Vec<Vec<f64>>,
}

/// What (K + sM)⁻¹M is on the space, and what it makes of the newest vectors beside it.
pub(crate) struct Projection {
    pub(crate) ritz: Vec<RitzPair>,
    /// How many of the first pairs have converged.
    pub(crate) converged: usize,
    /// What the images of the newest vectors have outside the space.
    outside: Vec<Vec<f64>>,
    /// Products by M of that.
    gram: Vec<Vec<f64>>,
}

impl<'a> Lanczos<'a> {
    /// A space of the motions known beforehand and the first random vectors.
    pub(crate) fn begin(
        stiffness: &'a SparseSymmetric,
        mass: &'a SparseSymmetric,
        rigid: &[Vec<f64>],
        shift: f64,
    ) -> Result<Self, SparseError> {
        let factor = SparseCholesky::of(&stiffness.plus(shift, mass)?)?;
        let mut space = Space { mass, held: Vec::new(), vectors: Vec::new() };
        for motion in rigid {
            let (vector, image) = space.normalised(motion.clone(), 0.0).ok_or(EigenError::MassNotPositive)?;
            space.held.push((vector, image));
        }
        let (mut random, mut block) = (Random::new(), Vec::new());
        for _ in 0..BLOCK.min(mass.order() - rigid.len().min(mass.order())) {
            space.start(&mut random, &factor, &mut block);
        }
        Ok(Lanczos { stiffness, shift, factor, space, random, block, columns: Vec::new() })
    }

    /// Vectors of the space.
    pub(crate) fn size(&self) -> usize {
        self.space.vectors.len()
    }

    /// Takes the newest vectors into the projection.
    pub(crate) fn projected(&mut self) -> Result<Projection, SparseError> {
        let size = self.size();
        // Residuals of Ritz pairs are made of what the images of the newest vectors have outside the space.
        let outside = self.space.images(&self.factor, &self.block, &mut self.columns);
        let ritz = ritz_pairs(&self.columns, size)?;
        // One product with M for each of them, and none for each pair.
        let gram = products_by_mass(self.space.mass, &outside);
        let converged = converged(&ritz, &gram, size - self.block.len());
        Ok(Projection { ritz, converged, outside, gram })
    }

    /// The next block: so many `fresh` start vectors, and what the images of the last one have outside the
    /// space.
    pub(crate) fn extend(&mut self, projection: Projection, fresh: usize) -> Result<(), SparseError> {
        let Projection { outside, gram, .. } = projection;
        let mut next = Vec::with_capacity(fresh + outside.len());
        (0..fresh).for_each(|_| self.space.start(&mut self.random, &self.factor, &mut next));
        let order = self.space.mass.order();
        for (index, rest) in outside.into_iter().enumerate() {
            // Where the block has run dry in a direction, another one.
            let vector = self.space.normalised_of(rest, gram[index][index], 1e-10);
            let Some(vector) = vector.or_else(|| self.space.normalised(self.random.vector(order), 1e-8))
            else {
                continue;
            };
            self.space.vectors.push(vector.clone());
            next.push(vector);
        }
        if next.is_empty() {
            return Err(EigenError::NoConvergence.into());
        }
        self.block = next;
        Ok(())
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

/// Products vᵢᵀ M vⱼ of all vectors, row by row.
fn products_by_mass(mass: &SparseSymmetric, vectors: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (blocks, rest) = vectors.as_chunks::<BLOCK>();
    let images = blocks.iter().flat_map(|block| mass.multiply_each(block.each_ref().map(Vec::as_slice)));
    let images = images.chain(rest.iter().map(|vector| mass.multiply(vector)));
    images.map(|image| vectors.iter().map(|other| dot(&image, other)).collect()).collect()
}

pub(crate) struct RitzPair {
    /// Of (K + sM)⁻¹M: 1/(λ + s).
    pub(crate) value: f64,
    pub(crate) vector: Vec<f64>,
}

impl RitzPair {
    /// λ, (rad/s)².
    pub(crate) fn eigenvalue(&self, shift: f64) -> f64 {
        1.0 / self.value - shift
    }
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
