//! Models that are to predict where nobody measured.
//!
//! What is said of effects and quantities is said at the sizes of error that are most probable: a natural
//! frequency that is off by its error is as probable as quantities that are off by theirs. Such a model
//! predicts badly all the same, for beside a resonance a small error of frequency is a large one of an FRF.
//! One that is to predict has the effects that are stated, and quantities that follow recorded natural
//! frequencies and damping more closely: as closely as takes none of them farther from what is stated than
//! chance, or than it already is.

use crate::departures::farthest;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::descent::settings;
use crate::modal::fit::ModalFit;
use crate::modal::judgement::ModalJudgement;
use crate::modal::problem::{Iterate, Problem};
use crate::search::Search;
use crate::settings::ModalSettings;
use crate::settings::effects::quantities::DEPARTED;
use crate::settings::modal::judgement::{BOUGHT, LEAST_MET, NO_MODEL, NO_PEAK};
use crate::work::Work;
use crate::{Hypothesis, Observation};
use jointscope_findings::Verdict;
use jointscope_inference::descend;
use jointscope_model_error::ErrorSizes;

impl ModalJudgement {
    /// The comparison with its models as they predict lines; `within` is the fixture refitted on them. What
    /// explains the modes in part only, and leaves more than a part of what lines miss without it, is not
    /// stated, unless the fixture by itself comes as close only by a departure beyond chance; nor is what explains
    /// them and spoils the lines.
    pub(crate) fn predicted(&self, fitter: &Fitter, within: &Search) -> (Self, Search) {
        let settings = &fitter.settings.modal;
        let models = self.predicting(fitter.observation.work(), settings);
        let search = self.search_on(fitter.observation, within, &models);
        let search = self.no_farther(fitter.observation, search);
        let departs = |fit: &ModalFit| fit.largest_departure() > settings.adequate.1;
        let bought = departs(&self.search.none) && !departs(&self.search.best.fit);
        // Factors on channels' signals leave natural frequencies as they are: peaks that miss each other by
        // these say nothing of a gain.
        let is_asked = !bought && !self.search.best.fit.is_of_signals();
        let misses = is_asked && search.repaired.chi2 >= settings.part * search.refitted.chi2;
        let is_none = match self.verdict {
            Verdict::PartlyExplained => misses,
            Verdict::Explained => self.spoils_lines(fitter, &search, if bought { BOUGHT } else { 1.0 }),
            Verdict::Consistent | Verdict::Unexplained => false,
        };
        if is_none {
            return (self.withdrawn(), Search { repaired: search.refitted.clone(), ..search });
        }
        if self.verdict == Verdict::Explained
            && (self.leaves_much_where_incomplete(fitter, &search)
                || self.tells_nothing_of_lines(fitter, &search))
        {
            return (self.doubted(), search);
        }
        (self.clone(), search)
    }

    /// Whether lines miss far more with what explains the modes than without: gains of all records, which may
    /// be off by anything among modes, make up for a gain that is none. What misses less without the names may
    /// be worth so many times as much.
    fn spoils_lines(&self, fitter: &Fitter, search: &Search, worth: f64) -> bool {
        let spoils = worth * fitter.settings.modal.spoils;
        let Search { refitted, repaired, .. } = search;
        let [missed, misses] = [refitted, repaired].map(|fit| fitter.observation.nrmse(&fit.predicted));
        !self.since_baseline && misses > spoils * missed && repaired.chi2 > spoils * spoils * refitted.chi2
    }

    /// Whether lines miss much of a recording that modes do not tell: what a free fit took residual terms for
    /// passes for errors in what lies outside the band, and what it took a mode for is held against no name.
    /// What a calibrated model is off by in both states is neither.
    fn leaves_much_where_incomplete(&self, fitter: &Fitter, search: &Search) -> bool {
        let ModalSettings { most_left_where_incomplete: most, slight, .. } = fitter.settings.modal;
        let Search { refitted, repaired, .. } = search;
        let leaves =
            repaired.chi2_per_dof(fitter.observation) > slight && repaired.chi2 > most * refitted.chi2;
        leaves && !self.since_baseline && (self.is_incomplete_but_usable(fitter) || self.has_no_peak())
    }

