//! How a case is measured: lines, hammer, and FRFs that nobody records.

use jointscope_fixture::Fixture;
use jointscope_rig::HammerSetup;
use jointscope_spectra::{FrfPair, SpectraError, SpectralLines};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

/// Spectral lines of every recording: number and spacing in Hz.
const LINES: (usize, f64) = (400, 2.5);
/// FRFs that nobody records, at the most.
const UNSEEN: usize = 6;

/// The spectral lines of every recording.
pub(crate) fn recorded_lines() -> Result<SpectralLines, SpectraError> {
    SpectralLines::even(LINES.1, LINES.1, LINES.0)
}

/// How a case is measured.
pub(crate) fn drawn_hammer(random: &mut impl Rng, seed: u64) -> HammerSetup {
    HammerSetup {
        averages: [5, 8, 10, 16, 20][random.random_range(0..5)],
        noise_response: random.random_range(0.004..0.015),
        noise_force: random.random_range(0.0005..0.0015),
        corner: random.random_range(900.0..1300.0),
        spread: 0.25,
        common_hits: false,
        seed,
    }
}

/// Pairs of points of which neither the FRF nor its reciprocal is recorded.
pub(crate) fn unseen_pairs(fixture: &Fixture, recorded: &[FrfPair], random: &mut impl Rng) -> Vec<FrfPair> {
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).collect();
    let mut all = Vec::new();
    for (i, response) in names.iter().enumerate() {
        for reference in &names[..=i] {
            let (pair, back) =
                (FrfPair::transverse(response, reference), FrfPair::transverse(reference, response));
            if !recorded.contains(&pair) && !recorded.contains(&back) {
                all.push(pair);
            }
        }
    }
    all.shuffle(random);
    all.truncate(UNSEEN);
    all
}
