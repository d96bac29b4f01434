//! What the FRFs alone tell of the joint and of the fixture's quantities: two joints on the same blocks share these, and only with the likelihood of both, their prior
//! entering once, is the difference of the joints as well known as it is.

use super::law::Dynamics;
use super::uncertainty::units;
use jointscope_inference::{NormalEquations, Parameter, QuadraticLikelihood};
use serde::Serialize;

/// Names of the six numbers of a joint.
pub(super) const ELEMENTS: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];

/// The likelihood of a joint's numbers and of the fixture's quantities, Gaussian about a point, without the quantities' priors; the joint's mass, if it has one, is
/// integrated out. c is free of constraints in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointLikelihood {
    /// The joint's numbers, SI; after them come the coordinates of [`JointFit::quantities`](super::JointFit::quantities): standard deviations from what is stated
    /// (tenths of it where its deviation is unknown), of ln(value) where a positive quantity is known to 12 % or better.
    pub elements: Vec<&'static str>,
    /// Where it is taken.
    pub at: Vec<f64>,
    /// Gradient of ln L there.
    pub gradient: Vec<f64>,
    /// Minus the second derivatives of ln L: the lower triangle by rows.
    pub information: Vec<Vec<f64>>,
}

impl JointLikelihood {
    /// From the normal equations at an optimum with c free: of the joint whose law's coordinates come first among those `kept`, and of the quantities; what is not kept is
    /// integrated out. Nothing where the FRFs leave that undetermined.
    pub(super) fn of(
        law: &Dynamics,
        (coordinates, kept): (&[f64], Vec<usize>),
        equations: &NormalEquations,
        parameters: &[Parameter],
    ) -> Option<Self> {
        let precision = |m: usize| parameters[m].precision;
        let mut all = QuadraticLikelihood::without_priors(equations, coordinates, precision);
        // At the optimum data and priors pull against each other. That derivatives by differences give a little more or less must not move the joint.
        let pull_of_priors = coordinates.iter().enumerate().map(|(m, at)| precision(m) * at);
        all.gradient = pull_of_priors.collect();
        let slots = law.slots();
        let scales = units(law);
        let si = all
            .marginal(&kept, precision)?
            .scaled(|index| slots.get(index).map_or(1.0, |&slot| scales[slot]));
        let n = si.order();
        Some(JointLikelihood {
            elements: slots.iter().map(|&slot| ELEMENTS[slot]).collect(),
            information: (0..n).map(|i| si.information[i * n..=i * n + i].to_vec()).collect(),
            at: si.at,
            gradient: si.gradient,
        })
    }
}
