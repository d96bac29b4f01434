//! Numbers that were changed in the file: FRFs that step by a power of ten from one line to the next.

use crate::settings::steps::{DECADE_TOLERANCE, FEWEST_STEPS, LEAST_DECADES, LEVEL_CHANGE};
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

/// The steps of `frfs`, where they have any.
pub(crate) fn steps(frfs: &FrfSet) -> Option<Steps> {
    let mut first = None;
    let mut count = 0;
    for (index, pair) in frfs.pairs().iter().enumerate() {
        let level: Vec<f64> = frfs.values(index).iter().map(|value| value.norm().ln()).collect();
        for (at, four) in level.windows(4).enumerate() {
            let [before, step, after] = [four[1] - four[0], four[2] - four[1], four[3] - four[2]];
            let tens = step / std::f64::consts::LN_10;
            let is_step = tens.is_finite()
                && tens.abs() > LEAST_DECADES - DECADE_TOLERANCE
                && (tens - tens.round()).abs() < DECADE_TOLERANCE;
            if is_step && before.abs() < LEVEL_CHANGE && after.abs() < LEVEL_CHANGE {
                count += 1;
                let factor = 10f64.powf(tens.round().abs());
                first.get_or_insert_with(|| (pair.clone(), frfs.lines().hz()[at + 2], factor));
            }
        }
    }
    let (frf, hz, factor) = first.filter(|_| count >= FEWEST_STEPS)?;
    Some(Steps { frf, hz, factor, count })
}
