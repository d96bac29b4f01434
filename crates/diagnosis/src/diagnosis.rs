use crate::alternatives::{Alternative, alternatives};
use crate::catalogue::catalogue;
use crate::estimates::estimates;
use crate::evidence::{excess, nothing_can_be_stated};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::location::{Location, located, measured};
use crate::modal::{Departure, ModalJudgement, ModelError, explains};
use crate::search::Search;
use crate::settings::Settings;
use crate::{Baseline, Hypothesis, Observation, Tolerance, Watch};
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
    /// FRFs of the same structure as it was known to be right: what is diagnosed is what has changed since.
    pub baseline: Option<FrfSet>,
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

/// Standard deviations beyond which a quantity has departed by more than chance.
const DEPARTED: f64 = 4.0;

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
        let in_use = |hz: f64| {
            options.band.is_none_or(|(from, to)| hz >= from && hz <= to)
                && !options.exclude.iter().any(|(from, to)| hz >= *from && hz <= *to)
        };
        let observation = Observation::new(frfs, in_use)?;
        Hypothesis::nominal(fixture, options.exact).predict(&observation)?;
        let fitter = Fitter { observation: &observation, settings: &options.settings, watch };
        if let Some(baseline) = &options.baseline {
            let baseline = Observation::new(baseline, in_use)?;
            if baseline.pairs() != observation.pairs() {
                return Err(DiagnosisError::Baseline);
            }
            return Ok(since(&fitter, baseline, fixture, options.exact)?.with(observation));
        }
        let division = Division::of(&observation, options)?;
        let within = Search::without_effects(&fitter, fixture, options.exact)
            .ok_or(DiagnosisError::Lines(SpectraError::NoLines))?;
        // Where the fixture as refitted leaves more than noise, the comparison by modes says whether the model itself is in error: if it is, the noise
        // of the lines decides nothing.
        let modal = match within.lacks_much(&fitter, &within.refitted) {
            true => ModalJudgement::of(&fitter, &within.nominal.hypothesis, &within.candidates, None),
            false => None,
        };
        let Some(modal) = modal.filter(|modal| !modal.needs_nothing()) else {
            return Ok(by_lines(&fitter, within, (fixture, options.exact), None, division)?.with(observation));
        };
        // What explains the lines down to their noise without any error of the model needs none: found among the modes, or, where these are
        // dubious, by a search on lines.
        let exact = modal.exact(&fitter).or_else(|| {
            let search = modal.is_dubious(&fitter).then(|| Search::searched(&fitter, within.clone()));
            search.map(|search| search.repaired).filter(|fit| explains(&fitter, fit, true))
        });
        let parts = match exact {
            Some(exact) => {
                let seed = Some((&modal, exact));
                by_lines(&fitter, within, (fixture, options.exact), seed, division)?
            }
            // Modes that need no error of the model, or that do not tell all there is, beside lines that are not explained: it is not the modes of the model
            // that are in error.
            None if modal.search.best.exact || modal.has_right_modes() || modal.tells_little(&fitter) => {
                by_lines(&fitter, within, (fixture, options.exact), None, division)?
            }
            None => by_modes(&fitter, within, &modal, division.as_ref()),
        };
        Ok(parts.with(observation))
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

/// A diagnosis but for the observation that it rests on.
struct Parts {
    verdict: Verdict,
    search: Search,
    refitted: (f64, f64),
    mismatch: Vec<FrfMismatch>,
    findings: Vec<Finding>,
    locations: Vec<Location>,
    held_out: Option<HeldOut>,
    residual_correlation: f64,
    model_error: Option<[ModelError; 2]>,
    baseline_error: Option<ModelError>,
    baseline: Option<Baseline>,
    tried: Vec<Tried>,
}

