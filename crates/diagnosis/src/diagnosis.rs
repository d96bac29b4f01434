use crate::estimates::{Estimate, estimates};
use crate::evidence::{Alternative, NAMED, alternatives, excess, is_beyond_names};
use crate::fit::Fit;
use crate::held_out::{Division, HeldOut};
use crate::location::{Location, locate, measure};
use crate::search::Search;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, Fixture};
use jointscope_frf::noise::NoiseSource;
use jointscope_spectra::{FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;

/// What a diagnosis concludes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing beyond noise and the stated tolerances.
    Consistent,
    /// The effects found explain the recordings within noise and tolerances.
    Explained,
    /// The effects found are needed, and something is left.
    PartlyExplained,
    /// A mismatch that no effect accounts for.
    Unexplained,
}

impl Verdict {
    /// The word used in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Consistent => "consistent",
            Verdict::Explained => "explained",
            Verdict::PartlyExplained => "partly_explained",
            Verdict::Unexplained => "unexplained",
        }
    }
}

/// A piece of physics that the recordings need.
#[derive(Debug, Clone)]
pub struct Finding {
    /// Kind, place, dof and parameters.
    pub effect: Effect,
    /// Parameters with their uncertainty.
    pub estimates: Vec<Estimate>,
    /// Probability of kind, place and dof together.
    pub probability: f64,
    /// Other names for it, the most probable first.
    pub alternatives: Vec<(Effect, f64)>,
    /// What χ² and priors lose without it.
    pub gain: f64,
    /// Its place with one free scalar a line in its stead, beside the other findings: the measured δ(ω) that its law has to follow. `None`
    /// where its place is not of rank one.
    pub measured: Option<Location>,
}

/// How one FRF disagrees with the refitted fixture.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfMismatch {
    /// The FRF.
    pub frf: FrfPair,
    /// √(Σ|H_model − H_measured|²/Σ|H_measured|²) of this FRF.
    pub nrmse: f64,
    /// (from, to, share of this FRF's χ²), Hz, ascending.
    pub bands: Vec<(f64, f64, f64)>,
}

/// What to leave out of a diagnosis, and what to hold out of its fits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DiagnosisOptions {
    /// The band to use, Hz; everything without.
    pub band: Option<(f64, f64)>,
    /// Bands to leave out, Hz.
    pub exclude: Vec<(f64, f64)>,
    /// FRFs to hold out; one is chosen where there are four or more and none is named.
    pub hold_out: Vec<FrfPair>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
}

/// Why a recording cannot be diagnosed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DiagnosisError {
    /// The set cannot be used.
    #[error("no usable spectral line is left: {0}")]
    Lines(#[from] SpectraError),
    /// The fixture predicts nothing finite.
    #[error("the fixture's model predicts no finite FRFs: {0}")]
    Model(#[from] crate::PredictionError),
    /// An FRF to be held out is not there, or nothing would be left.
    #[error("FRF {0} cannot be held out: the recording does not have it, or has nothing else")]
    HoldOut(String),
}

/// The whole answer.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// What it comes to.
    pub verdict: Verdict,
    /// FRFs and noise that it rests on.
    pub observation: Observation,
    /// The three models: the file's, refitted within tolerances, with the effects found.
    pub search: Search,
    /// χ² per degree of freedom of the refitted fixture, and the probability of one as large by chance.
    pub refitted: (f64, f64),
    /// Mismatch of the refitted fixture by FRF and band.
    pub mismatch: Vec<FrfMismatch>,
    /// What was found, the strongest first.
    pub findings: Vec<Finding>,
    /// What each place leaves unexplained of the refitted fixture's mismatch with one free scalar a line, the best place first. Empty where
    /// there is no mismatch.
    pub locations: Vec<Location>,
    /// The judgement on what no fit saw.
    pub held_out: Option<HeldOut>,
    /// Correlation of neighbouring lines' residuals of the repaired model: near zero if they are white.
    pub residual_correlation: f64,
}

