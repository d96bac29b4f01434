//! Factors of sparse symmetric matrices by supernodes; the order of elimination is shared by all matrices of
//! one pattern.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use crate::{SparseError, SparsePattern, SparseSymmetric};

/// The order of elimination for a pattern and where its factors have entries; shared by all factors of that
/// pattern.
#[derive(Debug, Clone)]
pub(crate) struct Elimination {
    pub(crate) symbolic: Arc<SymbolicCholesky<usize>>,
}

impl Elimination {
    pub(crate) fn of(pattern: &SparsePattern) -> Result<Self, SparseError> {
        // Always by supernodes: the simplicial variant of an indefinite factor passes over a zero pivot
        // without a word. The library's own constant for that, zero, still leaves diagonal matrices to it.
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
            ..CholeskySymbolicParams::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(shape(pattern), Side::Lower, SymmetricOrdering::Amd, parameters)
                .map_err(|_| SparseError::Memory { order: pattern.order() })?;
        Ok(Elimination { symbolic: Arc::new(symbolic) })
    }

    /// The diagonal of a factor, in the order of elimination; `None` for a factor that is not made by
    /// supernodes.
    pub(crate) fn diagonal(&self, values: &[f64]) -> Option<Vec<f64>> {
        let SymbolicCholeskyRaw::Supernodal(nodes) = self.symbolic.raw() else { return None };
        let mut diagonal = Vec::with_capacity(self.symbolic.nrows());
        for node in 0..nodes.n_supernodes() {
            let columns = nodes.supernode_end()[node] - nodes.supernode_begin()[node];
            let rows = columns + nodes.supernode(node).pattern().len();
            let block = &values[nodes.col_ptr_for_val()[node]..nodes.col_ptr_for_val()[node + 1]];
            diagonal.extend((0..columns).map(|j| block[j * rows + j]));
        }
        Some(diagonal)
    }
}

fn shape(pattern: &SparsePattern) -> SymbolicSparseColMatRef<'_, usize> {
    let order = pattern.order();
    SymbolicSparseColMatRef::new_checked(order, order, &pattern.starts, None, &pattern.rows)
}

/// The lower triangle of a matrix as the library sees it, `values` in the place of its own.
pub(crate) fn lower<'a>(matrix: &'a SparseSymmetric, values: &'a [f64]) -> SparseColMatRef<'a, usize, f64> {
    SparseColMatRef::new(shape(&matrix.pattern), values)
}

/// Zeros, or word that there is no room for them.
pub(crate) fn room<T: Clone>(length: usize, zero: T, order: usize) -> Result<Vec<T>, SparseError> {
    let mut values = Vec::new();
    values.try_reserve_exact(length).map_err(|_| SparseError::Memory { order })?;
    values.resize(length, zero);
    Ok(values)
}

/// The Cholesky factor of a sparse positive definite matrix, equations reordered for little fill.
///
/// One thread only, so that the same matrix gives the same bits on every machine of a kind.
pub struct SparseCholesky {
    pub(crate) elimination: Elimination,
    values: Vec<f64>,
    order: usize,
}

impl SparseCholesky {
    /// Factorises `matrix`.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or too large for the memory.
    pub fn of(matrix: &SparseSymmetric) -> Result<Self, SparseError> {
        let order = matrix.order();
        if matrix.values.iter().any(|value| !value.is_finite()) {
            return Err(SparseError::NotPositiveDefinite);
        }
        let elimination = Elimination::of(&matrix.pattern)?;
        let symbolic = &elimination.symbolic;
        let mut values = room(symbolic.len_val(), 0.0, order)?;
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| SparseError::Memory { order })?;
        let done = symbolic.factorize_numeric_llt(
            &mut values,
            lower(matrix, &matrix.values),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        done.map_err(|_| SparseError::NotPositiveDefinite)?;
        Ok(SparseCholesky { elimination, values, order })
    }

    /// Overwrites right-hand sides, one after the other, with their solutions.
    pub fn solve_in_place(&self, columns: &mut [f64]) {
        let count = columns.len() / self.order;
        let symbolic = &self.elimination.symbolic;
        let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(count, Par::Seq));
        let columns = MatMut::from_column_major_slice_mut(columns, self.order, count);
        LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            columns,
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }
}
