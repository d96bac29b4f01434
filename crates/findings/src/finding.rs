//! What was found and what else it may be. The evidence is a type of its own for each kind of data.

use crate::Estimate;
use jointscope_fixture::Effect;
use serde::Serialize;

/// A piece of physics that the data need. What only one kind of data tells of it is its `evidence`: `E`
/// differs between FRFs, hits and levels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding<E> {
    /// Kind, place, dof and parameters.
    #[serde(flatten, serialize_with = "crate::effect_name")]
    pub effect: Effect,
    /// Parameters with their uncertainty.
    #[serde(rename = "parameters", serialize_with = "crate::parameters")]
    pub estimates: Vec<Estimate>,
    /// Probability of kind, place and dof together.
    pub probability: f64,
    /// Other names for it, the most probable first.
    #[serde(serialize_with = "crate::alternatives")]
    pub alternatives: Vec<(Effect, f64)>,
    /// What speaks for it.
    #[serde(flatten)]
    pub evidence: E,
}

/// Probability from which another name for a finding is to be reckoned with: worth a word, and a measurement
/// that tells it apart.
const LIKELY: f64 = 0.05;

impl<E> Finding<E> {
    /// The other names that are likely enough to be reckoned with.
    pub fn look_alikes(&self) -> impl Iterator<Item = &(Effect, f64)> {
        self.alternatives.iter().filter(|(_, probability)| *probability >= LIKELY)
    }

    /// Whether a further measurement should tell it from other names, or from something that is not listed.
    pub fn is_open(&self) -> bool {
        self.look_alikes().next().is_some() || self.is_doubtful()
    }

    /// Whether neither it nor any of its look-alikes is likelier than something that is not listed.
    pub fn is_doubtful(&self) -> bool {
        self.stated() < 0.5
    }

    /// Probability of all names together; the rest is something that is not listed.
    pub fn stated(&self) -> f64 {
        self.probability + self.alternatives.iter().map(|(_, probability)| probability).sum::<f64>()
    }

    /// A parameter, by its name in files.
    pub fn estimate(&self, parameter: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter.name == parameter)
    }
}
