//! Edits of recorded values: what a wrong channel does to them.

use jointscope_spectra::{Channel, FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;

/// A side of the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Response,
    Reference,
}

impl Side {
    pub(super) const BOTH: [Side; 2] = [Side::Response, Side::Reference];

    pub(super) fn name(self) -> &'static str {
        match self {
            Side::Response => "response",
            Side::Reference => "reference",
        }
    }

    /// The channel of an FRF on this side.
    pub(super) fn of(self, pair: &FrfPair) -> &Channel {
        match self {
            Side::Response => &pair.response,
            Side::Reference => &pair.reference,
        }
    }

    /// The channels on this side, in the order of the recording.
    pub(super) fn channels(self, pairs: &[FrfPair]) -> Vec<Channel> {
        let mut all: Vec<Channel> = Vec::new();
        for pair in pairs {
            if !all.contains(self.of(pair)) {
                all.push(self.of(pair).clone());
            }
        }
        all
    }

    /// The FRFs of a channel on this side, by index.
    pub(super) fn frfs(self, channel: &Channel, pairs: &[FrfPair]) -> Vec<usize> {
        (0..pairs.len()).filter(|&i| self.of(&pairs[i]) == channel).collect()
    }
}

/// Multiplies a channel's signal by `factor` of ω: the FRFs of a response by it, those of a reference by its
/// inverse.
pub(super) fn with_signal(
    recorded: &FrfSet,
    side: Side,
    channel: &Channel,
    factor: impl Fn(f64) -> Complex64,
) -> Result<FrfSet, SpectraError> {
    let frfs = side.frfs(channel, recorded.pairs());
    let at = |omega: f64| match side {
        Side::Response => factor(omega),
        Side::Reference => factor(omega).inv(),
    };
    let factors: Vec<Complex64> = recorded.lines().omegas().map(at).collect();
    let n = factors.len();
    let mut values = recorded.all_values().to_vec();
    let variance = |index| recorded.variance(index).map(<[f64]>::to_vec);
    let mut variances: Option<Vec<Vec<f64>>> = (0..recorded.pairs().len()).map(variance).collect();
    for index in frfs {
        for (line, factor) in factors.iter().enumerate() {
            values[index * n + line] *= factor;
            if let Some(variances) = &mut variances {
                variances[index][line] *= factor.norm_sqr();
            }
        }
    }
    rebuilt(recorded, recorded.pairs().to_vec(), values, variances)
}

/// Exchanges two channels of one side: what was recorded by the one is filed under the other.
pub(super) fn exchanged(
    recorded: &FrfSet,
    side: Side,
    [one, other]: [&Channel; 2],
) -> Result<FrfSet, SpectraError> {
    let renamed = |channel: &Channel| match channel {
        channel if channel == one => other.clone(),
        channel if channel == other => one.clone(),
        channel => channel.clone(),
    };
    let pair = |pair: &FrfPair| match side {
        Side::Response => FrfPair::new(renamed(&pair.response), pair.reference.clone()),
        Side::Reference => FrfPair::new(pair.response.clone(), renamed(&pair.reference)),
    };
    let pairs = recorded.pairs().iter().map(pair).collect();
    let variances =
        (0..recorded.pairs().len()).map(|index| recorded.variance(index).map(<[f64]>::to_vec)).collect();
    rebuilt(recorded, pairs, recorded.all_values().to_vec(), variances)
}

fn rebuilt(
    recorded: &FrfSet,
    pairs: Vec<FrfPair>,
    values: Vec<Complex64>,
    variances: Option<Vec<Vec<f64>>>,
) -> Result<FrfSet, SpectraError> {
    let mut set = FrfSet::new(recorded.lines().clone(), recorded.form(), pairs, values)?;
    if let Some(variances) = variances {
        set = set.with_variance(variances.concat())?;
    }
    for index in 0..recorded.pairs().len() {
        if let Some(coherence) = recorded.coherence(index) {
            set.set_coherence(index, coherence.to_vec())?;
        }
        set.set_averages(index, recorded.averages(index));
    }
    Ok(set)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, SpectralLines};

    fn recorded() -> FrfSet {
        let lines = SpectralLines::new(vec![10.0, 20.0]).unwrap();
        let pairs = [("4", "1"), ("3", "1"), ("4", "2")].map(|(o, i)| FrfPair::transverse(o, i));
        let values = (1..=6).map(|v| Complex64::new(f64::from(v), 0.5)).collect();
        let set = FrfSet::new(lines, FrfForm::Accelerance, pairs.to_vec(), values).unwrap();
        let mut set = set.with_variance((1..=6).map(f64::from).collect()).unwrap();
        set.set_coherence(1, vec![0.9, 0.8]).unwrap();
        set.set_averages(1, Some(7));
        set
    }

    #[test]
    fn a_response_is_multiplied_and_a_reference_divides() {
        let (before, four, one) = (recorded(), Channel::transverse("4"), Channel::transverse("1"));
        let scaled = with_signal(&before, Side::Response, &four, |_| Complex64::new(2.0, 0.0)).unwrap();
        assert_eq!(scaled.values(0)[1], before.values(0)[1] * 2.0);
        assert_eq!(scaled.values(1), before.values(1));
        assert_eq!((scaled.variance(2).unwrap()[0], scaled.coherence(1).unwrap()[1]), (20.0, 0.8));
        let late = |omega: f64| Complex64::from_polar(1.0, -omega * 1e-3);
        let delayed = with_signal(&before, Side::Reference, &one, late).unwrap();
        let phase = (delayed.values(1)[1] / before.values(1)[1]).arg();
        assert!((phase - std::f64::consts::TAU * 20.0 * 1e-3).abs() < 1e-12, "{phase}");
        assert_eq!(delayed.values(2), before.values(2));
    }

    #[test]
    fn exchanged_channels_keep_values_and_change_names() {
        let before = recorded();
        let swapped =
            exchanged(&before, Side::Response, [&Channel::transverse("4"), &Channel::transverse("3")])
                .unwrap();
        let names: Vec<String> = swapped.pairs().iter().map(ToString::to_string).collect();
        assert_eq!(names, ["3/1", "4/1", "3/2"]);
        assert_eq!(swapped.all_values(), before.all_values());
        assert_eq!((swapped.coherence(1), swapped.averages(1)), (before.coherence(1), Some(7)));
    }
}
