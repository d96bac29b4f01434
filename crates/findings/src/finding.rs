use crate::Estimate;
use jointscope_fixture::Effect;
use serde::Serialize;

/// A piece of physics that the data need. What only one kind of data tells of it is its `evidence`: `E` differs between FRFs, hits and levels.
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

impl<E> Finding<E> {
    /// Whether neither it nor any of its look-alikes is likelier than something that is not listed.
    pub fn is_doubtful(&self) -> bool {
        self.probability + self.alternatives.iter().map(|(_, probability)| probability).sum::<f64>() < 0.5
    }

    /// A parameter, by its name in files.
    pub fn estimate(&self, parameter: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter.name == parameter)
    }
}
