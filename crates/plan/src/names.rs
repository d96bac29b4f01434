//! The names that a diagnosis has left for one finding, each at its best fit, with what the present
//! measurement tells of its parameters.

use crate::PlanError;
use crate::planned_test::PlannedTest;
use crate::settings::names::{
    FALSE_MINIMUM, LEAST_PROBABILITY, MOST_NAMES, SOUGHT_DEVIATION, UNKNOWN_DEVIATION,
};
use jointscope_diagnosis::{Diagnosis, Fit, Hypothesis, ModelError, Observation};
use jointscope_fixture::{Effect, Fixture, Place};
use jointscope_inference::{each, each_used_up};
use jointscope_linalg::Cholesky;
use jointscope_wording::effect_name;
use serde::Serialize;

/// A name that is left.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NameNow {
    /// Kind, place and dof.
    #[serde(flatten, serialize_with = "jointscope_findings::effect_name")]
    pub effect: Effect,
    /// Its probability, as the diagnosis states it.
    pub probability: f64,
}

/// A name, and how probable it is without a further test and with it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WeighedName {
    /// Kind, place and dof.
    #[serde(flatten, serialize_with = "jointscope_findings::effect_name")]
    pub effect: Effect,
    /// Its probability by both tests together.
    pub probability: f64,
    /// Its probability by the first alone, as the diagnosis states it.
    pub before: f64,
}

/// What a diagnosis has left open of one finding.
#[derive(Debug, Clone)]
pub struct Remaining {
    /// The repaired model: its quantities, and all effects found.
    pub repaired: Hypothesis,
    /// Which of its effects is in question.
    pub index: usize,
    /// Its names with their probabilities, its own first.
    pub names: Vec<(Effect, f64)>,
    /// FRFs and noise that the diagnosis rests on.
    pub observation: Observation,
    /// Error of the model with which the names were weighed, where they were weighed by modes.
    pub model_error: Option<ModelError>,
}

impl Remaining {
    /// What is open of finding `asked`, counted from 1; of the one that is named least surely without.
    ///
    /// # Errors
    /// A diagnosis without findings, or without another name for the one in question.
    pub fn of(diagnosis: &Diagnosis, asked: Option<usize>) -> Result<Self, PlanError> {
        let findings = &diagnosis.findings;
        let count = findings.len();
        let finding = match asked {
            Some(asked) => asked
                .checked_sub(1)
                .and_then(|i| findings.get(i))
                .ok_or(PlanError::NoSuchFinding { asked, count })?,
            None => {
                let open = findings.iter().filter(|finding| !finding.alternatives.is_empty());
                let open = open.min_by(|a, b| a.probability.total_cmp(&b.probability));
                open.or(findings.first()).ok_or(PlanError::NothingFound)?
            }
        };
        let others = finding.alternatives.iter().filter(|(_, probability)| *probability >= LEAST_PROBABILITY);
        let own = (finding.effect.clone(), finding.probability);
        let names: Vec<(Effect, f64)> = std::iter::once(own).chain(others.cloned()).collect();
        if names.len() < 2 {
            return Err(PlanError::NoAlternatives(effect_name(&finding.effect)));
        }
        let repaired = diagnosis.search.repaired.hypothesis.clone();
        let index = repaired.effects().iter().position(|effect| effect.is_named_as(&finding.effect));
        let index = index.ok_or(PlanError::NothingFound)?;
        let model_error =
            diagnosis.model_error.map(|[_, repaired]| repaired).filter(|error| !error.is_none());
        Ok(Remaining { repaired, index, names, observation: diagnosis.observation.clone(), model_error })
    }
}

impl Remaining {
    /// The names, and beside those of a reference that is the only one those of the force of all references:
    /// with one reference there is no such name, and what is measured next may have others. All of them have
    /// the probability that was stated together. Whether there are any is told as well.
    pub(crate) fn with_the_force(&self) -> (Vec<(Effect, f64)>, bool) {
        let pairs = self.observation.pairs();
        let only = |name: &str| pairs.iter().all(|pair| pair.reference.is_named(name));
        let of_the_force = |(effect, probability): &(Effect, f64)| match &effect.place {
            Place::Reference(name) if only(name) => {
                Some((Effect { place: Place::Force, ..effect.clone() }, *probability))
            }
            _ => None,
        };
        let more: Vec<(Effect, f64)> = self.names.iter().filter_map(of_the_force).collect();
        let any = !more.is_empty();
        let stated: f64 = self.names.iter().map(|(_, probability)| probability).sum();
        let mut all: Vec<(Effect, f64)> = self.names.iter().cloned().chain(more).collect();
        let total: f64 = all.iter().map(|(_, probability)| probability).sum();
        if any {
            all.iter_mut().for_each(|(_, probability)| *probability *= stated / total);
        }
        (all, any)
    }
}

