//! Numbers of what a search takes from a recording: which FRFs and lines, what their noise is, and what is
//! wrong with them.

/// Long recordings, of which some lines are used.
pub(crate) mod recordings {
    /// FRFs from which not all of them are searched, unless more are needed to show every channel.
    pub(crate) const SEARCHED_FRFS: usize = 16;
    /// Lines up to which all of them are used …
    pub(crate) const ALL_LINES: usize = 4000;
    /// … unless the searched FRFs have more values than this on them.
    pub(crate) const ALL_VALUES: usize = 16_000;
    /// Lines that are kept of a longer one, at the most.
    pub(crate) const KEPT_LINES: usize = 900;
    /// Share of these that are evenly spread.
    pub(crate) const EVEN_SHARE: f64 = 0.39;
    /// Lines about a resonance are kept one by one up to this distance and ever more rarely beyond, in
    /// proportion to it: the first that keeps the limit.
    pub(crate) const ONE_BY_ONE: [usize; 10] = [64, 48, 32, 24, 16, 12, 8, 6, 4, 2];
}

/// What is searched of many values.
pub(crate) mod searched {
    /// Values up to which all lines are searched.
    pub(crate) const ALL_VALUES: usize = 10_000;
    /// Values that are searched of more than these …
    pub(crate) const SEARCHED_VALUES: usize = 8000;
    /// … with so many lines at the least.
    pub(crate) const FEWEST_LINES: usize = 250;
}

/// What is not searched, to judge what was found by it.
pub(crate) mod held_out {
    /// Where the two bands begin, as shares of the lines: at about a third and two thirds, neither the stiff
    /// nor the massy end alone.
    pub(crate) const BANDS: [f64; 2] = [0.3, 0.62];
    /// Fewest lines, in widths of a band: of fewer nothing can be spared.
    pub(crate) const FEWEST_WIDTHS: usize = 10;
    /// Fewest FRFs of which one is held out besides.
    pub(crate) const FEWEST_FRFS: usize = 4;
}

/// Noise.
pub(crate) mod noise {
    /// Relative uncertainty of variances from coherence, which are smoothed over lines.
    pub(crate) const COHERENCE_UNCERTAINTY: f64 = 0.04;
    /// The same from scatter, which rest on the lines nearby alone.
    pub(crate) const SCATTER_UNCERTAINTY: f64 = 0.2;
    /// Lines on each side over which the local level is taken.
    pub(crate) const LEVEL_WINDOW: usize = 20;
    /// Share of the local mean square that counts as signal beside a value's own: in an antiresonance a value
    /// has next to none.
    pub(crate) const LEVEL_SHARE: f64 = 0.1;
}

/// Lines that contradict all others.
pub(crate) mod contradiction {
    /// χ² of a line, per value, from which it contradicts, as a multiple of the median line's.
    pub(crate) const CONTRADICTS: f64 = 25.0;
    /// Share of the lines that may.
    pub(crate) const MOST_SHARE: f64 = 0.08;
    /// χ² per degree of freedom of a free fit from which lines are looked for.
    pub(crate) const MISFIT: f64 = 2.0;
    /// What their absence must leave of it, at the most.
    pub(crate) const REMAINING_SHARE: f64 = 0.3;
    /// Lines from one break to the next of what was clipped, at most.
    pub(crate) const MOST_BETWEEN_BREAKS: usize = 12;
    /// Lines about a mode of the fixture in which a single line is not taken for wrong.
    pub(crate) const NEAR_MODE: usize = 3;
    /// Rounds in which more of them are found: a fit that has to follow a wrong line hides its neighbours.
    pub(crate) const ROUNDS: usize = 4;
}

/// FRFs that fall short by the noise of the force.
pub(crate) mod force_noise {
    /// Largest shortfall that is reckoned with: of what is mostly noise nothing is known.
    pub(crate) const MOST_SHORTFALL: f64 = 0.5;
}
