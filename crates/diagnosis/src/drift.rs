//! A test that drifted: the structure was another one while one reference was struck than while another was.
//!
//! A hammer test takes an hour; temperature and settling change joints and moduli meanwhile. All FRFs of a structure that stays the same share its poles, whatever a model of it
//! leaves out: masses, interfaces and laws move the poles of all FRFs alike, gains, delays and misplaced points move none, and an accelerometer that roves
//! moves those of its own response. Poles that differ between references beyond what responses explain are therefore drift (or a structure that depends on
//! amplitude, struck differently), and no physics.
//!
//! 1. **Quick test** ([`seen`]). Each reference's FRFs are fitted freely by themselves; ln ω of the modes that several references show are compared.
//! 2. **FRF by FRF** ([`seen`]). Where they differ, each FRF's own poles are taken; what differs by response is no drift ([`table`]).
//! 3. **Agreeing references** ([`agreement`]). The most references whose poles agree; the diagnosis goes on with theirs.
//! 4. **What drifted** ([`attribution`]). Each stiffness moves each mode by its share of the strain energy, d ln ω/d ln k = s/2. The shares of the model that the diagnosis ends with
//!    tell which stiffness explains the differences, and by how much.

mod agreement;
mod attribution;
mod seen;
mod table;

use crate::settings::{ModalSettings, Settings};
use crate::{Hypothesis, Observation};
use jointscope_fixture::Fixture;
use jointscope_model_error::RecordedModes;
use jointscope_spectra::{Channel, FrfSet};
use serde::Serialize;
use table::Table;

/// Probability by chance below which poles that differ between references are called drift.
const CALLED_DRIFT: f64 = 1e-3;
/// Differences of natural frequencies, as a share of the half-width, below which nothing is called drift: a free fit's residual terms leave as much wrong.
const LEAST: f64 = 0.005;

/// How far one reference's FRFs are from those of the references that agree.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceChange {
    /// Where was struck.
    pub reference: Channel,
    /// Relative change of the stiffness that drifted while this reference was struck: zero by definition where the references agree.
    pub change: f64,
    /// Its standard deviation.
    pub std: f64,
    /// Its interval of 95 %.
    pub ci95: [f64; 2],
    /// Whether the diagnosis goes on with this reference's FRFs.
    pub kept: bool,
}

/// How far one mode moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeDrift {
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Relative change of it by reference, in the order of [`TestDrift::references`]; `None` where a reference does not show the mode.
    pub changes: Vec<Option<f64>>,
    /// Standard deviations of these.
    pub std: Vec<Option<f64>>,
}

/// A test that drifted between references.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestDrift {
    /// Whose stiffness explains it: `joints/J`, `bodies/F` or `all stiffnesses`; `None` where the modes do not tell one.
    pub what: Option<String>,
    /// All that explain it, where `what` is `None`; empty where nothing does.
    pub could_be: Vec<String>,
    /// The course, in the order in which the recording has the references. Changes are of `what`; without, of all stiffnesses alike.
    pub references: Vec<ReferenceChange>,
    /// Probability of poles that differ as much between references by chance.
    pub p_value: f64,
    /// The modes that tell it.
    pub modes: Vec<ModeDrift>,
}

/// Drift as the recording alone tells it.
pub(crate) struct Drifted {
    references: Vec<Channel>,
    /// Whether each reference is one of those that agree.
    kept: Vec<bool>,
    /// The modes of one reference, to which [`Table::modes`] refer.
    modes: RecordedModes,
    table: Table,
    p_value: f64,
}

impl TestDrift {
    /// Probability by chance of poles that differ between references as much as in this recording, drift or not; `None` where nothing can be compared. The FRFs' own
    /// noise is taken, or estimated where they have none.
    pub fn chance(fixture: &Fixture, frfs: &FrfSet) -> Option<f64> {
        let observation = Observation::new(frfs, |_| true).ok()?;
        let references = seen::references(&observation);
        let nominal = Hypothesis::nominal(fixture, false);
        let settings = Settings::default().modal;
        seen::seen(&observation, &nominal, &settings, (&references, 1.0 + CALLED_DRIFT))?.table.chance()
    }
}

impl Drifted {
    /// Drift between the references of a recording; `None` where their poles agree, or there is nothing to compare.
    pub(crate) fn of(
        observation: &Observation,
        nominal: &Hypothesis,
        settings: &ModalSettings,
    ) -> Option<Self> {
        let references = seen::references(observation);
        if references.len() < 2 {
            return None;
        }
        let seen::Seen { modes, table } =
            seen::seen(observation, nominal, settings, (&references, CALLED_DRIFT))?;
        let p_value = table.chance()?;
        let all: Vec<usize> = (0..references.len()).collect();
        if p_value >= CALLED_DRIFT || table.farthest(&all) < LEAST {
            return None;
        }
        let frfs = |reference: &Channel| {
            observation.pairs().iter().filter(|pair| pair.reference == *reference).count()
        };
        let frfs: Vec<usize> = references.iter().map(frfs).collect();
        let kept = agreement::agreeing(&table, &frfs);
        // Where each agrees with each, there is nothing to leave out and no course to tell.
        if kept.iter().all(|kept| *kept) {
            return None;
        }
        Some(Drifted { references, kept, modes, table, p_value })
    }

    /// Whether the diagnosis goes on with FRFs of this reference.
    pub(crate) fn keeps(&self, reference: &Channel) -> bool {
        let at = self.references.iter().position(|own| own == reference);
        at.is_none_or(|at| self.kept[at])
    }

    /// What drifted, told by the shares of strain energy in a model of the structure.
    /// `explains`: whether that model explains the recording down to its noise.
    pub(crate) fn attributed(&self, model: &Fixture, explains: bool) -> TestDrift {
        attribution::attributed(self, model, explains)
    }
}
