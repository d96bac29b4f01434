//! FRFs in another unit than their file says: all of them larger than the fixture's by what lies between two
//! units.

use crate::levels::{median, ratios_apart};
use crate::settings::unit::{FACTOR_TOLERANCE, FRF_SPREAD};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// What lies between units that are taken for each other.
const BETWEEN: [(f64, &str); 5] = [
    (9.80665, "g and m/s²"),
    (39.3701, "in/s² and m/s²"),
    (386.089, "g and in/s²"),
    (4.44822, "lbf and N"),
    (1000.0, "mm and m, N and kN, or g and mV"),
];

/// Median |ln(|H|/|Ĥ|)| that is left of FRFs over a factor.
pub(crate) fn left(frfs: &FrfSet, modelled: &[Complex64], factor: f64) -> Option<f64> {
    let over: Vec<Complex64> = frfs.all_values().iter().map(|value| value / factor).collect();
    median(ratios_apart(&over, modelled))
}

/// The factor by which all FRFs are off, and the units between which it lies; `modelled` are the fixture's
/// accelerances.
pub(crate) fn off_by_units(frfs: &FrfSet, modelled: &[Complex64]) -> Option<(f64, &'static str)> {
    let count = frfs.lines().len();
    let ratio = |index: usize| {
        let pairs = frfs.values(index).iter().zip(&modelled[index * count..(index + 1) * count]);
        let ratios = pairs.map(|(recorded, modelled)| (recorded / modelled).norm().ln());
        median(ratios.filter(|ratio| ratio.is_finite()).collect())
    };
    let ratios: Vec<f64> = (0..frfs.pairs().len()).map(ratio).collect::<Option<_>>()?;
    let all = median(ratios.clone())?;
    if ratios.iter().any(|ratio| (ratio - all).abs() > FRF_SPREAD) {
        return None;
    }
    let both = BETWEEN.iter().flat_map(|(factor, units)| [(*factor, *units), (factor.recip(), *units)]);
    both.into_iter().find(|(factor, _)| (all - factor.ln()).abs() < FACTOR_TOLERANCE)
}
