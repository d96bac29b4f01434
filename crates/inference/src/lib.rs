//! Parameters, priors, the one damped Gauss–Newton method of the program, and what a fit leaves uncertain.
//!
//! Every fit minimises the same thing: a weighted sum of squared residuals and the squared deviations of the
//! parameters from what was known before, −2 ln(likelihood × prior) up to a constant. What differs is the
//! model. So a fit is a [`LeastSquares`] problem (a model, its derivatives, its normal equations) and
//! [`descend`] is its solution:
//!
//! * [`Parameter`], [`Transform`]: how a physical quantity moves in a fit (as it is, by its logarithm, not at
//!   all), between which bounds, with which prior;
//! * [`NormalEquations`]: JᵀWJ and JᵀWr with the priors; held coordinates, and steps that stop at bounds;
//! * [`descend`]: damped Gauss–Newton steps that use derivatives for as long as they still serve;
//! * [`inflated_weight`]: weights that count a share of the signal as noise, so that sharp resonances do not
//!   decide where a fit from afar goes;
//! * [`Covariance`], [`jackknife`], [`autocorrelation`], [`variance_inflation`]: uncertainty;
//! * [`birge_ratio`]: by how much departures exceed what chance makes of them;
//! * [`interval95`], [`Z95`], [`SIGNIFICANT`]: the one convention of intervals and tests;
//! * [`normal_below`], [`chi_squared_above`], [`fisher_above`], …: tails of the distributions they rest on;
//! * [`QuadraticLikelihood`]: what one recording tells of parameters that others tell of as well, put
//!   together in closed form;
//! * [`each`]: many fits on all threads.
//!
//! ```
//! use jointscope_inference::{DerivativePrecision, LeastSquares, NormalEquations, Settings, descend};
//!
//! // y = exp(−q x) at three abscissae; q from a start far off.
//! struct Decay;
//! impl LeastSquares for Decay {
//!     type Point = f64;
//!     type Weights = ();
//!     type Derivatives = [f64; 3];
//!     type Equations = NormalEquations;
//!     const FIXED_WEIGHTS: bool = true;
//!     fn weights(&self, _: &f64) {}
//!     fn objective(&self, q: &f64, _: &()) -> f64 {
//!         [1.0, 2.0, 3.0].iter().map(|x: &f64| ((-0.5 * x).exp() - (-q * x).exp()).powi(2)).sum()
//!     }
//!     fn derivatives(&self, q: &f64, _: DerivativePrecision) -> Option<[f64; 3]> {
//!         Some([1.0, 2.0, 3.0].map(|x: f64| -x * (-q * x).exp()))
//!     }
//!     fn equations(&self, q: &f64, slopes: &[f64; 3], _: &()) -> NormalEquations {
//!         let mut equations = NormalEquations::zero(1);
//!         for (x, slope) in [1.0, 2.0, 3.0_f64].iter().zip(slopes) {
//!             equations.add(1.0, (-0.5 * x).exp() - (-q * x).exp(), &[*slope]);
//!         }
//!         equations
//!     }
//!     fn stepped(&self, q: &f64, equations: &NormalEquations, damping: f64) -> Option<f64> {
//!         Some(q + equations.step(damping)?[0])
//!     }
//! }
//! let fit = descend(&Decay, 2.0, None, &Settings::default()).unwrap();
//! assert!((fit.point - 0.5).abs() < 1e-6);
//! ```

mod birge;
mod descent;
mod distributions;
mod interval;
mod likelihood;
mod noise;
mod normal;
mod parameter;
mod problem;
mod products;
mod settings;
mod threads;
mod uncertainty;

pub use birge::birge_ratio;
pub use descent::{Descent, descend};
pub use distributions::{
    chi_squared_above, chi_squared_exceeded, fisher_above, normal_above, normal_below, student_exceeded,
};
pub use interval::{SIGNIFICANT, Z95, interval95};
pub use likelihood::QuadraticLikelihood;
pub use noise::inflated_weight;
pub use normal::NormalEquations;
pub use parameter::{Parameter, Transform};
pub use problem::{DerivativePrecision, LeastSquares};
pub use products::{dot, weighted_products, whitened};
pub use settings::{Convergence, Limit, Settings, StepDamping};
pub use threads::{each, each_used_up};
pub use uncertainty::{Covariance, autocorrelation, jackknife, variance_inflation};