/// χ² per degree of freedom above which a model leaves something unexplained: variances from coherence are known to a few
/// per cent, those from scatter much less.
const LEFT_OVER: f64 = 1.2;
const LEFT_OVER_SCATTER: f64 = 1.6;
/// Probability by chance below which a mismatch is located.
const BY_CHANCE: f64 = 0.01;
/// Times as probable as what was found that another name must be to take its place: two that cannot be told apart stay as they are.
const CLEARLY: f64 = 1.5;
/// Times at most that a name takes the place of one that was found, more by the number of effects.
const SETTLINGS: usize = 4;
/// Bands in which a mismatch is told.
const BANDS: usize = 12;
impl Diagnosis {
    /// Diagnoses `frfs` against `fixture`.
    ///
    /// # Errors
    /// See [`DiagnosisError`].
    pub fn of(fixture: &Fixture, frfs: &FrfSet, options: &DiagnosisOptions) -> Result<Self, DiagnosisError> {
        let in_use = |hz: f64| {
            options.band.is_none_or(|(from, to)| hz >= from && hz <= to)
                && !options.exclude.iter().any(|(from, to)| hz >= *from && hz <= *to)
        };
        let observation = Observation::new(frfs, in_use)?;
        Hypothesis::nominal(fixture, options.exact).predict(&observation)?;
        // What is to be judged on unseen lines must not have chosen the names either: the search that sees less goes first, and the whole
        // recording only has to confirm or correct it.
        let division = Division::of(&observation, options)?;
        let blind = division.as_ref().and_then(|d| Search::of(fixture, &d.seen, options.exact));
        let search = match &blind {
            Some(blind) => Search::continued(blind, fixture, &observation, options.exact),
            None => Search::of(fixture, &observation, options.exact),
        };
        let mut search = search.ok_or(DiagnosisError::Lines(SpectraError::NoLines))?;
        let chi2_per_dof = search.refitted.chi2_per_dof(&observation);
        let mut findings = match is_beyond_names(&search, &observation) {
            true => Vec::new(),
            false => findings(&mut search, &observation),
        };
        let named = |f: &Finding| f.probability + f.alternatives.iter().map(|(_, p)| p).sum::<f64>();
        if findings.is_empty() || findings.iter().any(|finding| named(finding) < NAMED) {
            // What the best names leave says that none of them is right: they would only bend the model to the recording.
            findings.clear();
            search.repaired = search.refitted.clone();
        }
        let held_out = division.zip(blind).and_then(|(d, blind)| d.judge(&blind, &search, &observation));
        let chance = upper_tail(excess(chi2_per_dof, observation.degrees(), observation.noise_uncertainty()));
        let locations = match chance < BY_CHANCE {
            true => locate(&search.nominal.hypothesis, &search.refitted, &observation),
            false => Vec::new(),
        };
        Ok(Diagnosis {
            verdict: verdict(&search, &observation, &findings),
            refitted: (chi2_per_dof, chance),
            mismatch: mismatch(&observation, &search.refitted.predicted),
            residual_correlation: observation.residual_correlation(&search.repaired.predicted),
            findings,
            locations,
            held_out,
            search,
            observation,
        })
    }

    /// (nominal, refitted, repaired) errors over all FRFs and lines in use.
    pub fn nrmse(&self) -> [f64; 3] {
        [&self.search.nominal, &self.search.refitted, &self.search.repaired]
            .map(|fit| self.observation.nrmse(&fit.predicted))
    }

    /// (nominal, refitted, repaired) χ² per degree of freedom.
    pub fn chi2_per_dof(&self) -> [f64; 3] {
        [&self.search.nominal, &self.search.refitted, &self.search.repaired]
            .map(|fit| fit.chi2_per_dof(&self.observation))
    }
}

fn verdict(search: &Search, observation: &Observation, findings: &[Finding]) -> Verdict {
    let scatter = observation.noise().contains(&NoiseSource::Scatter);
    let limit = if scatter { LEFT_OVER_SCATTER } else { LEFT_OVER };
    let fits = search.repaired.chi2_per_dof(observation) < limit;
    match (findings.is_empty(), fits) {
        (true, true) => Verdict::Consistent,
        (true, false) => Verdict::Unexplained,
        (false, true) => Verdict::Explained,
        (false, false) => Verdict::PartlyExplained,
    }
}

