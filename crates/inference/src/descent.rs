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
    let mut course = Course::begin(problem, start, nearby, settings)?;
    for _ in 0..settings.steps {
        if !course.goes_on_after_step()? {
            break;
        }
    }
    let Course { point, derivatives, objective, .. } = course;
    Some(Descent { point, derivatives, objective })
}

/// A descent under way.
struct Course<'a, P: LeastSquares> {
    problem: &'a P,
    settings: &'a Settings,
    point: P::Point,
    /// With the last weights.
    objective: f64,
    derivatives: P::Derivatives,
    precision: DerivativePrecision,
    /// Whether the derivatives are those of the point.
    fresh: bool,
    /// How often derivatives were taken because steps with old ones gained too little.
    taken: usize,
    damping: f64,
    /// What a step with old derivatives has to gain for these to serve once more.
    least_gain: f64,
    /// Undamped steps tried where damped ones had converged.
    valleys: usize,
    pace: Pace,
}

/// What a step did.
struct Step {
    /// The objective before it, with the weights that it was taken with.
    before: f64,
    /// What an undamped one should have gained.
    promised: f64,
    gain: f64,
    /// Whether the point moved.
    moved: bool,
    /// Whether it went along a curved valley.
    followed: bool,
}

impl<'a, P: LeastSquares> Course<'a, P> {
    /// `None` where the start has no derivatives.
    fn begin(
        problem: &'a P,
        point: P::Point,
        nearby: Option<P::Derivatives>,
        settings: &'a Settings,
    ) -> Option<Self> {
        let objective = problem.objective(&point, &problem.weights(&point));
        let exact = is_within_reach(objective, settings);
        let precision = if exact { DerivativePrecision::Exact } else { DerivativePrecision::Rough };
        let fresh = nearby.is_none() || settings.fresh;
        let derivatives = match nearby {
            Some(nearby) => nearby,
            None => problem.derivatives(&point, precision)?,
        };
        Some(Course {
            problem,
            settings,
            point,
            objective,
            derivatives,
            precision,
            fresh,
            taken: 1,
            damping: settings.damping.initial,
            least_gain: 0.0,
            valleys: 0,
            pace: Pace::default(),
        })
    }

    /// Takes a step; whether another one is to follow. `None` where the point reached has no derivatives.
    fn goes_on_after_step(&mut self) -> Option<bool> {
        let Some(step) = self.step() else { return Some(false) };
        let needed = self.settings.convergence.needed(step.before);
        let is_converged = step.gain < needed && (self.fresh || (self.settings.trust_old && step.moved));
        match is_converged {
            true => self.goes_on_where_converged(&step, needed),
            false => self.goes_on_with_derivatives(&step, needed),
        }
    }

    /// The next step; `None` where the descent is given up.
    fn step(&mut self) -> Option<Step> {
        let at = At::of(self.problem, &self.point, &self.derivatives, self.objective, self.fresh);
        let (before, promised) = (at.objective, at.promised.unwrap_or(0.0));
        if let Some(limit) = self.settings.limit.filter(|_| self.fresh)
            && (limit.is_out_of_reach(before, promised) || self.pace.is_too_slow(before, &limit))
        {
            self.objective = before;
            return None;
        }
        let (next, followed) = at.next(self.problem, &mut self.damping, self.settings);
        let moved = next.is_some();
        match next {
            Some((next, after)) => (self.point, self.objective) = (next, after),
            None => self.objective = before,
        }
        Some(Step { before, promised, gain: before - self.objective, moved, followed })
    }

    /// Ends where exact derivatives promise no more, or goes on with these.
    fn goes_on_where_converged(&mut self, step: &Step, needed: f64) -> Option<bool> {
        let is_valley =
            step.promised > VALLEY * needed && step.gain > 0.0 && self.valleys < self.settings.valleys;
        if is_valley {
            self.valleys += 1;
            self.damping = self.settings.damping.least;
        } else if self.precision == DerivativePrecision::Exact || !self.settings.exact_at_end {
            return Some(false);
        }
        self.precision = DerivativePrecision::Exact;
        self.derivatives = self.problem.derivatives(&self.point, self.precision)?;
        (self.fresh, self.least_gain) = (true, 0.0);
        Some(true)
    }

    /// Goes on with the derivatives at hand, or with new ones where a step gained too little, as long as any
    /// may be taken.
    fn goes_on_with_derivatives(&mut self, step: &Step, needed: f64) -> Option<bool> {
        let Settings { reuse, derivatives: most, .. } = *self.settings;
        let is_slow = step.followed || step.gain < self.least_gain.max(needed) || reuse.is_none();
        if self.fresh {
            self.least_gain = reuse.map_or(0.0, |share| (share * step.gain).max(needed));
        }
        if is_slow {
            if self.taken == most {
                return Some(false);
            }
            self.taken += 1;
            if is_within_reach(self.objective, self.settings) {
                self.precision = DerivativePrecision::Exact;
            }
            self.derivatives = self.problem.derivatives(&self.point, self.precision)?;
            self.least_gain = 0.0;
        }
        self.fresh = is_slow;
        Some(true)
    }
}

/// Whether an objective comes so near to its limit that exact derivatives matter.
fn is_within_reach(objective: f64, settings: &Settings) -> bool {
    settings.exact_at_end && settings.limit.is_some_and(|limit| objective - limit.objective <= limit.reach)
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
/// Corrections of a share at the most.
const CORRECTIONS: usize = 4;

/// The point beside the way of an undamped step that lowers the objective below `than`, the lowest of those
/// tried.
///
/// What a share α of the step does across a curved valley grows as α², and its cost as α⁴: damped steps
/// creep. One more step from there, by the same derivatives, takes that back but for what grows as α³ (the
/// geodesic acceleration of Transtrum & Sethna, arXiv:1201.5885, by a finite step); where the valley is as
/// narrow as sharp resonances make it that is still far up its side, and further ones take it back in turn.
fn along_valley<P: LeastSquares>(problem: &P, at: &At<P>, than: f64) -> Option<(P::Point, f64)> {
    let mut best: Option<(P::Point, f64)> = None;
    for share in SHARES {
        let lowest = best.as_ref().map_or(than, |(_, lowest)| *lowest);
        match corrected(problem, at, share).filter(|(_, after)| *after < lowest) {
            Some(lower) => best = Some(lower),
            None if best.is_some() => break,
            None => {}
        }
    }
    best
}

/// Where a share of an undamped step leads, corrected for as long as that lowers the objective.
fn corrected<P: LeastSquares>(problem: &P, at: &At<P>, share: f64) -> Option<(P::Point, f64)> {
    let correction = |there: &P::Point| {
        let own = problem.equations_from(there, at.point, at.derivatives, &at.weights);
        let next = problem.corrected(there, at.point, [&own, &at.equations], share)?;
        let after = problem.objective(&next, &at.weights);
        Some((next, after))
    };
    let mut found = correction(&problem.shortened(at.point, &at.equations, share)?)?;
    for _ in 1..CORRECTIONS {
        match correction(&found.0).filter(|(_, after)| *after < found.1) {
            Some(lower) => found = lower,
            None => break,
        }
    }
    Some(found)
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
