//! The best estimate of the joint, with noise and tolerances kept apart.

use jointscope_decomposition::{Analysis, MatrixAverage, Relation};
use jointscope_linalg::RealMatrix2;

use super::element::{Element, Kind};

/// Where an estimate comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    PlainMean,
    WeightedMean,
    MaximumLikelihood,
}

impl Method {
    pub fn words(self) -> &'static str {
        match self {
            Method::PlainMean => "plain mean over the band",
            Method::WeightedMean => "weighted mean over the band",
            Method::MaximumLikelihood => "maximum likelihood",
        }
    }
}

/// K and C with standard deviations from noise and from the fixture's tolerances. The fit's noise holds also what it costs that
/// a constant joint does not explain the FRFs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimate {
    pub method: Method,
    /// Whether it is of the matrices of eq (7) rather than of the joint's own k and c.
    pub paper: bool,
    value: (RealMatrix2, RealMatrix2),
    noise: (RealMatrix2, RealMatrix2),
    tolerance: Option<(RealMatrix2, RealMatrix2)>,
}

/// An element of an estimate, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Figure {
    pub value: f64,
    pub noise: f64,
    /// Not known for weighted means.
    pub tolerance: Option<f64>,
}

impl Figure {
    /// Noise and tolerance together, independent of each other.
    pub fn total(&self) -> f64 {
        self.noise.hypot(self.tolerance.unwrap_or(0.0))
    }

    /// Whether the figure could as well be zero.
    pub fn may_be_zero(&self) -> bool {
        self.value.abs() < 1.96 * self.total()
    }
}

impl Estimate {
    /// The maximum-likelihood joint; where there is none, the mean of what the relation gives.
    pub fn best(analysis: &Analysis) -> Self {
        Self::maximum_likelihood(analysis)
            .or_else(|| {
                let tolerance = Some(analysis.tolerance_of_averages());
                Self::weighted(analysis).map(|mean| Estimate { tolerance, ..mean })
            })
            .unwrap_or_else(|| Self::plain(analysis))
    }

    /// The exact joint's, whichever relation the spectra show.
    pub fn maximum_likelihood(analysis: &Analysis) -> Option<Self> {
        let fit = analysis.likelihood.as_ref().ok()?;
        let model = fit.model_std();
        let together =
            |a: &RealMatrix2, b: &RealMatrix2| (a.map(|e| e * e) + b.map(|e| e * e)).map(f64::sqrt);
        Some(Estimate {
            method: Method::MaximumLikelihood,
            paper: false,
            value: (fit.stiffness, fit.damping),
            noise: (together(&fit.stiffness_std, &model.0), together(&fit.damping_std, &model.1)),
            tolerance: Some(analysis.tolerance_of_likelihood()),
        })
    }

    pub fn weighted(analysis: &Analysis) -> Option<Self> {
        let average = analysis.averages.weighted.as_ref()?;
        Some(Self::mean(analysis, average, Method::WeightedMean, None))
    }

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
        Estimate {
            method,
            paper: analysis.spectrum.relation == Relation::Paper,
            value: (average.stiffness, average.damping),
            noise: (average.stiffness_std, average.damping_std),
            tolerance,
        }
    }

    pub fn figure(&self, kind: Kind, element: Element) -> Figure {
        Figure {
            value: element.of(&kind.of(self.value)),
            noise: element.of(&kind.of(self.noise)),
            tolerance: self.tolerance.map(|tolerance| element.of(&kind.of(tolerance))),
        }
    }
}
