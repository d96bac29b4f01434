//! What to use of a measurement.

use crate::Error;
use jointscope_diagnosis::DiagnosisOptions;
use jointscope_estimation::EstimateOptions;
use jointscope_nonlinear::NonlinearOptions;
use jointscope_spectra::FrfSet;

/// Spectral lines that a diagnosis needs: as many as the blocks by which the error of a model is judged.
const FEWEST_LINES: usize = 8;

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
    /// All lines and FRFs; FRFs of hits as models ask for them.
    fn default() -> Self {
        Options {
            diagnosis: DiagnosisOptions::default(),
            estimate: EstimateOptions::for_models(),
            as_stated: false,
        }
    }
}

impl Options {
    pub(crate) fn nonlinear(&self) -> NonlinearOptions {
        NonlinearOptions {
            band: self.diagnosis.band,
            exclude: self.diagnosis.exclude.clone(),
            exact: self.diagnosis.exact,
        }
    }

    /// Refuses a choice of lines that leaves none, or so few that they tell neither a mode nor a misfit from
    /// noise.
    pub(crate) fn check(&self, frfs: &FrfSet) -> Result<(), Error> {
        let in_use = |hz: f64| hz > 0.0 && self.diagnosis.asks_for(hz);
        let hz = frfs.lines().hz();
        match (hz.first(), hz.last(), hz.iter().filter(|hz| in_use(**hz)).count()) {
            (Some(&first), Some(&last), 0) => Err(Error::NoLineInUse { first, last }),
            (.., lines) if lines < FEWEST_LINES => Err(Error::TooFewLines { lines, needed: FEWEST_LINES }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, FrfPair, SpectralLines};
    use num_complex::Complex64;

    fn on_lines(count: usize) -> FrfSet {
        let lines = SpectralLines::even(10.0, 10.0, count).unwrap_or_else(|error| panic!("{error}"));
        let pairs = vec![FrfPair::transverse("1", "1")];
        FrfSet::new(lines, FrfForm::Accelerance, pairs, vec![Complex64::ONE; count])
            .unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_recording_of_one_spectral_line_is_refused_for_too_few_lines() {
        let check = |count: usize| Options::default().check(&on_lines(count));
        assert_eq!(check(1), Err(Error::TooFewLines { lines: 1, needed: FEWEST_LINES }));
        assert_eq!(check(FEWEST_LINES), Ok(()));
        let mut options = Options::default();
        options.diagnosis.band = Some((0.0, 30.0));
        assert_eq!(options.check(&on_lines(20)), Err(Error::TooFewLines { lines: 3, needed: FEWEST_LINES }));
    }
}
