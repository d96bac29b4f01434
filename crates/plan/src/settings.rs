//! Every tuned number of a plan, with the reason for it where there is one to state, by the step that it
//! decides.

/// Which measurements are considered.
pub(crate) mod candidates {
    /// Points that are considered, where none are named.
    pub(crate) const MOST_POINTS: usize = 12;
    /// Places of a mass.
    pub(crate) const MASS_PLACES: usize = 6;
    /// An added mass as a share of its body's.
    pub(crate) const ADDED_MASS: f64 = 0.1;
    /// How well it is known, relative: a kitchen scale.
    pub(crate) const ADDED_MASS_DEVIATION: f64 = 2e-3;
    /// How well its place is known, m: a ruler.
    pub(crate) const ADDED_MASS_PLACE_DEVIATION: f64 = 3e-4;
    /// Averages in all, as a multiple of those at present.
    pub(crate) const AVERAGES: u32 = 4;
    /// What scales reach, as a share of a mass.
    pub(crate) const SCALES: f64 = 1e-4;
    /// What a calliper reaches, m.
    pub(crate) const CALLIPER: f64 = 5e-5;
    /// What a knife edge reaches, m.
    pub(crate) const KNIFE_EDGE: f64 = 1e-4;
    /// What a pendulum reaches, as a share of an inertia.
    pub(crate) const PENDULUM: f64 = 2e-3;
    /// Share of its present deviation to which a quantity must come to be worth a measurement.
    pub(crate) const NARROWER: f64 = 0.5;
}

/// The noise of a measurement to come.
pub(crate) mod noise {
    /// Lines on each side over which the floor is taken.
    pub(crate) const FLOOR_WINDOW: usize = 20;
    /// Share of a variance that the force may make where the rest of it tells the floor.
    pub(crate) const FORCE_SHARE: f64 = 0.5;
    /// Noise of a test that nobody has made: shares of |H| and of its root mean square, as standard
    /// deviations of the average.
    pub(crate) const ASSUMED: (f64, f64) = (3e-3, 3e-3);
    /// Values of an FRF that a mode's errors move: its frequency, damping and residue.
    pub(crate) const VALUES_OF_A_MODE: f64 = 3.0;
    /// Values of an observation from which lines would be left out of it.
    pub(crate) const MOST_VALUES: usize = 16_000;
}

/// Names that are compared, and what is known of them.
pub(crate) mod names {
    /// Probability below which a name is left aside.
    pub(crate) const LEAST_PROBABILITY: f64 = 0.005;
    /// Names that are compared, at the most.
    pub(crate) const MOST_NAMES: usize = 8;
    /// Cost above what its probability says at which a fit has ended in a false minimum.
    pub(crate) const FALSE_MINIMUM: f64 = 1.0;
    /// Standard deviation, in steps of a coordinate, of what nothing is known of.
    pub(crate) const UNKNOWN_DEVIATION: f64 = 3.0;
    /// The same of what is sought.
    pub(crate) const SOUGHT_DEVIATION: f64 = 1e3;
}

/// Names weighed by a further test.
pub(crate) mod further {
    /// Standard deviations that χ² per degree of freedom of the further test may be above one.
    pub(crate) const MISFIT: f64 = 4.0;
}

/// What a measurement would do for a set of names.
pub(crate) mod outcome {
    /// Draws of a measurement by each name.
    pub(crate) const DRAWS: usize = 400;
    /// Their seed.
    pub(crate) const SEED: u64 = 18;
    /// Probability from which a name is sure, and a promise counts as one.
    pub const SURE: f64 = 0.9;
    /// Share of the largest pivot below which a column adds nothing but rounding.
    pub(crate) const ROUNDING: f64 = 1e-12;
    /// ln of odds, nats, beyond which no figure means anything: linear predictions do not reach so far.
    pub const BEYOND_DOUBT: f64 = 100.0;
}

/// Which measurements are suggested, in which order.
pub(crate) mod ranking {
    /// Expected ln of the odds below which a measurement is not worth being told, nats.
    pub(crate) const LEAST_LOG_ODDS: f64 = 0.1;
    /// Probability that two names are told apart from which they count as separated.
    pub(crate) const SEPARATED: f64 = 0.9;
    /// Steps of the promise within which the effort decides.
    pub(crate) const PROMISE_STEPS: f64 = 50.0;
    /// Candidates of which measurements are drawn: the best by expectation.
    pub(crate) const MOST_DRAWN: usize = 24;
    /// FRFs that others are put beside, at the most.
    pub(crate) const MOST_COMBINED: usize = 4;
}

/// Plans for a narrower interval of a joint's element.
pub(crate) mod interval {
    /// Share of the present interval that a measurement must leave out to be worth being told.
    pub(crate) const LEAST_REDUCTION: f64 = 0.01;
    /// Half an interval beyond which the element is not determined, in stated values: what is left is what
    /// was taken to be known of it beforehand, or a fit that ran away.
    pub(crate) const UNDETERMINED: f64 = 10.0;
    /// Variance inflation from which a fit does not meet its recording.
    pub(crate) const POOR_FIT: f64 = 100.0;
    /// Measurements that are put together at the most.
    pub(crate) const MOST_TOGETHER: usize = 5;
}
