//! The modes of a recording: where a free fit of poles, residues and residual terms to all FRFs starts, and the features that it gives.

use crate::basis::{Pole, TERMS};
use crate::free_fit::FreeFit;
use crate::matching::Pairing;
use crate::modelled::ModelledModes;
use crate::outline::Outline;
use jointscope_modes::{ModalAnalysis, ModesOptions};
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// FRFs to take the modes of: accelerances, with a weight for each value.
#[derive(Debug, Clone, Copy)]
pub struct Recording<'a> {
    /// Accelerances with their variances, on lines above 0 Hz.
    pub frfs: &'a FrfSet,
    /// 1/variance of the real part, and of the imaginary part, of each value, FRF after FRF: 2/E|ε|². Zero where a value does not count.
    pub weights: &'a [f64],
}

/// One mode of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMode {
    /// Natural frequency and damping ratio.
    pub pole: Pole,
    /// Residue in each FRF, 1/kg for transverse channels: φ_response·φ_reference of mass-normalised shapes, where damping is light.
    pub residues: Vec<Complex64>,
    /// Root mean square of the residues over the FRFs.
    pub scale: f64,
    /// Whether it lies far enough above the lowest line that counts to be told from a residual term.
    pub resolved: bool,
}

/// Modes and residual terms of a recording, with their covariance.
#[derive(Debug, Clone)]
pub struct RecordedModes {
    pub(crate) pairs: Vec<FrfPair>,
    /// The modes in the band, ascending.
    pub modes: Vec<RecordedMode>,
    /// Lowest and highest line that counts, Hz.
    pub band: (f64, f64),
    /// Lowest line, counted or not, Hz.
    pub(crate) lowest: f64,
    /// Frequency, Hz, from which on modes can be told from residual terms.
    pub(crate) resolved_from: f64,
    /// χ² per degree of freedom of the free fit.
    pub chi2_per_dof: f64,
    /// What the free fit leaves on each line, mean square in units of the noise.
    pub misfit: Vec<f64>,
    /// Real parts of mass line and upper residual of each FRF.
    pub(crate) residual_terms: Vec<[f64; 2]>,
    /// Root mean squares of those over the FRFs.
    pub(crate) residual_scales: [f64; 2],
    /// Covariance of mass lines, 1/kg², where the shapes of modes that are a part of them err at each channel by their root mean square; empty where there are none.
    pub(crate) low: Vec<f64>,
    /// Covariance of the [features](RecordedModes::features), row-major.
    pub(crate) covariance: Vec<f64>,
    pub(crate) outline: Outline,
    /// Poles outside the band, and number of residual terms of each FRF.
    pub(crate) surroundings: (Vec<Pole>, usize),
}

/// Where modes above the band are looked for, as multiples of its upper end.
const BEYOND: [f64; 2] = [1.06, 1.3];

/// The free fit that is begun with poles in and out of the band, with what else the recording asks for: modes just outside the band, then more residual terms, then modes
/// in the band that were missed.
fn free_fit(recording: Recording, inside: Vec<Pole>, outside: &[Pole]) -> Option<FreeFit> {
    let mut fit = FreeFit::converged(recording, inside, outside, TERMS.0)?;
    let lines = recording.frfs.lines().hz();
    let (low, high) = (TAU * lines[0], TAU * lines[lines.len() - 1]);
    let beyond = |by: f64| Pole { omega: high * by, damping_ratio: 0.01 };
    let outside = BEYOND.into_iter().map(beyond).chain([Pole { omega: 0.7 * low, damping_ratio: 0.02 }]);
    for pole in outside {
        fit = fit.with(recording, pole);
    }
    while fit.terms < TERMS.1 {
        let (inside, outside) = fit.poles.split_at(fit.inside);
        match FreeFit::converged(recording, inside.to_vec(), outside, fit.terms + 1) {
            Some(more) if fit.is_poor(recording) || fit.lacks(&more, recording) => fit = more,
            _ => break,
        }
    }
    Some(fit.with_missed(recording))
}

/// A free fit with poles that a model expects besides, one after the other. Where that leaves more than noise, the model's modes by themselves are another place to begin
/// from: what the recording showed by itself, on few lines or with next to no noise, may be none of its modes.
fn with_expected(recording: Recording, fit: FreeFit, besides: &[Pole], all: &[Pole]) -> FreeFit {
    let fit = besides.iter().fold(fit, |fit, pole| fit.with_expected(recording, *pole));
    if !fit.is_poor(recording) {
        return fit;
    }
    let lowest = TAU * recording.frfs.lines().hz()[0];
    let (below, inside): (Vec<Pole>, Vec<Pole>) = all.iter().partition(|pole| pole.omega < lowest);
    let other = free_fit(recording, inside, &below);
    other.filter(|other| fit.is_worse(other, recording)).unwrap_or(fit)
}

/// Modes of a model, in the band of a recording or a little below it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Expected {
    /// All of them.
    pub all: Vec<Pole>,
    /// Those that the recording, as far as it is told, has not.
    pub unpaired: Vec<Pole>,
}

