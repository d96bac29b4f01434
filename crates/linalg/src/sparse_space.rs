//! The space of Lanczos vectors of the sparse eigenproblem, kept orthonormal in the mass matrix.

use crate::{SparseCholesky, SparseSymmetric, dot};

/// M-orthonormal vectors with their images under M: the known motions, and those of the search.
pub(crate) struct Space<'a> {
    pub(crate) mass: &'a SparseSymmetric,
    pub(crate) held: Vec<(Vec<f64>, Vec<f64>)>,
    pub(crate) vectors: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Space<'_> {
    pub(crate) fn coefficients(&self, vector: &[f64]) -> Vec<f64> {
        self.vectors.iter().map(|(_, image)| dot(image, vector)).collect()
    }

    /// (K + sM)⁻¹M of the newest vectors, those of `block`: adds their components in the space to `columns`,
    /// and returns what lies outside.
    pub(crate) fn images(
        &self,
        factor: &SparseCholesky,
        block: &[(Vec<f64>, Vec<f64>)],
        columns: &mut Vec<Vec<f64>>,
    ) -> Vec<Vec<f64>> {
        let mut images: Vec<f64> = block.iter().flat_map(|(_, image)| image.iter().copied()).collect();
        factor.solve_in_place(&mut images);
        let mut outside = Vec::with_capacity(block.len());
        for image in images.chunks(self.mass.order()) {
            columns.push(self.coefficients(image));
            outside.push(self.remainder(image.to_vec()));
        }
        outside
    }

    /// What is left of a vector outside the space; twice, because once leaves rounding of the removed part.
    pub(crate) fn remainder(&self, mut vector: Vec<f64>) -> Vec<f64> {
        for _ in 0..2 {
            for (known, image) in self.held.iter().chain(&self.vectors) {
                let part = dot(image, &vector);
                vector.iter_mut().zip(known).for_each(|(v, k)| *v -= part * k);
            }
        }
        vector
    }

    /// A vector's remainder at unit modal mass, with its image; `None` where less than `least` of it is left.
    pub(crate) fn normalised(&self, vector: Vec<f64>, least: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let square = self.mass.quadratic(&vector);
        self.normalised_of(vector, square, least)
    }

    /// The same of a vector of which `square` = vᵀ M v is known.
    pub(crate) fn normalised_of(
        &self,
        vector: Vec<f64>,
        square: f64,
        least: f64,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let before = square.max(0.0).sqrt();
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

    /// Takes in a random vector, smoothed by the factor, and adds it to a block if anything of it is new.
    pub(crate) fn start(
        &mut self,
        random: &mut Random,
        factor: &SparseCholesky,
        block: &mut Vec<(Vec<f64>, Vec<f64>)>,
    ) {
        let mut vector = self.mass.multiply(&random.vector(self.mass.order()));
        factor.solve_in_place(&mut vector);
        if let Some(next) = self.normalised(vector, 1e-8) {
            self.vectors.push(next.clone());
            block.push(next);
        }
    }
}

/// SplitMix64: start vectors that are the same on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new() -> Self {
        Random(0x9e37_79b9_7f4a_7c15)
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, order: usize) -> Vec<f64> {
        (0..order).map(|_| self.next()).collect()
    }
}
