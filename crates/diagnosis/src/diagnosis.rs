use crate::alternatives::{Alternative, alternatives};
use crate::estimates::estimates;
use crate::evidence::{excess, nothing_can_be_stated};
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::location::{Location, located, measured};
use crate::search::Search;
use crate::settings::Settings;
use crate::{Hypothesis, Observation};
use jointscope_findings::{Estimate, HeldOut, Verdict};
use jointscope_fixture::{Effect, Fixture};
use jointscope_frf::noise::NoiseSource;
use jointscope_spectra::{FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

/// A piece of physics that the recordings need.
#[derive(Debug, Clone, Serialize)]
pub struct Finding {
    /// Kind, place, dof and parameters.
    #[serde(flatten, serialize_with = "jointscope_findings::effect_name")]
    pub effect: Effect,
    /// Parameters with their uncertainty.
    #[serde(rename = "parameters", serialize_with = "jointscope_findings::parameters")]
    pub estimates: Vec<Estimate>,
    /// Probability of kind, place and dof together.
    pub probability: f64,
    /// Other names for it, the most probable first.
    #[serde(serialize_with = "jointscope_findings::alternatives")]
    pub alternatives: Vec<(Effect, f64)>,
    /// What χ² and priors lose without it.
    #[serde(rename = "gain_chi2")]
    pub gain: f64,
    /// Its place with one free scalar a line in its stead, beside the other findings: the measured δ(ω) that its law has to follow. `None`
    /// where its place is not of rank one.
    #[serde(skip)]
    pub measured: Option<Location>,
}

/// How one FRF disagrees with the refitted fixture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrfMismatch {
    /// The FRF.
    pub frf: FrfPair,
    /// √(Σ|H_model − H_measured|²/Σ|H_measured|²) of this FRF.
    pub nrmse: f64,
    /// Shares of this FRF's χ², ascending.
    pub bands: Vec<BandShare>,
}

