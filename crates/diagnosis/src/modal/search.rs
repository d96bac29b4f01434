//! Which effects the recorded modes need: every candidate fitted to them, alone and beside others.

use crate::modal::extended::best_of_each;
use crate::modal::fit::{ANY, ModalFit, SetOut};
use crate::modal::searcher::{Named, STARTS, Searcher};
use crate::settings::modal::sizes::DISTURBED;

/// The outcome of a search among modes.
#[derive(Debug, Clone)]
pub(crate) struct ModalSearch {
    /// The fixture by itself.
    pub none: ModalFit,
    /// What the recording needs beyond it, nothing included.
    pub best: Named,
    /// Every candidate by itself, the most probable first.
    pub singles: Vec<Named>,
    /// Candidates that by themselves start too far below the best of these to be fitted.
    pub far: Vec<usize>,
    /// The best with one effect more, whether or not that is needed.
    pub more: Vec<Named>,
    /// What else may stand in the stead of each effect of the best, itself included, the most probable first.
    pub alternatives: Vec<Vec<Named>>,
    /// Where else along its body each effect of the best explains the modes, the most probable place first.
    pub elsewhere: Vec<Vec<Named>>,
    /// ln p of the best without each of its effects.
    pub without: Vec<f64>,
}

/// What may stand in the stead of one of several effects.
struct InStead {
    /// Other names and its own, the most probable first.
    names: Vec<Named>,
    /// Its own name at other places of its body.
    elsewhere: Vec<Named>,
    /// ln p without it.
    without: f64,
}

/// The most probable of several fits.
fn highest(fits: impl Iterator<Item = Named>) -> Option<Named> {
    fits.max_by(|a, b| a.fit.ln.total_cmp(&b.fit.ln))
}

impl ModalSearch {
    /// Whether each of several effects gains as much as `needed` in ln p over the others, as far as these
    /// were tried: one that does not may imitate an error of the model.
    pub(crate) fn needs_all_of(&self, named: &Named, needed: f64) -> bool {
        let part = |fewer: &&Named| {
            fewer.names.len() + 1 == named.names.len() && fewer.names.iter().all(|c| named.names.contains(c))
        };
        self.singles.iter().chain(&self.more).filter(part).all(|fewer| named.fit.ln - fewer.fit.ln >= needed)
    }
}

