//! Whether the references' poles differ, and which of the references agree.

use super::agreement::agreeing;
use super::poles_by_frf::{PolesByFrf, poles_by_frf, references};
use super::table::Table;
use crate::settings::ModalSettings;
use crate::settings::drift::differences::{CALLED_DRIFT, LEAST_DIFFERENCE};
use crate::{Hypothesis, Observation};
use jointscope_model_error::RecordedModes;
use jointscope_spectra::Channel;

/// Drift as the recording alone tells it.
pub(crate) struct Drifted {
    pub(super) references: Vec<Channel>,
    /// Whether each reference is one of those that agree.
    pub(super) kept: Vec<bool>,
    /// The modes of one reference, to which [`Table::modes`] refer.
    pub(super) modes: RecordedModes,
    pub(super) table: Table,
    pub(super) p_value: f64,
}

impl Drifted {
    /// Drift between the references of a recording; `None` where their poles agree, or there is nothing to
    /// compare.
    pub(crate) fn of(
        observation: &Observation,
        nominal: &Hypothesis,
        settings: &ModalSettings,
    ) -> Option<Self> {
        let references = references(observation);
        if references.len() < 2 {
            return None;
        }
        let PolesByFrf { modes, table } =
            poles_by_frf(observation, nominal, settings, (&references, CALLED_DRIFT))?;
        let p_value = table.chance()?;
        let all: Vec<usize> = (0..references.len()).collect();
        if p_value >= CALLED_DRIFT || table.farthest(&all) < LEAST_DIFFERENCE {
            return None;
        }
        let frfs = |reference: &Channel| {
            observation.pairs().iter().filter(|pair| pair.reference == *reference).count()
        };
        let frfs: Vec<usize> = references.iter().map(frfs).collect();
        let kept = agreeing(&table, &frfs);
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
}
