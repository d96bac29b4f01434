//! Numbers of what is said of a diagnosis: from when on a difference is worth a word.

/// Changes from a state that was known to be right.
pub(crate) mod baseline {
    /// Standard deviations beyond which a change of a mode is more than noise.
    pub(crate) const MORE_THAN_NOISE: f64 = 3.0;
    /// χ² per degree of freedom of the lines now, by the fixture as the baseline's lines have it, from which
    /// these are asked for what has changed.
    pub(crate) const MISSES: f64 = 3.0;
    /// Share of its stated deviation by which a quantity may be off that a baseline has put in its place …
    pub(crate) const LEFT_BY_BASELINE: f64 = 0.2;
    /// … and of its value, where it was not stated at all.
    pub(crate) const LEFT_UNKNOWN: f64 = 1e-3;
    /// Modes from which a change that they share is no coincidence.
    pub(crate) const FEWEST_ALIKE: usize = 3;
    /// Share of a change by which the modes that share it may differ.
    pub(crate) const ALIKE: f64 = 0.05;
}

/// Findings.
pub(crate) mod findings {
    /// Share of a finding's probability from which another place of it is to be reckoned with.
    pub(crate) const LIKELY_SHARE: f64 = 0.05;
    /// Share of tests in which chance does as well, from which on the name that came nearest to a finding is
    /// not told.
    pub(crate) const LEAST_BY_CHANCE: f64 = 0.5;
    /// How close to the other point an offset must lead, as a share of the distance between the two, for two
    /// points to have been taken for each other.
    pub(crate) const EXCHANGED_WITHIN: f64 = 0.1;
}

/// A record that is another multiple of what the fixture makes of it than the others.
pub(crate) mod odd_record {
    /// Share of what the refitted fixture misses of the FRFs, from which on what was found leaves much.
    pub(crate) const LEFT: f64 = 0.5;
    /// Fewest records among which one stands alone.
    pub(crate) const FEWEST: usize = 3;
    /// ln of the multiple by which it stands apart from the next, at the least: a tenth is what strikes
    /// repeat to.
    pub(crate) const APART: f64 = 0.1;
    /// How many times as far as the others from each other.
    pub(crate) const OTHERS: f64 = 3.0;
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
    /// Variance of ln |δ| that every line has besides: none is known to better than a hundredth, or few lines
    /// would decide alone.
    pub(crate) const LEAST_VARIANCE: f64 = 1e-4;
    /// Departures of the logarithm from a straight line beyond which δ follows no power of frequency.
    pub(crate) const NO_POWER: f64 = 0.7;
    /// Length of the mean direction of δ below which its phase changes over the band.
    pub(crate) const ONE_PHASE: f64 = 0.7;
    /// How many times the other part of that direction its real or imaginary part must be for δ to be called
    /// real or imaginary.
    pub(crate) const ONE_PART: f64 = 2.0;
}