/// One name at its best fit.
#[derive(Debug, Clone)]
pub(crate) struct Name {
    pub effect: Effect,
    /// As the diagnosis stated it.
    pub probability: f64,
    pub hypothesis: Hypothesis,
    /// Minus twice the logarithm of the evidence.
    pub cost: f64,
    /// Information on its coordinates, priors included.
    pub information: Vec<f64>,
}

/// The names, and the weight of physics that none of them covers against one for the best.
#[derive(Debug, Clone)]
pub(crate) struct Names {
    pub names: Vec<Name>,
    pub unlisted: f64,
    /// Variance inflation that the best leaves.
    pub inflation: f64,
    /// Whether the force of all references was added.
    pub added: bool,
}

impl Names {
    /// Fits every name to the present measurement, on a fixture that knows all points which are considered.
    pub(crate) fn fitted(
        remaining: &Remaining,
        observation: &Observation,
        fixture: &Fixture,
        exact: bool,
    ) -> Result<Self, PlanError> {
        let (mut names, added) = remaining.with_the_force();
        names.sort_by(|a, b| b.1.total_cmp(&a.1));
        let listed: f64 = names.iter().map(|(_, probability)| probability).sum();
        let highest = names.iter().map(|(_, probability)| *probability).fold(f64::MIN_POSITIVE, f64::max);
        names.truncate(MOST_NAMES);
        let other_effects = remaining.repaired.without(remaining.index).in_fixture(fixture, exact);
        let start = |effect: &Effect| other_effects.with(effect.clone());
        let fit = |effect: &Effect| {
            Fit::of(&start(effect), observation, false)
                .ok_or_else(|| PlanError::NotComparable(effect_name(effect)))
        };
        let fits: Vec<Fit> = each(&names, |(effect, _)| fit(effect)).into_iter().collect::<Result<_, _>>()?;
        let inflation = fits[0].inflation(observation);
        // Where its probability says that a name fits better than this fit, another way leads there.
        let cost = |fit: &Fit| fit.cost(inflation);
        let least = fits.iter().zip(&names).map(|(fit, (_, p))| cost(fit) + 2.0 * (p / highest).ln());
        let least = least.fold(f64::INFINITY, f64::min);
        let fits = each_used_up(fits.into_iter().zip(&names).collect(), |(own, (effect, probability))| {
            if cost(&own) > least - 2.0 * (probability / highest).ln() + FALSE_MINIMUM
                && let Some(other) = Fit::of(&start(effect), observation, true)
                && other.objective < own.objective
            {
                return other;
            }
            own
        });
        let whole = |((effect, probability), fit): (&(Effect, f64), Fit)| {
            // Of a comparison by modes lines tell the parameters, and not the odds.
            let cost = match remaining.model_error {
                Some(_) => -2.0 * probability.max(f64::MIN_POSITIVE).ln(),
                None => fit.cost(inflation),
            };
            let effect = fit.hypothesis.effects().pop().unwrap_or_else(|| effect.clone());
            Name {
                effect,
                probability: *probability,
                hypothesis: fit.hypothesis,
                cost,
                information: Vec::new(),
            }
        };
        let names = names.iter().zip(fits).map(whole).collect();
        let stated = remaining.names.iter().map(|(_, probability)| *probability).fold(highest, f64::max);
        Ok(Names { names, unlisted: (1.0 - listed).max(0.0) / stated, inflation, added })
    }

