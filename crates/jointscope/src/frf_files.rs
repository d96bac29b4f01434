//! FRFs that `--also uff` writes beside an answer: what was measured, what models make of it, and the
//! difference.

use jointscope_check::{RecordingCheck, fixture_frfs};
use jointscope_decomposition::{FittedFrfs, JointFit};
use jointscope_fixture::Fixture;
use jointscope_modes::ModalAnalysis;
use jointscope_pipeline::{Answer, Outcome};
use jointscope_spectra::{FrfSet, SpectraError};
use num_complex::Complex64;

/// The FRFs behind an answer by what they are: `measured`, as the search used them, with their coherence; of
/// each model (`nominal`, `refitted`, and `repaired` where it is another) the FRFs and `residual-…`, measured
/// less modelled. All are accelerances in SI units. Empty where the answer comes from motion over time or
/// from levels.
///
/// # Errors
/// A model whose FRFs are not finite.
pub fn model_frfs(answer: &Answer) -> Result<Vec<(String, FrfSet)>, SpectraError> {
    let Outcome::Linear(diagnosis) = &answer.outcome else { return Ok(Vec::new()) };
    let search = &diagnosis.search;
    let mut models = vec![("nominal", &search.nominal), ("refitted", &search.refitted)];
    if !diagnosis.findings.is_empty() {
        models.push(("repaired", &search.repaired));
    }
    let modelled = models.into_iter().map(|(name, fit)| (name, fit.predicted.clone()));
    let observation = &diagnosis.observation;
    let mut measured = observation.frfs().clone();
    for index in 0..measured.pairs().len() {
        if let Some(coherence) = observation.coherence(index) {
            measured.set_coherence(index, coherence.to_vec())?;
        }
    }
    beside(&measured, modelled)
}

/// The FRFs behind a modal analysis: `measured`, `rebuilt` from the modes, and `residual-rebuilt`.
///
/// # Errors
/// Modes whose FRFs are not finite.
pub fn rebuilt_frfs(analysis: &ModalAnalysis) -> Result<Vec<(String, FrfSet)>, SpectraError> {
    let rebuilt = (0..analysis.pairs().len()).flat_map(|frf| analysis.rebuilt(frf).iter().copied());
    beside(analysis.measured(), [("rebuilt", rebuilt.collect())])
}

/// The FRFs behind a check: `measured`, those of the fixture as it stands (`nominal`), and
/// `residual-nominal`; `measured` alone where the fixture has none.
///
/// # Errors
/// A fixture whose FRFs are not finite.
pub fn checked_frfs(recording: &RecordingCheck) -> Result<Vec<(String, FrfSet)>, SpectraError> {
    beside(&recording.measured, recording.modelled.iter().map(|values| ("nominal", values.clone())))
}

/// The FRFs behind a joint from all FRFs, or behind several: `measured`, on the FRFs and lines that were
/// fitted, those of the fixture with its own joints (`nominal`), those of the fixture with the joints found
/// and its quantities where the fit has them (`fitted`), and `residual-…` of each.
///
/// # Errors
/// A model whose FRFs are not finite.
pub fn fitted_frfs(fit: &JointFit, fixture: &Fixture) -> Result<Vec<(String, FrfSet)>, SpectraError> {
    let FittedFrfs { measured, modelled } = &*fit.fitted;
    let nominal = fixture_frfs(fixture, measured).map(|frfs| ("nominal", frfs.all_values().to_vec()));
    beside(measured, nominal.into_iter().chain([("fitted", modelled.clone())]))
}

/// Measured FRFs, those of models, and what is left.
fn beside<'a>(
    measured: &FrfSet,
    modelled: impl IntoIterator<Item = (&'a str, Vec<Complex64>)>,
) -> Result<Vec<(String, FrfSet)>, SpectraError> {
    let with = |values: Vec<Complex64>| {
        FrfSet::new(measured.lines().clone(), measured.form(), measured.pairs().to_vec(), values)
    };
    let mut sets = vec![("measured".to_owned(), measured.clone())];
    for (name, values) in modelled {
        let left = measured.all_values().iter().zip(&values).map(|(measured, model)| measured - model);
        let left = left.collect();
        sets.push((name.to_owned(), with(values)?));
        sets.push((format!("residual-{name}"), with(left)?));
    }
    Ok(sets)
}
