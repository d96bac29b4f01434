//! Numbers of fits to the modes of a recording, by the question that each decides. What a caller may set of
//! them stands in `ModalSettings`.

/// Modes of the recording by themselves.
pub(crate) mod recorded {
    /// Orders of a free fit beside those of the modes that a model may have, where nothing but the FRFs tells
    /// their noise.
    pub(crate) const SPARE_ORDERS: usize = 8;
}

/// Sizes of a model's error.
pub(crate) mod sizes {
    use jointscope_model_error::ErrorSizes;

    /// Share of the usual size below which an error is none: ten times the least that is tried.
    pub(crate) const NEGLIGIBLE: f64 = 10.0 * ErrorSizes::LEAST;
    /// Multiple of the usual error of gains beyond which a channel's is no error of them: one record of many
    /// that is a tenth too large is the very thing that a name says.
    pub(crate) const BEYOND_ERRORS: f64 = 4.0;
    /// Times by which such errors of gains are larger with a name than without where the name makes them.
    pub(crate) const DISTURBED: f64 = 1.5;
    /// Share of what the fixture states as deviations of damping ratios that counts as the usual error of
    /// them at the least: nobody claimed to know them better than these.
    pub(crate) const LEAST_OF_STATED_DAMPING: f64 = 0.5;
    /// Times the usual error of shapes that counts as usual where a fit stands or falls: blocks that bend,
    /// strips with a mass and feet that yield leave shapes of blocks and beams of steel 1.4 to 2.5 % off whose
    /// natural frequencies are right to 0.3 %. Among names the usual one still decides; and in quadrature, where
    /// dashpots under two blocks showed by 0.18 % alone.
    pub(crate) const STANDING_SHAPE: f64 = 3.0;
    /// What a fit may lose in ln p by errors that are held at a limit and is as probable all the same. Beside
    /// its dashpot a spring to ground on a solid has damping wrong by 1.5 or by 2.2 times what was stated
    /// with ln p 0.03 apart, whichever the fit comes to.
    pub(crate) const AS_PROBABLE: f64 = 0.1;
}

/// What is known of coordinates beforehand, as standard deviations of them.
pub(crate) mod prior {
    /// In units of the coordinate, of a quantity of which nothing is known: its own size.
    pub(crate) const UNKNOWN_QUANTITY: f64 = 10.0;
    /// Of a calibrated quantity, in stated deviations: it stays where the calibration has put it.
    pub(crate) const CALIBRATED_QUANTITY: f64 = 1e-4;
    /// Of a logarithm, at the least: a factor of four either way.
    pub(crate) const LEAST_OF_LOGARITHM: f64 = 1.4;
    /// Of a size of either sign, as a share of the largest that a search starts from.
    pub(crate) const OF_SIZE: f64 = 0.6;
    /// The same of a dashpot beside a spring, whose starts are next to nothing.
    pub(crate) const OF_DASHPOT: f64 = 30.0;
    /// The same of a rotary inertia, whose start is that of a metal section.
    pub(crate) const OF_ROTARY_INERTIA: f64 = 3.0;
    /// Of a height above a block's axis, in radii of gyration.
    pub(crate) const OF_HEIGHT: f64 = 1.0;
}

/// Derivatives of modes by differences.
pub(crate) mod differences {
    /// Step, in standard deviations of the coordinate's prior.
    pub(crate) const STEP: f64 = 1e-3;
    /// The same in coordinates, at most: what is hardly known would take modes too far for a first order.
    pub(crate) const MOST_STEP: f64 = 2e-3;
}

/// Descents at given sizes of the error.
pub(crate) mod descent {
    use jointscope_inference::{Convergence, StepDamping};

    /// Decrease of χ² that a step promises below which a fit stands where it belongs: what one parameter
    /// gains by chance.
    pub(crate) const STANDS_STILL: f64 = 1.0;
    /// Sets of derivatives that a descent may take after whose end the sizes of error are taken anew: what is
    /// fitted closely at sizes that are about to change is fitted again.
    pub(crate) const DERIVATIVES: usize = 2;
    /// Gauss–Newton steps, at most.
    pub(crate) const MOST_STEPS: usize = 40;
    /// Damping of the steps, to begin with and as they succeed or fail.
    pub(crate) const DAMPING: StepDamping =
        StepDamping { initial: 1e-6, decrease: 0.1, least: 1e-9, raised: 1e-3, most: 1e5 };
    /// Decrease of the objective below which a descent ends, a fifth of that at which the fit stands still,
    /// and the same as a share of the objective.
    pub(crate) const CONVERGENCE: Convergence =
        Convergence { gain: 0.2 * STANDS_STILL, share: 1e-3, floor: 0.0 };
    /// Share of what an undamped step promises below which a fit follows a curved valley.
    pub(crate) const CURVED_VALLEY: f64 = 0.1;
    /// A step that gains less than this share of what the first one with its derivatives gained asks for new
    /// ones.
    pub(crate) const REUSE: f64 = 0.2;
}

