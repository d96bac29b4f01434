//! How answers to the laboratory's cases are judged.

use crate::case_line::errors;
use crate::judge::Judge;
use crate::judged::error_on;
use crate::objective::FAR_BEYOND_TOLERANCE;
use crate::{AS_GOOD, Answer, Case, CaseLine, Found, IndependentFits, Judgeable, Judged, Name, Role, Truth};
use jointscope_fixture::{Effect, Fixture};
use std::collections::BTreeMap;

/// Alternatives below this probability are not fitted.
const LISTED: f64 = 0.01;
/// Objective above that of the fit about the truth at which a fit of the same names has not found its
/// minimum.
const SHORT: f64 = 2.0;

impl Judgeable for Truth {
    fn index(&self) -> usize {
        self.index
    }

    fn role(&self) -> Role {
        self.role
    }

    fn effects(&self) -> &[Effect] {
        self.fixture.physics()
    }

    fn hidden(&self) -> String {
        Truth::hidden(self)
    }

    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits> {
        let judge = Judge::of(case)?;
        let unseen = self.unseen().ok()?;
        let mut fits = IndependentFits {
            unseen: error_on(&unseen, &answer.refitted)
                .zip(error_on(&unseen, &answer.repaired))
                .map(Into::into),
            beyond_tolerance: judge.beyond_tolerance(&answer.repaired, FAR_BEYOND_TOLERANCE),
            without: judge.without_each(&self.fixture),
            ..IndependentFits::of_answer(&judge, answer)?
        };
        if self.outside.is_some() {
            // No fixture describes it: the truth is what the hammer would have measured without noise.
            let (pairs, lines) = (judge.observation.pairs(), judge.observation.lines());
            let exact = self.frfs(pairs, lines, jointscope_rig::Instrument::AsDescribed).ok()?;
            fits.truth = judge.objective_of(exact.all_values(), &self.fixture);
        } else {
            let reference = judge.best(&self.fixture)?;
            fits.truth = reference.objective;
            fits.bounds = reference.bounds;
        }
        if self.role.is_of_one() {
            fits.others = others(self, answer, fits.repaired, &judge);
        }
        Some(fits)
    }
}

/// Objectives of the names that were given instead of the hidden one, each fitted alone from where the answer
/// left it, and from the true quantities.
pub(crate) fn others(truth: &Truth, answer: &Answer, repaired: f64, judge: &Judge) -> BTreeMap<Name, f64> {
    let mut all: BTreeMap<Name, f64> = BTreeMap::new();
    let mut fit = |effect: &Effect, known: f64| {
        let name = Name::of(effect);
        if truth.effects().iter().any(|hidden| Name::of(hidden) == name) || all.contains_key(&name) {
            return;
        }
        let from = |fixture: &Fixture| {
            let start = fixture.clone().with_physics(vec![effect.clone()]).ok()?;
            judge.best(&start).map(|reference| reference.objective)
        };
        let starts = [&answer.repaired, &truth.fixture].into_iter().filter_map(from);
        all.insert(name, starts.fold(known, f64::min));
    };
    for found in &answer.findings {
        let alone = if answer.findings.len() == 1 { repaired } else { f64::INFINITY };
        fit(&found.effect, alone);
        for (effect, _) in found.alternatives.iter().filter(|(_, p)| *p >= LISTED) {
            fit(effect, f64::INFINITY);
        }
    }
    all
}

impl Judged {
    /// Whether a name counts as right beside one hidden effect: it is the truth, or fits as well.
    pub fn accepts(&self, name: &Name) -> bool {
        let as_good = |objective: &f64| *objective <= self.fits.truth + AS_GOOD;
        self.hidden().contains(name) || self.fits.others.get(name).is_some_and(as_good)
    }

    /// Whether all that was hidden was found, under its names or by a fit that is as good with as many
    /// effects.
    pub(crate) fn all_found(&self) -> bool {
        let (hidden, found) = (self.hidden(), self.found());
        let by_name = hidden.iter().all(|name| found.contains(name));
        by_name || (found.len() == hidden.len() && self.cannot_be_told())
    }

    /// Whether a finding is of a hidden kind, or counts as right.
    pub(crate) fn has_kind(&self) -> bool {
        let hidden = self.hidden();
        let right = |name: &Name| hidden.iter().any(|h| h.kind == name.kind) || self.accepts(name);
        self.found().iter().any(right)
    }

