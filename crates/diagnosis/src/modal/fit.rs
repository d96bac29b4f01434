//! One hypothesis at its most probable parameters and sizes of error.

use crate::Hypothesis;
use crate::modal::descent::Rest;
use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, PairedModes, Problem};
use crate::modal::turns::{Turns, are_alike};
use crate::rarity::rarity;
use crate::settings::modal::descent::STANDS_STILL;
use crate::settings::modal::fit::{
    BY_CHANCE, CONVERGED, IDLE_ROUNDS, MOST_ROUNDS, MOST_SHRINKAGE, MOST_STRAYS, PATIENT_ROUNDS,
    PROMISING_SHARE,
};
use jointscope_inference::{Covariance, dot};
use jointscope_linalg::Cholesky;
use jointscope_model_error::{ErrorSizes, Linear, ModelEvidence, Pairing};

/// A hypothesis at its most probable parameters.
#[derive(Debug, Clone)]
pub(crate) struct ModalFit {
    pub hypothesis: Hypothesis,
    pub priors: Vec<Prior>,
    pub paired: PairedModes,
    pub linear: Linear,
    pub evidence: ModelEvidence,
    /// Derivatives of the model's features by each coordinate, for a step of one.
    pub slopes: Vec<Vec<f64>>,
    /// Recorded less modelled features.
    pub residual: Vec<f64>,
    /// ln of the evidence, modes without a partner included.
    pub ln: f64,
}

/// The sizes of error that a fit sets out with. One that begins with errors too small follows whatever
/// features are recorded most sharply, and its errors then grow to suit it; one that begins with large ones
/// may rest content with them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SetOut {
    /// The usual ones.
    Usual,
    /// These, and where the fit ends with larger ones also those that the start asks for; the more probable
    /// end counts.
    Both,
    /// Those of a fit nearby besides.
    Beside(ErrorSizes),
}

/// Of a fit whose ln p matters wherever it ends.
pub(super) const ANY: f64 = f64::NEG_INFINITY;

impl ModalFit {
    /// The largest departure of the fixture's quantities, in standard deviations.
    pub(crate) fn largest_departure(&self) -> f64 {
        let departures = self.hypothesis.coordinates.iter().zip(&self.priors);
        let departures = departures.take(self.hypothesis.tolerances().len());
        departures.map(|(at, prior)| ((at - prior.mean) / prior.std).abs()).fold(0.0, f64::max)
    }

    /// Whether the features' misfit, errors of the model at their sizes and departures counted, is no larger
    /// than chance makes it.
    pub(crate) fn leaves_chance(&self) -> bool {
        let comparison = &self.paired.comparison;
        let Some(factor) = Cholesky::of(comparison.count(), &comparison.covariance(&self.evidence.sizes))
        else {
            return false;
        };
        let mut white = self.residual.clone();
        factor.solve_lower_in_place(&mut white);
        let degrees = comparison.count() as f64;
        dot(&white, &white) < degrees + BY_CHANCE * (2.0 * degrees).sqrt()
    }

    /// Covariance of the coordinates of the linear model where an error has these sizes.
    pub(crate) fn covariance_at(&self, sizes: &ErrorSizes) -> Option<Covariance> {
        let comparison = &self.paired.comparison;
        let factor = Cholesky::of(comparison.count(), &comparison.covariance(sizes))?;
        let white = |slope: &Vec<f64>| {
            let mut white = slope.clone();
            factor.solve_lower_in_place(&mut white);
            white
        };
        let white: Vec<Vec<f64>> = self.linear.slopes.iter().map(white).collect();
        let order = white.len();
        let entry = |e: usize| {
            let own = if e / order == e % order { 1.0 } else { 0.0 };
            own + dot(&white[e / order], &white[e % order])
        };
        let information: Vec<f64> = (0..order * order).map(entry).collect();
        let mut entries = Cholesky::of(order, &information)?.inverse();
        for (e, entry) in entries.iter_mut().enumerate() {
            *entry *= self.priors[e / order].std * self.priors[e % order].std;
        }
        Some(Covariance::new(order, entries))
    }
}

