//! What a comparison by modes leaves to the lines: whether it is in doubt, and what of it lines are asked
//! for.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::evidence::{cost, explained, explains};
use crate::finding::Finding;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::judgement::ModalJudgement;
use crate::modal::searcher::Named;
use crate::settings::ModalSettings;
use crate::settings::modal::judgement::MISSED_BELOW;
use jointscope_findings::Verdict;
use jointscope_fixture::{Effect, EffectKind};

/// A hypothesis found among the modes, fitted to lines.
#[derive(Debug, Clone)]
pub(crate) struct Explaining {
    pub fit: Fit,
    /// Whether it explains the modes without any error of the model, so that nothing large can be left out
    /// beside it.
    pub is_sure: bool,
}

/// What the modes led to, fitted to lines, where that leaves no more than noise: the more strictly if the
/// modes seem to need an error of the model. What will hardly come down to the noise is given up.
pub(super) fn fitted_to_lines(fitter: &Fitter, named: &Named) -> Option<Fit> {
    let noise = explained(fitter.observation, fitter.settings) * fitter.observation.degrees() as f64;
    explaining_lines(fitter, named, noise)
}

/// The same, given up where it will hardly come below `limit`.
fn explaining_lines(fitter: &Fitter, named: &Named, limit: f64) -> Option<Fit> {
    let fit = fitter.local(&named.fit.hypothesis, None, limit)?;
    explains(fitter, &fit, !named.exact).then_some(fit)
}

impl ModalJudgement {
    /// The same beside the fixture refitted to lines.
    pub(crate) fn beside(self, fitter: &Fitter, refitted: &Fit) -> Self {
        let (error, most) = MISSED_BELOW;
        let below = self.features.recorded.band.0;
        let misses_below = fitter.observation.misses_below(&refitted.predicted, below, error) > most;
        ModalJudgement { misses_below, ..self }
    }

    /// Whether the comparison rests on modes that may not be all there are, a free fit short of the noise,
    /// modes without a partner or lines missed below them all, or on records that are not alike, and a search
    /// by lines may do better.
    pub(crate) fn is_dubious(&self, fitter: &Fitter) -> bool {
        let alone = self.search.best.fit.paired.pairing.alone();
        // Records taken one after another, their noise told by scatter alone: an outlier among their gains
        // passes for an error of all gains.
        let unsure = self.is_unexplained() && fitter.observation.has_scatter_for_noise();
        let has_poles = self.free_fit_chi2_per_dof <= fitter.settings.modal.hopeless;
        // Errors of gains may be of any size among modes, one channel's gain for instance, which then is held
        // against itself.
        let gain = self.search.best.fit.has_gains_beyond(&self.features.known.scales);
        let is_doubted = || alone != 0.0 || unsure || gain || self.is_beyond_errors(fitter);
        self.is_incomplete_but_usable(fitter) || self.misses_below || (has_poles && is_doubted())
    }

    /// Whether errors of a structure's model, however large, leave more than noise: a sensor that loads some
    /// FRFs and others not gives these other poles, which no hypothesis without it has, and names that stand
    /// for errors are no better.
    fn is_beyond_errors(&self, fitter: &Fitter) -> bool {
        let observation = fitter.observation;
        let Some(structural) = self.features.structural(observation) else { return false };
        let (_, count) = observation.chi2_from(observation.values(), structural.from);
        let degrees = count.saturating_sub(structural.unknowns).max(1) as f64;
        structural.chi2 / degrees > explained(observation, fitter.settings)
    }

    /// Whether frequencies, damping and shapes of the best hypothesis are right to the noise, and gains of
    /// records are not known to be wrong: lines know of none.
    pub(crate) fn has_right_modes(&self) -> bool {
        self.errors[1].is_none() && !self.states_gain
    }

    /// Whether modes tell a part of the recording only, but not where no poles explain it at all.
    pub(crate) fn is_incomplete_but_usable(&self, fitter: &Fitter) -> bool {
        let ModalSettings { free_fit_limit, hopeless, .. } = fitter.settings.modal;
        (self.free_fit_chi2_per_dof > free_fit_limit || self.excess_residual_terms)
            && self.free_fit_chi2_per_dof <= hopeless
    }

    /// Whether a free fit that needed all it may for the noise, as what relaxes or damps heavily makes it
    /// need, leaves no doubt of the names, and these explain the modes.
    pub(crate) fn stands_out(&self, fitter: &Fitter) -> bool {
        self.verdict == Verdict::Explained && self.has_no_rival(fitter)
    }

    /// Whether modes are far less probable without any of the names, at least in part explained by them, and
    /// by no others nearly as well.
    pub(crate) fn has_no_rival(&self, fitter: &Fitter) -> bool {
        let ModalSettings { free_fit_limit, no_rival_within, .. } = fitter.settings.modal;
        let best = &self.search.best;
        let alone = |index: usize| {
            let others = self.search.alternatives[index]
                .iter()
                .filter(|other| other.names.last() != Some(&best.names[index]));
            others.count() == 0 && best.fit.ln - self.search.without[index] > no_rival_within
        };
        !best.names.is_empty()
            && self.free_fit_chi2_per_dof <= free_fit_limit
            && (0..best.names.len()).all(alone)
    }

    /// Whether errors of the usual size explain the modes of no hypothesis.
    pub(crate) fn is_unexplained(&self) -> bool {
        !matches!(self.verdict, Verdict::Consistent | Verdict::Explained)
    }

