//! Measured modes against those of a model, by frequency and shape.

use num_complex::Complex64;

use crate::settings::matching::{LACKING, LEAST_MAC, MOST_SHIFT, SHIFT_WEIGHT};
use crate::{Mode, mac};

/// A mode that a model has: its frequency (Hz) and what it should leave in each FRF, the product of its shape
/// at response and reference.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedMode {
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// φ_response·φ_reference of each FRF.
    pub products: Vec<f64>,
}

/// A measured mode and the expected one that it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// Index of the measured mode.
    pub measured: usize,
    /// Index of the expected one.
    pub expected: usize,
    /// MAC of the residues and the expected products; 1 whatever the shapes for a single FRF.
    pub mac: f64,
    /// Measured over expected frequency, less one.
    pub shift: f64,
}

/// Which measured mode is which expected one, best matches first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Matches {
    /// The pairs.
    pub pairs: Vec<Match>,
    /// Measured modes that are none of the expected ones, by index.
    pub other_measured: Vec<usize>,
    /// Expected modes that none of the measured ones is, by index.
    pub other_expected: Vec<usize>,
}

/// Pairs measured with expected modes: near in frequency, alike in shape, the best pair first.
pub fn match_modes(measured: &[Mode], expected: &[ExpectedMode]) -> Matches {
    let mut possible: Vec<Match> = Vec::new();
    for (m, mode) in measured.iter().enumerate() {
        for (e, other) in expected.iter().enumerate() {
            let products: Vec<Complex64> = other.products.iter().map(|p| Complex64::from(*p)).collect();
            let shift = mode.frequency / other.frequency - 1.0;
            let mac = mac(&mode.residues, &products);
            if shift.abs() < MOST_SHIFT && mac > LEAST_MAC && shift.abs() + 1.0 - mac < LACKING {
                possible.push(Match { measured: m, expected: e, mac, shift });
            }
        }
    }
    let distance = |pair: &Match| 1.0 - pair.mac + SHIFT_WEIGHT * pair.shift.abs();
    possible.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut matches = Matches::default();
    for pair in possible {
        if matches.pairs.iter().all(|p| p.measured != pair.measured && p.expected != pair.expected) {
            matches.pairs.push(pair);
        }
    }
    matches.other_measured =
        (0..measured.len()).filter(|m| matches.pairs.iter().all(|p| p.measured != *m)).collect();
    matches.other_expected =
        (0..expected.len()).filter(|e| matches.pairs.iter().all(|p| p.expected != *e)).collect();
    matches
}
