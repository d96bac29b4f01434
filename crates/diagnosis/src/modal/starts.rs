//! Where fits by modes set out: every candidate's starts, with the density of the recorded features there.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::catalogue::has_a_name;
use crate::modal::evidence::linear;
use crate::modal::fit::ModalFit;
use crate::modal::known::Known;
use crate::modal::prior::Prior;
use crate::modal::problem::PairedModes;
use crate::modal::searcher::{Named, STARTS, Searcher};
use jointscope_fixture::{Effect, EffectKind, Place, QuantityKey, QuantityOwner, Starts};
use jointscope_model_error::Linear;
use std::f64::consts::TAU;

/// A hypothesis with one effect more than its base, where that effect sets out.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub candidate: usize,
    pub hypothesis: Hypothesis,
    /// ln of the density of the recorded features.
    pub density: f64,
    /// Whether it compares other modes than its base, of which the base's derivatives say nothing.
    apart: bool,
    /// Whether it has partners for more of the recorded modes than its base.
    partners: bool,
}

impl Start {
    /// One whose density nobody asks for.
    fn of(candidate: usize, hypothesis: Hypothesis) -> Self {
        Start { candidate, hypothesis, density: 0.0, apart: false, partners: false }
    }
}

/// Where among the parameters of a kind the frequency is at which it resonates by itself, if it does.
pub(super) fn own_frequency(kind: EffectKind) -> Option<usize> {
    kind.spec().parameters.iter().position(|parameter| matches!(parameter.starts, Starts::OverBand { .. }))
}

/// The starts of something that resonates by itself, at these frequencies (Hz).
fn resonating_at(candidate: &Candidate, hz: &[f64]) -> Vec<Effect> {
    let Some(frequency) = own_frequency(candidate.kind) else { return Vec::new() };
    let first = candidate.starts.first().map(|start| start[frequency]);
    // Every abscissa, mass and damping ratio once.
    let others = candidate.starts.iter().filter(|start| Some(start[frequency]) == first);
    let at = |start: &Vec<f64>, hz: f64| {
        let mut start = start.clone();
        start[frequency] = hz;
        Effect::new(candidate.kind, candidate.place.clone(), candidate.dof, &start)
    };
    others.flat_map(|start| hz.iter().map(move |hz| at(start, *hz))).collect()
}

/// The same model, stiff as it is by a change of stiffness and not by departures of what it consists of;
/// `None` where these do not depart. From farther off no linear model tells how well the change makes up for
/// them.
pub(super) fn relieved(base: &Hypothesis, candidate: &Candidate) -> Option<Hypothesis> {
    let fixture = base.fixture();
    let owner = match &candidate.place {
        _ if candidate.kind != EffectKind::StiffnessChange => return None,
        Place::Joint(name) => {
            QuantityOwner::Joint(fixture.joints().iter().position(|joint| joint.name == *name)?)
        }
        Place::Body(name) => {
            QuantityOwner::Body(fixture.bodies().iter().position(|body| body.name == *name)?)
        }
        _ => return None,
    };
    let tolerances = base.tolerances().iter().enumerate();
    let departed: Vec<usize> = tolerances
        .filter(|(index, tolerance)| {
            let (quantity, departure) = (&tolerance.quantity, base.departure(*index));
            let is_stiffness = matches!(
                quantity.key,
                QuantityKey::YoungsModulus | QuantityKey::SecondMoment | QuantityKey::JointStiffness(..)
            );
            let is_factor = quantity.value != 0.0 && is_stiffness && has_a_name(fixture, quantity, departure);
            quantity.owner == owner && is_factor && departure != 0.0
        })
        .map(|(index, _)| index)
        .collect();
    if departed.is_empty() {
        return None;
    }
    let ratio = |&index: &usize| {
        let tolerance = &base.tolerances()[index];
        tolerance.value(base.departure(index)) / tolerance.value(0.0)
    };
    let factor = departed.iter().map(ratio).product();
    let mut relieved = base.clone();
    departed.iter().for_each(|&index| relieved.coordinates[index] = 0.0);
    Some(relieved.with(Effect::new(candidate.kind, candidate.place.clone(), candidate.dof, &[factor])))
}

fn by_density(all: &mut [Start]) {
    all.sort_by(|a, b| b.density.total_cmp(&a.density));
}

