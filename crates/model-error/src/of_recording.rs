//! From a recording to its modes: where the free fits of poles, residues and residual terms to all FRFs
//! start, and which of them is taken.

use crate::basis::{Pole, TERMS};
use crate::expected::Expected;
use crate::free_fit::FreeFit;
use crate::recorded::RecordedModes;
use crate::recording::{WeightedFrfs, resolved_from};
use crate::settings::recorded::{
    ABOVE_BAND, BELOW_BAND, CLEAR_DAMPING, CLEAR_FREQUENCY, CLEAR_LINES, DAMPING_RATIO_ABOVE,
    DAMPING_RATIO_BELOW, EXPECTED_WITHIN, MOST_LINES_LEFT_OUT, NARROW, RESOLVED_LINES,
};
use jointscope_modes::{ModalAnalysis, Mode, ModesOptions};
use jointscope_spectra::FrfSet;
use std::f64::consts::TAU;

/// Poles that a recording shows by itself, in the band and outside it.
pub(crate) fn poles_of(recording: WeightedFrfs, options: &ModesOptions) -> Option<(Vec<Pole>, Vec<Pole>)> {
    let analysis = ModalAnalysis::of(recording.frfs, options).ok()?;
    let poles = |modes: &[Mode]| -> Vec<Pole> {
        let pole = |m: &Mode| Pole { omega: TAU * m.frequency, damping_ratio: m.damping_ratio };
        modes.iter().map(pole).filter(|p| p.damping_ratio > 0.0 && p.damping_ratio < 1.0).collect()
    };
    Some((poles(&analysis.modes), poles(&analysis.outside)))
}

/// The free fit that is begun with poles in and out of the band, with what else the recording asks for.
fn free_fit(recording: WeightedFrfs, inside: Vec<Pole>, outside: &[Pole]) -> Option<FreeFit> {
    FreeFit::converged(recording, inside, outside, TERMS.0).map(|fit| completed(recording, fit))
}

/// A free fit with what else the recording asks for: modes just outside the band, then more residual terms,
/// then modes in the band that were missed.
pub(crate) fn completed(recording: WeightedFrfs, mut fit: FreeFit) -> FreeFit {
    let lines = recording.frfs.lines().hz();
    let (low, high) = (TAU * lines[0], TAU * lines[lines.len() - 1]);
    let beyond = |by: f64| Pole { omega: high * by, damping_ratio: DAMPING_RATIO_ABOVE };
    let below = Pole { omega: BELOW_BAND * low, damping_ratio: DAMPING_RATIO_BELOW };
    for pole in ABOVE_BAND.into_iter().map(beyond).chain([below]) {
        fit = fit.with(recording, pole);
    }
    while fit.terms < TERMS.1 {
        let (inside, outside) = fit.poles.split_at(fit.inside);
        match FreeFit::converged(recording, inside.to_vec(), outside, fit.terms + 1) {
            Some(more) if fit.is_poor(recording) || fit.lacks(&more, recording) => fit = more,
            _ => break,
        }
    }
    fit.with_missed(recording)
}

/// A free fit with poles that a model expects besides, one after the other. Where that leaves more than
/// noise, the model's modes by themselves are another place to begin from: what the recording showed by
/// itself, on few lines or with next to no noise, may be none of its modes.
fn with_expected(recording: WeightedFrfs, fit: FreeFit, besides: &[Pole], all: &[Pole]) -> FreeFit {
    let fit = besides.iter().fold(fit, |fit, pole| fit.with_expected(recording, *pole));
    if !fit.is_poor(recording) {
        return fit;
    }
    let lowest = TAU * recording.frfs.lines().hz()[0];
    let (below, inside): (Vec<Pole>, Vec<Pole>) = all.iter().partition(|pole| pole.omega < lowest);
    let other = free_fit(recording, inside, &below);
    other.filter(|other| fit.is_worse(other, recording)).unwrap_or(fit)
}

/// A recording above its lowest lines, where suspensions lie that no lines tell from a mass line, and the free
/// fit of it; `fit` is that of all lines.
pub(crate) fn where_resolved(recording: WeightedFrfs, fit: &FreeFit) -> Option<(Above, FreeFit)> {
    let above = Above::line(recording, RESOLVED_LINES)?;
    let [low, within] = above.poles_below_and_within(fit);
    let fit = free_fit(above.recording(), within, &[&fit.poles[fit.inside..], &low].concat())?;
    Some((above, fit))
}

/// A recording without its lowest lines.
pub(crate) struct Above {
    frfs: FrfSet,
    weights: Vec<f64>,
}

impl Above {
    /// The lines above modes too low to be told from a mass line, as far as the others stay told from one;
    /// `None` where there are no such modes, and where lines are so uneven that more than the lowest few
    /// would have to go.
    fn of(recording: WeightedFrfs, poles: &[Pole]) -> Option<Self> {
        let hz = recording.frfs.lines().hz();
        let (from, reach) = (resolved_from(hz), resolved_from(hz) - hz[0]);
        let is_low = |pole: &&Pole| pole.omega <= TAU * from;
        poles.iter().find(is_low)?;
        let lowest = poles.iter().filter(|pole| !is_low(pole)).map(|pole| pole.omega / TAU);
        let cut = lowest.fold(from, |cut, resolved| cut.min(resolved - reach));
        let first = hz.partition_point(|hz| *hz < cut * (1.0 - 1e-9));
        if first == 0 || first > MOST_LINES_LEFT_OUT {
            return None;
        }
        Above::line(recording, first)
    }