impl Searcher<'_> {
    /// The fixture by itself; `None` where it has no modes that could be compared.
    pub(super) fn fixture_alone(&self) -> Option<ModalFit> {
        self.watch.stage("fitting the fixture to the modes");
        self.problem.fitted_however_paired(self.nominal, &self.priors(self.nominal, &[]))
    }

    /// Searches for effects beside the fixture `alone`.
    pub(super) fn search(&self, alone: ModalFit) -> ModalSearch {
        if let Some(found) = self.found_again(&alone) {
            return found;
        }
        let start = self.alone(alone);
        self.watch.stage("comparing effects by modes");
        let (mut singles, mut far) = self.extended(&start, self.settings.refined.0, self.settings.starts.0);
        singles = self.exchanged(singles);
        let before = start.fit.ln;
        let start = self.at_its_best(start, &singles);
        // Where an effect led the fixture to a better place, the others set out from there as well.
        if start.fit.ln > before {
            singles = self.fitted_beside(std::slice::from_ref(&start), singles, usize::MAX);
        }
        singles = self.at_other_places(&start, singles);
        let none = start.fit.clone();
        // Where neither the fixture nor any effect explains the modes, the right one may have set out from
        // the wrong place.
        let little = self.problem.work.spent() < self.settings.again;
        if little && !self.is_adequate(&none) && !singles.iter().any(|single| self.explains(single, &start)) {
            let (again, _) = self.extended(&start, self.settings.tried, self.settings.starts.1);
            singles = best_of_each(singles.into_iter().chain(again).collect());
            far.retain(|c| singles.iter().all(|single| single.names.last() != Some(c)));
        }
        let (best, more) = self.with_effects_added(&start, &singles);
        let (best, instead) = self.with_effects_exchanged(best, &singles, &none);
        let without = instead.iter().map(|effect| effect.without).collect();
        let (alternatives, elsewhere) = instead.into_iter().map(|i| (i.names, i.elsewhere)).unzip();
        ModalSearch { none, best, singles, far, more, alternatives, elsewhere, without }
    }

    /// The best hypothesis, effects added to `start`, the fixture by itself, one after another while each
    /// gains what it has to; and what was tried of several effects together.
    fn with_effects_added(&self, start: &Named, singles: &[Named]) -> (Named, Vec<Named>) {
        let none = &start.fit;
        let mut best = start.clone();
        let mut more = Vec::new();
        for count in 1..=self.settings.effects {
            // What the fixture itself explains, and no effect alone improves, needs no pair.
            if count > 1 && best.names.is_empty() && self.is_adequate(none) {
                break;
            }
            // What explains modes and lines needs no company that modes could tell.
            if count > 1 && !best.names.is_empty() && (self.suffices)(&best) {
                break;
            }
            if count > 1 {
                if !self.problem.work.allows("several effects together, by modes") {
                    break;
                }
                self.watch.stage("comparing several effects together by modes");
            }
            let ranked = self.with_one_more(count, (&best, start), singles);
            let Some(first) = ranked.iter().take(self.settings.tried).find(|named| self.is_told(named, none))
            else {
                break;
            };
            if count > 1 {
                more.extend(ranked.iter().take(self.settings.tried).cloned());
            }
            let fewer = if count > 1 { self.with_fewer_led_out(first, &best, none) } else { None };
            let led_out = fewer.is_some();
            best = fewer.unwrap_or(best);
            if self.gains(first, &best) {
                best = first.clone();
            } else if count > 1 && !led_out {
                break;
            }
        }
        (best, more)
    }

    /// What a hypothesis `first` of several effects together comes to without one of them, where that gains
    /// over the `best` so far: a pair may be needed where neither effect alone is, or one of them where the
    /// other has led it out of a false minimum.
    fn with_fewer_led_out(&self, first: &Named, best: &Named, none: &ModalFit) -> Option<Named> {
        if !self.gains(first, best) {
            return None;
        }
        let statements = self.statements(&first.names);
        let parts = statements.iter().filter_map(|statement| self.without(first, statement, best.fit.ln));
        let is_better = |fewer: &Named| {
            fewer.fit.ln > best.fit.ln && self.gains(fewer, best) && self.is_told(fewer, none)
        };
        highest(parts).filter(is_better)
    }

    /// The best hypothesis, effects exchanged for what explains more in the stead of one of them, and what
    /// may stand instead of each.
    fn with_effects_exchanged(
        &self,
        mut best: Named,
        singles: &[Named],
        none: &ModalFit,
    ) -> (Named, Vec<InStead>) {
        self.watch.stage("asking by modes what else would explain a finding");
        let mut instead = self.in_stead_of_each(&best, singles, none);
        // What explains more in the stead of one effect, beside the others, is what was searched for.
        for _ in 0..self.settings.exchanges {
            let stated = self.statements(&best.names).len();
            let higher =
                |other: &Named| self.statements(&other.names).len() == stated && other.fit.ln > best.fit.ln;
            let others = instead.iter().flat_map(|effect| effect.names.iter().chain(&effect.elsewhere));
            let Some(other) = highest(others.filter(|other| higher(other)).cloned()) else { break };
            best = other;
            instead = self.in_stead_of_each(&best, singles, none);
        }
        (best, instead)
    }

    /// Whether a hypothesis explains what `none`, the fixture by itself, does not, by as much as its names
    /// have to.
    fn explains(&self, named: &Named, none: &Named) -> bool {
        self.gains(named, none) && self.is_adequate(&named.fit) && self.is_told(named, &none.fit)
    }

    /// Whether a hypothesis gains what it has to over one that states less.
    fn gains(&self, more: &Named, fewer: &Named) -> bool {
        more.fit.ln - fewer.fit.ln > self.needed_over(fewer, more) && !self.disturbs_gains(more, fewer)
    }

    /// Whether a hypothesis takes gains of records farther off than any are that fewer effects leave where they
    /// belong: these may be of any size, and with residues free what suits mass lines and upper residuals
    /// alone gains by it, a hammer that became 5.7 times as sensitive for instance.
    fn disturbs_gains(&self, more: &Named, fewer: &Named) -> bool {
        let [with, without] = [more, fewer].map(|named| named.fit.evidence.sizes.gain);
        more.fit.has_gains_beyond(self.problem.sizes) && with > DISTURBED * without
    }

    /// The best with one effect more, or with a kind more at every joint, the most probable first. Where two
    /// effects are tried together neither need explain anything alone: then the best singles are extended,
    /// and not the best alone.
    fn with_one_more(&self, count: usize, (best, none): (&Named, &Named), singles: &[Named]) -> Vec<Named> {
        // Where the fixture does, or one effect beside it, no joint is asked.
        let suffices = best.names.is_empty()
            && (self.is_adequate(&best.fit) || singles.iter().any(|single| self.explains(single, none)));
        let mut ranked = if suffices { Vec::new() } else { self.at_every_joint(best) };
        // What explains what the best does not is compared with single names when these are tried in its
        // stead.
        let explains = |first: &Named| !self.is_adequate(&best.fit) && self.explains(first, none);
        if ranked.first().is_some_and(explains) {
            return ranked;
        }
        let beside_best = || self.extended(best, self.settings.refined.1, 1).0;
        ranked.extend(match (count, best.names.len()) {
            (1, _) => singles.to_vec(),
            (2, 0 | 1) => self.pairs(singles),
            // What is the same at every joint may imitate two effects of which each is at one: it takes no
            // more than one name.
            (2, _) if self.statements(&best.names).len() == 1 && !self.is_adequate(&best.fit) => {
                [self.pairs(singles), beside_best()].concat()
            }
            _ => beside_best(),
        });
        ranked.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        ranked
    }

    /// The fixture by itself from where the best effects left its quantities too.
    fn at_its_best(&self, none: Named, singles: &[Named]) -> Named {
        let alone = singles
            .iter()
            .take(self.settings.bases.0)
            .filter_map(|single| self.without(single, &[0], none.fit.ln));
        highest(alone).filter(|alone| alone.fit.ln > none.fit.ln).unwrap_or(none)
    }

    /// The best singles each with one effect more; all but the best, and these two by two, only where that
    /// leaves an error of the model.
    fn pairs(&self, singles: &[Named]) -> Vec<Named> {
        let Some(first) = singles.first() else { return Vec::new() };
        let close = |s: &&Named| first.fit.ln - s.fit.ln < self.settings.bases.1;
        let count = if first.exact { 1 } else { self.settings.bases.0 };
        let mut all: Vec<Named> = singles
            .iter()
            .take(count)
            .filter(close)
            .flat_map(|s| self.extended(s, self.settings.refined.1, 1).0)
            .collect();
        if !first.exact {
            all.extend(self.two_by_two(singles));
        }
        all.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        all
    }

    /// The best singles two by two, from where each stands by itself. What imitates two effects is more
    /// probable than either of them, and by more than what is extended otherwise may lie below it: a relaxing
    /// joint is stiffer and damped like one that is stiffer beside a window over the records.
    fn two_by_two(&self, singles: &[Named]) -> Vec<Named> {
        let few = &singles[..singles.len().min(self.settings.two_by_two)];
        let beside = |(at, one)| few[at + 1..].iter().map(move |other: &Named| (one, other));
        let both: Vec<(&Named, &Named)> = few.iter().enumerate().flat_map(beside).collect();
        let least = few.first().map_or(ANY, |first| first.fit.ln);
        self.problem.work.each(both, STARTS, |(one, other): (&Named, &Named)| {
            let start = one.fit.hypothesis.with(other.fit.hypothesis.effects().pop()?);
            self.fitted_with(one, &other.names, &start, (SetOut::Both, least))
        })
    }

    /// What may stand in the stead of each effect of `best`, in the company of its others.
    fn in_stead_of_each(&self, best: &Named, singles: &[Named], none: &ModalFit) -> Vec<InStead> {
        let mut each: Vec<(usize, InStead)> = self
            .statements(&best.names)
            .iter()
            .flat_map(|statement| self.in_stead_of(best, statement, singles, none))
            .collect();
        each.sort_by_key(|(index, _)| *index);
        each.into_iter().map(|(_, in_stead)| in_stead).collect()
    }

    /// The same for each effect of one statement, by its place.
    fn in_stead_of(
        &self,
        best: &Named,
        statement: &[usize],
        singles: &[Named],
        none: &ModalFit,
    ) -> Vec<(usize, InStead)> {
        let extended = |base: &Named| self.extended(base, self.settings.refined.1, 1).0;
        let (base, mut others) = if best.names.len() == statement.len() {
            (Some(self.alone(none.clone())), singles.to_vec())
        } else {
            let base = self.without(best, statement, ANY);
            let others = base.as_ref().map_or_else(Vec::new, extended);
            (base, others)
        };
        if let (Some(base), true) = (&base, statement.len() > 1) {
            others.extend(self.at_every_joint(base));
        }
        let is_own = |c: &usize| statement.iter().any(|&index| best.names[index] == *c);
        others.retain(|other| {
            let close = best.fit.ln - other.fit.ln < self.settings.listed;
            close && !other.names.last().is_some_and(is_own) && self.is_told(other, none)
        });
        let without = base.as_ref().map_or(f64::NEG_INFINITY, |base| base.fit.ln);
        let of_effect = |&index: &usize| {
            let own = Named { names: vec![best.names[index]], fit: best.fit.clone(), exact: best.exact };
            let mut names: Vec<Named> = others.iter().cloned().chain([own]).collect();
            names.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
            let places = |base: &Named| self.elsewhere(base, best, index, none);
            let elsewhere = base.as_ref().filter(|_| statement.len() == 1).map_or_else(Vec::new, places);
            (index, InStead { names, elsewhere, without })
        };
        statement.iter().map(of_effect).collect()
    }
}
