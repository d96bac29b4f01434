//! Fourier transforms of sampled signals.
//!
//! The transform's library is generic and large, and every crate that names it compiles it anew. So this one
//! alone does.

use num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::sync::Arc;

/// From signals of one length to their lines, Σ x e^(−iωt) from 0 Hz to half the sampling rate, unnormalised.
#[derive(Clone)]
pub struct Fourier {
    plan: Arc<dyn RealToComplex<f64>>,
}

impl Fourier {
    /// Of signals of `length` samples.
    pub fn new(length: usize) -> Self {
        Fourier { plan: RealFftPlanner::new().plan_fft_forward(length.max(1)) }
    }

    /// The samples of a signal.
    pub fn length(&self) -> usize {
        self.plan.len()
    }

    /// The lines of a signal, which is overwritten; zeros if it has another length.
    pub fn lines(&self, signal: &mut [f64]) -> Vec<Complex64> {
        let mut lines = self.plan.make_output_vec();
        match self.plan.process(signal, &mut lines) {
            Ok(()) => lines,
            Err(_) => vec![Complex64::ZERO; lines.len()],
        }
    }
}

/// From lines to signals of one length, unnormalised: there and back multiplies by the length.
pub struct InverseFourier {
    plan: Arc<dyn ComplexToReal<f64>>,
}

impl InverseFourier {
    /// Of signals of `length` samples.
    pub fn new(length: usize) -> Self {
        InverseFourier { plan: RealFftPlanner::new().plan_fft_inverse(length.max(1)) }
    }

    /// How many lines a signal has.
    pub fn count(&self) -> usize {
        self.plan.complex_len()
    }

    /// The signal of `lines`, which are overwritten; zeros if there are more or fewer than a signal has.
    pub fn signal(&self, lines: &mut [Complex64]) -> Vec<f64> {
        // A real signal's first line is real, and so is the one at half the rate.
        if let Some(first) = lines.first_mut() {
            first.im = 0.0;
        }
        if let Some(last) = lines.last_mut().filter(|_| self.plan.len().is_multiple_of(2)) {
            last.im = 0.0;
        }
        let mut signal = self.plan.make_output_vec();
        match self.plan.process(lines, &mut signal) {
            Ok(()) => signal,
            Err(_) => vec![0.0; signal.len()],
        }
    }
}
