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

    /// What was asked for that a diagnosis of what depends on amplitude does not heed, a sentence each.
    pub(crate) fn unheeded_where_amplitude_matters(&self) -> Vec<String> {
        let DiagnosisOptions { baseline, time_limit, hold_out, .. } = &self.diagnosis;
        let windowed = self.estimate.force_window != EstimateOptions::for_models().force_window;
        let asked = [
            (baseline.is_some(), "the baseline"),
            (time_limit.is_some(), "the limit of time"),
            (!hold_out.is_empty(), "the FRFs to hold out"),
            (windowed, "the window over the force"),
        ];
        let unheeded: Vec<&str> = asked.into_iter().filter(|(is, _)| *is).map(|(_, what)| what).collect();
        match unheeded.as_slice() {
            [] => Vec::new(),
            all => vec![format!(
                "FRFs change with amplitude, and what depends on it was looked for: {} had no part in that",
                all.join(", ")
            )],
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
    fn what_a_diagnosis_by_amplitude_does_not_heed_is_told_and_nothing_where_all_is_heeded() {
        let mut options = Options::default();
        options.diagnosis.band = Some((10.0, 500.0));
        assert!(options.unheeded_where_amplitude_matters().is_empty());
        options.diagnosis.time_limit = Some(std::time::Duration::from_secs(5));
        options.diagnosis.baseline = Some(on_lines(20));
        let told = options.unheeded_where_amplitude_matters();
        assert!(told.len() == 1 && told[0].contains("the baseline, the limit of time"), "{told:?}");
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
