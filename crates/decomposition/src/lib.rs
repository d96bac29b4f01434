//! A joint's dynamic stiffness from the FRFs of the assembly, and back (eq 4–7, 32–42).
//!
//! An assembly is side α, the joint, side β. A force on α reaches β through the joint alone, so
//!
//! H41 = β43 · (k⁻¹ + β33 + R α22 Rᵀ)⁻¹ · R α21, and k⁻¹ = R α21 H41⁻¹ β43 − β33 − R α22 Rᵀ
//!
//! with R = [[1, L],[0, 1]] across the joint's length L. Eq (7) of the paper leaves R out, which is exact
//! only for a joint of zero length; [`Relation::Paper`] reproduces it, [`Relation::Exact`] closes the round
//! trip.
//!
//! * [`Relation`]: both relations for one line and for many;
//! * [`Sides`]: the fixture taken apart at a joint, and the compliances α21, α22, β33, β43 of its sides with
//!   their supports, masses and mass-proportional damping (eq 8–12);
//! * [`CrossingFrfs`]: which FRFs of a recording tell the motion of one side due to loads on the other;
//! * [`decompose`]: K(ω) and C(ω) with standard deviations, masked lines counted ([`JointSpectrum`]);
//! * [`Analysis`]: all of it for one recording, with what the fixture's tolerances add;
//! * [`Averages`]: means over a band, plain (eq 35, 42) and weighted;
//! * [`maximum_likelihood`]: symmetric, passive k and c straight from the FRFs;
//! * [`fit_joint`]: the same from every FRF, the fixture's quantities moving within their tolerances; tests
//!   of the joint, laws over frequency;
//! * [`fit_joints`]: several joints at once, in chains and in loops, from every FRF;
//! * [`interfaces`]: what the joint's ends add to its beam (eq 6, scalar and matrix form);
//!   [`interface_spectrum`]: the same line by line.
//!
//! ```
//! use jointscope_decomposition::Relation;
//! use jointscope_linalg::{ComplexMatrix2, Matrix2};
//! use num_complex::Complex64;
//!
//! let c = |re: f64| Complex64::new(re, 0.0);
//! let (alpha, beta) = (Matrix2::new(c(-1e-6), c(0.0), c(0.0), c(-1e-3)), Matrix2::new(c(-2e-6), c(0.0), c(0.0), c(-3e-3)));
//! let stiffness = Matrix2::new(c(3e6), c(-1e5), c(-1e5), c(5e3));
//! let length = 0.065;
//! let h41 = Relation::synthesize(stiffness, alpha, alpha, beta, beta, length).unwrap();
//! let back: ComplexMatrix2 = Relation::Exact.decompose(h41, alpha, alpha, beta, beta, length).unwrap();
//! assert!((back.at(0, 0).re / 3e6 - 1.0).abs() < 1e-9);
//! // Eq (7), without the transport, does not close its own round trip.
//! let paper = Relation::Paper.decompose(h41, alpha, alpha, beta, beta, length).unwrap();
//! assert!((paper.at(0, 0).re / 3e6 - 1.0).abs() > 0.01);
//! ```

mod analysis;
mod averages;
mod by_law;
mod criteria;
mod crossing;
mod element;
mod estimate;
mod from_frfs;
mod idle_points;
mod inertia;
mod interface_spectrum;
mod interface_tolerances;
mod interfaces;
mod joint_ends;
mod joint_fit;
mod judgement;
mod likelihood;
mod method;
mod relation;
mod settings;
mod sides;
mod spectrum;
mod tolerances;

pub use analysis::Analysis;
pub use averages::{Averages, MatrixAverage};
pub use crossing::{CrossingError, CrossingFrfs};
pub use element::{DynamicStiffnessPart, MatrixElement};
pub use estimate::{ElementFigure, JointEstimate};
pub use from_frfs::AnalysisOptions;
pub(crate) use idle_points::IdlePoints;
pub use interface_spectrum::{
    InterfaceLine, InterfaceMask, InterfaceSpectrum, LineCompliance, LineInterface, LineSpring, Spread,
    interface_spectrum,
};
pub use interfaces::{Compliance, InterfaceStiffness, Interfaces, interfaces};
pub use joint_ends::{JointEnd, JointEnds};
pub use joint_fit::{
    Admissible, FittedFrfs, FittedLength, FittedQuantity, Followed, FoundJoint, JointFit, JointFitOptions,
    JointLikelihood, JointTests, JointsCovariance, JointsFit, LawFit, LawKind, SeveralError, UnmovedQuantity,
    fit_joint, fit_joints,
};
pub use judgement::{Contradiction, Judgement, Use};
pub use likelihood::{LikelihoodFit, maximum_likelihood};
pub use method::Method;
pub use relation::{Compliances, Relation};
pub use sides::{Sides, SidesError};
pub use spectrum::{JointLine, JointSpectrum, decompose};
pub use tolerances::ToleranceShare;
pub(crate) use tolerances::{NominalResult, ToleranceShares, tolerance_shares};

/// Why a joint cannot be decomposed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DecompositionError {
    /// The fixture cannot be taken apart there.
    #[error(transparent)]
    Sides(#[from] SidesError),
    /// The recording lacks what is needed.
    #[error(transparent)]
    Plan(#[from] CrossingError),
    /// The blocks' motion cannot be found.
    #[error(transparent)]
    Motion(#[from] jointscope_frf::RigidMotionError),
    /// A side cannot be modelled.
    #[error(transparent)]
    Model(#[from] jointscope_lumped::LumpedError),
    /// No average can be taken.
    #[error(transparent)]
    Averaging(#[from] jointscope_averaging::AveragingError),
    /// Not one line could be solved.
    #[error(
        "none of the {lines} spectral lines can be solved: {reasons}; measure again or leave out FRFs without coherence"
    )]
    NothingSolved {
        /// Lines of the recording.
        lines: usize,
        /// Reasons and their counts.
        reasons: String,
    },
    /// The fit of the joint did not converge.
    #[error("the maximum-likelihood fit of the joint did not converge: {0}")]
    NoFit(&'static str),
}
