//! FRFs of records that ended while the structure still rang.

use crate::modal::modes_options;
use crate::{Hypothesis, Observation};
use jointscope_model_error::{RecordEnd, WeightedFrfs};

/// The observation as if records had not ended before the structure was silent, and where they ended; as it is
/// where they tell of no such end.
pub(crate) fn without_early_end(
    observation: Observation,
    nominal: &Hypothesis,
) -> (Observation, Option<RecordEnd>) {
    let restored = || {
        let options = modes_options(&observation, &nominal.to_fixture().ok()?);
        let recording = WeightedFrfs { frfs: observation.frfs(), weights: observation.weights() };
        let (end, missing) = RecordEnd::of(recording, &options)?;
        Some((observation.plus(&missing)?, end))
    };
    match restored() {
        Some((restored, end)) => (restored, Some(end)),
        None => (observation, None),
    }
}
