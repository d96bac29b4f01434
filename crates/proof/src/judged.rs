//! Truth and answer side by side, with the objectives that decide which names are right.

use crate::answers::on_workers;
use crate::objective::{Tolerance, objective, values};
use crate::{Answer, Answers, Case, Name, NoAnswer, Reference, Role, Truth};
use jointscope_diagnosis::Observation;
use jointscope_fixture::{Effect, Fixture};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::FrfSet;
use std::collections::BTreeMap;

/// A name whose best fit comes within this of the truth's cannot be told from it.
pub const AS_GOOD: f64 = 9.0;
/// What a hidden effect must cost the refitted fixture to be asked for.
pub const VISIBLE: f64 = 50.0;
/// What it must cost for its name to be expected with certainty.
pub const PLAIN: f64 = 200.0;
/// Standard deviations beyond which a quantity's departure is worth telling.
pub const STRAINED: f64 = 4.0;
/// Alternatives below this probability are not fitted.
const LISTED: f64 = 0.01;

/// A case after the truth was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// What was true.
    pub truth: Truth,
    /// What was answered.
    pub answer: Result<Answer, NoAnswer>,
    /// What independent fits say of both.
    pub evidence: Evidence,
}

/// Objectives (χ² and squared departures of the quantities) by which an answer is judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Evidence {
    /// Of the refitted fixture that was handed back.
    pub refitted: f64,
    /// Of the repaired fixture that was handed back.
    pub repaired: f64,
    /// Of the best fit about the truth.
    pub truth: f64,
    /// Cramér–Rao bound of each hidden effect's parameters, one standard deviation.
    pub bounds: Vec<Vec<Option<f64>>>,
    /// Of every other name that was given, fitted alone (one hidden effect only).
    pub others: BTreeMap<Name, f64>,
    /// Of the best fit without each hidden effect.
    pub without: Vec<f64>,
    /// Errors on FRFs that nobody recorded: refitted and repaired.
    pub unseen: Option<[f64; 2]>,
    /// Quantities of the repaired fixture that lie farther than [`STRAINED`] from what was stated, in standard deviations.
    pub strained: Vec<(String, f64)>,
}

impl Judged {
    /// Judges all cases on `threads` workers.
    pub fn all(
        cases: &[Case],
        truths: Vec<Truth>,
        answers: &Answers,
        threads: usize,
        told: impl Fn(usize) + Sync,
    ) -> Vec<Judged> {
        let work: Vec<_> = cases.iter().zip(&truths).zip(answers.all()).collect();
        let evidence = on_workers(&work, threads, told, |((case, truth), answer)| {
            answer.as_ref().ok().and_then(|answer| Evidence::of(case, truth, answer))
        });
        let judged = truths.into_iter().zip(answers.all()).zip(evidence);
        judged
            .map(|((truth, answer), evidence)| Judged {
                truth,
                answer: answer.clone(),
                evidence: evidence.flatten().unwrap_or_default(),
            })
            .collect()
    }

    /// The hidden names.
    pub fn hidden(&self) -> Vec<Name> {
        self.truth.effects().iter().map(Name::of).collect()
    }

    /// The names found, the strongest first; none where there is no answer.
    pub fn found(&self) -> Vec<Name> {
        self.answer.as_ref().map_or_else(|_| Vec::new(), Answer::names)
    }

    /// What the hidden physics costs a fit that does without: Δχ², of two effects the smaller one's.
    pub fn size(&self) -> f64 {
        let Evidence { refitted, truth, without, .. } = &self.evidence;
        let lowest = without.iter().copied().fold(f64::INFINITY, f64::min);
        match self.truth.role {
            // A refit that ended in a false minimum must not make an effect look larger than it is.
            Role::Single | Role::Graded => refitted.min(lowest) - truth,
            Role::Double => lowest - truth,
            Role::Null | Role::Outside => refitted - truth,
        }
    }

    /// Whether what was hidden shows: one effect, or each of two.
    pub fn is_visible(&self) -> bool {
        self.truth.role != Role::Null && self.size() >= VISIBLE
    }

    /// Whether a name counts as right beside one hidden effect: it is the truth, or fits as well.
    pub fn accepts(&self, name: &Name) -> bool {
        let as_good = |objective: &f64| *objective <= self.evidence.truth + AS_GOOD;
        self.hidden().contains(name) || self.evidence.others.get(name).is_some_and(as_good)
    }

    /// Whether all that was hidden was found, under its names or by a fit that is as good with as many effects.
    pub fn all_found(&self) -> bool {
        let (hidden, found) = (self.hidden(), self.found());
        let by_name = hidden.iter().all(|name| found.contains(name));
        let as_good = self.evidence.repaired <= self.evidence.truth + AS_GOOD;
        by_name || (found.len() == hidden.len() && as_good)
    }

