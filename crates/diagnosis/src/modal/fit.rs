//! One hypothesis at its most probable parameters and sizes of error.

use crate::Hypothesis;
use crate::modal::prior::Prior;
use crate::modal::turns::{Turns, are_alike};
use crate::rarity::rarity;
use crate::work::Work;
use jointscope_fixture::Fixture;
use jointscope_inference::{
    Convergence, Covariance, Damping, LeastSquares, NormalEquations, Precision, Settings, descend, dot,
};
use jointscope_linalg::Cholesky;
use jointscope_model_error::{
    Comparison, ErrorSizes, Evidence, KINDS, Linear, ModelledModes, Pairing, RecordedModes, Shapes, SizePrior,
};

/// The recording's modes and what is known of the model's error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem<'a> {
    pub recorded: &'a RecordedModes,
    pub features: &'a [f64],
    pub sizes: &'a ErrorSizes,
    /// Which of the sizes are stated.
    pub stated: [bool; KINDS],
    /// Work done.
    pub work: &'a Work,
}

/// A hypothesis where it stands: its modes, paired with the recording's.
#[derive(Debug, Clone)]
pub(crate) struct Standing {
    pub modelled: ModelledModes,
    pub pairing: Pairing,
    pub comparison: Comparison,
}

/// A hypothesis at its most probable parameters.
#[derive(Debug, Clone)]
pub(crate) struct ModalFit {
    pub hypothesis: Hypothesis,
    pub priors: Vec<Prior>,
    pub standing: Standing,
    pub linear: Linear,
    pub evidence: Evidence,
    /// Derivatives of the model's features by each coordinate, for a step of one.
    pub slopes: Vec<Vec<f64>>,
    /// Recorded less modelled features.
    pub residual: Vec<f64>,
    /// ln of the evidence, modes without a partner included.
    pub ln: f64,
}

/// The sizes of error that a fit sets out with. One that begins with errors too small follows whatever features are recorded most sharply, and its errors then grow
/// to suit it; one that begins with large ones may rest content with them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SetOut {
    /// The usual ones.
    Usual,
    /// These, and where the fit ends with larger ones also those that the start asks for; the more probable end counts.
    Both,
    /// Those of a fit nearby besides.
    Beside(ErrorSizes),
}

/// Values of an FRF that the search for a model's poles, and following known ones, cost about.
const SEARCHED: usize = 1000;
const FOLLOWED: usize = 300;
/// Step of differences, in prior standard deviations and at most in coordinates.
const DIFFERENCE: (f64, f64) = (1e-3, 2e-3);
/// Descents at sizes of the error that are taken anew after each, at most, and the gain in ln p at which that ends. Each goes as far as few sets of derivatives lead:
/// what is fitted closely at sizes that are about to change is fitted again.
const ROUNDS: usize = 20;
const DERIVATIVES: usize = 2;
const CONVERGED: f64 = 0.02;
/// Rounds at whose ends a fit stands still and has gained less, after which it ends.
const IDLE: usize = 2;
/// Of a fit whose ln p matters wherever it ends.
pub(super) const ANY: f64 = f64::NEG_INFINITY;
/// Rounds after which a fit is given up that is still below what matters, and gains less than this share of what it lacks.
const PATIENCE: usize = 2;
const GAINING: f64 = 0.25;
/// Factor by which a size may shrink from one round to the next: where errors are next to none, a fit that starts far away hangs on whatever is recorded most sharply.
const SHRINK: f64 = 0.1;
/// How often a mode that has strayed into the band or out of it is counted anew, and damping that turns phases by far more or less than before: a mode at the very end of the
/// band may stray for ever.
const STRAYS: usize = 2;
/// Decrease of χ² that a step promises below which a fit stands where it belongs.
const STILL: f64 = 1.0;
/// Standard deviations by which χ² of the features may be larger than their number.
const BY_CHANCE: f64 = 6.0;
/// Gauss–Newton steps, at most.
const STEPS: usize = 40;
/// Share of what an undamped step promises below which a fit follows a curved valley.
const CURVED_VALLEY: f64 = 0.1;
/// A step that gains less than this share of what the first one with its derivatives gained asks for new ones.
const REUSE: f64 = 0.2;