impl Parts {
    fn with(self, observation: Observation) -> Diagnosis {
        let Parts { verdict, search, refitted, mismatch, findings, locations, held_out, .. } = self;
        let departures = departures(&search);
        Diagnosis {
            verdict,
            observation,
            search,
            refitted,
            mismatch,
            findings,
            locations,
            held_out,
            residual_correlation: self.residual_correlation,
            model_error: self.model_error,
            baseline_error: self.baseline_error,
            baseline: self.baseline,
            departures,
            tried: self.tried,
        }
    }
}

/// The diagnosis where the noise of the lines decides; what was found among the modes is where it sets out.
fn by_lines(
    fitter: &Fitter,
    within: Search,
    (fixture, exact): (&Fixture, bool),
    seed: Option<(&ModalJudgement, Fit)>,
    division: Option<Division>,
) -> Result<Parts, DiagnosisError> {
    let Fitter { observation, settings, .. } = *fitter;
    // What is to be judged on unseen lines must not have chosen the names either: the search that sees less goes first, and the whole
    // recording only has to confirm or correct it.
    let blind = division.as_ref().and_then(|division| {
        fitter.watch.stage("searching without the lines that are held out");
        let fitter = fitter.on(&division.seen);
        let start = Search::without_effects(&fitter, fixture, exact)?;
        let known = seed.as_ref().map(|(modal, _)| modal.known(settings.modal.blind));
        let modal = known.and_then(|known| {
            ModalJudgement::of(&fitter, &start.nominal.hypothesis, &start.candidates, Some(&known))
        });
        let exact = modal.as_ref().and_then(|modal| modal.exact(&fitter));
        Some(match modal.zip(exact) {
            Some((modal, exact)) => {
                let part = Search { repaired: exact, ..modal.search_on(&division.seen, &start) };
                Search::continued(&fitter, start, &part)
            }
            None => Search::searched(&fitter, start),
        })
    });
    let seed = seed.map(|(modal, exact)| Search { repaired: exact, ..modal.search_on(observation, &within) });
    fitter.watch.stage("searching the whole recording");
    let mut search = match seed.as_ref().or(blind.as_ref()) {
        Some(part) => Search::continued(fitter, within, part),
        None => Search::searched(fitter, within),
    };
    let chi2_per_dof = search.refitted.chi2_per_dof(observation);
    let mut findings = match nothing_can_be_stated(fitter, &search.repaired, search.candidates.len()) {
        true => Vec::new(),
        false => findings(fitter, &mut search),
    };
    let stated = |f: &Finding| f.probability + f.alternatives.iter().map(|(_, p)| p).sum::<f64>();
    if findings.is_empty() || findings.iter().any(|finding| stated(finding) < settings.evidence.stated) {
        // What the best hypotheses leave says that none of them is right: they would only adapt the model to the recording.
        findings.clear();
        search.repaired = search.refitted.clone();
    }
    let held_out = division.zip(blind).and_then(|(d, blind)| d.judge(&blind, &search, observation));
    let chance = upper_tail(excess(chi2_per_dof, observation.degrees(), observation.noise_uncertainty()));
    let locations = match chance < settings.evidence.located {
        true => {
            fitter.watch.stage("locating what is left");
            located(*fitter, &search.nominal.hypothesis, &search.refitted)
        }
        false => Vec::new(),
    };
    Ok(Parts {
        verdict: verdict(fitter, &search, &findings),
        refitted: (chi2_per_dof, chance),
        mismatch: mismatch(observation, &search.refitted.predicted, settings.evidence.bands),
        residual_correlation: observation.residual_correlation(&search.repaired.predicted),
        findings,
        locations,
        held_out,
        search,
        model_error: None,
        baseline_error: None,
        baseline: None,
        tried: Vec::new(),
    })
}

