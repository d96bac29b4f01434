//! Where a mismatch sits, with no law assumed: one unknown dynamic stiffness δ(ω) a place.
//!
//! A component that was left out and acts through one station b changes the dynamic stiffness by δ·b·bᵀ, and so the FRFs by −γ(ω)·p(ω) with a
//! pattern p that the model knows and γ = δ/(1 + δ·bᵀZ⁻¹b). With more FRFs than one, a free γ on every line is over-determined: at the right
//! place one γ explains all FRFs within their noise, at a wrong one it cannot. What stays unexplained, by place, FRF and band, is the map of
//! the mismatch; the γ of the best place, turned back into δ, is a measured dynamic stiffness, whose law over frequency names the physics.

use jointscope_fixture::{Dof, Effect};
use jointscope_spectra::FrfPair;
use num_complex::Complex64;

/// A place through which one unknown scalar a line may act.
#[derive(Debug, Clone, PartialEq)]
pub enum Site {
    /// A component on a body at an abscissa (m), felt through its transverse motion.
    Body {
        /// The body's name.
        body: String,
        /// Abscissa, m.
        x: f64,
    },
    /// A compliance in series with one end of a joint, or with the joint as a whole in shear.
    Series {
        /// The joint's name.
        joint: String,
        /// The point at that end; `None` for both alike (translation in a massless joint).
        point: Option<String>,
        /// The direction that yields.
        dof: Dof,
    },
    /// A response channel: its FRFs are multiplied by 1 + δ.
    Response(String),
    /// A reference channel: its FRFs are divided by 1 + δ.
    Reference(String),
    /// A sensor or impact that sits δ metres from where it is said to be.
    Seat(String),
}

/// What one place leaves unexplained, and the dynamic stiffness that it would have to have.
#[derive(Debug, Clone)]
pub struct Location {
    /// The place.
    pub site: Site,
    /// χ² per degree of freedom that is left with one free scalar a line there, tolerances yielding.
    pub chi2_per_dof: f64,
    /// Real values less real unknowns.
    pub degrees: usize,
    /// Probability of as much by chance.
    pub p_value: f64,
    /// (from, to, χ² per degree of freedom left) by band, Hz, ascending.
    pub bands: Vec<(f64, f64, f64)>,
    /// χ² per real value left, by FRF.
    pub frfs: Vec<(FrfPair, f64)>,
    /// δ on each line where it is determined.
    pub delta: Vec<LineEstimate>,
}

/// δ on one spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineEstimate {
    /// The line, Hz.
    pub frequency: f64,
    /// The unknown component's dynamic stiffness (N/m for a body or a translation in series, N·m/rad for a rotation in series), or the channel's
    /// relative error (1), or the seat's offset (m).
    pub value: Complex64,
    /// Standard deviation of its real part, and of its imaginary part.
    pub std: f64,
}

impl Site {
    /// Unit of δ.
    pub fn unit(&self) -> &'static str {
        match self {
            Site::Body { .. } | Site::Series { dof: Dof::Translation, .. } => "N/m",
            Site::Series { dof: Dof::Rotation, .. } => "N*m/rad",
            Site::Response(_) | Site::Reference(_) => "1",
            Site::Seat(_) => "m",
        }
    }

    /// Whether `effect` would act through this site.
    pub fn holds(&self, _effect: &Effect) -> bool {
        false
    }
}
