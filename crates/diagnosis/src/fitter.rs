//! Fits of hypotheses to an observation: from nearby, and from afar by stages in which a share of the signal
//! counts as noise.

use crate::settings::Settings;
use crate::{Fit, Hypothesis, Linearisation, Observation, Watch};
use jointscope_inference::{
    Convergence, DerivativePrecision, LeastSquares, Limit, NormalEquations, descend, each,
};
use num_complex::Complex64;
use std::borrow::Cow;

/// An observation with the settings by which hypotheses are fitted to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fitter<'a> {
    pub observation: &'a Observation,
    pub settings: &'a Settings,
    pub watch: Watch<'a>,
}

/// A fit under way: where it stands, and derivatives taken there or on the way.
pub(crate) struct Iterate {
    pub hypothesis: Hypothesis,
    pub predicted: Vec<Complex64>,
    linear: Option<Linearisation>,
}

/// The FRFs of an observation with a share of the signal, `inflation`, counted as noise; `FIXED` where there
/// is none of that, so that the weights stay.
struct Problem<'a, const FIXED: bool> {
    fitter: Fitter<'a>,
    inflation: f64,
}

/// How far one stage of a fit goes.
struct Stage {
    inflation: f64,
    /// Convergence as a share of the objective, where noise is inflated.
    share: f64,
    /// Objective to be reached, where noise is not inflated.
    limit: f64,
}

impl<'a, const FIXED: bool> LeastSquares for Problem<'a, FIXED> {
    type Point = Iterate;
    type Weights = Cow<'a, [f64]>;
    type Derivatives = Linearisation;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = FIXED;

    fn weights(&self, at: &Iterate) -> Cow<'a, [f64]> {
        self.fitter.observation.inflated_weights(&at.predicted, self.inflation)
    }

    fn objective(&self, at: &Iterate, weights: &Cow<'a, [f64]>) -> f64 {
        self.fitter.observation.weighted_squares(&at.predicted, weights) + at.hypothesis.squared_departures()
    }

    fn derivatives(&self, at: &Iterate, precision: DerivativePrecision) -> Option<Linearisation> {
        let Fitter { observation, settings, .. } = self.fitter;
        Some(match precision {
            DerivativePrecision::Exact => self.fitter.linearised(&at.hypothesis),
            DerivativePrecision::Rough => {
                Linearisation::forward(&at.hypothesis, &at.predicted, observation, settings.fit.difference)
            }
        })
    }

    fn equations(&self, at: &Iterate, linear: &Linearisation, weights: &Cow<'a, [f64]>) -> NormalEquations {
        linear.equations(&at.hypothesis, weights, &self.fitter.observation.residual(&at.predicted))
    }

    fn stepped(&self, at: &Iterate, equations: &NormalEquations, damping: f64) -> Option<Iterate> {
        let step = equations.bounded_step(damping, &at.hypothesis.coordinates, at.hypothesis.parameters())?;
        self.fitter.iterate(at.hypothesis.stepped(&step))
    }

    fn shortened(&self, at: &Iterate, equations: &NormalEquations, share: f64) -> Option<Iterate> {
        let step = equations.bounded_step(0.0, &at.hypothesis.coordinates, at.hypothesis.parameters())?;
        let step: Vec<f64> = step.iter().map(|step| share * step).collect();
        self.fitter.iterate(at.hypothesis.stepped(&step))
    }

    fn corrected(
        &self,
        at: &Iterate,
        from: &Iterate,
        [own, equations]: [&NormalEquations; 2],
        share: f64,
    ) -> Option<Iterate> {
        let coordinates = &at.hypothesis.coordinates;
        let earlier = (equations, from.hypothesis.coordinates.as_slice());
        let across = own.correction(coordinates, earlier, share, at.hypothesis.parameters())?;
        self.fitter.iterate(at.hypothesis.stepped(&across))
    }

    fn promised(&self, at: &Iterate, equations: &NormalEquations) -> f64 {
        equations.promised(&at.hypothesis.coordinates, at.hypothesis.parameters())
    }
}

