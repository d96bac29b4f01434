//! What errors of the model leave uncertain of effects that lines have found.
//!
//! Where noise of lines is told from their scatter, a model may leave no more than that and still be in
//! error: its modes, told from many lines each, are off by far more than their noise. Intervals by the noise
//! of the lines are then too narrow by as much. The errors that the modes need beside what was found, at the
//! very parameters that lines have led to, make intervals of their own, and the wider of the two counts.

use crate::candidate::Candidate;
use crate::estimates::estimates;
use crate::finding::Finding;
use crate::fitter::Fitter;
use crate::modal::fit::ModalFit;
use crate::modal::judgement::ModalJudgement;
use crate::modal::prior::{Prior, priors_among};
use crate::modal::problem::{Iterate, Problem};
use crate::rarity::rarity;
use crate::{Hypothesis, Observation};
use jointscope_findings::Estimate;
use jointscope_fixture::EffectKind;
use jointscope_inference::Covariance;

impl ModalJudgement {
    /// The findings of `hypothesis`, none of their parameters surer than the errors of its modes allow.
    pub(crate) fn with_errors_of_modes(
        &self,
        fitter: &Fitter,
        hypothesis: &Hypothesis,
        candidates: &[Candidate],
        findings: Vec<Finding>,
    ) -> Vec<Finding> {
        let Some(covariance) = self.uncertainty_of(fitter, hypothesis, candidates) else { return findings };
        let effects = hypothesis.effects();
        let widened = |finding: Finding| {
            let own = effects.iter().position(|effect| effect.is_named_as(&finding.effect));
            let Some(index) = own else { return finding };
            let by_modes = estimates(hypothesis, index, &finding.effect, Some(&covariance), 1.0);
            let pairs = finding.estimates.into_iter().zip(by_modes);
            Finding { estimates: pairs.map(|(lines, modes)| less_sure(lines, modes)).collect(), ..finding }
        };
        findings.into_iter().map(widened).collect()
    }

    /// Covariance of a hypothesis' coordinates by its modes and their errors; `None` where these need none,
    /// or are not all told, or where FRFs have no modes in common.
    fn uncertainty_of(
        &self,
        fitter: &Fitter,
        hypothesis: &Hypothesis,
        candidates: &[Candidate],
    ) -> Option<Covariance> {
        if has_moved_sensor(hypothesis, fitter.observation) {
            return None;
        }
        let problem = self.features.problem(fitter.observation.work());
        let fit = problem.unfitted(hypothesis, &priors_among(hypothesis, candidates)?)?;
        let errors_count =
            fit.paired.pairing.alone() == 0.0 && !problem.is_exact(&fit, fitter.settings.modal.exact);
        let sizes = || fit.linear.mean_sizes(&fit.paired.comparison, problem.prior(), &fit.evidence);
        errors_count.then(|| fit.covariance_at(&sizes())).flatten()
    }
}

/// Whether a sensor loads the structure in some FRFs and not in others: each has poles of its own then, and
/// the common ones of a recording are of no structure.
fn has_moved_sensor(hypothesis: &Hypothesis, observation: &Observation) -> bool {
    let pairs = observation.pairs();
    let several = pairs.iter().any(|pair| pair.response != pairs[0].response);
    several && hypothesis.effects().iter().any(|effect| effect.kind == EffectKind::SensorMass)
}

impl Problem<'_> {
    /// A hypothesis as it is, with the sizes of error that it asks for.
    fn unfitted(&self, hypothesis: &Hypothesis, priors: &[Prior]) -> Option<ModalFit> {
        let (point, paired) = self.at_start(hypothesis, self.paired_modes(hypothesis)?);
        let slopes = self.slopes_at(&point, &paired, priors)?;
        let (linear, evidence) = self.evidence(&point, priors, &slopes, (&paired.comparison, None))?;
        let ln = evidence.ln + paired.pairing.alone() - rarity(hypothesis);
        let Iterate { hypothesis, residual, .. } = point;
        Some(ModalFit { hypothesis, priors: priors.to_vec(), paired, linear, evidence, slopes, residual, ln })
    }
}

/// The one of two estimates of the same value that is less sure of it; one that is sure of nothing says
/// nothing.
fn less_sure(a: Estimate, b: Estimate) -> Estimate {
    match (a.std, b.std) {
        (Some(own), Some(other)) if other > own => b,
        _ => a,
    }
}
