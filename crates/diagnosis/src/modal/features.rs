//! A recording as its modes tell it, and what is known of a model's error beforehand: what hypotheses are
//! held against.

use crate::modal::problem::Problem;
use crate::modal::sizes::known;
use crate::settings::ModalSettings;
use crate::settings::modal::recorded::SPARE_ORDERS;
use crate::work::Work;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Fixture, Quantity};
use jointscope_model_error::{RecordedModes, SizePrior, Structural};
use jointscope_modes::ModesOptions;
use std::sync::OnceLock;

/// Features of a recording's modes, and sizes of error.
#[derive(Debug, Clone)]
pub(crate) struct Features {
    pub recorded: RecordedModes,
    values: Vec<f64>,
    pub known: SizePrior,
    /// Whether the fixture has supports with dashpots.
    held_by_dashpots: bool,
    /// Fitted when it is first asked for.
    structural: OnceLock<Option<Structural>>,
}

impl Features {
    /// Those of a recording; `None` where it has no modes that could be compared.
    pub(crate) fn of(
        observation: &Observation,
        nominal: &Hypothesis,
        settings: &ModalSettings,
    ) -> Option<Self> {
        let fixture = nominal.to_fixture().ok()?;
        let known = known(settings, &fixture, observation.pairs());
        let features = Features::new(recorded(observation, nominal)?, known);
        let damps = |dashpot: &Option<Quantity>| dashpot.as_ref().is_some_and(|damping| damping.value > 0.0);
        let mut supports = fixture.supports().iter();
        let held_by_dashpots = supports.any(|s| damps(&s.damping) || damps(&s.rotational_damping));
        Some(Features { held_by_dashpots, ..features })
    }

    /// Those of modes, with what is known of the sizes of error.
    pub(crate) fn new(recorded: RecordedModes, known: SizePrior) -> Self {
        let structural = OnceLock::new();
        Features { values: recorded.features(), recorded, known, held_by_dashpots: false, structural }
    }

    /// What hypotheses are fitted to; the work done for that is counted in `work`.
    pub(crate) fn problem<'a>(&'a self, work: &'a Work) -> Problem<'a> {
        Problem {
            recorded: &self.recorded,
            features: &self.values,
            sizes: &self.known.scales,
            stated: self.known.stated,
            work,
        }
    }

    /// What errors of a structure's model, however large, leave of the recording.
    pub(crate) fn structural(&self, observation: &Observation) -> Option<Structural> {
        let fitted = || self.recorded.structural(observation.weighted(), self.held_by_dashpots);
        *self.structural.get_or_init(fitted)
    }

    /// Whether the modes tell a part of the recording only.
    pub(crate) fn is_incomplete(&self, settings: &ModalSettings) -> bool {
        self.recorded.chi2_per_dof > settings.free_fit_limit || self.recorded.has_excess_residual_terms()
    }
}

/// The recording's modes, with the help of the model's where they are not resolved.
pub(crate) fn recorded(observation: &Observation, nominal: &Hypothesis) -> Option<RecordedModes> {
    let fixture = nominal.to_fixture().ok()?;
    let options = modes_options(observation, &fixture);
    let recorded = RecordedModes::of(observation.weighted(), &options, |alone| alone.expected_by(&fixture))?;
    Some(recorded.beside(&fixture))
}

/// How the modes of a recording are looked for. Where nothing but the FRFs tells their noise, every ripple
/// looks like a mode: no more are asked for than a model may have.
pub(crate) fn modes_options(observation: &Observation, fixture: &Fixture) -> ModesOptions {
    let expected = || jointscope_model_error::modes_within(fixture, observation.frfs());
    let orders = observation
        .has_scatter_for_noise()
        .then(expected)
        .flatten()
        .map(|modes| (2, 2 * modes + SPARE_ORDERS));
    ModesOptions { orders, ..ModesOptions::default() }
}
