//! The FRFs that a hypothesis predicts for an observation, and how they change with its coordinates.

use crate::settings::effects::differences::COORDINATE_STEP;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Fixture, FixtureError, Place, QuantityOwner};
use jointscope_lumped::{Instrument, LumpedError, Tangent, Vicinity, accelerances};
use jointscope_spectra::FrfPair;
use num_complex::Complex64;

/// Why a hypothesis predicts nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PredictionError {
    /// Its quantities or parameters are impossible.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
    /// Its model has no finite FRFs.
    #[error(transparent)]
    Model(#[from] LumpedError),
}

/// Writes the values of `some` FRFs, those of the places `frfs`, where they belong among `all`, each of so
/// many `lines`.
fn write_frfs(all: &mut [Complex64], some: &[Complex64], frfs: &[usize], lines: usize) {
    for (values, &i) in some.chunks_exact(lines).zip(frfs) {
        all[i * lines..(i + 1) * lines].copy_from_slice(values);
    }
}

impl Hypothesis {
    /// The accelerances this hypothesis predicts for an observation, as its instruments would record them.
    ///
    /// # Errors
    /// Impossible quantities, or a model without finite FRFs.
    pub fn predict(&self, observation: &Observation) -> Result<Vec<Complex64>, PredictionError> {
        let fixture = self.to_fixture()?;
        observation.work().count(observation.values().len());
        Ok(accelerances(&fixture, observation.pairs(), observation.lines(), Instrument::AsRecorded)?)
    }

    /// What is predicted with coordinate `index` moved by `step`. FRFs that do not depend on it are not
    /// predicted again: they are those of `predicted`, or zero without. Of a step that is small enough for a
    /// derivative modes may follow from those that it leads `away` from.
    pub(crate) fn predict_moved(
        &self,
        index: usize,
        step: f64,
        (predicted, away): (Option<&[Complex64]>, Option<&Vicinity>),
        observation: &Observation,
    ) -> Result<Vec<Complex64>, PredictionError> {
        let moved = self.moved(index, step);
        let lines = observation.lines();
        let count = lines.len();
        let by = |fixture: &Fixture, pairs: &[FrfPair]| match away {
            Some(away) => away.beside(fixture, pairs, Instrument::AsRecorded)?.accelerances(lines),
            None => accelerances(fixture, pairs, lines, Instrument::AsRecorded),
        };
        let Some(frfs) = self.depending(index, observation) else {
            let fixture = moved.to_fixture()?;
            observation.work().count(observation.values().len());
            return Ok(by(&fixture, observation.pairs())?);
        };
        let mut all =
            predicted.map_or_else(|| vec![Complex64::ZERO; observation.values().len()], <[_]>::to_vec);
        let pairs: Vec<FrfPair> = frfs.iter().map(|&i| observation.pairs()[i].clone()).collect();
        if !pairs.is_empty() {
            let fixture = moved.to_fixture()?;
            observation.work().count(count * pairs.len());
            let some = by(&fixture, &pairs)?;
            write_frfs(&mut all, &some, &frfs, count);
        }
        Ok(all)
    }

    /// What differences of an observation's FRFs set out from; `None` where whole solutions cost as little.
    pub(crate) fn vicinity(&self, observation: &Observation) -> Option<Vicinity> {
        let hz = observation.lines().hz();
        Vicinity::where_it_pays(self.to_fixture().ok()?, hz[hz.len() - 1])
    }

    /// What derivatives of an observation's FRFs are taken from; `None` where they have to be differences.
    pub(crate) fn tangent<'o>(&self, observation: &'o Observation) -> Option<Tangent<'o>> {
        Tangent::where_it_pays(
            self.to_fixture().ok()?,
            observation.pairs(),
            observation.lines(),
            Instrument::AsRecorded,
        )
    }

    /// Derivatives by coordinate `index` from one solution. They count as the work of the `predictions` that
    /// differences would take, so that a limit of work means the same however derivatives come about.
    pub(crate) fn derivative(
        &self,
        index: usize,
        solution: &Tangent,
        observation: &Observation,
        predictions: usize,
    ) -> Option<Vec<Complex64>> {
        let step = self.inward(index, COORDINATE_STEP);
        let fixture = self.moved(index, step).to_fixture().ok()?;
        let some = self.depending(index, observation);
        let derivatives = solution.toward(&fixture, step, some.as_deref())?;
        let count = observation.lines().len();
        (0..predictions).for_each(|_| observation.work().count(derivatives.len()));
        let Some(frfs) = some else { return Some(derivatives) };
        let mut all = vec![Complex64::ZERO; observation.values().len()];
        write_frfs(&mut all, &derivatives, &frfs, count);
        Some(all)
    }

    /// The FRFs that coordinate `index` acts on, where that is told by its name: where a channel's point
    /// sits, if nothing but channels is there, matters to that channel's FRFs alone.
    fn depending(&self, index: usize, observation: &Observation) -> Option<Vec<usize>> {
        let place = match self.tolerances().get(index)?.quantity.owner {
            QuantityOwner::Point(place) => place,
            QuantityOwner::Channel(channel) => return self.recorded_by(channel, observation),
            _ => return None,
        };
        let name = self.fixture().points()[place].name.as_str();
        let holds = self.fixture().joints().iter().any(|joint| joint.from == place || joint.to == place);
        if holds || !self.fixture().supports().is_empty() {
            return None;
        }
        let pairs = observation.pairs().iter().enumerate();
        let reads = |pair: &FrfPair| pair.response.point == name || pair.reference.point == name;
        Some(pairs.filter(|(_, pair)| reads(pair)).map(|(i, _)| i).collect())
    }

    /// The one FRF that a channel of the fixture is the record of.
    fn recorded_by(&self, channel: usize, observation: &Observation) -> Option<Vec<usize>> {
        let Place::Record(name) = &self.fixture().channels().get(channel)?.place else { return None };
        let is_own = |pair: &FrfPair| pair.is_named(name);
        Some(observation.pairs().iter().position(is_own).into_iter().collect())
    }
}
