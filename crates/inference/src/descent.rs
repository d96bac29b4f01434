//! The damped Gauss–Newton method, from derivatives that are taken anew as seldom as possible.

use crate::problem::{DerivativePrecision, LeastSquares};
use crate::settings::{Limit, Settings};

/// Where a descent ended.
#[derive(Debug, Clone)]
pub struct Descent<Point, Derivatives> {
    /// The point.
    pub point: Point,
    /// The derivatives last used, taken there or on the way.
    pub derivatives: Derivatives,
    /// Objective with the last weights.
    pub objective: f64,
}

/// A promise that exceeds the decrease of convergence this many times is worth an undamped step.
const VALLEY: f64 = 3.0;
/// Dampings tried with old derivatives before new ones are taken.
const ATTEMPTS_WITH_OLD: usize = 2;

/// Goes down from `start` until it has converged or is given up; with derivatives known from nearby where
/// there are any.
///
/// `None` where a point on the way has no derivatives.
pub fn descend<P: LeastSquares>(
    problem: &P,
    start: P::Point,
    nearby: Option<P::Derivatives>,
    settings: &Settings,
) -> Option<Descent<P::Point, P::Derivatives>> {
    let mut point = start;
    let mut objective = problem.objective(&point, &problem.weights(&point));
    let within_reach = |objective: f64| {
        settings.exact_at_end
            && settings.limit.is_some_and(|limit| objective - limit.objective <= limit.reach)
    };
    let mut precision =
        if within_reach(objective) { DerivativePrecision::Exact } else { DerivativePrecision::Rough };
    let mut fresh = nearby.is_none() || settings.fresh;
    let mut derivatives = match nearby {
        Some(nearby) => nearby,
        None => problem.derivatives(&point, precision)?,
    };
    let mut damping = settings.damping.initial;
    let mut least_gain = 0.0_f64;
    let mut valleys = 0;
    let mut taken = 1;
    let mut pace = Pace::default();
    for _ in 0..settings.steps {
        let at = At::of(problem, &point, &derivatives, objective, fresh);
        let (before, promised) = (at.objective, at.promised.unwrap_or(0.0));
        if let Some(limit) = settings.limit.filter(|_| fresh)
            && (limit.is_out_of_reach(before, promised) || pace.is_too_slow(before, &limit))
        {
            objective = before;
            break;
        }
        let (next, followed) = at.next(problem, &mut damping, settings);
        let stepped = next.is_some();
        if let Some((next, after)) = next {
            (point, objective) = (next, after);
        } else {
            objective = before;
        }
        let gain = before - objective;
        let needed = settings.convergence.needed(before);
        if gain < needed && (fresh || (settings.trust_old && stepped)) {
            let valley = promised > VALLEY * needed && gain > 0.0 && valleys < settings.valleys;
            if valley {
                valleys += 1;
                damping = settings.damping.least;
            } else if precision == DerivativePrecision::Exact || !settings.exact_at_end {
                break;
            }
            precision = DerivativePrecision::Exact;
            derivatives = problem.derivatives(&point, precision)?;
            (fresh, least_gain) = (true, 0.0);
            continue;
        }
        let slow = followed || gain < least_gain.max(needed) || settings.reuse.is_none();
        if fresh {
            least_gain = settings.reuse.map_or(0.0, |share| (share * gain).max(needed));
        }
        if slow {
            if taken == settings.derivatives {
                break;
            }
            taken += 1;
            if within_reach(objective) {
                precision = DerivativePrecision::Exact;
            }
            derivatives = problem.derivatives(&point, precision)?;
            least_gain = 0.0;
        }
        fresh = slow;
    }
    Some(Descent { point, derivatives, objective })
}

/// Where a descent stands, before its next step.
struct At<'a, P: LeastSquares> {
    point: &'a P::Point,
    derivatives: &'a P::Derivatives,
    weights: P::Weights,
    equations: P::Equations,
    objective: f64,
    /// What an undamped step should gain; nothing where the derivatives are old.
    promised: Option<f64>,
}

