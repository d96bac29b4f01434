//! Whether plans keep what they promise: look-alikes of the simulated laboratory, the first suggestion
//! carried out, and the diagnosis made again.
//!
//! A case is a random assembly with one hidden effect and a hammer test of one or two FRFs, so few that names
//! look alike. Where the diagnosis leaves the name open, what the plan suggests first is measured in the
//! laboratory, with noise of its own, and everything is diagnosed again; the plan never sees the truth. It
//! promised a probability with which the hidden name would then have 0.9 or more.

use crate::hammer_test::{drawn_hammer, recorded_lines};
use crate::random::seed_of;
use crate::workers::on_workers;
use crate::{FAMILIES, GenerationError, HIDDEN_KINDS, Name, Share};
use jointscope_diagnosis::{Diagnosis, Observation};
use jointscope_fixture::{Fixture, Quantity, Spread};
use jointscope_pipeline::{Measurement, Options, Outcome, diagnose};
use jointscope_plan::{Measure, Plan as TestPlan, PlanOptions, Remaining, SURE, weighed_by};
use jointscope_rig::{
    Family, HammerSetup, Instrument, StructureError, drawn_within_tolerance, frfs, generator, random_effect,
};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use serde::Serialize;
use std::fmt;

/// Cases drawn for each that is wanted, at the most: most names are not in doubt.
const DRAWS: usize = 12;
/// Cases drawn together, for each that is wanted and at the most.
const BATCH: (usize, usize) = (4, 16);
/// Ends of the classes of promises.
const CLASSES: [f64; 5] = [0.0, 0.3, 0.6, 0.9, 1.0];

/// A case whose name was open, and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedCase {
    /// Its number.
    pub case: usize,
    /// What was hidden.
    pub hidden: Name,
    /// The FRFs recorded.
    pub recorded: Vec<FrfPair>,
    /// The names left, with their probabilities.
    pub before: Vec<(Name, f64)>,
    /// What the plan suggests first; `None` where nothing helps.
    pub first: Option<String>,
    /// The probability that it promises.
    pub promise: f64,
    /// Expected ln of the odds, nats.
    pub expected_log_odds: f64,
    /// The names thereafter.
    pub after: Vec<(Name, f64)>,
    /// Whether the hidden name then has 0.9 or more.
    pub separated: bool,
}

/// How plans did.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Planning {
    /// Cases drawn until enough names were open.
    pub drawn: usize,
    /// Cases whose name was open.
    pub cases: Vec<PlannedCase>,
    /// Of those with a promise of 0.9 or more, how many were separated.
    pub kept: Share,
    /// Of all with a suggestion, by class of promise: mean promise, and how many were separated.
    pub classes: Vec<PromiseClass>,
}

/// Promises of about the same size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PromiseClass {
    /// From this promise.
    pub from: f64,
    /// To this one.
    pub to: f64,
    /// Mean promise.
    pub promised: f64,
    /// How many were separated.
    pub separated: Share,
}

impl Planning {
    /// Draws cases from `seed` until `wanted` of them have an open name, on `threads` workers; `told` hears
    /// how many have.
    ///
    /// # Errors
    /// See [`GenerationError`].
    pub fn of(
        wanted: usize,
        seed: u64,
        threads: usize,
        progress: impl Fn(usize),
    ) -> Result<Self, GenerationError> {
        let mut cases = Vec::new();
        let mut drawn = 0;
        while cases.len() < wanted && drawn < DRAWS * wanted.max(4) {
            let batch = (BATCH.0 * wanted).min(BATCH.1);
            let numbers: Vec<usize> = (drawn..drawn + batch).collect();
            let batch = on_workers(&numbers, threads, |_| (), |number| planned(seed, *number));
            for (number, case) in numbers.into_iter().zip(batch) {
                if cases.len() == wanted {
                    break;
                }
                drawn = number + 1;
                // A worker that died over a case has left nothing of it.
                cases.extend(case.unwrap_or(Ok(None))?);
            }
            progress(cases.len());
        }
        Ok(Planning::scored(drawn, cases))
    }

