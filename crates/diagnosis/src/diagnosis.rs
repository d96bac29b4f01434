use crate::contradiction::contradictory;
use crate::departures::{Departure, departures, has_departed};
use crate::drift::{Drifted, TestDrift};
use crate::fitter::Fitter;
use crate::location::Location;
use crate::modal::ModelError;
use crate::routes;
use crate::search::Search;
use crate::settings::Settings;
use crate::work::Work;
use crate::{Baseline, Hypothesis, Observation, Watch};
use jointscope_findings::{Estimate, HeldOut, Verdict};
use jointscope_fixture::{Effect, Fixture};
use jointscope_lumped::Assembly;
use jointscope_spectra::{FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};
use std::sync::Arc;
use std::time::Duration;

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
    /// FRFs of the same structure as it was known to be right: what is diagnosed is what has changed since.
    pub baseline: Option<FrfSet>,
    /// How long a search may take; what it has then is the answer. Without, its limit of work is all that ends it ([`Settings::work`]).
    pub time_limit: Option<Duration>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
    /// Whether the FRFs were estimated from hits: they carry leakage and errors that neighbouring lines share, and no name may live on those.
    pub estimated: bool,
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
    /// The baseline and the recording have no modes in common.
    #[error("baseline and recording have no FRFs or no modes in common")]
    Baseline,
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
    /// The refitted and the repaired model where quantities are as probable as can be: what is said of them. By modes the models of [`Diagnosis::search`], which are to predict, follow the
    /// recording more closely than that.
    pub stated: [Hypothesis; 2],
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
    /// Error of the refitted and of the repaired model, where it is larger than the noise and decides; `None` where the noise does.
    pub model_error: Option<[ModelError; 2]>,
    /// Error of the model on the baseline, where there was one; then [`Diagnosis::model_error`] is of the change since.
    pub baseline_error: Option<ModelError>,
    /// The state that a change is told from, where there was a baseline.
    pub baseline: Option<Baseline>,
    /// Quantities that had to leave their stated values by more than chance makes, the farthest first.
    pub departures: Vec<Departure>,
    /// What the search did not come to within its limit of work or time.
    pub stopped: Vec<&'static str>,
    /// Bands, Hz, of lines that contradict all others whatever the structure, and were left out.
    pub contradictory: Vec<(f64, f64)>,
    /// How the structure changed from reference to reference, where it did: the diagnosis is of the references that agree.
    pub drift: Option<TestDrift>,
    /// Effects that were tried by themselves where the model's error decides, the most probable first.
    pub tried: Vec<Tried>,
}

/// An effect that was tried by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Kind, place, dof and parameters.
    #[serde(flatten, serialize_with = "jointscope_findings::effect_name")]
    pub effect: Effect,
    /// What it gains in ln p over the fixture without it.
    pub ln_gain: f64,
}

impl Diagnosis {
    /// Diagnoses `frfs` against `fixture`.
    ///
    /// # Errors
    /// See [`DiagnosisError`].
    pub fn of(fixture: &Fixture, frfs: &FrfSet, options: &DiagnosisOptions) -> Result<Self, DiagnosisError> {
        Self::watched(fixture, frfs, options, Watch::default())
    }

    /// As [`Diagnosis::of`], telling what it is doing.
    ///
    /// # Errors
    /// See [`DiagnosisError`].
    pub fn watched(
        fixture: &Fixture,
        frfs: &FrfSet,
        options: &DiagnosisOptions,
        watch: Watch,
    ) -> Result<Self, DiagnosisError> {
        let asked = |hz: f64| {
            options.band.is_none_or(|(from, to)| hz >= from && hz <= to)
                && !options.exclude.iter().any(|(from, to)| hz >= *from && hz <= *to)
        };
        let highest = frfs.lines().hz().last().copied().unwrap_or_default();
        let coordinates = Assembly::new(fixture, highest).map_or(0, |assembly| assembly.order());
        let work = Work::of(options.settings.work, options.time_limit).for_models_of(coordinates);
        let work = Arc::new(work);
        let observation = Observation::new(frfs, asked)?.counted(Arc::clone(&work));
        let nominal = Hypothesis::nominal(fixture, options.exact);
        nominal.predict(&observation)?;
        let contradictory = contradictory(&observation, &nominal);
        let in_use = |hz: f64| asked(hz) && !contradictory.iter().any(|(from, to)| hz >= *from && hz <= *to);
        let observation = match contradictory.is_empty() {
            true => observation,
            false => Observation::new(frfs, in_use)?.counted(work),
        };
        let drifted = Drifted::of(&observation, &nominal, &options.settings.modal);
        let agreeing = |pair: &FrfPair| drifted.as_ref().is_none_or(|drifted| drifted.keeps(&pair.reference));
        let observation = match drifted {
            Some(_) => observation.reduced(|_| true, agreeing).unwrap_or(observation),
            None => observation,
        };
        let hold_out: Vec<FrfPair> = options.hold_out.iter().filter(|pair| agreeing(pair)).cloned().collect();
        let options = &DiagnosisOptions { hold_out, ..options.clone() };
        let few = observation.searched(&options.hold_out);
        let searched = few.as_ref().unwrap_or(&observation);
        let fitter = Fitter { observation: searched, settings: &options.settings, watch };
        let mut parts = match &options.baseline {
            Some(baseline) => {
                let baseline = Observation::new(baseline, in_use)?;
                let baseline = baseline.reduced(|_| true, agreeing).unwrap_or(baseline);
                if baseline.pairs() != observation.pairs() {
                    return Err(DiagnosisError::Baseline);
                }
                let pairs = searched.pairs();
                let part = baseline.reduced(|_| true, |pair| pairs.contains(pair));
                routes::since(&fitter, part.unwrap_or(baseline), fixture, options.exact)?
            }
            None => routes::judged(&fitter, fixture, options)?,
        };
        if few.is_some() {
            parts = parts.on_all(&fitter.on(&observation));
        }
        let diagnosis = Diagnosis { contradictory, ..parts.with(observation, &options.settings) };
        let within_estimates = options.estimated
            && diagnosis.refitted.0 < options.settings.evidence.explained.0
            && !has_departed(&diagnosis.stated[0]);
        let diagnosis = if within_estimates { diagnosis.without_findings() } else { diagnosis };
        Ok(Diagnosis { drift: drifted.and_then(|drifted| diagnosis.told_drift(&drifted)), ..diagnosis })
    }

    /// What drifted, by the model that the diagnosis ends with.
    fn told_drift(&self, drifted: &Drifted) -> Option<TestDrift> {
        let model = self.search.repaired.hypothesis.to_fixture();
        let explains =
            self.model_error.is_none() && matches!(self.verdict, Verdict::Consistent | Verdict::Explained);
        Some(drifted.attributed(&model.ok()?, explains))
    }

    /// The same where the fixture as refitted explains all that there is to explain.
    fn without_findings(mut self) -> Self {
        self.search.repaired = self.search.refitted.clone();
        self.verdict = Verdict::Consistent;
        self.residual_correlation = self.observation.residual_correlation(&self.search.repaired.predicted);
        self.stated[1] = self.stated[0].clone();
        self.departures = departures(&self.stated);
        (self.findings, self.locations, self.tried) = (Vec::new(), Vec::new(), Vec::new());
        (self.held_out, self.model_error) = (None, None);
        self
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

/// Mismatch of a prediction by FRF and band.
pub(crate) fn mismatch(observation: &Observation, predicted: &[Complex64], bands: usize) -> Vec<FrfMismatch> {
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
