//! From the refitted linear fixture to the law that explains what is left.

use super::candidates::{Seat, seats};
use super::fit::Fit;
use super::horizon::horizons;
use super::misfit::{Focus, View};
use super::parameters::{Law, Parameters};
use super::reconstruction::{Look, suggestions};
use super::records::Record;
use super::shapes::Suggestion;
use jointscope_fixture::Fixture;
use rayon::prelude::*;

/// What a search uses of the records.
pub(crate) struct Search<'a> {
    pub records: Vec<&'a Record>,
    /// One of every level at every point.
    few: Vec<&'a Record>,
    pub band: (f64, f64),
    /// Period of the slowest elastic motion, s.
    period: f64,
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

/// A name with its best fit, and how it fared.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub law: Law,
    pub fit: Fit,
}

/// Periods of the slowest motion over which the weight of a look falls by e: of an opening, a first and a second look.
const OPENING: f64 = 2.0;
const FIRST_LOOK: f64 = 5.0;
const SECOND_LOOK: f64 = 30.0;
/// The same of the looks from which a joint's force is reconstructed: the shorter, the less the fixture's errors add up; the longer, the more is seen.
const RECONSTRUCTED: [f64; 3] = [2.0, 5.0, 12.0];
/// What a longer look may cost a shorter one in χ² and priors: so much, and so large a part of them.
const CONTRADICTION: (f64, f64) = (40.0, 3e-3);
/// Share explained, relative to the best kind's, below which a kind is not fitted.
const WEAK: f64 = 0.1;
/// χ² per degree of freedom from which names are further from the best than any later look could bring them back.
const BEHIND: f64 = 1.5;
/// Kinds of law that are fitted.
const CONTENDERS: usize = 4;
/// Derivatives taken at the most for a name on one look: a fit that is cut short is carried into the next as a false minimum.
const RENEWALS: usize = 20;
/// Names that are fitted to whole records.
const FINALISTS: usize = 3;

impl<'a> Search<'a> {
    pub fn new(records: Vec<&'a Record>, band: (f64, f64), elastic_hz: (f64, f64)) -> Self {
        let interval = records.iter().map(|r| r.hit.interval()).fold(0.0, f64::max);
        // Thirty steps in a period of the fastest elastic motion.
        let within = (30.0 * elastic_hz.1.min(band.1) * interval).ceil().clamp(2.0, 16.0) as usize;
        let alike = |a: &Record, b: &Record| a.struck() == b.struck() && a.level == b.level;
        let first = |i: &usize| !records[..*i].iter().any(|earlier| alike(earlier, records[*i]));
        let few = (0..records.len()).filter(first).map(|i| records[i]).collect();
        Search { records, few, band, period: 1.0 / elastic_hz.0, within }
    }

    /// How a look of so many periods is taken; of whole records without a number.
    pub fn focus(&self, periods: Option<f64>) -> Focus {
        let decay = periods.map_or(0.0, |periods| 1.0 / (periods * self.period));
        Focus { decay, band: self.band, within: self.within, halvings: 3 }
    }

