//! Every tuned number of the estimation of FRFs from hits, with the reason for it where there is one to
//! state, by the question that it decides.
//!
//! Guards against rounding, and factors that follow from the normal distribution or from a window's form,
//! stand where they are used.

/// Hits that an estimate is made of.
pub(crate) mod hits {
    /// Fewest samples of a record.
    pub(crate) const FEWEST_SAMPLES: usize = 16;
    /// Relative difference up to which sampling intervals are the same.
    pub(crate) const SAME_INTERVAL: f64 = 1e-6;
}

/// Where a hit begins and ends.
pub(crate) mod pulse {
    /// Share of the peak at which a pulse begins and ends.
    pub(crate) const EDGE: f64 = 0.05;
    /// Samples about a pulse in which an anti-alias filter rings.
    pub(crate) const FILTER_RINGING: usize = 16;
    /// Widths of the pulse before it that do not count as quiet, if they are more than that.
    pub(crate) const WIDTHS_BEFORE: usize = 2;
}

/// Offsets and drifts.
pub(crate) mod baseline {
    /// Samples beyond so many deviations from the middle belong to the hit or its ringing.
    pub(crate) const FAR: f64 = 3.0;
    /// Fewest samples before the hit from which an offset or a mean square is taken.
    pub(crate) const FEWEST_BEFORE: usize = 24;
    /// Passes, each through the samples near the line of the pass before.
    pub(crate) const LINE_PASSES: usize = 3;
}

/// Mains hum.
pub(crate) mod hum {
    /// Frequencies of the world's mains, Hz.
    pub(crate) const MAINS_HZ: [f64; 2] = [50.0, 60.0];
    /// Relative difference from them that is looked at: grids keep to a fifth of this, and a card's clock is
    /// better still.
    pub(crate) const WANDERS: f64 = 0.01;
    /// Frequencies tried in one width of what a record's end resolves: over the whole record the phase of the
    /// mains turns by less than half a radian from one to the next.
    pub(crate) const STEPS_IN_LINE: f64 = 16.0;
    /// Frequencies tried between two of these about the best: the highest multiple asks for it.
    pub(crate) const FINER: f64 = 16.0;
    /// Multiples looked at: rectifiers show up to there.
    pub(crate) const HARMONICS: usize = 11;
    /// Above all of them, Hz.
    pub(crate) const HIGHEST_HZ: f64 = 670.0;
    /// Share of the sampling rate above which a filter falls off.
    pub(crate) const BELOW_FILTER: f64 = 0.4;
    /// Times the length of a record's end to which it is filled with zeros.
    pub(crate) const PADDING: usize = 4;
    /// Shortest quiet before a blow that can confirm a hum, s: half a period.
    pub(crate) const LEAST_BEFORE_S: f64 = 0.01;
    /// Fewest periods in the quiet half of a record.
    pub(crate) const FEWEST_PERIODS_AFTER: f64 = 8.0;
    /// Lines beside a tone, in widths of the end's own resolution, that it has to stand out of: beyond the
    /// Hann window's main lobe.
    pub(crate) const ASIDE: [f64; 3] = [2.5, 3.5, 5.0];
    /// Times what lies beside it: noise alone does so on one line of many thousands.
    pub(crate) const STANDS_OUT: f64 = 4.0;
    /// Share of it by which a tone differs from blow to blow, over the force, up to which it is the structure's
    /// answer: of two blows hum is as near by chance in one test of a hundred, of more in none.
    pub(crate) const SAME_AFTER_BLOW: f64 = 0.1;
    /// Gain in the logarithm of the likelihood before the blows from which a tone is hum: that a tone picked
    /// from eleven multiples at a hundred frequencies gains as much by chance has odds below one in a
    /// thousand.
    pub(crate) const EXPLAINS: f64 = 14.0;
}

/// What of a response is left when its record ends.
pub(crate) mod ringing_left {
    /// Parts into which the time after the hit is cut.
    pub(crate) const PARTS: usize = 40;
    /// Power above the noise by which a part still shows the ringing.
    pub(crate) const RINGING_SHOWS: f64 = 3.0;
    /// Times the power of the quietest part that the noise is taken for, at most.
    pub(crate) const NOISE_OVER_QUIETEST: f64 = 2.0;
    /// Fewest parts that show the ringing from which its fall is told.
    pub(crate) const FEWEST_SHOWN: usize = 4;
    /// Parts of these that the fall is read from, at the least: the slower half, if that is more.
    pub(crate) const FEWEST_ON_LINE: usize = 3;
}

/// Signals that their input cut off.
pub(crate) mod overload {
    /// Samples at one extreme value that a signal of its own does not hold.
    pub(crate) const HELD_SAMPLES: usize = 3;
    /// The same where the samples beside them lie `CLIFF_STEPS` steps of the converter below.
    pub(crate) const HELD_BETWEEN_CLIFFS: usize = 2;
    /// Steps below a top of which chance makes two samples equal in one blow of a thousand.
    pub(crate) const CLIFF_STEPS: f64 = 1000.0;
    /// Relative difference within which samples of two hits are the same value.
    pub(crate) const SAME_VALUE: f64 = 1e-9;
    /// Steps of the converter by which the samples beside a cut-off top lie below it.
    pub(crate) const FLANK_STEPS: f64 = 4.0;
    /// Smallest share of the range that such a step is taken to be, for signals that were scaled since.
    pub(crate) const FINEST_STEP: f64 = 1e-6;
    /// Share of the larger extreme from which the other one may be a cut-off top as well.
    pub(crate) const EXTREME_SHARE: f64 = 0.5;
    /// Samples from which the converter's step is told.
    pub(crate) const SAMPLES_LOOKED_AT: usize = 4096;
    /// Share of that step by which a distance of two values is off a whole number of steps.
    pub(crate) const OFF_THE_GRID: f64 = 0.05;
}