impl Searcher<'_> {
    /// Starts with one effect more than `base`, the densest first. Those that compare other modes than their
    /// base are compared with the others by their own derivatives, the best of all and the best of each
    /// candidate, those with a partner more and the others by themselves; the rest are left out.
    pub(super) fn starts(&self, base: &Named) -> Vec<Start> {
        // What resonates makes a mode more: where every mode has its partner, nothing of the kind is there.
        let partners = base.fit.paired.pairing.alone() == 0.0;
        let idle = |c: usize| partners && self.candidates[c].kind == EffectKind::AttachedResonator;
        self.starts_of(base, |c| !base.names.contains(&c) && !idle(c))
    }

    /// The same of these candidates alone.
    pub(super) fn starts_of(&self, base: &Named, among: impl Fn(usize) -> bool) -> Vec<Start> {
        let bases = self.bases(base);
        let unmatched = self.unmatched(&base.fit);
        let count = bases.len();
        let starts: Vec<(usize, Effect, usize)> = (0..self.candidates.len())
            .filter(|&c| among(c))
            .flat_map(|c| {
                let candidate = &self.candidates[c];
                let own = (0..candidate.starts.len()).map(|start| candidate.effect(start));
                let all = own.chain(resonating_at(candidate, &unmatched));
                all.flat_map(move |effect| (0..count).map(move |b| (c, effect.clone(), b)))
            })
            .collect();
        let tried = self.watch.count(starts.len());
        let mut scored = self.problem.work.each(starts, STARTS, |(c, effect, b)| {
            tried.trying(&self.candidates[c]);
            self.scored(c, bases[b].with(effect), &base.fit)
        });
        let relieved = (0..self.candidates.len()).filter(|&c| among(c)).filter_map(|c| {
            let hypothesis = relieved(&base.fit.hypothesis, &self.candidates[c])?;
            self.scored(c, hypothesis, &base.fit)
        });
        scored.extend(relieved);
        self.rescored(scored)
    }

    /// Starts that are worth a fit: so many of `each` of the `refined` best candidates, the densest first. A
    /// mode that the base does not have is the plainest sign of what is left out, however poorly what would
    /// make it starts: the best of those that have it come before all others.
    pub(super) fn chosen(&self, starts: Vec<Start>, refined: usize, each: usize) -> Vec<Start> {
        let (mut partners, others): (Vec<Start>, Vec<Start>) =
            starts.into_iter().partition(|start| start.partners);
        let rest = partners.split_off(self.settings.partnering.min(partners.len()));
        let mut taken = vec![0; self.candidates.len()];
        let mut kinds = 0;
        let wanted = |start: &Start| {
            let own = &mut taken[start.candidate];
            if *own >= each || *own == 0 && kinds >= refined {
                return false;
            }
            kinds += usize::from(*own == 0);
            *own += 1;
            true
        };
        let mut all: Vec<Start> = others.into_iter().chain(rest).collect();
        by_density(&mut all);
        partners.extend(all.into_iter().filter(wanted));
        partners
    }

    /// Frequencies (Hz) at which the recording has a mode that a fit has not, and halfway from there to the
    /// next one that it has: what resonates beside a mode parts the two.
    fn unmatched(&self, fit: &ModalFit) -> Vec<f64> {
        let PairedModes { modelled, pairing, .. } = &fit.paired;
        let recorded = &self.problem.recorded.modes;
        let alone = (0..recorded.len()).filter(|&r| pairing.pairs.iter().all(|(other, _)| *other != r));
        let both = |r: usize| {
            let own = recorded[r].pole.omega;
            let next = modelled.modes.iter().map(|mode| mode.pole.omega);
            let next = next.min_by(|a, b| (a / own).ln().abs().total_cmp(&(b / own).ln().abs()));
            [own, next.map_or(own, |next| (own * next).sqrt())]
        };
        alone.flat_map(both).map(|omega| omega / TAU).collect()
    }

    /// Starts at effects that are known, of names that `base` does not have.
    pub(super) fn starts_at(&self, base: &Named, known: &Known) -> Vec<Start> {
        let start = |effect: &Effect| {
            let c = self.name_of(effect)?;
            (!base.names.contains(&c)).then(|| Start::of(c, base.fit.hypothesis.with(effect.clone())))
        };
        known.all().filter_map(start).collect()
    }

    /// Starts the densest first, those that compare other modes than their base by derivatives of their own
    /// as far as they are worth it.
    pub(super) fn rescored(&self, scored: Vec<Start>) -> Vec<Start> {
        let (mut apart, mut alike): (Vec<Start>, Vec<Start>) =
            scored.into_iter().partition(|start| start.apart);
        by_density(&mut apart);
        // Those with a partner more and the others by themselves: of a spring to ground a start that makes no
        // mode more says nothing of one that does.
        let mut seen = vec![[false; 2]; self.candidates.len()];
        let mut ranks = [0; 2];
        apart.retain(|start| {
            let class = usize::from(start.partners);
            ranks[class] += 1;
            !std::mem::replace(&mut seen[start.candidate][class], true) || ranks[class] <= self.settings.apart
        });
        let anew = self.problem.work.each(apart, STARTS, |start| {
            Some(Start { density: self.density_by_itself(&start.hypothesis)?, ..start })
        });
        alike.extend(anew);
        by_density(&mut alike);
        alike
    }

    /// The density at a start by derivatives taken there.
    fn density_by_itself(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let problem = &self.problem;
        let paired = problem.paired_modes(hypothesis)?;
        let residual = problem.residual(&paired, &paired.modelled);
        let own = |at: &f64| Prior { mean: *at, std: self.settings.near };
        let mut local: Vec<Prior> = hypothesis.coordinates.iter().map(own).collect();
        let tolerances = self.priors(self.nominal, &[]);
        local[..tolerances.len()].copy_from_slice(&tolerances);
        let all = 0..local.len();
        let slopes = problem.slopes(hypothesis, &paired, &paired.modelled, &residual, &local, all)?;
        let linear = linear(hypothesis, &local, &residual, &slopes);
        Some(linear.ln_density(&paired.comparison, problem.sizes)? + paired.pairing.alone())
    }

    /// A start with the density of the recorded features there, everything else linear about `base`.
    pub(super) fn scored(&self, candidate: usize, hypothesis: Hypothesis, base: &ModalFit) -> Option<Start> {
        let problem = &self.problem;
        let paired = problem.paired_modes(&hypothesis)?;
        let residual = problem.residual(&paired, &paired.modelled);
        let alone = paired.pairing.alone();
        if paired.pairing.pairs != base.paired.pairing.pairs {
            // Derivatives of the base are of other features: none at all, and errors so much larger.
            let linear = Linear { difference: residual, slopes: Vec::new() };
            let wide = problem.sizes.times(self.settings.wide);
            let density = linear.ln_density(&paired.comparison, &wide)? + alone;
            let partners = paired.pairing.pairs.len() > base.paired.pairing.pairs.len();
            return Some(Start { density, candidate, hypothesis, apart: true, partners });
        }
        let slopes = self.slopes(&hypothesis, &paired, &residual, base)?;
        let linear = linear(&hypothesis, &self.local_priors(&hypothesis, base), &residual, &slopes);
        let density = linear.ln_density(&paired.comparison, problem.sizes)? + alone;
        Some(Start { density, candidate, hypothesis, apart: false, partners: false })
    }

    /// Priors of the base, and of what it does not have a factor of two about where it stands.
    fn local_priors(&self, hypothesis: &Hypothesis, base: &ModalFit) -> Vec<Prior> {
        let own = |at: &f64| Prior { mean: *at, std: self.settings.near };
        let prior = |(i, at): (usize, &f64)| base.priors.get(i).copied().unwrap_or_else(|| own(at));
        hypothesis.coordinates.iter().enumerate().map(prior).collect()
    }

    /// Derivatives of the base, and of what it does not have where `hypothesis` stands.
    fn slopes(
        &self,
        hypothesis: &Hypothesis,
        paired: &PairedModes,
        residual: &[f64],
        base: &ModalFit,
    ) -> Option<Vec<Vec<f64>>> {
        let known = base.slopes.len();
        let local = self.local_priors(hypothesis, base);
        let own = known..hypothesis.coordinates.len();
        let own = self.problem.slopes(hypothesis, paired, &paired.modelled, residual, &local, own)?;
        Some(base.slopes.iter().cloned().chain(own).collect())
    }

    /// [`Searcher::slopes`] where the base compares the same modes.
    pub(super) fn nearby(
        &self,
        hypothesis: &Hypothesis,
        paired: &PairedModes,
        base: &ModalFit,
    ) -> Option<Vec<Vec<f64>>> {
        if paired.pairing.pairs != base.paired.pairing.pairs {
            return None;
        }
        let residual = self.problem.residual(paired, &paired.modelled);
        self.slopes(hypothesis, paired, &residual, base)
    }
}
