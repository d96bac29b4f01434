//! Sizes of the error and parameters of a hypothesis taken in turn, until neither moves the other any more.

use super::modal_fit::{ModalFit, more_probable};
use crate::modal::descent::Rest;
use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, PairedModes, Problem};
use crate::modal::turns::{Turns, are_alike};
use crate::rarity::rarity;
use crate::settings::modal::descent::STANDS_STILL;
use crate::settings::modal::fit::{
    CONVERGED, IDLE_ROUNDS, MOST_ROUNDS, MOST_SHRINKAGE, MOST_STRAYS, PATIENT_ROUNDS, PROMISING_SHARE,
};
use jointscope_model_error::{ErrorSizes, Linear, ModelEvidence};

/// A point with the derivatives there.
pub(super) type Start = (Iterate, Vec<Vec<f64>>);

/// A fit from round to round: parameters are fitted at the sizes of the error, then the sizes go on to those
/// that the parameters ask for.
pub(super) struct InTurn<'a> {
    problem: &'a Problem<'a>,
    priors: &'a [Prior],
    /// Of the effects: it is subtracted from ln p.
    rarity: f64,
    /// A fit that does not promise to reach this in ln p is given up.
    least: f64,
    paired: PairedModes,
    sizes: ErrorSizes,
    turns: Turns,
    fits: Fits,
    /// ln p of the round before.
    before: f64,
    /// Rounds in a row that stood still and gained nothing.
    idle: usize,
    /// How often the modes had to be paired anew because some counted as what they are not.
    strayed: usize,
}

impl<'a> InTurn<'a> {
    /// A fit of a hypothesis as rare as that which it starts from.
    pub(super) fn new(
        problem: &'a Problem<'a>,
        (point, paired): (&Iterate, PairedModes),
        priors: &'a [Prior],
        (sizes, least): (ErrorSizes, f64),
    ) -> Self {
        InTurn {
            problem,
            priors,
            rarity: rarity(&point.hypothesis),
            least,
            paired,
            sizes,
            turns: Turns::none(),
            fits: Fits::default(),
            before: f64::NEG_INFINITY,
            idle: 0,
            strayed: 0,
        }
    }

    /// The most probable fit of all rounds.
    pub(super) fn fitted(mut self, mut start: Start) -> Option<ModalFit> {
        for round in 0..MOST_ROUNDS {
            // What fails on the way takes nothing from what was found before.
            let Some(next) = self.after_round(round, start) else { break };
            start = next;
        }
        self.fits.most_probable()
    }

    /// Where the next round starts; `None` where the fit ends.
    fn after_round(&mut self, round: usize, (point, derivatives): Start) -> Option<Start> {
        let end = self.problem.settled(&self.paired, point, derivatives, (self.priors, &self.sizes))?;
        let (at_rest, asks_for_the_same) = self.go_on_to_sizes_asked_for(&end);
        let stands_still = at_rest.is_some();
        let is_last = round + 1 == MOST_ROUNDS;
        let is_given_up = self.is_given_up(round, self.ln(&end.evidence));
        let Rest { point, derivatives, linear, evidence, .. } = end;
        // A fit that ends without having stood still anywhere is as probable as it is where it ends.
        let is_only_one = (is_last || is_given_up) && self.fits.are_none();
        let has_gained = match at_rest.or(is_only_one.then_some(evidence)) {
            Some(evidence) => self.fits.add(self.fit_at((&point, &derivatives), linear, evidence)),
            None => self.fits.here.is_none(),
        };
        if is_given_up {
            return None;
        }
        self.idle = if has_gained { 0 } else { self.idle + usize::from(stands_still) };
        let ends = self.fits.here.is_some() && (asks_for_the_same || self.idle == IDLE_ROUNDS);
        // Modes may have moved past others on the way, and shapes with them, or into the band or out of it.
        let strays = self.strayed < MOST_STRAYS && point.modelled.strays(self.problem.recorded);
        match !is_last && (ends || strays) {
            true => self.paired_anew(point, ends, strays),
            false => Some((point, derivatives)),
        }
    }

