//! What tests of several crates are made of: fixture files, FRFs by their points, and noise that is the same
//! every time.
//!
//! Nothing but tests stands on this crate, and it knows of no mechanics: what it hands out shares nothing
//! with what is tested.
//!
//! ```
//! use jointscope_samples::{ACROSS, Noise, transverse};
//!
//! assert_eq!(transverse(&ACROSS)[1].to_string(), "3/1");
//! let (mut noise, mut again) = (Noise::new(1), Noise::new(1));
//! assert_eq!(noise.complex(0.1), again.complex(0.1));
//! ```

// Only tests call it, and a test ends where its sample cannot be made.
#![allow(clippy::unwrap_used)]

mod fixtures;
mod records;

pub use fixtures::{TWO_BLOCKS, TWO_STOREYS, two_blocks_damped, with};
pub use records::{Blow, of_records};

use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;

/// The four FRFs across the joint of [`TWO_BLOCKS`].
pub const ACROSS: [(&str, &str); 4] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")];

/// Transverse FRFs by their points, response first.
pub fn transverse(points: &[(&str, &str)]) -> Vec<FrfPair> {
    points.iter().map(|(response, reference)| FrfPair::transverse(response, reference)).collect()
}

/// A stream of uniform numbers and circular complex normals: a linear congruential generator, Box and Muller.
#[derive(Debug, Clone)]
pub struct Noise(u64);

impl Noise {
    /// The stream from this state of its generator.
    pub fn from_state(state: u64) -> Self {
        Noise(state)
    }

    /// A stream of its own for every seed, small and neighbouring ones among them.
    pub fn new(seed: u64) -> Self {
        Noise(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// A number between 0 and 1, neither of them.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// A number with E|ε|² = `variance`.
    pub fn complex(&mut self, variance: f64) -> Complex64 {
        let radius = (-variance * self.uniform().ln()).sqrt();
        Complex64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }

    /// The set with noise of `relative` times each FRF's root mean square, and the variances that go with it.
    ///
    /// # Panics
    /// Where a square of a value is too large for a number.
    pub fn on(&mut self, frfs: &FrfSet, relative: f64) -> FrfSet {
        let n = frfs.lines().len();
        let mut values = frfs.all_values().to_vec();
        let mut variance = Vec::new();
        for (index, block) in values.chunks_mut(n).enumerate() {
            let mean: f64 = frfs.values(index).iter().map(|v| v.norm_sqr()).sum::<f64>() / n as f64;
            let floor = relative * relative * mean;
            block.iter_mut().for_each(|v| *v += self.complex(floor));
            variance.extend(std::iter::repeat_n(floor, n));
        }
        let noisy = FrfSet::new(frfs.lines().clone(), frfs.form(), frfs.pairs().to_vec(), values);
        noisy.and_then(|noisy| noisy.with_variance(variance)).unwrap()
    }
}
