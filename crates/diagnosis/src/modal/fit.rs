//! One hypothesis at its most probable parameters and sizes of error.

mod in_turn;
mod modal_fit;

pub(crate) use modal_fit::ModalFit;

use crate::Hypothesis;
use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, PairedModes, Problem};
use crate::settings::modal::fit::AS_GOOD_AS_NONE;
use in_turn::{InTurn, Start};
use jointscope_model_error::{ErrorSizes, Pairing};
use modal_fit::{more_probable, one_of_two};

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
    ///
    /// Where the model's damping would turn shapes, it is as probable that the structure's turns none.
    pub(crate) fn fitted_from(
        &self,
        start: &Hypothesis,
        paired: PairedModes,
        priors: &[Prior],
        (nearby, set_out, least): (Option<Vec<Vec<f64>>>, SetOut, f64),
    ) -> Option<ModalFit> {
        if !(paired.comparison.turns_phases() && start.filters_nothing()) {
            return self.fitted_as(start, paired, priors, (nearby, set_out, least));
        }
        let in_phase = self.fitted_as(start, paired.clone().in_phase(), priors, (None, set_out, least));
        let least = in_phase.as_ref().map_or(least, |fit| least.max(fit.ln - AS_GOOD_AS_NONE));
        one_of_two(in_phase, self.fitted_as(start, paired, priors, (nearby, set_out, least)))
    }

    /// The same with the structure's damping as these modes are `paired` with it.
    fn fitted_as(
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
        (point, derivatives): Start,
        paired: PairedModes,
        priors: &[Prior],
        (sizes, least): (Option<ErrorSizes>, f64),
    ) -> Option<ModalFit> {
        let sizes = match sizes {
            Some(sizes) => sizes,
            None => self.evidence(&point, priors, &derivatives, (&paired.comparison, None))?.1.sizes,
        };
        InTurn::new(self, (&point, paired), priors, (sizes, least)).fitted((point, derivatives))
    }
}
