//! Undamped modes as the checked eigenproblems return them, mass-normalised, and why there may be none.

/// Why the eigenproblem has no trustworthy answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EigenError {
    /// The matrices are not of the stated order, or hold a value that is not finite.
    #[error("the mass and stiffness matrices must both be finite and of order {order}")]
    Shape {
        /// The stated order.
        order: usize,
    },
    /// The mass matrix is not positive definite.
    #[error("the mass matrix is not positive definite: some motion of the assembly has no mass")]
    MassNotPositive,
    /// The solution does not satisfy the equations it was found from.
    #[error(
        "the eigenproblem was solved with a relative residual of {residual:.1e}, more than {allowed:.1e}"
    )]
    Inaccurate {
        /// Largest of `‖Kφ − λMφ‖ / ‖K‖`, balanced, over the modes, or departure of ΞᵀMΞ from I.
        residual: f64,
        /// What is tolerated.
        allowed: f64,
    },
    /// The iteration did not converge.
    #[error("the eigenproblem did not converge")]
    NoConvergence,
}

/// Undamped modes, mass-normalised: ΞᵀMΞ = I and ΞᵀKΞ = diag λ (eq 30, 31).
#[derive(Debug, Clone, PartialEq)]
pub struct ModalBasis {
    order: usize,
    eigenvalues: Vec<f64>,
    shapes: Vec<f64>,
}

impl ModalBasis {
    /// Modes known from elsewhere: eigenvalues, ascending, and mass-normalised shapes, one after the other.
    /// `None` where the numbers do not fit together or are not finite.
    pub fn new(eigenvalues: Vec<f64>, shapes: Vec<f64>) -> Option<Self> {
        let order = eigenvalues.len();
        let fits = shapes.len() == order * order
            && eigenvalues.iter().chain(&shapes).all(|value| value.is_finite())
            && eigenvalues.windows(2).all(|pair| pair[0] <= pair[1]);
        fits.then_some(ModalBasis { order, eigenvalues, shapes })
    }

    /// Number of modes, equal to the number of coordinates.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Eigenvalues λ_r = ω_r², ascending, (rad/s)².
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// The mass-normalised shapes, one after the other.
    pub fn shapes(&self) -> &[f64] {
        &self.shapes
    }

    /// The mass-normalised shape of mode `r` over the coordinates.
    pub fn shape(&self, r: usize) -> &[f64] {
        &self.shapes[r * self.order..(r + 1) * self.order]
    }
}

/// Residual that is tolerated, relative to the norm of the balanced matrices.
const RESIDUAL_ALLOWED: f64 = 1e-11;

/// Whether modes may be trusted that leave `residual` of the balanced equations.
pub(crate) fn judged(order: usize, residual: f64) -> Result<(), EigenError> {
    // A comparison that a residual of NaN fails as well.
    if residual <= RESIDUAL_ALLOWED * (order as f64).max(10.0) {
        Ok(())
    } else {
        Err(EigenError::Inaccurate { residual, allowed: RESIDUAL_ALLOWED * (order as f64).max(10.0) })
    }
}