    fn scored(drawn: usize, cases: Vec<PlannedCase>) -> Self {
        let share = |of: &[&PlannedCase]| Share::count(of, |case| case.separated);
        let within = |from: f64, to: f64| -> Vec<&PlannedCase> {
            let holds = |case: &&PlannedCase| {
                case.first.is_some() && case.promise >= from && (case.promise < to || to >= 1.0)
            };
            cases.iter().filter(holds).collect()
        };
        let class = |ends: &[f64]| {
            let all = within(ends[0], ends[1]);
            let promised = all.iter().map(|case| case.promise).sum::<f64>() / all.len().max(1) as f64;
            PromiseClass { from: ends[0], to: ends[1], promised, separated: share(&all) }
        };
        let kept = share(&within(SURE, 1.0));
        let classes = CLASSES.windows(2).map(class).collect();
        Planning { drawn, cases, kept, classes }
    }
}

impl fmt::Display for Planning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Planning { drawn, cases, kept, classes } = self;
        let open = cases.len();
        writeln!(f, "{drawn} cases drawn, of {open} the diagnosis left the name open")?;
        let none = cases.iter().filter(|case| case.first.is_none()).count();
        writeln!(f, "nothing to suggest: {none}")?;
        writeln!(
            f,
            "first suggestion separates where it promises that with 0.9 or more: {}",
            kept.briefly()
        )?;
        for PromiseClass { from, to, promised, separated } in classes {
            writeln!(
                f,
                "  promise {from:.1} to {to:.1}: mean {promised:.2}, separated {}",
                separated.briefly()
            )?;
        }
        Ok(())
    }
}

/// The case in a line.
impl fmt::Display for PlannedCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let listed = |names: &[(Name, f64)]| {
            names.iter().map(|(name, p)| format!("{name} {p:.2}")).collect::<Vec<_>>().join(", ")
        };
        let recorded: Vec<String> = self.recorded.iter().map(ToString::to_string).collect();
        write!(
            f,
            "case {}: {} in {}; {} → {} (promise {:.2}, {:.3} nats) → {}",
            self.case,
            self.hidden,
            recorded.join(" "),
            listed(&self.before),
            self.first.as_deref().unwrap_or("nothing"),
            self.promise,
            self.expected_log_odds,
            listed(&self.after)
        )
    }
}

/// A case of a number, planned and carried out; `None` where its name is not open.
fn planned(seed: u64, number: usize) -> Result<Option<PlannedCase>, GenerationError> {
    let Some(case) = PlanningCase::draw(seed, number)? else { return Ok(None) };
    let recorded = case.measured(&case.truth, &case.pairs, 0)?;
    let Some((fixture, diagnosis)) = linear(&case.believed, &recorded) else { return Ok(None) };
    let [finding] = diagnosis.findings.as_slice() else { return Ok(None) };
    // By modes the name has an error of the model beside it.
    if finding.probability >= SURE || diagnosis.model_error.is_some() {
        return Ok(None);
    }
    let Ok(remaining) = Remaining::of(&diagnosis, None) else { return Ok(None) };
    let asked = PlanOptions::default();
    let Ok(plan) = TestPlan::between(&fixture, &remaining, &asked) else { return Ok(None) };
    let before = remaining.names.iter().map(|(effect, p)| (Name::of(effect), *p)).collect();
    let first = plan.suggestions.first();
    let after = match first {
        Some(first) => case.carried_out(&first.action, &recorded, &fixture, &remaining)?,
        None => Vec::new(),
    };
    let hidden = case.hidden();
    let separated = after.iter().any(|(name, probability)| *name == hidden && *probability >= SURE);
    Ok(Some(PlannedCase {
        case: number,
        hidden,
        recorded: case.pairs.clone(),
        before,
        first: first.map(|first| first.measure.clone()),
        promise: first.and_then(|first| first.sure).unwrap_or(0.0),
        expected_log_odds: first.and_then(|first| first.expected_log_odds).unwrap_or(0.0),
        after,
        separated,
    }))
}

