//! Quantities that are wrong beyond their stated deviations, as what a recording asks for.
//!
//! A quantity far from what is stated is a misfit that effects can imitate: a centre of gravity 2.5 mm off its place looks like one mass too many and
//! another one missing. So the fixture with the quantities that had to depart most set free competes with the effects found: each pays for itself
//! as an effect does.

use crate::departures::{departed, has_departed};
use crate::evidence::deviates_by_chance;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::explains;
use crate::penalty::{parameter_penalty, penalty};
use crate::search::Search;
use rayon::prelude::*;

/// The refitted fixture with quantities set free.
#[derive(Debug, Clone)]
pub(crate) struct Freed {
    /// What it leaves.
    pub fit: Fit,
    /// How many are free.
    count: usize,
}

impl Freed {
    /// The fewest quantities that, set free, explain the lines down to their noise; `None` where few do not.
    pub fn of(fitter: &Fitter, within: &Search) -> Option<Self> {
        let settings = &fitter.settings.selection;
        let price = Freed::price(fitter, within);
        let mut best = within.refitted.clone();
        let mut free: Vec<usize> = Vec::new();
        while free.len() < settings.freed.0 {
            let hypothesis = &best.hypothesis;
            let bent = |m: &usize| !free.contains(m) && departed(hypothesis, *m);
            let mut farthest: Vec<usize> = (0..hypothesis.tolerances().len()).filter(bent).collect();
            let distance = |m: usize| hypothesis.departure(m).abs();
            farthest.sort_by(|a, b| distance(*b).total_cmp(&distance(*a)));
            farthest.truncate(settings.freed.1);
            let with = |m: &usize| {
                let freed: Vec<usize> = free.iter().copied().chain([*m]).collect();
                let near = fitter.local(&hypothesis.freeing(&freed), None, f64::INFINITY);
                let far = fitter.global(&within.nominal.hypothesis.freeing(&freed));
                let fits = [near, far].into_iter().flatten();
                Some((*m, fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?))
            };
            let fits: Vec<(usize, Fit)> = farthest.par_iter().filter_map(with).collect();
            let (next, fit) =
                fits.into_iter().min_by(|(_, a), (_, b)| a.objective.total_cmp(&b.objective))?;
            if best.objective - fit.objective <= price * fit.inflation(fitter.observation) {
                return None;
            }
            free.push(next);
            best = fit;
            if explains(fitter, &best, false) {
                return Some(Freed { fit: best, count: free.len() });
            }
        }
        None
    }

    /// What a free quantity has to gain: as much as an effect with one parameter.
    fn price(fitter: &Fitter, within: &Search) -> f64 {
        let settings = &fitter.settings.selection;
        penalty(settings, settings.parameter_penalty, within.candidates.len())
    }

    /// Whether it serves better than the effects found, if there are any: where it is about as good, an effect goes before a slip, unless it leaves
    /// quantities far from what is stated.
    pub fn serves_better(&self, fitter: &Fitter, search: &Search) -> bool {
        let settings = &fitter.settings.selection;
        let effects = search.repaired.hypothesis.effect_count() as f64;
        let each = penalty(settings, 0.0, search.candidates.len());
        let theirs = search.repaired.objective
            + parameter_penalty(settings, &search.repaired.hypothesis)
            + effects * each;
        let own = self.fit.objective + self.count as f64 * Freed::price(fitter, search);
        let bent = !deviates_by_chance(fitter, &search.repaired.hypothesis)
            || has_departed(&search.repaired.hypothesis);
        let slip = if bent { 0.0 } else { settings.slip };
        effects == 0.0 || own + slip < theirs
    }
}
