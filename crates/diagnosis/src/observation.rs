//! What a diagnosis rests on: FRFs with the weight of each value, the lines in use, the work done so far.

use crate::recorded_lines::{drift_variance, lines_in_use};
use crate::settings::lines::noise::{COHERENCE_UNCERTAINTY, LEVEL_SHARE, LEVEL_WINDOW, SCATTER_UNCERTAINTY};
use crate::work::Work;
use jointscope_frf::Drift;
use jointscope_frf::noise::{NoiseSource, known};
use jointscope_inference::{autocorrelation, inflated_weight};
use jointscope_model_error::WeightedFrfs;
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectraError, SpectralLines};
use num_complex::Complex64;
use std::borrow::Cow;
use std::sync::Arc;

/// FRFs as a fit sees them: accelerances on the lines in use, each with its weight.
#[derive(Debug, Clone)]
pub struct Observation {
    frfs: FrfSet,
    /// 2/σ² by value: each part of a complex value has half of its variance.
    weight: Vec<f64>,
    /// Mean |H|² around each line, by value: the floor of what a softened fit tolerates.
    level: Vec<f64>,
    noise: Vec<NoiseSource>,
    /// γ² as recorded, by FRF.
    coherence: Vec<Option<Vec<f64>>>,
    recorded_lines: usize,
    drift: Option<Drift>,
    work: Arc<Work>,
}

impl Observation {
    /// Takes a recording on the lines for which `in_use` holds (Hz). Variances that the set carries are kept;
    /// without them they are estimated from coherence or scatter.
    ///
    /// The noise is estimated on all lines before any are left out. Lines at 0 Hz are never used, and neither
    /// are single values that were not measured. Of thousands of lines those are used that hold what there is to
    /// be told, those about resonances above all. Where the noise had to be estimated from scatter, and
    /// resonances differ among FRFs of one response by more than it, that drift counts as noise too.
    ///
    /// # Errors
    /// No line left.
    pub fn new(frfs: &FrfSet, in_use: impl Fn(f64) -> bool + Copy) -> Result<Self, SpectraError> {
        let (with_noise, noise) = known(frfs)?;
        let hz = frfs.lines().hz().to_vec();
        let kept = with_noise.on_lines(|i| hz[i] > 0.0 && in_use(hz[i])).ok_or(SpectraError::NoLines)?;
        let frfs = kept.to_form(FrfForm::Accelerance)?;
        let n = frfs.lines().len();
        let mut weight = Vec::with_capacity(n * frfs.pairs().len());
        let mut level = Vec::with_capacity(weight.capacity());
        for index in 0..frfs.pairs().len() {
            let values = frfs.values(index);
            let variance = frfs.variance(index).unwrap_or(&[]);
            for line in 0..n {
                let variance = variance.get(line).copied().unwrap_or(0.0);
                let told = frfs.is_measured(index, line) && variance > 0.0;
                weight.push(if told { 2.0 / variance } else { 0.0 });
                let near = line.saturating_sub(LEVEL_WINDOW)..(line + LEVEL_WINDOW + 1).min(n);
                let count = near.len() as f64;
                level.push(values[near].iter().map(|v| v.norm_sqr()).sum::<f64>() / count);
            }
        }
        let from_scatter = !noise.is_empty() && noise.iter().all(|source| source.is_by_scatter());
        let drift = if from_scatter { Drift::of(&frfs) } else { None };
        let coherence = (0..frfs.pairs().len()).map(|index| frfs.coherence(index).map(<[f64]>::to_vec));
        let coherence = coherence.collect();
        let work = Arc::default();
        let whole = Observation { frfs, weight, level, noise, coherence, recorded_lines: n, drift, work };
        let kept = lines_in_use(&whole.frfs);
        let mut used = whole.on(&kept, &vec![true; whole.pairs().len()]).ok_or(SpectraError::NoLines)?;
        used.allow_for_drift(&whole.frfs, &kept);
        Ok(used)
    }

    /// Adds what drift makes of the FRFs to the variances; `whole` has all lines, of which these are the
    /// `kept` ones.
    fn allow_for_drift(&mut self, whole: &FrfSet, kept: &[bool]) {
        let Some(drift) = self.drift.clone() else { return };
        let wanted: Vec<usize> = (0..kept.len()).filter(|&line| kept[line]).collect();
        let hz = self.lines().hz().to_vec();
        for (index, weight) in self.weight.chunks_exact_mut(hz.len()).enumerate() {
            let change = drift.squared_change(whole.lines().hz(), whole.values(index), &wanted);
            let variance: Vec<f64> = weight.iter().map(|w| if *w > 0.0 { 2.0 / w } else { 0.0 }).collect();
            let added = drift_variance(&drift, &hz, &variance, &change);
            for ((weight, variance), added) in weight.iter_mut().zip(&variance).zip(&added) {
                if *variance > 0.0 {
                    *weight = 2.0 / (variance + added);
                }
            }
        }
    }

