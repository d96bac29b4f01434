//! The free fit of a recording: poles by Gauss–Newton steps, residues and residual terms eliminated (variable
//! projection, Golub & Pereyra, *SIAM J. Numer. Anal.* 10 (1973) 413), and the covariance of all of them.
//!
//! At given poles each FRF is linear in its coefficients c, which a [`Projection`] gives. A pole parameter p
//! moves the fit by the part of c·∂b/∂p that lies across the columns (Kaufman's approximation), and c by the
//! part along them.
//!
//! The steps are not those of `descend` in `inference`: value, step and covariance come out of one and the
//! same projection of each FRF, every step is undamped and held to a few per cent of a frequency, and a fit
//! ends where its step is small beside the deviations of its poles, as these and not χ² are what is wanted.

use crate::basis::{MASS_LINE, Pole, TERMS, UPPER, row};
use crate::outline::Outline;
use crate::projection::Projection;
use crate::recorded::{RecordedMode, RecordedModes};
use crate::recording::{WeightedFrfs, resolved_from};
use crate::settings::free_fit::{
    CONVERGED, LEFT_BY_MISSED_POLE, LEFT_BY_OUTER_POLE, MISSED_DAMPING_RATIO, MISSED_WITHIN_LINES,
    MOST_DAMPING_RATIO, MOST_DAMPING_STEP, MOST_FREQUENCY_STEP, MOST_STEPS, POOR, STEP_SHARES, VAGUE_DAMPING,
    VAGUE_FREQUENCY,
};
use jointscope_linalg::Cholesky;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Poles, and each FRF's fit with them.
#[derive(Clone)]
pub(crate) struct FreeFit {
    pub poles: Vec<Pole>,
    /// How many of the poles are modes in the band; they come first.
    pub inside: usize,
    /// Residual terms of each FRF.
    pub terms: usize,
    fits: Vec<FrfFit>,
    /// Information on ln ω and ln ζ of all poles, and the Gauss–Newton step of them.
    information: Vec<f64>,
    step: Vec<f64>,
    pub chi2: f64,
    /// Squared residuals in units of the noise, by line, over all FRFs.
    misfit: Vec<f64>,
}

/// The columns whose coefficients make up mass line and upper residual. Modes too low to be told from a mass
/// line, a suspension's, are a part of it: what they and the residual term by itself are no recording tells
/// apart, what they are together it tells well.
fn residual_columns(poles: &[Pole], resolved_from: f64) -> [Vec<usize>; 2] {
    let low = (0..poles.len()).filter(|&p| poles[p].omega <= TAU * resolved_from);
    [low.chain([poles.len() + MASS_LINE]).collect(), vec![poles.len() + UPPER]]
}

/// One FRF at given poles.
#[derive(Clone)]
struct FrfFit {
    projection: Projection,
    coefficients: Vec<Complex64>,
    /// Change of the coefficients with each pole's ln ω and ln ζ.
    sensitivity: Vec<Vec<Complex64>>,
}

impl FreeFit {
    /// Whether more than noise is left.
    pub(crate) fn is_poor(&self, recording: WeightedFrfs) -> bool {
        self.chi2_per_dof(recording) > POOR
    }

    /// Whether the residual terms that `more` has are worth their number by Akaike's criterion. What too few
    /// of them leave biases the poles long before χ² as a whole looks poor.
    pub(crate) fn lacks(&self, more: &FreeFit, recording: WeightedFrfs) -> bool {
        let coefficients = 2.0 * ((more.terms - self.terms) * self.fits.len()) as f64;
        self.chi2 - more.chi2 > 2.0 * coefficients * more.chi2_per_dof(recording).max(1.0)
    }

    /// With one pole more outside the band, where the fit is poor without it and better for it.
    pub(crate) fn with(self, recording: WeightedFrfs, pole: Pole) -> Self {
        if !self.is_poor(recording) {
            return self;
        }
        let (inside, outside) = self.poles.split_at(self.inside);
        let outside: Vec<Pole> = outside.iter().copied().chain([pole]).collect();
        let more = FreeFit::converged(recording, inside.to_vec(), &outside, self.terms);
        more.filter(|more| more.chi2 < LEFT_BY_OUTER_POLE * self.chi2).unwrap_or(self)
    }

