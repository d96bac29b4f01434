//! From the refitted linear fixture to the law that explains what is left.

use super::fit::Fit;
use super::horizon::horizons;
use super::hypothesis::Hypothesis;
use super::locations::locations;
use super::misfit::{Focus, View};
use super::records::Record;
use super::shapes::{Suggestion, suggestions};
use crate::RestoringLaw;
use crate::settings::band::BEYOND_BAND;
use crate::settings::search::{
    BEHIND, BEHIND_BESIDE, BEHIND_BY_CHANCE, CONTENDERS, CONTRADICTION, CONTRADICTION_SHARE, FINALISTS,
    LINEAR_RENEWALS, LONG, MEDIUM, RECONSTRUCTED, RENEWALS, SEARCH_HALVINGS, SHORT, START_RENEWALS,
    STEPS_IN_INTERVAL, STEPS_IN_PERIOD, WEAK_KIND,
};
use crate::spectra::Compared;
use jointscope_fixture::Fixture;
use jointscope_inference::each;

/// What a search uses of the records.
pub(crate) struct Search<'a> {
    pub records: Vec<&'a Record>,
    /// One of every level at every point.
    few: Vec<&'a Record>,
    /// Lines compared.
    pub lines: Compared<'a>,
    /// Period of the slowest elastic motion, s.
    period_s: f64,
    within: usize,
}

/// How much of the records counts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Span {
    /// Periods over which the weight falls by e; all alike without.
    pub periods: Option<f64>,
    /// Where each record ends; where it has died away without.
    pub ends: Vec<usize>,
}

impl<'a> Search<'a> {
    pub(super) fn new(records: Vec<&'a Record>, lines: Compared<'a>, elastic_hz: (f64, f64)) -> Self {
        let interval = records.iter().map(|r| r.hit.interval()).fold(0.0, f64::max);
        // Thirty steps in a period of the fastest elastic motion.
        let within = (STEPS_IN_PERIOD * elastic_hz.1.min(lines.band.1) * interval)
            .ceil()
            .clamp(STEPS_IN_INTERVAL.0, STEPS_IN_INTERVAL.1) as usize;
        let first = |i: &usize| !records[..*i].iter().any(|earlier| earlier.is_like(records[*i]));
        let few = (0..records.len()).filter(first).map(|i| records[i]).collect();
        Search { records, few, lines, period_s: 1.0 / elastic_hz.0, within }
    }

