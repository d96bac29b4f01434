//! What a fit of the joint finds.

use super::length::FittedLength;
use super::{Admissible, JointLikelihood, JointTests, LawFit, LawKind};
use crate::settings::laws::CERTAIN;
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// The joint from all FRFs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointFit {
    /// K of the law followed, in the middle of the band, symmetric: N/m, N/rad, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C of the law followed, there: Im(dynamic stiffness)/ω, ηK/ω of a structural one; symmetric and
    /// passive: N·s/m, N·s/rad, N·m·s/rad.
    pub damping: RealMatrix2,
    /// Posterior covariance of (k11, k12, k22, c11, c12, c22), the fixture's quantities integrated out; with
    /// what the model's error and the laws compared add.
    pub covariance: [[f64; 6]; 6],
    /// The part of it that comes from the model's error: how far the joint moves when one of eight blocks of
    /// lines is left out. Zero where noise explains what is left.
    #[serde(skip)]
    pub model_covariance: [[f64; 6]; 6],
    /// The part of it that comes from the laws compared: by how much they differ from the one followed in the
    /// middle of the band, each as often as it is probable.
    pub law_covariance: [[f64; 6]; 6],
    /// The joint's length between its ends where the fit has them.
    pub length: FittedLength,
    /// χ² and priors per degree of freedom: 1 where noise and tolerances explain the FRFs.
    pub chi2_per_dof: f64,
    /// What the noise's variance was multiplied by because the model does not explain the FRFs; 1 where it
    /// does.
    #[serde(skip)]
    pub inflation: f64,
    /// What the posterior covariance was multiplied by because the fixture's quantities are farther from what
    /// is stated than chance takes them; 1 where they are not.
    #[serde(skip)]
    pub tolerance_inflation: f64,
    /// Whether c would give out energy if it were free, and was held to c = v vᵀ.
    #[serde(rename = "on_the_boundary_of_passive")]
    pub is_on_the_boundary: bool,
    /// The fixture's quantities that the FRFs depend on, where the fit has them.
    pub quantities: Vec<FittedQuantity>,
    /// The fixture's other uncertain quantities, on which the FRFs do not depend.
    pub unmoved: Vec<UnmovedQuantity>,
    /// What is wrong with a joint that physics forbids.
    pub tests: JointTests,
    /// The nearest joint that physics allows, where a test fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub admissible: Option<Admissible>,
    /// How stiffness and damping depend on frequency, the most probable law first; empty if not asked for.
    #[serde(skip)]
    pub laws: Vec<LawFit>,
    /// The law that K, C, their covariance, mass and tests are of.
    #[serde(skip)]
    pub follows: Followed,
    /// The FRFs fitted.
    pub frfs: Vec<FrfPair>,
    /// Spectral lines fitted.
    pub lines: usize,
    /// The same FRFs as measured and as fitted.
    #[serde(skip)]
    pub fitted: Arc<FittedFrfs>,
    /// The joint's own mass and its standard deviation, kg, where the law followed has one; k and c are those
    /// of a joint with it.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "uncertain")]
    pub mass: Option<(f64, f64)>,
    /// Whether the bodies do not rotate: only the elements (1,1) mean anything then.
    #[serde(skip)]
    pub scalar: bool,
    /// What the FRFs alone tell of the joint and of the quantities; nothing where they leave the joint's mass
    /// open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<JointLikelihood>,
}

/// The law that a joint's numbers are of: the most probable one, or a viscous one where laws were not
/// compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Which.
    pub law: LawKind,
    /// The law itself where the joint's numbers are; its probability is that among the laws compared, 1 where
    /// they were not.
    pub fit: LawFit,
    /// Circular frequency in the middle of the band, at which K and C are stated, rad/s.
    pub omega: f64,
    /// Time τ (s) of a standard linear solid or exponent α of a springpot, and its standard deviation.
    pub shape: Option<(f64, f64)>,
}