/// The diagnosis where the model's own error decides.
fn by_modes(fitter: &Fitter, within: Search, modal: &ModalJudgement, division: Option<&Division>) -> Parts {
    let Fitter { observation, settings, .. } = *fitter;
    let search = modal.search_on(observation, &within);
    let held_out = division.and_then(|division| {
        fitter.watch.stage("comparing by modes without what is held out");
        let blind = fitter.on(&division.seen);
        let known = modal.known(settings.modal.blind);
        let judged =
            ModalJudgement::of(&blind, &within.nominal.hypothesis, &within.candidates, Some(&known))?;
        division.judge(&judged.search_on(&division.seen, &within), &search, observation)
    });
    let chi2_per_dof = search.refitted.chi2_per_dof(observation);
    let chance = upper_tail(excess(chi2_per_dof, observation.degrees(), observation.noise_uncertainty()));
    let locations = match modal.verdict {
        Verdict::Unexplained => located(*fitter, &search.nominal.hypothesis, &search.refitted),
        _ => Vec::new(),
    };
    Parts {
        verdict: modal.verdict,
        refitted: (chi2_per_dof, chance),
        mismatch: mismatch(observation, &search.refitted.predicted, settings.evidence.bands),
        residual_correlation: observation.residual_correlation(&search.repaired.predicted),
        findings: modal.findings(&search.candidates),
        locations,
        held_out,
        search,
        model_error: Some(modal.errors),
        baseline_error: None,
        baseline: None,
        tried: modal.tried(settings.modal.tried),
    }
}

/// The diagnosis of what has changed since a baseline.
fn since(
    fitter: &Fitter,
    baseline: Observation,
    fixture: &Fixture,
    exact: bool,
) -> Result<Parts, DiagnosisError> {
    let observation = fitter.observation;
    let hypothesis = Hypothesis::nominal(fixture, exact);
    let candidates = catalogue(fixture, observation);
    let (modal, before) =
        ModalJudgement::since(fitter, &baseline, &hypothesis, &candidates).ok_or(DiagnosisError::Baseline)?;
    let calibrated = Fit::standing(before.calibrated, &baseline)?;
    let nominal = Fit::standing(hypothesis, observation)?;
    let within = Search { refitted: nominal.clone(), repaired: nominal.clone(), nominal, candidates };
    let parts = by_modes(fitter, within, &modal, None);
    let baseline = Baseline { observation: baseline, calibrated, modes: before.modes };
    Ok(Parts { baseline_error: Some(before.error), baseline: Some(baseline), ..parts })
}

/// Quantities that the refitted or the repaired model took farther from what is stated than chance does, the farthest first.
fn departures(search: &Search) -> Vec<Departure> {
    let [refitted, repaired] = [&search.refitted, &search.repaired].map(|fit| &fit.hypothesis);
    let of = |(index, tolerance): (usize, &Tolerance)| {
        let largest = refitted.departure(index).abs().max(repaired.departure(index).abs());
        let std = tolerance.quantity.std.filter(|_| largest > DEPARTED)?;
        Some(Departure {
            path: tolerance.quantity.path.clone(),
            stated: tolerance.quantity.value,
            std,
            refitted: refitted.ended_at(index),
            repaired: repaired.ended_at(index),
            deviations: repaired.departure(index),
        })
    };
    let mut all: Vec<Departure> = repaired.tolerances().iter().enumerate().filter_map(of).collect();
    all.sort_by(|a, b| b.deviations.abs().total_cmp(&a.deviations.abs()));
    all
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
    let widening = repaired.inflation(fitter.observation).sqrt();
    let finding = |(index, effect): (usize, Effect)| {
        let own = |a: &Alternative| search.candidates[a.candidate].names(&effect);
        let without = repaired.hypothesis.without(index);
        let without = match without.effect_count() {
            0 => Some(search.refitted.clone()),
            _ => fitter.global(&without.with_tolerances_of(&search.nominal.hypothesis)),
        };
        let alternative = |a: &Alternative| Some((a.fit.hypothesis.effects().pop()?, a.probability));
        Finding {
            estimates: estimates(&repaired.hypothesis, index, &effect, covariance.as_ref(), widening),
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
