//! Where else along its body an effect that was found explains the modes.
//!
//! A mass near a node of one mode and one near a node of another may do the same to all natural frequencies
//! there are, and on a beam that is held alike at both ends two places mirror each other. A fit comes to rest
//! at one of them, and an interval about that says nothing of the others.

use crate::along_body::{Abscissae, place_of_last};
use crate::modal::fit::{ModalFit, SetOut};
use crate::modal::searcher::{Named, STARTS, Searcher};
use crate::modal::starts::Start;

impl Searcher<'_> {
    /// Singles with other places of those that are the most probable, where the recording needs any: one
    /// whose size is told from nothing is to be had at a place that is a little less probable than the first.
    pub(super) fn at_other_places(&self, none: &Named, singles: Vec<Named>) -> Vec<Named> {
        let Some(first) = singles.first() else { return singles };
        if first.fit.ln - none.fit.ln < self.needed_over(none, first) {
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

    /// Effect `index` of `best` at other places of its body, where these explain the modes nearly as well or
    /// better in the company of the others: the most probable of each place first. `base` is the same without
    /// it.
    pub(super) fn elsewhere(&self, base: &Named, best: &Named, index: usize, none: &ModalFit) -> Vec<Named> {
        let own = best.names[index];
        let effect = &best.fit.hypothesis.effects()[index];
        let along = Abscissae::of(&self.candidates[own], effect).filter(|_| self.known.is_none());
        let Some(along) = along else { return Vec::new() };
        let here = effect.value(along.at);
        let starts = self.starts_of(base, |c| c == own);
        let densest = |place: f64| {
            let at_place = |start: &&Start| place_of_last(&start.hypothesis) == Some(place);
            starts.iter().find(at_place).cloned()
        };
        let others = along.places.iter().copied().filter(|place| along.are_apart(*place, here));
        let near = |start: &Start| best.fit.ln - start.density < self.settings.foremost.1;
        let chosen: Vec<Start> = others.filter_map(densest).filter(near).collect();
        let least = best.fit.ln - self.settings.listed;
        let fit = |start: Start| self.fitted_from(base, start, SetOut::Usual, least);
        let mut fits = self.problem.work.each(chosen, STARTS, fit);
        fits.retain(|named| named.fit.ln > least && self.is_told(named, none));
        fits.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        along.each_once(here, fits, |named| place_of_last(&named.fit.hypothesis))
    }
}
