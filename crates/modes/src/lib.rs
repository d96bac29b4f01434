//! Modal parameters from FRFs: natural frequencies, damping ratios, mode shapes and residual terms, each with
//! its standard deviation.
//!
//! [`ModalAnalysis::of`] goes three steps:
//!
//! 1. **Poles by order.** The poly-reference least-squares complex-frequency estimator (pLSCF, known as
//!    PolyMAX) fits H(ω) = B(z)A(z)⁻¹, z = exp(iωT), for rising orders; poles that stay from order to order
//!    make the columns of the [stabilisation chart](ChartPole).
//! 2. **Selection.** Of the columns those are modes that χ² cannot do without, noise and look-elsewhere
//!    counted; or the ones that the analyst picks ([`ModesOptions::pick`]).
//! 3. **Maximum likelihood.** Poles, participations, residues and residual terms are refined on
//!    α(s) = Σ [ρ/(s − λ) + ρ̄/(s − λ̄)] + L/s² + U with the FRFs' variances as weights, residues eliminated.
//!    The inverse of the information is the Cramér–Rao bound that the standard deviations are taken from;
//!    estimates reach it (`tests/all/statistics.rs`, `docs/reference/modes.md`).
//!
//! Then each FRF is asked by itself. Where they do not agree on a pole, as after a structure has warmed up
//! between hits, the mode [drifts](DriftingMode): frequency and damping ratio are means over the FRFs, and
//! their deviation is the scatter of one more.
//!
//! Any form of FRF does, any number of responses and references, uneven lines and gaps. Variances are those
//! of the set, or come from coherence and averages, or from the scatter of the lines and, in the end, from
//! what the modes leave.
//!
//! ```
//! use jointscope_modes::{ModalAnalysis, ModesOptions};
//! use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
//! use num_complex::Complex64;
//!
//! // A mass of 2 kg with one mode of 1 kg at 50 Hz, damped by 1 %; lines 1 Hz apart.
//! let lines = SpectralLines::even(1.0, 1.0, 100)?;
//! let natural = 2.0 * std::f64::consts::PI * 50.0;
//! let values = lines.omegas().map(|omega| {
//!     let s = Complex64::new(0.0, omega);
//!     0.5 / (s * s) + 1.0 / (s * s + 0.02 * natural * s + natural * natural)
//! });
//! let pair = FrfPair::transverse("1", "1");
//! let frfs = FrfSet::new(lines.clone(), FrfForm::Receptance, vec![pair], values.collect())?;
//!
//! let analysis = ModalAnalysis::of(&frfs, &ModesOptions::default())?;
//! let mode = &analysis.modes[0];
//! assert!((mode.frequency - 50.0).abs() < 1e-4 && (mode.damping_ratio - 0.01).abs() < 1e-6);
//! assert!((mode.modal_mass.unwrap() - 1.0).abs() < 1e-3);
//! assert!((analysis.residual_terms[0].lower[0].re - 0.5).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`ModeIndicator`] shows how many modes there are before any is looked for: the singular values of the
//! matrix of FRFs, line by line. [`match_modes`] pairs measured modes with those of a model by frequency and
//! shape ([`mac`]).

mod analysis;
mod error;
mod gram;
mod indicator;
mod likelihood;
mod matching;
mod mode;
mod model;
mod moved;
mod noise;
mod observed;
mod polynomial;
mod scatter;
mod selection;
mod settings;
mod stabilization;
mod uneven_scale;

pub use analysis::{ModalAnalysis, ModesOptions, ResidualTerms};
pub use error::ModesError;
pub use indicator::ModeIndicator;
pub use matching::{ExpectedMode, Match, Matches, match_modes};
pub use mode::{Mode, mac};
pub use scatter::DriftingMode;
pub use stabilization::{ChartPole, Stability};
pub use uneven_scale::UnevenScale;
