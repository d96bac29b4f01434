//! Truth and answer of a solid case side by side.

use super::SolidTruth;
use crate::answers::on_workers;
use crate::objective::{Tolerance, objective, values};
use crate::{Answer, Answers, Case, Name, NoAnswer, Reference, Role, VISIBLE};
use jointscope_diagnosis::{Observation, Verdict};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::FrfSet;

/// A solid case after its truth was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidJudged {
    /// What was true.
    pub truth: SolidTruth,
    /// What was answered.
    pub answer: Result<Answer, NoAnswer>,
    /// What the solid itself says of the fixtures that were handed back.
    pub evidence: SolidEvidence,
}

/// Objectives (χ² and squared departures of the quantities) and errors by which an answer to a solid case is judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SolidEvidence {
    /// Of the refitted fixture that was handed back.
    pub refitted: f64,
    /// Of the repaired fixture that was handed back.
    pub repaired: f64,
    /// Of the solid's own noise-free FRFs.
    pub truth: f64,
    /// Of the best lumped fixture that has what is hidden, started at its closed form.
    pub lumped: f64,
    /// Of two hidden effects: of the best lumped fixture that has the one and not the other.
    pub without: Vec<f64>,
    /// Errors on the solid's FRFs that nobody recorded: refitted and repaired.
    pub unseen: Option<[f64; 2]>,
}

impl SolidJudged {
    /// Judges all cases on `threads` workers.
    pub fn all(
        cases: &[Case],
        truths: Vec<SolidTruth>,
        answers: &Answers,
        threads: usize,
        told: impl Fn(usize) + Sync,
    ) -> Vec<SolidJudged> {
        let work: Vec<_> = cases.iter().zip(&truths).zip(answers.all()).collect();
        let evidence = on_workers(&work, threads, told, |((case, truth), answer)| {
            answer.as_ref().ok().and_then(|answer| SolidEvidence::of(case, truth, answer))
        });
        let judged = truths.into_iter().zip(answers.all()).zip(evidence);
        judged
            .map(|((truth, answer), evidence)| SolidJudged {
                truth,
                answer: answer.clone(),
                evidence: evidence.flatten().unwrap_or_default(),
            })
            .collect()
    }

    /// What was found, the strongest first.
    pub fn found(&self) -> Vec<&Effect> {
        self.answer.iter().flat_map(|answer| &answer.findings).map(|found| &found.effect).collect()
    }

    /// What the hidden physics costs a fit that does without: Δχ², of two effects the smaller one's.
    pub fn size(&self) -> f64 {
        let SolidEvidence { refitted, truth, without, .. } = &self.evidence;
        without.iter().copied().fold(*refitted, f64::min) - truth
    }

    /// Whether what was hidden shows: one effect, or each of two.
    pub fn is_visible(&self) -> bool {
        self.truth.role != Role::Null && self.size() >= VISIBLE
    }

    /// Whether something found is something hidden, or the same by mechanics.
    pub fn is_hidden(&self, found: &Effect) -> bool {
        self.truth.effects().iter().any(|hidden| are_the_same(hidden, found))
    }

    /// Whether something found is in the solid, asked for or not.
    pub fn is_true(&self, found: &Effect) -> bool {
        self.is_hidden(found) || self.truth.besides.iter().any(|other| are_the_same(other, found))
    }

    /// Whether all that was hidden was found at its place.
    pub fn is_named(&self) -> bool {
        let found = self.found();
        self.truth.effects().iter().all(|hidden| found.iter().any(|found| are_the_same(hidden, found)))
    }

    /// Whether the kinds of all that was hidden were found.
    pub fn has_kind(&self) -> bool {
        let found = self.found();
        let of_kind =
            |hidden: &Effect| found.iter().any(|f| f.kind == hidden.kind || are_the_same(hidden, f));
        self.truth.effects().iter().all(of_kind)
    }

    /// Whether something was found that is not in the solid.
    pub fn has_extra(&self) -> bool {
        self.found().iter().any(|found| !self.is_true(found))
    }

