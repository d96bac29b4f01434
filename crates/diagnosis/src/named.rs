//! The names of what a search by lines has found: how probable, what else it could be, how large.

use crate::alternatives::{Alternative, alternatives};
use crate::departures::has_departed;
use crate::elsewhere::elsewhere;
use crate::estimates::estimates;
use crate::evidence::explained;
use crate::finding::{Finding, FrfEvidence};
use crate::fitter::Fitter;
use crate::location::measured;
use crate::search::Search;
use jointscope_findings::Verdict;
use jointscope_fixture::Effect;

/// What a search by lines comes to.
pub(crate) fn verdict(fitter: &Fitter, search: &Search, findings: &[Finding]) -> Verdict {
    let fits =
        search.repaired.chi2_per_dof(fitter.observation) < explained(fitter.observation, fitter.settings);
    // A quantity far from what is stated is a finding too, if none with a name of its own.
    let departed = has_departed(&search.repaired.hypothesis);
    match (findings.is_empty(), fits) {
        (true, true) if departed => Verdict::Unexplained,
        (true, true) => Verdict::Consistent,
        (true, false) => Verdict::Unexplained,
        (false, true) => Verdict::Explained,
        (false, false) => Verdict::PartlyExplained,
    }
}

/// The hypotheses for each effect of the repaired fit. Where one is more probable than what was found, it
/// takes its place and everything is asked again: a search goes one effect at a time, and what was best
/// alone, or in a part of the recording, need not be best in company and in the whole.
fn settled(fitter: &Fitter, search: &mut Search) -> Vec<Vec<Alternative>> {
    let settings = &fitter.settings.evidence;
    // Each replacement costs the fits of all candidates for all effects.
    let mut left = settings.replacements.saturating_sub(search.repaired.hypothesis.effect_count());
    loop {
        let count = search.repaired.hypothesis.effect_count();
        let all: Vec<Vec<Alternative>> =
            (0..count).map(|index| alternatives(fitter, search, index)).collect();
        let effects = search.repaired.hypothesis.effects();
        let better = all.iter().zip(&effects).find_map(|(all, effect)| {
            let own = all.iter().find(|other| search.candidates[other.candidate].names(effect));
            let own = own.map_or(0.0, |own| own.probability);
            all.first().filter(|best| best.probability > settings.replace * own).map(|best| best.fit.clone())
        });
        match better.filter(|_| left > 0) {
            Some(fit) => {
                search.repaired = fit;
                // Beside the new effect an earlier one may no longer be needed.
                search.prune(fitter);
            }
            None => return all,
        }
        left -= 1;
    }
}

/// What was found, the strongest first, with its look-alikes.
pub(crate) fn findings(fitter: &Fitter, search: &mut Search) -> Vec<Finding> {
    let all_names = settled(fitter, search);
    let search = &*search;
    let repaired = &search.repaired;
    let covariance = fitter.information(&repaired.hypothesis).covariance();
    let widening = repaired.inflation(fitter.observation).sqrt();
    let finding = |(index, effect): (usize, Effect)| {
        let own = |a: &Alternative| search.candidates[a.candidate].names(&effect);
        let without = repaired.hypothesis.without(index);
        let without = match without.effect_count() {
            0 => Some(search.refitted.clone()),
            _ => fitter.global(&without.with_tolerances_of(&search.nominal.hypothesis)),
        };
        let alternative = |a: &Alternative| Some((a.fit.hypothesis.effects().pop()?, a.probability));
        Finding {
            estimates: estimates(&repaired.hypothesis, index, &effect, covariance.as_ref(), widening),
            probability: all_names[index].iter().find(|a| own(a)).map_or(0.0, |a| a.probability),
            alternatives: all_names[index].iter().filter(|a| !own(a)).filter_map(alternative).collect(),
            evidence: FrfEvidence {
                gain: without.map_or(0.0, |fit| fit.objective - repaired.objective),
                elsewhere: elsewhere(fitter, search, index),
                measured: measured(*fitter, repaired, index),
            },
            effect,
        }
    };
    let mut all: Vec<Finding> = repaired.hypothesis.effects().into_iter().enumerate().map(finding).collect();
    all.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
    all
}

/// The same findings of a search that was fitted to more FRFs: sizes and uncertainties are by those.
pub(crate) fn re_estimated(fitter: &Fitter, search: &Search, findings: Vec<Finding>) -> Vec<Finding> {
    let repaired = &search.repaired;
    let covariance = fitter.information(&repaired.hypothesis).covariance();
    let widening = repaired.inflation(fitter.observation).sqrt();
    let effects = repaired.hypothesis.effects();
    let again = |finding: Finding| {
        let same = |effect: &Effect| effect.is_named_as(&finding.effect);
        let Some(index) = effects.iter().position(same) else { return finding };
        let effect = effects[index].clone();
        let estimates = estimates(&repaired.hypothesis, index, &effect, covariance.as_ref(), widening);
        Finding { effect, estimates, ..finding }
    };
    findings.into_iter().map(again).collect()
}