    /// With a pole that a model has, in the band or below it, where that is worth its number of unknowns by
    /// Akaike's criterion: what it takes from χ² as a whole may be little, and without it mass lines are off
    /// by ten of their deviations.
    pub(crate) fn with_expected(self, recording: WeightedFrfs, pole: Pole) -> Self {
        let (inside, outside) = self.poles.split_at(self.inside);
        let (mut inside, mut outside) = (inside.to_vec(), outside.to_vec());
        let is_below = pole.omega < TAU * recording.frfs.lines().hz()[0];
        if is_below { &mut outside } else { &mut inside }.push(pole);
        let more = FreeFit::converged(recording, inside, &outside, self.terms);
        more.filter(|more| self.is_worse(more, recording)).unwrap_or(self)
    }

    /// With a pole more in the band, where the fit misses most: two modes close to each other, seen on few
    /// lines, pass for one. It is kept where little is left with it of what was missed, and if the lines
    /// resolve it: a tone on one line is no mode.
    pub(crate) fn with_missed(self, recording: WeightedFrfs) -> Self {
        if !self.is_poor(recording) {
            return self;
        }
        let lines = recording.frfs.lines().hz();
        let most = self.misfit.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let Some((line, _)) = most.filter(|_| lines.len() > 1) else { return self };
        let spacing = (lines[(line + 1).min(lines.len() - 1)] - lines[line.saturating_sub(1)]) / 2.0;
        let (inside, outside) = self.poles.split_at(self.inside);
        let missed = Pole { omega: TAU * lines[line], damping_ratio: MISSED_DAMPING_RATIO };
        let inside: Vec<Pole> = inside.iter().copied().chain([missed]).collect();
        let more = FreeFit::converged(recording, inside, outside, self.terms);
        let is_seen = |more: &FreeFit| {
            let near = |pole: &&Pole| (pole.omega / TAU - lines[line]).abs() < MISSED_WITHIN_LINES * spacing;
            let mut near = more.poles[..more.inside].iter().filter(near);
            near.any(|pole| 2.0 * pole.damping_ratio * pole.omega > TAU * spacing)
        };
        more.filter(|more| more.chi2 < LEFT_BY_MISSED_POLE * self.chi2 && is_seen(more))
            .map_or(self, |more| more.with_missed(recording))
    }

    /// Whether another fit of the same recording is better by Akaike's criterion.
    pub(crate) fn is_worse(&self, other: &FreeFit, recording: WeightedFrfs) -> bool {
        let unknowns = self.unknowns() as f64 - other.unknowns() as f64;
        let richer = if unknowns > 0.0 { self } else { other };
        self.chi2 - other.chi2 + 2.0 * unknowns * richer.chi2_per_dof(recording).max(1.0) > 0.0
    }

    fn unknowns(&self) -> usize {
        2 * self.poles.len() + self.fits.len() * 2 * (self.poles.len() + self.terms)
    }