    /// How a window of so many periods is compared; whole records without a number.
    pub(super) fn focus(&self, periods: Option<f64>) -> Focus<'a> {
        let decay = periods.map_or(0.0, |periods| 1.0 / (periods * self.period_s));
        Focus { decay, lines: self.lines, within: self.within, halvings: SEARCH_HALVINGS }
    }

    /// All records, as far as they are followed.
    pub(super) fn view(&self, span: &Span) -> View<'a> {
        View::new(&self.records, &self.focus(span.periods), &span.ends)
    }

    /// How far `fit` can follow each record.
    fn horizons(&self, records: &[&Record], fit: &Fit) -> Vec<usize> {
        horizons(records, &self.focus(None), fit, self.shortest_s())
    }

    /// So many periods of the slowest motion, s.
    pub(super) fn time_s(&self, periods: f64) -> f64 {
        periods * self.period_s
    }

    /// Time after a blow, s, that is always followed.
    pub(super) fn shortest_s(&self) -> f64 {
        self.time_s(SHORT)
    }

    /// The first moments of a hit of every level at every point, up to `ends` where there are such.
    fn window(&self, periods: f64, ends: &[usize]) -> View<'a> {
        View::new(&self.few, &self.focus(Some(periods)), ends)
    }

    /// The fixture without any law, refitted within its tolerances.
    pub(super) fn refitted(&self, nominal: &Hypothesis) -> Option<Fit> {
        let first = Fit::of(&self.window(MEDIUM, &[]), nominal, LINEAR_RENEWALS)?;
        let second = Fit::of(&self.window(LONG, &[]), &first.hypothesis, LINEAR_RENEWALS)?;
        let whole = self.view(&Span::default());
        let fits = [nominal, &second.hypothesis].map(|start| Fit::of(&whole, start, LINEAR_RENEWALS));
        best(fits.into_iter().flatten())
    }

    /// The kinds of effect beyond those of `base` that explain the most of the reconstructed forces, the best
    /// first.
    fn suggested(&self, fixture: &Fixture, base: &Hypothesis) -> Vec<Suggestion> {
        let locations = locations(fixture, &self.records, BEYOND_BAND * self.lines.band.1);
        let mut kinds: Vec<Suggestion> = Vec::new();
        for periods in RECONSTRUCTED {
            let focus = self.focus(Some(periods));
            for suggestion in suggestions(fixture, &self.few, &locations, &focus).into_iter().flatten() {
                match kinds.iter_mut().find(|kind| kind.effects[0].is_named_as(&suggestion.effects[0])) {
                    Some(kind) => kind.join(suggestion),
                    None => kinds.push(suggestion),
                }
            }
        }
        let taken = base.effects();
        kinds.retain(|kind| !taken.iter().any(|effect| effect.is_named_as(&kind.effects[0])));
        kinds.sort_by(|a, b| b.share.total_cmp(&a.share));
        kinds.truncate(CONTENDERS);
        let least = kinds.first().map_or(0.0, |kind| WEAK_KIND * kind.share);
        kinds.retain(|kind| kind.share >= least);
        kinds
    }

    /// Whether the law that was added last to a hypothesis never acts: a gap that no hit closes, friction
    /// that none makes slip. What gains by it are the quantities beside it.
    pub(super) fn is_idle(&self, hypothesis: &Hypothesis) -> bool {
        let Some((effect, model)) = hypothesis.effects().pop().zip(hypothesis.to_fixture().ok()) else {
            return false;
        };
        let all = locations(&model, &self.records, BEYOND_BAND * self.lines.band.1);
        let mut own = all.iter().filter(|location| location.is_of(&effect));
        let from = RestoringLaw::of(&effect).map_or(0.0, |law| law.acts_from());
        own.next().is_some_and(|location| location.reach < from)
    }

    /// Of `fits` those whose last law acts; and the best without it of the others, where a law that never
    /// acts may have led the quantities beside it out of a false minimum.
    pub(super) fn acting(&self, view: &View, fits: Vec<Fit>) -> (Vec<Fit>, Option<Fit>) {
        let (idle, acting): (Vec<Fit>, Vec<Fit>) =
            fits.into_iter().partition(|fit| self.is_idle(&fit.hypothesis));
        let freed = |fit: &Fit| Fit::of(view, &fit.hypothesis.without_last(), RENEWALS);
        (acting, best(idle.iter().filter_map(freed)))
    }

    /// Fits with one more effect beside those of `base`, the best first, and how much of the records decided
    /// between them.
    pub(super) fn hypotheses(&self, fixture: &Fixture, base: &Hypothesis) -> (Vec<Fit>, Span) {
        let kinds = self.suggested(fixture, base);
        let short = self.window(SHORT, &[]);
        let of_kind = |kind: &Suggestion| {
            let starts = kind.effects.iter().map(|effect| base.with(effect.clone()));
            best(starts.filter_map(|start| Fit::of(&short, &start, START_RENEWALS)))
        };
        let mut fits: Vec<Fit> = each(&kinds, of_kind).into_iter().flatten().collect();
        sort(&mut fits);
        narrow(&mut fits, &short);
        for window in [&short, &self.window(MEDIUM, &[])] {
            fits = refitted(&fits, window);
            narrow(&mut fits, window);
        }
        let ends = |records: &[&Record], fits: &[Fit]| {
            fits.first().map_or(Vec::new(), |fit| self.horizons(records, fit))
        };
        let long = self.window(LONG, &ends(&self.few, &fits));
        let mut shorter = refitted(&fits, &long);
        narrow(&mut shorter, &long);
        shorter.truncate(FINALISTS);
        let mut span = Span { periods: None, ends: ends(&self.records, &shorter) };
        let mut fits = refitted(&shorter, &self.view(&span));
        // What comes late must not contradict what came before: a motion that cannot be followed to its end
        // draws the fit away from the truth.
        if let (Some(before), Some(now)) = (shorter.first(), fits.first())
            && contradicts(long.objective(&now.hypothesis), before.objective)
        {
            span.periods = Some(LONG);
            fits = refitted(&shorter, &self.view(&span));
        }
        (fits, span)
    }
}

/// Whether an objective, of a hypothesis that more of the records led to, is worse than the one before by
/// more than chance and small errors of the model make.
pub(crate) fn contradicts(now: Option<f64>, before: f64) -> bool {
    now.is_none_or(|now| now > before * (1.0 + CONTRADICTION_SHARE) + CONTRADICTION)
}

/// Drops fits that are hopelessly behind.
fn narrow(fits: &mut Vec<Fit>, view: &View) {
    let Some(best) = fits.first().map(|fit| fit.objective) else { return };
    let limit = BEHIND * best + BEHIND_BESIDE + BEHIND_BY_CHANCE * view.degrees().sqrt();
    fits.retain(|fit| fit.objective < limit);
}

fn refitted(fits: &[Fit], view: &View) -> Vec<Fit> {
    let again = each(fits, |fit| Fit::of(view, &fit.hypothesis, RENEWALS));
    let mut again: Vec<Fit> = again.into_iter().flatten().collect();
    sort(&mut again);
    again
}

fn sort(fits: &mut [Fit]) {
    fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
}

fn best(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    fits.min_by(|a, b| a.objective.total_cmp(&b.objective))
}
