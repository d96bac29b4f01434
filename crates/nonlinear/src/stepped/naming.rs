//! Laws as they are named: over which levels one holds, how sure, and with which parameters.

use super::forms::{FORMS, Fitted, fitted, share};
use super::problem::{BASE, Change, Problem};
use super::tolerances::{ByTolerances, by_tolerances};
use crate::RestoringLaw;
use crate::estimates::estimates;
use crate::settings::naming::{
    HARMONIC_BALANCE_ERROR, LAW_ERROR, LEAST_SHOWN, LEAVES_NOTHING, LEVELS_FOR_ONE, LEVELS_FOR_TWO, NAMED,
    NAMED_TWO,
};
use jointscope_findings::{Finding, HeldOut};
use jointscope_fixture::{Effect, Fixture};
use jointscope_inference::jackknife;
use jointscope_spectra::Dof;
use serde::Serialize;

/// A form tried at a component of a joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TriedForm {
    /// Names of the effects, `linear` for none.
    #[serde(rename = "kind")]
    pub form: String,
    /// The joint.
    #[serde(rename = "place")]
    pub joint: String,
    /// Which component of d.
    pub dof: Dof,
    /// Root mean square over the levels of the relative errors.
    pub nrmse: f64,
    /// Share of the change with level that it explains, 0 to 1.
    #[serde(rename = "share_explained")]
    pub share: f64,
}

/// A law that the levels need.
pub type LevelFinding = Finding<LevelEvidence>;

/// What levels tell of a law beyond its name, size and probability.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LevelEvidence {
    /// Share of the change with level that the laws found explain over the range.
    #[serde(rename = "share_explained")]
    pub share: f64,
    /// Relative motions of the joint over the range, m or rad.
    #[serde(rename = "relative_motions")]
    pub motions: (f64, f64),
}

/// All forms at one component of a joint.
#[derive(Clone)]
pub(crate) struct Judged {
    pub problem: Problem,
    pub linear: Fitted,
    laws: Vec<Fitted>,
}

impl Judged {
    /// Laws are tried where there is a change to explain.
    pub(super) fn of(problem: Problem, linear: Fitted, changed: bool) -> Self {
        let tried = |form: &&&[_]| changed && (problem.levels.len() >= LEVELS_FOR_ONE || form.len() == 1);
        let laws = FORMS.iter().filter(tried).filter_map(|form| fitted(&problem, form)).collect();
        Judged { problem, linear, laws }
    }

    pub(super) fn best(&self) -> &Fitted {
        self.laws.iter().fold(&self.linear, |best, fit| if fit.nrmse < best.nrmse { fit } else { best })
    }

    pub(super) fn tried(&self) -> impl Iterator<Item = TriedForm> {
        std::iter::once(&self.linear).chain(&self.laws).map(|fit| TriedForm {
            joint: self.problem.joint.clone(),
            dof: self.problem.dof,
            form: fit.name(),
            nrmse: fit.nrmse,
            share: share(&self.problem, &self.linear, fit),
        })
    }
}

/// A form fitted at one of the judged components.
#[derive(Clone)]
struct Rival {
    /// Which of them.
    index: usize,
    fit: Fitted,
    share: f64,
}

/// A law with the levels over which it holds.
pub(crate) struct Named {
    /// Which of the judged components.
    pub index: usize,
    pub fit: Fitted,
    pub count: usize,
    pub share: f64,
    /// That component up to the last level over which the law holds, and all that was tried there and
    /// elsewhere.
    problem: Problem,
    linear: Fitted,
    rivals: Vec<Rival>,
}

/// The law that explains the most, over as many levels from the lowest as it holds for.
pub(crate) fn named_law(judged: &[Judged]) -> Option<Named> {
    let levels = judged.first()?.problem.levels.len();
    // Two levels tell a shift from no shift, three whether a law follows it.
    (LEVELS_FOR_ONE.min(levels)..=levels).rev().find_map(|count| {
        let part = |(index, whole): (usize, &Judged)| {
            if count == levels {
                return Some((index, whole.clone()));
            }
            let problem = whole.problem.up_to(count)?;
            let linear = fitted(&problem, &[])?;
            Some((index, Judged::of(problem, linear, true)))
        };
        let parts: Vec<(usize, Judged)> = judged.iter().enumerate().filter_map(part).collect();
        best_of(&parts, count)
    })
}

/// The law that explains the most of the first `count` levels: one alone, two together only where none does.
fn best_of(parts: &[(usize, Judged)], count: usize) -> Option<Named> {
    let mut rivals: Vec<Rival> = Vec::new();
    for (index, part) in parts {
        let share = |fit: &Fitted| share(&part.problem, &part.linear, fit);
        rivals.extend(part.laws.iter().map(|fit| Rival {
            index: *index,
            fit: fit.clone(),
            share: share(fit),
        }));
    }
    let simplest = |double: bool| {
        let explains = |rival: &&Rival| match double {
            true => rival.share >= NAMED_TWO && count >= LEVELS_FOR_TWO,
            false => rival.share >= NAMED,
        };
        let of_form = rivals.iter().filter(|rival| rival.fit.is_double() == double).filter(explains);
        of_form.min_by(|a, b| a.fit.nrmse.total_cmp(&b.fit.nrmse))
    };
    let Rival { index, fit, share } = simplest(false).or_else(|| simplest(true))?.clone();
    let (_, part) = parts.iter().find(|(i, _)| *i == index)?;
    let (problem, linear) = (part.problem.clone(), part.linear.clone());
    Some(Named { index, fit, count, share, problem, linear, rivals })
}