impl<'a> Fitter<'a> {
    /// The same settings on another observation.
    pub(crate) fn on<'b>(self, observation: &'b Observation) -> Fitter<'b>
    where
        'a: 'b,
    {
        Fitter { observation, ..self }
    }

    /// The observation on the few lines of a thinned fit.
    pub(crate) fn thinned(&self) -> Observation {
        self.observation.thinned(self.settings.fit.thinned_lines)
    }

    /// A fit's first iterate; `None` where the hypothesis predicts no finite FRFs.
    pub(crate) fn iterate(&self, hypothesis: Hypothesis) -> Option<Iterate> {
        let predicted = hypothesis.predict(self.observation).ok()?;
        Some(Iterate { hypothesis, predicted, linear: None })
    }

    /// Central differences about a hypothesis.
    pub(crate) fn linearised(&self, at: &Hypothesis) -> Linearisation {
        Linearisation::default().extended(at, self.observation, |_| self.settings.fit.difference)
    }

    /// Central differences by steps so small that every digit counts which rounding leaves: for
    /// uncertainties.
    pub(crate) fn linearised_exactly(&self, at: &Hypothesis) -> Linearisation {
        let difference = self.settings.fit.difference;
        let (change, least) = self.settings.fit.small_difference;
        let small = |m: usize| {
            let predicted =
                [0.0, difference].map(|step| at.predict_moved(m, step, (None, None), self.observation));
            let [Ok(here), Ok(there)] = predicted else { return difference };
            let relative = |(a, b): (&Complex64, &Complex64)| (a - b).norm() / a.norm().max(b.norm());
            let changes = here.iter().zip(&there).map(relative).filter(|c| c.is_finite());
            difference * (change / changes.fold(0.0, f64::max)).clamp(least, 1.0)
        };
        Linearisation::default().extended(at, self.observation, small)
    }

    /// The normal equations of a hypothesis at its optimum, for uncertainties.
    pub(crate) fn information(&self, at: &Hypothesis) -> NormalEquations {
        let residual = vec![Complex64::ZERO; self.observation.values().len()];
        self.linearised_exactly(at).equations(at, self.observation.weights(), &residual)
    }

    /// Goes on with a fit by one stage; with its objective at the end of it, by the weights that hold there.
    fn improve(&self, at: Iterate, stage: &Stage) -> Option<(Iterate, f64)> {
        let own = &self.settings.fit;
        let whole = stage.inflation == 0.0;
        let limit = Limit { objective: stage.limit, ..own.limit };
        let degrees = self.observation.degrees() as f64;
        let settings = jointscope_inference::Settings {
            steps: if whole { own.steps.1 } else { own.steps.0 },
            damping: own.damping,
            convergence: match whole {
                true => Convergence { gain: own.converged, share: own.negligible, floor: degrees },
                false => Convergence { gain: 0.0, share: stage.share, floor: 0.0 },
            },
            reuse: Some(own.reuse),
            exact_at_end: whole,
            limit: (whole && limit.objective.is_finite()).then_some(limit),
            valleys: if whole { own.valleys } else { 0 },
            curved_valley: if whole { own.curved_valley } else { 0.0 },
            ..Default::default()
        };
        let Iterate { hypothesis, predicted, linear } = at;
        let start = Iterate { hypothesis, predicted, linear: None };
        let (end, objective) = if whole {
            let problem = Problem::<true> { fitter: *self, inflation: 0.0 };
            let end = descend(&problem, start, linear, &settings)?;
            let objective = end.objective;
            (end, objective)
        } else {
            let problem = Problem::<false> { fitter: *self, inflation: stage.inflation };
            let end = descend(&problem, start, linear, &settings)?;
            let objective = problem.objective(&end.point, &problem.weights(&end.point));
            (end, objective)
        };
        Some((Iterate { linear: Some(end.derivatives), ..end.point }, objective))
    }

    /// A stage with inflated noise.
    fn improve_inflated(&self, at: Iterate, inflation: f64) -> Option<(Iterate, f64)> {
        let share = self.settings.fit.inflated;
        self.improve(at, &Stage { inflation, share, limit: f64::INFINITY })
    }

    /// A stage with inflated noise of a fit that many others are compared with.
    pub(crate) fn improve_among_many(&self, at: Iterate, inflation: f64) -> Option<(Iterate, f64)> {
        let share = self.settings.fit.inflated_among_many;
        self.improve(at, &Stage { inflation, share, limit: f64::INFINITY })
    }

    /// The last stage, without inflation, given up where it will hardly come below `limit`.
    fn end(&self, at: Iterate, limit: f64) -> Option<Fit> {
        let (at, _) = self.improve(at, &Stage { inflation: 0.0, share: 0.0, limit })?;
        Some(self.fit(at))
    }

    fn inflated(&self, start: &Hypothesis, stages: &[f64]) -> Option<Fit> {
        let mut at = (self.iterate(start.clone())?, f64::INFINITY);
        for &inflation in stages {
            at = self.improve_inflated(at.0, inflation)?;
        }
        Some(Fit { objective: at.1, ..self.fit(at.0) })
    }

    /// The stages of a fit from afar on a thinned observation, which this is: good enough to compare
    /// hypotheses by. Its objective is that of the last stage.
    pub(crate) fn on_thinned_lines(&self, start: &Hypothesis) -> Option<Fit> {
        self.inflated(start, &self.settings.fit.inflation.0)
    }

    /// The last stage with inflated noise, on all lines; its objective is that stage's.
    pub(crate) fn on_whole_lines(&self, start: &Hypothesis) -> Option<Fit> {
        self.inflated(start, &[self.settings.fit.inflation.1])
    }

    fn fit(&self, at: Iterate) -> Fit {
        let chi2 = self.observation.chi2(&at.predicted);
        let objective = chi2 + at.hypothesis.squared_departures();
        Fit { hypothesis: at.hypothesis, predicted: at.predicted, chi2, objective }
    }

    /// A fit from nearby, given up where it will hardly come below `limit`, with derivatives of the first
    /// coordinates where these are known.
    ///
    /// `None` where the start predicts no finite FRFs.
    pub(crate) fn local(
        &self,
        start: &Hypothesis,
        nearby: Option<&Linearisation>,
        limit: f64,
    ) -> Option<Fit> {
        let difference = self.settings.fit.difference;
        let extended =
            |linear: &Linearisation| linear.clone().extended(start, self.observation, |_| difference);
        let at = self.iterate(start.clone())?;
        self.end(Iterate { linear: nearby.map(extended), ..at }, limit)
    }

    /// A fit from afar: stages on thinned lines first, then on all.
    pub(crate) fn global(&self, start: &Hypothesis) -> Option<Fit> {
        let thinned = self.on(&self.thinned()).on_thinned_lines(start)?;
        self.after_thinned(&thinned.hypothesis)
    }

    fn after_thinned(&self, start: &Hypothesis) -> Option<Fit> {
        let (at, _) = self.improve_inflated(self.iterate(start.clone())?, self.settings.fit.inflation.1)?;
        self.end(at, f64::INFINITY)
    }

    /// The best of a global and a local fit; the local one is given up where it will hardly come as low: far
    /// from any optimum it creeps.
    pub(crate) fn refitted(&self, start: &Hypothesis) -> Option<Fit> {
        let global = self.global(start);
        let limit = global.as_ref().map_or(f64::INFINITY, |fit| fit.objective);
        [global, self.local(start, None, limit)].into_iter().flatten().reduce(better)
    }

    /// The `first` fit or, where that leaves much, the best of it and of global fits from about the start:
    /// one deviation up and down each quantity that is widely known.
    pub(crate) fn refitted_widely(&self, start: &Hypothesis, first: Fit) -> Fit {
        let (much, followed) = self.settings.fit.other_starts;
        if first.chi2_per_dof(self.observation) < much {
            return first;
        }
        let observation = self.thinned();
        let thinned = self.on(&observation);
        let is_wide = |m: &usize| start.tolerances()[*m].is_wide(self.settings.fit.wide);
        let starts: Vec<Hypothesis> = (0..start.tolerances().len())
            .filter(is_wide)
            .flat_map(|m| [-1.0, 1.0].map(|sign| start.moved(m, sign)))
            .collect();
        let fits = each(&starts, |start| thinned.on_thinned_lines(start));
        let mut fits: Vec<Fit> = fits.into_iter().flatten().collect();
        fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
        fits.truncate(followed);
        let fits: Vec<Option<Fit>> = each(&fits, |fit| self.after_thinned(&fit.hypothesis));
        fits.into_iter().flatten().fold(first, |best, fit| better(fit, best))
    }

    /// The fit without effect `index` that is reached by making the effect smaller step by step, so that the
    /// quantities can take over what they are able to imitate.
    ///
    /// `None` as well where a part of the effect is already missed by more than `limit`.
    pub(crate) fn faded(&self, full: &Hypothesis, index: usize, limit: f64) -> Option<Fit> {
        let effect = &full.effects()[index];
        let without = full.without(index);
        let mut at = without.clone();
        for share in self.settings.fit.fading {
            let smaller = crate::candidate::scaled(effect, share).and_then(|effect| without.beside(effect));
            let Some(smaller) = smaller.map(|h| h.with_coordinates_of(&at)) else { break };
            let Some(fit) = self.local(&smaller, None, limit) else { break };
            if fit.objective > limit {
                return None;
            }
            at = fit.hypothesis;
        }
        self.local(&without.with_coordinates_of(&at), None, f64::INFINITY)
    }
}

