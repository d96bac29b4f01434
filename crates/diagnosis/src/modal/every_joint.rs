//! What a model leaves out of every joint alike.
//!
//! Whoever takes one strip for massless takes all of them so. To him that is one omission; to a search by
//! single names it is one for each joint, none of which explains the recording without the others. Here a
//! kind at every joint is tried at once, as one statement among all. How large it is at each joint is fitted,
//! told and stated joint by joint.

use crate::candidate::Candidate;
use crate::modal::fit::SetOut;
use crate::modal::searcher::{Named, STARTS, Searcher};
use jointscope_fixture::{Effect, Place};
use std::collections::BTreeSet;

impl Searcher<'_> {
    /// The candidates of each kind that a model leaves out of every joint, one for each joint, where several
    /// joints may lack it.
    fn of_every_joint(&self) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = Vec::new();
        for (index, candidate) in self.candidates.iter().enumerate() {
            let is_of_joint = matches!(candidate.place, Place::Joint(_));
            if !(is_of_joint && candidate.kind.spec().of_every_joint) {
                continue;
            }
            let alike = |other: &Candidate| other.kind == candidate.kind && other.dof == candidate.dof;
            match all.iter_mut().find(|names| alike(&self.candidates[names[0]])) {
                Some(names) => names.push(index),
                None => all.push(vec![index]),
            }
        }
        all.retain(|names| names.len() > 1);
        all
    }

    /// What effects of these names state, by their places in the list: a kind at every joint is one
    /// statement, every other effect is one by itself.
    pub(super) fn statements(&self, names: &[usize]) -> Vec<Vec<usize>> {
        let whole = self.of_every_joint().into_iter().filter(|all| all.iter().all(|c| names.contains(c)));
        let places = |all: Vec<usize>| (0..names.len()).filter(|&at| all.contains(&names[at])).collect();
        let mut statements: Vec<Vec<usize>> = whole.map(places).collect();
        let alone: Vec<usize> = (0..names.len())
            .filter(|at| statements.iter().all(|statement| !statement.contains(at)))
            .collect();
        statements.extend(alone.into_iter().map(|at| vec![at]));
        statements.sort();
        statements
    }

    /// Fits of `base` with one kind of effect more, at every joint that may lack it and does not have it yet:
    /// the best of each kind, the most probable first.
    pub(super) fn at_every_joint(&self, base: &Named) -> Vec<Named> {
        let mut groups = self.of_every_joint();
        groups.iter_mut().for_each(|names| names.retain(|c| !base.names.contains(c)));
        // Ratios that are free as well would follow their own errors beside another effect: how all joints
        // dissipate is asked where it may be all that is left out.
        let frees_ratios = |names: &[usize]| self.candidates[names[0]].kind.spec().within_modal_ratios;
        groups.retain(|names| names.len() > 1 && (base.names.is_empty() || !frees_ratios(names)));
        if groups.is_empty() || !self.problem.work.allows("what every joint may lack, by modes") {
            return Vec::new();
        }
        self.watch.stage("comparing by modes what every joint may lack");
        let bases = self.bases(base);
        let starts: Vec<(usize, Vec<Effect>)> = groups
            .iter()
            .flat_map(|names| self.starts_at_all(names).into_iter().map(|effects| (names[0], effects)))
            .collect();
        let starts = starts.iter().flat_map(|start| bases.iter().map(move |base| (start, *base))).collect();
        let scored = self.problem.work.each(starts, STARTS, |((first, effects), from)| {
            let hypothesis = effects.iter().fold(from.clone(), |rest, effect| rest.with(effect.clone()));
            self.scored(*first, hypothesis, &base.fit)
        });
        let mut chosen = self.rescored(scored);
        let mut seen = BTreeSet::new();
        chosen.retain(|start| seen.insert(start.candidate));
        let least = self.least_beside(base);
        let mut fits = self.problem.work.each(chosen, STARTS, |start| {
            let names = groups.iter().find(|names| names[0] == start.candidate)?;
            self.fitted_with(base, names, &start.hypothesis, (SetOut::Both, least))
        });
        fits.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        fits
    }

    /// Effects of all these names to set out from: at each joint the same multiple of what it has, or as they
    /// are known.
    fn starts_at_all(&self, names: &[usize]) -> Vec<Vec<Effect>> {
        let candidates: Vec<&Candidate> = names.iter().map(|&c| &self.candidates[c]).collect();
        if let Some(known) = self.known {
            let own = |candidate: &&Candidate| known.of(candidate).cloned();
            return candidates.iter().map(own).collect::<Option<Vec<Effect>>>().into_iter().collect();
        }
        let count = candidates.iter().map(|candidate| candidate.starts.len()).min().unwrap_or(0);
        (0..count).map(|start| candidates.iter().map(|candidate| candidate.effect(start)).collect()).collect()
    }
}