impl Named {
    /// Whether the law leaves nothing worth a word of all `levels`. Of two it cannot: any law follows them.
    pub(super) fn explains_all(&self, levels: usize) -> bool {
        levels >= LEVELS_FOR_ONE && self.count == levels && self.share >= LEAVES_NOTHING
    }

    /// `by_fixture`: the fixture, and whether its bare numbers are exact.
    pub(super) fn findings(&self, judged: &[Judged], by_fixture: (&Fixture, bool)) -> Vec<LevelFinding> {
        let effect = |index: usize, law: &RestoringLaw| {
            law.to_effect(&judged[index].problem.joint, judged[index].problem.dof)
        };
        let (fixture, exact) = by_fixture;
        let tolerances = by_tolerances(fixture, exact, &self.problem, &self.fit.change);
        // What the fixture's own numbers and one harmonic leave of the right law tells no law from another.
        let floor = self.problem.floor.hypot(tolerances.error).hypot(LAW_ERROR);
        // Laplace's approximation with as many observations as the levels have stiffnesses and losses.
        let observations = 2.0 * self.count as f64;
        let badness = |fit: &Fitted| {
            let parameters = (fit.change.parameters().len() - BASE) as f64;
            2.0 * observations * fit.nrmse.max(floor).ln() + parameters * observations.ln()
        };
        let least = badness(&self.fit);
        let weigh = |fit: &Fitted| (0.5 * (least - badness(fit))).exp();
        let comparable = |rival: &&Rival| rival.fit.is_double() == self.fit.is_double();
        let rivals = || self.rivals.iter().filter(comparable);
        let total: f64 = rivals().map(|rival| weigh(&rival.fit)).sum::<f64>().max(1.0);
        // What is not explained is the share of something not listed.
        let probability = |fit: &Fitted| self.share * weigh(fit) / total;
        let motions = (self.problem.levels[0].motion(), self.problem.levels[self.count - 1].motion());
        let deviations = self.deviations(&tolerances);
        let mut deviations = deviations.iter().copied().skip(BASE);
        let finding = |(k, law): (usize, &RestoringLaw)| {
            let other = |rival: &&Rival| rival.index != self.index || rival.fit.name() != self.fit.name();
            let named = |rival: &Rival| {
                Some((effect(rival.index, rival.fit.change.laws.get(k)?), probability(&rival.fit)))
            };
            let mut alternatives: Vec<(Effect, f64)> =
                rivals().filter(other).filter_map(named).filter(|(_, p)| *p >= LEAST_SHOWN).collect();
            alternatives.sort_by(|a, b| b.1.total_cmp(&a.1));
            let effect = effect(self.index, law);
            let own: Vec<Option<f64>> = deviations.by_ref().take(law.values().len()).collect();
            LevelFinding {
                probability: probability(&self.fit),
                estimates: estimates(&effect, &own, HARMONIC_BALANCE_ERROR),
                effect,
                alternatives,
                evidence: LevelEvidence { share: self.share, motions },
            }
        };
        self.fit.change.laws.iter().enumerate().map(finding).collect()
    }

    /// Standard deviations of the parameters: from the scatter of lines, or of fits that leave one level out,
    /// whichever is larger; with what the fixture's tolerances add.
    fn deviations(&self, tolerances: &ByTolerances) -> Vec<Option<f64>> {
        let by_lines = self.problem.deviations(&self.fit.change);
        let without: Vec<Vec<f64>> =
            (0..self.count).filter_map(|l| Some(self.without(l, &self.fit)?.parameters())).collect();
        let by_levels = (without.len() > 1).then(|| jackknife(&without));
        let of = |p: usize| {
            let noise = by_lines.as_ref()?[p].max(by_levels.as_ref().map_or(0.0, |levels| levels.std(p)));
            Some(noise.hypot(tolerances.variances[p].sqrt()))
        };
        (0..tolerances.variances.len()).map(of).collect()
    }

    /// The change fitted to all levels but one.
    fn without(&self, level: usize, fit: &Fitted) -> Option<Change> {
        Some(self.problem.without(level).fitted(&fit.change)?.0)
    }

    /// Root-mean-square relative errors at levels that the fit did not see.
    pub(super) fn held_out(&self) -> Option<HeldOut> {
        let levels = &self.problem.levels;
        let error = |fit: &Fitted| {
            let of = |l: usize| Some(self.problem.error(&levels[l], &self.without(l, fit)?).powi(2));
            let squares = (0..self.count).map(of).sum::<Option<f64>>()?;
            Some((squares / self.count as f64).sqrt())
        };
        Some(HeldOut {
            what: levels.iter().map(|level| format!("level {}", level.measured.held)).collect(),
            nrmse_refitted: error(&self.linear)?,
            nrmse_repaired: error(&self.fit)?,
            same_findings: None,
        })
    }
}