/// The diagnosis of FRFs, with the fixture that it was made on.
fn linear(believed: &Fixture, frfs: &FrfSet) -> Option<(Fixture, Diagnosis)> {
    let answer = diagnose(believed, &Measurement::from(frfs.clone()), &Options::default(), |_| ()).ok()?;
    match answer.outcome {
        Outcome::Linear(diagnosis) => Some((answer.fixture, *diagnosis)),
        _ => None,
    }
}

/// What every finding may be, with its probability.
fn names(diagnosis: &Diagnosis) -> Vec<(Name, f64)> {
    let all = diagnosis.findings.iter().flat_map(|finding| {
        std::iter::once((&finding.effect, finding.probability))
            .chain(finding.alternatives.iter().map(|(effect, probability)| (effect, *probability)))
    });
    all.map(|(effect, probability)| (Name::of(effect), probability)).collect()
}

/// An assembly, what is hidden in it, and how it is measured.
struct PlanningCase {
    believed: Fixture,
    truth: Fixture,
    pairs: Vec<FrfPair>,
    hammer: HammerSetup,
}

impl PlanningCase {
    /// The case of a number; `None` where the fixture has no place for what is to be hidden.
    fn draw(seed: u64, number: usize) -> Result<Option<Self>, GenerationError> {
        let seed = seed_of(&format!("seed {seed} plan"), number);
        let mut random = generator(seed);
        // A deformable beam takes longest.
        let families: Vec<Family> = FAMILIES
            .iter()
            .map(|(_, family)| *family)
            .filter(|family| *family != Family::BeamAndBlock)
            .collect();
        let family = families[random.random_range(0..families.len())];
        let believed = family.draw("look-alikes", &mut random)?;
        let truth = drawn_within_tolerance(&believed, &mut random)?;
        let mut pairs = family.usual_pairs();
        pairs.shuffle(&mut random);
        pairs.truncate(random.random_range(1..=2));
        let kind = HIDDEN_KINDS[number % HIDDEN_KINDS.len()];
        let Some(effect) = random_effect(&mut random, &truth, kind, &pairs)? else { return Ok(None) };
        let truth = truth.with_physics(vec![effect]).map_err(StructureError::from)?;
        let hammer = drawn_hammer(&mut random, seed);
        Ok(Some(PlanningCase { believed, truth, pairs, hammer }))
    }

    fn hidden(&self) -> Name {
        Name::of(&self.truth.physics()[0])
    }

    /// A hammer test of a structure; each `round` has hits and noise of its own.
    fn measured(
        &self,
        structure: &Fixture,
        pairs: &[FrfPair],
        round: u64,
    ) -> Result<FrfSet, GenerationError> {
        let clean = frfs(structure, pairs, &recorded_lines()?, Instrument::AsDescribed)?;
        let hammer = HammerSetup { seed: self.hammer.seed.wrapping_add(round), ..self.hammer };
        Ok(hammer.measure(&clean)?)
    }

    /// Names and probabilities once `measure` was made.
    fn carried_out(
        &self,
        measure: &Measure,
        recorded: &FrfSet,
        fixture: &Fixture,
        remaining: &Remaining,
    ) -> Result<Vec<(Name, f64)>, GenerationError> {
        let again = |believed: &Fixture, frfs: &FrfSet| {
            linear(believed, frfs).map_or_else(Vec::new, |(_, diagnosis)| names(&diagnosis))
        };
        Ok(match measure {
            Measure::Quantity { path, std, .. } => {
                let mut random = generator(self.hammer.seed.wrapping_add(2));
                let error = deviate(&mut random);
                let mut truth = self.truth.clone();
                let value =
                    truth.quantities_mut().into_iter().find(|q| q.path == *path).map(|q| q.quantity.value);
                let mut believed = self.believed.clone();
                for quantity in believed.quantities_mut().into_iter().filter(|q| q.path == *path) {
                    *quantity.quantity = Quantity::with_std(value.unwrap_or(0.0) + std * error, *std);
                }
                again(&believed, recorded)
            }
            Measure::Averages { times } => {
                let hammer = HammerSetup { averages: self.hammer.averages * (times - 1), ..self.hammer };
                let more = PlanningCase {
                    hammer,
                    truth: self.truth.clone(),
                    believed: self.believed.clone(),
                    pairs: self.pairs.clone(),
                };
                let more = more.measured(&self.truth, &self.pairs, 1)?;
                again(&self.believed, &averaged(recorded, &more)?)
            }
            Measure::AddedMass { .. } | Measure::HungFreely => {
                let (Some(true_state), Some(state)) = (self.with(measure), measure.changed(fixture)) else {
                    return Ok(Vec::new());
                };
                let more = self.measured(&true_state, &self.pairs, 1)?;
                let observation = Observation::new(&more, |_| true)?;
                let options = PlanOptions::default();
                let weighed = weighed_by(fixture, remaining, (&state, &observation), &options);
                let names = weighed.map(|weighed| weighed.names).unwrap_or_default();
                names.into_iter().map(|name| (Name::of(&name.effect), name.probability)).collect()
            }
            _ => {
                let more = self.measured(&self.truth, &measure.frfs(), 1)?;
                again(&self.believed, &beside(recorded, &more)?)
            }
        })
    }