    /// All records, as far as they are followed.
    pub fn view(&self, span: &Span) -> View<'a> {
        View::new(&self.records, &self.focus(span.periods), &span.ends)
    }

    /// How far `fit` can follow each record.
    fn horizons(&self, records: &[&Record], fit: &Fit) -> Vec<usize> {
        horizons(records, &self.focus(None), fit, self.shortest())
    }

    /// So many periods of the slowest motion, s.
    pub fn time_of(&self, periods: f64) -> f64 {
        periods * self.period
    }

    /// Time after a blow, s, that is always followed.
    pub fn shortest(&self) -> f64 {
        self.time_of(OPENING)
    }

    /// The first moments of a hit of every level at every point, up to `ends` where there are such.
    fn look(&self, periods: f64, ends: &[usize]) -> View<'a> {
        View::new(&self.few, &self.focus(Some(periods)), ends)
    }

    /// The fixture without any law, refitted within its tolerances.
    pub fn refitted(&self, nominal: &Parameters) -> Option<Fit> {
        let first = Fit::of(&self.look(FIRST_LOOK, &[]), nominal, 5)?;
        let second = Fit::of(&self.look(SECOND_LOOK, &[]), &first.parameters, 5)?;
        let whole = self.view(&Span::default());
        let fits = [nominal, &second.parameters].map(|start| Fit::of(&whole, start, 5));
        fits.into_iter().flatten().min_by(|a, b| a.objective.total_cmp(&b.objective))
    }

    /// Names for one more law beside those of `base`, the best first, and how much of the records told them apart.
    pub fn names(&self, fixture: &Fixture, base: &Parameters) -> (Vec<Named>, Span) {
        let seats: Vec<Seat> = seats(fixture, &self.records, 2.0 * self.band.1);
        let taken = |law: &Law| base.laws.iter().any(|other| other.is_named_as(law));
        let mut kinds: Vec<Suggestion> = Vec::new();
        for periods in RECONSTRUCTED {
            let decay = 1.0 / (periods * self.period);
            let look = Look { decay, highest: self.band.1, within: self.within };
            for suggestion in suggestions(fixture, &self.few, &seats, look).into_iter().flatten().flatten() {
                match kinds.iter_mut().find(|kind| kind.laws[0].is_named_as(&suggestion.laws[0])) {
                    Some(kind) => kind.join(suggestion),
                    None => kinds.push(suggestion),
                }
            }
        }
        kinds.retain(|kind| !taken(&kind.laws[0]));
        kinds.sort_by(|a, b| b.share.total_cmp(&a.share));
        kinds.truncate(CONTENDERS);
        let least = kinds.first().map_or(0.0, |kind| WEAK * kind.share);
        kinds.retain(|kind| kind.share >= least);
        let opening = self.look(OPENING, &[]);
        let mut names: Vec<Named> = kinds
            .par_iter()
            .filter_map(|kind| {
                let starts = kind.laws.iter().map(|law| base.with(law.clone()));
                let fits = starts.filter_map(|start| Fit::of(&opening, &start, 4));
                let best = fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?;
                Some(Named { law: kind.laws[0].clone(), fit: best })
            })
            .collect();
        sort(&mut names);
        self.narrowed(&mut names, opening.degrees());
        refit(&mut names, &opening, RENEWALS);
        self.narrowed(&mut names, opening.degrees());
        let first = self.look(FIRST_LOOK, &[]);
        refit(&mut names, &first, RENEWALS);
        self.narrowed(&mut names, first.degrees());
        let ends = |records: &[&Record], names: &[Named]| {
            names.first().map_or(Vec::new(), |name| self.horizons(records, &name.fit))
        };
        let second = self.look(SECOND_LOOK, &ends(&self.few, &names));
        refit(&mut names, &second, RENEWALS);
        self.narrowed(&mut names, second.degrees());
        names.truncate(FINALISTS);
        let mut span = Span { periods: None, ends: ends(&self.records, &names) };
        let shorter = names.clone();
        refit(&mut names, &self.view(&span), RENEWALS);
        // What comes late must not contradict what came before: a motion that cannot be followed to its end draws the fit away from the truth.
        let contradicted = match (shorter.first(), names.first()) {
            (Some(before), Some(now)) => {
                contradicts(second.objective(&now.fit.parameters), before.fit.objective)
            }
            _ => false,
        };
        if contradicted {
            span.periods = Some(SECOND_LOOK);
            names = shorter.clone();
            refit(&mut names, &self.view(&span), RENEWALS);
        }
        (names, span)
    }

    /// Drops names that are hopelessly behind.
    fn narrowed(&self, names: &mut Vec<Named>, degrees: f64) {
        let Some(best) = names.first().map(|n| n.fit.objective) else { return };
        let limit = BEHIND * best + 50.0 + 5.0 * degrees.sqrt();
        names.retain(|name| name.fit.objective < limit);
    }
}

/// Whether an objective, of parameters that more of the records led to, is worse than the one before by more than chance and small errors of
/// the model make.
pub(crate) fn contradicts(now: Option<f64>, before: f64) -> bool {
    now.is_none_or(|now| now > before * (1.0 + CONTRADICTION.1) + CONTRADICTION.0)
}

fn refit(names: &mut Vec<Named>, view: &View, iterations: usize) {
    let fitted = names.par_iter().filter_map(|name| {
        let fit = Fit::of(view, &name.fit.parameters, iterations)?;
        Some(Named { law: name.law.clone(), fit })
    });
    *names = fitted.collect();
    sort(names);
}

fn sort(names: &mut [Named]) {
    names.sort_by(|a, b| a.fit.objective.total_cmp(&b.fit.objective));
}
