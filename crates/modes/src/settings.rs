//! Every tuned number of a modal analysis, with the reason for it where there is one to state, by the step
//! that it decides.
//!
//! Guards against rounding and against division by zero, which decide nothing, stand where they are used.

/// Poles by order.
pub(crate) mod orders {
    /// Fewest lines that a mode can be told from.
    pub(crate) const FEWEST_LINES: usize = 8;
    /// Share of the unit circle that the band is laid on; poles a little outside of the band lie in the rest.
    pub(crate) const BAND_ARC: f64 = 0.85;
    /// Growth, as a share of the lines' spacing, up to which a pole that does not decay may be one that
    /// hardly does: noise makes either of it. What is mere arithmetic grows faster.
    pub(crate) const UNDAMPED_GROWTH: f64 = 0.1;
    /// Poles of the highest order that is gone to unasked, over all columns.
    pub(crate) const USUAL_POLES: usize = 60;
    /// That order is no lower where columns are many, as far as the lines determine it.
    pub(crate) const LEAST_HIGHEST_ORDER: usize = 10;
    /// Lines for each pole of that order, at the least.
    pub(crate) const LINES_PER_POLE: usize = 3;
    /// Poles of the highest order that can be asked for, over all columns.
    pub(crate) const MOST_POLES: usize = 400;
    /// Fewest orders that a pole can be stable over.
    pub(crate) const FEWEST_ORDERS: usize = 3;
}

/// Poles that stay from order to order.
pub(crate) mod stabilization {
    /// Frequencies that agree to this share are stable.
    pub(crate) const STABLE_FREQUENCY: f64 = 0.002;
    /// Damping ratios that agree to this share are stable.
    pub(crate) const STABLE_DAMPING: f64 = 0.1;
    /// A pole follows one this far away, as a share of the frequency. It is the farthest of this reach and
    /// the next two that counts.
    pub(crate) const FOLLOWED_FREQUENCY: f64 = 0.002;
    /// The same in half-widths.
    pub(crate) const FOLLOWED_HALF_WIDTHS: f64 = 1.0;
    /// The same as a share of the lines' spacing.
    pub(crate) const FOLLOWED_SPACING: f64 = 0.5;
    /// Orders that a track may miss.
    pub(crate) const MISSED_ORDERS: usize = 2;
}

/// Which poles are modes.
pub(crate) mod selection {
    /// Share of the orders that a candidate's track is seen at.
    pub(crate) const SEEN_SHARE: f64 = 0.2;
    /// How many orders that is at the least.
    pub(crate) const FEWEST_SEEN: usize = 3;
    /// Candidates that are looked at, those of the longest tracks.
    pub(crate) const MOST_CANDIDATES: usize = 50;
    /// Damping ratio above which a pole is no resonance.
    pub(crate) const OVERDAMPED: f64 = 0.5;
    /// How far outside the lines a pole may lie that is kept for what it does inside, as a share of the band.
    pub(crate) const OUTSIDE_BAND: f64 = 0.05;
    /// Rise of χ² that a mode must be worth, in natural logarithms of the number of values for each of its
    /// unknowns.
    pub(crate) const WORTH: f64 = 1.5;
    /// Steps of a search between which poles that are worth nothing are taken out: what is left is searched
    /// for again.
    pub(crate) const UNSETTLED_STEPS: usize = 4;
    /// Half-widths of both together up to which poles are near each other: of these one at a time is taken
    /// out, since one of two poles at one place makes the other worthless.
    pub(crate) const NEAR_HALF_WIDTHS: f64 = 20.0;
    /// Share of the frequency that is added to that.
    pub(crate) const NEAR_FREQUENCY: f64 = 0.01;
    /// Worth below which a mode must show that the others, moved a little, do not make up for it.
    pub(crate) const DOUBTFUL_WORTH: f64 = 10.0;
    /// Deviation of a frequency, in half-widths, above which a mode must show the same.
    pub(crate) const DOUBTFUL_DEVIATION: f64 = 0.5;
    /// How near a pick has to be to a pole, as a share of its frequency: it is read off a chart, to a percent
    /// or so.
    pub(crate) const PICK_REACH: f64 = 0.01;
    /// Spacings of the lines that it may be off in any case.
    pub(crate) const PICK_SPACINGS: f64 = 2.0;
    /// Share of that reach within which columns of poles are equally near a pick: the one that is seen at
    /// most orders is meant.
    pub(crate) const PICK_ALIKE: f64 = 0.1;
}

/// Residual terms.
pub(crate) mod residual_terms {
    /// Residual terms of each FRF, at most.
    pub(crate) const MOST_TERMS: usize = 8;
    /// Fall of χ² for a further residual term, in natural logarithms of the number of values for each of its
    /// unknowns.
    pub(crate) const TERM_WORTH: f64 = 1.0;
}

/// The search for the most likely poles.
pub(crate) mod likelihood {
    use jointscope_inference::{Convergence, StepDamping};

