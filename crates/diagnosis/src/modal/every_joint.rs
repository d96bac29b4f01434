//! What a model leaves out at several places alike: of every joint, or under two bodies.
//!
//! Whoever takes one strip for massless takes all of them so. To him that is one omission; to a search by
//! single names it is one for each joint, none of which explains the recording without the others. Here a
//! kind at every joint is tried at once, as one statement among all. How large it is at each joint is fitted,
//! told and stated joint by joint.
//!
//! A structure that lies on two pieces of foam has two supports that a free fixture does not know, and one of
//! them alone leaves it a motion without any frequency: neither explains anything without the other. They are
//! one statement too, as long as the fixture itself holds the structure nowhere.

use crate::candidate::Candidate;
use crate::modal::fit::SetOut;
use crate::modal::searcher::{Named, STARTS, Searcher};
use crate::settings::modal::suspensions::MOST_BODIES;
use jointscope_fixture::{Dof, Effect, EffectKind, Place};
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

    /// The candidates of a suspension that a fixture without any does not know: a support under each of two
    /// bodies.
    fn of_suspensions(&self) -> Vec<Vec<usize>> {
        let fixture = self.nominal.fixture();
        let holds = |effect: &Effect| effect.kind == EffectKind::Support;
        if !fixture.supports().is_empty() || fixture.physics().iter().any(holds) {
            return Vec::new();
        }
        let is_support = |candidate: &Candidate| {
            let holds = candidate.kind == EffectKind::Support && candidate.dof != Some(Dof::Rotation);
            holds && matches!(candidate.place, Place::Body(_))
        };
        let all: Vec<usize> =
            (0..self.candidates.len()).filter(|&c| is_support(&self.candidates[c])).collect();
        let others = |(at, one): (usize, &usize)| {
            let one = *one;
            all[at + 1..].iter().map(move |other| vec![one, *other]).collect::<Vec<_>>()
        };
        match all.len() {
            0..=MOST_BODIES => all.iter().enumerate().flat_map(others).collect(),
            count => vec![vec![all[0], all[count - 1]]],
        }
    }

    /// What is one statement though it is several effects.
    fn of_several(&self) -> Vec<Vec<usize>> {
        [self.of_every_joint(), self.of_suspensions()].concat()
    }

    /// What effects of these names state, by their places in the list: a kind at every joint is one
    /// statement, so is a suspension, every other effect is one by itself.
    pub(super) fn statements(&self, names: &[usize]) -> Vec<Vec<usize>> {
        let whole = self.of_several().into_iter().filter(|all| all.iter().all(|c| names.contains(c)));
        let places = |all: Vec<usize>| (0..names.len()).filter(|&at| all.contains(&names[at])).collect();
        let mut statements: Vec<Vec<usize>> = whole.map(places).collect();
        let alone: Vec<usize> = (0..names.len())
            .filter(|at| statements.iter().all(|statement| !statement.contains(at)))
            .collect();
        statements.extend(alone.into_iter().map(|at| vec![at]));
        statements.sort();
        statements
    }

    /// Fits of `base` with one kind of effect more, at every joint that may lack it and does not have it yet,
    /// or under two bodies: the best of each statement, the most probable first.
    pub(super) fn at_every_joint(&self, base: &Named) -> Vec<Named> {
        let mut groups = self.of_several();
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
            .enumerate()
            .flat_map(|(at, names)| self.starts_at_all(names).into_iter().map(move |effects| (at, effects)))
            .collect();
        let starts = starts.iter().flat_map(|start| bases.iter().map(move |base| (start, *base))).collect();
        // Starts are told apart by the places of their statements.
        let scored = self.problem.work.each(starts, STARTS, |((at, effects), from)| {
            let hypothesis = effects.iter().fold(from.clone(), |rest, effect| rest.with(effect.clone()));
            self.scored(*at, hypothesis, &base.fit)
        });
        let mut chosen = self.rescored(scored);
        let mut seen = BTreeSet::new();
        chosen.retain(|start| seen.insert(start.candidate));
        let least = self.least_beside(base);
        let mut fits = self.problem.work.each(chosen, STARTS, |start| {
            self.fitted_with(base, &groups[start.candidate], &start.hypothesis, (SetOut::Both, least))
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
