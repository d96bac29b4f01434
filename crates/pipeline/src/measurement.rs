//! What a test recorded.

use crate::MeasurementError;
use jointscope_fixture::Fixture;
use jointscope_hits::Hit;
use jointscope_recordings::{
    Hits, Level, ReadOptions, Recording, RecordingError, Source, TimeHistories, hits_of,
};
use jointscope_spectra::FrfSet;

/// What a test recorded, in the fixture's terms and SI units.
#[derive(Debug, Clone, PartialEq)]
pub enum Measurement {
    /// FRFs at one level or at several.
    Frfs(Recording),
    /// Force and responses of hammer hits over time.
    Hits(Hits),
}

impl Measurement {
    /// Reads a test of `fixture` from its files. Files with time histories alone are hits; beside FRFs, time
    /// histories are left aside.
    ///
    /// # Errors
    /// See [`MeasurementError`].
    pub fn of(
        sources: &[Source],
        fixture: &Fixture,
        options: &ReadOptions,
    ) -> Result<Self, MeasurementError> {
        match Recording::of(sources, fixture, options) {
            Ok(recording) => Ok(Measurement::Frfs(recording)),
            Err(RecordingError::OnlyTimeHistories { .. }) => {
                Ok(Measurement::Hits(hits_of(sources, Some(fixture), options)?))
            }
            Err(error) => Err(error.into()),
        }
    }
}

/// FRFs of one level, of which no more is known.
impl From<FrfSet> for Measurement {
    fn from(frfs: FrfSet) -> Self {
        let recorded_forms = vec![frfs.form(); frfs.pairs().len()];
        Measurement::Frfs(Recording {
            levels: vec![Level { held: None, frfs, recorded_forms, window_decay: 0.0 }],
            time_histories: TimeHistories::default(),
            notes: Vec::new(),
        })
    }
}

/// Hits of which no more is known.
impl From<Vec<Hit>> for Measurement {
    fn from(hits: Vec<Hit>) -> Self {
        Measurement::Hits(Hits { hits, notes: Vec::new() })
    }
}