    /// Residues of a mode, FRF by FRF.
    pub(crate) fn residues(&self, mode: usize) -> impl Iterator<Item = Complex64> + '_ {
        self.fits.iter().map(move |fit| fit.coefficients[mode])
    }

    /// The coefficients of other values of an FRF, at the same poles, and what these leave of them in units of
    /// the noise.
    pub(crate) fn split(&self, frf: usize, values: &[Complex64]) -> (Vec<Complex64>, Vec<Complex64>) {
        self.fits[frf].projection.split(values)
    }

    pub(crate) fn chi2_per_dof(&self, recording: WeightedFrfs) -> f64 {
        self.chi2 / (recording.degrees() - self.unknowns() as f64).max(1.0)
    }

    /// With the poles that Gauss–Newton steps lead to.
    pub(crate) fn converged(
        recording: WeightedFrfs,
        inside: Vec<Pole>,
        outside: &[Pole],
        terms: usize,
    ) -> Option<Self> {
        let count = inside.len();
        if count == 0 {
            return None;
        }
        let mut poles = inside;
        poles.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        poles.extend_from_slice(outside);
        let mut fit = FreeFit::at(recording, poles, count, terms)?;
        for _ in 0..MOST_STEPS {
            let relative = |(i, step): (usize, &f64)| step * fit.information[i * fit.step.len() + i].sqrt();
            let largest = fit.step.iter().enumerate().map(relative).fold(0.0, |m: f64, s| m.max(s.abs()));
            if largest < CONVERGED {
                break;
            }
            let moved = |share: f64| {
                let factor = |step: f64, most: f64| (share * step.clamp(-most, most)).exp();
                let step = |(pole, step): (&Pole, &[f64; 2])| Pole {
                    omega: pole.omega * factor(step[0], MOST_FREQUENCY_STEP),
                    damping_ratio: (pole.damping_ratio * factor(step[1], MOST_DAMPING_STEP))
                        .min(MOST_DAMPING_RATIO),
                };
                let poles = fit.poles.iter().zip(fit.step.as_chunks::<2>().0).map(step).collect();
                FreeFit::at(recording, poles, count, terms)
            };
            match STEP_SHARES.into_iter().find_map(|share| moved(share).filter(|next| next.chi2 < fit.chi2)) {
                Some(next) => fit = next,
                None => break,
            }
        }
        // Close modes may have passed each other.
        let mut poles = fit.poles.clone();
        poles[..count].sort_by(|a, b| a.omega.total_cmp(&b.omega));
        if poles != fit.poles {
            fit = FreeFit::at(recording, poles, count, terms)?;
        }
        Some(fit)
    }

    /// At given poles.
    fn at(recording: WeightedFrfs, poles: Vec<Pole>, inside: usize, terms: usize) -> Option<Self> {
        let omegas: Vec<f64> = recording.frfs.lines().omegas().collect();
        let reference = *omegas.last()?;
        let rows: Vec<Vec<Complex64>> =
            omegas.iter().map(|w| row(&poles, terms, *w, reference).collect()).collect();
        let order = 2 * poles.len();
        let mut information = vec![0.0; order * order];
        let mut right = vec![0.0; order];
        let mut chi2 = 0.0;
        let mut misfit = vec![0.0; omegas.len()];
        let mut fits = Vec::new();
        for frf in 0..recording.frfs.pairs().len() {
            let n = omegas.len();
            let projection = Projection::new(&rows, &recording.weights[frf * n..(frf + 1) * n])?;
            let (coefficients, left) = projection.split(recording.frfs.values(frf));
            chi2 += left.iter().map(|v| v.norm_sqr()).sum::<f64>();
            misfit.iter_mut().zip(&left).for_each(|(sum, v)| *sum += v.norm_sqr());
            let mut sensitivity = Vec::with_capacity(order);
            let mut slopes = Vec::with_capacity(order);
            for (index, pole) in poles.iter().enumerate() {
                let by: [fn(&Pole, Complex64) -> Complex64; 2] = [Pole::by_frequency, Pole::by_damping];
                for derivative in by {
                    let s = omegas.iter().map(|w| Complex64::new(0.0, *w));
                    let values: Vec<Complex64> =
                        s.map(|s| derivative(pole, s) * coefficients[index]).collect();
                    let (along, across) = projection.split(&values);
                    sensitivity.push(along.into_iter().map(|c| -c).collect());
                    slopes.push(across);
                }
            }
            let product = |a: &[Complex64], b: &[Complex64]| -> f64 {
                a.iter().zip(b).map(|(a, b)| a.re * b.re + a.im * b.im).sum()
            };
            for i in 0..order {
                right[i] += product(&slopes[i], &left);
                for j in 0..=i {
                    information[i * order + j] += product(&slopes[i], &slopes[j]);
                }
            }
            fits.push(FrfFit { projection, coefficients, sensitivity });
        }
        for i in 0..order {
            for j in 0..i {
                information[j * order + i] = information[i * order + j];
            }
        }
        let vague = [VAGUE_FREQUENCY, VAGUE_DAMPING];
        for k in 0..order {
            information[k * (order + 1)] += vague[k % 2].powi(-2);
        }
        let mut step = right;
        Cholesky::of(order, &information)?.solve_in_place(&mut step);
        Some(FreeFit { poles, inside, terms, fits, information, step, chi2, misfit })
    }

    /// What it says of the modes in the band.
    pub(crate) fn recorded_modes(&self, recording: WeightedFrfs) -> Option<RecordedModes> {
        self.recorded_modes_from(recording, resolved_from(recording.frfs.lines().hz()))
    }

    /// The same where modes above a frequency, Hz, are told from residual terms.
    pub(crate) fn recorded_modes_from(
        &self,
        recording: WeightedFrfs,
        resolved_from: f64,
    ) -> Option<RecordedModes> {
        let lines = recording.frfs.lines();
        let frfs = self.fits.len();
        let modes = self.inside;
        let scale = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
        let recorded: Vec<RecordedMode> = (0..modes)
            .map(|r| {
                let residues: Vec<Complex64> = self.residues(r).collect();
                let sizes: Vec<f64> = residues.iter().map(|a| a.norm()).collect();
                let resolved = self.poles[r].omega / TAU > resolved_from;
                let scale = scale(&sizes).max(f64::MIN_POSITIVE);
                RecordedMode { pole: self.poles[r], scale, residues, resolved }
            })
            .collect();
        let sum = |columns: &Vec<usize>| -> Vec<f64> {
            let of_frf = |f: &FrfFit| columns.iter().map(|&c| f.coefficients[c].re).sum();
            self.fits.iter().map(of_frf).collect()
        };
        let columns = residual_columns(&self.poles, resolved_from);
        let terms = columns.each_ref().map(sum);
        let residual_scales = [0, 1].map(|k| scale(&terms[k]).max(f64::MIN_POSITIVE));
        let chi2_per_dof = self.chi2_per_dof(recording);
        let covariance = self.covariance(&recorded, (&residual_scales, &columns), chi2_per_dof.max(1.0))?;
        let [mass_line, _] = columns;
        Some(RecordedModes {
            pairs: recording.frfs.pairs().to_vec(),
            band: (lines.hz()[0], lines.hz()[lines.len() - 1]),
            lowest: lines.hz()[0],
            resolved_from,
            chi2_per_dof,
            misfit: self.misfit.iter().map(|sum| sum / (2 * frfs) as f64).collect(),
            residual_terms: (0..frfs).map(|j| [terms[0][j], terms[1][j]]).collect(),
            residual_scales,
            low: Vec::new(),
            covariance,
            excess_residual_terms: self.terms >= TERMS.1,
            outline: Outline::of(recording, (&self.poles, self.inside), self.terms, mass_line)?,
            offsets: None,
            surroundings: (self.poles[modes..].to_vec(), self.terms),
            modes: recorded,
        })
    }

    /// Covariance of the features: each FRF's own at given poles, and what the poles' covariance makes of all
    /// of them.
    fn covariance(
        &self,
        modes: &[RecordedMode],
        (scales, [mass_line, upper]): (&[f64; 2], &[Vec<usize>; 2]),
        inflation: f64,
    ) -> Option<Vec<f64>> {
        let (m, all, frfs) = (modes.len(), self.poles.len(), self.fits.len());
        let count = 2 * m + 2 * m * frfs + 2 * frfs;
        let order = 2 * all;
        let of_poles = Cholesky::of(order, &self.information)?.inverse();
        // Each feature as (FRF, coefficients of which it is the sum, imaginary part or not, scale); poles
        // stand for themselves.
        let residue = |r: usize, frf: usize, im: bool| (frf, vec![r], im, modes[r].scale);
        let mut parts = Vec::new();
        for r in 0..m {
            parts.extend((0..frfs).flat_map(|frf| [residue(r, frf, false), residue(r, frf, true)]));
        }
        for frf in 0..frfs {
            parts.push((frf, mass_line.clone(), false, scales[0]));
            parts.push((frf, upper.clone(), false, scales[1]));
        }
        // How each feature moves with the poles.
        let mut with_poles = vec![0.0; count * order];
        for k in 0..2 * m {
            with_poles[k * order + k] = 1.0;
        }
        for (k, (frf, columns, im, scale)) in parts.iter().enumerate() {
            for (p, change) in self.fits[*frf].sensitivity.iter().enumerate() {
                let change: Complex64 = columns.iter().map(|&c| change[c]).sum();
                with_poles[(2 * m + k) * order + p] = if *im { change.im } else { change.re } / scale;
            }
        }
        let mut covariance = propagated(&with_poles, &of_poles, (count, order));
        let own: Vec<Vec<Complex64>> = self.fits.iter().map(|f| f.projection.covariance()).collect();
        for (i, (frf, of_a, im_a, scale_a)) in parts.iter().enumerate() {
            for (j, (other, of_b, im_b, scale_b)) in parts.iter().enumerate() {
                if frf == other {
                    let columns = self.fits[*frf].projection.columns();
                    let pairs = of_a.iter().flat_map(|a| of_b.iter().map(move |b| a * columns + b));
                    let entry: Complex64 = pairs.map(|place| own[*frf][place]).sum();
                    let part = match (im_a, im_b) {
                        (false, false) | (true, true) => entry.re,
                        (true, false) => entry.im,
                        (false, true) => -entry.im,
                    };
                    covariance[(2 * m + i) * count + 2 * m + j] += part / (scale_a * scale_b);
                }
            }
        }
        covariance.iter_mut().for_each(|value| *value *= inflation);
        Some(covariance)
    }
}