    fn line(recording: WeightedFrfs, first: usize) -> Option<Self> {
        let of_frf = recording.weights.chunks_exact(recording.frfs.lines().len());
        let weights = of_frf.flat_map(|weights| &weights[first..]).copied().collect();
        Some(Above { frfs: recording.frfs.on_lines(|line| line >= first)?, weights })
    }

    pub(crate) fn recording(&self) -> WeightedFrfs<'_> {
        WeightedFrfs { frfs: &self.frfs, weights: &self.weights }
    }

    /// The poles in the band of a fit of all lines: those below these lines, and the others.
    fn poles_below_and_within(&self, fit: &FreeFit) -> [Vec<Pole>; 2] {
        let from = TAU * self.frfs.lines().hz()[0];
        fit.poles[..fit.inside].iter().partition::<Vec<Pole>, _>(|pole| pole.omega < from).into()
    }
}

impl RecordedModes {
    /// The modes of a recording; `None` where it has none that can be told.
    ///
    /// Poles that a model `expected` besides what they show by themselves are tried too: two modes on a few
    /// lines look like one. So are the model's alone, where more than noise is left. Where there are modes
    /// too low to be told from a mass line, the band begins above them: where they are on a few lines many
    /// poles fit as well, and mass lines differ with them by many deviations. A mode that the model has not,
    /// told as sharply as others, is kept.
    pub fn of(
        recording: WeightedFrfs,
        options: &ModesOptions,
        expected: impl FnOnce(&RecordedModes) -> Expected,
    ) -> Option<Self> {
        let (inside, outside) = poles_of(recording, options)?;
        let fit = free_fit(recording, inside, &outside)?;
        let alone = fit.recorded_modes(recording)?;
        let expected = expected(&alone);
        let Expected { all, unpaired } = expected;
        let told_or_expected: Vec<Pole> = fit.poles[..fit.inside].iter().chain(&unpaired).copied().collect();
        if let Some(from) = alone.clear_of_the_lower_end(&all) {
            return with_expected(recording, fit, &unpaired, &all).recorded_modes_from(recording, from);
        }
        let Some(above) = Above::of(recording, &told_or_expected) else {
            return match all.is_empty() {
                true => Some(alone),
                false => with_expected(recording, fit, &unpaired, &all).recorded_modes(recording),
            };
        };
        let recording = above.recording();
        let [low, within] = above.poles_below_and_within(&fit);
        let fit = free_fit(recording, within, &fit.poles[fit.inside..])?;
        let besides: Vec<Pole> = low.into_iter().chain(unpaired).collect();
        let fit = with_expected(recording, fit, &besides, &all);
        let mut modes = fit.recorded_modes(recording)?;
        let below = alone.misfit.len() - modes.misfit.len();
        (modes.lowest, modes.outline.grid) = (alone.lowest, alone.outline.grid);
        modes.misfit.splice(..0, alone.misfit[..below].iter().copied());
        Some(modes)
    }

    /// Frequency, Hz, below a mode of this recording that lies near the lowest line and yet is told from a
    /// mass line, where a model `expects` none near it: the spring that nobody stated shows in nothing else.
    /// `None` where there is no such mode. A peak much narrower than the spacing of the lines tells its
    /// frequency alone: that it is so narrow is told as well then, which is more than a mass line could be
    /// taken for.
    fn clear_of_the_lower_end(&self, expected: &[Pole]) -> Option<f64> {
        let spacing = (self.resolved_from - self.lowest) / RESOLVED_LINES as f64;
        let is_expected =
            |omega: f64| expected.iter().any(|pole| (pole.omega / omega).ln().abs() < EXPECTED_WITHIN);
        let is_clear = |&index: &usize| {
            let mode = &self.modes[index];
            let [frequency, damping] = self.deviations(index);
            let Pole { omega, damping_ratio } = mode.pole;
            let widest = damping_ratio * (1.0 + 2.0 * damping) * omega / TAU;
            let is_told =
                frequency < CLEAR_FREQUENCY && (damping < CLEAR_DAMPING || widest < NARROW * spacing);
            let above = mode.pole.omega / TAU - self.lowest;
            !mode.resolved && above > CLEAR_LINES * spacing && is_told && !is_expected(mode.pole.omega)
        };
        let lowest = (0..self.modes.len()).find(is_clear)?;
        Some(0.5 * (self.lowest + self.modes[lowest].pole.omega / TAU))
    }

    /// The same modes as each FRF of the `recording` has them by itself, the free fit begun at the common
    /// poles; `None` for an FRF whose fit fails.
    ///
    /// Where a structure stays the same they differ by their noise.
    pub fn one_by_one(&self, recording: WeightedFrfs) -> Vec<Option<RecordedModes>> {
        let below = recording.frfs.lines().hz().partition_point(|hz| *hz < self.band.0);
        let Some(above) = Above::line(recording, below) else { return Vec::new() };
        let n = above.frfs.lines().len();
        let poles: Vec<Pole> = self.modes.iter().map(|mode| mode.pole).collect();
        let (outside, terms) = &self.surroundings;
        let of = |index: usize| {
            let frfs = above.frfs.of_frfs(|frf| frf == index)?;
            let weights = above.weights.get(index * n..(index + 1) * n)?;
            let alone = WeightedFrfs { frfs: &frfs, weights };
            FreeFit::converged(alone, poles.clone(), outside, *terms)?
                .recorded_modes_from(alone, self.resolved_from)
        };
        (0..recording.frfs.pairs().len()).map(of).collect()
    }
}
