//! FRFs from hammer hits: spectra of force and responses, averaged over the hits at each struck point.
//!
//! * [`Estimate`]: H1, H2 or Hv of every response to every struck point, with coherence, averages and
//!   variances;
//! * [`HitReport`], [`Fault`]: what was seen in each hit, and why one was rejected: double hits, overloads,
//!   records that start too late;
//! * [`Excitation`]: what the hammer put in at a struck point, and up to which frequency;
//! * [`EstimateOptions`]: estimator, weights, baselines, windows.
//!
//! ```
//! use jointscope_estimation::{Estimate, EstimateOptions};
//! use jointscope_hits::{Hit, MeasuredMotion, Response};
//! use jointscope_spectra::Channel;
//!
//! // A mass of 2 kg hit by half a sine: its acceleration is the force over the mass.
//! let half_sine = |i: usize| 80.0 * (std::f64::consts::PI * (i as f64 - 39.5) / 6.0).sin();
//! let pulse = |i: usize| if (40..46).contains(&i) { half_sine(i) } else { 0.0 };
//! let force: Vec<f64> = (0..1024).map(pulse).collect();
//! let hit = |number: u32| {
//!     let acceleration = force.iter().map(|f| f / 2.0).collect();
//!     let response = Response::new(Channel::transverse("4"), MeasuredMotion::Acceleration, acceleration);
//!     Hit::new(number, 1.0 / 4096.0, 0.0, Channel::transverse("1"), force.clone(), vec![response])
//! };
//! let estimate = Estimate::of(&[hit(1)?, hit(2)?], &EstimateOptions::default())?;
//! let accelerance = estimate.frfs.values(0)[100];
//! assert_eq!(estimate.frfs.lines().hz()[100], 400.0);
//! assert!((accelerance - 0.5).norm() < 1e-12);
//! assert_eq!(estimate.frfs.averages(0), Some(2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Windows
//! An exponential window cannot be taken out of an FRF again: subtracting its decay from the damping of
//! fitted modes is exact, but an FRF by line has none. It need not be taken out either. The window lies on
//! force and responses alike, and then e^(−δt) turns Y = H·X at s = iω into the same relation at s = δ + iω:
//! what is estimated is the structure's own FRF, read beside the imaginary axis. [`Estimate::decay`] states
//! δ, and models read at that s compare without error (the effect `exponential_window`).

mod average;
mod band;
mod baseline;
mod conditioned;
mod decay;
mod error;
mod estimate;
mod fault;
mod hum;
mod options;
mod overload;
mod plausibility;
mod pulse;
mod remark;
mod remarks;
mod report;
mod settings;

pub use error::EstimateError;
pub use estimate::Estimate;
pub use fault::{Fault, Signal};
pub use options::{Baseline, EstimateOptions, Estimator, ForceWindow, ResponseWindow, Weighting};
pub use remark::Remark;
pub use report::{Excitation, HitReport};
