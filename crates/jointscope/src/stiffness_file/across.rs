//! The joint from the FRFs across it: averages over the band and the fit, beside the fixture's own.

use super::pair::pair;
use jointscope_comparison::{EstimateEntry, MatrixPair, Nominal};
use jointscope_decomposition::{
    Analysis, DynamicStiffnessPart, LikelihoodFit, MatrixAverage, MatrixElement, Relation,
};
use jointscope_linalg::RealMatrix2;
use serde::Serialize;

/// The joint from the FRFs across it.
#[derive(Serialize)]
pub(super) struct AcrossJoint {
    #[serde(flatten)]
    estimate: EstimateEntry,
    relation: Relation,
}

/// An estimate with what noise leaves uncertain.
fn estimate(value: (RealMatrix2, RealMatrix2), std: (RealMatrix2, RealMatrix2)) -> EstimateEntry {
    let MatrixPair { stiffness, damping } = pair(value);
    EstimateEntry {
        stiffness,
        damping,
        std: Some(pair(std)),
        band: None,
        lines: None,
        std_fixture: None,
        std_model: None,
        chi2_per_dof: None,
    }
}

pub(super) fn average(average: &MatrixAverage) -> EstimateEntry {
    estimate((average.stiffness, average.damping), (average.stiffness_std, average.damping_std))
}

pub(super) fn averages(analysis: &Analysis) -> EstimateEntry {
    let band = analysis.averages.band;
    EstimateEntry {
        band: Some((band.from, band.to)),
        lines: Some(analysis.averages.lines),
        std_fixture: Some(pair(analysis.tolerance_of_averages())),
        ..average(&analysis.averages.plain)
    }
}

/// K and C of the fixture as it stands, read as the lines are; `null` where no line of the band has them.
pub(super) fn nominal(analysis: &Analysis) -> Nominal {
    let paper = analysis.spectrum.relation == Relation::Paper;
    let element = |part: DynamicStiffnessPart, row: usize, column: usize| {
        analysis.nominal_average(part, MatrixElement { row, column }, paper)
    };
    let of = |part: DynamicStiffnessPart| [0, 1].map(|row| [0, 1].map(|column| element(part, row, column)));
    Nominal { stiffness: of(DynamicStiffnessPart::Stiffness), damping: of(DynamicStiffnessPart::Damping) }
}

pub(super) fn across(analysis: &Analysis, fit: &LikelihoodFit) -> AcrossJoint {
    let estimate = EstimateEntry {
        std_fixture: Some(pair(analysis.tolerance_of_likelihood())),
        std_model: Some(pair(fit.model_std())),
        chi2_per_dof: Some(fit.chi2_per_dof),
        ..estimate((fit.stiffness, fit.damping), (fit.stiffness_std, fit.damping_std))
    };
    AcrossJoint { estimate, relation: Relation::Exact }
}
