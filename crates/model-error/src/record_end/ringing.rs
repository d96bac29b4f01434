//! What of the modes' motion came after the end of a record.

use crate::basis::Pole;
use crate::free_fit::FreeFit;
use crate::recording::WeightedFrfs;
use crate::settings::record_end::{MOST_STARTS, MOST_TURNS, NEAR_LINES, QUADRATURE, SETTLED};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// FRFs of a recording, and modes that still rang at its end.
pub(super) struct Ringing<'a> {
    pub recording: WeightedFrfs<'a>,
    pub fit: &'a FreeFit,
    /// The FRFs, by their index.
    pub frfs: &'a [usize],
}

/// FRFs without an end of their records.
pub(super) struct WithoutEnd {
    /// What each value lacks, FRF after FRF.
    pub missing: Vec<Complex64>,
    /// χ² of the modes at their poles, and what their residues cost that are out of phase.
    pub cost: f64,
}

/// How records ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// Time from the middle of the blow, s.
    pub after: f64,
    /// Root mean square duration of the blow, s.
    pub blow: f64,
}

/// λ²e^{λτ}/(2iω_d): how a mode of residue one still rings `after` its blow.
fn amplitude(pole: &Pole, after: f64) -> Complex64 {
    let lambda = pole.lambda();
    lambda * lambda * (lambda * after).exp() / Complex64::new(0.0, 2.0 * lambda.im)
}

/// The transform at s of what followed of a mode of residue one.
fn tail(pole: &Pole, cut: Cut, s: Complex64) -> Complex64 {
    let (size, lambda) = (amplitude(pole, cut.after), pole.lambda());
    let excited = |lambda: Complex64| (0.5 * cut.blow * cut.blow * (lambda * lambda - s * s)).exp();
    let of = |size: Complex64, lambda: Complex64| excited(lambda) * size / (s - lambda);
    (-s * cut.after).exp() * (of(size, lambda) + of(size.conj(), lambda.conj()))
}

/// What is left at a time after the blow of the mode that rings longest.
pub(super) fn left(modes: &[Pole], after: f64) -> f64 {
    modes.iter().map(|pole| (pole.lambda().re * after).exp()).fold(0.0, f64::max)
}

/// What it costs that the residues of a mode have a phase in common: the square of that, in units of what
/// structures' are. Light damping leaves residues nearly real.
fn out_of_phase(residues: impl Iterator<Item = Complex64>) -> f64 {
    let of = |sums: (f64, f64), a: Complex64| (sums.0 + a.re * a.im, sums.1 + a.norm_sqr());
    let (along, square) = residues.fold((0.0, f64::MIN_POSITIVE), of);
    (along / square / QUADRATURE).powi(2)
}

impl Ringing<'_> {
    fn modes(&self) -> &[Pole] {
        &self.fit.poles[..self.fit.inside]
    }

    /// Times after the blow, at least `step` apart, at which records may have ended: where what the free fit
    /// leaves looks most like what would be missing, and the last one, with which nothing need be left.
    pub(super) fn ends(&self, (from, to): (f64, f64), step: f64) -> Vec<f64> {
        let times: Vec<f64> = (0..((to - from) / step) as usize).map(|k| to - k as f64 * step).collect();
        let likeness = self.likeness(&times);
        let is_peak = |&k: &usize| {
            let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
            beside.filter_map(|other| likeness.get(other)).all(|other| *other <= likeness[k])
        };
        let mut peaks: Vec<usize> = (0..times.len()).filter(is_peak).collect();
        peaks.sort_by(|&a, &b| likeness[b].total_cmp(&likeness[a]));
        peaks.truncate(MOST_STARTS);
        peaks.into_iter().map(|k| times[k]).chain([to]).collect()
    }

    /// How much what the free fit leaves about resonances looks like what records lack that ended at such
    /// times, each mode for itself.
    fn likeness(&self, times: &[f64]) -> Vec<f64> {
        let lines = self.recording.frfs.lines();
        let n = lines.len();
        let reach = NEAR_LINES * TAU * lines.least_spacing().unwrap_or_default();
        let omegas: Vec<f64> = lines.omegas().collect();
        let is_near = |line: &usize| self.modes().iter().any(|p| (omegas[*line] - p.omega).abs() < reach);
        let near: Vec<usize> = (0..n).filter(is_near).collect();
        let mut alike = vec![vec![Complex64::ZERO; near.len()]; self.modes().len()];
        let mut squares = vec![0.0; self.modes().len()];
        for &frf in self.frfs {
            let weights = &self.recording.weights[frf * n..][..n];
            let (residues, left) = self.fit.split(frf, self.recording.frfs.values(frf));
            for (mode, pole) in self.modes().iter().enumerate() {
                for (alike, &line) in alike[mode].iter_mut().zip(&near) {
                    let own = weights[line].sqrt() * residues[mode]
                        / (Complex64::new(0.0, omegas[line]) - pole.lambda());
                    *alike += left[line].conj() * own;
                    squares[mode] += own.norm_sqr();
                }
            }
        }
        let at = |&after: &f64| {
            let turns: Vec<Complex64> =
                near.iter().map(|&line| Complex64::cis(-omegas[line] * after)).collect();
            let (mut along, mut square) = (0.0, f64::MIN_POSITIVE);
            for ((pole, alike), own) in self.modes().iter().zip(&alike).zip(&squares) {
                let size = amplitude(pole, after);
                let sum: Complex64 = alike.iter().zip(&turns).map(|(alike, turn)| alike * turn).sum();
                along += (size * sum).re;
                square += size.norm_sqr() * own;
            }
            -along / square.sqrt()
        };
        times.iter().map(at).collect()
    }

    /// The FRFs as if records had not ended, at the poles there are. The residues that tell what is missing
    /// are those of the FRFs with it.
    pub(super) fn without_end(&self, cut: Cut) -> WithoutEnd {
        let lines = self.recording.frfs.lines();
        let n = lines.len();
        let tail = |pole: &Pole| -> Vec<Complex64> {
            lines.omegas().map(|omega| tail(pole, cut, Complex64::new(0.0, omega))).collect()
        };
        // Each turn leaves of an error what was left of the mode.
        let turns =
            (SETTLED.ln() / left(self.modes(), cut.after).ln()).ceil().clamp(1.0, MOST_TURNS) as usize;
        let tails: Vec<Vec<Complex64>> = self.modes().iter().map(tail).collect();
        let mut all = WithoutEnd { missing: Vec::with_capacity(n * self.frfs.len()), cost: 0.0 };
        let mut of_frfs = Vec::new();
        for &frf in self.frfs {
            let values = self.recording.frfs.values(frf);
            let mut missing = vec![Complex64::ZERO; n];
            let (mut residues, mut left) = self.fit.split(frf, values);
            for _ in 0..turns {
                for (line, missing) in missing.iter_mut().enumerate() {
                    *missing = tails.iter().zip(&residues).map(|(tail, a)| tail[line] * a).sum();
                }
                let restored: Vec<Complex64> = values.iter().zip(&missing).map(|(v, m)| v + m).collect();
                (residues, left) = self.fit.split(frf, &restored);
            }
            all.cost += left.iter().map(|left| left.norm_sqr()).sum::<f64>();
            all.missing.extend(missing);
            of_frfs.push(residues);
        }
        let of_mode = |mode: usize| of_frfs.iter().map(move |residues| residues[mode]);
        all.cost += (0..self.modes().len()).map(|mode| out_of_phase(of_mode(mode))).sum::<f64>();
        all
    }
}