impl ModalFit {
    /// The largest departure of the fixture's quantities, in standard deviations.
    pub(crate) fn largest_pull(&self) -> f64 {
        let pulls = self.hypothesis.coordinates.iter().zip(&self.priors);
        let pulls = pulls.take(self.hypothesis.tolerances().len());
        pulls.map(|(at, prior)| ((at - prior.mean) / prior.std).abs()).fold(0.0, f64::max)
    }

    /// Whether the features' misfit, errors of the model at their sizes and departures counted, is no larger than chance makes it.
    pub(crate) fn leaves_chance(&self) -> bool {
        let comparison = &self.standing.comparison;
        let Some(factor) = Cholesky::of(comparison.count(), &comparison.covariance(&self.evidence.sizes))
        else {
            return false;
        };
        let mut white = self.residual.clone();
        factor.solve_lower_in_place(&mut white);
        let degrees = comparison.count() as f64;
        dot(&white, &white) < degrees + BY_CHANCE * (2.0 * degrees).sqrt()
    }

    /// Covariance of the coordinates of the linear model where an error has these sizes.
    pub(crate) fn covariance_at(&self, sizes: &ErrorSizes) -> Option<Covariance> {
        let comparison = &self.standing.comparison;
        let factor = Cholesky::of(comparison.count(), &comparison.covariance(sizes))?;
        let white = |slope: &Vec<f64>| {
            let mut white = slope.clone();
            factor.solve_lower_in_place(&mut white);
            white
        };
        let white: Vec<Vec<f64>> = self.linear.slopes.iter().map(white).collect();
        let order = white.len();
        let entry = |e: usize| {
            let own = if e / order == e % order { 1.0 } else { 0.0 };
            own + dot(&white[e / order], &white[e % order])
        };
        let information: Vec<f64> = (0..order * order).map(entry).collect();
        let mut entries = Cholesky::of(order, &information)?.inverse();
        for (e, entry) in entries.iter_mut().enumerate() {
            *entry *= self.priors[e / order].std * self.priors[e % order].std;
        }
        Some(Covariance::new(order, entries))
    }
}

impl<'a> Problem<'a> {
    /// What is known of the sizes of the error beforehand.
    pub(crate) fn prior(&self) -> SizePrior {
        SizePrior { scales: *self.sizes, stated: self.stated }
    }

    /// Where a hypothesis stands, its poles found anew.
    pub(crate) fn standing(&self, hypothesis: &Hypothesis) -> Option<Standing> {
        let fixture = hypothesis.to_fixture().ok()?;
        self.work.count(SEARCHED * self.recorded.frfs());
        let modelled = ModelledModes::of(&fixture, self.recorded)?;
        let pairing = Pairing::of(self.recorded, &modelled);
        self.paired((hypothesis, &fixture), modelled, pairing)
    }

    fn paired(
        &self,
        (hypothesis, fixture): (&Hypothesis, &Fixture),
        modelled: ModelledModes,
        pairing: Pairing,
    ) -> Option<Standing> {
        let shapes = |fixture: &Fixture| Shapes::of(fixture, self.recorded, &modelled.poles());
        let own = shapes(fixture)?;
        let mut comparison = Comparison::new(self.recorded, &pairing, &modelled, &own);
        // The damping of the fixture by itself is no proportional one of a structure with effects; which of both it is, if either, nobody knows.
        let springs = match hypothesis.springs_and_masses() {
            Some(effects) if effects == hypothesis.effects() => Some(own),
            Some(effects) => hypothesis.to_fixture_with(effects).ok().and_then(|fixture| shapes(&fixture)),
            None => None,
        };
        if let Some(springs) = springs {
            comparison = comparison.with_damping_distributed_otherwise(self.recorded, &pairing, &springs);
        }
        Some(Standing { modelled, pairing, comparison })
    }

