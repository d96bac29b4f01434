//! FRFs of few modes and noise of a known variance.

use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

/// A stream of complex normals: a linear congruential generator, Box and Muller.
pub(crate) struct Normals(pub u64);

impl Normals {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// One with E|ε|² = `variance`.
    pub(crate) fn complex(&mut self, variance: f64) -> Complex64 {
        let radius = (-variance * self.uniform().ln()).sqrt();
        Complex64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }
}

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
    let pairs = channels.iter().map(|(response, reference)| FrfPair::transverse(response, reference));
    let mut values = Vec::new();
    for frf in 0..channels.len() {
        values.extend(lines.hz().iter().map(|&hz| value(frf, hz)));
    }
    FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.collect(), values).unwrap()
}