    /// Whether what explains the modes predicts lines no better than zeros do, and not because its peaks are as
    /// far off as errors of its frequencies take them: a mode that it takes out of the band is missed by no mode,
    /// and by every line.
    fn tells_nothing_of_lines(&self, fitter: &Fitter, search: &Search) -> bool {
        let (observation, predicted) = (fitter.observation, &search.repaired.predicted);
        !self.since_baseline
            && observation.nrmse(predicted) > NO_MODEL
            && self.errors[1].squares_met(observation, predicted) < LEAST_MET
    }

    /// Whether something is recorded beside the modes of the model that is as wide as no mode of a structure.
    fn has_no_peak(&self) -> bool {
        let pairs = &self.search.best.fit.paired.pairing.pairs;
        let mut modes = self.features.recorded.modes.iter().enumerate();
        modes.any(|(at, mode)| mode.pole.damping_ratio > NO_PEAK && pairs.iter().all(|(own, _)| *own != at))
    }

    /// The same with the model as it is stated where that comes closer to the recorded lines than one that
    /// follows frequencies, and with the fixture as it was given where that does: where frequencies stay far
    /// off, following them says nothing of what is between them.
    fn no_farther(&self, observation: &Observation, search: Search) -> Search {
        let closer = |fit: Fit, stated: &Hypothesis| match Fit::at(stated.clone(), observation) {
            Some(other) if other.chi2 < fit.chi2 => other,
            _ => fit,
        };
        let [none, best] = &self.stated;
        let refitted = closer(closer(search.refitted, none), &search.nominal.hypothesis);
        let repaired = match best.effect_count() {
            0 => refitted.clone(),
            _ => closer(search.repaired, best),
        };
        Search { refitted, repaired, ..search }
    }

    /// The fixture by itself and the best hypothesis as they are to predict; what that takes is counted in
    /// `work`.
    fn predicting(&self, work: &Work, settings: &ModalSettings) -> [Hypothesis; 2] {
        let problem = self.features.problem(work);
        let [none, best] = [&self.search.none, &self.search.best.fit];
        // The refit's errors may be larger where what is missing shows, and smaller elsewhere.
        let sizes = [none.evidence.sizes, best.evidence.sizes.smaller(none.evidence.sizes)];
        let model = |index: usize| {
            let found = &self.stated[index];
            let quantities = Quantities::of(&problem, [none, best][index], found);
            let followed = quantities.and_then(|all| all.following(&sizes[index], &settings.followed));
            followed.unwrap_or_else(|| found.clone())
        };
        [model(0), model(1)]
    }
}

/// The quantities of a hypothesis, its effects staying as they were found.
struct Quantities<'a> {
    problem: &'a Problem<'a>,
    /// A fit of the same names.
    fit: &'a ModalFit,
    found: &'a Hypothesis,
    start: Iterate,
}

impl<'a> Quantities<'a> {
    fn of(problem: &'a Problem<'a>, fit: &'a ModalFit, found: &'a Hypothesis) -> Option<Self> {
        let hypothesis = found.with_effects_in_place()?;
        let modelled = problem.modelled(&hypothesis, &fit.paired.modelled)?;
        let residual = problem.residual(&fit.paired, &modelled);
        Some(Quantities { problem, fit, found, start: Iterate { hypothesis, modelled, residual } })
    }

    /// The hypothesis whose errors are the first of these `shares` of the most probable `sizes` that chance
    /// allows; the last one that can be fitted where it allows none.
    fn following(&self, sizes: &ErrorSizes, shares: &[f64]) -> Option<Hypothesis> {
        let reach = farthest(self.found).map_or(DEPARTED, |(_, deviations)| deviations.max(DEPARTED));
        let within = |model: &Hypothesis| farthest(model).is_none_or(|(_, deviations)| deviations <= reach);
        let mut last = None;
        for share in shares {
            last = self.most_probable(&sizes.following(*share)).or(last);
            if last.as_ref().is_some_and(within) {
                break;
            }
        }
        last
    }

    /// The most probable quantities at given sizes of the error.
    fn most_probable(&self, sizes: &ErrorSizes) -> Option<Hypothesis> {
        let count = self.found.tolerances().len();
        let descent = self.problem.descent_at(self.fit, &self.fit.priors[..count], sizes)?;
        let slopes = self.fit.slopes[..count].to_vec();
        let point = descend(&descent, self.start.clone(), Some(slopes), &settings(usize::MAX))?.point;
        Some(self.found.with_tolerances_of(&point.hypothesis))
    }
}
