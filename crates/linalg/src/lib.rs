//! Linear algebra of the sizes that joint identification needs.
//!
//! * [`Matrix2`]: real and complex 2×2 matrices in closed form, the size of a compliance or a
//!   joint stiffness on (transverse, rotation) per spectral line;
//! * [`LuWorkspace`]: dense complex LU with row equilibration, its memory reused from line to line;
//! * [`LeastSquares`]: weighted linear least squares by Householder reflections, with a rank check;
//! * [`Cholesky`], [`solve_positive_definite`]: symmetric positive definite matrices: normal equations,
//!   covariances, masses;
//! * [`products`] of the rows of two square matrices;
//! * [`matrix_exponential`]: real matrices of a few rows, such as those of a state space;
//! * [`generalized_symmetric_eigen`]: `K φ = λ M φ`, scaled and with its residuals checked;
//! * [`complex_eigenvalues`]: eigenvalues of a general complex matrix; [`singular_values`] of a complex
//!   matrix;
//! * with the feature `sparse`: [`SparsePattern`] and [`SparseSymmetric`] assembled from element matrices,
//!   [`SparseCholesky`], and [`lowest_modes`] of a sparse pencil by shift-invert block Lanczos, residuals
//!   checked and the modes counted ([`eigenvalues_below`]).
//!
//! This is the only crate that names the library behind the eigenproblem. That library loses
//! accuracy on symmetric matrices whose norm is far from one, so scaling and residual checks live
//! here and nowhere else.
//!
//! ```
//! use jointscope_linalg::Matrix2;
//!
//! let stiffness = Matrix2::new(3.3e6, -1.1e5, -1.1e5, 4.7e3);
//! let compliance = stiffness.inverse().expect("a stiff joint is not singular");
//! let identity = stiffness * compliance;
//! assert!((identity.at(0, 0) - 1.0).abs() < 1e-12 && identity.at(0, 1).abs() < 1e-9);
//! ```

mod cholesky;
mod eigen;
mod exponential;
mod few_coordinates;
mod general_eigen;
mod least_squares;
mod lu;
mod matrix2;
mod modal_basis;
mod products;
mod singular_values;
#[cfg(feature = "sparse")]
mod sparse;
#[cfg(feature = "sparse")]
mod sparse_cholesky;
#[cfg(feature = "sparse")]
mod sparse_inertia;
#[cfg(feature = "sparse")]
mod sparse_lanczos;
#[cfg(feature = "sparse")]
mod sparse_modes;
#[cfg(feature = "sparse")]
mod sparse_space;
mod vectors;

pub use cholesky::{Cholesky, semidefinite_factor, solve_positive_definite};
pub use eigen::generalized_symmetric_eigen;
pub use exponential::matrix_exponential;
pub use general_eigen::complex_eigenvalues;
pub use least_squares::{LeastSquares, LeastSquaresError};
pub use lu::{LuWorkspace, Singular};
pub use matrix2::{ComplexMatrix2, Field, Matrix2, RealMatrix2, Scalar};
pub use modal_basis::{EigenError, ModalBasis};
pub use products::products;
pub use singular_values::singular_values;
#[cfg(feature = "sparse")]
pub use sparse::{SparseError, SparsePattern, SparseSymmetric};
#[cfg(feature = "sparse")]
pub use sparse_cholesky::SparseCholesky;
#[cfg(feature = "sparse")]
pub use sparse_inertia::eigenvalues_below;
#[cfg(feature = "sparse")]
pub use sparse_modes::{ModesWanted, SparseModes, lowest_modes};
pub use vectors::{Uniform, dot, normal_pair};
