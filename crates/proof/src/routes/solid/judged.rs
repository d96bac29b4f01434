//! How answers to solid cases are judged.

use super::{APART, SolidTruth, with_points};
use crate::judge::Judge;
use crate::judged::error_on;
use crate::{Answer, Case, IndependentFits, Judgeable, Judged, Name, Role};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture};

/// A solid case after its truth was opened.
pub(crate) type SolidJudged = Judged<SolidTruth>;

impl Judgeable for SolidTruth {
    fn index(&self) -> usize {
        self.index
    }

    fn role(&self) -> Role {
        self.role
    }

    /// Sizes in closed form.
    fn effects(&self) -> &[Effect] {
        self.lumped.physics()
    }

    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits> {
        let [clean, unseen] = self.frfs().ok()?;
        let judge = Judge::of(case)?;
        let error = |fixture: &Fixture| error_on(&unseen, &with_points(fixture, &self.solid, APART)?);
        Some(IndependentFits {
            truth: judge.objective_of_clean(&clean, &self.lumped)?,
            lumped: Some(judge.best(&self.lumped)?.objective),
            without: if self.effects().len() == 2 { judge.without_each(&self.lumped) } else { Vec::new() },
            unseen: error(&answer.refitted).zip(error(&answer.repaired)).map(Into::into),
            ..IndependentFits::of_answer(&judge, answer)?
        })
    }
}

impl SolidJudged {
    /// Whether something found is in the solid, asked for or not.
    pub(crate) fn is_true(&self, found: &Effect) -> bool {
        let mut in_the_solid = self.truth.effects().iter().chain(&self.truth.besides);
        in_the_solid.any(|there| are_the_same(there, found))
    }

    /// Whether all that was hidden was found at its place.
    pub(crate) fn is_named(&self) -> bool {
        self.finds_all(are_the_same)
    }

    /// Whether the kinds of all that was hidden were found.
    pub(crate) fn has_kind(&self) -> bool {
        self.finds_all(|hidden, found| found.kind == hidden.kind || are_the_same(hidden, found))
    }

    fn finds_all(&self, is_one: impl Fn(&Effect, &Effect) -> bool) -> bool {
        let is_found = |hidden: &Effect| self.findings().iter().any(|found| is_one(hidden, &found.effect));
        self.truth.effects().iter().all(is_found)
    }

    /// Whether something was found that is not in the solid.
    pub(crate) fn has_extra(&self) -> bool {
        self.findings().iter().any(|found| !self.is_true(&found.effect))
    }

    /// What went wrong, in a phrase each. Hidden effects that do not show are not asked for.
    pub(crate) fn faults(&self) -> Vec<String> {
        let Ok(answer) = &self.answer else { return vec!["no answer".to_owned()] };
        let mut faults = Vec::new();
        if self.truth.role == Role::Null {
            faults.extend(self.is_noticed().then(|| format!("called {}", answer.verdict.name())));
        } else if self.is_named() {
            faults.extend(self.has_extra().then(|| "extra finding".to_owned()));
        } else if self.is_visible() {
            let fault = match (answer.findings.len(), self.truth.role) {
                (0, _) => "missed",
                (_, Role::Double) => "not both",
                _ => "wrong name",
            };
            faults.push(fault.to_owned());
        }
        faults.extend(self.faults_of_prediction());
        faults
    }
}

/// Whether two effects have one name, or are one spring in series across the strip: shear of the strip and a
/// layer that slides at either end are the same number to blocks on a strip without mass.
pub(super) fn are_the_same(a: &Effect, b: &Effect) -> bool {
    Name::of(a) == Name::of(b) || (is_across(a) && is_across(b))
}

/// Whether an effect is a spring in series across the strip.
fn is_across(effect: &Effect) -> bool {
    effect.kind == EffectKind::ShearDeformation
        || (effect.kind == EffectKind::InterfaceCompliance && effect.dof == Some(Dof::Translation))
}
