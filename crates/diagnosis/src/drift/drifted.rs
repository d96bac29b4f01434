//! Whether the references' poles differ, and which of the references agree.

use super::agreement::agreeing;
use super::levelled::levelled;
use super::poles_by_frf::{
    PolesByFrf, ReferenceModes, by_reference, leaves_between, poles_by_frf, references,
};
use super::table::Table;
use crate::settings::ModalSettings;
use crate::settings::drift::differences::{CALLED_DRIFT, LEAST_DIFFERENCE, NEARLY_ALL};
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
    /// Whether references differ so little that the difference is taken out, and none of them left out.
    pub(super) levelled: bool,
}

impl Drifted {
    /// Drift between the references of a recording, and the observation without it: of the references that
    /// agree, or of all of them where they differ little. `None` where their poles agree, or there is nothing
    /// to compare.
    pub(crate) fn of(
        observation: &Observation,
        nominal: &Hypothesis,
        settings: &ModalSettings,
    ) -> Option<(Self, Observation)> {
        let references = references(observation);
        if references.len() < 2 {
            return None;
        }
        let struck = by_reference(observation, nominal, &references);
        let limit = settings.free_fit_limit;
        let told = |most_left: f64| Self::told(observation, (&references, &struck), most_left);
        // Where modes do not tell all there is, little drift may be taken out, but no reference left out.
        let least_drift = || {
            let others = leaves_between(&struck, (limit, NEARLY_ALL));
            others.then(|| told(NEARLY_ALL)).flatten().filter(|(drifted, _)| drifted.levelled)
        };
        told(limit).or_else(least_drift)
    }

    /// The same of references whose free fits leave less than `most_left` in χ² per degree of freedom.
    fn told(
        observation: &Observation,
        (references, struck): (&[Channel], &[Option<ReferenceModes>]),
        most_left: f64,
    ) -> Option<(Self, Observation)> {
        let PolesByFrf { modes, table, own } = poles_by_frf(observation, struck, (most_left, CALLED_DRIFT))?;
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
        let levelled = levelled(observation, references, &own);
        let (references, modes) = (references.to_vec(), modes.clone());
        let drifted = Drifted { references, kept, modes, table, p_value, levelled: levelled.is_some() };
        let without = levelled.unwrap_or_else(|| drifted.agreeing(observation));
        Some((drifted, without))
    }

    /// The observation of the references with whose FRFs the diagnosis goes on, or all of it where that leaves
    /// nothing.
    pub(crate) fn agreeing(&self, observation: &Observation) -> Observation {
        let agreeing = observation.reduced(|_| true, |pair| self.keeps(&pair.reference));
        agreeing.unwrap_or_else(|| observation.clone())
    }

    /// Whether the diagnosis goes on with FRFs of this reference.
    pub(crate) fn keeps(&self, reference: &Channel) -> bool {
        let at = self.references.iter().position(|own| own == reference);
        self.levelled || at.is_none_or(|at| self.kept[at])
    }
}
