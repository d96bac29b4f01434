//! Numbers that were changed in the file: FRFs that step by a power of ten from one line to the next.

use jointscope_spectra::{FrfPair, FrfSet};

/// Steps of an FRF that no structure makes.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    /// The FRF with the first one.
    pub frf: FrfPair,
    /// Where it is, Hz.
    pub hz: f64,
    /// The factor.
    pub factor: f64,
    /// Steps of all FRFs.
    pub count: usize,
}

/// Least exponent of ten of a step, and how far it may be from a whole one: an FRF changes a little between two lines besides.
const LEAST: f64 = 2.0;
const WHOLE: f64 = 0.1;
/// Change of an FRF to the line before and after a step, as ln of its level, up to which its course is even there. A resonance or an antiresonance that lies between two lines
/// has its change on both sides.
const EVEN: f64 = 0.4;
/// Fewest steps: there and back.
const FEWEST: usize = 2;

/// The steps of `frfs`, where they have any.
pub(crate) fn steps(frfs: &FrfSet) -> Option<Steps> {
    let mut first = None;
    let mut count = 0;
    for (index, pair) in frfs.pairs().iter().enumerate() {
        let level: Vec<f64> = frfs.values(index).iter().map(|value| value.norm().ln()).collect();
        for (at, four) in level.windows(4).enumerate() {
            let [before, step, after] = [four[1] - four[0], four[2] - four[1], four[3] - four[2]];
            let tens = step / std::f64::consts::LN_10;
            let is_step =
                tens.is_finite() && tens.abs() > LEAST - WHOLE && (tens - tens.round()).abs() < WHOLE;
            if is_step && before.abs() < EVEN && after.abs() < EVEN {
                count += 1;
                let factor = 10f64.powf(tens.round().abs());
                first.get_or_insert_with(|| (pair.clone(), frfs.lines().hz()[at + 2], factor));
            }
        }
    }
    let (frf, hz, factor) = first.filter(|_| count >= FEWEST)?;
    Some(Steps { frf, hz, factor, count })
}
