//! Spectral lines and sets of frequency response functions (FRFs) with their variances.
//!
//! * [`SpectralLines`]: the frequencies of a test in Hz, ascending, shared by everything measured on them;
//! * [`FrfForm`]: receptance, mobility or accelerance, and the factors (iω)ⁿ between them;
//! * [`FrfSet`]: FRFs between [`Channel`]s, all lines of all FRFs in one contiguous block, with
//!   variance, coherence and averages where they are known.
//!
//! ```
//! use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
//! use num_complex::Complex64;
//!
//! let lines = SpectralLines::new(vec![100.0, 102.5])?;
//! let pair = FrfPair::new(Channel::transverse("4"), Channel::transverse("1"));
//! let accelerance = vec![Complex64::new(-0.5, 0.01), Complex64::new(-0.4, 0.02)];
//! let set = FrfSet::new(lines, FrfForm::Accelerance, vec![pair], accelerance)?;
//! let receptance = set.to_form(FrfForm::Receptance)?;
//! let omega = 2.0 * std::f64::consts::PI * 100.0;
//! assert!((receptance.values(0)[0].re - 0.5 / (omega * omega)).abs() < 1e-18);
//! # Ok::<(), jointscope_spectra::SpectraError>(())
//! ```

mod form;
mod frf_set;
mod lines;
mod median;
mod serialization;

pub use form::FrfForm;
pub use frf_set::{Channel, Dof, FrfPair, FrfSet};
pub use lines::{SpectralLines, in_sentence, in_text};
pub use median::median;
pub use serialization::complex;

/// What makes spectral lines or a set of FRFs impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpectraError {
    /// There are no lines.
    #[error("there are no spectral lines")]
    NoLines,
    /// A frequency is negative, infinite or missing.
    #[error("spectral line {index} has the frequency {frequency} Hz: a finite one, zero or above, is needed")]
    BadFrequency {
        /// Index of the line, from 0.
        index: usize,
        /// The frequency found, Hz.
        frequency: f64,
    },
    /// Lines out of order or twice.
    #[error(
        "spectral lines must ascend: {frequency} Hz at index {index} follows {previous} Hz; sort them by frequency, each once"
    )]
    NotAscending {
        /// Index of the offending line, from 0.
        index: usize,
        /// Its frequency, Hz.
        frequency: f64,
        /// The frequency before it, Hz.
        previous: f64,
    },
    /// The block of values does not have one value per FRF and line.
    #[error("{frfs} FRFs on {lines} spectral lines need {} values, not {found}", frfs * lines)]
    Size {
        /// Number of FRFs.
        frfs: usize,
        /// Number of lines.
        lines: usize,
        /// Number of values given.
        found: usize,
    },
    /// A value is not a finite number.
    #[error("FRF {frf} holds a value that is not a finite number at {} Hz", in_text(*frequency))]
    NotFinite {
        /// Name of the FRF, response/reference.
        frf: String,
        /// The line, Hz.
        frequency: f64,
    },
    /// The same FRF was given twice.
    #[error("FRF {0} was given twice")]
    Twice(String),
    /// An accelerance or mobility has no receptance at 0 Hz.
    #[error("the line at 0 Hz has no {0}: leave it out first")]
    NothingAtZero(&'static str),
    /// A variance is negative or not a finite number.
    #[error(
        "the variance of FRF {frf} at {} Hz is {}: a finite one, zero or above, is needed",
        in_text(*frequency),
        if *variance < 0.0 { "negative" } else { "beyond all numbers" }
    )]
    BadVariance {
        /// Name of the FRF.
        frf: String,
        /// The line, Hz.
        frequency: f64,
        /// The variance found.
        variance: f64,
    },
}
