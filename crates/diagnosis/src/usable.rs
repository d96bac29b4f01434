//! What of a recording a diagnosis rests on: the lines that are asked for and do not contradict all others,
//! and the references that agree.

use crate::contradiction::contradictory;
use crate::drift::Drifted;
use crate::work::Work;
use crate::{DiagnosisError, DiagnosisOptions, Hypothesis, Observation};
use jointscope_spectra::{FrfPair, FrfSet};
use std::sync::Arc;

/// What of a recording a diagnosis rests on.
pub(crate) struct Usable<'a> {
    pub options: &'a DiagnosisOptions,
    /// Bands, Hz, of lines that contradict all others.
    pub contradictory: Vec<(f64, f64)>,
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
        let drifted = Drifted::of(&observation, nominal, &options.settings.modal);
        let usable = Usable { options, contradictory, drifted };
        let observation = match usable.drifted {
            Some(_) => usable.agreeing(observation),
            None => observation,
        };
        Ok((usable, observation))
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
        let in_use = |hz| is_asked_for(self.options, hz) && !is_within(&self.contradictory, hz);
        Ok(self.agreeing(Observation::new(baseline, in_use)?))
    }

    /// Whether an FRF is of a reference that agrees with the others.
    fn keeps(&self, pair: &FrfPair) -> bool {
        self.drifted.as_ref().is_none_or(|drifted| drifted.keeps(&pair.reference))
    }

    /// The observation of the references that agree, or all of it where that leaves nothing.
    fn agreeing(&self, observation: Observation) -> Observation {
        observation.reduced(|_| true, |pair| self.keeps(pair)).unwrap_or(observation)
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
    let asked = |hz| is_asked_for(options, hz);
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

/// Whether a line is within the band that is asked for, and in none that is to be left out.
fn is_asked_for(options: &DiagnosisOptions, hz: f64) -> bool {
    options.band.is_none_or(|(from, to)| hz >= from && hz <= to) && !is_within(&options.exclude, hz)
}

fn is_within(bands: &[(f64, f64)], hz: f64) -> bool {
    bands.iter().any(|(from, to)| hz >= *from && hz <= *to)
}
