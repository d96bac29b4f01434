//! The whole diagnosis: what is left out before it, the route, and what is done once more with other noise.

use crate::departures::{Departure, departures, has_departed};
use crate::drift::{Drifted, TestDrift};
use crate::evidence::cost;
use crate::finding::{Finding, Tried};
use crate::fitter::Fitter;
use crate::force_noise::Shortfall;
use crate::location::Location;
use crate::mismatch::{FrfMismatch, mismatch};
use crate::modal::{Features, ModelError};
use crate::options::{DiagnosisError, DiagnosisOptions};
use crate::routes::{self, Parts, chance};
use crate::search::Search;
use crate::settings::Settings;
use crate::usable::Usable;
use crate::work::Work;
use crate::{Baseline, Hypothesis, Observation, Watch};
use jointscope_findings::{HeldOut, Verdict};
use jointscope_fixture::{Effect, EffectKind, Fixture};
use jointscope_lumped::Assembly;
use jointscope_model_error::RecordEnd;
use jointscope_spectra::FrfSet;
use std::sync::Arc;

/// The whole answer.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// What it comes to.
    pub verdict: Verdict,
    /// FRFs and noise that it rests on.
    pub observation: Observation,
    /// The three models: the file's, refitted within tolerances, with the effects found.
    pub search: Search,
    /// The refitted and the repaired model where quantities are as probable as can be: what is said of them.
    /// By modes the models of [`Diagnosis::search`], which are to predict, follow the recording more closely
    /// than that.
    pub stated: [Hypothesis; 2],
    /// χ² per degree of freedom of the refitted fixture, and the probability of one as large by chance.
    pub refitted: (f64, f64),
    /// Mismatch of the refitted fixture by FRF and band.
    pub mismatch: Vec<FrfMismatch>,
    /// What was found, the strongest first.
    pub findings: Vec<Finding>,
    /// What each place leaves unexplained of the refitted fixture's mismatch with one free scalar a line, the
    /// best place first. Empty where there is no mismatch.
    pub locations: Vec<Location>,
    /// The judgement on what no fit saw.
    pub held_out: Option<HeldOut>,
    /// Correlation of neighbouring lines' residuals of the repaired model: near zero if they are white.
    pub residual_correlation: f64,
    /// Error of the refitted and of the repaired model, where it is larger than the noise and decides; `None`
    /// where the noise does.
    pub model_error: Option<[ModelError; 2]>,
    /// Error of the model on the baseline, where there was one; then [`Diagnosis::model_error`] is of the
    /// change since.
    pub baseline_error: Option<ModelError>,
    /// The state that a change is told from, where there was a baseline.
    pub baseline: Option<Baseline>,
    /// Quantities that had to leave their stated values by more than chance makes, the farthest first.
    pub departures: Vec<Departure>,
    /// What the search did not come to within its limit of work or time.
    pub stopped: Vec<&'static str>,
    /// Bands, Hz, of lines that contradict all others whatever the structure, and were left out.
    pub contradictory: Vec<(f64, f64)>,
    /// The largest share by which FRFs fell short because of noise of the force, where that explains the
    /// recording better: the observation is without it.
    pub falls_short: Option<f64>,
    /// Where records ended, where the structure still rang: the observation is with what followed.
    pub early_end: Option<RecordEnd>,
    /// What no modes explain of the recording, as a share of its FRFs, where it had to count as noise for
    /// anything to be explained: the observation has so much.
    pub beside_modes: Option<f64>,
    /// How the structure changed from reference to reference, where it did: the diagnosis is of the
    /// references that agree.
    pub drift: Option<TestDrift>,
    /// Stated sensors that were moved from response to response and whose mass was taken off the FRFs: the
    /// observation, and the fixtures that are held against it, are without them.
    pub sensors_off: Vec<Effect>,
    /// Effects that were tried by themselves where the model's error decides or nothing explains the
    /// recording, by what they make of its modes: the most probable first.
    pub tried: Vec<Tried>,
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
        let of_hits = options
            .estimated
            .then(|| DiagnosisOptions { settings: options.settings.of_estimates(), ..options.clone() });
        let options = of_hits.as_ref().unwrap_or(options);
        let work = Arc::new(work_for(fixture, frfs, options));
        let fixture = &with_gains_of_records(fixture, frfs, options);
        let nominal = Hypothesis::nominal(fixture, options.exact);
        let (usable, observation) = Usable::of(frfs, options, &nominal, work)?;
        let diagnosed = |observation| Self::by_its_route(&usable, observation, watch);
        let diagnosis = diagnosed(observation)?;
        let diagnosis = match options.baseline {
            None => {
                diagnosis.without_shortfall(options, diagnosed)?.beside_modes(&options.settings, diagnosed)?
            }
            Some(_) => diagnosis,
        };
        let diagnosis = diagnosis.within_estimates(options);
        let drift = usable.drifted.as_ref().and_then(|drifted| diagnosis.told_drift(drifted));
        let sensors_off = usable.sensors_off().to_vec();
        let Usable { contradictory, early_end, .. } = usable;
        Ok(Diagnosis { contradictory, early_end, drift, sensors_off, ..diagnosis })
    }

    /// What the route of a recording makes of an observation, where FRFs are many of a part of them first.
    fn by_its_route(usable: &Usable, observation: Observation, watch: Watch) -> Result<Self, DiagnosisError> {
        let fixture = usable.fixture();
        let options = &DiagnosisOptions { hold_out: usable.held_out(), ..usable.options.clone() };
        let few = observation.searched(&options.hold_out);
        let searched = few.as_ref().unwrap_or(&observation);
        let fitter = Fitter { observation: searched, settings: &options.settings, watch };
        let mut parts = match &options.baseline {
            Some(baseline) => {
                let baseline = usable.part_of_baseline(baseline)?;
                changed_since(&fitter, &observation, baseline, fixture, options)?
            }
            None => routes::judged(&fitter, fixture, options, usable.sensors_off().is_empty())?,
        };
        if few.is_some() {
            parts = parts.on_all(&fitter.on(&observation));
        }
        Ok(Self::of_parts(parts, observation, &options.settings))
    }

    /// The answer that the parts of a route make.
    fn of_parts(parts: Parts, observation: Observation, settings: &Settings) -> Self {
        let stated = parts.models();
        let search = parts.search;
        Self {
            verdict: parts.verdict,
            refitted: chance(&observation, &search.refitted),
            mismatch: mismatch(&observation, &search.refitted.predicted, settings.evidence.bands),
            residual_correlation: observation.residual_correlation(&search.repaired.predicted),
            departures: departures(&stated),
            stated,
            contradictory: Vec::new(),
            falls_short: None,
            early_end: None,
            beside_modes: None,
            drift: None,
            sensors_off: Vec::new(),
            stopped: observation.work().left_out(),
            observation,
            search,
            findings: parts.findings,
            locations: parts.locations,
            held_out: parts.held_out,
            model_error: parts.model_error,
            baseline_error: parts.baseline_error,
            baseline: parts.baseline,
            tried: parts.tried,
        }
    }

    /// What drifted, by the model that the diagnosis ends with.
    fn told_drift(&self, drifted: &Drifted) -> Option<TestDrift> {
        let model = self.search.repaired.hypothesis.to_fixture();
        let explains =
            self.model_error.is_none() && matches!(self.verdict, Verdict::Consistent | Verdict::Explained);
        Some(drifted.attributed(&model.ok()?, explains))
    }

    /// The same, or, where something was found or left and FRFs that fall short by noise of the force explain
    /// the recording better, what is `diagnosed` of the FRFs without that. FRFs that were estimated from hits
    /// do not: that noise was seen and taken off.
    fn without_shortfall(
        self,
        options: &DiagnosisOptions,
        diagnosed: impl Fn(Observation) -> Result<Self, DiagnosisError>,
    ) -> Result<Self, DiagnosisError> {
        let settings = &options.settings;
        let needs_nothing = self.verdict == Verdict::Consistent && self.model_error.is_none();
        if options.estimated || needs_nothing {
            return Ok(self);
        }
        let fitter = Fitter { observation: &self.observation, settings, watch: Watch::default() };
        let Search { refitted, repaired, .. } = &self.search;
        let found = (repaired.hypothesis.effect_count() > 0).then_some(repaired);
        let cost = |of: &Self| cost(&fitter, &of.search.repaired, 1.0);
        // Beside what was found second: a filter or a mass takes up what falls short, and leaves too little
        // of it.
        for fit in [Some(refitted), found].into_iter().flatten() {
            let short = Shortfall::beside(&fitter, fit).filter(|short| short.explains(&fitter));
            let Some(short) = short else { continue };
            let Some(corrected) = short.corrected(&self.observation) else { continue };
            let other = diagnosed(corrected)?;
            // What needs nothing is as good as what falls short leaves by itself, whatever models are in
            // error by.
            let left = if other.verdict == Verdict::Consistent { short.left() } else { f64::INFINITY };
            if cost(&other).min(left) + settings.selection.parameter_penalty < cost(&self) {
                return Ok(Diagnosis { falls_short: Some(short.largest), ..other });
            }
        }
        Ok(self)
    }

    /// The same, or, where nothing explains the whole recording and no poles do either, what is `diagnosed`
    /// in part with that as its noise: leakage and filters leave what no structure has in its FRFs, and no
    /// name is to be held against it.
    fn beside_modes(
        self,
        settings: &Settings,
        diagnosed: impl Fn(Observation) -> Result<Self, DiagnosisError>,
    ) -> Result<Self, DiagnosisError> {
        // With a sensor that loads the structure in some FRFs only, none has the poles that all share.
        let is_loaded = self.findings.iter().any(|finding| finding.effect.kind == EffectKind::SensorMass);
        if is_loaded || !matches!(self.verdict, Verdict::Unexplained | Verdict::PartlyExplained) {
            return Ok(self);
        }
        let nominal = &self.search.nominal.hypothesis;
        let Some(features) = Features::of(&self.observation, nominal, &settings.modal) else {
            return Ok(self);
        };
        let left = features.recorded.chi2_per_dof;
        let share = left.sqrt() * self.observation.relative_noise();
        if left <= settings.modal.free_fit_limit || share > settings.modal.beside_modes {
            return Ok(self);
        }
        let other =
            Diagnosis { beside_modes: Some(share), ..diagnosed(self.observation.with_variance_times(left))? };
        Ok(match other.verdict {
            Verdict::Explained | Verdict::PartlyExplained if other.surest() > self.surest() => {
                Diagnosis { verdict: Verdict::PartlyExplained, ..other }
            }
            // No more than models usually have for errors of shapes.
            Verdict::Consistent if self.findings.is_empty() && share <= settings.modal.usual.shape => other,
            _ => self,
        })
    }

    /// The same, or without findings where the FRFs were estimated, the fixture as refitted explains them,
    /// none of its quantities far off, and what was found gains little over that, or is what a record's end
    /// or its baseline make of FRFs too: a window, or AC coupling.
    fn within_estimates(self, options: &DiagnosisOptions) -> Self {
        let evidence = &options.settings.evidence;
        let explains_all =
            options.estimated && self.refitted.0 < evidence.explained.0 && !has_departed(&self.stated[0]);
        let gain = self.search.refitted.objective - self.search.repaired.objective;
        let imitated = |finding: &Finding| {
            matches!(finding.effect.kind, EffectKind::ExponentialWindow | EffectKind::ChannelHighpass)
        };
        let is_little = gain < evidence.little_of_estimates || self.findings.iter().all(imitated);
        if explains_all && is_little { self.without_findings() } else { self }
    }

    /// The largest probability of a finding.
    fn surest(&self) -> f64 {
        self.findings.iter().map(|finding| finding.probability).fold(0.0, f64::max)
    }

    /// The same where the fixture as refitted explains all that there is to explain.
    fn without_findings(mut self) -> Self {
        self.search.repaired = self.search.refitted.clone();
        self.verdict = Verdict::Consistent;
        self.residual_correlation = self.observation.residual_correlation(&self.search.repaired.predicted);
        self.stated[1] = self.stated[0].clone();
        self.departures = departures(&self.stated);
        (self.findings, self.locations, self.tried) = (Vec::new(), Vec::new(), Vec::new());
        // What is said of a change says by how much the model misses it.
        let missed = self.model_error.filter(|_| self.baseline.is_some());
        (self.held_out, self.model_error) = (None, missed.map(|[refitted, _]| [refitted; 2]));
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

/// How much work a diagnosis may do.
fn work_for(fixture: &Fixture, frfs: &FrfSet, options: &DiagnosisOptions) -> Work {
    let highest = frfs.lines().hz().last().copied().unwrap_or_default();
    let coordinates = Assembly::new(fixture, highest).map_or(0, |assembly| assembly.order());
    Work::of(options.settings.work, options.time_limit).for_models_of(coordinates)
}

/// The fixture, each record's gain moving within what is stated of all of them, on lines and by modes; of a
/// baseline and what follows it they are not the same.
fn with_gains_of_records(fixture: &Fixture, frfs: &FrfSet, options: &DiagnosisOptions) -> Fixture {
    if options.baseline.is_some() {
        return fixture.clone();
    }
    let names: Vec<String> = frfs.pairs().iter().map(ToString::to_string).collect();
    fixture.clone().with_records(names.iter().map(String::as_str))
}

/// What has changed in the whole `observation` since a `baseline`, of which the fitter's part is searched.
fn changed_since(
    fitter: &Fitter,
    observation: &Observation,
    baseline: Observation,
    fixture: &Fixture,
    options: &DiagnosisOptions,
) -> Result<Parts, DiagnosisError> {
    if baseline.pairs() != observation.pairs() {
        return Err(DiagnosisError::Baseline);
    }
    let pairs = fitter.observation.pairs();
    let part = baseline.reduced(|_| true, |pair| pairs.contains(pair));
    routes::since(fitter, part.unwrap_or(baseline), fixture, options)
}