impl<'a, P: LeastSquares> At<'a, P> {
    /// At a point where `objective` is that of the weights before; `fresh` where the derivatives are those of
    /// the point.
    fn of(
        problem: &P,
        point: &'a P::Point,
        derivatives: &'a P::Derivatives,
        objective: f64,
        fresh: bool,
    ) -> Self {
        let weights = problem.weights(point);
        let objective = if P::FIXED_WEIGHTS { objective } else { problem.objective(point, &weights) };
        let equations = problem.equations(point, derivatives, &weights);
        let promised = fresh.then(|| problem.promised(point, &equations));
        At { point, derivatives, weights, equations, objective, promised }
    }

    /// The next point with its objective, and whether it lies along a curved valley, where a damped step
    /// gained much less than was promised.
    fn next(&self, problem: &P, damping: &mut f64, settings: &Settings) -> (Option<(P::Point, f64)>, bool) {
        let attempts = if self.promised.is_some() { usize::MAX } else { ATTEMPTS_WITH_OLD };
        let next = lower(problem, self, (damping, attempts), settings);
        let gained = next.as_ref().map_or(0.0, |(_, after)| self.objective - after);
        // A fit far from what it competes with follows no valley.
        let near = settings.limit.is_none_or(|limit| self.objective - limit.objective <= limit.reach);
        let is_curved = near
            && self.promised.is_some_and(|promised| {
                promised > VALLEY * settings.convergence.needed(self.objective)
                    && gained < settings.curved_valley * promised
            });
        let along = if is_curved { along_valley(problem, self, self.objective - gained) } else { None };
        let followed = along.is_some();
        (along.or(next), followed)
    }
}

/// The first step, ever more damped, that lowers the objective.
fn lower<P: LeastSquares>(
    problem: &P,
    at: &At<P>,
    (damping, attempts): (&mut f64, usize),
    settings: &Settings,
) -> Option<(P::Point, f64)> {
    for _ in 0..attempts {
        if let Some(next) = problem.stepped(at.point, &at.equations, *damping) {
            let after = problem.objective(&next, &at.weights);
            if after < at.objective {
                *damping = (*damping * settings.damping.decrease).max(settings.damping.least);
                return Some((next, after));
            }
        }
        *damping = (*damping * 10.0).max(settings.damping.raised);
        if *damping > settings.damping.most {
            return None;
        }
    }
    None
}

/// Shares of an undamped step that are tried in turn.
const SHARES: [f64; 4] = [1.0, 0.4, 0.15, 0.05];

/// The point beside the way of an undamped step that lowers the objective below `than`, the lowest of those
/// tried.
///
/// What a share α of the step does across a curved valley grows as α², and its cost as α⁴: damped steps
/// creep. One more step from there, by the same derivatives, takes that back but for what grows as α³ (the
/// geodesic acceleration of Transtrum & Sethna, arXiv:1201.5885, by a finite step).
fn along_valley<P: LeastSquares>(problem: &P, at: &At<P>, than: f64) -> Option<(P::Point, f64)> {
    let mut best: Option<(P::Point, f64)> = None;
    for share in SHARES {
        let next = problem.shortened(at.point, &at.equations, share).and_then(|there| {
            let own = problem.equations(&there, at.derivatives, &at.weights);
            problem.corrected(&there, at.point, [&own, &at.equations], share)
        });
        let Some(next) = next else { continue };
        let after = problem.objective(&next, &at.weights);
        let lowest = best.as_ref().map_or(than, |(_, lowest)| *lowest);
        if after < lowest {
            best = Some((next, after));
        } else if best.is_some() {
            break;
        }
    }
    best
}

/// How fast a fit comes nearer to its limit, from one set of derivatives to the next.
#[derive(Default)]
struct Pace {
    seen: usize,
    last: f64,
}

