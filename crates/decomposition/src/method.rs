//! How K and C of a joint were estimated.

/// Where an estimate comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The mean over the band, eq (35) and (42).
    PlainMean,
    /// The mean weighted by the noise of each line.
    WeightedMean,
    /// The fit of a constant joint to the FRFs across it.
    MaximumLikelihood,
    /// The fit of a constant joint to all FRFs, the fixture moving within its tolerances.
    AllFrfs,
}
