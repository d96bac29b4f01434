//! Sparse symmetric matrices, ordered and factorised by faer.

use std::sync::Arc;

/// Why a sparse matrix cannot be built or factorised.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SparseError {
    /// An element names an equation that does not exist.
    #[error("an element speaks of equation {equation}, and there are {order}")]
    Equation {
        /// The equation named.
        equation: usize,
        /// Number of equations.
        order: usize,
    },
    /// The matrix is not positive definite to working precision, or holds a value that is not finite.
    #[error("the matrix is not positive definite: some motion costs no energy, or an element is degenerate")]
    NotPositiveDefinite,
    /// Two matrices of different patterns were combined.
    #[error("the matrices do not share a sparsity pattern")]
    Patterns,
    /// There is not enough memory for the factor.
    #[error("the factor of {order} equations does not fit into memory: take a coarser mesh")]
    Memory {
        /// Number of equations.
        order: usize,
    },
    /// The search found another number of modes than there are.
    #[error(
        "{counted} modes, rigid ones included, lie below {hz:.6} Hz by count and {found} were found: change the mesh a little, or ask for modes up to another frequency"
    )]
    Missing {
        /// Modes found below the shift, rigid ones included.
        found: usize,
        /// Eigenvalues counted there.
        counted: usize,
        /// The shift, Hz.
        hz: f64,
    },
    /// So many modes lie in the band that finding them all would take hours.
    #[error(
        "more than {most} modes lie below {hz:.0} Hz: check the moduli and densities, or end the band lower"
    )]
    TooMany {
        /// Modes that are looked for at the most.
        most: usize,
        /// Upper end of the band, Hz.
        hz: f64,
    },
    /// The count of eigenvalues below a shift cannot be relied on.
    #[error(
        "the modes below {hz:.6} Hz cannot be counted: a mode lies too close to that frequency, or neighbouring elements differ too much in size or stiffness"
    )]
    Uncertain {
        /// The shift, Hz.
        hz: f64,
        /// What one step of refinement leaves of a solution with the factor; 0.1 is allowed.
        error: f64,
    },
    /// The projected eigenproblem failed, or the modes found do not satisfy the equations.
    #[error(transparent)]
    Modes(#[from] crate::EigenError),
}

/// Where a symmetric matrix has entries: its lower triangle in compressed columns, diagonal first in each.
#[derive(Debug, PartialEq, Eq)]
pub struct SparsePattern {
    pub(crate) starts: Vec<usize>,
    pub(crate) rows: Vec<usize>,
}

impl SparsePattern {
    /// The pattern of a matrix of order `order` summed from elements, each given by the equations that it
    /// couples.
    ///
    /// # Errors
    /// An equation that is not below `order`.
    pub fn of_elements<'a>(
        order: usize,
        elements: impl Iterator<Item = &'a [usize]> + Clone,
    ) -> Result<Arc<Self>, SparseError> {
        let mut touching = vec![Vec::new(); order];
        for (index, equations) in elements.clone().enumerate() {
            for &equation in equations {
                touching.get_mut(equation).ok_or(SparseError::Equation { equation, order })?.push(index);
            }
        }
        let elements: Vec<&[usize]> = elements.collect();
        let mut starts = Vec::with_capacity(order + 1);
        let mut rows = Vec::new();
        // The last column that took each row: a set without clearing.
        let mut taken = vec![usize::MAX; order];
        starts.push(0);
        for (column, touching) in touching.iter().enumerate() {
            let start = rows.len();
            rows.push(column);
            taken[column] = column;
            for &element in touching {
                for &row in elements[element] {
                    if row > column && taken[row] != column {
                        taken[row] = column;
                        rows.push(row);
                    }
                }
            }
            rows[start..].sort_unstable();
            starts.push(rows.len());
        }
        Ok(Arc::new(SparsePattern { starts, rows }))
    }

    /// Number of equations.
    pub fn order(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored entries: the lower triangle with its diagonal.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }
}

