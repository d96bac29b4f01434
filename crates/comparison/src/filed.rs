//! What `stiffness.json` says of the joint from all FRFs: `JointFit` of the decomposition as it is read back,
//! with less in files of earlier versions.

use crate::filed_likelihood::FiledLikelihood;
use crate::stiffness_file::{ComparedLaw, FollowedLaw, Matrix, ModelError, Uncertain};
use jointscope_inference::{QuadraticLikelihood, SIGNIFICANT};
use serde::Deserialize;

/// The joint from all FRFs, the fixture's quantities moving within their deviations, as a file has it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct FiledJoint {
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// Covariance of k11, k12, k22, c11, c12, c22.
    pub covariance: [[f64; 6]; 6],
    /// χ² and priors per degree of freedom.
    #[serde(default)]
    pub chi2_per_dof: Option<f64>,
    /// What the model gets wrong.
    #[serde(default)]
    pub model_error: ModelError,
    /// What of the covariance comes from the laws over frequency.
    #[serde(default)]
    pub law_covariance: [[f64; 6]; 6],
    /// The fixture's quantities that moved.
    #[serde(default)]
    pub quantities: Vec<StatedQuantity>,
    /// The fixture's other uncertain quantities, on which its FRFs do not depend; files of earlier versions
    /// do not say.
    #[serde(default)]
    pub unmoved: Vec<StatedQuantity>,
    /// Its length where the fit has its ends, zero deviation where both are exact; files of earlier versions
    /// do not say.
    #[serde(default)]
    pub length: Option<Uncertain>,
    /// What the FRFs alone tell of it and of the quantities; files of earlier versions do not say.
    #[serde(default)]
    pub likelihood: Option<FiledLikelihood>,
    /// How it is damped, as far as the file says.
    #[serde(default)]
    pub law: Option<String>,
    /// The law that its numbers are of; files of earlier versions do not say, theirs are of a viscous one.
    #[serde(default)]
    pub follows: Option<FollowedLaw>,
    /// The laws compared, the most probable first.
    #[serde(default)]
    pub laws: Vec<ComparedLaw>,
    /// The joint's own mass, where the FRFs show one: K and C are then those of a joint with it.
    #[serde(default)]
    pub mass: Option<Uncertain>,
    /// Whether physics allows it.
    #[serde(default)]
    pub tests: FiledTests,
    /// Whether C was held where it just gives out no energy: what the FRFs alone ask for is then another C.
    #[serde(default)]
    pub on_the_boundary_of_passive: bool,
}

/// Probabilities of FRFs that speak at least as much against a property, if the joint has it; nothing where
/// it was not tested.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
pub struct FiledTests {
    /// k12 = k21 and c12 = c21.
    #[serde(default)]
    pub reciprocity: Option<f64>,
    /// No eigenvalue of K is negative.
    #[serde(default)]
    pub definite: Option<f64>,
    /// No eigenvalue of C is negative.
    #[serde(default)]
    pub passive: Option<f64>,
}

impl FiledTests {
    /// Names and probabilities of the tests that fail.
    pub fn failed(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [("reciprocity", self.reciprocity), ("definite", self.definite), ("passive", self.passive)];
        all.into_iter().filter_map(|(name, p)| Some((name, p.filter(|p| *p < SIGNIFICANT)?)))
    }
}

/// A quantity of the fixture as the file states it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StatedQuantity {
    /// Its path.
    pub path: String,
    /// The body that it belongs to.
    #[serde(default)]
    pub body: Option<String>,
    /// Its value, SI.
    pub stated: f64,
    /// Its standard deviation; nothing where it is unknown.
    pub std: Option<f64>,
}

impl FiledJoint {
    /// The likelihood of the joint's numbers, by their places among the six, and after them of the
    /// quantities; nothing where the file has none that fits its quantities.
    pub(crate) fn likelihood(&self) -> Option<(Vec<usize>, QuadraticLikelihood)> {
        self.likelihood.as_ref()?.of_six(self.quantities.len())
    }

    /// What its fixture states under a path, if the file says it.
    pub(crate) fn statement(&self, path: &str) -> Option<&StatedQuantity> {
        self.quantities.iter().chain(&self.unmoved).find(|quantity| quantity.path == path)
    }

    /// The quantities of a body that the fit moved.
    pub(crate) fn of_body<'a>(&'a self, body: &'a str) -> impl Iterator<Item = &'a StatedQuantity> {
        self.quantities.iter().filter(move |quantity| quantity.body.as_deref() == Some(body))
    }

    /// k11, k12, k22, c11, c12, c22.
    pub(crate) fn six(&self) -> [f64; 6] {
        six(&self.stiffness, &self.damping)
    }

    /// The law that its numbers are of.
    pub(crate) fn stated_law(&self) -> &str {
        let earlier = if self.mass.is_some() { "viscous_with_mass" } else { "viscous" };
        self.follows.as_ref().map_or(earlier, |follows| &follows.law)
    }

    /// By how much a law is off the joint stated in the middle of the band; nothing where the file does not
    /// have it.
    pub(crate) fn departure(&self, law: &str) -> Option<[f64; 6]> {
        let of = |name: &str| {
            let law = self.laws.iter().find(|other| other.law == name)?.in_the_middle?;
            Some(six(&law.stiffness, &law.damping))
        };
        let stated = of(self.stated_law())?;
        let own = of(law)?;
        Some(std::array::from_fn(|e| own[e] - stated[e]))
    }
}

fn six(k: &Matrix, c: &Matrix) -> [f64; 6] {
    [k[0][0], k[0][1], k[1][1], c[0][0], c[0][1], c[1][1]]
}