    /// Number of lines of the recording within the band in use, before thinning.
    pub fn recorded_lines(&self) -> usize {
        self.recorded_lines
    }

    /// How far the resonances moved from FRF to FRF, where that is beyond their noise and counts as noise
    /// itself.
    pub fn drift(&self) -> Option<&Drift> {
        self.drift.as_ref()
    }

    /// The observation on fewer lines and FRFs, its noise as it was; `None` where nothing is left.
    pub fn reduced(&self, line: impl Fn(f64) -> bool, frf: impl Fn(&FrfPair) -> bool) -> Option<Self> {
        let lines: Vec<bool> = self.lines().hz().iter().map(|&hz| line(hz)).collect();
        let frfs: Vec<bool> = self.pairs().iter().map(frf).collect();
        self.on(&lines, &frfs)
    }

    fn on(&self, lines: &[bool], frfs: &[bool]) -> Option<Self> {
        let n = self.lines().len();
        let hz = self.lines().hz();
        let kept_frfs: Vec<usize> = (0..frfs.len()).filter(|&i| frfs[i]).collect();
        let kept_lines: Vec<usize> = (0..n).filter(|&i| lines[i]).collect();
        let places = || kept_frfs.iter().flat_map(|&i| kept_lines.iter().map(move |&l| i * n + l));
        let lines = SpectralLines::new(kept_lines.iter().map(|&l| hz[l]).collect()).ok()?;
        let pairs: Vec<FrfPair> = kept_frfs.iter().map(|&i| self.pairs()[i].clone()).collect();
        let values = places().map(|at| self.values()[at]).collect();
        let mut frfs = FrfSet::new(lines, FrfForm::Accelerance, pairs, values).ok()?;
        kept_frfs.iter().enumerate().for_each(|(own, &i)| frfs.set_averages(own, self.frfs.averages(i)));
        (!kept_frfs.is_empty()).then(|| Observation {
            frfs,
            weight: places().map(|at| self.weight[at]).collect(),
            level: places().map(|at| self.level[at]).collect(),
            noise: kept_frfs.iter().filter_map(|&i| self.noise.get(i).copied()).collect(),
            coherence: kept_frfs
                .iter()
                .map(|&i| self.coherence[i].as_ref().map(|all| kept_lines.iter().map(|&l| all[l]).collect()))
                .collect(),
            recorded_lines: self.recorded_lines,
            drift: self.drift.clone(),
            work: Arc::clone(&self.work),
        })
    }

    /// The observation on at most `limit` lines, evenly thinned: enough for a softened fit, which follows the
    /// FRFs' course and leaves their peaks alone.
    pub fn thinned(&self, limit: usize) -> Self {
        let n = self.lines().len();
        let every = n.div_ceil(limit.max(1)).max(1);
        let keep: Vec<bool> = (0..n).map(|line| line % every == 0).collect();
        self.on(&keep, &vec![true; self.pairs().len()]).unwrap_or_else(|| self.clone())
    }

    /// The observation of FRFs that are this one's values divided by `kept`, each known as well as before.
    pub(crate) fn divided_by(&self, kept: &[f64]) -> Option<Self> {
        let values = self.values().iter().zip(kept).map(|(value, kept)| value / kept).collect();
        self.with_values(values, |at| kept[at], 2)
    }

    /// The observation of FRFs that are so many `factors` times this one's values, each relatively known as well
    /// as before.
    pub(crate) fn times(&self, factors: &[Complex64]) -> Option<Self> {
        let values = self.values().iter().zip(factors).map(|(value, factor)| value * factor).collect();
        self.with_values(values, |at| factors[at].norm(), -2)
    }

    /// The observation of FRFs that are this one's values and what these lack, as well known as before.
    pub(crate) fn plus(&self, missing: &[Complex64]) -> Option<Self> {
        let values = self.values().iter().zip(missing).map(|(value, missing)| value + missing).collect();
        self.with_values(values, |_| 1.0, 0)
    }

