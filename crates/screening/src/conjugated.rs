//! Which way the phase turns.
//!
//! With e^{+iωt} the phase of an FRF falls through each resonance; it rises through antiresonances only,
//! where the FRF is small. So Σ Im(H_{k+1} H̄_k), in which resonances weigh most, is negative, and positive
//! for conjugates.

use crate::settings::conjugates::{LEAST_TURN, RISING_SHARE};
use jointscope_spectra::FrfSet;

/// The FRFs that are conjugates, by place.
pub(crate) fn conjugated(frfs: &FrfSet) -> Vec<usize> {
    let is_conjugate = |index: &usize| {
        let values = frfs.values(*index);
        let turns: Vec<f64> = values.windows(2).map(|pair| (pair[1] * pair[0].conj()).im).collect();
        let all = turns.iter().map(|turn| turn.abs()).sum::<f64>();
        let energy = values.iter().map(|value| value.norm_sqr()).sum::<f64>();
        turns.iter().sum::<f64>() > RISING_SHARE * all && all > LEAST_TURN * energy
    };
    (0..frfs.pairs().len()).filter(is_conjugate).collect()
}
