//! What of a recording a diagnosis rests on: the lines that are asked for and do not contradict all others,
//! and the references that agree.

use crate::contradiction::contradictory;
use crate::drift::Drifted;
use crate::fitter::Fitter;
use crate::moved_sensor::WithoutSensors;
use crate::options::is_within;
use crate::record_end::{without_early_end, without_ends_of_references};
use crate::work::Work;
use crate::{DiagnosisError, DiagnosisOptions, Hypothesis, Observation, Watch};
use jointscope_fixture::{Effect, Fixture};
use jointscope_model_error::RecordEnd;
use jointscope_spectra::{FrfPair, FrfSet};
use std::sync::Arc;

/// What of a recording a diagnosis rests on.
pub(crate) struct Usable<'a> {
    pub options: &'a DiagnosisOptions,
    /// What the observation is held against: the fixture, without the sensors that were taken off.
    nominal: Hypothesis,
    /// The stated sensors whose mass is taken off the FRFs, where that is needed.
    without_sensors: Option<WithoutSensors>,
    /// Bands, Hz, of lines that contradict all others.
    pub contradictory: Vec<(f64, f64)>,
    /// The end of the records, where it came too early.
    pub early_end: Option<RecordEnd>,
    /// How references differ, where they do.
    pub drifted: Option<Drifted>,
}

impl<'a> Usable<'a> {
    /// What is usable of a recording, and the observation of it.
    ///
    /// # Errors
    /// FRFs that cannot be used, or a fixture that cannot be modelled between their channels.
    pub(crate) fn of(
        frfs: &FrfSet,
        options: &'a DiagnosisOptions,
        nominal: &Hypothesis,
        work: Arc<Work>,
    ) -> Result<(Self, Observation), DiagnosisError> {
        let (observation, contradictory) = without_contradictory(frfs, options, nominal, work)?;
        let fitter =
            Fitter { observation: &observation, settings: &options.settings, watch: Watch::default() };
        let (without_sensors, observation) = match WithoutSensors::of(&fitter, nominal, options.exact) {
            Some((without, unloaded)) => (Some(without), unloaded),
            None => (None, observation),
        };
        let nominal = without_sensors.as_ref().map_or(nominal, |without| &without.nominal).clone();
        let (observation, early_end, drifted) = of_one_structure(observation, &nominal, options);
        let of_responses = without_sensors.as_ref().and_then(|without| without.early_end);
        let early_end = of_responses.or(early_end);
        Ok((Usable { options, nominal, without_sensors, contradictory, early_end, drifted }, observation))
    }

    /// The fixture that the observation is held against.
    pub(crate) fn fixture(&self) -> &Fixture {
        self.nominal.fixture()
    }

    /// The stated sensors whose mass was taken off the FRFs.
    pub(crate) fn sensors_off(&self) -> &[Effect] {
        self.without_sensors.as_ref().map_or(&[], WithoutSensors::sensors)
    }

    /// The FRFs to be held out that are of references which agree.
    pub(crate) fn held_out(&self) -> Vec<FrfPair> {
        self.options.hold_out.iter().filter(|pair| self.keeps(pair)).cloned().collect()
    }

    /// The observation of a baseline on the same lines and references.
    ///
    /// # Errors
    /// FRFs that cannot be used.
    pub(crate) fn part_of_baseline(&self, baseline: &FrfSet) -> Result<Observation, DiagnosisError> {
        let in_use = |hz| self.options.asks_for(hz) && !is_within(&self.contradictory, hz);
        let observation = Observation::new(baseline, in_use)?;
        let observation = match &self.drifted {
            Some(drifted) => drifted.agreeing(&observation),
            None => observation,
        };
        let observation = match &self.without_sensors {
            Some(without) => without.as_well(observation),
            None => observation,
        };
        Ok(of_one_structure(observation, &self.nominal, self.options).0)
    }

    /// Whether an FRF is of a reference that agrees with the others.
    fn keeps(&self, pair: &FrfPair) -> bool {
        self.drifted.as_ref().is_none_or(|drifted| drifted.keeps(&pair.reference))
    }
}

/// The observation as if records had not ended too early and references were those of one structure; where
/// records ended, and how references differ.
fn of_one_structure(
    observation: Observation,
    nominal: &Hypothesis,
    options: &DiagnosisOptions,
) -> (Observation, Option<RecordEnd>, Option<Drifted>) {
    let without_drift =
        |observation: Observation| match Drifted::of(&observation, nominal, &options.settings.modal) {
            Some((drifted, without)) => (without, Some(drifted)),
            None => (observation, None),
        };
    let (restored, end) = match without_early_end(&observation, nominal.fixture()) {
        Some((restored, end)) => (Some(restored), Some(end)),
        None => (None, None),
    };
    let (without, drifted) = without_drift(restored.unwrap_or_else(|| observation.clone()));
    // Of a structure that drifted, poles of all references together tell the end of the records less well, or
    // not at all. Where they tell drift and no end, there is none.
    let is_in_doubt = end.is_some() == drifted.is_some();
    let by_reference = || without_ends_of_references(&observation, nominal.fixture());
    match is_in_doubt.then(by_reference).flatten() {
        Some((each, end)) => {
            let (without, drifted) = without_drift(each);
            (without, Some(end), drifted)
        }
        None => (without, end, drifted),
    }
}

/// The observation of the lines that are asked for and do not contradict all others; and the bands, Hz, of
/// those that do.
fn without_contradictory(
    frfs: &FrfSet,
    options: &DiagnosisOptions,
    nominal: &Hypothesis,
    work: Arc<Work>,
) -> Result<(Observation, Vec<(f64, f64)>), DiagnosisError> {
    let asked = |hz| options.asks_for(hz);
    let observation = Observation::new(frfs, asked)?.counted(Arc::clone(&work));
    nominal.predict(&observation)?;
    let contradictory = contradictory(&observation, nominal);
    if contradictory.is_empty() {
        return Ok((observation, contradictory));
    }
    let in_use = |hz| asked(hz) && !is_within(&contradictory, hz);
    let observation = Observation::new(frfs, in_use)?.counted(work);
    Ok((observation, contradictory))
}
