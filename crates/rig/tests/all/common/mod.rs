//! What several tests need.

use jointscope_fixture::Fixture;
use jointscope_recordings::{ReadOptions, Recording, Source};
use jointscope_rig::smoothed_variance;
use jointscope_spectra::FrfSet;

/// The FRFs of a universal file, in the order of the fixture's points.
pub(crate) fn frfs_in(bytes: &[u8], fixture: &Fixture) -> FrfSet {
    let source = Source { name: "recording.uff".into(), file: jointscope_uff::read(bytes).unwrap() };
    Recording::of(&[source], fixture, &ReadOptions::default()).unwrap().frfs().unwrap().clone()
}

/// χ² and degrees of freedom (two a complex value) of `measured` against `model`, both in the same form and
/// pairs.
pub(crate) fn chi_squared(measured: &FrfSet, model: &FrfSet, half_width: usize) -> (f64, f64) {
    let (mut chi2, mut dof) = (0.0, 0.0);
    for index in 0..measured.pairs().len() {
        let variance = smoothed_variance(measured, index, half_width).expect("coherence and averages");
        for ((h, m), v) in measured.values(index).iter().zip(model.values(index)).zip(&variance) {
            chi2 += 2.0 * (h - m).norm_sqr() / v;
            dof += 2.0;
        }
    }
    (chi2, dof)
}

/// Largest difference over FRFs and lines, relative to the rms of that FRF.
pub(crate) fn largest_error(expected: &FrfSet, got: &FrfSet) -> f64 {
    assert_eq!(expected.pairs(), got.pairs());
    let mut largest = 0.0_f64;
    for index in 0..expected.pairs().len() {
        let (a, b) = (expected.values(index), got.values(index));
        let rms = (a.iter().map(|v| v.norm_sqr()).sum::<f64>() / a.len() as f64).sqrt();
        largest = a.iter().zip(b).map(|(a, b)| (a - b).norm() / rms).fold(largest, f64::max);
    }
    largest
}
