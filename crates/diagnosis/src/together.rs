//! Effects on several channels that are together exactly one other effect.
//!
//! What a channel does to its signal is a factor on a row or a column of the FRFs, on all of them (`force`,
//! `responses`) or on one (a record). Equal factors on all rows are one factor on everything, and so on: two
//! effects found one after another may be one that no step from either leads to.

use crate::candidate::Candidate;
use jointscope_fixture::{Effect, EffectKind, Entry, Place};
use jointscope_lumped::signal_power;
use jointscope_spectra::FrfPair;

/// Whether the inverse of what a kind does to a signal is of that kind too: of a gain and a delay it is, of
/// no filter.
pub(crate) fn inverts(kind: EffectKind) -> bool {
    matches!(kind, EffectKind::ChannelGain | EffectKind::ChannelDelay)
}

/// The powers with which a factor at a place enters each FRF.
fn powers(place: &Place, pairs: &[FrfPair]) -> Vec<i32> {
    pairs.iter().map(|pair| signal_power(place, pair)).collect()
}

/// The effect that does the inverse.
fn inverse(effect: Effect) -> Effect {
    let value = effect.value(0);
    let value = if effect.kind == EffectKind::ChannelGain { 1.0 / value } else { -value };
    Effect::new(effect.kind, effect.place, effect.dof, &[value])
}

/// Several of `effects`, by their places in the list, and the one of `candidates` that they are together if
/// their parameters are the same, with the mean of these.
pub(crate) fn as_one(
    effects: &[Effect],
    candidates: &[Candidate],
    pairs: &[FrfPair],
) -> Vec<(Vec<usize>, Effect)> {
    let on_signals = |index: &usize| effects[*index].kind.spec().entry == Entry::Signal;
    let mut all = Vec::new();
    for first in (0..effects.len()).filter(on_signals) {
        let kind = effects[first].kind;
        let alike: Vec<usize> =
            (first + 1..effects.len()).filter(|&other| effects[other].kind == kind).collect();
        // Every choice of some of the others: there are two at the most.
        for choice in 1..1_usize << alike.len() {
            let chosen = alike.iter().enumerate().filter(|(bit, _)| choice >> bit & 1 == 1);
            let several: Vec<usize> = std::iter::once(first).chain(chosen.map(|(_, other)| *other)).collect();
            let mut sum = vec![0; pairs.len()];
            for &index in &several {
                sum.iter_mut()
                    .zip(powers(&effects[index].place, pairs))
                    .for_each(|(sum, power)| *sum += power);
            }
            let opposite: Vec<i32> = sum.iter().map(|power| -power).collect();
            let count = several.len() as f64;
            let mean = |parameter: usize| {
                several.iter().map(|&index| effects[index].value(parameter)).sum::<f64>() / count
            };
            let mean: Vec<f64> = (0..effects[first].parameters.len()).map(mean).collect();
            for candidate in candidates.iter().filter(|candidate| candidate.kind == kind) {
                let one = Effect::new(kind, candidate.place.clone(), candidate.dof, &mean);
                let own = powers(&candidate.place, pairs);
                if own == sum {
                    all.push((several.clone(), one));
                } else if own == opposite && inverts(kind) {
                    all.push((several.clone(), inverse(one)));
                }
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs() -> Vec<FrfPair> {
        [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i)).to_vec()
    }

    fn candidate(kind: EffectKind, place: Place) -> Candidate {
        Candidate { kind, place, dof: None, starts: Vec::new(), directions: Vec::new() }
    }

    fn on(kind: EffectKind, place: Place, value: f64) -> Effect {
        Effect::new(kind, place, None, &[value])
    }

    /// The place and the value of the one effect that `several` are, of all places there are.
    fn one(kind: EffectKind, several: &[(Place, f64)]) -> Vec<(Place, f64)> {
        let effects: Vec<Effect> =
            several.iter().map(|(place, value)| on(kind, place.clone(), *value)).collect();
        let channels = ["3", "4"].map(|n| Place::Response(n.into()));
        let references = ["1", "2"].map(|n| Place::Reference(n.into()));
        let records = pairs().into_iter().map(|pair| Place::Record(pair.to_string()));
        let all =
            channels.into_iter().chain(references).chain(records).chain([Place::Force, Place::Responses]);
        let candidates: Vec<Candidate> = all.map(|place| candidate(kind, place)).collect();
        as_one(&effects, &candidates, &pairs())
            .into_iter()
            .map(|(_, e)| (e.place.clone(), e.value(0)))
            .collect()
    }

    fn response(name: &str) -> Place {
        Place::Response(name.into())
    }

    fn reference(name: &str) -> Place {
        Place::Reference(name.into())
    }

    #[test]
    fn equal_filters_of_all_references_are_one_of_the_force_and_of_all_responses_one_of_theirs() {
        let kind = EffectKind::ChannelHighpass;
        assert_eq!(one(kind, &[(reference("1"), 1.9), (reference("2"), 2.1)]), [(Place::Force, 2.0)]);
        assert_eq!(one(kind, &[(response("4"), 1.9), (response("3"), 2.1)]), [(Place::Responses, 2.0)]);
        assert_eq!(one(kind, &[(response("4"), 2.0), (reference("2"), 2.0)]), []);
    }

    #[test]
    fn equal_gains_of_all_responses_are_the_inverse_gain_of_the_force() {
        let all = one(EffectKind::ChannelGain, &[(response("4"), 1.25), (response("3"), 1.25)]);
        assert_eq!(all, [(Place::Force, 0.8), (Place::Responses, 1.25)]);
        let late = one(EffectKind::ChannelDelay, &[(response("4"), 1e-5), (response("3"), 1e-5)]);
        assert_eq!(late, [(Place::Force, -1e-5), (Place::Responses, 1e-5)]);
    }

    #[test]
    fn equal_gains_of_all_records_of_a_channel_are_that_channels() {
        let records = |names: [&str; 2]| names.map(|name| (Place::Record(name.into()), 1.25));
        assert_eq!(one(EffectKind::ChannelGain, &records(["4/1", "4/2"])), [(response("4"), 1.25)]);
        assert_eq!(one(EffectKind::ChannelGain, &records(["4/1", "3/1"])), [(reference("1"), 0.8)]);
        assert_eq!(one(EffectKind::ChannelGain, &records(["4/1", "3/2"])), []);
    }
}