    /// Steps of the damped Gauss–Newton search, at most.
    pub(crate) const MOST_STEPS: usize = 40;
    /// Damping of its steps.
    pub(crate) const STEP_DAMPING: StepDamping =
        StepDamping { initial: 1e-4, decrease: 0.1, least: 1e-12, raised: 1e-4, most: 1e8 };
    /// χ² falls by less than this: done. Noise alone moves it by far more.
    pub(crate) const CONVERGED: Convergence = Convergence { gain: 1e-3, share: 0.0, floor: 0.0 };
    /// Half-widths that a pole moves by in a step, at most.
    pub(crate) const MOST_HALF_WIDTHS: f64 = 4.0;
    /// Change of ln σ in a step, at most.
    pub(crate) const MOST_GROWTH: f64 = 1.0;
}

/// What is said of a fit and its modes.
pub(crate) mod quality {
    /// χ² per degree of freedom above which poles that all FRFs share do not explain them.
    pub(crate) const POOR_FIT: f64 = 1.3;
    /// Share of a damping ratio above which its deviation leaves little of it.
    pub(crate) const VAGUE_DAMPING: f64 = 0.3;
}

/// Each FRF by itself, near the poles of all.
pub(crate) mod each_frf {
    /// Fewest FRFs from which a scatter, or a drift, is told.
    pub(crate) const FEWEST_FRFS: usize = 3;
    /// Half-widths by which an FRF's pole may stand off that of all, and by how much (in ln σ) be wider: one
    /// standard deviation.
    pub(crate) const HELD: (f64, f64) = (3.0, 1.5);
    /// Steps of each FRF's own search.
    pub(crate) const OWN_STEPS: usize = 12;
}

/// Resonances that are not at one place in all FRFs.
pub(crate) mod drift {
    /// An FRF counts where it knows the frequency of its pole to this share of a half-width.
    pub(crate) const KNOWN_FREQUENCY: f64 = 0.3;
    /// And its σ to this share.
    pub(crate) const KNOWN_DAMPING: f64 = 0.25;
    /// Standard deviations by which the FRFs' differences must exceed their noise.
    pub(crate) const BEYOND_NOISE: f64 = 5.0;
    /// A drift of less than this share of the half-width is left to the noise.
    pub(crate) const LEAST_DRIFT: f64 = 0.02;
    /// Fall of χ² for each pole of its own, over its residual noise, that poles of their own must bring.
    pub(crate) const OWN_POLE_WORTH: f64 = 2.5;
    /// Relative precision to which the variance of a drift is found.
    pub(crate) const VARIANCE_PRECISION: f64 = 1e-9;
    /// Poles nearer to each other than this share of their half-widths together stand at one place.
    pub(crate) const ONE_PLACE: f64 = 0.7;
}

/// Noise from what the modes leave.
pub(crate) mod noise {
    /// Half-width in lines of the window of the floor, which varies slowly.
    pub(crate) const FLOOR_WINDOW: usize = 25;
    /// Half-width of the window of the share, in parts of all lines: all resonances within it tell the share
    /// together.
    pub(crate) const SHARE_WINDOW_PARTS: usize = 2;
    /// Passes of weights from the fit before.
    pub(crate) const PASSES: usize = 8;
    /// Squared residuals beyond this many times their expected size count as this many.
    pub(crate) const MOST_OVER_EXPECTED: f64 = 12.0;
    /// Steps of each FRF's own fit.
    pub(crate) const EACH_FIT_STEPS: usize = 8;
    /// Smallest relative noise that is believed, as in `jointscope_frf::noise`.
    pub(crate) const LEAST_NOISE: f64 = 1e-5;
    /// What others of the FRFs say of the share counts this much of what an FRF says itself: an FRF without a
    /// line on which the share shows believes the others.
    pub(crate) const FROM_OTHERS: f64 = 0.3;
    /// A line whose own noise the modes follow to more than this share tells nothing about it.
    pub(crate) const MOST_FOLLOWED: f64 = 0.7;
    /// A share that is not told at all is taken for this much, a noise of 1 %.
    pub(crate) const UNTOLD_SHARE: f64 = 1e-4;
}

/// Lines that are averaged before a search.
pub(crate) mod merged_lines {
    /// So many lines are all kept.
    pub(crate) const FEW_LINES: usize = 2000;
    /// Lines over this share of the distance to the nearest pole are averaged: what is curved over them is
    /// 1e-4 of the FRF.
    pub(crate) const SMOOTH: f64 = 0.03;
}

/// A record of another scale than the others.
pub(crate) mod uneven_scale {
    /// Share of the half-bandwidth within which two poles are one.
    pub(crate) const SAME_POLE: f64 = 0.1;
    /// Fewest modes that must be there twice: one may be two that are close.
    pub(crate) const FEWEST: usize = 2;
    /// How far apart a factor may be from mode to mode, and a minor of the others from nothing: what a record
    /// that is off by less makes of modes noise may make, too.
    pub(crate) const ALIKE: f64 = 0.1;
}

/// Measured modes and those of a model.
pub(crate) mod matching {
    /// Frequencies apart by more than this share are of different modes.
    pub(crate) const MOST_SHIFT: f64 = 0.25;
    /// Shapes of a MAC below this are of different modes.
    pub(crate) const LEAST_MAC: f64 = 0.6;
    /// What frequency and shape may lack together: a model a quarter off in frequency must at least have the
    /// shape.
    pub(crate) const LACKING: f64 = 0.4;
    /// What a shift of the frequency counts beside shapes: a tenth of it like shapes that are not alike at
    /// all.
    pub(crate) const SHIFT_WEIGHT: f64 = 10.0;
}