    /// What went wrong, in a phrase each. Hidden effects that do not show are not asked for.
    pub fn faults(&self) -> Vec<String> {
        let Ok(answer) = &self.answer else { return vec!["no answer".to_owned()] };
        let mut faults = Vec::new();
        let mut fault = |what: String| faults.push(what);
        match self.truth.role {
            Role::Null if answer.verdict != Verdict::Consistent => {
                fault(format!("called {}", answer.verdict.name()));
            }
            Role::Null => {}
            _ if self.is_visible() && !self.is_named() => {
                fault(match (answer.findings.len(), self.truth.role) {
                    (0, _) => "missed".to_owned(),
                    (_, Role::Double) => "not both".to_owned(),
                    _ => "wrong name".to_owned(),
                })
            }
            _ => {}
        }
        if self.truth.role != Role::Null && self.has_extra() && self.is_named() {
            fault("extra finding".to_owned());
        }
        let worse = |errors: Option<[f64; 2]>| errors.is_some_and(|[refitted, repaired]| repaired > refitted);
        if !answer.findings.is_empty() && worse(self.evidence.unseen) {
            fault("unseen FRFs worse".to_owned());
        }
        if !answer.findings.is_empty() && worse(answer.held_out) {
            fault("held-out lines worse".to_owned());
        }
        faults
    }
}

impl SolidEvidence {
    fn of(case: &Case, truth: &SolidTruth, answer: &Answer) -> Option<Self> {
        let [clean, unseen] = truth.frfs().ok()?;
        let observation = Observation::new(&case.recorded, |_| true).ok()?;
        let tolerances = Tolerance::all(&case.believed);
        // Exactly the lines in use: of many a diagnosis thins out.
        let hz = clean.lines().hz();
        let is_used = |line: usize| {
            observation.lines().hz().iter().any(|used| (used - hz[line]).abs() <= 1e-6 * hz[line])
        };
        let used = clean.on_lines(is_used)?;
        let objective_of = |fixture: &Fixture| {
            let (pairs, lines) = (observation.pairs(), observation.lines());
            let set = synthesize(fixture, pairs, lines, Instrument::AsRecorded).ok()?;
            Some(objective(&observation, set.all_values(), &tolerances, &values(fixture)))
        };
        let best = |start: &Fixture| {
            Reference::of(&case.believed, start, &observation).map(|reference| reference.objective)
        };
        let without = |index: usize| {
            let mut fewer = truth.effects().to_vec();
            fewer.remove(index);
            best(&truth.lumped.clone().with_physics(fewer).ok()?)
        };
        let each = match truth.effects().len() {
            2 => (0..2).map(|index| without(index).unwrap_or(f64::INFINITY)).collect(),
            _ => Vec::new(),
        };
        Some(SolidEvidence {
            refitted: objective_of(&answer.refitted)?,
            repaired: objective_of(&answer.repaired)?,
            truth: objective(&observation, used.all_values(), &tolerances, &values(&truth.lumped)),
            lumped: best(&truth.lumped)?,
            without: each,
            unseen: errors(&unseen, [&answer.refitted, &answer.repaired], truth),
        })
    }
}

/// Errors √(Σ|ΔH|²/Σ|H|²) of fixtures on FRFs at points that they do not state.
fn errors(exact: &FrfSet, fixtures: [&Fixture; 2], truth: &SolidTruth) -> Option<[f64; 2]> {
    let error = |fixture: &Fixture| {
        let fixture = truth.with_points_apart(fixture)?;
        let set = synthesize(&fixture, exact.pairs(), exact.lines(), Instrument::Perfect).ok()?;
        let (mut error, mut size) = (0.0, 0.0);
        for (modelled, exact) in set.all_values().iter().zip(exact.all_values()) {
            error += (modelled - exact).norm_sqr();
            size += exact.norm_sqr();
        }
        Some((error / size).sqrt())
    };
    Some([error(fixtures[0])?, error(fixtures[1])?])
}

/// Whether two effects have one name, or are one spring in series across the strip: shear of the strip and a layer that slides at either end
/// are the same number to blocks on a strip without mass.
pub(super) fn are_the_same(a: &Effect, b: &Effect) -> bool {
    Name::of(a) == Name::of(b) || (is_across(a) && is_across(b))
}

/// Whether an effect is a spring in series across the strip.
fn is_across(effect: &Effect) -> bool {
    effect.kind == EffectKind::ShearDeformation
        || (effect.kind == EffectKind::InterfaceCompliance && effect.dof == Some(Dof::Translation))
}