    /// Goes on to the sizes of error that a fit asks for. Answers with its evidence if it stands still, and
    /// whether it asks for no others than it has.
    fn go_on_to_sizes_asked_for(&mut self, end: &Rest) -> (Option<ModelEvidence>, bool) {
        let asked = end.evidence.sizes;
        let next = asked.larger(self.sizes.times(MOST_SHRINKAGE));
        let settled = next == asked;
        let is_same = settled && are_alike(&next, &self.sizes);
        let at_rest = end.evidence_at_rest(settled, self.sizes);
        self.sizes = self.turns.toward(&next, &self.sizes);
        (at_rest, is_same)
    }

    /// Whether a fit of this ln p promises too little to go on.
    fn is_given_up(&mut self, round: usize, ln: f64) -> bool {
        let gained = ln - self.before;
        self.before = ln;
        round >= PATIENT_ROUNDS && ln < self.least && gained < PROMISING_SHARE * (self.least - ln)
    }

    /// ln p by an evidence, modes without a partner and the rarity of the effects included.
    fn ln(&self, evidence: &ModelEvidence) -> f64 {
        evidence.ln + self.paired.pairing.alone() - self.rarity
    }

    fn fit_at(
        &self,
        (point, derivatives): (&Iterate, &[Vec<f64>]),
        linear: Linear,
        evidence: ModelEvidence,
    ) -> ModalFit {
        ModalFit {
            hypothesis: point.hypothesis.clone(),
            priors: self.priors.to_vec(),
            paired: PairedModes { modelled: point.modelled.clone(), ..self.paired.clone() },
            linear,
            evidence,
            slopes: derivatives.to_vec(),
            residual: point.residual.clone(),
            ln: self.ln(&evidence),
        }
    }

    /// The same point with its modes paired anew; `None` where that changes nothing and the fit `ends`.
    fn paired_anew(&mut self, point: Iterate, ends: bool, strays: bool) -> Option<Start> {
        let anew = self.problem.paired_modes(&point.hypothesis)?;
        let in_phase = self.paired.comparison.is_in_phase();
        let anew = if in_phase { anew.in_phase() } else { anew };
        let alike = anew.pairing.pairs == self.paired.pairing.pairs;
        // Where the fit set out, damping may have turned the shapes' phases by far more or less than it does
        // here.
        let damped_like = anew.comparison.damps_like(&self.paired.comparison, self.problem.sizes.damping);
        let turned = alike && self.strayed < MOST_STRAYS && !damped_like;
        if ends && alike && anew.modelled.counts_like(&self.paired.modelled) && !turned {
            return None;
        }
        let residual = self.problem.residual(&anew, &anew.modelled);
        let point = Iterate { modelled: anew.modelled.clone(), residual, ..point };
        let derivatives = self.problem.slopes_at(&point, &anew, self.priors)?;
        let is_void = strays || turned;
        self.fits.set_aside(is_void);
        self.strayed += usize::from(is_void);
        self.idle = 0;
        self.paired = anew;
        Some((point, derivatives))
    }
}

/// The most probable fits, by the pairing of modes that they were found with.
#[derive(Default)]
struct Fits {
    /// With the present one.
    here: Option<ModalFit>,
    /// With those before.
    before: Option<ModalFit>,
    /// With the last that counted a mode as what it is not, or another's damping as its own: it says
    /// something only where there is no other fit.
    void: Option<ModalFit>,
}

impl Fits {
    fn are_none(&self) -> bool {
        self.here.is_none() && self.before.is_none()
    }

    /// Takes in a fit with the present pairing; whether it gains anything.
    fn add(&mut self, fit: ModalFit) -> bool {
        let before = self.here.as_ref().map(|fit| fit.ln);
        self.here = more_probable(self.here.take(), Some(fit));
        self.here.as_ref().zip(before).is_none_or(|(best, before)| best.ln - before >= CONVERGED)
    }

    /// Makes room for fits with another pairing.
    fn set_aside(&mut self, is_void: bool) {
        if is_void {
            self.void = self.here.take();
        }
        self.before = more_probable(self.before.take(), self.here.take());
    }

    fn most_probable(self) -> Option<ModalFit> {
        more_probable(self.before, self.here).or(self.void)
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