    /// The same with so much more variance of each value.
    pub(crate) fn with_variance_added(&self, variances: &[f64]) -> Self {
        let weight = self.weight.iter().zip(variances);
        // Lines that count for nothing stay so.
        let weight = weight.map(|(weight, added)| weight / (1.0 + 0.5 * weight * added)).collect();
        Observation { weight, ..self.clone() }
    }

    /// The same with other values, whose weights are this one's times a power of a size, and whose levels are
    /// divided by it.
    fn with_values(&self, values: Vec<Complex64>, size: impl Fn(usize) -> f64, power: i32) -> Option<Self> {
        let mut frfs =
            FrfSet::new(self.lines().clone(), FrfForm::Accelerance, self.pairs().to_vec(), values).ok()?;
        (0..self.pairs().len()).for_each(|index| frfs.set_averages(index, self.frfs.averages(index)));
        let scaled = |all: &[f64], power: i32| {
            all.iter().enumerate().map(|(at, value)| value * size(at).powi(power)).collect()
        };
        let (weight, level) = (scaled(&self.weight, power), scaled(&self.level, -power));
        Some(Observation { frfs, weight, level, ..self.clone() })
    }

    /// The same observation with so many times the variance of its noise.
    pub(crate) fn with_variance_times(&self, factor: f64) -> Self {
        let weight = self.weight.iter().map(|weight| weight / factor).collect();
        Observation { weight, ..self.clone() }
    }

    /// Root mean square of the noise over that of the FRFs.
    pub(crate) fn relative_noise(&self) -> f64 {
        let counted = self.weight.iter().zip(self.values()).filter(|(weight, _)| **weight > 0.0);
        let sum = |sum: (f64, f64), (weight, value): (&f64, &Complex64)| {
            (sum.0 + 2.0 / weight, sum.1 + value.norm_sqr())
        };
        let (noise, signal) = counted.fold((0.0, 0.0), sum);
        if signal > 0.0 { (noise / signal).sqrt() } else { f64::INFINITY }
    }