/// Hits that are no good for an FRF.
pub(crate) mod faults {
    /// A later strike below this share of the first does no harm that the noise does not.
    pub(crate) const SECOND_STRIKE: f64 = 0.05;
    /// A strike is one-sided; what swings to the other side as far is a filter's ringing. Ratio of the peak
    /// to the other side.
    pub(crate) const ONE_SIDED: f64 = 1.5;
    /// Between two strikes the force falls below this share of the lower peak.
    pub(crate) const VALLEY: f64 = 0.7;
    /// An impact stands out of the noise by this factor.
    pub(crate) const STANDS_OUT: f64 = 10.0;
    /// A response is a hammer's pulse that stands out by so many times as much.
    pub(crate) const RESPONSE_STANDS_OUT: f64 = 5.0;
    /// Times the share of the peak at which a pulse begins, from which the first sample shows the hammer in
    /// contact.
    pub(crate) const IN_CONTACT: f64 = 2.0;
    /// Energy to the other side, relative to that to the peak's side, above which a signal rings.
    pub(crate) const TO_AND_FRO: f64 = 0.3;
}

/// Windows on demand.
pub(crate) mod windows {
    /// Widths of the pulse from its onset that the force's window passes: the pulse, and ten of them after
    /// it.
    pub(crate) const FORCE_WINDOW_WIDTHS: usize = 11;
    /// Part of its length in which it then falls to zero: a quarter.
    pub(crate) const TAPER_PARTS: usize = 4;
    /// What an exponential window on demand leaves of the slowest response.
    pub(crate) const LEFT_BY_WINDOW: f64 = 1e-4;
    /// Line spacings below which lines are left out under a window, beside its own width.
    pub(crate) const LOWEST_SPACINGS: f64 = 4.0;
    /// Share of the usable band that is left out below, at most.
    pub(crate) const MOST_LEFT_OUT: f64 = 0.1;
}

/// Noise of the force.
pub(crate) mod force_noise {
    /// Share of the force's power on a line that may be taken off as its noise: of more nothing is known.
    pub(crate) const MOST_NOISE_OF_FORCE: f64 = 0.5;
}

/// Which lines the hammer excites.
pub(crate) mod band {
    /// Power below this share of the largest excites too little: 20 dB.
    pub(crate) const WEAK: f64 = 0.01;
    /// An anti-alias filter falls off above this share of half the sampling rate.
    pub(crate) const BELOW_FILTER: f64 = 0.8;
    /// Dips narrower than one of so many parts of all lines are bridged.
    pub(crate) const DIP_PARTS: usize = 50;
    /// Power below this share of its neighbourhood's median is a dip.
    pub(crate) const DEEP: f64 = 0.03;
}

/// How much each hit counts.
pub(crate) mod weights {
    /// Hits whose noise differs by more than this factor in amplitude are weighted.
    pub(crate) const UNEQUAL: f64 = 1.5;
    /// Fewest lines from which the hits' noise is told.
    pub(crate) const FEWEST_LINES: usize = 10;
    /// Lines of many from which it is told.
    pub(crate) const LINES_LOOKED_AT: usize = 1_000;
    /// Passes in which each hit's noise is told with the weights of the pass before, at most.
    pub(crate) const WEIGHT_PASSES: usize = 40;
    /// Factor by which the power of a noise changes in a pass, least and largest.
    pub(crate) const PASS_RANGE: (f64, f64) = (0.1, 10.0);
    /// Relative change of all of them in a pass below which there is no further one.
    pub(crate) const SETTLED: f64 = 1e-3;
    /// Noise of two hits differs by no more than this, or it is not noise.
    pub(crate) const MOST_RATIO: f64 = 1e4;
    /// Share of an average from which it is one hit's alone, and the coherence from which on what others differ
    /// from that one by is no noise.
    pub(crate) const ALONE: (f64, f64) = (0.9, 0.5);
    /// What the leverage of a hit leaves its residuals of freedom, at the least: the stronger of two very
    /// unequal hits has next to none.
    pub(crate) const LEAST_FREEDOM: f64 = 1e-3;
}

/// What a reader of the FRFs should know.
pub(crate) mod remarks {
    /// What may be left of a response at its record's end without a remark.
    pub(crate) const LEFT_UNNOTICED: f64 = 3e-3;
    /// Deviations of a baseline's slope from none at which it is called a drift.
    pub(crate) const DRIFTS: f64 = 30.0;
    /// Share of the first line that a drift makes up from which it shows.
    pub(crate) const DRIFT_OF_FIRST_LINE: f64 = 0.1;
    /// Share of the peak that is part of the pulse or of the loudest ringing.
    pub(crate) const PULSE: f64 = 0.1;
    /// Ringing before a hit relative to its loudest response.
    pub(crate) const RINGS_BEFORE: f64 = 0.01;
    /// Power before the hit over that before the quietest one, beyond which it rings: what is there before
    /// every hit is noise.
    pub(crate) const RINGS_OVER_QUIETEST: f64 = 9.0;
    /// Ratio of powers from which hits disagree by more than their noise.
    pub(crate) const DISAGREE: f64 = 4.0;
    /// Bias of H1 that is worth a word.
    pub(crate) const BIASED: f64 = 1e-3;
    /// Share of the driving point's |H|² on lines where the force takes energy out, beyond which a sign is
    /// wrong.
    pub(crate) const TAKES_OUT: f64 = 0.7;
    /// Relative difference of two FRFs that should be the same.
    pub(crate) const NOT_RECIPROCAL: f64 = 0.3;
}
