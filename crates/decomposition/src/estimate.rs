//! One estimate of K and C whatever the method, its deviation split into what noise and what the fixture's
//! tolerances do.

use crate::settings::estimates::NOT_DETERMINED;
use jointscope_inference::Z95;
use jointscope_linalg::RealMatrix2;

use crate::{Analysis, DynamicStiffnessPart, MatrixAverage, MatrixElement, Method, Relation};

/// K and C with standard deviations from noise and from the fixture's tolerances. The fit's noise holds also
/// what it costs that a constant joint does not explain the FRFs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointEstimate {
    /// Where it comes from.
    pub method: Method,
    /// Whether it is of the matrices of eq (7) rather than of the joint's own k and c.
    pub paper: bool,
    value: (RealMatrix2, RealMatrix2),
    noise: (RealMatrix2, RealMatrix2),
    tolerance: Option<(RealMatrix2, RealMatrix2)>,
}

/// An element of an estimate, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementFigure {
    /// Its value.
    pub value: f64,
    /// Standard deviation by noise (of a fit: and misfit).
    pub noise: f64,
    /// Standard deviation by the fixture's tolerances; not known for weighted means, part of the other one
    /// for the joint from all FRFs.
    pub tolerance: Option<f64>,
}

impl ElementFigure {
    /// Noise and tolerance together, independent of each other.
    pub fn total(&self) -> f64 {
        self.noise.hypot(self.tolerance.unwrap_or(0.0))
    }

    /// Whether the figure could as well be zero, at 95 %.
    pub fn may_be_zero(&self) -> bool {
        self.value.abs() < Z95 * self.total()
    }

    /// Whether it is known to half of its magnitude or better.
    pub fn is_determined(&self) -> bool {
        self.value.is_finite() && self.total() <= NOT_DETERMINED * self.value.abs()
    }
}

impl JointEstimate {
    /// The joint from all FRFs; where there is none, the maximum-likelihood joint, then the mean of what the
    /// relation gives.
    pub fn best(analysis: &Analysis) -> Self {
        let mean = || {
            let tolerance = Some(analysis.tolerance_of_averages());
            Self::weighted(analysis).map(|mean| JointEstimate { tolerance, ..mean })
        };
        Self::all_frfs(analysis)
            .or_else(|| Self::maximum_likelihood(analysis))
            .or_else(mean)
            .unwrap_or_else(|| Self::plain(analysis))
    }

    /// From all FRFs; the deviations hold noise, the fixture's tolerances and the model's error in one.
    pub fn all_frfs(analysis: &Analysis) -> Option<Self> {
        let fit = analysis.joint_fit.as_ref().ok()?;
        Some(JointEstimate {
            method: Method::AllFrfs,
            paper: false,
            value: (fit.stiffness, fit.damping),
            noise: fit.std(),
            tolerance: None,
        })
    }

    /// The exact joint's, whichever relation the spectra show.
    pub fn maximum_likelihood(analysis: &Analysis) -> Option<Self> {
        let fit = analysis.likelihood.as_ref().ok()?;
        let model = fit.model_std();
        let together =
            |a: &RealMatrix2, b: &RealMatrix2| (a.map(|e| e * e) + b.map(|e| e * e)).map(f64::sqrt);
        Some(JointEstimate {
            method: Method::MaximumLikelihood,
            paper: false,
            value: (fit.stiffness, fit.damping),
            noise: (together(&fit.stiffness_std, &model.0), together(&fit.damping_std, &model.1)),
            tolerance: Some(analysis.tolerance_of_likelihood()),
        })
    }

    /// The weighted mean over the band, where the lines' noise is known.
    pub fn weighted(analysis: &Analysis) -> Option<Self> {
        let average = analysis.averages.weighted.as_ref()?;
        Some(Self::mean(analysis, average, Method::WeightedMean, None))
    }

    /// The plain mean over the band.
    pub fn plain(analysis: &Analysis) -> Self {
        let tolerance = Some(analysis.tolerance_of_averages());
        Self::mean(analysis, &analysis.averages.plain, Method::PlainMean, tolerance)
    }

    fn mean(
        analysis: &Analysis,
        average: &MatrixAverage,
        method: Method,
        tolerance: Option<(RealMatrix2, RealMatrix2)>,
    ) -> Self {
        JointEstimate {
            method,
            paper: analysis.spectrum.relation == Relation::Paper,
            value: (average.stiffness, average.damping),
            noise: (average.stiffness_std, average.damping_std),
            tolerance,
        }
    }

    /// An element with its deviations.
    pub fn figure(&self, part: DynamicStiffnessPart, element: MatrixElement) -> ElementFigure {
        ElementFigure {
            value: element.of(&part.of(self.value)),
            noise: element.of(&part.of(self.noise)),
            tolerance: self.tolerance.map(|tolerance| element.of(&part.of(tolerance))),
        }
    }
}
