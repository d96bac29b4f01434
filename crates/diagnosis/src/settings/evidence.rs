//! Numbers of probabilities and of what counts as explained. What a caller may set of them stands in
//! `EvidenceSettings`.

/// What no hypothesis covers.
pub(crate) mod unlisted {
    /// ln of the weight of physics that none covers, against one for the best hypothesis, at the most: a worse
    /// fit makes no difference then.
    pub const MOST_UNLISTED: f64 = 5.0;
}

/// Fits that must not leave a tenth of the noise more. Where nothing but the FRFs' scatter tells the noise,
/// none is judged as strictly.
pub(crate) mod strictly {
    /// Share of the uncertainty of the noise's variances that is allowed for.
    pub(crate) const UNCERTAINTY_SHARE: f64 = 0.5;
    /// Standard deviations that χ² per degree of freedom may be above one.
    pub(crate) const MOST_EXCESS: f64 = 2.0;
}
