//! Mass-normalised shapes of a model's modes at the channels of a recording, from the residues of driving-point FRFs (φ²) and the signs of transfer FRFs.

use crate::modelled::mode;
use crate::recorded::RecordedModes;
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
}

/// References to which the signs of shapes are told, at most.
const REFERENCES: usize = 4;

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
        references.truncate(REFERENCES);
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
        let shape = |pole: &Complex64| -> Option<Vec<f64>> {
            let residues = mode(&mut continued, *pole, pairs.len())?.residues;
            let squares: Vec<f64> = residues[..n].iter().map(|a| a.norm()).collect();
            let largest = (0..references.len())
                .max_by(|a, b| squares[references[*a]].total_cmp(&squares[references[*b]]))?;
            let sign = |channel: usize| residues[n + largest * n + channel].re.signum();
            Some((0..n).map(|channel| squares[channel].sqrt() * sign(channel)).collect())
        };
        Some(Shapes { frfs, amplitudes: poles.iter().map(shape).collect::<Option<_>>()? })
    }
}