impl Problem<'_> {
    /// The most probable parameters from `start` on, and the sizes of the error there.
    pub(crate) fn fitted(&self, start: &Hypothesis, priors: &[Prior]) -> Option<ModalFit> {
        self.fitted_from(start, self.paired_modes(start)?, priors, (None, SetOut::Both, ANY))
    }

    /// [`Problem::fitted`], and from pairings beside the most likely one at the start where errors of the
    /// usual size do not do.
    pub(crate) fn fitted_however_paired(&self, start: &Hypothesis, priors: &[Prior]) -> Option<ModalFit> {
        let paired = self.paired_modes(start)?;
        let others = paired.pairing.others(self.recorded, &paired.modelled);
        let modelled = paired.modelled.clone();
        let first = self.fitted_from(start, paired, priors, (None, SetOut::Both, ANY));
        if others.is_empty() || first.as_ref().is_some_and(|fit| self.is_usual(&fit.evidence.sizes)) {
            return first;
        }
        let fixture = start.to_fixture().ok()?;
        let fitted = |pairing: Pairing| {
            let paired = self.paired_as((start, &fixture), modelled.clone(), pairing)?;
            self.fitted_from(start, paired, priors, (None, SetOut::Both, ANY))
        };
        others.into_iter().map(fitted).fold(first, more_probable)
    }

    /// [`Problem::fitted`] from a start whose modes are `paired` already, with derivatives known from nearby
    /// where there are any. What stays below `least` in ln p is not followed to its rest, nor from other
    /// sizes of error.
    pub(crate) fn fitted_from(
        &self,
        start: &Hypothesis,
        paired: PairedModes,
        priors: &[Prior],
        (nearby, set_out, least): (Option<Vec<Vec<f64>>>, SetOut, f64),
    ) -> Option<ModalFit> {
        let (point, paired) = self.at_start(start, paired);
        let count = point.residual.len();
        let nearby = nearby.filter(|slopes| slopes.iter().all(|slope| slope.len() == count));
        let derivatives = match nearby {
            Some(nearby) => nearby,
            None => self.slopes_at(&point, &paired, priors)?,
        };
        let from = |sizes| {
            self.fitted_with((point.clone(), derivatives.clone()), paired.clone(), priors, (sizes, least))
        };
        let mut best = from(Some(*self.sizes));
        if let SetOut::Beside(sizes) = set_out {
            best = more_probable(best, from(Some(sizes)));
        }
        let is_far = best.as_ref().is_some_and(|fit| fit.ln < least);
        if is_far
            || set_out == SetOut::Usual
            || best.as_ref().is_some_and(|fit| self.is_usual(&fit.evidence.sizes))
        {
            return best;
        }
        more_probable(best, from(None))
    }

    /// Where a fit from `start` sets out, errors of its damping counted as those of ratios alone.
    pub(super) fn at_start(&self, start: &Hypothesis, paired: PairedModes) -> (Iterate, PairedModes) {
        let paired = PairedModes { comparison: paired.comparison.with_ratios_alone(), ..paired };
        let residual = self.residual(&paired, &paired.modelled);
        let point = Iterate { hypothesis: start.clone(), modelled: paired.modelled.clone(), residual };
        (point, paired)
    }

    /// Whether no error is larger than the usual one.
    fn is_usual(&self, sizes: &ErrorSizes) -> bool {
        sizes.to_array().iter().zip(self.sizes.to_array()).all(|(size, usual)| *size <= usual)
    }

    /// Sizes of the error and parameters taken in turn from a point with its derivatives, and from these
    /// sizes or those that it asks for.
    fn fitted_with(
        &self,
        (mut point, mut derivatives): (Iterate, Vec<Vec<f64>>),
        mut paired: PairedModes,
        priors: &[Prior],
        (sizes, least): (Option<ErrorSizes>, f64),
    ) -> Option<ModalFit> {
        let rarity = rarity(&point.hypothesis);
        let mut sizes = match sizes {
            Some(sizes) => sizes,
            None => self.evidence(&point, priors, &derivatives, (&paired.comparison, None))?.1.sizes,
        };
        let (mut best, mut otherwise, mut stale): (Option<ModalFit>, Option<ModalFit>, Option<ModalFit>) =
            (None, None, None);
        let mut strayed = 0;
        let (mut idle, mut ahead) = (0, f64::NEG_INFINITY);
        let mut turns = Turns::none();
        for round in 0..MOST_ROUNDS {
            // What fails on the way takes nothing from what was found before.
            let Some(end) = self.settled(&paired, point, derivatives, (priors, &sizes)) else { break };
            let before = best.as_ref().map(|fit| fit.ln);
            let asked = end.evidence.sizes;
            let next = asked.larger(sizes.times(MOST_SHRINKAGE));
            let settled = next == asked;
            let same = settled && are_alike(&next, &sizes);
            let last = round + 1 == MOST_ROUNDS;
            let evidence = end.evidence_at_rest(settled, sizes);
            (point, derivatives) = (end.point, end.derivatives);
            let stands = evidence.is_some();
            sizes = turns.toward(&next, &sizes);
            let ln = end.evidence.ln + paired.pairing.alone() - rarity;
            let given_up =
                round >= PATIENT_ROUNDS && ln < least && ln - ahead < PROMISING_SHARE * (least - ln);
            ahead = ln;
            let none = (last || given_up) && best.is_none() && otherwise.is_none();
            if let Some(evidence) = evidence.or(none.then_some(end.evidence)) {
                let fit = ModalFit {
                    hypothesis: point.hypothesis.clone(),
                    priors: priors.to_vec(),
                    paired: PairedModes { modelled: point.modelled.clone(), ..paired.clone() },
                    linear: end.linear,
                    evidence,
                    slopes: derivatives.clone(),
                    residual: point.residual.clone(),
                    ln: evidence.ln + paired.pairing.alone() - rarity,
                };
                best = more_probable(best, Some(fit));
            }
            if given_up {
                break;
            }
            let gained = best.as_ref().zip(before).is_none_or(|(best, before)| best.ln - before >= CONVERGED);
            idle = if gained { 0 } else { idle + usize::from(stands) };
            let ends = best.is_some() && (same || idle == IDLE_ROUNDS);
            // Modes may have moved past others on the way, and shapes with them, or into the band or out of
            // it.
            let strays = strayed < MOST_STRAYS && point.modelled.strays(self.recorded);
            if last || !(ends || strays) {
                continue;
            }
            let Some(anew) = self.paired_modes(&point.hypothesis) else { break };
            let alike = anew.pairing.pairs == paired.pairing.pairs;
            // Where the fit set out, damping may have turned the shapes' phases by far more or less than it
            // does here.
            let damped_like = anew.comparison.damps_like(&paired.comparison, self.sizes.damping);
            let turned = alike && strayed < MOST_STRAYS && !damped_like;
            if ends && alike && anew.modelled.counts_like(&paired.modelled) && !turned {
                break;
            }
            point.residual = self.residual(&anew, &anew.modelled);
            point.modelled = anew.modelled.clone();
            let Some(there) = self.slopes_at(&point, &anew, priors) else { break };
            derivatives = there;
            // What counted a mode as what it is not, or another's damping as its own, says nothing.
            if strays || turned {
                stale = best.take();
                strayed += 1;
            }
            idle = 0;
            otherwise = more_probable(otherwise, best.take());
            paired = anew;
        }
        more_probable(otherwise, best).or(stale)
    }
}

impl Rest {
    /// The evidence that a fit at these `sizes` has where it stands still: at the sizes that are asked for,
    /// if they have `settled`, or else at its own. What is asked for says nothing of a point from where the
    /// parameters are still to move, or the sizes to shrink; at its own sizes a fit may stand still all the
    /// same.
    fn evidence_at_rest(&self, settled: bool, sizes: ErrorSizes) -> Option<ModelEvidence> {
        if settled && self.promised < STANDS_STILL {
            return Some(self.evidence);
        }
        (self.promised_there < STANDS_STILL).then_some(ModelEvidence {
            ln: self.evidence.ln_at_start,
            sizes,
            ..self.evidence
        })
    }
}

/// The more probable of two fits, as far as there are any.
fn more_probable(a: Option<ModalFit>, b: Option<ModalFit>) -> Option<ModalFit> {
    a.into_iter().chain(b).reduce(|best, fit| if fit.ln > best.ln { fit } else { best })
}