/// What a fit was made to, and what it makes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedFrfs {
    /// The FRFs as measured: accelerances on the lines fitted.
    pub measured: FrfSet,
    /// The same of the fixture with the joints found, its quantities where the fit has them; FRF after FRF.
    pub modelled: Vec<Complex64>,
}

/// A quantity of the fixture as the fit has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedQuantity {
    /// Path in the fixture file.
    pub path: String,
    /// The body that it belongs to, by itself or as a place on it; nothing for supports, damping, channels
    /// and other joints.
    pub body: Option<String>,
    /// As stated, SI.
    pub stated: f64,
    /// Its stated standard deviation; nothing where it is unknown.
    pub std: Option<f64>,
    /// As fitted.
    pub fitted: f64,
    /// Standard deviation after the fit.
    pub fitted_std: f64,
    /// Stated standard deviations between the two (tenths of the value where it is unknown).
    pub deviations: f64,
}

impl FittedQuantity {
    /// Whether the FRFs move it farther than chance takes one of a few quantities.
    pub fn is_far(&self) -> bool {
        self.std.is_some() && jointscope_tolerances::is_far(self.deviations)
    }
}

/// An uncertain quantity of the fixture that the FRFs tell nothing of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnmovedQuantity {
    /// Path in the fixture file.
    pub path: String,
    /// The body that it belongs to, as that of a [`FittedQuantity`].
    pub body: Option<String>,
    /// As stated, SI.
    pub stated: f64,
    /// Its stated standard deviation; nothing where it is unknown.
    pub std: Option<f64>,
}

fn uncertain<S: Serializer>(mass: &Option<(f64, f64)>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(mass.iter().flat_map(|(value, std)| [("value", value), ("std", std)]))
}

impl JointFit {
    /// Standard deviations of K and C, everything included.
    pub fn std(&self) -> (RealMatrix2, RealMatrix2) {
        deviations(&self.covariance)
    }

    /// Whether noise and tolerances explain the FRFs.
    pub fn explains(&self) -> bool {
        self.inflation == 1.0 && self.tolerance_inflation == 1.0
    }

    /// The loss factor ωC/K of an element in the middle of the band and its standard deviation, with that of
    /// all that [`covariance`](Self::covariance) holds; nothing for an element of K that is zero, and of a
    /// law without damping.
    pub fn loss_factor(&self, row: usize, column: usize) -> Option<(f64, f64)> {
        let (k, c) = (self.stiffness.at(row, column), self.damping.at(row, column));
        if k == 0.0 || self.follows.law == LawKind::Constant || (self.scalar && row + column > 0) {
            return None;
        }
        let (of_k, of_c) = (row + column, 3 + row + column);
        let loss = self.follows.omega * c / k;
        let by = [-loss / k, self.follows.omega / k];
        let covariance = |m: usize, n: usize| self.covariance[m][n];
        let variance = by[0] * by[0] * covariance(of_k, of_k)
            + 2.0 * by[0] * by[1] * covariance(of_k, of_c)
            + by[1] * by[1] * covariance(of_c, of_c);
        Some((loss, variance.max(0.0).sqrt()))
    }

    /// Whether the laws compared leave no doubt of the joint's mass, or of its having none.
    pub fn has_certain_mass(&self) -> bool {
        let with_mass = self.laws.iter().filter(|law| law.mass.is_some());
        with_mass.map(|law| law.probability).sum::<f64>() >= CERTAIN
    }

    /// The most probable law, if laws were compared.
    pub fn law(&self) -> Option<&LawFit> {
        self.laws.first()
    }
}

fn deviations(covariance: &[[f64; 6]; 6]) -> (RealMatrix2, RealMatrix2) {
    let of = |first: usize| {
        let s = |m: usize| covariance[first + m][first + m].max(0.0).sqrt();
        Matrix2::new(s(0), s(1), s(1), s(2))
    };
    (of(0), of(3))
}
