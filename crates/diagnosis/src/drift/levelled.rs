//! FRFs of a test that drifted a little, as if it had not.
//!
//! A mode of residue A whose natural frequency was ω while one reference was struck, and is ω̄ on the mean of
//! all, adds A·(φ(ω̄) − φ(ω)) to that reference's FRFs, φ being the accelerance of a mode of modal mass one.
//! Modulus and joints take all that is between a structure at one temperature and at another; what is left of
//! it in residues is of the order of that drift, parts in ten thousand, and far below what a model is wrong
//! by.

use super::poles_by_frf::references;
use crate::Observation;
use crate::settings::drift::differences::MOST_LEVELLED;
use jointscope_model_error::{Pole, RecordedModes};
use num_complex::Complex64;

/// Modes of one reference's FRFs by themselves, and which of them is each mode that is compared.
type OwnModes = Option<(RecordedModes, Vec<Option<usize>>)>;

/// The observation with the modes of each reference, in their order, where they lie on the mean of all; `None`
/// where a reference's modes are not told, or lie too far from that.
pub(super) fn levelled(observation: &Observation, own: &[OwnModes]) -> Option<Observation> {
    let own: Vec<&(RecordedModes, Vec<Option<usize>>)> =
        own.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let references = references(observation);
    let compared = own.first()?.1.len();
    let means: Vec<f64> = (0..compared).map(|mode| mean(&own, mode)).collect();
    let n = observation.lines().len();
    let omegas: Vec<f64> = observation.lines().omegas().collect();
    let mut missing = vec![Complex64::ZERO; observation.values().len()];
    for (reference, (modes, of)) in references.iter().zip(own) {
        let frfs = observation.pairs().iter().enumerate().filter(|(_, pair)| pair.reference == *reference);
        let frfs: Vec<usize> = frfs.map(|(index, _)| index).collect();
        for (mode, mean) in
            of.iter().zip(&means).filter_map(|(own, mean)| Some((&modes.modes[(*own)?], mean)))
        {
            let Pole { omega, damping_ratio } = mode.pole;
            if (omega.ln() - mean).abs() > MOST_LEVELLED {
                return None;
            }
            let levelled = Pole { omega: mean.exp(), damping_ratio };
            for (line, &omega) in omegas.iter().enumerate() {
                let s = Complex64::new(0.0, omega);
                let moved = levelled.accelerance(s) - mode.pole.accelerance(s);
                for (&frf, residue) in frfs.iter().zip(&mode.residues) {
                    missing[frf * n + line] += residue * moved;
                }
            }
        }
    }
    observation.plus(&missing)
}

/// ln ω of a compared mode on the mean of the references that show it, each with the weight that its noise
/// leaves it.
fn mean(own: &[&(RecordedModes, Vec<Option<usize>>)], mode: usize) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (modes, of) in own {
        if let Some(own) = of[mode] {
            let weight = modes.deviations(own)[0].powi(-2);
            sum += weight * modes.modes[own].pole.omega.ln();
            weights += weight;
        }
    }
    sum / weights
}
