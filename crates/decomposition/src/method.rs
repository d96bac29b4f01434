//! How K and C of a joint were estimated.

use serde::Serialize;

/// Where an estimate comes from; in files the entry of `stiffness.json` that it stands in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The mean over the band, eq (35) and (42).
    #[serde(rename = "average")]
    PlainMean,
    /// The mean weighted by the noise of each line.
    #[serde(rename = "weighted_average")]
    WeightedMean,
    /// The fit of a constant joint to the FRFs across it.
    MaximumLikelihood,
    /// The fit of a constant joint to all FRFs, the fixture moving within its tolerances.
    #[serde(rename = "joint")]
    AllFrfs,
}