/// J C Jᵀ of `count` features that move with `order` coordinates as J says, whose covariance is C.
fn propagated(jacobian: &[f64], covariance: &[f64], (count, order): (usize, usize)) -> Vec<f64> {
    let mut moved = vec![0.0; count * order];
    for i in 0..count {
        for p in 0..order {
            let value = jacobian[i * order + p];
            if value != 0.0 {
                for q in 0..order {
                    moved[i * order + q] += value * covariance[p * order + q];
                }
            }
        }
    }
    let dot =
        |i: usize, j: usize| (0..order).map(|p| moved[i * order + p] * jacobian[j * order + p]).sum::<f64>();
    (0..count * count).map(|e| dot(e / count, e % count)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};

    #[test]
    fn a_pole_that_a_model_expects_is_taken_where_the_frfs_have_it_and_left_where_not() {
        let pole = |hz: f64| Pole { omega: TAU * hz, damping_ratio: 0.01 };
        let (strong, weak) = (pole(60.0), pole(6.0));
        let lines = SpectralLines::even(2.5, 2.5, 60).unwrap();
        let of = |omega: f64| {
            let s = Complex64::new(0.0, omega);
            strong.accelerance(s) + 0.02 * weak.accelerance(s)
        };
        let values: Vec<Complex64> = lines.omegas().map(of).collect();
        let deviation = 0.01 * values.iter().map(|value| value.norm()).fold(f64::INFINITY, f64::min);
        let weights = vec![2.0 / deviation.powi(2); values.len()];
        let pairs = vec![FrfPair::transverse("2", "1")];
        let frfs = FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap();
        let recording = WeightedFrfs { frfs: &frfs, weights: &weights };
        let alone = || FreeFit::converged(recording, vec![strong], &[], 2).unwrap();
        let found = alone().with_expected(recording, pole(6.3));
        assert_eq!(found.inside, 2);
        assert!((found.poles[0].omega / weak.omega - 1.0).abs() < 1e-3, "{:?}", found.poles);
        assert_eq!(found.with_expected(recording, pole(110.0)).inside, 2);
    }

    /// An FRF set of eight pairs: modes with these poles, residues of either sign, and a `tone` on one line
    /// of all of them, with noise of a ten-thousandth of the largest value.
    fn eight(poles: &[Pole], tone: Option<usize>) -> (FrfSet, Vec<f64>) {
        let lines = SpectralLines::even(2.5, 2.5, 120).unwrap();
        let pairs: Vec<FrfPair> = (0..8).map(|o| FrfPair::transverse(&format!("{o}"), "a")).collect();
        let omegas: Vec<f64> = lines.omegas().collect();
        let mut values: Vec<Complex64> = Vec::new();
        for frf in 0..8 {
            let residue = |mode: usize| ((1.0 + 1.7 * mode as f64) * (frf as f64 + 0.4)).sin();
            let at = |(line, omega): (usize, &f64)| {
                let s = Complex64::new(0.0, *omega);
                let modes = poles.iter().enumerate().map(|(mode, pole)| residue(mode) * pole.accelerance(s));
                let tone =
                    if tone == Some(line) { Complex64::new(0.0, 40.0 * residue(7)) } else { Complex64::ZERO };
                modes.sum::<Complex64>() + tone
            };
            values.extend(omegas.iter().enumerate().map(at));
        }
        let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
        let weights = vec![2.0 / (1e-4 * largest).powi(2); values.len()];
        (FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap(), weights)
    }

    #[test]
    fn a_mode_that_was_missed_beside_another_is_found_and_a_tone_on_one_line_is_none() {
        let pole = |hz: f64, damping_ratio: f64| Pole { omega: TAU * hz, damping_ratio };
        let [low, missed, near] = [pole(51.4, 0.007), pole(139.4, 0.0134), pole(148.2, 0.006)];
        let (frfs, weights) = eight(&[low, missed, near], None);
        let recording = WeightedFrfs { frfs: &frfs, weights: &weights };
        let alone = FreeFit::converged(recording, vec![low, near], &[], 5).unwrap();
        assert!(alone.chi2_per_dof(recording) > 100.0);
        let found = alone.with_missed(recording);
        assert_eq!(found.inside, 3);
        assert!((found.poles[1].omega / missed.omega - 1.0).abs() < 1e-4, "{:?}", found.poles);
        assert!(
            (found.poles[1].damping_ratio / missed.damping_ratio - 1.0).abs() < 1e-2,
            "{:?}",
            found.poles
        );
        for line in [20, 55, 100] {
            let (frfs, weights) = eight(&[low, near], Some(line));
            let recording = WeightedFrfs { frfs: &frfs, weights: &weights };
            let alone = FreeFit::converged(recording, vec![low, near], &[], 5).unwrap();
            assert!(alone.is_poor(recording));
            assert_eq!(alone.with_missed(recording).inside, 2, "a tone at {} Hz", frfs.lines().hz()[line]);
        }
    }
}
