//! From the refitted linear fixture to the law that explains what is left.

use super::candidates::{Seat, seats, starts};
use super::fit::Fit;
use super::misfit::{Focus, View};
use super::parameters::{Law, Parameters};
use super::records::Record;
use jointscope_fixture::Fixture;
use rayon::prelude::*;

/// What a search uses of the records.
pub(crate) struct Search<'a> {
    pub records: Vec<&'a Record>,
    pub band: (f64, f64),
    /// Period of the slowest elastic motion, s.
    period: f64,
    within: usize,
}

/// A name with its best fit, and how it fared.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub law: Law,
    pub fit: Fit,
}

/// Periods of the slowest motion over which a first look's weight falls by e, and a second's.
const FIRST_LOOK: f64 = 5.0;
const SECOND_LOOK: f64 = 30.0;
/// Hits of a level at a point that a first look takes.
const HITS: usize = 1;
/// Starts of each kind that are fitted.
const STARTS: usize = 3;
/// χ² per degree of freedom from which names are further from the best than any later look could bring them back.
const BEHIND: f64 = 1.5;
/// Names that are fitted to the end on the first look.
const CONTENDERS: usize = 4;
/// Names that are fitted to whole records.
const FINALISTS: usize = 3;

impl<'a> Search<'a> {
    pub fn new(records: Vec<&'a Record>, band: (f64, f64), elastic_hz: (f64, f64)) -> Self {
        let interval = records.iter().map(|r| r.hit.interval()).fold(0.0, f64::max);
        // Thirty steps in a period of the fastest elastic motion.
        let within = (30.0 * elastic_hz.1.min(band.1) * interval).ceil().clamp(2.0, 16.0) as usize;
        Search { records, band, period: 1.0 / elastic_hz.0, within }
    }

    /// Steps within a sampling interval.
    pub fn within(&self) -> usize {
        self.within
    }

    fn focus(&self, periods: Option<f64>) -> Focus {
        let decay = periods.map_or(0.0, |periods| 1.0 / (periods * self.period));
        Focus { decay, band: self.band, within: self.within, halvings: 3 }
    }

    /// All of every record.
    pub fn whole(&self) -> View<'a> {
        View::new(self.records.iter().copied(), &self.focus(None))
    }

    fn second_look(&self) -> View<'a> {
        View::new(self.records.iter().copied(), &self.focus(Some(SECOND_LOOK)))
    }

    /// The first moments of a few hits of every level.
    fn first_look(&self) -> View<'a> {
        let alike = |a: &Record, b: &Record| a.struck() == b.struck() && a.level == b.level;
        let few = self.records.iter().enumerate().filter(|(i, record)| {
            self.records[..*i].iter().filter(|earlier| alike(earlier, record)).count() < HITS
        });
        View::new(few.map(|(_, record)| *record), &self.focus(Some(FIRST_LOOK)))
    }

    /// The fixture without any law, refitted within its tolerances.
    pub fn refitted(&self, nominal: &Parameters) -> Option<Fit> {
        let first = Fit::of(&self.first_look(), nominal, 5)?;
        let second = Fit::of(&self.second_look(), &first.parameters, 5)?;
        let whole = self.whole();
        let fits = [nominal, &second.parameters].map(|start| Fit::of(&whole, start, 5));
        fits.into_iter().flatten().min_by(|a, b| a.objective.total_cmp(&b.objective))
    }

    /// Names for one more law beside those of `base`, the best first.
    pub fn names(&self, fixture: &Fixture, base: &Parameters) -> Vec<Named> {
        let records: Vec<&Record> = self.records.clone();
        let seats: Vec<Seat> = seats(fixture, &records, 2.0 * self.band.1);
        let first = self.first_look();
        let kinds: Vec<Vec<Law>> = seats.iter().flat_map(starts).filter(|laws| !laws.is_empty()).collect();
        let taken = |law: &Law| base.laws.iter().any(|other| other.is_named_as(law));
        let kinds: Vec<Vec<Law>> = kinds.into_iter().filter(|laws| !taken(&laws[0])).collect();
        let mut names: Vec<Named> = kinds
            .par_iter()
            .filter_map(|laws| {
                let mut tried: Vec<(f64, Parameters)> = laws
                    .iter()
                    .map(|law| base.with(law.clone()))
                    .filter_map(|parameters| first.chi2(&parameters).map(|chi2| (chi2, parameters)))
                    .collect();
                tried.sort_by(|a, b| a.0.total_cmp(&b.0));
                let fits = tried.iter().take(STARTS).filter_map(|(_, start)| Fit::of(&first, start, 2));
                let best = fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?;
                Some(Named { law: laws[0].clone(), fit: best })
            })
            .collect();
        sort(&mut names);
        names.truncate(CONTENDERS);
        refit(&mut names, &first, 3);
        self.narrowed(&mut names, first.degrees());
        refit(&mut names, &first, 9);
        self.narrowed(&mut names, first.degrees());
        let second = self.second_look();
        refit(&mut names, &second, 6);
        self.narrowed(&mut names, second.degrees());
        names.truncate(FINALISTS);
        refit(&mut names, &self.whole(), 8);
        names
    }

    /// Drops names that are hopelessly behind.
    fn narrowed(&self, names: &mut Vec<Named>, degrees: f64) {
        let Some(best) = names.first().map(|n| n.fit.objective) else { return };
        let limit = BEHIND * best + 50.0 + 5.0 * degrees.sqrt();
        names.retain(|name| name.fit.objective < limit);
    }
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