impl Pace {
    fn is_too_slow(&mut self, objective: f64, limit: &Limit) -> bool {
        let gained = self.last - objective;
        self.last = objective;
        self.seen += 1;
        self.seen > limit.patience && objective - limit.objective > limit.reach.max(limit.gains * gained)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Convergence, NormalEquations, Parameter, StepDamping, Transform};
    use proptest::prelude::*;
    use std::cell::Cell;

    /// A damped oscillation sampled at forty instants: amplitude, decay and frequency from a start nearby.
    struct Oscillation {
        measured: Vec<f64>,
        linearised: Cell<usize>,
    }

    fn value(q: &[f64; 3], t: f64) -> f64 {
        q[0] * (-q[1] * t).exp() * (q[2] * t).cos()
    }

    impl Oscillation {
        fn of(truth: [f64; 3]) -> Self {
            let measured = (0..40).map(|i| value(&truth, 0.1 * f64::from(i))).collect();
            Oscillation { measured, linearised: Cell::new(0) }
        }
    }

    impl LeastSquares for Oscillation {
        type Point = [f64; 3];
        type Weights = ();
        type Derivatives = Vec<[f64; 3]>;
        type Equations = NormalEquations;
        const FIXED_WEIGHTS: bool = true;

        fn weights(&self, _: &[f64; 3]) {}

        fn objective(&self, q: &[f64; 3], _: &()) -> f64 {
            let squares =
                self.measured.iter().enumerate().map(|(i, m)| (m - value(q, 0.1 * i as f64)).powi(2));
            squares.sum()
        }

        fn derivatives(&self, q: &[f64; 3], _: DerivativePrecision) -> Option<Vec<[f64; 3]>> {
            self.linearised.set(self.linearised.get() + 1);
            let at = |i: usize| {
                let t = 0.1 * i as f64;
                let decay = (-q[1] * t).exp();
                [decay * (q[2] * t).cos(), -t * value(q, t), -q[0] * decay * t * (q[2] * t).sin()]
            };
            Some((0..self.measured.len()).map(at).collect())
        }

        fn equations(&self, q: &[f64; 3], slopes: &Vec<[f64; 3]>, _: &()) -> NormalEquations {
            let mut equations = NormalEquations::zero(3);
            for (i, slopes) in slopes.iter().enumerate() {
                equations.add(1.0, self.measured[i] - value(q, 0.1 * i as f64), slopes);
            }
            equations
        }

        fn stepped(&self, q: &[f64; 3], equations: &NormalEquations, damping: f64) -> Option<[f64; 3]> {
            let step = equations.step(damping)?;
            Some([q[0] + step[0], q[1] + step[1], q[2] + step[2]])
        }
    }

    /// A valley along y = x² with its lowest point at x = 1: residuals steep·(y − x²) and 1 − x.
    struct Bent {
        steep: f64,
    }

    impl LeastSquares for Bent {
        type Point = [f64; 2];
        type Weights = ();
        type Derivatives = Vec<[f64; 2]>;
        type Equations = NormalEquations;
        const FIXED_WEIGHTS: bool = true;

        fn weights(&self, _: &[f64; 2]) {}

        fn objective(&self, q: &[f64; 2], _: &()) -> f64 {
            (self.steep * (q[1] - q[0] * q[0])).powi(2) + (1.0 - q[0]).powi(2)
        }

        fn derivatives(&self, q: &[f64; 2], _: DerivativePrecision) -> Option<Vec<[f64; 2]>> {
            Some(vec![[-2.0 * self.steep * q[0], self.steep], [-1.0, 0.0]])
        }

        fn equations(&self, q: &[f64; 2], slopes: &Vec<[f64; 2]>, _: &()) -> NormalEquations {
            let mut equations = NormalEquations::zero(2);
            let left = [-self.steep * (q[1] - q[0] * q[0]), q[0] - 1.0];
            for (slopes, left) in slopes.iter().zip(left) {
                equations.add(1.0, left, slopes);
            }
            equations
        }

