//! What the FRFs alone tell of joints and of the fixture's quantities: two joints on the same blocks share
//! these, and only with the likelihood of both, their prior entering once, is the difference of the joints as
//! well known as it is.

use super::law::Dynamics;
use super::uncertainty::units;
use jointscope_inference::{NormalEquations, Parameter, QuadraticLikelihood};
use serde::Serialize;

/// Names of the six numbers of a joint.
pub(super) const ELEMENTS: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];

/// The likelihood of joints' numbers and of the fixture's quantities, Gaussian about a point, without the
/// quantities' priors; a joint's mass, if it has one, is integrated out. c is free of constraints in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointLikelihood {
    /// The joints' numbers, SI: `k11` of one joint, `J1/k11` of several; after them come the coordinates of
    /// [`JointFit::quantities`](super::JointFit::quantities): standard deviations from what is stated (tenths
    /// of it where its deviation is unknown), of ln(value) where a positive quantity is known to 12 % or
    /// better.
    pub elements: Vec<String>,
    /// Where it is taken.
    pub at: Vec<f64>,
    /// Gradient of ln L there.
    pub gradient: Vec<f64>,
    /// Minus the second derivatives of ln L: the lower triangle by rows.
    pub information: Vec<Vec<f64>>,
}

/// A number of a joint among the coordinates of a fit.
pub(super) struct NamedCoordinate {
    /// What it is called.
    pub name: String,
    pub coordinate: usize,
    /// SI units for one unit of the coordinate.
    pub unit: f64,
}

/// The numbers of the only joint in the middle of the band, by its law.
pub(super) fn named_coordinates(law: &Dynamics) -> Vec<NamedCoordinate> {
    let units = units(law);
    let number = |(coordinate, &place): (usize, &usize)| NamedCoordinate {
        name: ELEMENTS[place].to_owned(),
        coordinate,
        unit: units[place],
    };
    law.slots().iter().enumerate().map(number).collect()
}

impl JointLikelihood {
    /// The same where the variance of the noise counts so many times.
    pub(super) fn inflated(mut self, by: f64) -> Self {
        self.gradient.iter_mut().for_each(|entry| *entry /= by);
        self.information.iter_mut().flatten().for_each(|entry| *entry /= by);
        self
    }

    /// From the normal equations at an optimum with c free: of these numbers and of the quantities, whose
    /// coordinates begin at `own`; what is neither is integrated out. Nothing where the FRFs leave that
    /// undetermined.
    pub(super) fn of(
        numbers: &[NamedCoordinate],
        own: usize,
        coordinates: &[f64],
        equations: &NormalEquations,
        parameters: &[Parameter],
    ) -> Option<Self> {
        let precision = |m: usize| parameters[m].precision;
        let mut all = QuadraticLikelihood::without_priors(equations, coordinates, precision);
        // At the optimum data and priors pull against each other. That derivatives by differences give a
        // little more or less must not move the joint.
        let gradient_of_priors = coordinates.iter().enumerate().map(|(m, at)| precision(m) * at);
        all.gradient = gradient_of_priors.collect();
        let kept: Vec<usize> =
            numbers.iter().map(|number| number.coordinate).chain(own..parameters.len()).collect();
        let si = all
            .marginal(&kept, precision)?
            .scaled(|index| numbers.get(index).map_or(1.0, |number| number.unit));
        let n = si.order();
        Some(JointLikelihood {
            elements: numbers.iter().map(|number| number.name.clone()).collect(),
            information: (0..n).map(|i| si.information[i * n..=i * n + i].to_vec()).collect(),
            at: si.at,
            gradient: si.gradient,
        })
    }
}
