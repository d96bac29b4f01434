//! Numbers of effects: where a search for them sets out, how far they may go, and how common they are.

/// Quantities that are stated wrongly.
pub(crate) mod quantities {
    pub(crate) use jointscope_tolerances::DEPARTED;

    /// Standard deviations beyond which nobody believes a quantity where lines are not explained for it: a
    /// bungee of 200 N/m was to have 11.7 kN/m, 460 deviations off, and a point mass 220.
    pub(crate) const BEYOND_BELIEF: f64 = 10.0;
    /// Departures from which a search for a wrong quantity sets out, as multiples of that which the refit
    /// made: what else it bent was bent in its stead.
    pub(crate) const DEPARTURES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
    /// Factors by which the stiffness of a support may have changed since a baseline, to set out from.
    pub(crate) const CHANGES_OF_SUPPORTS: [f64; 5] = [0.3, 0.55, 0.8, 1.25, 2.0];
    /// Least standard deviation of a quantity that is wrong, in stated ones: a slip of the calliper or the
    /// scales is many of them. One that sets out farther, as a wrong sign or decimal point asks for, may lie
    /// anywhere that far: a narrower expectation would bend the rest of the fixture to bring it back.
    pub(crate) const EXPECTED_ERROR: f64 = 10.0;
}

/// Starts of an effect's parameters.
pub(crate) mod starts {
    /// Places along a beam from which a search sets out, by half-wave of the highest mode: between two of
    /// them what something on the beam does to that mode changes once.
    pub(crate) const PLACES_A_HALF_WAVE: f64 = 2.0;
    /// Half-waves that are reckoned with at the least: they make three places.
    pub(crate) const FEWEST_HALF_WAVES: f64 = 1.5;
    /// Half-waves beyond which no more places are tried.
    pub(crate) const MOST_HALF_WAVES: f64 = 12.0;
    /// Share of the highest line below which no frequency is tried: a band that begins at next to nothing
    /// would take most starts on a logarithmic scale to where nothing happens.
    pub(crate) const LOWEST_FREQUENCY: f64 = 0.02;
    /// Least length of a joint that starts of lengths are measured by, m: of one without any length they
    /// would all be the same.
    pub(crate) const LEAST_LENGTH: f64 = 0.01;
}

/// How parameters move, and how far.
pub(crate) mod bounds {
    /// Unit in which abscissae move, as a share of the body's extent.
    pub(crate) const ABSCISSA_UNIT: f64 = 0.1;
    /// Least factor that an effect is scaled to where it must stay positive: no farther than this does a
    /// straight line lead.
    pub(crate) const LEAST_FACTOR: f64 = 0.5;
    /// The largest.
    pub(crate) const MOST_FACTOR: f64 = 2.0;
    /// Share of a joint's length that may be missing.
    pub(crate) const MISSING_LENGTH: f64 = 0.95;
    /// Share of a beam's mass that may be missing at one place: a hole that takes more is no point, and takes
    /// stiffness with it.
    pub(crate) const MISSING_OF_BEAM: f64 = 0.05;
    /// Masses of the whole structure that may be added.
    pub(crate) const ADDED_MASSES: f64 = 2.0;
    /// Share of a bar's length by which a body of the bar's mass and inertia is longer at either end if half
    /// of its mass is in its middle.
    pub(crate) const BEYOND_BAR: f64 = 0.5 * (std::f64::consts::SQRT_2 - 1.0);
    /// Height of what sits on a block above its axis, in radii of gyration, at most: the faces of a cube are
    /// 1.2 away, and what stands on them is no higher than the block.
    pub(crate) const FARTHEST_ACROSS: f64 = 3.0;
}

/// How common effects are.
pub(crate) mod rarity {
    /// ln of the odds against a joint that is longer than the points at its ends say: what gives way at an
    /// end, a layer of glue above all, makes it seem longer, and is held for five times as common as a length
    /// that somebody got wrong.
    pub(crate) const LONGER_JOINT: f64 = 1.6;
}

/// Derivatives by differences.
pub(crate) mod differences {
    /// Step of a coordinate, in its units, to a neighbouring fixture whose matrices tell derivatives: halfway
    /// between what they curve by and what rounding leaves of them.
    pub(crate) const COORDINATE_STEP: f64 = 1e-6;
}
