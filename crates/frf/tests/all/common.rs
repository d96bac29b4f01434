//! FRFs of few modes.

use jointscope_samples::transverse;
use jointscope_spectra::{FrfForm, FrfSet, SpectralLines};
use num_complex::Complex64;

/// Accelerance of one mode of unit residue: natural frequency in Hz, damping ratio.
pub(crate) fn mode(hz: f64, natural: f64, ratio: f64) -> Complex64 {
    -hz * hz / Complex64::new(natural * natural - hz * hz, 2.0 * ratio * natural * hz)
}

/// Accelerances by channel and frequency on `lines`.
pub(crate) fn accelerances(
    lines: &SpectralLines,
    channels: &[(&str, &str)],
    mut value: impl FnMut(usize, f64) -> Complex64,
) -> FrfSet {
    let mut values = Vec::new();
    for frf in 0..channels.len() {
        values.extend(lines.hz().iter().map(|&hz| value(frf, hz)));
    }
    FrfSet::new(lines.clone(), FrfForm::Accelerance, transverse(channels), values).unwrap()
}
