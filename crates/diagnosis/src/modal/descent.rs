//! Parameters fitted to the recorded modes at given sizes of the model's error.

use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, PairedModes, Problem};
use crate::settings::modal::descent::{CONVERGENCE, CURVED_VALLEY, DAMPING, DERIVATIVES, MOST_STEPS, REUSE};
use jointscope_inference::{DerivativePrecision, LeastSquares, NormalEquations, Settings, descend, dot};
use jointscope_linalg::Cholesky;
use jointscope_model_error::{ErrorSizes, Linear, ModelEvidence};

/// How parameters are fitted with at most so many sets of derivatives, the first taken at the start.
pub(super) fn settings(derivatives: usize) -> Settings {
    Settings {
        steps: MOST_STEPS,
        derivatives,
        fresh: true,
        damping: DAMPING,
        convergence: CONVERGENCE,
        reuse: Some(REUSE),
        curved_valley: CURVED_VALLEY,
        trust_old: true,
        ..Settings::default()
    }
}

/// Where a fit came to rest.
pub(super) struct Rest {
    pub point: Iterate,
    pub derivatives: Vec<Vec<f64>>,
    pub linear: Linear,
    pub evidence: ModelEvidence,
    /// Decrease of χ² that one more step promises at the sizes that were fitted with, and at those asked for.
    pub promised_there: f64,
    pub promised: f64,
}

/// Parameters to be fitted at given sizes of the error.
pub(super) struct Descent<'a> {
    pub problem: &'a Problem<'a>,
    pub paired: &'a PairedModes,
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
        let residual = self.problem.residual(self.paired, &modelled);
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

    fn derivatives(&self, point: &Iterate, _: DerivativePrecision) -> Option<Vec<Vec<f64>>> {
        self.problem.slopes_at(point, self.paired, self.priors)
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

impl Problem<'_> {
    /// Where parameters come to rest at these sizes of the error, with derivatives taken there, and the
    /// evidence by these.
    pub(super) fn settled(
        &self,
        paired: &PairedModes,
        start: Iterate,
        derivatives: Vec<Vec<f64>>,
        (priors, sizes): (&[Prior], &ErrorSizes),
    ) -> Option<Rest> {
        let factor = Cholesky::of(paired.comparison.count(), &paired.comparison.covariance(sizes))?;
        let descent = Descent { problem: self, paired, factor, priors };
        let point = descend(&descent, start, Some(derivatives), &settings(DERIVATIVES))?.point;
        let derivatives = descent.derivatives(&point, DerivativePrecision::Rough)?;
        let promised_there = descent.promised(&point, &descent.equations(&point, &derivatives, &()));
        let (linear, evidence) =
            self.evidence(&point, priors, &derivatives, (&paired.comparison, Some(sizes)))?;
        // Of a fit at errors of nothing that finds they are not, the parameters are still to move, however
        // still they stand there.
        let factor = Cholesky::of(paired.comparison.count(), &paired.comparison.covariance(&evidence.sizes))?;
        let there = Descent { factor, ..descent };
        let promised = there.promised(&point, &there.equations(&point, &derivatives, &()));
        Some(Rest { point, derivatives, linear, evidence, promised_there, promised })
    }

    /// [`Problem::slopes`] by all coordinates.
    pub(super) fn slopes_at(
        &self,
        point: &Iterate,
        paired: &PairedModes,
        priors: &[Prior],
    ) -> Option<Vec<Vec<f64>>> {
        let all = 0..point.hypothesis.coordinates.len();
        self.slopes(&point.hypothesis, paired, &point.modelled, &point.residual, priors, all)
    }
}
