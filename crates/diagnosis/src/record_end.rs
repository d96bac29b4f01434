//! FRFs of records that ended while the structure still rang.

use crate::Observation;
use crate::drift::distinct;
use crate::modal::modes_options;
use crate::recorded_lines::is_short;
use jointscope_fixture::Fixture;
use jointscope_model_error::RecordEnd;
use jointscope_modes::ModesOptions;
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet};
use num_complex::Complex64;

/// FRFs as if records had not ended before the structure was silent, and where they ended; `None` where they
/// tell of no such end, and of more lines than a diagnosis uses: records as long hardly end too early.
pub fn restored(frfs: &FrfSet) -> Option<(FrfSet, RecordEnd)> {
    let observation = is_short(frfs).then(|| Observation::new(frfs, |_| true).ok())??;
    let counted = observation.lines().len();
    let (end, missing) = RecordEnd::of(observation.weighted(), &ModesOptions::default())?;
    // Lines at 0 Hz, which come first, are none of an observation.
    let at_rest = vec![Complex64::ZERO; frfs.lines().len() - counted];
    let of_frfs = missing.chunks_exact(counted);
    let missing: Vec<Complex64> =
        of_frfs.flat_map(|missing| at_rest.iter().chain(missing)).copied().collect();
    let accelerances = frfs.to_form(FrfForm::Accelerance).ok()?.plus(&missing);
    Some((accelerances.to_form(frfs.form()).ok()?, end))
}

/// The observation as if records had not ended before the structure was silent, and where they ended; `None`
/// where they tell of no such end.
pub(crate) fn without_early_end(
    observation: &Observation,
    fixture: &Fixture,
) -> Option<(Observation, RecordEnd)> {
    let (end, missing) = RecordEnd::of(observation.weighted(), &modes_options(observation, fixture))?;
    Some((observation.plus(&missing)?, end))
}

/// The observation as if records had not ended before the structure was silent, of each reference by its own
/// poles, where the structure drifted from one to the next: what still rang of a mode is out of phase by all
/// that its frequency is off. And where they ended, on the mean of all. `None` where one of them tells of no such
/// end by itself, or there is one only.
pub(crate) fn without_ends_of_references(
    observation: &Observation,
    fixture: &Fixture,
) -> Option<(Observation, RecordEnd)> {
    without_ends(observation, fixture, |pair| &pair.reference)
}

/// The same of each response by its own poles, where a sensor was moved from one to the next.
pub(crate) fn without_ends_of_responses(
    observation: &Observation,
    fixture: &Fixture,
) -> Option<(Observation, RecordEnd)> {
    without_ends(observation, fixture, |pair| &pair.response)
}

/// The same of the FRFs of each `channel` by themselves.
fn without_ends(
    observation: &Observation,
    fixture: &Fixture,
    channel: impl Fn(&FrfPair) -> &Channel,
) -> Option<(Observation, RecordEnd)> {
    let channels = distinct(observation.pairs().iter().map(&channel));
    let count = channels.len() as f64;
    if channels.len() < 2 {
        return None;
    }
    let mut mean = RecordEnd { after: 0.0, left: 0.0 };
    let n = observation.lines().len();
    let mut missing = vec![Complex64::ZERO; observation.values().len()];
    for shared in &channels {
        let part = observation.reduced(|_| true, |pair| channel(pair) == shared)?;
        let (end, own) = RecordEnd::of(part.weighted(), &modes_options(&part, fixture))?;
        mean.after += end.after / count;
        mean.left += end.left / count;
        let frfs = observation.pairs().iter().enumerate().filter(|(_, pair)| channel(pair) == shared);
        for ((frf, _), own) in frfs.zip(own.chunks_exact(n)) {
            missing[frf * n..][..n].copy_from_slice(own);
        }
    }
    Some((observation.plus(&missing)?, mean))
}