    /// Takes what the present measurement tells of every name's coordinates.
    pub(crate) fn with_information(
        mut self,
        test: &PlannedTest,
        observation: &Observation,
    ) -> Result<Self, PlanError> {
        let predict = |name: &mut Name| {
            let products = test.products_of(std::slice::from_ref(&name.hypothesis), observation)?;
            name.information = with_priors(&name.hypothesis, products.information(0));
            Some(())
        };
        for name in &mut self.names {
            predict(name).ok_or_else(|| PlanError::NotComparable(effect_name(&name.effect)))?;
        }
        Ok(self)
    }

    /// Weights now, one for the best: by the fits' costs, as the diagnosis has them.
    pub(crate) fn weights(&self) -> Vec<f64> {
        let least = self.names.iter().map(|name| name.cost).fold(f64::INFINITY, f64::min);
        self.names.iter().map(|name| (-0.5 * (name.cost - least)).exp()).collect()
    }

    /// The hypotheses.
    pub(crate) fn hypotheses(&self) -> Vec<Hypothesis> {
        self.names.iter().map(|name| name.hypothesis.clone()).collect()
    }

    /// Factors of the information on every name's coordinates.
    pub(crate) fn known(&self) -> Option<Vec<Cholesky>> {
        self.names.iter().map(|name| factor(&name.information)).collect()
    }

    /// The same for other states of the structure: coordinates that are the same are as well known, others as
    /// their priors say.
    pub(crate) fn known_in(&self, others: &[Hypothesis]) -> Option<Vec<Cholesky>> {
        let of = |(name, other): (&Name, &Hypothesis)| {
            factor(&carried(&name.information, &name.hypothesis, other))
        };
        self.names.iter().zip(others).map(of).collect()
    }
}

/// Information with the priors of a hypothesis; what nothing is known of has a wide one.
pub(crate) fn with_priors(hypothesis: &Hypothesis, information: Vec<f64>) -> Vec<f64> {
    with_widths(hypothesis, information, UNKNOWN_DEVIATION)
}

/// The same where what nothing is known of is looked for.
pub(crate) fn with_wide_priors(hypothesis: &Hypothesis, information: Vec<f64>) -> Vec<f64> {
    with_widths(hypothesis, information, SOUGHT_DEVIATION)
}

fn with_widths(hypothesis: &Hypothesis, mut information: Vec<f64>, unknown: f64) -> Vec<f64> {
    let count = hypothesis.parameters().len();
    for (m, parameter) in hypothesis.parameters().iter().enumerate() {
        let width = match parameter.high - parameter.low {
            range if range.is_finite() => (range / 12f64.sqrt()).min(unknown),
            _ => unknown,
        };
        let least = width.max(1e-6).powi(-2);
        information[m * count + m] += if parameter.precision > 0.0 { parameter.precision } else { least };
    }
    information
}

/// Information on the coordinates of `from` as one on those of `to`, the same hypothesis of the structure in
/// another state: what has no counterpart there, and what another state has anew, is as well known as it is
/// stated.
pub(crate) fn carried(information: &[f64], from: &Hypothesis, to: &Hypothesis) -> Vec<f64> {
    let (count, tolerances) = (from.parameters().len(), from.tolerances());
    // Where it was, and how much a step here is there.
    let place = |m: usize| match to.tolerances().get(m) {
        Some(tolerance) if tolerance.is_of_one_state() => None,
        Some(tolerance) => {
            let own = tolerances.iter().position(|own| own.quantity.path == tolerance.quantity.path)?;
            let value = to.ended_at(m);
            let [here, there] = [tolerance, &tolerances[own]].map(|t| t.parameter.transform.slope(value));
            (there != 0.0).then_some((own, here / there))
        }
        None => Some((m - to.tolerances().len() + tolerances.len(), 1.0)),
    };
    let order = to.parameters().len();
    let places: Vec<Option<(usize, f64)>> = (0..order).map(place).collect();
    let mut carried = vec![0.0; order * order];
    for i in 0..order {
        match places[i] {
            Some((own, step)) => {
                for (j, other) in places.iter().enumerate() {
                    let entry = |(other, along)| step * along * information[own * count + other];
                    carried[i * order + j] = other.map_or(0.0, entry);
                }
            }
            None => carried[i * order + i] = to.parameters()[i].precision.max(UNKNOWN_DEVIATION.powi(-2)),
        }
    }
    carried
}

fn factor(information: &[f64]) -> Option<Cholesky> {
    Cholesky::of(information.len().isqrt(), information)
}
