//! Every tuned number of a check, with the reason for it where there is one to state, by what it is that is
//! checked.

/// How much a check may do.
pub(crate) mod work {
    /// Values of FRFs above which modes, and lines that contradict others, take longer to find than one waits
    /// for a check.
    pub(crate) const MOST_VALUES: usize = 30_000;
}

/// Modes of the fixture.
pub(crate) mod model_modes {
    /// Frequency up to which modes are looked for without a recording, Hz.
    pub(crate) const HIGHEST_HZ: f64 = 2000.0;
    /// Factor by which that grows where there is no mode.
    pub(crate) const EXTENSION: f64 = 4.0;
    /// Where that ends, Hz.
    pub(crate) const LAST_HZ: f64 = 1e6;
    /// Share of the highest frequency up to which modes are followed where a number is moved.
    pub(crate) const FOLLOWED_SHARE: f64 = 1.5;
    /// Modes that are listed at the most.
    pub(crate) const MOST_LISTED: usize = 20;
    /// Factor on the last line of a recording up to which modes matter as well.
    pub(crate) const BEYOND_BAND: f64 = 1.2;
    /// Share of the highest frequency below which a pole is at zero: rounding of a double one is the root of
    /// the machine's.
    pub(crate) const ZERO_POLE: f64 = 1e-6;
    /// Relative distance of natural frequencies with and without effects up to which a mode is the same one.
    pub(crate) const SAME_FREQUENCY: f64 = 0.1;
}

/// Deviations of totals and modes.
pub(crate) mod figures {
    /// Step by which a number of unknown deviation is moved to see whether a figure rests on it, relative;
    /// and of one that is zero.
    pub(crate) const RELATIVE_STEP: f64 = 1e-3;
    /// Relative change of a figure from which it rests on a number.
    pub(crate) const LEAST_CHANGE: f64 = 1e-9;
}

/// Numbers of the fixture file.
pub(crate) mod numbers {
    /// Damping ratio above which joints of metal are rarely found.
    pub(crate) const HIGH_DAMPING: f64 = 0.1;
    /// Relative deviation from which a number says little.
    pub(crate) const VAGUE_DEVIATION: f64 = 0.5;
    /// Deviation of a place (m) that no ruler has.
    pub(crate) const PLACE_DEVIATION: f64 = 0.05;
    /// Frequency (Hz) below which no support carries a structure: a pendulum would be a hundred metres long.
    pub(crate) const SLOWEST_SUPPORT: f64 = 0.05;
}

/// FRFs of the fixture, drawn beside the recording.
pub(crate) mod drawn {
    /// Damping ratio with which the FRFs of a fixture without any are drawn.
    pub(crate) const ASSUMED_RATIO: f64 = 0.005;
}

/// FRFs by themselves.
pub(crate) mod frfs {
    /// Coherence below which a line is poor.
    pub(crate) const POOR_COHERENCE: f64 = 0.8;
    /// Share of poor lines from which an FRF's coherence is worth a word.
    pub(crate) const MANY_POOR_LINES: f64 = 0.3;
    /// Times the median of the values about it from which a value is none of a structure's: the highest peak
    /// of a damping ratio of 1e-5 is less.
    pub(crate) const ABSURD_RATIO: f64 = 1e6;
    /// Lines on either side that are about one: over a whole band the FRFs of a row of masses may well fall
    /// by more than that.
    pub(crate) const NEIGHBOURS: usize = 20;
}

/// Lines that contradict all others.
pub(crate) mod contradictions {
    /// Steps of lines from the first within which a band starts at it: the line just there may fit by chance.
    pub(crate) const AT_START: f64 = 2.5;
}

/// Channels against each other.
pub(crate) mod channels {
    /// Mean cosine below which an FRF is turned round.
    pub(crate) const TURNED_COSINE: f64 = -0.6;
    /// Mean cosine from which it is not.
    pub(crate) const UPRIGHT_COSINE: f64 = 0.3;
    /// Factor from which a channel's level is odd beside the others'.
    pub(crate) const LEVEL_FACTOR: f64 = 1.25;
    /// Noise of a channel, relative to that of the others, from which it is odd.
    pub(crate) const NOISE_FACTOR: f64 = 5.0;
    /// The least size of a noise that is odd.
    pub(crate) const LEAST_NOISE: f64 = 0.05;
    /// Share of FRFs that must be turned for the force, which all have in common, to be so.
    pub(crate) const FORCE_SHARE: f64 = 0.8;
}

/// Signs of driving points.
pub(crate) mod driving_points {
    /// Standard deviations from which a real part stands out.
    pub(crate) const STANDS_OUT: f64 = 3.0;
    /// Lines that must.
    pub(crate) const FEWEST_LINES: usize = 8;
    /// Share of negative ones from which signs are mixed.
    pub(crate) const MIXED_SHARE: f64 = 0.03;
    /// Share of negative ones from which the channel is turned.
    pub(crate) const TURNED_SHARE: f64 = 0.8;
}

/// Pairs of FRFs that reciprocity makes equal.
pub(crate) mod reciprocity {
    /// Times its expected size from which a difference is more than noise.
    pub(crate) const TIMES_EXPECTED: f64 = 3.0;
    /// Its least size.
    pub(crate) const LEAST_DIFFERENCE: f64 = 0.05;
}

/// Modes of the recording.
pub(crate) mod recorded_modes {
    /// Orders beyond two for every mode of the model.
    pub(crate) const FURTHER_ORDERS: usize = 10;
    /// How far (ln) a mode on the supports may be from the fixture's: foam and cords are known to a fifth or a
    /// third of their stiffness.
    pub(crate) const SUSPENSION: f64 = 0.2;
    /// As many deviations, where the fixture states more.
    pub(crate) const DEVIATIONS: f64 = 3.0;
}

/// The mass line.
pub(crate) mod mass_line {
    /// Lines from this many times the highest mode on supports up to this share of the first elastic mode.
    pub(crate) const BAND: (f64, f64) = (2.5, 0.5);
    /// Fewest lines.
    pub(crate) const FEWEST_LINES: usize = 5;
    /// How far off an FRF's line may be, of the largest.
    pub(crate) const FRF_TOLERANCE: f64 = 0.1;
    /// How far off the mass may be, relative.
    pub(crate) const MASS_TOLERANCE: f64 = 0.03;
    /// Standard deviations that either must be off by.
    pub(crate) const LEAST_DEVIATIONS: f64 = 3.0;
    /// A mass is stated where the fixture's own FRFs give its mass to this share …
    pub(crate) const FIXTURE_SHARE: f64 = 0.03;
    /// … and the recording's to this one.
    pub(crate) const RECORDED_SHARE: f64 = 0.2;
    /// What a fit of few lines gets wrong at best, relative to the largest a₀.
    pub(crate) const LEAST_ERROR: f64 = 0.005;
}