/// The names for each effect of the repaired fit. Where one is more probable than what was found, it takes its place and everything is asked
/// again: a search goes one effect at a time, and a name that was best alone, or in a part of the recording, need not be best in company
/// and in the whole.
fn settled(search: &mut Search, observation: &Observation) -> Vec<Vec<Alternative>> {
    // Each time costs the names of all effects.
    let mut left = SETTLINGS.saturating_sub(search.repaired.hypothesis.effect_count());
    loop {
        let count = search.repaired.hypothesis.effect_count();
        let names: Vec<Vec<Alternative>> =
            (0..count).map(|index| alternatives(search, index, observation)).collect();
        let effects = search.repaired.hypothesis.effects();
        let better = names.iter().zip(&effects).find_map(|(names, effect)| {
            let own = names.iter().find(|name| search.candidates[name.candidate].names(effect));
            let own = own.map_or(0.0, |own| own.probability);
            names.first().filter(|best| best.probability > CLEARLY * own).map(|best| best.fit.clone())
        });
        match better.filter(|_| left > 0) {
            Some(fit) => {
                search.repaired = fit;
                // Beside the new name an earlier one may no longer be needed.
                search.prune(observation);
            }
            None => return names,
        }
        left -= 1;
    }
}

fn findings(search: &mut Search, observation: &Observation) -> Vec<Finding> {
    let all_names = settled(search, observation);
    let search = &*search;
    let repaired = &search.repaired;
    let effects = repaired.hypothesis.effects();
    let covariance = repaired.covariance(observation);
    let mut all: Vec<Finding> = effects
        .iter()
        .enumerate()
        .map(|(index, effect)| {
            let names = &all_names[index];
            let own = |a: &Alternative| search.candidates[a.candidate].names(effect);
            let without = repaired.hypothesis.without(index);
            let without = match without.effect_count() {
                0 => Some(search.refitted.clone()),
                _ => Fit::of(&without.with_tolerances_of(&search.nominal.hypothesis), observation, true),
            };
            let named = |a: &Alternative| {
                let effects = a.fit.hypothesis.effects();
                effects.last().map(|effect| (effect.clone(), a.probability))
            };
            Finding {
                effect: effect.clone(),
                estimates: estimates(
                    &repaired.hypothesis,
                    index,
                    effect,
                    covariance.as_deref(),
                    repaired,
                    observation,
                ),
                probability: names.iter().find(|a| own(a)).map_or(0.0, |a| a.probability),
                alternatives: names.iter().filter(|a| !own(a)).filter_map(named).collect(),
                gain: without.map_or(0.0, |fit| fit.objective - repaired.objective),
                measured: measure(repaired, index, observation),
            }
        })
        .collect();
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    all
}

fn mismatch(observation: &Observation, predicted: &[Complex64]) -> Vec<FrfMismatch> {
    let n = observation.lines().len();
    let hz = observation.lines().hz();
    let bands = BANDS.min(n);
    let edge = |band: usize| band * n / bands;
    let of = |(index, pair): (usize, &FrfPair)| {
        let at = |line: usize| index * n + line;
        let residual = |line: usize| (observation.values()[at(line)] - predicted[at(line)]).norm_sqr();
        let error: f64 = (0..n).map(residual).sum();
        let size: f64 = (0..n).map(|line| observation.values()[at(line)].norm_sqr()).sum();
        let chi2 = |range: std::ops::Range<usize>| {
            range.map(|l| observation.weights()[at(l)] * residual(l)).sum::<f64>()
        };
        let whole = chi2(0..n).max(f64::MIN_POSITIVE);
        let band = |b: usize| (hz[edge(b)], hz[edge(b + 1) - 1], chi2(edge(b)..edge(b + 1)) / whole);
        FrfMismatch { frf: pair.clone(), nrmse: (error / size).sqrt(), bands: (0..bands).map(band).collect() }
    };
    observation.pairs().iter().enumerate().map(of).collect()
}

/// Probability of a standard normal above `z` (Abramowitz and Stegun 26.2.17, absolute error below 1e-7).
pub(crate) fn upper_tail(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * z.abs());
    let series = t
        * (0.319_381_530
            + t * (-0.356_563_782 + t * (1.781_477_937 + t * (-1.821_255_978 + t * 1.330_274_429))));
    let tail = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt() * series;
    if z >= 0.0 { tail } else { 1.0 - tail }
}
