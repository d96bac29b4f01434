//! What a test would record of a structure, for tests.
#![allow(clippy::unwrap_used)]

use crate::Observation;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

/// The FRFs of a fixture, which have no noise but are known no better than to this variance, as a share of
/// each value's square.
pub(crate) fn simulated(
    truth: &Fixture,
    pairs: &[FrfPair],
    lines: &SpectralLines,
    variance: f64,
) -> Observation {
    observed(synthesize(truth, pairs, lines, Instrument::AsRecorded).unwrap(), variance)
}

/// FRFs that are known no better than to this variance, as a share of each value's square.
pub(crate) fn observed(frfs: FrfSet, variance: f64) -> Observation {
    let variance = frfs.all_values().iter().map(|value| variance * value.norm_sqr()).collect();
    Observation::new(&frfs.with_variance(variance).unwrap(), |_| true).unwrap()
}