    /// The modes of a hypothesis, followed from those of another one near it.
    pub(super) fn modelled(&self, hypothesis: &Hypothesis, near: &ModelledModes) -> Option<ModelledModes> {
        let fixture = hypothesis.to_fixture().ok()?;
        self.work.count(FOLLOWED * self.recorded.frfs());
        ModelledModes::near(&fixture, self.recorded, near)
    }

    /// Recorded less modelled features, of the modes that are paired.
    pub(crate) fn residual(&self, standing: &Standing, modelled: &ModelledModes) -> Vec<f64> {
        standing.comparison.residual(self.recorded, self.features, modelled, &standing.pairing)
    }

    /// Derivatives of the model's features by coordinates `of`, for a step of one.
    pub(crate) fn slopes(
        &self,
        hypothesis: &Hypothesis,
        standing: &Standing,
        modelled: &ModelledModes,
        residual: &[f64],
        priors: &[Prior],
        of: std::ops::Range<usize>,
    ) -> Option<Vec<Vec<f64>>> {
        let about = self.recorded.about(hypothesis.to_fixture().ok()?);
        let beside = |hypothesis: &Hypothesis| {
            let Some(about) = &about else { return self.modelled(hypothesis, modelled) };
            let fixture = hypothesis.to_fixture().ok()?;
            self.work.count(FOLLOWED * self.recorded.frfs());
            ModelledModes::after_step(&fixture, self.recorded, (about, modelled))
        };
        of.map(|index| {
            let size = (DIFFERENCE.0 * priors[index].std).min(DIFFERENCE.1);
            let inward = hypothesis.inward(index, size);
            // A beam that ends at a support cannot become shorter: then longer.
            let moved = |step: f64| Some((step, beside(&hypothesis.moved(index, step))?));
            let (step, moved) = moved(inward).or_else(|| moved(-inward))?;
            let there = self.residual(standing, &moved);
            Some(residual.iter().zip(&there).map(|(at, there)| (at - there) / step).collect())
        })
        .collect()
    }

    /// The most probable parameters from where `start` stands, and the sizes of the error there.
    pub(crate) fn fitted(&self, start: &Hypothesis, priors: &[Prior]) -> Option<ModalFit> {
        self.fitted_from(start, self.standing(start)?, priors, (None, SetOut::Both, ANY))
    }

    /// [`Problem::fitted`], and from pairings beside the most likely one at the start where errors of the usual size do not do.
    pub(crate) fn fitted_however_paired(&self, start: &Hypothesis, priors: &[Prior]) -> Option<ModalFit> {
        let standing = self.standing(start)?;
        let others = standing.pairing.others(self.recorded, &standing.modelled);
        let modelled = standing.modelled.clone();
        let first = self.fitted_from(start, standing, priors, (None, SetOut::Both, ANY));
        if others.is_empty() || first.as_ref().is_some_and(|fit| self.is_usual(&fit.evidence.sizes)) {
            return first;
        }
        let fixture = start.to_fixture().ok()?;
        let fitted = |pairing: Pairing| {
            let standing = self.paired((start, &fixture), modelled.clone(), pairing)?;
            self.fitted_from(start, standing, priors, (None, SetOut::Both, ANY))
        };
        others.into_iter().map(fitted).fold(first, more_probable)
    }

    /// [`Problem::fitted`] from where `start` is known to stand, with derivatives known from nearby where there are any. What stays below `least` in ln p is not followed to
    /// its rest, nor from other sizes of error.
    pub(crate) fn fitted_from(
        &self,
        start: &Hypothesis,
        standing: Standing,
        priors: &[Prior],
        (nearby, set_out, least): (Option<Vec<Vec<f64>>>, SetOut, f64),
    ) -> Option<ModalFit> {
        let (point, standing) = self.at_start(start, standing);
        let count = point.residual.len();
        let nearby = nearby.filter(|slopes| slopes.iter().all(|slope| slope.len() == count));
        let derivatives = match nearby {
            Some(nearby) => nearby,
            None => self.slopes_at(&point, &standing, priors)?,
        };
        let from = |sizes| {
            self.fitted_with((point.clone(), derivatives.clone()), standing.clone(), priors, (sizes, least))
        };
        let mut best = from(Some(*self.sizes));
        if let SetOut::Beside(sizes) = set_out {
            best = more_probable(best, from(Some(sizes)));
        }
        let is_far = best.as_ref().is_some_and(|fit| fit.ln < least);
        if is_far
            || set_out == SetOut::Usual
            || best.as_ref().is_some_and(|fit| self.is_usual(&fit.evidence.sizes))
        {
            return best;
        }
        more_probable(best, from(None))
    }