/// A recording without its lowest lines.
struct Above {
    frfs: FrfSet,
    weights: Vec<f64>,
}

impl Above {
    /// The lines above modes too low to be told from a mass line, as far as the others stay told from one; `None` where there are no such modes, and where lines are so
    /// uneven that more than the lowest few would have to go.
    fn of(recording: Recording, poles: &[Pole]) -> Option<Self> {
        let hz = recording.frfs.lines().hz();
        let (from, reach) = (resolved_from(hz), resolved_from(hz) - hz[0]);
        let is_low = |pole: &&Pole| pole.omega <= TAU * from;
        poles.iter().find(is_low)?;
        let lowest = poles.iter().filter(|pole| !is_low(pole)).map(|pole| pole.omega / TAU);
        let cut = lowest.fold(from, |cut, resolved| cut.min(resolved - reach));
        let first = hz.partition_point(|hz| *hz < cut * (1.0 - 1e-9));
        if first == 0 || first > 2 * RESOLVED as usize {
            return None;
        }
        Above::line(recording, first)
    }

    fn line(recording: Recording, first: usize) -> Option<Self> {
        let of_frf = recording.weights.chunks_exact(recording.frfs.lines().len());
        let weights = of_frf.flat_map(|weights| &weights[first..]).copied().collect();
        Some(Above { frfs: recording.frfs.on_lines(|line| line >= first)?, weights })
    }

    fn recording(&self) -> Recording<'_> {
        Recording { frfs: &self.frfs, weights: &self.weights }
    }
}

impl RecordedModes {
    /// The modes of a recording; `None` where it has none that can be told.
    ///
    /// Poles that a model `expected` besides what they show by themselves are tried too: two modes on a few lines look like one. So are the model's alone, where more than
    /// noise is left. Where there are modes too low to be
    /// told from a mass line, the band begins above them: where they are on a few lines many poles fit as well, and mass lines differ with them by many deviations.
    pub fn of(
        recording: Recording,
        options: &ModesOptions,
        expected: impl FnOnce(&RecordedModes) -> Expected,
    ) -> Option<Self> {
        let analysis = ModalAnalysis::of(recording.frfs, options).ok()?;
        let poles = |modes: &[jointscope_modes::Mode]| -> Vec<Pole> {
            let pole = |m: &jointscope_modes::Mode| Pole {
                omega: TAU * m.frequency,
                damping_ratio: m.damping_ratio,
            };
            modes.iter().map(pole).filter(|p| p.damping_ratio > 0.0 && p.damping_ratio < 1.0).collect()
        };
        let fit = free_fit(recording, poles(&analysis.modes), &poles(&analysis.outside))?;
        let alone = fit.recorded_modes(recording)?;
        let expected = expected(&alone);
        let Expected { all, unpaired } = expected;
        let told_or_expected: Vec<Pole> = fit.poles[..fit.inside].iter().chain(&unpaired).copied().collect();
        let Some(above) = Above::of(recording, &told_or_expected) else {
            return match all.is_empty() {
                true => Some(alone),
                false => with_expected(recording, fit, &unpaired, &all).recorded_modes(recording),
            };
        };
        let (recording, from) = (above.recording(), TAU * above.frfs.lines().hz()[0]);
        let (low, within): (Vec<Pole>, Vec<Pole>) =
            fit.poles[..fit.inside].iter().partition(|p| p.omega < from);
        let fit = free_fit(recording, within, &fit.poles[fit.inside..])?;
        let besides: Vec<Pole> = low.into_iter().chain(unpaired).collect();
        let fit = with_expected(recording, fit, &besides, &all);
        let mut modes = fit.recorded_modes(recording)?;
        let below = alone.misfit.len() - modes.misfit.len();
        (modes.lowest, modes.outline.grid) = (alone.lowest, alone.outline.grid);
        modes.misfit.splice(..0, alone.misfit[..below].iter().copied());
        Some(modes)
    }

