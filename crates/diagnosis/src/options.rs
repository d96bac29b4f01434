//! What may be asked of a diagnosis, and why there may be none.

use crate::settings::Settings;
use jointscope_spectra::{FrfPair, FrfSet, SpectraError};
use std::time::Duration;

/// What to leave out of a diagnosis, and what to hold out of its fits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DiagnosisOptions {
    /// The band to use, Hz; everything without.
    pub band: Option<(f64, f64)>,
    /// Bands to leave out, Hz.
    pub exclude: Vec<(f64, f64)>,
    /// FRFs to hold out; one is chosen where there are four or more and none is named.
    pub hold_out: Vec<FrfPair>,
    /// FRFs of the same structure as it was known to be right: what is diagnosed is what has changed since.
    pub baseline: Option<FrfSet>,
    /// How long a search may take; what it has then is the answer. Without, its limit of work is all that
    /// ends it ([`Settings::work`]).
    pub time_limit: Option<Duration>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
    /// Whether the FRFs were estimated from hits: they carry leakage and errors that neighbouring lines
    /// share, and no name may live on those.
    pub estimated: bool,
    /// How the search goes.
    pub settings: Settings,
}

impl DiagnosisOptions {
    /// Whether a line, Hz, is within the band that is asked for, and in none that is to be left out.
    pub fn asks_for(&self, hz: f64) -> bool {
        self.band.is_none_or(|(from, to)| hz >= from && hz <= to) && !is_within(&self.exclude, hz)
    }
}

/// Whether a line, Hz, is in one of these bands.
pub(crate) fn is_within(bands: &[(f64, f64)], hz: f64) -> bool {
    bands.iter().any(|(from, to)| hz >= *from && hz <= *to)
}

/// Why a recording cannot be diagnosed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DiagnosisError {
    /// The set cannot be used.
    #[error("no usable spectral line is left: {0}")]
    Lines(#[from] SpectraError),
    /// The fixture predicts nothing finite.
    #[error("the fixture's model predicts no finite FRFs: {0}")]
    Model(#[from] crate::PredictionError),
    /// The baseline and the recording have no modes in common.
    #[error("baseline and recording have no FRFs or no modes in common")]
    Baseline,
    /// An FRF to be held out is not there, or nothing would be left.
    #[error("FRF {0} cannot be held out: the recording does not have it, or has nothing else")]
    HoldOut(String),
}