    /// The stated probability of a name, the largest where it was stated for several findings; zero where it was not named.
    pub fn stated(&self, name: &Name) -> f64 {
        let Ok(answer) = &self.answer else { return 0.0 };
        let all = answer.findings.iter().flat_map(|found| found.names());
        all.filter(|(other, _)| other == name).fold(0.0, |most, (_, p)| p.max(most))
    }
}

impl Evidence {
    /// `None` where the recording or what was handed back cannot be evaluated.
    fn of(case: &Case, truth: &Truth, answer: &Answer) -> Option<Self> {
        let observation = Observation::new(&case.recorded, |_| true).ok()?;
        let tolerances = Tolerance::all(&case.believed);
        let objective_of = |fixture: &Fixture| {
            let (pairs, lines) = (observation.pairs(), observation.lines());
            let set = synthesize(fixture, pairs, lines, Instrument::AsRecorded).ok()?;
            Some(objective(&observation, set.all_values(), &tolerances, &values(fixture)))
        };
        let best = |start: &Fixture| Reference::of(&case.believed, start, &observation);
        let mut evidence = Evidence {
            refitted: objective_of(&answer.refitted)?,
            repaired: objective_of(&answer.repaired)?,
            unseen: unseen(&truth.unseen, answer),
            strained: strained(&case.believed, &tolerances, &answer.repaired),
            ..Evidence::default()
        };
        match &truth.outside {
            // No fixture describes it: the truth is what the hammer would have measured without noise.
            Some(outside) => {
                let (pairs, lines) = (observation.pairs(), observation.lines());
                let set = outside
                    .frfs(&truth.fixture, pairs, lines, jointscope_rig::Instrument::AsDescribed)
                    .ok()?;
                evidence.truth =
                    objective(&observation, set.all_values(), &tolerances, &values(&truth.fixture));
            }
            None => {
                let reference = best(&truth.fixture)?;
                evidence.truth = reference.objective;
                evidence.bounds = reference.bounds;
            }
        }
        if truth.role.is_of_one() {
            evidence.others = others(truth, answer, &evidence, best);
        }
        let without = |index: usize| {
            let mut fewer = truth.effects().to_vec();
            fewer.remove(index);
            let start = truth.fixture.clone().with_physics(fewer).ok()?;
            best(&start).map(|reference| reference.objective)
        };
        let each = (0..truth.effects().len()).map(|index| without(index).unwrap_or(f64::INFINITY));
        evidence.without = each.collect();
        Some(evidence)
    }
}

fn strained(believed: &Fixture, tolerances: &[Tolerance], repaired: &Fixture) -> Vec<(String, f64)> {
    let (quantities, values) = (believed.quantities(), values(repaired));
    let departures = tolerances.iter().map(|t| (quantities[t.index].path.clone(), t.departure(&values)));
    departures.filter(|(_, departure)| departure.abs() > STRAINED).collect()
}

/// Objectives of the names that were given instead of the hidden one, each fitted alone from where the answer left it, and from the
/// true quantities.
fn others(
    truth: &Truth,
    answer: &Answer,
    evidence: &Evidence,
    best: impl Fn(&Fixture) -> Option<Reference>,
) -> BTreeMap<Name, f64> {
    let hidden: Vec<Name> = truth.effects().iter().map(Name::of).collect();
    let mut all: BTreeMap<Name, f64> = BTreeMap::new();
    let mut fit = |effect: &Effect, known: f64| {
        let name = Name::of(effect);
        if hidden.contains(&name) || all.contains_key(&name) {
            return;
        }
        let from = |fixture: &Fixture| {
            let start = fixture.clone().with_physics(vec![effect.clone()]).ok()?;
            best(&start).map(|reference| reference.objective)
        };
        let starts = [&answer.repaired, &truth.fixture].into_iter().filter_map(from);
        all.insert(name, starts.fold(known, f64::min));
    };
    for found in &answer.findings {
        let alone = if answer.findings.len() == 1 { evidence.repaired } else { f64::INFINITY };
        fit(&found.effect, alone);
        for (effect, _) in found.alternatives.iter().filter(|(_, p)| *p >= LISTED) {
            fit(effect, f64::INFINITY);
        }
    }
    all
}

/// Errors of the refitted and the repaired fixture, √(Σ|ΔH|²/Σ|H|²), as a perfect instrument would read them.
fn unseen(truth: &FrfSet, answer: &Answer) -> Option<[f64; 2]> {
    let error = |fixture: &Fixture| {
        let set = synthesize(fixture, truth.pairs(), truth.lines(), Instrument::Perfect).ok()?;
        let (mut error, mut size) = (0.0, 0.0);
        for (modelled, exact) in set.all_values().iter().zip(truth.all_values()) {
            error += (modelled - exact).norm_sqr();
            size += exact.norm_sqr();
        }
        Some((error / size).sqrt())
    };
    Some([error(&answer.refitted)?, error(&answer.repaired)?])
}
