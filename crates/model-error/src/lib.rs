//! A model's own error as a part of the likelihood: recordings and models compared by their modes.
//!
//! No model of a real structure is exact. Its natural frequencies are off by tenths of a per cent, its
//! damping ratios and residues by some per cent, where a recording's noise moves them by far less. Compared
//! line by line, such a model is refuted whatever else is right about it; compared by modes, each kind of
//! error has a size (Kennedy & O'Hagan, *J. R. Stat. Soc. B* 63 (2001) 425: model discrepancy as a part of
//! the likelihood), and hypotheses are weighed by the error that they leave.
//!
//! 1. **Recording.** [`RecordedModes::of`] fits all FRFs freely with common poles,
//!    H(s) = Σ s²A/(s² + 2ζωs + ω²) + residual terms, and gives the *features*: ln ω and ln ζ of each mode,
//!    its residue A in each FRF, each FRF's mass line and upper residual. Their covariance is the Cramér–Rao
//!    bound times χ² per degree of freedom where that is above one. Modes too low to be told from a mass line
//!    are a part of it; where there are any, lines begin above them, and mass lines have the errors of their
//!    shapes ([`RecordedModes::beside`]).
//!    What FRFs lack whose records ended while modes still rang, [`RecordEnd::of`] tells beforehand.
//! 2. **Model.** [`ModelledModes::of`] finds a fixture's poles by the peaks of its FRFs and the modes of the
//!    recording, follows them by analytic continuation of the FRFs as they would be recorded, and takes
//!    residues by contour integrals; [`ModelledModes::near`] sets out from poles that are known.
//!    [`modes_within`] counts the modes in a band.
//! 3. **Pairing.** [`Pairing::of`] tells which mode of the model is which of the recording, by frequency and
//!    shape, and what modes without a partner cost.
//! 4. **Error.** [`ErrorSizes`] are relative standard deviations by kind: natural frequency, damping ratio,
//!    shape (in phase and in quadrature), mass line, upper residual; and, of the test, gains of records and
//!    the places of sensors and impacts. [`SharedFeatures`] makes the covariance S = noise + Σ size²·kind of
//!    them, with the model's [`Shapes`] and [`StrikeSlopes`].
//! 5. **Evidence.** [`Linear::evidence`] gives the evidence of a model that is linear in its parameters, with
//!    the sizes at their most probable ([`ModelEvidence`]); [`Linear::mean_sizes`] their root mean squares.
//!
//! Where a model is exact, features differ from the recording's by the stated deviations: over 100 recordings
//! with noise the mean square of the normalised differences is 1 within a tenth (`tests/all/calibration.rs`).
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_lumped::{Instrument, synthesize};
//! use jointscope_model_error::{
//!     ErrorSizes, Expected, Linear, ModelledModes, Pairing, RecordedModes, Shapes, SharedFeatures, WeightedFrfs,
//! };
//! use jointscope_modes::ModesOptions;
//! use jointscope_spectra::{FrfPair, SpectralLines};
//!
//! // Masses of 2 kg and 3 kg on a spring: f = √(k/μ)/2π, μ = 1.2 kg.
//! let fixture = |stiffness: &str| Fixture::from_json(&r#"{
//!   "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 } },
//!   "joints": { "J": { "from": "1", "to": "2", "stiffness": [[STIFFNESS, 0], [0, 0]] } },
//!   "damping": { "modal_ratios": [0.01] } }"#.replace("STIFFNESS", stiffness));
//! let (structure, model) = (fixture("5.00e6")?, fixture("5.05e6")?);
//!
//! // A recording of the structure, with noise of 0.1 %.
//! let pairs = [FrfPair::transverse("1", "1"), FrfPair::transverse("2", "1")];
//! let frfs = synthesize(&structure, &pairs, &SpectralLines::even(20.0, 2.5, 200)?, Instrument::AsRecorded)?;
//! let variance: Vec<f64> = frfs.all_values().iter().map(|v| 1e-6 * v.norm_sqr()).collect();
//! let weights: Vec<f64> = variance.iter().map(|v| 2.0 / v).collect(); // 1/variance of the real part, and of the imaginary part
//! let frfs = frfs.with_variance(variance)?;
//!
//! let recording = WeightedFrfs { frfs: &frfs, weights: &weights };
//! let recorded = RecordedModes::of(recording, &ModesOptions::default(), |_| Expected::default()).ok_or("no modes")?;
//! let natural = (5e6_f64 / 1.2).sqrt();
//! assert!((recorded.modes[0].pole.omega / natural - 1.0).abs() < 1e-6);
//!
//! // The model's spring is 1 % too stiff, its natural frequency 0.5 % too high.
//! let modelled = ModelledModes::of(&model, &recorded).ok_or("no poles")?;
//! let ratio = modelled.modes[0].pole.omega / recorded.modes[0].pole.omega;
//! assert!((ratio - 1.01_f64.sqrt()).abs() < 1e-6);
//!
//! // As an error of the model, unexplained, that is what its size says.
//! let pairing = Pairing::of(&recorded, &modelled);
//! let shapes = Shapes::of(&model, &recorded, &modelled.poles()).ok_or("no shapes")?;
//! let comparison = SharedFeatures::new(&recorded, &pairing, &modelled, &shapes);
//! let difference = comparison.residual(&recorded, &recorded.features(), &modelled, &pairing);
//! let linear = Linear { difference, slopes: Vec::new() };
//! let evidence = linear.evidence(&comparison, &ErrorSizes::default(), None).ok_or("no evidence")?;
//! assert!((0.002..0.006).contains(&evidence.sizes.frequency) && evidence.sizes.shape < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
mod basis;
mod density;
mod errors;
mod evidence;
mod expected;
mod free_fit;
mod matching;
mod modelled;
mod most_probable;
mod of_recording;
mod outline;
mod poles;
mod projection;
mod record_end;
mod recorded;
mod recording;
mod relative;
mod settings;
mod shapes;
mod strikes;
mod structural;

pub use basis::Pole;
pub use errors::{
    DAMPING, ErrorSizes, FREQUENCY, GAIN, KINDS, SHAPE, STRIKE, SharedFeatures, SizePrior, UPPER_RESIDUAL,
};
pub use evidence::{Linear, ModelEvidence};
pub use expected::Expected;
pub use matching::Pairing;
pub use modelled::ModelledModes;
pub use poles::{ModelledMode, modes_within};
pub use record_end::RecordEnd;
pub use recorded::{RecordedMode, RecordedModes};
pub use recording::WeightedFrfs;
pub use shapes::Shapes;
pub use strikes::StrikeSlopes;
pub use structural::Structural;
