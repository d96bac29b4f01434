//! Numbers of probabilities and of what counts as explained. What a caller may set of them stands in
//! `EvidenceSettings`.

/// What no hypothesis covers.
pub(crate) mod unlisted {
    /// Cost of physics that none covers, at the least, above the best hypothesis': it then weighs e⁵ times as
    /// much, and a worse fit makes no difference.
    pub(crate) const LEAST_COST: f64 = -10.0;
}

/// Fits that must not leave a tenth of the noise more. Where nothing but the FRFs' scatter tells the noise,
/// none is judged as strictly.
pub(crate) mod strictly {
    /// Share of the uncertainty of the noise's variances that is allowed for.
    pub(crate) const UNCERTAINTY_SHARE: f64 = 0.5;
    /// Standard deviations that χ² per degree of freedom may be above one.
    pub(crate) const MOST_EXCESS: f64 = 2.0;
}
