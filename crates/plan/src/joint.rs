//! What to measure for a narrower interval of a joint's stiffness or dashpots.
//!
//! The joint's own numbers are taken as free, whatever the fixture states of them; everything else is known
//! as the fixture says. Near the fit of the present FRFs, or of the fixture as it stands where there are
//! none, information adds up: J + J_new, with the covariance (J + J_new)⁻¹.

mod free;
mod wanted;

pub use wanted::{HalfWidth, Wanted};

use crate::candidates;
use crate::expected_noise::ExpectedNoise;
use crate::measure::Measure;
use crate::names::{carried, with_wide_priors};
use crate::plan::{FrfGain, Plan, PlanOptions};
use crate::planned_test::PlannedTest;
use crate::products::Products;
use crate::settings::interval::{LEAST_REDUCTION, MOST_TOGETHER, POOR_FIT, UNDETERMINED};
use crate::settings::noise::ASSUMED;
use crate::suggestion::{ExpectedInterval, Suggestion};
use crate::{PlanError, says};
use free::with_free_joint;
use jointscope_diagnosis::{Fit, Hypothesis, Observation};
use jointscope_fixture::Fixture;
use jointscope_inference::{Z95, each};
use jointscope_linalg::Cholesky;
use jointscope_spectra::{FrfPair, SpectralLines};

/// What a plan for an interval starts from.
#[derive(Debug, Clone)]
pub enum Start<'a> {
    /// FRFs that were recorded.
    Recorded(&'a Observation),
    /// The lines of a test that nobody has made.
    Lines(&'a SpectralLines),
}

impl Plan {
    /// Plans what makes an interval of a joint's element narrower. The joint's elements that are not zero are
    /// free; the fixture's own effects are taken as they are.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn for_interval(
        fixture: &Fixture,
        start: &Start,
        wanted: &Wanted,
        options: &PlanOptions,
    ) -> Result<Self, PlanError> {
        let present: &[FrfPair] = match start {
            Start::Recorded(observation) => observation.pairs(),
            Start::Lines(_) => &[],
        };
        let freed = with_free_joint(fixture, wanted)?;
        let points = candidates::points(fixture, &options.points, present)?;
        let freed = candidates::with_idle_points_exact(freed, &points, present);
        let nominal = Hypothesis::nominal(&freed, options.exact);
        let (hypothesis, lines, noise, inflation) = match start {
            Start::Recorded(observation) => {
                let not_fitted = || PlanError::NotComparable("the fixture".to_owned());
                let fit = Fit::of(&nominal, observation, true).ok_or_else(not_fitted)?;
                let inflation = fit.inflation(observation);
                (fit.hypothesis, observation.lines().clone(), ExpectedNoise::of(observation), inflation)
            }
            Start::Lines(lines) => {
                (nominal, (*lines).clone(), ExpectedNoise::assumed(lines.len(), ASSUMED.0, ASSUMED.1), 1.0)
            }
        };
        let test =
            PlannedTest { fixture: freed, exact: options.exact, lines, noise, inflation, model_error: None };
        Joints { test: &test, hypothesis: &hypothesis, start, wanted }.plan(&points)
    }
}

struct Joints<'a> {
    test: &'a PlannedTest,
    hypothesis: &'a Hypothesis,
    start: &'a Start<'a>,
    wanted: &'a Wanted,
}

/// A candidate, what it tells of the coordinates of its hypothesis, and what is known of them beforehand.
struct Candidate {
    measure: Measure,
    information: Vec<f64>,
    known: Option<(Hypothesis, Vec<f64>)>,
}

