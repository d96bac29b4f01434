//! What a diagnosis names, and what it tried.

use crate::location::Location;
use crate::settings::statements::findings::LIKELY_SHARE;
use jointscope_findings::Estimate;
use jointscope_fixture::{Effect, Motion};
use serde::Serialize;

/// A piece of physics that the FRFs need.
pub type Finding = jointscope_findings::Finding<FrfEvidence>;

/// What FRFs tell of a finding beyond its name, size and probability.
#[derive(Debug, Clone, Serialize)]
pub struct FrfEvidence {
    /// What χ² and priors lose without it.
    #[serde(rename = "gain_chi2")]
    pub gain: f64,
    /// The same at other places of its body, where the recording does not tell them apart, the most probable
    /// first.
    pub elsewhere: Vec<Elsewhere>,
    /// Its place with one free scalar a line in its stead, beside the other findings: the measured δ(ω) that
    /// its law has to follow. `None` where its place is not of rank one.
    #[serde(skip)]
    pub measured: Option<Location>,
}

impl FrfEvidence {
    /// The other places of the finding that are likely enough to be reckoned with.
    pub fn likely_places(&self) -> impl Iterator<Item = &Elsewhere> {
        self.elsewhere.iter().filter(|place| place.share >= LIKELY_SHARE)
    }

    /// Whether there are any.
    pub fn may_be_elsewhere(&self) -> bool {
        self.likely_places().next().is_some()
    }
}

/// A finding at another place of its body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Elsewhere {
    /// Parameters there, with their uncertainty.
    #[serde(rename = "parameters", serialize_with = "jointscope_findings::parameters")]
    pub estimates: Vec<Estimate>,
    /// Probability that it is there if it is what its name says; the rest is for where the finding states it,
    /// and other places.
    pub share: f64,
}

impl Elsewhere {
    /// The abscissa, m.
    pub fn abscissa(&self) -> Option<f64> {
        let along = |estimate: &&Estimate| estimate.parameter.motion == Motion::AlongBody;
        self.estimates.iter().find(along).map(|estimate| estimate.value)
    }
}

/// An effect that was tried by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Kind, place, dof and parameters.
    #[serde(flatten, serialize_with = "jointscope_findings::effect_name")]
    pub effect: Effect,
    /// What it gains in ln p over the fixture without it.
    pub ln_gain: f64,
}
