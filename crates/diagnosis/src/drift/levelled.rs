//! FRFs of a test that drifted a little, as if it had not.
//!
//! A mode of residue A whose natural frequency was ω while one reference was struck, and is ω̄ on the mean of
//! all, adds A·(φ(ω̄) − φ(ω)) to that reference's FRFs, φ being the accelerance of a mode of modal mass one.
//! Modulus and joints take all that is between a structure at one temperature and at another; what is left of
//! it in residues is of the order of that drift, parts in ten thousand, and far below what a model is wrong
//! by.

use super::poles_by_frf::OwnModes;
use crate::Observation;
use crate::settings::drift::differences::MOST_LEVELLED;
use jointscope_model_error::Pole;
use jointscope_spectra::Channel;
use num_complex::Complex64;

/// The observation with the modes of each of its references where they lie on the mean of all; `None` where a
/// reference's modes are not told, or lie too far from that.
pub(super) fn levelled(
    observation: &Observation,
    references: &[Channel],
    own: &[Option<OwnModes>],
) -> Option<Observation> {
    let own: Vec<&OwnModes> = own.iter().map(Option::as_ref).collect::<Option<_>>()?;
    let means: Vec<f64> = (0..own.first()?.compared.len()).map(|mode| mean(&own, mode)).collect();
    let n = observation.lines().len();
    let omegas: Vec<f64> = observation.lines().omegas().collect();
    let mut missing = vec![Complex64::ZERO; observation.values().len()];
    for (reference, OwnModes { modes, compared }) in references.iter().zip(own) {
        let frfs = observation.pairs().iter().enumerate().filter(|(_, pair)| pair.reference == *reference);
        let frfs: Vec<usize> = frfs.map(|(index, _)| index).collect();
        for (own, mean) in compared.iter().zip(&means) {
            let Some(mode) = own.map(|own| &modes.modes[own]) else { continue };
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
fn mean(own: &[&OwnModes], mode: usize) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for OwnModes { modes, compared } in own {
        if let Some(own) = compared[mode] {
            let weight = modes.deviations(own)[0].powi(-2);
            sum += weight * modes.modes[own].pole.omega.ln();
            weights += weight;
        }
    }
    sum / weights
}