/// Rounds of a fit: a descent at sizes of the error, then these sizes anew.
pub(crate) mod fit {
    /// Rounds, at most.
    pub(crate) const MOST_ROUNDS: usize = 20;
    /// Gain in ln p from one round to the next below which a fit has come to rest.
    pub(crate) const CONVERGED: f64 = 0.02;
    /// Rounds at whose ends a fit stands still and has gained less, after which it ends.
    pub(crate) const IDLE_ROUNDS: usize = 2;
    /// Rounds after which a fit may be given up that is still below what matters …
    pub(crate) const PATIENT_ROUNDS: usize = 2;
    /// … if it gains less in one than this share of what it lacks.
    pub(crate) const PROMISING_SHARE: f64 = 0.25;
    /// Factor by which a size may shrink from one round to the next: where errors are next to none, a fit
    /// that starts far away hangs on whatever is recorded most sharply.
    pub(crate) const MOST_SHRINKAGE: f64 = 0.1;
    /// How often a mode that has strayed into the band or out of it is counted anew, and damping that turns
    /// phases by far more or less than before: a mode at the very end of the band may stray for ever.
    pub(crate) const MOST_STRAYS: usize = 2;
    /// Difference in ln p below which a fit adds next to nothing to another one.
    pub(crate) const AS_GOOD_AS_NONE: f64 = 4.0;
    /// Standard deviations by which χ² of the features may be larger than their number.
    pub(crate) const BY_CHANCE: f64 = 6.0;
}

/// How far sizes of the error go of the way to those that a fit asks for. Where parameters and sizes ask for
/// each other in turn they would go round for ever (`docs/records/2026-11-25-fits-among-modes.md`).
pub(crate) mod turns {
    /// Factor of the share that a size goes, where it turns back.
    pub(crate) const TURNED_BACK: f64 = 0.4;
    /// The same where it does not, up to all of the way.
    pub(crate) const ONWARD: f64 = 1.25;
    /// Difference of sizes, as ln, up to which they are as good as the same: they are searched no closer.
    pub(crate) const ALIKE: f64 = 0.1;
}

/// A walk along a ridge on which an effect explains the modes almost as well everywhere.
pub(crate) mod along {
    /// Standard deviation, in coordinates, about a place at which an effect is held.
    pub(crate) const HELD: f64 = 1e-4;
    /// First step away from where a fit came to rest, in deviations by its derivatives there.
    pub(crate) const FIRST_STEP: f64 = 0.7;
    /// The same in coordinates, at most.
    pub(crate) const MOST_FIRST_STEP: f64 = 0.5;
    /// Steps on either side, at most.
    pub(crate) const MOST_STEPS: usize = 14;
    /// ln of the density below the highest at which a place is not credible any more: three standard
    /// deviations.
    pub(crate) const INCREDIBLE: f64 = 4.5;
    /// Fall of ln of the density over a step below which the next is longer.
    pub(crate) const EVEN: f64 = 0.5;
    /// The same above which it is shorter.
    pub(crate) const STEEP: f64 = 1.5;
    /// Factor by which it is longer or shorter.
    pub(crate) const LONGER: f64 = 1.6;
    /// Parts of a step between whose ends everything is interpolated.
    pub(crate) const PARTS: usize = 16;
}

/// What modes and lines say together.
pub(crate) mod judgement {
    /// Standard deviations of χ² for so many unknowns that an effect must leave less than errors of the model
    /// do.
    pub(crate) const CERTAIN: f64 = 3.0;
    /// Probability of names that explain the modes, and not the lines: what a usual finding has beside the
    /// largest weight of something that is not listed.
    pub(crate) const AT_ODDS: f64 = 2.0 / 3.0;
    /// How many times more lines may miss with what explains the modes where the fixture by itself misses less
    /// only by a departure beyond chance: a beam that is softer had modulus and lengths bent for it, and missed
    /// 2.1 and 2.7 times less.
    pub(crate) const BOUGHT: f64 = 2.5;
    /// Times the χ² of a model's lines that is as good: of 40 right names in solids the weakest, a delay of 5
    /// µs, had 1.7 times as much without; masses of nothing and second names that stand for errors had 1.01
    /// times as much and less.
    pub(crate) const AS_WELL_WITHOUT: f64 = 1.01;
    /// Error of the model's lines, as a share of them, beside which they may be missed below all modes that were
    /// compared, and times both, in mean square, beyond which they are: a spring on a block that moved its
    /// resonance from 9 to 29 Hz, below the first line that counted, left 340, and `consistent` was said.
    pub(crate) const MISSED_BELOW: (f64, f64) = (0.03, 9.0);
    /// Standard deviations from nothing below which an effect is nothing, whatever it gains.
    pub(crate) const NOTHING: f64 = 1.0;
    /// Damping ratio of a recorded pole above which it stands for no mode, half its frequency wide: a ripple
    /// over the band had 0.8.
    pub(crate) const NO_PEAK: f64 = 0.25;
    /// Normalised error of the lines from which a model tells as good as nothing of them: zeros have one. What
    /// explains the modes had at most 0.7 where it was right, and 1.00 where a joint 25 times softer than
    /// stated was called 40 times stiffer, its mode out of the band.
    pub(crate) const NO_MODEL: f64 = 0.9;
    /// Share of the recorded squares that must be met within twice the error of natural frequencies where the
    /// lines themselves are missed so far.
    pub(crate) const LEAST_MET: f64 = 0.5;
}

/// Modes of two recordings of a structure.
pub(crate) mod changes {
    /// Difference in ln ω within which modes that no model tells apart are taken for one: what a small change
    /// moves a frequency by.
    pub(crate) const SAME: f64 = 0.02;
}

/// Suspensions that a fixture does not know.
pub(crate) mod suspensions {
    /// Bodies of which every two are tried; of more, the first and the last: who hangs a chain up hangs it up
    /// near its ends.
    pub(crate) const MOST_BODIES: usize = 4;
}