/// What one band holds of an FRF's χ².
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BandShare {
    /// Lower end, Hz.
    pub from: f64,
    /// Upper end, Hz.
    pub to: f64,
    /// Share, 0 to 1.
    pub share: f64,
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
    /// How the search goes.
    pub settings: Settings,
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
        let settings = &options.settings;
        let fitter = Fitter { observation: &observation, settings };
        let division = Division::of(&observation, options)?;
        let blind = division
            .as_ref()
            .and_then(|division| Search::from_nothing(&fitter.on(&division.seen), fixture, options.exact));
        let search = match &blind {
            Some(blind) => Search::continued(&fitter, blind, fixture, options.exact),
            None => Search::from_nothing(&fitter, fixture, options.exact),
        };
        let mut search = search.ok_or(DiagnosisError::Lines(SpectraError::NoLines))?;
        let chi2_per_dof = search.refitted.chi2_per_dof(&observation);
        let mut findings = match nothing_can_be_stated(&fitter, &search.repaired, search.candidates.len()) {
            true => Vec::new(),
            false => findings(&fitter, &mut search),
        };
        let stated = |f: &Finding| f.probability + f.alternatives.iter().map(|(_, p)| p).sum::<f64>();
        if findings.is_empty() || findings.iter().any(|finding| stated(finding) < settings.evidence.stated) {
            // What the best hypotheses leave says that none of them is right: they would only adapt the model to the recording.
            findings.clear();
            search.repaired = search.refitted.clone();
        }
        let held_out = division.zip(blind).and_then(|(d, blind)| d.judge(&blind, &search, &observation));
        let chance = upper_tail(excess(chi2_per_dof, observation.degrees(), observation.noise_uncertainty()));
        let locations = match chance < settings.evidence.located {
            true => located(fitter, &search.nominal.hypothesis, &search.refitted),
            false => Vec::new(),
        };
        Ok(Diagnosis {
            verdict: verdict(&fitter, &search, &findings),
            refitted: (chi2_per_dof, chance),
            mismatch: mismatch(&observation, &search.refitted.predicted, settings.evidence.bands),
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

fn verdict(fitter: &Fitter, search: &Search, findings: &[Finding]) -> Verdict {
    let (coherence, scatter) = fitter.settings.evidence.explained;
    let from_scatter = fitter.observation.noise().contains(&NoiseSource::Scatter);
    let limit = if from_scatter { scatter } else { coherence };
    let fits = search.repaired.chi2_per_dof(fitter.observation) < limit;
    match (findings.is_empty(), fits) {
        (true, true) => Verdict::Consistent,
        (true, false) => Verdict::Unexplained,
        (false, true) => Verdict::Explained,
        (false, false) => Verdict::PartlyExplained,
    }
}

/// The hypotheses for each effect of the repaired fit. Where one is more probable than what was found, it takes its place and everything is
/// asked again: a search goes one effect at a time, and what was best alone, or in a part of the recording, need not be best in company
/// and in the whole.
fn settled(fitter: &Fitter, search: &mut Search) -> Vec<Vec<Alternative>> {
    let settings = &fitter.settings.evidence;
    // Each replacement costs the fits of all candidates for all effects.
    let mut left = settings.replacements.saturating_sub(search.repaired.hypothesis.effect_count());
    loop {
        let count = search.repaired.hypothesis.effect_count();
        let all: Vec<Vec<Alternative>> =
            (0..count).map(|index| alternatives(fitter, search, index)).collect();
        let effects = search.repaired.hypothesis.effects();
        let better = all.iter().zip(&effects).find_map(|(all, effect)| {
            let own = all.iter().find(|other| search.candidates[other.candidate].names(effect));
            let own = own.map_or(0.0, |own| own.probability);
            all.first().filter(|best| best.probability > settings.replace * own).map(|best| best.fit.clone())
        });
        match better.filter(|_| left > 0) {
            Some(fit) => {
                search.repaired = fit;
                // Beside the new effect an earlier one may no longer be needed.
                search.prune(fitter);
            }
            None => return all,
        }
        left -= 1;
    }
}

fn findings(fitter: &Fitter, search: &mut Search) -> Vec<Finding> {
    let all_names = settled(fitter, search);
    let search = &*search;
    let repaired = &search.repaired;
    let covariance = fitter.information(&repaired.hypothesis).covariance();
    let finding = |(index, effect): (usize, Effect)| {
        let own = |a: &Alternative| search.candidates[a.candidate].names(&effect);
        let without = repaired.hypothesis.without(index);
        let without = match without.effect_count() {
            0 => Some(search.refitted.clone()),
            _ => fitter.global(&without.with_tolerances_of(&search.nominal.hypothesis)),
        };
        let alternative = |a: &Alternative| Some((a.fit.hypothesis.effects().pop()?, a.probability));
        Finding {
            estimates: estimates(repaired, index, &effect, covariance.as_ref(), fitter.observation),
            probability: all_names[index].iter().find(|a| own(a)).map_or(0.0, |a| a.probability),
            alternatives: all_names[index].iter().filter(|a| !own(a)).filter_map(alternative).collect(),
            gain: without.map_or(0.0, |fit| fit.objective - repaired.objective),
            measured: measured(*fitter, repaired, index),
            effect,
        }
    };
    let mut all: Vec<Finding> = repaired.hypothesis.effects().into_iter().enumerate().map(finding).collect();
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    all
}

fn mismatch(observation: &Observation, predicted: &[Complex64], bands: usize) -> Vec<FrfMismatch> {
    let n = observation.lines().len();
    let hz = observation.lines().hz();
    let bands = bands.min(n);
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
        let band = |b: usize| BandShare {
            from: hz[edge(b)],
            to: hz[edge(b + 1) - 1],
            share: chi2(edge(b)..edge(b + 1)) / whole,
        };
        FrfMismatch { frf: pair.clone(), nrmse: (error / size).sqrt(), bands: (0..bands).map(band).collect() }
    };
    observation.pairs().iter().enumerate().map(of).collect()
}

/// Probability of a standard normal above `z`.
pub(crate) fn upper_tail(z: f64) -> f64 {
    Normal::standard().sf(z)
}
