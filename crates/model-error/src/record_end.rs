//! Records that end while the structure still rings.
//!
//! A blow at t = 0 makes a mode ring, and at t = τ its record ends. The transform of the record lacks what
//! followed: of a mode with pole λ, ω_d = Im λ, and residue A
//!
//! > H(s) − e^{−sτ}·A·(a/(s − λ) + a*/(s − λ*)),  a = λ²e^{λτ}/(2iω_d)
//!
//! is recorded, over however many blows it is averaged. Spectral lines lie at multiples of the reciprocal of
//! the record's length T: had the blow come with the first sample, e^{−sτ} would be one on all of them, and
//! the residue be turned by 1 − e^{λτ}. A blow that comes later, as triggers have it, leaves besides a ripple
//! that no structure has in its FRFs. An exponential window is in the poles already. A blow of root mean
//! square duration σ has the transform e^{s²σ²/2}, and FRFs are over the force: it excited the mode by
//! e^{(λ² − s²)σ²/2} of what a line at s is divided by, and a is as much larger.
//!
//! The poles say how much is left of each mode, so τ, from the middle of the blow, and σ are the only
//! unknowns. What is missing is told from the FRFs themselves. FRFs that were not estimated from such records,
//! a model's or those of random excitation, have no such ripple, and only get worse for it. A suspension about
//! the lowest lines, which no lines tell, leaves what an end seems to explain: where poles explain all lines above
//! these, no end is looked for.

mod ringing;

use crate::basis::TERMS;
use crate::free_fit::FreeFit;
use crate::of_recording::{completed, poles_of, where_resolved};
use crate::recording::WeightedFrfs;
use crate::settings::record_end::{
    LEAST_GAIN, LEAST_LEFT, LEFT_OF_MISFIT, LONGEST_BLOW, NEAR_LINES, ROUNDS, SHORTEST, STEPS,
};
use jointscope_modes::ModesOptions;
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use ringing::{Cut, Ringing, left};
use serde::Serialize;
use std::f64::consts::TAU;

/// The end of the records that FRFs were estimated from, which came while the structure still rang.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RecordEnd {
    /// Time from the blow to the end of the records, s: of several references the mean.
    pub after: f64,
    /// What was left then of the mode that still rang loudest, as a share of its amplitude after the blow.
    pub left: f64,
}

impl RecordEnd {
    /// Where the records of a recording ended, and what each value of its FRFs lacks for it, FRF after FRF;
    /// `None` where they tell of no such end.
    pub fn of(recording: WeightedFrfs, options: &ModesOptions) -> Option<(Self, Vec<Complex64>)> {
        let hz = recording.frfs.lines().hz();
        let spacing = recording.frfs.lines().least_spacing()?;
        let whole = 1.0 / spacing;
        let (inside, outside) = poles_of(recording, options)?;
        let fit = FreeFit::converged(recording, inside, &outside, TERMS.0)?;
        if left(&fit.poles[..fit.inside], SHORTEST * whole) < LEAST_LEFT {
            return None;
        }
        let as_recorded = completed(recording, fit.clone());
        if most_gain(&as_recorded, recording) < LEAST_GAIN {
            return None;
        }
        let (above, resolved) = where_resolved(recording, &as_recorded)?;
        if most_gain(&resolved, above.recording()) < LEAST_GAIN {
            return None;
        }
        let highest = hz[hz.len() - 1];
        let area = Area {
            after: (SHORTEST * whole, whole),
            longest_blow: LONGEST_BLOW / (TAU * highest),
            reach: 0.5 / (highest - hz[0]),
        };
        let all: Vec<usize> = (0..recording.frfs.pairs().len()).collect();
        let ringing = Ringing { recording, fit: &fit, frfs: &all };
        // What resonances by themselves tell to some milliseconds the whole band tells as closely as it may.
        let spread = (0.5 / (NEAR_LINES * spacing) / area.reach).ceil() as i32;
        let about = |after: f64| (-spread..=spread).map(move |k| after + f64::from(k) * area.reach);
        let starts = ringing.ends(area.after, area.reach).into_iter().flat_map(about);
        let starts = starts.filter(|after| (area.after.0..=area.after.1).contains(after));
        let starts = starts.map(|after| Cut { after, blow: 0.5 * area.longest_blow });
        let costs = starts.map(|cut| (cut, ringing.without_end(cut).cost));
        let (start, _) = costs.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let best = Restored::near(recording, &fit, &area, start)?;
        best.explains_more_than(&as_recorded, recording).then_some((best.end, best.missing))
    }
}

/// Where an end is looked for.
struct Area {
    /// First and last time after the blow, s.
    after: (f64, f64),
    /// Root mean square duration of the longest blow, s.
    longest_blow: f64,
    /// How far an end may lie from where a search for it sets out, s.
    reach: f64,
}