    /// What explains the recording without any error of the model, by its modes and down to the noise of its
    /// lines: the best of those that do. Where errors of the usual size do not explain the modes either, or
    /// these are dubious or right whatever their evidence says, lines decide alone, but more strictly. They
    /// do so too among what modes have nothing against where nothing is named: of few modes, or of broad ones,
    /// a gain or a spring to ground may be told by lines alone.
    pub(crate) fn exact(&self, fitter: &Fitter) -> Option<Explaining> {
        let by_lines = self.is_unexplained() || self.is_dubious(fitter) || self.has_right_modes();
        // What modes tell from the best is no better on lines.
        let best = self.search.best.fit.ln;
        let close = |named: &&Named| best - named.fit.ln < fitter.settings.modal.no_rival_within;
        let singles = self.search.singles.iter().take(fitter.settings.modal.tried);
        let all = singles.chain(&self.search.more).filter(close).chain([&self.search.best]);
        let odds = fitter.settings.modal.odds.ln();
        let nothing = self.search.best.names.is_empty().then_some(self.search.none.ln);
        let asked = |named: &&Named| {
            by_lines
                || named.exact && self.search.needs_all_of(named, odds)
                || nothing.is_some_and(|none| named.fit.ln - none > odds)
        };
        let all: Vec<&Named> = all.filter(asked).collect();
        // Broad modes lead to where lines are far from their optimum yet: the foremost has all the time. So have
        // all where modes do not tell the lowest lines.
        let is_foremost = |named: &Named| self.search.singles.first().is_some_and(|f| f.names == named.names);
        let explaining = |named: &&Named| {
            let fit = match is_foremost(named) || self.misses_below {
                true => explaining_lines(fitter, named, f64::INFINITY),
                false => fitted_to_lines(fitter, named),
            };
            Some(Explaining { fit: fit?, is_sure: named.exact })
        };
        let cost = |found: &Explaining| cost(fitter, &found.fit, 1.0);
        // More effects than explain the lines are for the lines to ask for.
        let most = all.iter().map(|named| named.names.len()).max().unwrap_or(0);
        (0..=most).find_map(|count| {
            let of_count = all.iter().filter(|named| named.names.len() == count);
            of_count.filter_map(explaining).min_by(|a, b| cost(a).total_cmp(&cost(b)))
        })
    }

    /// Whether modes that need no error of the model tell what explains them from `other`, which explains the
    /// lines with quantities bent: an antiresonance lies where what is left of higher modes puts it, a
    /// thousandth of which refutes every name on lines but one that bends enough to follow.
    pub(crate) fn tells_from(&self, fitter: &Fitter, other: &Hypothesis) -> bool {
        let Named { fit, exact, names } = &self.search.best;
        let effects = other.effects();
        let is_other = |named: &&Named| {
            let same = |(&name, effect): (&usize, _)| self.candidates[name].names(effect);
            named.names.len() == effects.len() && named.names.iter().zip(&effects).all(same)
        };
        let fitted = self.search.singles.iter().chain(&self.search.more).find(is_other);
        let needed = fitter.settings.modal.odds.ln();
        let is_clear = fitted.is_some_and(|other| other.names != *names && fit.ln - other.fit.ln > needed);
        *exact && is_clear && self.nearly_exact(fitter).is_some()
    }

    /// The findings of the lines; beside one alone the one name that the modes hold more probable, where
    /// errors of the model as usual leave them so. Each is as probable as the other then: what lines hold
    /// against that name is the very thing that such errors make.
    pub(crate) fn with_its_own_name(&self, fitter: &Fitter, mut findings: Vec<Finding>) -> Vec<Finding> {
        let effects = self.search.best.fit.hypothesis.effects();
        let ([own], [finding]) = (&effects[..], &mut findings[..]) else { return findings };
        let named = |effect: &Effect| effect.is_named_as(own);
        let is_listed = finding.alternatives.iter().any(|(effect, _)| named(effect));
        let little = self.features.is_incomplete(&fitter.settings.modal);
        // Without any error of the model lines are right to tell the two apart.
        let may_err = !self.search.best.exact;
        if !(self.names_all() && may_err) || little || named(&finding.effect) || is_listed {
            return findings;
        }
        let stated = finding.stated();
        finding.probability *= 0.5;
        finding.alternatives.iter_mut().for_each(|(_, probability)| *probability *= 0.5);
        finding.alternatives.push((own.clone(), 0.5 * stated));
        finding.alternatives.sort_by(|a, b| b.1.total_cmp(&a.1));
        findings
    }

    /// What explains the modes, fitted to lines, where it leaves little more than noise there: lines show
    /// what is beside the modes of a real structure too, and need not refute what these say.
    pub(crate) fn nearly_exact(&self, fitter: &Fitter) -> Option<Explaining> {
        if !self.names_all() {
            return None;
        }
        let Named { fit, exact, .. } = &self.search.best;
        let slight = fitter.settings.modal.slight;
        let most = slight * fitter.observation.degrees() as f64;
        let on_lines = fitter.local(&fit.hypothesis, None, most)?;
        let is_near = on_lines.chi2_per_dof(fitter.observation) < slight;
        is_near.then_some(Explaining { fit: on_lines, is_sure: *exact })
    }

    /// Names that lines may be asked for where errors of the usual size do not explain the modes: the most
    /// probable by themselves, and quantities that are wrong.
    pub(crate) fn in_question(&self, fitter: &Fitter) -> Vec<Candidate> {
        if !self.is_unexplained() {
            return Vec::new();
        }
        let tried = self.search.singles.iter().take(fitter.settings.modal.tried);
        let probable: Vec<usize> = tried.flat_map(|single| single.names.clone()).collect();
        let of = |(index, candidate): (usize, &Candidate)| {
            let asked = probable.contains(&index) || candidate.kind == EffectKind::QuantityError;
            asked.then(|| candidate.clone())
        };
        self.candidates.iter().enumerate().filter_map(of).collect()
    }
}
