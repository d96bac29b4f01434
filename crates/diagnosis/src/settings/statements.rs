//! Numbers of what is said of a diagnosis: from when on a difference is worth a word.

/// Changes from a state that was known to be right.
pub(crate) mod baseline {
    /// Standard deviations beyond which a change of a mode is more than noise.
    pub(crate) const MORE_THAN_NOISE: f64 = 3.0;
}

/// Findings.
pub(crate) mod findings {
    /// Share of a finding's probability from which another place of it is to be reckoned with.
    pub(crate) const LIKELY_SHARE: f64 = 0.05;
    /// Share of tests in which chance does as well, from which on the name that came nearest to a finding is not told.
    pub(crate) const LEAST_BY_CHANCE: f64 = 0.5;
    /// How close to the other point an offset must lead, as a share of the distance between the two, for two points to have been taken for each other.
    pub(crate) const EXCHANGED_WITHIN: f64 = 0.1;
}

/// What the best model leaves.
pub(crate) mod residuals {
    /// Correlation of neighbouring lines from which residuals are not called white.
    pub(crate) const NOT_WHITE: f64 = 0.2;
    /// Ratio of the relative errors at the ends of the band from which they count as different.
    pub(crate) const UNEVEN: f64 = 2.0;
}

/// How δ(ω), what is missing at a place, varies.
pub(crate) mod variation {
    /// Standard deviations that δ is from nothing on a line that counts, at the least.
    pub(crate) const KNOWN: f64 = 2.0;
    /// Fewest such lines that tell.
    pub(crate) const FEWEST_LINES: usize = 8;
    /// Variance of ln |δ| that every line has besides: none is known to better than a hundredth, or few lines would decide alone.
    pub(crate) const LEAST_VARIANCE: f64 = 1e-4;
    /// Departures of the logarithm from a straight line beyond which δ follows no power of frequency.
    pub(crate) const NO_POWER: f64 = 0.7;
    /// Length of the mean direction of δ below which its phase changes over the band.
    pub(crate) const ONE_PHASE: f64 = 0.7;
    /// How many times the other part of that direction its real or imaginary part must be for δ to be called real or imaginary.
    pub(crate) const ONE_PART: f64 = 2.0;
}
