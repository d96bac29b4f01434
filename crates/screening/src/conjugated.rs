//! Which way the phase turns.
//!
//! With e^{+iωt} the phase of an FRF falls through each resonance; it rises through antiresonances only, where the FRF is small. So Σ Im(H_{k+1} H̄_k), in which resonances
//! weigh most, is negative, and positive for conjugates.

use jointscope_spectra::FrfSet;

/// Share of |Im(H_{k+1} H̄_k)| that must be of one sign.
const TURNS: f64 = 0.8;
/// Least of Σ|Im(H_{k+1} H̄_k)| over Σ|H|²: without a resonance in the band nothing turns.
const RESONATES: f64 = 1e-3;

/// The FRFs that are conjugates, by place.
pub(crate) fn conjugated(frfs: &FrfSet) -> Vec<usize> {
    let is_conjugate = |index: &usize| {
        let values = frfs.values(*index);
        let turns: Vec<f64> = values.windows(2).map(|pair| (pair[1] * pair[0].conj()).im).collect();
        let all = turns.iter().map(|turn| turn.abs()).sum::<f64>();
        let energy = values.iter().map(|value| value.norm_sqr()).sum::<f64>();
        turns.iter().sum::<f64>() > TURNS * all && all > RESONATES * energy
    };
    (0..frfs.pairs().len()).filter(is_conjugate).collect()
}
