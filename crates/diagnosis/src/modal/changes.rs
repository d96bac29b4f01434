//! The modes of two states of a structure side by side.

use crate::modal::fit::ModalFit;
use crate::modal::searcher::Named;
use crate::settings::modal::changes::SAME;
use crate::{ModeChange, ModeState};
use jointscope_model_error::{Pairing, Pole, RecordedMode, RecordedModes};
use std::f64::consts::TAU;

/// Two states of a structure, and the model calibrated on the earlier one.
pub(super) struct States<'a> {
    pub before: &'a RecordedModes,
    pub now: &'a RecordedModes,
    /// Which of the modes now are which of the calibrated model.
    pub own: &'a Pairing,
    pub calibrated: &'a ModalFit,
}

impl States<'_> {
    /// The modes of both, with what `found` makes of them, ascending.
    pub(super) fn modes(&self, found: &Named) -> Vec<ModeChange> {
        let of_baseline = &self.calibrated.paired.pairing.pairs;
        let modelled = |b: usize| of_baseline.iter().find(|(other, _)| *other == b).map(|(_, m)| *m);
        let recorded = |m: usize| self.own.pairs.iter().find(|(_, other)| *other == m).map(|(r, _)| *r);
        let mut all: Vec<ModeChange> = Vec::new();
        let mut shared = Vec::new();
        for (b, was) in self.before.modes.iter().enumerate() {
            let model = modelled(b);
            let paired = model.and_then(recorded);
            let now = paired.or_else(|| self.unpaired(b));
            shared.extend(now);
            let ratio = |r: usize| ratio(&self.now.modes[r].pole, &was.pole);
            let deviation = |r: usize| self.deviation(b, r);
            let predicted = |(r, m)| self.predicted(found, r, m);
            all.push(ModeChange {
                baseline: Some(state(was)),
                now: now.map(|r| state(&self.now.modes[r])),
                change: now.map(ratio),
                change_std: now.map(deviation),
                predicted: paired.zip(model).and_then(predicted),
            });
        }
        let new = self.now.modes.iter().enumerate().filter(|(r, _)| !shared.contains(r));
        all.extend(new.map(|(_, mode)| ModeChange {
            baseline: None,
            now: Some(state(mode)),
            change: None,
            change_std: None,
            predicted: None,
        }));
        let frequency = |mode: &ModeChange| mode.baseline.or(mode.now).map_or(0.0, |state| state.frequency);
        all.sort_by(|a, b| frequency(a).total_cmp(&frequency(b)));
        all
    }

    /// Standard deviations of the change from mode `b` to mode `r` by the noise of both recordings.
    fn deviation(&self, b: usize, r: usize) -> ModeState {
        let [was, now] = [self.before.deviations(b), self.now.deviations(r)];
        ModeState { frequency: was[0].hypot(now[0]), damping_ratio: was[1].hypot(now[1]) }
    }

    /// The mode that is now what mode `b` was, of those that the model does not have: the nearest of either
    /// to the other.
    fn unpaired(&self, b: usize) -> Option<usize> {
        let of_baseline = &self.calibrated.paired.pairing.pairs;
        let was = |b: &usize| !of_baseline.iter().any(|(other, _)| other == b);
        let now = |r: &usize| !self.own.pairs.iter().any(|(other, _)| other == r);
        let apart =
            |b: usize, r: usize| (self.now.modes[r].pole.omega / self.before.modes[b].pole.omega).ln().abs();
        let nearest_now = |b: usize| {
            (0..self.now.modes.len()).filter(now).min_by(|x, y| apart(b, *x).total_cmp(&apart(b, *y)))
        };
        let nearest_was = |r: usize| {
            (0..self.before.modes.len()).filter(was).min_by(|x, y| apart(*x, r).total_cmp(&apart(*y, r)))
        };
        let r = nearest_now(b).filter(|_| was(&b))?;
        (nearest_was(r) == Some(b) && apart(b, r) < SAME).then_some(r)
    }

    /// By how much the effects found change mode `r`, which is the calibrated model's `m`.
    fn predicted(&self, found: &Named, r: usize, m: usize) -> Option<ModeState> {
        let paired = &found.fit.paired;
        let (_, own) = paired.pairing.pairs.iter().find(|(other, _)| *other == r)?;
        let [own, was] = [&paired.modelled.modes[*own], &self.calibrated.paired.modelled.modes[m]];
        (!found.names.is_empty()).then(|| ratio(&own.pole, &was.pole))
    }
}

fn state(mode: &RecordedMode) -> ModeState {
    ModeState { frequency: mode.pole.omega / TAU, damping_ratio: mode.pole.damping_ratio }
}

/// ln of the ratios of one mode's frequency and damping to another's.
fn ratio(pole: &Pole, to: &Pole) -> ModeState {
    ModeState {
        frequency: (pole.omega / to.omega).ln(),
        damping_ratio: (pole.damping_ratio / to.damping_ratio).ln(),
    }
}