impl Joints<'_> {
    fn plan(&self, points: &[String]) -> Result<Plan, PlanError> {
        let not_comparable = || PlanError::NotComparable("the fixture".to_owned());
        let present: &[FrfPair] = match self.start {
            Start::Recorded(observation) => observation.pairs(),
            Start::Lines(_) => &[],
        };
        let names = std::slice::from_ref(self.hypothesis);
        let count = self.hypothesis.parameters().len();
        let again = match self.start {
            Start::Recorded(observation) => {
                Some(self.test.products_of(names, observation).ok_or_else(not_comparable)?.information(0))
            }
            Start::Lines(_) => None,
        };
        let known =
            with_wide_priors(self.hypothesis, again.clone().unwrap_or_else(|| vec![0.0; count * count]));
        let frfs = candidates::frfs(points, present);
        let by_frf = self.test.products(names, &frfs).ok_or_else(not_comparable)?;
        let all = self.candidates(points, (&frfs, &by_frf), again.as_deref(), (present, &known));
        // Before anything is recorded there is no interval.
        let now = again.as_ref().and_then(|_| self.interval(self.hypothesis, &known));
        let ranked = each(&all, |candidate| {
            let (hypothesis, known) =
                candidate.known.as_ref().map_or((self.hypothesis, &known), |(h, known)| (h, known));
            Some((self.interval(hypothesis, &added(known, &candidate.information))?, candidate))
        });
        let mut ranked: Vec<(f64, &Candidate)> = ranked.into_iter().flatten().collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let gain = |(interval, candidate): &(f64, &Candidate)| {
            FrfGain::of(&candidate.measure, interval / now.unwrap_or(*interval))
        };
        let gains = FrfGain::in_order(ranked.iter().filter_map(gain), &frfs);
        let reached_now = now.is_some_and(|now| self.wanted.reached(now, self.value()));
        let suggestions = if reached_now { Vec::new() } else { self.suggestions(ranked, now, present.len()) };
        let alone =
            suggestions.first().and_then(|first| first.interval.as_ref()).is_some_and(|first| first.reaches);
        let together = (!reached_now && !alone).then(|| self.together(&all, &known)).flatten();
        let question = format!("What makes the interval narrower: {}?", self.wanted.says());
        let (says, mut remarks) = self.comes_to(reached_now, now, &suggestions, together);
        if now.is_none() && self.test.inflation > POOR_FIT {
            remarks.push(says::not_met());
        }
        remarks.extend(says::remarks(&suggestions, self.test.inflation, false));
        if let Start::Lines(_) = self.start {
            remarks.push(format!(
                "Nothing was recorded yet: the noise is taken as {} % of each value and {} % of each FRF's root mean square",
                100.0 * ASSUMED.0,
                100.0 * ASSUMED.1
            ));
        }
        Ok(Plan {
            question,
            says,
            suggestions,
            names: Vec::new(),
            not_by_frfs: Vec::new(),
            frfs: gains,
            remarks,
            recorded: present.to_vec(),
        })
    }

    /// Everything that could be measured, with what it would tell.
    fn candidates(
        &self,
        points: &[String],
        (frfs, by_frf): (&[FrfPair], &[Products]),
        again: Option<&[f64]>,
        (present, known): (&[FrfPair], &[f64]),
    ) -> Vec<Candidate> {
        let count = self.hypothesis.parameters().len();
        let mut all: Vec<Candidate> = Vec::new();
        for measure in candidates::of_frfs(points, present) {
            let mut sum = Products::none(&[count]);
            for frf in measure.frfs() {
                frfs.iter().position(|own| *own == frf).into_iter().for_each(|at| sum.add(&by_frf[at]));
            }
            all.push(Candidate { measure, information: sum.information(0), known: None });
        }
        if let (Some(again), averages @ Measure::Averages { times }) = (again, candidates::averages()) {
            let information = again.iter().map(|entry| f64::from(times - 1) * entry).collect();
            all.push(Candidate { measure: averages, information, known: None });
        }
        all.extend(candidates::quantities(self.hypothesis).into_iter().filter_map(|m| self.of_quantity(m)));
        if !present.is_empty() {
            let changes = candidates::changes(&self.test.fixture, points);
            all.extend(changes.into_iter().filter_map(|measure| self.of_change(measure, present, known)));
        }
        all
    }

    /// What narrows the interval by enough: of what reaches it the least effort first, of the rest the
    /// narrowest.
    fn suggestions(
        &self,
        mut ranked: Vec<(f64, &Candidate)>,
        now: Option<f64>,
        recorded: usize,
    ) -> Vec<Suggestion> {
        ranked.retain(|(interval, _)| now.is_none_or(|now| *interval <= (1.0 - LEAST_REDUCTION) * now));
        let value = self.value();
        let effort = |candidate: &Candidate| candidate.measure.effort(recorded);
        let key = |(interval, candidate): &(f64, &Candidate)| match self.wanted.reached(*interval, value) {
            true => (0.0, effort(candidate), *interval),
            false => (1.0, *interval, 0.0),
        };
        ranked.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
        let suggestion = |(then, candidate): (f64, &Candidate)| {
            self.suggestion(&candidate.measure, now, then, effort(candidate))
        };
        ranked.into_iter().map(suggestion).collect()
    }

    fn comes_to(
        &self,
        reached_now: bool,
        now: Option<f64>,
        suggestions: &[Suggestion],
        together: Option<(Vec<String>, f64)>,
    ) -> (String, Vec<String>) {
        let unit = self.wanted.key().unit();
        let at_present = match (now, self.start) {
            (Some(now), _) => format!(" It is ± {} {unit} at present.", says::three(now)),
            (None, Start::Recorded(_)) => " What was recorded does not determine it.".to_owned(),
            (None, Start::Lines(_)) => String::new(),
        };
        if reached_now {
            return (format!("The interval is as narrow as wanted already.{at_present}"), Vec::new());
        }
        let alone = suggestions.iter().any(|s| s.interval.as_ref().is_some_and(|interval| interval.reaches));
        let says = match (suggestions.first(), alone) {
            (None, _) if now.is_none() => {
                format!("Nothing that was considered determines the element.{at_present}")
            }
            (None, _) => format!("Nothing that was considered makes the interval narrower.{at_present}"),
            (Some(best), true) => format!("{}.{at_present}", says::to_do(&best.action)),
            (Some(best), false) => {
                format!(
                    "No single measurement makes it as narrow as wanted; the best is: {}.{at_present}",
                    says::to_do(&best.action)
                )
            }
        };
        let remarks = together.map(|(measures, interval)| {
            let value = self.value();
            let reaches = if self.wanted.reached(interval, value) { ", as narrow as wanted" } else { "" };
            format!("Together {} leave ± {} {unit}{reaches}", measures.join(", "), says::three(interval))
        });
        (says, remarks.into_iter().collect())
    }

    /// Where the wanted element is among the coordinates of a hypothesis.
    fn index(&self, hypothesis: &Hypothesis) -> Option<usize> {
        let joint = format!("joints/{}/", self.wanted.joint);
        let is_it = |quantity: &jointscope_fixture::NamedQuantity| {
            quantity.key == self.wanted.key() && quantity.path.starts_with(&joint)
        };
        hypothesis.tolerances().iter().position(|tolerance| is_it(&tolerance.quantity))
    }

    fn value(&self) -> f64 {
        self.index(self.hypothesis).map_or(f64::NAN, |index| self.hypothesis.ended_at(index))
    }

    /// Half of the 95 % interval with this information; nothing where the element is not determined.
    fn interval(&self, hypothesis: &Hypothesis, information: &[f64]) -> Option<f64> {
        let index = self.index(hypothesis)?;
        let order = hypothesis.parameters().len();
        let factor = Cholesky::of(order, information)?;
        let mut unit = vec![0.0; order];
        unit[index] = 1.0;
        factor.solve_lower_in_place(&mut unit);
        let std = unit.iter().map(|u| u * u).sum::<f64>().sqrt();
        let slope = hypothesis.parameters()[index].transform.slope(hypothesis.ended_at(index));
        let stated = hypothesis.tolerances().get(index)?.quantity.value.abs();
        // What is not a number is no interval either.
        Some(Z95 * std * slope.abs()).filter(|interval| *interval <= UNDETERMINED * stated)
    }

    fn suggestion(&self, measure: &Measure, now: Option<f64>, then: f64, effort: f64) -> Suggestion {
        let key = self.wanted.key();
        let value = self.value();
        let (which, row, column) = self.wanted.element;
        let interval = ExpectedInterval {
            element: format!("{which}{row}{column} of joint {}", self.wanted.joint),
            value,
            unit: key.unit(),
            now,
            then,
            reaches: self.wanted.reached(then, value),
        };
        Suggestion {
            measure: measure.to_string(),
            to_do: says::to_do(measure),
            action: measure.clone(),
            expected_log_odds: None,
            box_hill: None,
            sure: None,
            separates: Vec::new(),
            says: says::of_interval(measure, &interval),
            interval: Some(interval),
            effort,
        }
    }

    fn of_quantity(&self, measure: Measure) -> Option<Candidate> {
        let Measure::Quantity { path, std, .. } = &measure else { return None };
        let at = self.hypothesis.tolerances().iter().position(|t| t.quantity.path == *path)?;
        let slope = self.hypothesis.parameters()[at].transform.slope(self.hypothesis.ended_at(at));
        let count = self.hypothesis.parameters().len();
        let mut information = vec![0.0; count * count];
        information[at * count + at] = (slope / std).powi(2);
        Some(Candidate { measure, information, known: None })
    }

    fn of_change(&self, measure: Measure, present: &[FrfPair], known: &[f64]) -> Option<Candidate> {
        let fixture = measure.changed(&self.test.fixture)?;
        let hypothesis = self.hypothesis.in_state(&fixture, self.test.exact);
        let by_frf = self.test.products(std::slice::from_ref(&hypothesis), present)?;
        let mut sum = Products::none(&by_frf.first()?.widths);
        by_frf.iter().for_each(|own| sum.add(own));
        let carried = carried(known, self.hypothesis, &hypothesis);
        Some(Candidate { measure, information: sum.information(0), known: Some((hypothesis, carried)) })
    }

    /// The best first, then the best beside that, until the interval is as narrow as wanted: of single FRFs
    /// and quantities.
    fn together(&self, all: &[Candidate], known: &[f64]) -> Option<(Vec<String>, f64)> {
        let single = |candidate: &&Candidate| {
            matches!(candidate.measure, Measure::Frf { .. } | Measure::Quantity { .. })
        };
        let mut left: Vec<&Candidate> = all.iter().filter(single).collect();
        let (mut known, mut chosen) = (known.to_vec(), Vec::new());
        let mut interval = f64::INFINITY;
        while chosen.len() < MOST_TOGETHER && !self.wanted.reached(interval, self.value()) {
            let with = |(place, candidate): (usize, &&Candidate)| {
                Some((self.interval(self.hypothesis, &added(&known, &candidate.information))?, place))
            };
            let best = left.iter().enumerate().filter_map(with).min_by(|a, b| a.0.total_cmp(&b.0));
            let (narrowest, place) =
                best.filter(|(narrowest, _)| *narrowest < (1.0 - LEAST_REDUCTION) * interval)?;
            let candidate = left.swap_remove(place);
            known = added(&known, &candidate.information);
            chosen.push(candidate.measure.to_string());
            interval = narrowest;
        }
        (chosen.len() > 1).then_some((chosen, interval))
    }
}

fn added(known: &[f64], information: &[f64]) -> Vec<f64> {
    known.iter().zip(information).map(|(known, information)| known + information).collect()
}