    /// Where a fit from `start` sets out, errors of its damping counted as those of ratios alone.
    pub(super) fn at_start(&self, start: &Hypothesis, standing: Standing) -> (Iterate, Standing) {
        let standing = Standing { comparison: standing.comparison.with_ratios_alone(), ..standing };
        let residual = self.residual(&standing, &standing.modelled);
        let point = Iterate { hypothesis: start.clone(), modelled: standing.modelled.clone(), residual };
        (point, standing)
    }

    /// Whether no error is larger than the usual one.
    fn is_usual(&self, sizes: &ErrorSizes) -> bool {
        sizes.to_array().iter().zip(self.sizes.to_array()).all(|(size, usual)| *size <= usual)
    }

    /// Sizes of the error and parameters taken in turn from a point with its derivatives, and from these sizes or those that it asks for.
    fn fitted_with(
        &self,
        (mut point, mut derivatives): (Iterate, Vec<Vec<f64>>),
        mut standing: Standing,
        priors: &[Prior],
        (sizes, least): (Option<ErrorSizes>, f64),
    ) -> Option<ModalFit> {
        let rarity = rarity(&point.hypothesis);
        let mut sizes = match sizes {
            Some(sizes) => sizes,
            None => self.evidence(&point, priors, &derivatives, (&standing.comparison, None))?.1.sizes,
        };
        let (mut best, mut otherwise, mut stale): (Option<ModalFit>, Option<ModalFit>, Option<ModalFit>) =
            (None, None, None);
        let mut strayed = 0;
        let (mut idle, mut ahead) = (0, f64::NEG_INFINITY);
        let mut turns = Turns::none();
        for round in 0..ROUNDS {
            // What fails on the way takes nothing from what was found before.
            let Some(end) = self.settled(&standing, point, derivatives, (priors, &sizes)) else { break };
            (point, derivatives) = (end.point, end.derivatives);
            let before = best.as_ref().map(|fit| fit.ln);
            let asked = end.evidence.sizes;
            let next = asked.larger(sizes.times(SHRINK));
            // The evidence at sizes that are asked for says nothing of a point from where the parameters are still to move, or the sizes to shrink. At its own a fit may stand still all the
            // same.
            let settled = next == asked;
            let same = settled && are_alike(&next, &sizes);
            let last = round + 1 == ROUNDS;
            let evidence = match settled && end.promised < STILL {
                true => Some(end.evidence),
                false => (end.promised_there < STILL).then_some(Evidence {
                    ln: end.evidence.ln_at_start,
                    sizes,
                    ..end.evidence
                }),
            };
            let stands = evidence.is_some();
            sizes = turns.toward(&next, &sizes);
            let ln = end.evidence.ln + standing.pairing.alone() - rarity;
            let given_up = round >= PATIENCE && ln < least && ln - ahead < GAINING * (least - ln);
            ahead = ln;
            let none = (last || given_up) && best.is_none() && otherwise.is_none();
            if let Some(evidence) = evidence.or(none.then_some(end.evidence)) {
                let fit = ModalFit {
                    hypothesis: point.hypothesis.clone(),
                    priors: priors.to_vec(),
                    standing: Standing { modelled: point.modelled.clone(), ..standing.clone() },
                    linear: end.linear,
                    evidence,
                    slopes: derivatives.clone(),
                    residual: point.residual.clone(),
                    ln: evidence.ln + standing.pairing.alone() - rarity,
                };
                best = more_probable(best, Some(fit));
            }
            if given_up {
                break;
            }
            let gained = best.as_ref().zip(before).is_none_or(|(best, before)| best.ln - before >= CONVERGED);
            idle = if gained { 0 } else { idle + usize::from(stands) };
            let ends = best.is_some() && (same || idle == IDLE);
            // Modes may have moved past others on the way, and shapes with them, or into the band or out of it.
            let strays = strayed < STRAYS && point.modelled.strays(self.recorded);
            if last || !(ends || strays) {
                continue;
            }
            let Some(anew) = self.standing(&point.hypothesis) else { break };
            let alike = anew.pairing.pairs == standing.pairing.pairs;
            // Where the fit set out, damping may have turned the shapes' phases by far more or less than it does here.
            let damped_like = anew.comparison.damps_like(&standing.comparison, self.sizes.damping);
            let turned = alike && strayed < STRAYS && !damped_like;
            if ends && alike && anew.modelled.counts_like(&standing.modelled) && !turned {
                break;
            }
            point.residual = self.residual(&anew, &anew.modelled);
            point.modelled = anew.modelled.clone();
            let Some(there) = self.slopes_at(&point, &anew, priors) else { break };
            derivatives = there;
            // What counted a mode as what it is not, or another's damping as its own, says nothing.
            if strays || turned {
                stale = best.take();
                strayed += 1;
            }
            idle = 0;
            otherwise = more_probable(otherwise, best.take());
            standing = anew;
        }
        more_probable(otherwise, best).or(stale)
    }

