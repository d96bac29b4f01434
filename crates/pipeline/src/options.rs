//! What to use of a measurement.

use crate::Error;
use jointscope_diagnosis::DiagnosisOptions;
use jointscope_estimation::{EstimateOptions, ResponseWindow};
use jointscope_nonlinear::NonlinearOptions;
use jointscope_spectra::FrfSet;

/// What to use of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Lines in use, FRFs to hold out, numbers to take as exact. Bands in Hz.
    pub diagnosis: DiagnosisOptions,
    /// How FRFs follow from hits.
    pub estimate: EstimateOptions,
    /// Whether numbers of the fixture that belong to no structure together are taken as they are.
    pub as_stated: bool,
}

impl Default for Options {
    /// All lines and FRFs; FRFs by H1, under an exponential window where a record ends before the motion does.
    fn default() -> Self {
        let estimate = EstimateOptions {
            response_window: ResponseWindow::Auto,
            zero_padding: 1,
            ..EstimateOptions::default()
        };
        Options { diagnosis: DiagnosisOptions::default(), estimate, as_stated: false }
    }
}

impl Options {
    pub(crate) fn nonlinear(&self) -> NonlinearOptions {
        NonlinearOptions { band: self.diagnosis.band, exact: self.diagnosis.exact }
    }

    /// Refuses a choice of lines that leaves none.
    pub(crate) fn check(&self, frfs: &FrfSet) -> Result<(), Error> {
        let within = |hz: f64, &(from, to): &(f64, f64)| hz >= from && hz <= to;
        let in_use = |hz: f64| {
            hz > 0.0
                && self.diagnosis.band.is_none_or(|band| within(hz, &band))
                && !self.diagnosis.exclude.iter().any(|band| within(hz, band))
        };
        let hz = frfs.lines().hz();
        match (hz.first(), hz.last()) {
            (Some(&first), Some(&last)) if !hz.iter().any(|hz| in_use(*hz)) => {
                Err(Error::NoLineInUse { first, last })
            }
            _ => Ok(()),
        }
    }
}
