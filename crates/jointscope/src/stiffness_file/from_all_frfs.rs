//! The joint from all FRFs, with the laws that were compared.

use super::pair::pair;
use crate::file::value;
use jointscope_comparison::{
    ComparedLaw, FiledLikelihood, FollowedLaw, LossFactor, MatrixPair, ModelError, Uncertain,
};
use jointscope_decomposition::{JointFit, JointLikelihood, LawFit, LawKind};
use jointscope_inference::interval95;
use jointscope_linalg::RealMatrix2;
use serde::Serialize;

/// A joint from all FRFs, with what follows from its fit.
#[derive(Serialize)]
pub(super) struct JointEntry<'a> {
    #[serde(flatten)]
    fit: &'a JointFit,
    std: MatrixPair,
    model_error: ModelError,
    follows: FollowedLaw,
    #[serde(skip_serializing_if = "Option::is_none")]
    law: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    laws: Vec<ComparedLaw>,
}

impl<'a> JointEntry<'a> {
    pub(super) fn of(fit: &'a JointFit) -> Self {
        let (inflation, tolerance_inflation) = (fit.inflation, fit.tolerance_inflation);
        JointEntry {
            fit,
            std: pair(fit.std()),
            model_error: ModelError { inflation, tolerance_inflation, covariance: fit.model_covariance },
            follows: follows(fit),
            law: fit.law().map(LawFit::name),
            laws: fit.laws.iter().map(law).collect(),
        }
    }
}

/// Parameters of a law over frequency.
#[derive(Serialize)]
struct LawParameters {
    stiffness: RealMatrix2,
    #[serde(flatten)]
    losses: Option<Losses>,
    #[serde(flatten)]
    shape: Option<Shape>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness_per_rad_per_s: Option<RealMatrix2>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
}

/// The matrix of a law's losses, which has a name of its own in each.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Losses {
    Damping(RealMatrix2),
    ImaginaryStiffness(RealMatrix2),
    RelaxingStiffness(RealMatrix2),
    Springpot(RealMatrix2),
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Shape {
    Time(f64),
    Exponent(f64),
}

/// The law that the joint's numbers are of, the frequency at which they are stated, and its losses in its own
/// terms.
fn follows(fit: &JointFit) -> FollowedLaw {
    let follows = &fit.follows;
    let shape = |law: LawKind| {
        let shape = follows.shape.filter(|_| follows.law == law);
        shape.map(|(value, std)| Uncertain { value, std })
    };
    let loss_factor = (follows.law == LawKind::Structural).then(|| {
        let elements = [0, 1].map(|row| [0, 1].map(|column| fit.loss_factor(row, column)));
        LossFactor {
            value: elements.map(|row| row.map(|of| of.map(|(loss, _)| loss))),
            std: elements.map(|row| row.map(|of| of.map(|(_, std)| std))),
            ci95: elements.map(|row| row.map(|of| of.map(|(loss, std)| interval95(loss, std)))),
        }
    });
    FollowedLaw {
        law: follows.fit.name(),
        probability: Some(follows.fit.probability),
        frequency: follows.omega / std::f64::consts::TAU,
        exponent: shape(LawKind::Fractional),
        time: shape(LawKind::StandardLinearSolid),
        loss_factor,
    }
}

fn law(law: &LawFit) -> ComparedLaw {
    let (losses, shape) = match law.kind {
        LawKind::Constant => (None, None),
        LawKind::Viscous | LawKind::LinearStiffness => (Some(Losses::Damping(law.damping)), None),
        LawKind::Structural => (Some(Losses::ImaginaryStiffness(law.damping)), None),
        LawKind::StandardLinearSolid => {
            (Some(Losses::RelaxingStiffness(law.damping)), law.shape.map(Shape::Time))
        }
        LawKind::Fractional => (Some(Losses::Springpot(law.damping)), law.shape.map(Shape::Exponent)),
    };
    let (stiffness, stiffness_per_rad_per_s, mass) = (law.stiffness, law.change, law.mass);
    let parameters = LawParameters { stiffness, losses, shape, stiffness_per_rad_per_s, mass };
    let uncertain = |kind: LawKind| {
        let known = law.shape.zip(law.shape_std).filter(|_| law.kind == kind);
        known.map(|(value, std)| Uncertain { value, std })
    };
    ComparedLaw {
        law: law.name(),
        probability: law.probability,
        parameters: value(parameters),
        exponent: uncertain(LawKind::Fractional),
        time: uncertain(LawKind::StandardLinearSolid),
        in_the_middle: Some(pair(law.in_the_middle())),
        likelihood: law.likelihood.as_ref().map(likelihood),
    }
}

fn likelihood(told: &JointLikelihood) -> FiledLikelihood {
    FiledLikelihood {
        elements: told.elements.clone(),
        at: told.at.clone(),
        gradient: told.gradient.clone(),
        information: told.information.clone(),
    }
}