/// The one of lower objective, the first where both are alike.
fn better(a: Fit, b: Fit) -> Fit {
    if b.objective < a.objective { b } else { a }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Watch;
    use crate::simulated::simulated;
    use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
    use jointscope_spectra::{FrfPair, SpectralLines};
    use proptest::prelude::*;

    /// Two blocks on a strip, each group of quantities known to so many times its usual deviation.
    fn blocks([masses, places, modulus, damping]: [f64; 4]) -> Fixture {
        let known =
            |value: f64, std: f64, times: f64| format!(r#"{{"value": {value}, "std": {}}}"#, std * times);
        let block = |mass: f64, x: f64| {
            let (mass, inertia) = (known(mass, 0.002, masses), known(9.5e-4, 9.5e-6, masses));
            format!(r#"{{ "mass": {mass}, "inertia": {inertia}, "x_cg": {} }}"#, known(x, 2e-4, places))
        };
        let point =
            |body: &str, x: f64| format!(r#"{{ "body": "{body}", "x": {} }}"#, known(x, 2e-4, places));
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {}, "B": {} }}, "points": {{ "1": {}, "2": {}, "3": {}, "4": {} }},
                 "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": {}, "second_moment": 4e-10 }} }} }},
                 "damping": {{ "modal_ratios": [{}, {}] }} }}"#,
            block(1.1, -0.03),
            block(1.2, 0.095),
            point("A", -0.06),
            point("A", 0.0),
            point("B", 0.065),
            point("B", 0.125),
            known(2e11, 2e9, modulus),
            known(0.003, 6e-4, damping),
            known(0.004, 8e-4, damping)
        ))
        .unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        #[test]
        fn a_looser_tolerance_never_makes_a_refit_worse(
            group in 0usize..4,
            times in 1.5f64..8.0,
            spring in 2e4f64..2e5,
            mass in 0.002f64..0.02,
        ) {
            let hidden = [
                Effect::new(EffectKind::InterfaceCompliance, Place::Point("2".into()), Some(Dof::Rotation), &[spring, 0.0]),
                Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, mass]),
            ];
            let truth = blocks([1.0; 4]).with_physics(hidden.to_vec()).unwrap();
            let pairs = [("4", "1"), ("3", "1"), ("4", "2")].map(|(o, i)| FrfPair::transverse(o, i));
            let lines = SpectralLines::even(10.0, 5.0, 200).unwrap();
            let observation = simulated(&truth, &pairs, &lines, 1e-5);
            let settings = Settings::default();
            let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
            let objective = |known: [f64; 4]| {
                let nominal = Hypothesis::nominal(&blocks(known), true);
                fitter.refitted_widely(&nominal, fitter.refitted(&nominal).unwrap()).objective
            };
            let mut looser = [1.0; 4];
            looser[group] = times;
            let (tight, loose) = (objective([1.0; 4]), objective(looser));
            prop_assert!(loose <= tight * (1.0 + 1e-4) + 0.1, "{tight} to {loose} with {looser:?}");
        }
    }
}