    /// These modes as a model that is calibrated on a `baseline` should have them: what the baseline's modes differ by from those of the model
    /// (`modelled`, paired by `pairing`) is taken off, and its covariance added. Modes that the baseline does not show are left out.
    ///
    /// `None` where the FRFs are not the same.
    pub fn relative_to(
        &self,
        baseline: &RecordedModes,
        modelled: &ModelledModes,
        [own, of_baseline]: [&Pairing; 2],
    ) -> Option<Self> {
        if self.pairs != baseline.pairs {
            return None;
        }
        let frfs = self.frfs();
        let mut relative = self.clone();
        let mut shared = Vec::new();
        for (r, mode) in relative.modes.iter_mut().enumerate() {
            let model = own.pairs.iter().find(|(recorded, _)| *recorded == r).map(|(_, m)| *m);
            let pair = model.and_then(|m| of_baseline.pairs.iter().find(|(_, other)| *other == m));
            let Some(&(b, m)) = pair else {
                mode.resolved = false;
                continue;
            };
            let (was, model) = (&baseline.modes[b], &modelled.modes[m]);
            mode.pole.omega *= model.pole.omega / was.pole.omega;
            mode.pole.damping_ratio *= model.pole.damping_ratio / was.pole.damping_ratio;
            for ((residue, was), model) in mode.residues.iter_mut().zip(&was.residues).zip(&model.residues) {
                *residue += model - was;
            }
            shared.push((r, b));
        }
        for ((terms, was), model) in
            relative.residual_terms.iter_mut().zip(&baseline.residual_terms).zip(&modelled.residual_terms)
        {
            for k in 0..2 {
                terms[k] += model[k] - was[k];
            }
        }
        let place = |modes: &RecordedModes, r: usize| {
            let residues = 2 * modes.modes.len() + 2 * r * frfs;
            [2 * r, 2 * r + 1].into_iter().chain(residues..residues + 2 * frfs)
        };
        let terms = |modes: &RecordedModes| {
            let first = 2 * modes.modes.len() * (1 + frfs);
            first..first + 2 * frfs
        };
        // (own place, the baseline's place, ratio of their scales)
        let mut places: Vec<(usize, usize, f64)> = Vec::new();
        for &(r, b) in &shared {
            let ratio = baseline.modes[b].scale / self.modes[r].scale;
            let both = place(self, r).zip(place(baseline, b)).enumerate();
            places.extend(both.map(|(k, (own, other))| (own, other, if k < 2 { 1.0 } else { ratio })));
        }
        for (k, (own, other)) in terms(self).zip(terms(baseline)).enumerate() {
            places.push((own, other, baseline.residual_scales[k % 2] / self.residual_scales[k % 2]));
        }
        let (n, m) = (self.count(), baseline.count());
        for &(i, a, by) in &places {
            for &(j, b, and) in &places {
                relative.covariance[i * n + j] += by * and * baseline.covariance[a * m + b];
            }
        }
        Some(relative)
    }

    /// The same modes as each FRF of the `recording` has them by itself, the free fit begun at the common poles; `None` for an FRF whose fit fails.
    ///
    /// Where a structure stays the same they differ by their noise.
    pub fn one_by_one(&self, recording: Recording) -> Vec<Option<RecordedModes>> {
        let below = recording.frfs.lines().hz().partition_point(|hz| *hz < self.band.0);
        let Some(above) = Above::line(recording, below) else { return Vec::new() };
        let n = above.frfs.lines().len();
        let poles: Vec<Pole> = self.modes.iter().map(|mode| mode.pole).collect();
        let (outside, terms) = &self.surroundings;
        let of = |index: usize| {
            let frfs = above.frfs.of_frfs(|frf| frf == index)?;
            let weights = above.weights.get(index * n..(index + 1) * n)?;
            let alone = Recording { frfs: &frfs, weights };
            FreeFit::converged(alone, poles.clone(), outside, *terms)?.recorded_modes(alone)
        };
        (0..recording.frfs.pairs().len()).map(of).collect()
    }

    /// Standard deviations of ln ω and ln ζ of mode `index` by the noise.
    pub fn deviations(&self, index: usize) -> [f64; 2] {
        let (n, first) = (self.count(), 2 * index);
        [first, first + 1].map(|at| self.covariance[at * (n + 1)].max(0.0).sqrt())
    }

    /// Whether the free fit took all the residual terms it may: then something smooth that is no mode is in the FRFs.
    pub fn is_strained(&self) -> bool {
        self.outline.projections[0].columns() - self.outline.poles >= TERMS.1
    }

    /// Number of FRFs.
    pub fn frfs(&self) -> usize {
        self.pairs.len()
    }

    /// Number of features: ln ω and ln ζ of each mode, real and imaginary residue of each FRF in each mode, and two residual terms of each FRF.
    pub fn count(&self) -> usize {
        let (modes, frfs) = (self.modes.len(), self.frfs());
        2 * modes + 2 * modes * frfs + 2 * frfs
    }

    /// The features: residues over the mode's [scale](RecordedMode::scale), residual terms over theirs.
    pub fn features(&self) -> Vec<f64> {
        let poles = self.modes.iter().flat_map(|m| [m.pole.omega.ln(), m.pole.damping_ratio.ln()]);
        let mut all: Vec<f64> = poles.collect();
        for mode in &self.modes {
            all.extend(mode.residues.iter().flat_map(|a| [a.re / mode.scale, a.im / mode.scale]));
        }
        for terms in &self.residual_terms {
            all.extend((0..2).map(|k| terms[k] / self.residual_scales[k]));
        }
        all
    }
}

/// Lines above the lowest one from which a mode can be told from a residual term.
const RESOLVED: f64 = 4.0;

/// Frequency, Hz, from which on modes are told from residual terms.
pub(crate) fn resolved_from(hz: &[f64]) -> f64 {
    hz[0] + RESOLVED * (hz[hz.len() - 1] - hz[0]) / (hz.len() as f64 - 1.0).max(1.0)
}
