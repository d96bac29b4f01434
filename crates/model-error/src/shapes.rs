//! Mass-normalised shapes of a model's modes at the channels of a recording, from the residues of
//! driving-point FRFs (φ²) and the signs of transfer FRFs.
//!
//! A pole of the measuring chain, as a sensor's mounting makes one, is none of the structure's: it has
//! residues but no shape. Amplitudes whose products are of the size of these stand for one, so that what errs
//! in them by a share errs in the residues by that share.

use crate::poles::mode;
use crate::recorded::RecordedModes;
use crate::settings::shapes::{MOST_REFERENCES, NODE_SHARE, SAME_FREQUENCY};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, ModelledTest};
use jointscope_spectra::{Channel, FrfPair};
use num_complex::Complex64;

/// Shapes of a model's modes at the channels of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Shapes {
    /// (response, reference) of each FRF, as places among the channels.
    pub(crate) frfs: Vec<(usize, usize)>,
    /// By mode, mass-normalised amplitude at each channel.
    pub(crate) amplitudes: Vec<Vec<f64>>,
    /// By mode, what damping that is not distributed as mass and stiffness are adds to the residue of each
    /// FRF: its imaginary part, the measuring chain apart.
    pub(crate) quadrature: Vec<Vec<f64>>,
}

impl Shapes {
    /// The shapes of the modes at `poles`.
    pub fn of(fixture: &Fixture, recorded: &RecordedModes, poles: &[Complex64]) -> Option<Self> {
        let mut channels: Vec<Channel> = Vec::new();
        let mut place = |channel: &Channel| {
            channels.iter().position(|c| c == channel).unwrap_or_else(|| {
                channels.push(channel.clone());
                channels.len() - 1
            })
        };
        let frfs: Vec<(usize, usize)> =
            recorded.pairs.iter().map(|pair| (place(&pair.response), place(&pair.reference))).collect();
        let mut references: Vec<usize> = frfs.iter().map(|(_, reference)| *reference).collect();
        references.sort_unstable();
        references.dedup();
        references.truncate(MOST_REFERENCES);
        let driving = channels.iter().map(|c| FrfPair::new(c.clone(), c.clone()));
        let across = references.iter().flat_map(|&r| {
            channels.iter().map({
                let channels = &channels;
                move |c| FrfPair::new(c.clone(), channels[r].clone())
            })
        });
        let pairs: Vec<FrfPair> = driving.chain(across).collect();
        let test = ModelledTest::new(fixture, &pairs, recorded.band.1, Instrument::Perfect).ok()?;
        let mut continued = test.continued();
        let n = channels.len();
        let mut of_structure = |pole: &Complex64| -> Option<(Vec<f64>, Vec<f64>)> {
            let mode = mode(&mut continued, *pole, pairs.len())?;
            if (mode.pole.lambda().im - pole.im).abs() > SAME_FREQUENCY * pole.norm() {
                return None;
            }
            let residues = mode.residues;
            let squares: Vec<f64> = residues[..n].iter().map(|a| a.norm()).collect();
            let largest = (0..references.len())
                .max_by(|a, b| squares[references[*a]].total_cmp(&squares[references[*b]]))?;
            let to_largest = &residues[n + largest * n..][..n];
            let amplitude = |channel: usize| squares[channel].sqrt() * to_largest[channel].re.signum();
            let own = residues[references[largest]];
            let moves = own.norm() > NODE_SHARE * squares.iter().sum::<f64>() / n as f64;
            // ψ_o·ψ_i = (ψ_o·ψ_r)(ψ_i·ψ_r)/ψ_r²
            let product = |&(o, i): &(usize, usize)| (to_largest[o] * to_largest[i] / own).im;
            let quadrature = frfs.iter().map(|frf| if moves { product(frf) } else { 0.0 });
            Some(((0..n).map(amplitude).collect(), quadrature.collect()))
        };
        let of_chain = |pole: &Complex64| -> Option<(Vec<f64>, Vec<f64>)> {
            let test =
                ModelledTest::new(fixture, &recorded.pairs, recorded.band.1, Instrument::AsRecorded).ok()?;
            let residues = mode(&mut test.continued(), *pole, recorded.frfs())?.residues;
            Some((amplitudes_of(&residues, &frfs, n), vec![0.0; frfs.len()]))
        };
        let shape = |pole: &Complex64| of_structure(pole).or_else(|| of_chain(pole));
        let of_modes: Vec<(Vec<f64>, Vec<f64>)> = poles.iter().map(shape).collect::<Option<_>>()?;
        let (amplitudes, quadrature) = of_modes.into_iter().unzip();
        Some(Shapes { frfs, amplitudes, quadrature })
    }

    /// Mean square of a mode's amplitudes.
    pub(crate) fn mean_square(&self, mode: usize) -> f64 {
        let shape = &self.amplitudes[mode];
        shape.iter().map(|a| a * a).sum::<f64>() / shape.len() as f64
    }

    /// Covariance of the residues of FRFs `a` and `b` where a mode's shape errs at each channel by its root
    /// mean square: an error ε_c at channel c changes the residue φ_o·φ_i by ε_o·φ_i + ε_i·φ_o.
    pub(crate) fn shared(&self, mode: usize, a: usize, b: usize) -> f64 {
        let by_channel = |frf: usize, channel: usize| {
            let (o, i) = self.frfs[frf];
            let at =
                |own: usize, other: usize| if own == channel { self.amplitudes[mode][other] } else { 0.0 };
            at(o, i) + at(i, o)
        };
        let (o, i) = self.frfs[a];
        let at = |channel: usize| by_channel(a, channel) * by_channel(b, channel);
        self.mean_square(mode) * if i == o { at(o) } else { at(o) + at(i) }
    }
}

/// By channel the root of the largest residue among its FRFs.
fn amplitudes_of(residues: &[Complex64], frfs: &[(usize, usize)], channels: usize) -> Vec<f64> {
    let mut largest = vec![0.0_f64; channels];
    for (residue, &(response, reference)) in residues.iter().zip(frfs) {
        for channel in [response, reference] {
            largest[channel] = largest[channel].max(residue.norm());
        }
    }
    largest.into_iter().map(f64::sqrt).collect()
}