    /// Where parameters come to rest at these sizes of the error, with derivatives taken there, and the evidence by these.
    fn settled(
        &self,
        standing: &Standing,
        start: Iterate,
        derivatives: Vec<Vec<f64>>,
        (priors, sizes): (&[Prior], &ErrorSizes),
    ) -> Option<Rest> {
        let factor = Cholesky::of(standing.comparison.count(), &standing.comparison.covariance(sizes))?;
        let descent = Descent { problem: self, standing, factor, priors };
        let point = descend(&descent, start, Some(derivatives), &settings(DERIVATIVES))?.point;
        let derivatives = descent.derivatives(&point, Precision::Rough)?;
        let promised_there = descent.promised(&point, &descent.equations(&point, &derivatives, &()));
        let (linear, evidence) =
            self.evidence(&point, priors, &derivatives, (&standing.comparison, Some(sizes)))?;
        // Of a fit at errors of nothing that finds they are not, the parameters are still to move, however still they stand there.
        let factor =
            Cholesky::of(standing.comparison.count(), &standing.comparison.covariance(&evidence.sizes))?;
        let there = Descent { factor, ..descent };
        let promised = there.promised(&point, &there.equations(&point, &derivatives, &()));
        Some(Rest { point, derivatives, linear, evidence, promised_there, promised })
    }

    /// [`Problem::slopes`] by all coordinates.
    pub(super) fn slopes_at(
        &self,
        point: &Iterate,
        standing: &Standing,
        priors: &[Prior],
    ) -> Option<Vec<Vec<f64>>> {
        let all = 0..point.hypothesis.coordinates.len();
        self.slopes(&point.hypothesis, standing, &point.modelled, &point.residual, priors, all)
    }
}

/// The more probable of two fits, as far as there are any.
fn more_probable(a: Option<ModalFit>, b: Option<ModalFit>) -> Option<ModalFit> {
    a.into_iter().chain(b).reduce(|best, fit| if fit.ln > best.ln { fit } else { best })
}

/// How parameters are fitted with at most so many sets of derivatives, the first taken at the start.
pub(super) fn settings(derivatives: usize) -> Settings {
    Settings {
        steps: STEPS,
        derivatives,
        fresh: true,
        damping: Damping { initial: 1e-6, decrease: 0.1, least: 1e-9, raised: 1e-3, most: 1e5 },
        convergence: Convergence { gain: 0.2 * STILL, share: 1e-3, floor: 0.0 },
        reuse: Some(REUSE),
        curved_valley: CURVED_VALLEY,
        trust_old: true,
        ..Settings::default()
    }
}