    /// Whether a name counts as right among those found.
    pub(crate) fn is_named(&self) -> bool {
        self.found().iter().any(|name| self.accepts(name))
    }

    /// The stated probability of a name, the largest where it was stated for several findings; zero where it
    /// was not named.
    pub(crate) fn stated(&self, name: &Name) -> f64 {
        let all = self.findings().iter().flat_map(|found| found.names());
        all.filter(|(other, _)| other == name).fold(0.0, |most, (_, p)| p.max(most))
    }

    /// Whether the repaired fixture fits as well as the truth although its names are not what was hidden.
    pub(crate) fn cannot_be_told(&self) -> bool {
        self.fits.repaired <= self.fits.truth + AS_GOOD
    }

    /// Whether a name is given with certainty to physics that has none, and the fit tells it from the truth.
    pub(crate) fn claims_wrongly(&self) -> bool {
        self.claims().next().is_some() && !self.cannot_be_told()
    }

    /// Whether the answer names what was hidden and nothing else.
    pub(crate) fn names_all_and_nothing_else(&self) -> bool {
        let (mut hidden, mut found) = (self.hidden(), self.found());
        hidden.sort();
        found.sort();
        self.answer.is_ok() && self.truth.role != Role::Outside && hidden == found
    }

    /// Whether the fit with all the right names, or of a null, ended higher than the fit about the truth: a
    /// false minimum.
    pub(crate) fn stopped_short(&self) -> bool {
        self.names_all_and_nothing_else() && self.fits.repaired > self.fits.truth + SHORT
    }

    /// What went wrong, in a phrase each; empty where nothing did. Hidden effects that do not show are not
    /// asked for.
    pub fn faults(&self) -> Vec<String> {
        let Ok(answer) = &self.answer else { return vec!["no answer".to_owned()] };
        let (found, visible, named) = (answer.findings.len(), self.is_visible(), self.is_named());
        let mut faults = Vec::new();
        let mut fault = |is_one: bool, what: &str| faults.extend(is_one.then(|| what.to_owned()));
        match self.truth.role {
            Role::Null => fault(self.is_noticed(), &format!("called {}", answer.verdict.name())),
            Role::Single | Role::Graded => {
                fault(visible && !named, if found == 0 { "missed" } else { "wrong name" });
                fault(found > 1 || (found > 0 && !visible && !named), "extra finding");
            }
            Role::Double => {
                fault(visible && !self.all_found(), "not both");
                fault(found > 2, "extra finding");
            }
            Role::Outside => fault(self.claims_wrongly(), "a wrong name with certainty"),
        }
        fault(self.stopped_short(), "false minimum");
        faults.extend(self.faults_of_prediction());
        faults
    }

    /// The case in a line; its details are the findings and the objectives.
    pub(crate) fn line(&self) -> CaseLine {
        let mut line = self.line_of(self.faults(), |found: &Found| self.accepts(&Name::of(&found.effect)));
        let fresh = if self.truth.fresh { ", fresh" } else { "" };
        line.role = format!("{}{fresh}", self.truth.role.name());
        let Ok(answer) = &self.answer else { return line };
        let IndependentFits { refitted, repaired, truth, others, without, unseen, beyond_tolerance, .. } =
            &self.fits;
        let [stated_refitted, stated_repaired] = answer.objectives;
        line.details.push(format!(
            "objective: refitted {refitted:.1}, repaired {repaired:.1}, fit from the truth {truth:.1} \
             (stated: {stated_refitted:.1}, {stated_repaired:.1})"
        ));
        let alone = others.iter().map(|(name, objective)| format!("  {name} alone: {objective:.1}"));
        line.details.extend(alone);
        let hidden = self.hidden().into_iter().zip(without);
        line.details.extend(hidden.map(|(name, objective)| format!("  without {name}: {objective:.1}")));
        let departures = beyond_tolerance
            .iter()
            .map(|(path, by)| format!("  repaired bends {path} by {by:+.1} standard deviations"));
        line.details.extend(departures);
        line.details.extend(errors("unseen FRFs", *unseen));
        line.details.extend(errors("held out", answer.held_out));
        line
    }
}
