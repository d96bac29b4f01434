//! Fixtures and FRFs evaluated anew against a case's recording, whatever an answer says of them.

use crate::objective::{Tolerance, objective, values};
use crate::{Case, Reference};
use jointscope_diagnosis::Observation;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// Evaluates fixtures anew against a case's recording, and not taken at an answer's word.
pub(crate) struct Judge<'a> {
    believed: &'a Fixture,
    tolerances: Vec<Tolerance>,
    /// What was recorded.
    pub observation: Observation,
}

impl<'a> Judge<'a> {
    /// `None` where the recording has no noise that could be judged by.
    pub(crate) fn of(case: &'a Case) -> Option<Self> {
        let observation = Observation::new(&case.recorded, |_| true).ok()?;
        Some(Judge { believed: &case.believed, tolerances: Tolerance::all(&case.believed), observation })
    }

    /// The objective of a fixture, read as the recording was.
    pub(crate) fn objective(&self, fixture: &Fixture) -> Option<f64> {
        let (pairs, lines) = (self.observation.pairs(), self.observation.lines());
        let set = synthesize(fixture, pairs, lines, Instrument::AsRecorded).ok()?;
        Some(self.objective_of(set.all_values(), fixture))
    }

    /// The objective of FRFs, with the departures of a fixture's quantities.
    pub(crate) fn objective_of(&self, predicted: &[Complex64], fixture: &Fixture) -> f64 {
        objective(&self.observation, predicted, &self.tolerances, &values(fixture))
    }

    /// The same of noise-free FRFs on all lines of the recording.
    pub(crate) fn objective_of_clean(&self, clean: &FrfSet, fixture: &Fixture) -> Option<f64> {
        // Exactly the lines in use: of many a diagnosis thins out.
        let (hz, in_use) = (clean.lines().hz(), self.observation.lines().hz());
        let is_used = |line: usize| in_use.iter().any(|used| (used - hz[line]).abs() <= 1e-6 * hz[line]);
        Some(self.objective_of(clean.on_lines(is_used)?.all_values(), fixture))
    }

    /// The best fit about a fixture, by the laboratory's own model.
    pub(crate) fn best(&self, start: &Fixture) -> Option<Reference> {
        Reference::of(self.believed, start, &self.observation)
    }

    /// Objectives of the best fits about a fixture without each of its effects.
    pub(crate) fn without_each(&self, fixture: &Fixture) -> Vec<f64> {
        let without = |index: usize| {
            let mut fewer = fixture.physics().to_vec();
            fewer.remove(index);
            self.best(&fixture.clone().with_physics(fewer).ok()?)
        };
        let objective = |index| without(index).map_or(f64::INFINITY, |reference| reference.objective);
        (0..fixture.physics().len()).map(objective).collect()
    }

    /// Quantities that lie farther than so many standard deviations from what was stated.
    pub(crate) fn beyond_tolerance(&self, fixture: &Fixture, beyond: f64) -> Vec<(String, f64)> {
        let (quantities, values) = (self.believed.quantities(), values(fixture));
        let departure = |t: &Tolerance| (quantities[t.index].path.clone(), t.departure(&values));
        self.tolerances.iter().map(departure).filter(|(_, by)| by.abs() > beyond).collect()
    }
}
