//! Candidates ranked by what they would do for the names that are left.

use crate::candidates;
use crate::error::PlanError;
use crate::expected_noise::ExpectedNoise;
use crate::measure::Measure;
use crate::model_error::ModelErrorNoise;
use crate::names::{NameNow, Names, Remaining};
use crate::planned_test::PlannedTest;
use crate::products::Products;
use crate::rivals::{ExpectedOutcome, Rivals};
use crate::says;
use crate::settings::outcome::{SEED, SURE};
use crate::settings::ranking::{LEAST_LOG_ODDS, MOST_COMBINED, MOST_DRAWN, PROMISE_STEPS, SEPARATED};
use crate::suggestion::Suggestion;
use jointscope_diagnosis::{Hypothesis, Observation};
use jointscope_fixture::{Effect, Fixture, Place};
use jointscope_inference::{each, each_used_up};
use jointscope_linalg::Cholesky;
use jointscope_spectra::FrfPair;
use jointscope_wording::effect_name;
use serde::Serialize;

/// What to consider.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanOptions {
    /// Points between which FRFs are considered; empty for all of a small structure.
    pub points: Vec<String>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
}

/// What to measure next, and what it is for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// What is to be found out, in a sentence.
    pub question: String,
    /// What the plan comes to, in a sentence.
    pub says: String,
    /// What may be measured, the best first; empty where nothing helps.
    pub suggestions: Vec<Suggestion>,
    /// The names that are left, the most probable first; of a plan for look-alikes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<NameNow>,
    /// Pairs of names that all FRFs between the points considered, together, do not tell apart.
    pub not_by_frfs: Vec<[String; 2]>,
    /// Every FRF considered, in the order of points; of those that are recorded, none.
    pub frfs: Vec<FrfGain>,
    /// What a reader should know besides, one plain sentence each.
    pub remarks: Vec<String>,
    /// The FRFs recorded so far.
    pub recorded: Vec<FrfPair>,
}

/// What one more FRF would bring.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrfGain {
    /// The FRF.
    pub frf: FrfPair,
    /// Expected ln of the odds for the true name against its nearest rival, nats; for an interval its
    /// half-width then over that at present.
    pub gain: f64,
}

impl FrfGain {
    /// What a measurement of one FRF gains; nothing of another measurement.
    pub(crate) fn of(measure: &Measure, gain: f64) -> Option<Self> {
        match measure {
            Measure::Frf { frf } => Some(FrfGain { frf: frf.clone(), gain }),
            _ => None,
        }
    }

    /// Gains in the order of these FRFs.
    pub(crate) fn in_order(gains: impl Iterator<Item = Self>, frfs: &[FrfPair]) -> Vec<Self> {
        let mut gains: Vec<Self> = gains.collect();
        gains.sort_by_key(|gain| frfs.iter().position(|frf| *frf == gain.frf));
        gains
    }
}

impl Plan {
    /// Plans what separates the names that a diagnosis has left. `fixture` is the one that was diagnosed.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn between(
        fixture: &Fixture,
        remaining: &Remaining,
        options: &PlanOptions,
    ) -> Result<Self, PlanError> {
        let observation = &remaining.observation;
        let present = observation.pairs();
        let points = candidates::points(fixture, &options.points, present)?;
        let fixture = candidates::with_idle_points_exact(fixture.clone(), &points, present);
        let model = remaining.repaired.in_fixture(&fixture, options.exact);
        let model_error = remaining.model_error.map(|error| ModelErrorNoise::of(&error, &model, observation));
        let with_model_error =
            model_error.and_then(|model_error| model_error.with_model_error(&model, observation));
        let observation = with_model_error.as_ref().unwrap_or(observation);
        let names = Names::fitted(remaining, observation, &fixture, options.exact)?;
        let test = PlannedTest {
            fixture,
            exact: options.exact,
            lines: observation.lines().clone(),
            noise: ExpectedNoise::of(&remaining.observation),
            inflation: names.inflation,
            model_error,
        };
        let names = names.with_information(&test, observation)?;
        let judge = Judge { test: &test, names: &names, observation, hypotheses: names.hypotheses() };
        judge.plan(&points)
    }
}

