//! A record of another scale than the others: in g, turned round, of another range.
//!
//! A mode's residues in a full matrix of FRFs are products of two shapes, ρ_ij = φ_i·ψ_j: every minor
//! ρ_ij·ρ_kl − ρ_il·ρ_kj is zero. One record of another scale spoils that, and modes that share their poles
//! follow only by each being there twice. Both together have ρ_ij·ρ_kl/(ρ_il·ρ_kj) equal to that scale, the
//! same in all modes, where two modes that are really close have any.

use crate::analysis::ModalAnalysis;
use crate::mode::Mode;
use crate::settings::uneven_scale::{ALIKE, FEWEST, SAME_POLE};
use jointscope_spectra::Channel;
use num_complex::Complex64;

/// FRFs of which one is of another scale.
#[derive(Debug, Clone, PartialEq)]
pub struct UnevenScale {
    /// Their places among the FRFs, each with the factor that it has if it is the one: with two references it
    /// may be either of those to a response, of two by two any.
    pub frfs: Vec<(usize, f64)>,
}

impl ModalAnalysis {
    /// The FRFs of which one is of another scale than the others; `None` where no two modes are there twice,
    /// or no one record explains that they are.
    pub fn uneven_scale(&self) -> Option<UnevenScale> {
        let residues = doubled(&self.modes)?;
        let minors = self.minors();
        let of = |frf: usize| {
            let ratios = |is_own: bool| {
                let asked = minors.iter().filter(move |minor| minor.contains(&frf) == is_own);
                asked.flat_map(|minor| residues.iter().map(move |residues| ratio(residues, minor, frf)))
            };
            let factor = ratios(true).next()?.re;
            let is_one = |value: Complex64| (value - 1.0).norm() < ALIKE;
            let stands_alone = ratios(true).all(|value| is_one(value / factor)) && ratios(false).all(is_one);
            (stands_alone && !is_one(factor.into())).then_some((frf, factor))
        };
        let frfs: Vec<(usize, f64)> = (0..self.pairs().len()).filter_map(of).collect();
        (!frfs.is_empty()).then_some(UnevenScale { frfs })
    }

    /// Four FRFs each of two responses and two references: the first and the second of which share neither.
    fn minors(&self) -> Vec<[usize; 4]> {
        let pairs = self.pairs();
        let place = |response: &Channel, reference: &Channel| {
            pairs.iter().position(|pair| pair.response == *response && pair.reference == *reference)
        };
        let mut all = Vec::new();
        for (a, one) in pairs.iter().enumerate() {
            for (b, other) in pairs.iter().enumerate().skip(a + 1) {
                if one.response == other.response || one.reference == other.reference {
                    continue;
                }
                let crossed =
                    place(&one.response, &other.reference).zip(place(&other.response, &one.reference));
                all.extend(crossed.map(|(c, d)| [a, b, c, d]));
            }
        }
        all
    }
}

/// How many times what three FRFs of a minor make of it the residue of `frf` is; of a minor without it, of
/// its first.
fn ratio(residues: &[Complex64], [a, b, c, d]: &[usize; 4], frf: usize) -> Complex64 {
    let ratio = residues[*a] * residues[*b] / (residues[*c] * residues[*d]);
    if frf == *c || frf == *d { 1.0 / ratio } else { ratio }
}

/// Residues of the modes that are there twice, both of a pair together; `None` where these are few. In a mode
/// that hardly shows in the odd record it makes no second one.
fn doubled(modes: &[Mode]) -> Option<Vec<Vec<Complex64>>> {
    let is_one = |one: &Mode, other: &Mode| (one.pole - other.pole).norm() < SAME_POLE * one.pole.re.abs();
    let pairs = modes.windows(2).filter(|pair| is_one(&pair[0], &pair[1]));
    let both = |pair: &[Mode]| pair[0].residues.iter().zip(&pair[1].residues).map(|(a, b)| a + b).collect();
    let doubled: Vec<Vec<Complex64>> = pairs.map(both).collect();
    (doubled.len() >= FEWEST).then_some(doubled)
}