impl Area {
    /// The end within a `share` of what may be, about a `start`, that leaves least, at the poles there are.
    fn nearest(&self, ringing: &Ringing, start: Cut, share: f64) -> Cut {
        let (mut best, mut cost) = (start, ringing.without_end(start).cost);
        let mut share = share;
        for _ in 0..STEPS {
            for (after, blow) in [(self.reach, 0.0), (0.0, 0.5 * self.longest_blow)] {
                let about = best;
                for turn in [-share, -0.5 * share, 0.5 * share, share] {
                    let other = Cut {
                        after: (about.after + turn * after).clamp(self.after.0, self.after.1),
                        blow: (about.blow + turn * blow).clamp(0.0, self.longest_blow),
                    };
                    let of_other = ringing.without_end(other).cost;
                    if of_other < cost {
                        (best, cost) = (other, of_other);
                    }
                }
            }
            share *= 0.5;
        }
        best
    }
}

/// FRFs with what the end of their records took.
struct Restored {
    frfs: FrfSet,
    fit: FreeFit,
    end: RecordEnd,
    /// What each value lacked.
    missing: Vec<Complex64>,
}

impl Restored {
    /// With an end about a `start`, and the poles that FRFs have which are so restored. All references have
    /// one at first, then each its own: a blow on another spot is longer or shorter.
    fn near(recording: WeightedFrfs, fit: &FreeFit, area: &Area, start: Cut) -> Option<Self> {
        let n = recording.frfs.lines().len();
        let pairs = recording.frfs.pairs();
        let mut references: Vec<Vec<usize>> = vec![(0..pairs.len()).collect()];
        let (mut cuts, mut share) = (vec![start], 1.0);
        let mut best: Option<Restored> = None;
        for round in 0..ROUNDS {
            let fit = best.as_ref().map_or(fit, |best| &best.fit);
            let mut missing = vec![Complex64::ZERO; n * pairs.len()];
            for (frfs, cut) in references.iter().zip(&mut cuts) {
                let ringing = Ringing { recording, fit, frfs };
                *cut = area.nearest(&ringing, *cut, share);
                for (own, &frf) in ringing.without_end(*cut).missing.chunks_exact(n).zip(frfs) {
                    missing[frf * n..][..n].copy_from_slice(own);
                }
            }
            let frfs = recording.frfs.clone().plus(&missing);
            let (inside, outside) = fit.poles.split_at(fit.inside);
            let of = WeightedFrfs { frfs: &frfs, weights: recording.weights };
            let fit = FreeFit::converged(of, inside.to_vec(), outside, fit.terms)?;
            let after = cuts.iter().map(|cut| cut.after).sum::<f64>() / cuts.len() as f64;
            let end = RecordEnd { after, left: left_of_loudest(&fit, after) };
            best = Some(Restored { frfs, fit, end, missing });
            if round == 0 {
                references = by_reference(recording.frfs);
                cuts = vec![cuts[0]; references.len()];
            }
            share *= 0.5;
        }
        best
    }

    /// Whether poles explain these FRFs clearly better than they do the `recording` as it is: beyond chance, and
    /// but for the lesser part of what they left.
    fn explains_more_than(&self, as_recorded: &FreeFit, recording: WeightedFrfs) -> bool {
        let of = WeightedFrfs { frfs: &self.frfs, weights: recording.weights };
        let restored = completed(of, self.fit.clone());
        let [before, after] = [as_recorded, &restored].map(|fit| fit.chi2_per_dof(recording).max(1.0));
        self.end.left > LEAST_LEFT
            && most_gain(as_recorded, recording) - most_gain(&restored, recording) > LEAST_GAIN
            && after - 1.0 < LEFT_OF_MISFIT * (before - 1.0)
    }
}

/// What χ² would gain where nothing were left but noise, whose size nobody knows.
fn most_gain(fit: &FreeFit, recording: WeightedFrfs) -> f64 {
    recording.degrees() * fit.chi2_per_dof(recording).max(1.0).ln()
}

/// The FRFs of each reference, by their index.
fn by_reference(frfs: &FrfSet) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = Vec::new();
    let pairs = frfs.pairs();
    for (index, pair) in pairs.iter().enumerate() {
        match all.iter_mut().find(|own| pairs[own[0]].reference == pair.reference) {
            Some(own) => own.push(index),
            None => all.push(vec![index]),
        }
    }
    all
}

/// What was left of the mode that rang loudest at a time after the blow.
fn left_of_loudest(fit: &FreeFit, after: f64) -> f64 {
    let of = |mode: usize| {
        let lambda = fit.poles[mode].lambda();
        let left = (lambda.re * after).exp();
        let squares: f64 = fit.residues(mode).map(|residue| residue.norm_sqr()).sum();
        (left, squares * (left * lambda.norm()).powi(2))
    };
    let loudest = (0..fit.inside).map(of).max_by(|a, b| a.1.total_cmp(&b.1));
    loudest.map_or(0.0, |(left, _)| left)
}
