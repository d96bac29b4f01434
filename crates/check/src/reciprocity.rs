//! Reciprocity: what is measured at i for a blow at j is what is measured at j for a blow at i.

use crate::settings::reciprocity::{LEAST_DIFFERENCE, TIMES_EXPECTED};
use jointscope_screening::median;
use jointscope_spectra::{FrfPair, FrfSet};
use serde::Serialize;

/// How far two FRFs that should be one are apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reciprocity {
    /// One of them.
    pub frf: FrfPair,
    /// The other.
    pub other: FrfPair,
    /// √(Σ|H_ij − H_ji|²/Σ½(|H_ij|² + |H_ji|²)) over all lines: 2 where one is the other turned round.
    pub difference: f64,
    /// What noise alone would make of that.
    pub expected: f64,
    /// Median of |H_ij|/|H_ji|.
    pub level: f64,
    /// Whether the difference is more than noise.
    pub odd: bool,
}

/// All reciprocal pairs among accelerances with variances.
pub(crate) fn of(frfs: &FrfSet) -> Vec<Reciprocity> {
    let pairs = frfs.pairs();
    let mut all = Vec::new();
    for (i, pair) in pairs.iter().enumerate() {
        let mirrored = FrfPair::new(pair.reference.clone(), pair.response.clone());
        if let Some(j) = frfs.index_of(&mirrored).filter(|j| *j > i) {
            all.push(of_pair(frfs, i, j));
        }
    }
    all
}

fn of_pair(frfs: &FrfSet, i: usize, j: usize) -> Reciprocity {
    let (a, b) = (frfs.values(i), frfs.values(j));
    let apart: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
    let size: f64 = a.iter().zip(b).map(|(a, b)| 0.5 * (a.norm_sqr() + b.norm_sqr())).sum();
    let noise: f64 = [i, j].iter().flat_map(|index| frfs.variance(*index).unwrap_or_default()).sum();
    let levels = a.iter().zip(b).map(|(a, b)| a.norm() / b.norm()).filter(|level| level.is_finite());
    let relative =
        |square: f64| Some((square / size).sqrt()).filter(|share| share.is_finite()).unwrap_or(f64::MAX);
    let (difference, expected) = (relative(apart), relative(noise));
    Reciprocity {
        frf: frfs.pairs()[i].clone(),
        other: frfs.pairs()[j].clone(),
        difference,
        expected,
        level: median(levels.collect()).unwrap_or(1.0),
        odd: difference > LEAST_DIFFERENCE && difference > TIMES_EXPECTED * expected,
    }
}