/// A candidate with what it would record.
struct Candidate {
    measure: Measure,
    products: Products,
    /// What is known beforehand, where the coordinates are not those at present.
    known: Option<Vec<Cholesky>>,
}

struct Judge<'a> {
    test: &'a PlannedTest,
    names: &'a Names,
    observation: &'a Observation,
    hypotheses: Vec<Hypothesis>,
}

impl Judge<'_> {
    fn plan(&self, points: &[String]) -> Result<Plan, PlanError> {
        let not_comparable = || PlanError::NotComparable(effect_name(&self.names.names[0].effect));
        let known = self.names.known().ok_or_else(not_comparable)?;
        let present = self.observation.pairs();
        let frfs = candidates::frfs(points, present);
        let by_frf = self.test.products(&self.hypotheses, &frfs).ok_or_else(not_comparable)?;
        let rivals = |candidate: &Candidate| {
            Rivals::of(&candidate.products, candidate.known.as_deref().unwrap_or(&known))
        };
        let judged = |candidate: Candidate| {
            let rivals = rivals(&candidate)?;
            Some((self.expected(&rivals), candidate, rivals))
        };
        let candidates = self.candidates(points, &frfs, &by_frf);
        let mut ranked: Vec<(f64, Candidate, Rivals)> =
            each_used_up(candidates, judged).into_iter().flatten().collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let both = self.pairs_of_frfs(&ranked);
        let single = |(gain, candidate, _): &(f64, Candidate, Rivals)| FrfGain::of(&candidate.measure, *gain);
        let gains = FrfGain::in_order(ranked.iter().filter_map(single), &frfs);
        ranked.retain(|(gain, ..)| *gain >= LEAST_LOG_ODDS);
        ranked.truncate(MOST_DRAWN);
        let weights = self.names.weights();
        let drawn = |(gain, candidate, rivals): &(f64, Candidate, Rivals)| {
            let outcome = rivals.expected_outcome(&weights, self.names.unlisted, SEED);
            self.suggestion(candidate, *gain, &outcome)
        };
        let mut suggestions: Vec<Suggestion> = each(&ranked, drawn);
        // Where one measurement does not do it, two FRFs may.
        if suggestions.iter().all(|suggestion| suggestion.sure.is_none_or(|sure| sure < SURE)) {
            let both = each_used_up(both, judged).into_iter().flatten();
            let both: Vec<(f64, Candidate, Rivals)> =
                both.filter(|(gain, ..)| *gain >= LEAST_LOG_ODDS).collect();
            suggestions.extend(each(&both, drawn));
        }
        suggestions.sort_by(|a, b| order(b).partial_cmp(&order(a)).unwrap_or(std::cmp::Ordering::Equal));
        let not_by_frfs = self.not_by_frfs(&by_frf, &known);
        let names = self.names.names.iter();
        let names: Vec<NameNow> = names
            .map(|name| NameNow { effect: name.effect.clone(), probability: name.probability })
            .collect();
        Ok(Plan {
            question: says::question(&names),
            says: says::comes_to(&names, &suggestions, &not_by_frfs),
            remarks: says::sure_already(&names)
                .into_iter()
                .chain(self.names.added.then(says::added_names))
                .chain(says::remarks(&suggestions, self.names.inflation, self.test.model_error.is_some()))
                .collect(),
            recorded: present.to_vec(),
            suggestions,
            names,
            not_by_frfs,
            frfs: gains,
        })
    }

    /// The names that all FRFs together leave unseparated.
    fn not_by_frfs(&self, by_frf: &[Products], known: &[Cholesky]) -> Vec<[String; 2]> {
        let Some(first) = by_frf.first() else { return Vec::new() };
        let mut whole = Products::none(&first.widths);
        by_frf.iter().for_each(|products| whole.add(products));
        Rivals::of(&whole, known).map_or_else(Vec::new, |rivals| {
            let outcome = rivals.expected_outcome(&self.names.weights(), self.names.unlisted, SEED);
            self.pairs(&outcome, |apart| apart < SEPARATED)
        })
    }

    /// Everything that could be measured, with the products of what the names predict of it.
    fn candidates(&self, points: &[String], frfs: &[FrfPair], by_frf: &[Products]) -> Vec<Candidate> {
        let present = self.observation.pairs();
        let here = |measure: Measure, products: Products| Candidate { measure, products, known: None };
        let widths = self.hypotheses.iter().map(|h| h.parameters().len()).collect::<Vec<_>>();
        let sum = |measure: &Measure| {
            let mut sum = Products::none(&widths);
            for frf in measure.frfs() {
                let at = frfs.iter().position(|known| *known == frf);
                at.into_iter().for_each(|at| sum.add(&by_frf[at]));
            }
            sum
        };
        let mut all: Vec<Candidate> = candidates::of_frfs(points, present)
            .into_iter()
            .map(|measure| {
                let products = sum(&measure);
                here(measure, products)
            })
            .collect();
        if let Some(again) = self.test.products_of(&self.hypotheses, self.observation)
            && let averages @ Measure::Averages { times } = candidates::averages()
        {
            all.push(here(averages, again.times(f64::from(times) - 1.0)));
        }
        for measure in candidates::quantities(&self.hypotheses[0]) {
            all.extend(self.of_quantity(&measure).map(|products| here(measure, products)));
        }
        let changes = candidates::changes(&self.test.fixture, points);
        all.extend(changes.into_iter().filter_map(|measure| self.of_change(measure, present)));
        all
    }

    /// Two FRFs at a time, of those that tell some two of the names apart best.
    fn pairs_of_frfs(&self, ranked: &[(f64, Candidate, Rivals)]) -> Vec<Candidate> {
        let count = self.names.names.len();
        let single: Vec<(&FrfPair, &Products, &Rivals)> = ranked
            .iter()
            .filter_map(|(_, candidate, rivals)| match &candidate.measure {
                Measure::Frf { frf } => Some((frf, &candidate.products, rivals)),
                _ => None,
            })
            .collect();
        let mut best: Vec<usize> = Vec::new();
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            let divergence = |at: &usize| single[*at].2.divergence(i, j);
            let most = (0..single.len()).max_by(|a, b| divergence(a).total_cmp(&divergence(b)));
            best.extend(most.filter(|at| !best.contains(at)));
        }
        best.truncate(MOST_COMBINED);
        let both = |(a, b): (usize, usize)| {
            let mut products = single[a].1.clone();
            products.add(single[b].1);
            let frfs = vec![single[a].0.clone(), single[b].0.clone()];
            Candidate { measure: Measure::Frfs { frfs }, products, known: None }
        };
        // Beside the best for some two names, all others.
        let pairs = best.iter().flat_map(|&a| (0..single.len()).map(move |b| (a, b)));
        pairs.filter(|(a, b)| a < b || !best.contains(b) && a != b).map(both).collect()
    }

    /// The present FRFs of the structure with something fixed to it.
    fn of_change(&self, measure: Measure, present: &[FrfPair]) -> Option<Candidate> {
        let fixture = measure.changed(&self.test.fixture)?;
        let hypotheses: Vec<Hypothesis> =
            self.hypotheses.iter().map(|own| own.in_state(&fixture, self.test.exact)).collect();
        let by_frf = self.test.products(&hypotheses, present)?;
        let mut products = Products::none(&by_frf.first()?.widths);
        by_frf.iter().for_each(|own| products.add(own));
        Some(Candidate { measure, products, known: Some(self.names.known_in(&hypotheses)?) })
    }

    /// A quantity by itself: what every name expects of it, in deviations.
    fn of_quantity(&self, measure: &Measure) -> Option<Products> {
        let Measure::Quantity { path, std, .. } = measure else { return None };
        let mut weight = 0.0;
        let of = |hypothesis: &Hypothesis| {
            let at = hypothesis.tolerances().iter().position(|tolerance| tolerance.quantity.path == *path)?;
            let transform = hypothesis.parameters()[at].transform;
            // What an effect calls wrong has the value that the effect gives it.
            let called_wrong =
                |effect: &Effect| matches!(&effect.place, Place::Quantity(other, _) if other == path);
            let effect = hypothesis.effects().iter().position(called_wrong);
            let at = effect.map_or(at, |effect| hypothesis.range_of(effect).start);
            let coordinate = *hypothesis.coordinates().get(at)?;
            let slope = transform.slope(transform.value(coordinate)?);
            let mut derivatives = vec![0.0; hypothesis.parameters().len()];
            derivatives[at] = 1.0;
            Some(((coordinate, derivatives), (slope / std).powi(2)))
        };
        let mut names = Vec::with_capacity(self.hypotheses.len());
        for hypothesis in &self.hypotheses {
            let (name, precision) = of(hypothesis)?;
            weight = precision;
            names.push(name);
        }
        Some(Products::of_number(&names, weight))
    }

    /// Expected ln of the Bayes factor for the true name against its nearest rival, over the names as
    /// probable as they are.
    fn expected(&self, rivals: &Rivals) -> f64 {
        let weights = self.names.weights();
        let total: f64 = weights.iter().sum();
        let count = weights.len();
        let nearest = |i: usize| {
            (0..count).filter(|j| *j != i).map(|j| rivals.divergence(i, j)).fold(f64::INFINITY, f64::min)
        };
        (0..count).map(|i| weights[i] / total * nearest(i)).sum()
    }

    fn suggestion(&self, candidate: &Candidate, expected: f64, outcome: &ExpectedOutcome) -> Suggestion {
        let weights = self.names.weights();
        let total: f64 = weights.iter().sum();
        let count = weights.len();
        let pair = |i: usize, j: usize| weights[i] * weights[j] / total / total * outcome.divergence[i][j];
        let box_hill =
            (0..count).flat_map(|i| (0..count).map(move |j| (i, j))).map(|(i, j)| pair(i, j)).sum();
        let separates = self.pairs(outcome, |apart| apart >= SEPARATED);
        let effort = candidate.measure.effort(self.observation.pairs().len());
        Suggestion {
            measure: candidate.measure.to_string(),
            to_do: says::to_do(&candidate.measure),
            action: candidate.measure.clone(),
            expected_log_odds: Some(expected),
            box_hill: Some(box_hill),
            sure: Some(outcome.sure),
            says: says::of_names(&candidate.measure, expected, outcome.sure, &separates, count),
            separates,
            interval: None,
            effort,
        }
    }

    /// The pairs of names of which this holds true, the more probable first.
    fn pairs(&self, outcome: &ExpectedOutcome, holds: impl Fn(f64) -> bool) -> Vec<[String; 2]> {
        let label = |i: usize| effect_name(&self.names.names[i].effect);
        let count = self.names.names.len();
        let all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        all.filter(|&(i, j)| holds(outcome.separated[i][j])).map(|(i, j)| [label(i), label(j)]).collect()
    }
}

/// The better first: the promise; among those that keep it, the less effort; then what is expected.
fn order(suggestion: &Suggestion) -> (f64, f64, f64) {
    let sure = (suggestion.sure.unwrap_or(0.0) * PROMISE_STEPS).round() / PROMISE_STEPS;
    let effort = if sure >= SURE { -suggestion.effort } else { 0.0 };
    (sure, effort, suggestion.expected_log_odds.unwrap_or(0.0))
}