/// Where a fit came to rest.
struct Rest {
    point: Iterate,
    derivatives: Vec<Vec<f64>>,
    linear: Linear,
    evidence: Evidence,
    /// Decrease of χ² that one more step promises at the sizes that were fitted with, and at those asked for.
    promised_there: f64,
    promised: f64,
}

/// Where a fit stands on its way.
#[derive(Clone)]
pub(super) struct Iterate {
    pub hypothesis: Hypothesis,
    pub modelled: ModelledModes,
    pub residual: Vec<f64>,
}

/// Parameters to be fitted at given sizes of the error.
pub(super) struct Descent<'a> {
    pub problem: &'a Problem<'a>,
    pub standing: &'a Standing,
    /// Of the covariance of noise and error.
    pub factor: Cholesky,
    pub priors: &'a [Prior],
}

/// The step that the equations at a point ask for, within its bounds.
fn step(equations: &NormalEquations, point: &Iterate, damping: f64) -> Option<Vec<f64>> {
    equations.bounded_step(damping, &point.hypothesis.coordinates, point.hypothesis.parameters())
}

impl Descent<'_> {
    fn moved(&self, point: &Iterate, step: &[f64]) -> Option<Iterate> {
        let hypothesis = point.hypothesis.stepped(step);
        let modelled = self.problem.modelled(&hypothesis, &point.modelled)?;
        let residual = self.problem.residual(self.standing, &modelled);
        Some(Iterate { hypothesis, residual, modelled })
    }

    fn whitened(&self, values: &[f64]) -> Vec<f64> {
        let mut white = values.to_vec();
        self.factor.solve_lower_in_place(&mut white);
        white
    }
}

impl LeastSquares for Descent<'_> {
    type Point = Iterate;
    type Weights = ();
    type Derivatives = Vec<Vec<f64>>;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Iterate) {}

    fn objective(&self, point: &Iterate, _: &()) -> f64 {
        let departures = point.hypothesis.coordinates.iter().zip(self.priors);
        let departures = departures.map(|(at, prior)| ((at - prior.mean) / prior.std).powi(2));
        self.whitened(&point.residual).iter().map(|v| v * v).sum::<f64>() + departures.sum::<f64>()
    }

    fn derivatives(&self, point: &Iterate, _: Precision) -> Option<Vec<Vec<f64>>> {
        self.problem.slopes_at(point, self.standing, self.priors)
    }

    fn equations(&self, point: &Iterate, slopes: &Vec<Vec<f64>>, _: &()) -> NormalEquations {
        let white: Vec<Vec<f64>> = slopes.iter().map(|slope| self.whitened(slope)).collect();
        let residual = self.whitened(&point.residual);
        let mut equations = NormalEquations::zero(white.len());
        for (i, a) in white.iter().enumerate() {
            equations.right[i] = dot(a, &residual);
            for (j, b) in white.iter().enumerate() {
                equations.information[i * white.len() + j] = dot(a, b);
            }
            let prior = self.priors[i];
            equations.add_prior(i, prior.std.powi(-2), point.hypothesis.coordinates[i] - prior.mean);
        }
        equations
    }

    fn stepped(&self, point: &Iterate, equations: &NormalEquations, damping: f64) -> Option<Iterate> {
        self.moved(point, &step(equations, point, damping)?)
    }

    fn shortened(&self, point: &Iterate, equations: &NormalEquations, share: f64) -> Option<Iterate> {
        let step: Vec<f64> = step(equations, point, 0.0)?.iter().map(|step| share * step).collect();
        self.moved(point, &step)
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
        self.moved(at, &own.correction(coordinates, earlier, share, at.hypothesis.parameters())?)
    }

    fn promised(&self, point: &Iterate, equations: &NormalEquations) -> f64 {
        equations.promised(&point.hypothesis.coordinates, point.hypothesis.parameters())
    }
}