    /// The true structure as a measure changes it, what is fixed to it of a true size within its deviation.
    fn with(&self, measure: &Measure) -> Option<Fixture> {
        let mut random = generator(self.hammer.seed.wrapping_add(3));
        let stated = self.truth.physics().len();
        let changed = measure.changed(&self.truth)?;
        let mut physics = changed.physics().to_vec();
        for parameter in physics.iter_mut().skip(stated).flat_map(|effect| &mut effect.parameters) {
            if let Spread::Stated(std) = parameter.spread {
                *parameter = Quantity::bare(parameter.value + std * deviate(&mut random));
            }
        }
        changed.with_physics(physics).ok()
    }
}

/// A number of mean zero and variance one, near enough normal: the sum of twelve uniform ones.
fn deviate(random: &mut impl Rng) -> f64 {
    (0..12).map(|_| random.random_range(0.0..1.0)).sum::<f64>() - 6.0
}

/// The FRFs of both tests.
fn beside(one: &FrfSet, other: &FrfSet) -> Result<FrfSet, GenerationError> {
    let pairs = [one.pairs(), other.pairs()].concat();
    let values = [one.all_values(), other.all_values()].concat();
    let mut all = FrfSet::new(one.lines().clone(), FrfForm::Accelerance, pairs, values)?;
    let first = one.pairs().len();
    for (set, from) in [(one, 0), (other, first)] {
        for index in 0..set.pairs().len() {
            if let Some(coherence) = set.coherence(index) {
                all.set_coherence(from + index, coherence.to_vec())?;
            }
            all.set_averages(from + index, set.averages(index));
        }
    }
    Ok(all)
}

/// The same FRFs from the hits of both tests.
fn averaged(one: &FrfSet, other: &FrfSet) -> Result<FrfSet, GenerationError> {
    let averages = |set: &FrfSet, index: usize| set.averages(index).unwrap_or(1);
    let count = one.lines().len();
    let share = |index: usize| {
        let (own, more) = (f64::from(averages(one, index)), f64::from(averages(other, index)));
        own / (own + more)
    };
    let values = one.all_values().iter().zip(other.all_values()).enumerate();
    let values = values.map(|(at, (a, b))| a * share(at / count) + b * (1.0 - share(at / count))).collect();
    let mut all = FrfSet::new(one.lines().clone(), FrfForm::Accelerance, one.pairs().to_vec(), values)?;
    for index in 0..one.pairs().len() {
        if let (Some(a), Some(b)) = (one.coherence(index), other.coherence(index)) {
            // Noise by power of one hit: (1 − γ²)/γ².
            let noise = |gamma2: f64| (1.0 - gamma2) / gamma2.max(1e-6);
            let mean = |a: &f64, b: &f64| share(index) * noise(*a) + (1.0 - share(index)) * noise(*b);
            let coherence = a.iter().zip(b).map(|(a, b)| 1.0 / (1.0 + mean(a, b))).collect();
            all.set_coherence(index, coherence)?;
        }
        all.set_averages(index, Some(averages(one, index) + averages(other, index)));
    }
    Ok(all)
}
