//! One symmetric, passive k and c for the whole band, fitted to the FRFs themselves.

mod data;
mod parameters;
mod shift;
mod sums;

pub(crate) use shift::Optimum;

use crate::settings::constant_joint::{POOR_FIT, START_DAMPING_TIME, STEP_DAMPING};
use crate::settings::noise::{EXPLAINED, JACKKNIFE_BLOCKS};
use crate::{CrossingFrfs, DecompositionError, JointSpectrum, Sides};
use data::{Data, Part};
use jointscope_averaging::Band;
use jointscope_inference::{
    DerivativePrecision, LeastSquares, NormalEquations, Settings, descend, jackknife,
};
use jointscope_linalg::{Cholesky, Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;
use parameters::Parameters;

/// The maximum-likelihood joint.
#[derive(Debug, Clone, PartialEq)]
pub struct LikelihoodFit {
    /// K, symmetric: N/m, N/rad, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C, symmetric and passive (it never gives out energy): N·s/m, N·s/rad, N·m·s/rad.
    pub damping: RealMatrix2,
    /// Standard deviations of K.
    pub stiffness_std: RealMatrix2,
    /// Standard deviations of C.
    pub damping_std: RealMatrix2,
    /// Covariance of (k11, k12, k22, c11, c12, c22). As the deviations, it is widened by χ² per degree of
    /// freedom where that is above one.
    pub covariance: [[f64; 6]; 6],
    /// χ² per degree of freedom: 1 where a constant joint explains the FRFs within their noise.
    pub chi2_per_dof: f64,
    /// Covariance of (k11, k12, k22, c11, c12, c22) from how far they move when one of eight blocks of lines
    /// is left out (a jackknife): what a joint that is not quite constant, or a fixture that is not quite
    /// right, does to them. Zero where χ² gives no reason to look.
    pub model_covariance: [[f64; 6]; 6],
    /// Whether c would give out energy if it were free, and was held to c = v vᵀ.
    pub is_on_the_boundary: bool,
    /// Complex values fitted.
    pub values: usize,
}

/// Fits a constant k + sc (s = iω, or δ + iω under an exponential window) to the FRFs across the joint on the
/// lines in `band` (all usable ones without).
///
/// With X = (k⁻¹ + T)⁻¹, T = β33 + R α22 Rᵀ, an FRF is rational in k, and resonances make a trap of every
/// poor start. But (I − X T) k = X is linear: solved with the measured X and the last round's (I + T k)⁻¹ as
/// weight, it leads close to the optimum within a few rounds, from the spectrum's medians or from `nominal`.
/// Levenberg–Marquardt with analytic derivatives goes on from there and from the starts themselves, until one
/// explains the FRFs; the lowest χ² is kept. Where c comes out giving off energy, it is fitted again as c = v
/// vᵀ, the boundary of what is passive.
///
/// The fit weighs every FRF by the variance it carries; FRFs without variances weigh alike. Where χ² says
/// that a constant joint does not explain the FRFs, a jackknife over the band says what that leaves
/// uncertain.
///
/// # Errors
/// No usable line in the band, or FRFs that leave an element of k or c undetermined.
pub fn maximum_likelihood(
    frfs: &FrfSet,
    sides: &Sides,
    spectrum: &JointSpectrum,
    band: Option<Band>,
    nominal: Option<RealMatrix2>,
) -> Result<LikelihoodFit, DecompositionError> {
    let plan = CrossingFrfs::of(frfs, sides)?;
    let data = Data::new(frfs, (&plan.layout, sides), spectrum, band)?;
    let all = data.whole();
    let starts = [Some(start_of(spectrum)), nominal].into_iter().flatten();
    let starts = starts.filter_map(|k| Parameters::of(k, k.scale(START_DAMPING_TIME), spectrum.scalar));
    let linear = data.linear(spectrum);
    // The linear rounds mislead where the model is far from right; plain steps do where the start is.
    let starts = starts.flat_map(|start| [(start, true), (start, false)]);
    let mut best: Option<(f64, Parameters)> = None;
    for (start, is_linear) in starts {
        let (chi2, joint) = all.fit(if is_linear { data.linear_rounds(&linear, start) } else { start });
        let lower = best.is_none_or(|(lowest, _)| chi2 < lowest);
        if lower && chi2.is_finite() && joint.k[0] > 0.0 {
            best = Some((chi2, joint));
            if chi2 <= EXPLAINED * data.degrees(&joint) {
                break;
            }
        }
    }
    let (mut chi2, mut joint) = best.ok_or(DecompositionError::NoFit("no start gives finite FRFs"))?;
    if !joint.is_passive() {
        (chi2, joint) = all.fit(joint.on_the_boundary());
    }
    let mut fit = data.result(chi2, &joint)?;
    if fit.chi2_per_dof > EXPLAINED {
        fit.model_covariance = data.jackknife(&joint);
    }
    Ok(fit)
}

impl LikelihoodFit {
    /// Whether one constant k and c explains the FRFs within their noise.
    pub fn explains(&self) -> bool {
        self.chi2_per_dof <= POOR_FIT
    }

    /// Standard deviations of K and C from [`LikelihoodFit::model_covariance`].
    pub fn model_std(&self) -> (RealMatrix2, RealMatrix2) {
        let std = |first: usize| {
            let s = |m: usize| self.model_covariance[first + m][first + m].sqrt();
            Matrix2::new(s(0), s(1), s(1), s(2))
        };
        (std(0), std(3))
    }
}

/// Robust start: medians over the solved lines.
fn start_of(spectrum: &JointSpectrum) -> RealMatrix2 {
    let at = |i: usize, j: usize| {
        let mut values: Vec<f64> = spectrum.solved.iter().map(|line| line.stiffness.at(i, j)).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let cross = 0.5 * (at(0, 1) + at(1, 0));
    Matrix2::new(at(0, 0), cross, cross, at(1, 1))
}

const UNDETERMINED: DecompositionError =
    DecompositionError::NoFit("the FRFs leave an element of k or c undetermined");

impl Data {
    /// The spread of the fits without each of the blocks, as a covariance of the fit to all.
    fn jackknife(&self, at: &Parameters) -> [[f64; 6]; 6] {
        let lines = self.lines();
        let blocks = JACKKNIFE_BLOCKS.min(lines);
        let without = |block: usize| {
            let left_out = block * lines / blocks..(block + 1) * lines / blocks;
            let Parameters { k, c, .. } = self.without(left_out).fit(*at).1;
            [k, c].concat()
        };
        let spread = jackknife(&(0..blocks).map(without).collect::<Vec<_>>());
        std::array::from_fn(|m| std::array::from_fn(|n| spread.at(m, n)))
    }

    /// Values that χ² has to spare for these parameters.
    fn degrees(&self, fitted: &Parameters) -> f64 {
        let free = Parameters { boundary: None, ..*fitted }.active().len();
        (2 * self.values()).saturating_sub(free).max(1) as f64
    }

    fn result(&self, chi2: f64, fitted: &Parameters) -> Result<LikelihoodFit, DecompositionError> {
        // Deviations are those of free elements, on the boundary too.
        let free = Parameters { boundary: None, ..*fitted };
        let active = free.active();
        let sums = self.whole().sums(&free).ok_or(UNDETERMINED)?;
        let information = sums.equations(&free).information;
        let inverse = Cholesky::of(active.len(), &information).ok_or(UNDETERMINED)?.inverse();
        let chi2_per_dof = chi2 / self.degrees(fitted);
        let widening = chi2_per_dof.max(1.0);
        let mut covariance = [[0.0; 6]; 6];
        for (a, &m) in active.iter().enumerate() {
            for (b, &n) in active.iter().enumerate() {
                covariance[m][n] = inverse[a * active.len() + b] * widening;
            }
        }
        let std = |first: usize| {
            let s = |m: usize| covariance[first + m][first + m].sqrt();
            Matrix2::new(s(0), s(1), s(1), s(2))
        };
        Ok(LikelihoodFit {
            stiffness: fitted.stiffness(),
            damping: fitted.damping(),
            stiffness_std: std(0),
            damping_std: std(3),
            covariance,
            chi2_per_dof,
            is_on_the_boundary: fitted.boundary.is_some(),
            model_covariance: [[0.0; 6]; 6],
            values: self.values(),
        })
    }
}

impl Part<'_> {
    /// χ² and parameters at the optimum next to `start`.
    fn fit(&self, start: Parameters) -> (f64, Parameters) {
        let settings = Settings { damping: STEP_DAMPING, ..Settings::default() };
        descend(self, self.placed(start), None, &settings).map_or((f64::INFINITY, start), |fit| fit.point)
    }

    fn placed(&self, parameters: Parameters) -> (f64, Parameters) {
        (self.chi2(&parameters), parameters)
    }
}

impl LeastSquares for Part<'_> {
    /// χ² and parameters.
    type Point = (f64, Parameters);
    type Weights = ();
    type Derivatives = ();
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Self::Point) {}

    fn objective(&self, (chi2, _): &Self::Point, _: &()) -> f64 {
        *chi2
    }

    /// In closed form, and taken with the residuals.
    fn derivatives(&self, _: &Self::Point, _: DerivativePrecision) -> Option<()> {
        Some(())
    }

    fn equations(&self, (_, current): &Self::Point, _: &(), _: &()) -> NormalEquations {
        match self.sums(current) {
            Some(sums) => sums.equations(current),
            None => NormalEquations::zero(current.active().len()),
        }
    }

    fn stepped(
        &self,
        (_, from): &Self::Point,
        normal: &NormalEquations,
        damping: f64,
    ) -> Option<Self::Point> {
        let step = normal.step(damping)?;
        Some(self.placed(from.stepped(&from.slots(&step))))
    }
}