    /// The FRFs in use with their weights, as their modes are taken.
    pub(crate) fn weighted(&self) -> WeightedFrfs<'_> {
        WeightedFrfs { frfs: &self.frfs, weights: &self.weight }
    }

    /// The FRFs in use, accelerances.
    pub fn frfs(&self) -> &FrfSet {
        &self.frfs
    }

    /// The spectral lines in use.
    pub fn lines(&self) -> &SpectralLines {
        self.frfs.lines()
    }

    /// The FRFs' channels.
    pub fn pairs(&self) -> &[FrfPair] {
        self.frfs.pairs()
    }

    /// Where each FRF's noise came from; empty where the set carried its variances.
    pub fn noise(&self) -> &[NoiseSource] {
        &self.noise
    }

    /// γ² of FRF `index` on the lines in use, where it was recorded.
    pub fn coherence(&self, index: usize) -> Option<&[f64]> {
        self.coherence[index].as_deref()
    }

    /// The same, its predictions counted as `work`.
    pub(crate) fn counted(self, work: Arc<Work>) -> Self {
        Observation { work, ..self }
    }

    /// Work done on it and its parts.
    pub(crate) fn work(&self) -> &Work {
        &self.work
    }

    /// Whether some FRF's noise is told by nothing but the scatter of its lines.
    pub(crate) fn has_scatter_for_noise(&self) -> bool {
        self.noise.iter().any(|source| source.is_by_scatter())
    }

    /// Measured values, FRF after FRF.
    pub fn values(&self) -> &[Complex64] {
        self.frfs.all_values()
    }

    /// 2/σ² by value.
    pub fn weights(&self) -> &[f64] {
        &self.weight
    }

    /// Number of real values that count.
    pub fn degrees(&self) -> usize {
        2 * self.weight.iter().filter(|w| **w > 0.0).count()
    }

    /// Standard deviations by which χ² per degree of freedom of these FRFs exceeds one, the relative
    /// uncertainty of the noise's variances included.
    pub fn excess(&self, chi2_per_dof: f64) -> f64 {
        excess(chi2_per_dof, self.degrees(), self.noise_uncertainty())
    }

    /// The weight of value `index` when a share `epsilon` of the measured, the modelled and some of the local
    /// level counts as noise too: sharp peaks then do not decide where a fit goes.
    pub(crate) fn inflated(&self, index: usize, modelled: Complex64, epsilon: f64) -> f64 {
        let size = self.values()[index].norm_sqr() + modelled.norm_sqr() + LEVEL_SHARE * self.level[index];
        inflated_weight(self.weight[index], size, epsilon)
    }

    /// [`Observation::inflated`] of every value.
    pub(crate) fn inflated_weights(&self, modelled: &[Complex64], epsilon: f64) -> Cow<'_, [f64]> {
        if epsilon == 0.0 {
            return Cow::Borrowed(&self.weight);
        }
        modelled.iter().enumerate().map(|(index, value)| self.inflated(index, *value, epsilon)).collect()
    }

    /// Measured less modelled values.
    pub(crate) fn residual(&self, modelled: &[Complex64]) -> Vec<Complex64> {
        self.values().iter().zip(modelled).map(|(measured, modelled)| measured - modelled).collect()
    }

    /// Σ weight·|measured − modelled|².
    pub(crate) fn weighted_squares(&self, modelled: &[Complex64], weights: &[f64]) -> f64 {
        let terms = self.values().iter().zip(modelled).zip(weights);
        terms.map(|((measured, modelled), weight)| weight * (measured - modelled).norm_sqr()).sum()
    }

    /// χ² of modelled values.
    pub fn chi2(&self, modelled: &[Complex64]) -> f64 {
        self.weighted_squares(modelled, &self.weight)
    }

    /// χ² of modelled values on the lines from a frequency on, Hz, and the number of real values that count
    /// there.
    pub(crate) fn chi2_from(&self, modelled: &[Complex64], from: f64) -> (f64, usize) {
        let values = self.counted_where(|hz| hz >= from);
        let square = |index: usize| self.weight[index] * (self.values()[index] - modelled[index]).norm_sqr();
        values.fold((0.0, 0), |(chi2, count), index| (chi2 + square(index), count + 2))
    }

    /// Mean square by which modelled values miss the lines below a frequency, Hz, in units of noise and of an
    /// `error` of the larger of both values; zero where there are none.
    pub(crate) fn misses_below(&self, modelled: &[Complex64], below: f64, error: f64) -> f64 {
        let values = self.counted_where(|hz| hz < below);
        let square = |index: usize| {
            let (measured, modelled) = (self.values()[index], modelled[index]);
            let largest = measured.norm_sqr().max(modelled.norm_sqr());
            (measured - modelled).norm_sqr() / (2.0 / self.weight[index] + error * error * largest)
        };
        let (sum, count) = values.fold((0.0, 0), |(sum, count), index| (sum + square(index), count + 1));
        if count == 0 { 0.0 } else { sum / count as f64 }
    }

    /// The values that count on such lines, Hz, by their places.
    fn counted_where(&self, line: impl Fn(f64) -> bool) -> impl Iterator<Item = usize> {
        let hz = self.lines().hz();
        (0..self.weight.len()).filter(move |index| line(hz[index % hz.len()]) && self.weight[*index] > 0.0)
    }

    /// √(Σ|H_model − H_measured|² / Σ|H_measured|²) over all FRFs and lines.
    pub fn nrmse(&self, modelled: &[Complex64]) -> f64 {
        self.nrmse_of(modelled, 0..self.weight.len())
    }

    /// The same over the values at such places, FRF after FRF, that were measured; nothing where none was.
    pub(crate) fn nrmse_of(&self, modelled: &[Complex64], places: impl Iterator<Item = usize>) -> f64 {
        let (mut error, mut size) = (0.0, 0.0);
        for at in places.filter(|at| self.weight[*at] > 0.0) {
            error += (self.values()[at] - modelled[at]).norm_sqr();
            size += self.values()[at].norm_sqr();
        }
        if size > 0.0 { (error / size).sqrt() } else { 0.0 }
    }

    /// Relative uncertainty of the noise's variances: those from coherence are smoothed over lines, those
    /// from scatter rest on the lines nearby alone.
    pub(crate) fn noise_uncertainty(&self) -> f64 {
        if self.has_scatter_for_noise() { SCATTER_UNCERTAINTY } else { COHERENCE_UNCERTAINTY }
    }

    /// Correlation of the normalised residuals of neighbouring lines.
    pub fn residual_correlation(&self, predicted: &[Complex64]) -> f64 {
        let residual = self.residual(predicted).into_iter().zip(self.weights());
        let normalised: Vec<Complex64> = residual.map(|(r, weight)| r * weight.sqrt()).collect();
        autocorrelation(&normalised, self.lines().len())
    }
}

/// Standard deviations by which χ² per degree of freedom exceeds one, the relative uncertainty of the noise's
/// variances included.
pub(crate) fn excess(chi2_per_dof: f64, degrees: usize, noise_uncertainty: f64) -> f64 {
    (chi2_per_dof - 1.0) / (2.0 / degrees.max(1) as f64).sqrt().hypot(noise_uncertainty)
}
