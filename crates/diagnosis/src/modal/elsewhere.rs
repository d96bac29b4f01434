//! Where else along its body an effect that was found explains the modes.
//!
//! A mass near a node of one mode and one near a node of another may do the same to all natural frequencies there are, and on a beam that is held alike at both ends two
//! places mirror each other. A fit comes to rest at one of them, and an interval about that says nothing of the others.

use crate::modal::fit::{ModalFit, SetOut};
use crate::modal::searcher::{Named, STARTS, Searcher};
use crate::modal::starts::Start;
use jointscope_fixture::{Effect, Motion};

/// Index of the parameter that says where along its body an effect sits, if it has one.
pub(super) fn abscissa(effect: &Effect) -> Option<usize> {
    effect.kind.spec().parameters.iter().position(|parameter| parameter.motion == Motion::AlongBody)
}

/// Where the last effect of a start or fit sits.
fn place_of_last(effects: &[Effect]) -> Option<f64> {
    let effect = effects.last()?;
    Some(effect.value(abscissa(effect)?))
}

impl Searcher<'_> {
    /// Singles with other places of those that are the most probable, where the recording needs any: one whose size is told from nothing is to be had at a place that is a little less
    /// probable than the first.
    pub(super) fn at_other_places(&self, none: &Named, singles: Vec<Named>) -> Vec<Named> {
        let Some(first) = singles.first() else { return singles };
        if first.fit.ln - none.fit.ln < self.needed_beyond(none, first) {
            return singles;
        }
        let least = first.fit.ln - self.settings.listed;
        let close = singles.iter().take_while(|single| single.fit.ln > least);
        let others: Vec<Named> =
            close.flat_map(|single| self.elsewhere(none, single, 0, &none.fit)).collect();
        let mut all = singles;
        all.extend(others);
        all.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        all
    }

    /// Effect `index` of `best` at other places of its body, where these explain the modes nearly as well or better in the company of the others: the most probable of each place first. `base` is
    /// the same without it.
    pub(super) fn elsewhere(&self, base: &Named, best: &Named, index: usize, none: &ModalFit) -> Vec<Named> {
        let own = best.names[index];
        let effect = &best.fit.hypothesis.effects()[index];
        let Some(at) = abscissa(effect).filter(|at| effect.has_parameter(*at) && self.known.is_none()) else {
            return Vec::new();
        };
        let mut places: Vec<f64> = self.candidates[own].starts.iter().map(|start| start[at]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        // What comes to rest nearer than halfway to the next place is at the same one.
        let apart = places.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).fold(f64::INFINITY, f64::min);
        let is_apart = |a: f64, b: f64| (a - b).abs() >= apart;
        let starts = self.starts_of(base, |c| c == own);
        let densest = |place: f64| {
            let at_place = |start: &&Start| place_of_last(&start.hypothesis.effects()) == Some(place);
            starts.iter().find(at_place).cloned()
        };
        let others = places.into_iter().filter(|place| is_apart(*place, effect.value(at)));
        let near = |start: &Start| best.fit.ln - start.density < self.settings.foremost.1;
        let chosen: Vec<Start> = others.filter_map(densest).filter(near).collect();
        let least = best.fit.ln - self.settings.listed;
        let fit = |start: Start| self.fitted_from(base, start, SetOut::Usual, least);
        let mut fits = self.problem.work.each(chosen, STARTS, fit);
        fits.retain(|named| named.fit.ln > least && self.is_told(named, none));
        fits.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        let mut taken = vec![effect.value(at)];
        fits.retain(|named| {
            let place = place_of_last(&named.fit.hypothesis.effects());
            let Some(place) = place.filter(|place| taken.iter().all(|other| is_apart(*place, *other))) else {
                return false;
            };
            taken.push(place);
            true
        });
        fits
    }
}