/// A symmetric matrix with a [`SparsePattern`].
#[derive(Debug, Clone, PartialEq)]
pub struct SparseSymmetric {
    pub(crate) pattern: Arc<SparsePattern>,
    pub(crate) values: Vec<f64>,
}

impl SparseSymmetric {
    /// The zero matrix.
    pub fn zero(pattern: &Arc<SparsePattern>) -> Self {
        SparseSymmetric { pattern: Arc::clone(pattern), values: vec![0.0; pattern.entries()] }
    }

    /// Number of equations.
    pub fn order(&self) -> usize {
        self.pattern.order()
    }

    /// Adds an element's symmetric matrix, row-major over its equations; `None` for those that are held.
    ///
    /// # Errors
    /// Equations that the pattern does not couple.
    pub fn add_element(&mut self, equations: &[Option<usize>], matrix: &[f64]) -> Result<(), SparseError> {
        let (count, order) = (equations.len(), self.order());
        for (i, row) in equations.iter().enumerate() {
            let Some(row) = *row else { continue };
            for (j, column) in equations.iter().enumerate() {
                let Some(column) = column.filter(|column| *column <= row) else { continue };
                let range = match self.pattern.starts.get(column..column + 2) {
                    Some(ends) => ends[0]..ends[1],
                    None => return Err(SparseError::Equation { equation: column, order }),
                };
                let place = self.pattern.rows[range.clone()].binary_search(&row);
                let place = place.map_err(|_| SparseError::Equation { equation: row, order })?;
                self.values[range.start + place] += matrix[i * count + j];
            }
        }
        Ok(())
    }

    /// This matrix plus `factor` times `other`.
    ///
    /// # Errors
    /// Matrices of different patterns.
    pub fn plus(&self, factor: f64, other: &SparseSymmetric) -> Result<Self, SparseError> {
        if !Arc::ptr_eq(&self.pattern, &other.pattern) && self.pattern != other.pattern {
            return Err(SparseError::Patterns);
        }
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a + factor * b).collect();
        Ok(SparseSymmetric { pattern: Arc::clone(&self.pattern), values })
    }

    /// y = A x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        let SparsePattern { starts, rows } = self.pattern.as_ref();
        for (column, ends) in starts.windows(2).enumerate() {
            let (below, own) = (ends[0] + 1..ends[1], x[column]);
            let mut sum = self.values[ends[0]] * own;
            for (&row, value) in rows[below.clone()].iter().zip(&self.values[below]) {
                y[row] += value * own;
                sum += value * x[row];
            }
            y[column] += sum;
        }
        y
    }

    /// A x of several vectors, each as [`multiply`](SparseSymmetric::multiply) has it: the matrix is read
    /// once, which is most of the time.
    pub(crate) fn multiply_each<const N: usize>(&self, vectors: [&[f64]; N]) -> [Vec<f64>; N] {
        let order = self.order();
        let x: Vec<[f64; N]> = (0..order).map(|i| vectors.map(|vector| vector[i])).collect();
        let mut y = vec![[0.0; N]; order];
        let SparsePattern { starts, rows } = self.pattern.as_ref();
        for (column, ends) in starts.windows(2).enumerate() {
            let (below, own) = (ends[0] + 1..ends[1], x[column]);
            let mut sums = own.map(|own| self.values[ends[0]] * own);
            for (&row, value) in rows[below.clone()].iter().zip(&self.values[below]) {
                let (x, y) = (&x[row], &mut y[row]);
                for k in 0..N {
                    y[k] += value * own[k];
                    sums[k] += value * x[k];
                }
            }
            y[column].iter_mut().zip(sums).for_each(|(y, sum)| *y += sum);
        }
        std::array::from_fn(|k| y.iter().map(|y| y[k]).collect())
    }

    /// xᵀ A x: twice the energy of a motion.
    pub fn quadratic(&self, x: &[f64]) -> f64 {
        self.multiply(x).iter().zip(x).map(|(a, b)| a * b).sum()
    }
}
