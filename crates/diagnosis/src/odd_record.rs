//! One record among several that is another multiple of what the fixture makes of it: its unit, range or sign
//! is wrong, and no place of a structure is.

use crate::candidate::{Candidate, candidate};
use crate::settings::statements::odd_record::{APART, FEWEST, OTHERS};
use jointscope_fixture::{EffectKind, Place};
use jointscope_spectra::{FrfPair, median};
use num_complex::Complex64;

/// A record that stands alone.
#[derive(Debug, Clone, PartialEq)]
pub struct OddRecord {
    /// Which.
    pub frf: FrfPair,
    /// How many times what the fixture makes of it; negative where it is turned round.
    pub factor: f64,
    /// The least and the largest multiple of the others.
    pub others: [f64; 2],
}

/// The multiple of what is `predicted` that a record is, by the median over its lines: resonances that are
/// off by what is left out count little so. `None` where it has no values.
fn multiple(measured: &[Complex64], predicted: &[Complex64]) -> Option<f64> {
    let both = measured.iter().zip(predicted);
    let in_phase: f64 =
        both.clone().map(|(m, p)| (m * p.conj()).re / (m.norm() * p.norm())).filter(|c| c.is_finite()).sum();
    let ratios = both.map(|(m, p)| m.norm() / p.norm()).filter(|r| r.is_finite() && *r > 0.0);
    Some(median(&mut ratios.collect::<Vec<f64>>())? * in_phase.signum())
}

impl OddRecord {
    /// The one of `measured` FRFs between these channels, FRF after FRF, beside what is `predicted` of them.
    pub(crate) fn of(pairs: &[FrfPair], measured: &[Complex64], predicted: &[Complex64]) -> Option<Self> {
        let lines = (measured.len() / pairs.len().max(1)).max(1);
        let records = measured.chunks_exact(lines).zip(predicted.chunks_exact(lines));
        OddRecord::among(pairs, &records.map(|(m, p)| multiple(m, p)).collect::<Option<Vec<f64>>>()?)
    }

    /// The gain of that record as a name: no other record may have one of its own where the fixture does not
    /// say so.
    pub(crate) fn as_a_name(&self) -> Candidate {
        let place = Place::Record(self.frf.to_string());
        candidate(EffectKind::ChannelGain, place, None, vec![vec![self.factor]])
    }

    /// The one of these FRFs whose multiple stands farther from those of the others than these from each
    /// other, by much.
    pub fn among(pairs: &[FrfPair], multiples: &[f64]) -> Option<Self> {
        if pairs.len() < FEWEST {
            return None;
        }
        let distance = |a: f64, b: f64| if a * b > 0.0 { (a / b).ln().abs() } else { f64::INFINITY };
        (0..multiples.len()).find_map(|odd| {
            let others = || (0..multiples.len()).filter(|&at| at != odd).map(|at| multiples[at]);
            let least = others().fold(f64::INFINITY, f64::min);
            let largest = others().fold(f64::NEG_INFINITY, f64::max);
            let apart = distance(multiples[odd], least).min(distance(multiples[odd], largest));
            let is_odd = least > 0.0 && apart > APART && apart > OTHERS * distance(least, largest);
            let found =
                || OddRecord { frf: pairs[odd].clone(), factor: multiples[odd], others: [least, largest] };
            is_odd.then(found)
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Observation;
    use crate::simulated::simulated;
    use jointscope_fixture::Fixture;
    use jointscope_spectra::SpectralLines;

    const BLOCKS: &str = r#"{ "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
        "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": MODULUS, "second_moment": 4e-10 } } },
        "damping": { "modal_ratios": [0.006] } }"#;

    /// Four FRFs of blocks whose strip has this modulus, the one at a place multiplied, and what the blocks
    /// of the fixture make of them.
    fn odd(modulus: &str, at: usize, factor: f64) -> Option<OddRecord> {
        let fixture = |modulus: &str| Fixture::from_json(&BLOCKS.replace("MODULUS", modulus)).unwrap();
        let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i));
        let lines = SpectralLines::even(10.0, 5.0, 200).unwrap();
        let recorded = |modulus: &str| simulated(&fixture(modulus), &pairs, &lines, 1e-5);
        let truth = recorded(modulus);
        let count = truth.lines().len();
        let values =
            |index: usize, value: Complex64| if index / count == at { value * factor } else { value };
        let frfs = truth.frfs().clone().with_values(values);
        let observation = Observation::new(&frfs, |_| true).unwrap();
        OddRecord::of(observation.pairs(), observation.values(), recorded("2e11").values())
    }

    #[test]
    fn a_record_in_g_or_turned_round_stands_alone_and_what_is_left_out_makes_none_do_so() {
        for (factor, modulus) in
            [(9.80665, "2e11"), (1.0 / 9.80665, "2.1e11"), (-1.0, "2e11"), (0.8, "2e11"), (1.3, "1.9e11")]
        {
            let found = odd(modulus, 2, factor).unwrap();
            assert_eq!(found.frf.to_string(), "4/2", "{factor}");
            assert!((found.factor / factor - 1.0).abs() < 0.1, "{factor}: {}", found.factor);
        }
        for (factor, modulus) in [(1.0, "2e11"), (1.0, "1.6e11"), (1.02, "2e11")] {
            assert_eq!(odd(modulus, 2, factor), None, "{factor} with {modulus}");
        }
    }
}