        fn stepped(&self, q: &[f64; 2], equations: &NormalEquations, damping: f64) -> Option<[f64; 2]> {
            let step = equations.step(damping)?;
            Some([q[0] + step[0], q[1] + step[1]])
        }

        fn shortened(&self, q: &[f64; 2], equations: &NormalEquations, share: f64) -> Option<[f64; 2]> {
            let step = equations.step(0.0)?;
            Some([q[0] + share * step[0], q[1] + share * step[1]])
        }

        fn corrected(
            &self,
            at: &[f64; 2],
            from: &[f64; 2],
            [own, before]: [&NormalEquations; 2],
            share: f64,
        ) -> Option<[f64; 2]> {
            let free = [Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 }); 2];
            let step = own.correction(at, (before, from), share, &free)?;
            Some([at[0] + step[0], at[1] + step[1]])
        }

        fn promised(&self, _: &[f64; 2], equations: &NormalEquations) -> f64 {
            let step = equations.step(0.0).unwrap_or_default();
            step.iter().zip(&equations.right).map(|(step, right)| step * right).sum()
        }
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end_where_damped_steps_creep() {
        let problem = Bent { steep: 1e4 };
        let damping = StepDamping { initial: 1e-8, decrease: 0.1, least: 1e-13, raised: 0.0, most: 1e7 };
        let convergence = Convergence { gain: 1e-9, share: 0.0, floor: 0.0 };
        let end = |curved_valley: f64| {
            let settings = Settings { steps: 40, damping, convergence, curved_valley, ..Settings::default() };
            descend(&problem, [-1.2, 1.44], None, &settings).unwrap().objective
        };
        assert!(end(0.0) > 0.1, "{}", end(0.0));
        assert!(end(0.1) < 1e-6, "{}", end(0.1));
    }

    proptest! {
        #[test]
        fn a_damped_oscillation_is_found_from_a_start_nearby(
            truth in (0.5f64..3.0, 0.05f64..0.5, 2.0f64..4.0), off in prop::array::uniform3(-0.1f64..0.1)
        ) {
            let truth = [truth.0, truth.1, truth.2];
            let start = [0, 1, 2].map(|i| truth[i] * (1.0 + off[i]));
            let fit = descend(&Oscillation::of(truth), start, None, &Settings::default()).unwrap();
            for i in 0..3 {
                prop_assert!((fit.point[i] / truth[i] - 1.0).abs() < 1e-6, "{:?} for {truth:?}", fit.point);
            }
        }

        #[test]
        fn old_derivatives_lead_to_the_same_place_and_are_taken_more_rarely(off in prop::array::uniform3(-0.05f64..0.05)) {
            let truth = [1.0, 0.2, 3.0];
            let start = [0, 1, 2].map(|i| truth[i] * (1.0 + off[i]));
            let (anew, reused) = (Oscillation::of(truth), Oscillation::of(truth));
            let converged = Convergence { gain: 1e-18, share: 0.0, floor: 0.0 };
            let settings = Settings { convergence: converged, ..Settings::default() };
            let first = descend(&anew, start, None, &settings).unwrap();
            let second = descend(&reused, start, None, &Settings { reuse: Some(0.0), ..settings }).unwrap();
            for i in 0..3 {
                prop_assert!((first.point[i] - second.point[i]).abs() < 1e-6);
            }
            prop_assert!(reused.linearised.get() <= anew.linearised.get());
        }

        #[test]
        fn no_step_ever_raises_the_objective(start in (0.1f64..5.0, 0.0f64..2.0, 0.5f64..8.0), steps in 1usize..20) {
            let problem = Oscillation::of([1.0, 0.2, 3.0]);
            let start = [start.0, start.1, start.2];
            let fit = descend(&problem, start, None, &Settings { steps, ..Settings::default() }).unwrap();
            prop_assert!(fit.objective <= problem.objective(&start, &()));
            prop_assert!((fit.objective - problem.objective(&fit.point, &())).abs() <= 1e-12);
        }
    }
}
