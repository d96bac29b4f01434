//! Every tuned number of the comparison by modes, with the reason or the measurement behind it where there is
//! one to state, by the question that it decides.
//!
//! Distances between frequencies and between damping ratios are differences of their logarithms. Guards
//! against rounding and against division by zero, which decide nothing, stand where they are used; so do
//! sizes of arrays, orders of lists and the terms of Akaike's criterion.

/// What a recording tells by itself: where modes can be told from residual terms, and where modes out of the
/// band are looked for.
pub(crate) mod recorded {
    /// Lines above the lowest one from which a mode can be told from a residual term. Two or three lines do
    /// not tell a suspension's modes: many poles fit as well, and the mass lines that go with one choice of
    /// them differ from those of another by ten deviations and more.
    pub(crate) const RESOLVED_LINES: usize = 4;
    /// Lowest lines that may be left out for the sake of modes below these, at most: more are only asked for
    /// where lines are uneven.
    pub(crate) const MOST_LINES_LEFT_OUT: usize = 2 * RESOLVED_LINES;
    /// Lines above the lowest one beyond which a mode may stand clear of the mass line all the same: that of
    /// a block on a spring which nobody stated was the third, and showed in nothing else.
    pub(crate) const CLEAR_LINES: f64 = 2.0;
    /// Deviation of ln ω up to which it does: what a mass line may be taken for is told far worse.
    pub(crate) const CLEAR_FREQUENCY: f64 = 1e-3;
    /// The same of ln ζ.
    pub(crate) const CLEAR_DAMPING: f64 = 0.1;
    /// Half the width of a peak, two deviations wider than it is, in spacings of lines, up to which it is
    /// told to be narrow: no line lies on the peak itself then.
    pub(crate) const NARROW: f64 = 0.5;
    /// Difference in ln ω within which a model's mode may be the recorded one: a suspension is known to a
    /// third.
    pub(crate) const EXPECTED_WITHIN: f64 = 0.5;
    /// Where modes above the band are looked for, as multiples of its upper end, one after the other.
    pub(crate) const ABOVE_BAND: [f64; 2] = [1.06, 1.3];
    /// Damping ratio that they are looked for with.
    pub(crate) const DAMPING_RATIO_ABOVE: f64 = 0.01;
    /// Where a mode below the band is looked for, as a multiple of its lower end.
    pub(crate) const BELOW_BAND: f64 = 0.7;
    /// Damping ratio that it is looked for with.
    pub(crate) const DAMPING_RATIO_BELOW: f64 = 0.02;
}

/// The free fit of a recording.
pub(crate) mod free_fit {
    /// χ² per degree of freedom from which a fit may lack a pole: noise alone leaves 1, within a tenth or so
    /// where values are hundreds.
    pub(crate) const POOR: f64 = 1.3;
    /// Share of χ² that is left, at most, where a pole out of the band is worth its unknowns.
    pub(crate) const LEFT_BY_OUTER_POLE: f64 = 0.8;
    /// Damping ratio that a pole is tried with where a fit misses most.
    pub(crate) const MISSED_DAMPING_RATIO: f64 = 0.01;
    /// Share of χ² that is left, at most, where that is a mode. One that was missed beside another took χ²
    /// per degree of freedom from 306 to 1.01.
    pub(crate) const LEFT_BY_MISSED_POLE: f64 = 0.1;
    /// Lines between such a mode and where it was tried, at most: one that went farther explains something
    /// else.
    pub(crate) const MISSED_WITHIN_LINES: f64 = 3.0;
    /// Prior deviation of ln ω about where a fit starts. It matters only to modes that the lines do not
    /// resolve, and so does the next one.
    pub(crate) const VAGUE_FREQUENCY: f64 = 0.2;
    /// The same of ln ζ.
    pub(crate) const VAGUE_DAMPING: f64 = 1.0;
    /// Gauss–Newton steps, at most.
    pub(crate) const MOST_STEPS: usize = 12;
    /// Change of ln ω and ln ζ, in their standard deviations, below which a fit ends: its poles, not χ², are
    /// what is wanted.
    pub(crate) const CONVERGED: f64 = 0.02;
    /// Change of ln ω by one step, at most: steps are undamped, and held so to a few per cent of a frequency.
    pub(crate) const MOST_FREQUENCY_STEP: f64 = 0.02;
    /// The same of ln ζ.
    pub(crate) const MOST_DAMPING_STEP: f64 = 0.3;
    /// Damping ratio that a step may lead to, at most: the pole stays that of an oscillation.
    pub(crate) const MOST_DAMPING_RATIO: f64 = 0.9;
    /// Shares of a step that are tried in turn until χ² falls.
    pub(crate) const STEP_SHARES: [f64; 3] = [1.0, 0.3, 0.05];
}

/// Records that ended while the structure still rang.
pub(crate) mod record_end {
    /// Share of the reciprocal of the lines' distance after which a record ends, at the soonest: triggers come
    /// within its first tenth, and twice its length is transformed with zeros.
    pub(crate) const SHORTEST: f64 = 0.45;
    /// What must be left of a mode for its end to matter: a few of the shares to which FRFs are known.
    pub(crate) const LEAST_LEFT: f64 = 0.003;
    /// Lines on either side of a resonance on which ends are looked for.
    pub(crate) const NEAR_LINES: f64 = 40.0;
    /// Times that the search sets out from, beside the whole length.
    pub(crate) const MOST_STARTS: usize = 3;
    /// What is missing and the residues that tell it ask for each other in turn: share of an error that may be
    /// left, and turns at the most.
    pub(crate) const SETTLED: f64 = 3e-4;
    pub(crate) const MOST_TURNS: f64 = 20.0;
    /// Root mean square duration of a blow, over the highest line's 1/ω, at most: its force is a fifth there of
    /// what it is at rest, and coherence would be gone.
    pub(crate) const LONGEST_BLOW: f64 = 1.8;
    /// Times the poles are fitted to FRFs as restored.
    pub(crate) const ROUNDS: usize = 3;
    /// Times the area in which the end lies is halved at given poles.
    pub(crate) const STEPS: usize = 5;
    /// Phase of residues, rad, that structures and channels have by themselves. It tells ends apart that leave as
    /// much, and no end from none: blocks on foam have phases of a third of one.
    pub(crate) const QUADRATURE: f64 = 0.03;
    /// What an end must gain in χ²: a thousand times that are tried gain 14 by chance.
    pub(crate) const LEAST_GAIN: f64 = 40.0;
    /// Share of what no poles explain that may be left: what is no end is not taken for one because it
    /// resembles one. What an exponential window leaves of a free fit went down to 0.35, where poles alone
    /// know of it.
    pub(crate) const LEFT_OF_MISFIT: f64 = 0.2;
}

/// Lines and frequencies that stand for a whole recording.
pub(crate) mod outline {
    /// Lines on which what a model's modes leave is written by residual terms, at the least: a fraction of
    /// the cost of all of them.
    pub(crate) const LEAST_LINES: usize = 48;
    /// The same for each pole and residual term, each of which is one unknown.
    pub(crate) const LINES_PER_COLUMN: usize = 4;
    /// Where lines stand on each mode in the band besides, in half-widths from its middle. Without them a peak
    /// between two lines left its residue to what surrounds it: of blocks under an exponential window, whose mass
    /// lines leave something that no residual term is, a quarter of a residue was said to come from that.
    pub(crate) const HALF_WIDTHS_AT_PEAKS: [f64; 5] = [-10.0, -2.0, 0.0, 2.0, 10.0];
    /// Frequencies at which peaks of a model are looked for, at the least.
    pub(crate) const LEAST_GRID: usize = 240;
    /// The same for each pole of the recording's free fit.
    pub(crate) const GRID_PER_POLE: usize = 24;
    /// Lowest of them, as a multiple of the band's lower end: modes a little out of the band belong to it,
    /// too.
    pub(crate) const GRID_FROM: f64 = 0.6;
    /// The same as a multiple of the band's upper end, at the least: on a logarithmic scale a band from next
    /// to nothing would leave few for its modes.
    pub(crate) const LEAST_GRID_FROM: f64 = 0.002;
    /// Highest of them, as a multiple of the band's upper end.
    pub(crate) const GRID_TO: f64 = 1.4;
}

/// Poles of a model, and residues by a contour about each.
pub(crate) mod poles {
    /// How far below the band's lowest line a model's mode may lie to be one of the recording's, as a
    /// multiple of that. A suspension's mode just below it is a part of the mass line.
    pub(crate) const FARTHEST_BELOW: f64 = 0.5;
    /// The same above its highest line.
    pub(crate) const FARTHEST_ABOVE: f64 = 1.6;
    /// Distance of the secant method's two first points at a peak of the FRFs, as a share of the distance to
    /// the next frequency.
    pub(crate) const PEAK_STEP: f64 = 0.5;
    /// How far the single pole that would make a peak may lie from it, as a multiple of the distance between
    /// the frequencies on either side: else the peak is made by more than one.
    pub(crate) const SINGLE_POLE_WITHIN: f64 = 2.0;
    /// Distance of the two first points beside a known pole, in frequency, as a share of the pole.
    pub(crate) const APART_IN_FREQUENCY: f64 = 1e-4;
    /// The same in decay, as a share of the pole's.
    pub(crate) const APART_IN_DECAY: f64 = 0.01;
    /// What is added to that for poles that hardly decay, as a share of the pole.
    pub(crate) const LEAST_APART_IN_DECAY: f64 = 1e-6;
    /// Steps of the secant method, at most.
    pub(crate) const MOST_STEPS: usize = 14;
    /// Largest relative distance of a pole from where it was looked for.
    pub(crate) const MOST_DISTANCE: f64 = 0.5;
    /// Relative distance below which two poles are one.
    pub(crate) const SAME_POLE: f64 = 1e-6;
    /// Relative distance below which a pole that was found is the one that a recorded mode hints at.
    pub(crate) const HINTED_AT: f64 = 1e-3;
    /// Damping ratio of what has none: its logarithm is finite, and beyond that of anything recorded.
    pub(crate) const UNDAMPED_RATIO: f64 = 1e-9;
    /// ln f about an effect's own resonance within which its mode is looked for.
    pub(crate) const ABOUT_RESONANCE: f64 = 0.1;
    /// Damping ratio of the narrowest resonance that is not missed there: frequencies are no closer than that
    /// asks for.
    pub(crate) const NARROWEST_RATIO: f64 = 0.003;
    /// Points of the contour about a pole. What they leave of the pole's own place goes with the fourth
    /// power, their number, of its distance from the centre over the radius.
    pub(crate) const CONTOUR_POINTS: usize = 4;
    /// Radius of the contour as a share of the pole's decay: modes that overlap lie well outside of it.
    pub(crate) const RADIUS_OF_DECAY: f64 = 0.01;
    /// The same as a share of the pole, at the least: rounding lies well below.
    pub(crate) const LEAST_RADIUS: f64 = 1e-6;
    /// Radius of the contour that finds a pole beside a known one, as a multiple of the usual radius: a
    /// difference's steps of a thousandth of a deviation move poles by 0.4 of that.
    pub(crate) const WIDE_CONTOUR: f64 = 10.0;
    /// How far from its centre that contour may find the pole, as a share of the radius. A neighbour as far
    /// off as the pole's decay leaves a thousandth of the usual radius.
    pub(crate) const WELL_INSIDE: f64 = 0.5;
    /// Last step of the secant method, as a share of the contour's radius: the contour then tells the pole.
    /// Of much damping it is no longer than [`SAME_POLE`].
    pub(crate) const LAST_STEP: f64 = 1e-3;
}

/// Which mode of a model is which of a recording. Costs count against each other only; what is in nats counts
/// in the evidence.
pub(crate) mod matching {
    /// What a difference of one in ln f costs where a single FRF tells no shapes.
    pub(crate) const FREQUENCY_WITHOUT_SHAPES: f64 = 60.0;
    /// The same where several FRFs tell them: then shapes say which is which, and frequencies may be farther
    /// off.
    pub(crate) const FREQUENCY_BESIDE_SHAPES: f64 = 10.0;
    /// Difference in ln f from which that costs no more.
    pub(crate) const MOST_DISTANCE: f64 = 1.0;
    /// What shapes cost that have nothing in common.
    pub(crate) const UNLIKE_SHAPES: f64 = 5.0;
    /// What a mode without a partner costs. Two of them cost more than the most unlike pair where several
    /// FRFs tell shapes; with a single FRF a pair may be 0.27 apart in ln f.
    pub(crate) const WITHOUT_PARTNER: f64 = 8.0;
    /// Deviation of ln ω up to which a mode too low to be resolved counts as one that is there.
    pub(crate) const PLACED_FREQUENCY: f64 = 0.01;
    /// Decades that the damping ratio of a mode of anything may lie in.
    pub(crate) const DAMPING_DECADES: f64 = 4.0;
    /// Most that an unseen mode may cost, nats: a free fit may miss one.
    pub(crate) const MOST_UNSEEN: f64 = 60.0;
}

/// Shapes of a model's modes.
pub(crate) mod shapes {
    /// Relative distance of natural frequencies below which a pole of the test is one of the structure: an
    /// exponential window adds damping alone.
    pub(crate) const SAME_FREQUENCY: f64 = 1e-3;
    /// References to which the signs of shapes are told, at most: each asks for an FRF to every channel, and
    /// one that moves in a mode is enough.
    pub(crate) const MOST_REFERENCES: usize = 4;
    /// Share of a mode's mean square below which a reference does not move in it, and tells no phases.
    pub(crate) const NODE_SHARE: f64 = 1e-9;
}

/// Errors of a model. Usual ones are those of lumped models of machined parts, as relative standard
/// deviations: scales of priors, fixed beforehand and not fitted.
pub(crate) mod errors {
    /// Usual error of natural frequencies: those of models are off by some tenths of a per cent.
    pub(crate) const USUAL_FREQUENCY: f64 = 0.003;
    /// Usual error of damping ratios, which models have far less well than frequencies.
    pub(crate) const USUAL_DAMPING: f64 = 0.1;
    /// Usual error of shapes at each channel, against the shape's root mean square, and of modal masses.
    pub(crate) const USUAL_SHAPE: f64 = 0.005;
    /// The same in quadrature. Phases that the structure's damping turns err with the damping ratios; this is
    /// what is left besides. Imaginary parts of residues are recorded to 10⁻⁴ and better.
    pub(crate) const USUAL_QUADRATURE: f64 = 0.0005;
    /// Usual error of mass lines. Where modes are a part of them, what the errors of these modes' shapes make
    /// comes on top.
    pub(crate) const USUAL_MASS_LINE: f64 = 0.001;
    /// Usual error of upper residuals: blocks that are rigid in a model and solids by finite elements leave
    /// these 3 to 36 % off, in all FRFs alike.
    pub(crate) const USUAL_UPPER_RESIDUAL: f64 = 0.15;
    /// Usual error of gains: sensors turned, hits off the point.
    pub(crate) const USUAL_GAIN: f64 = 0.01;
    /// Usual distance of sensors and impacts from their points, m: a hammer's tip is 6 mm wide, and who aims at
    /// a cross hits within a millimetre of it.
    pub(crate) const USUAL_STRIKE: f64 = 1e-3;
    /// Multiple of its usual size below which an error is none: what is told from noise lies far above.
    pub(crate) const LEAST_SIZE: f64 = 1e-3;
    /// Error of gains up to which it counts for what it makes of a displacement besides: one without bounds, which
    /// a wrong hypothesis asks for, would leave residues anything.
    pub(crate) const LARGEST_STRUCK_GAIN: f64 = 0.05;
    /// Share of the lowest mode's residues below which a model's mass lines are none: it is held to ground.
    pub(crate) const HELD_SHARE: f64 = 0.03;
    /// What a free fit writes into the mass lines of such a structure, relative to the lowest mode's residues,
    /// for a size of one. The usual 0.1 % makes it 1 %; of beams in a clamp and blocks on rubber it was 1 to 2.
    pub(crate) const OF_LOWEST: f64 = 10.0;
    /// Square of the share of the root mean square over the FRFs from which a residual term counts as much as
    /// it is: relative to next to nothing any error were large.
    pub(crate) const LEAST_TERM_SQUARED: f64 = 0.1;
}

/// The most probable sizes of a model's error, and how well they are known. Sizes are multiples of their
/// priors' scales.
pub(crate) mod evidence {
    /// Sizes that are tried first, from next to none to far beyond what a prior lets one expect.
    pub(crate) const COARSE_SIZES: [f64; 7] = [1e-3, 0.1, 0.4, 1.0, 3.0, 10.0, 40.0];
    /// How often all kinds are gone through so: the best size of one depends on those of the others.
    pub(crate) const COARSE_SWEEPS: usize = 2;
    /// First step of a size's logarithm. The density of a size that ten modes tell is about as wide, and
    /// nearly a parabola.
    pub(crate) const STEP: f64 = 0.3;
    /// Further steps, each twice as long, at most.
    pub(crate) const MOST_STEPS: usize = 6;
    /// How often a kind is gone through, at most.
    pub(crate) const MOST_SWEEPS: usize = 4;
    /// What a kind must gain to be gone through once more, nats: by as much no name is told from another.
    pub(crate) const LEAST_GAIN: f64 = 0.02;
    /// How far means and intervals reach at the least: what is larger than that a half-normal prior has with
    /// a probability below 10⁻⁴.
    pub(crate) const LEAST_REACH: f64 = 4.0;
    /// How far means reach, as a multiple of the most probable size.
    pub(crate) const REACH_OF_MEAN: f64 = 3.0;
    /// How far intervals reach, as a multiple of the most probable size: their ends lie farther out than a
    /// mean.
    pub(crate) const REACH_OF_INTERVAL: f64 = 6.0;
    /// Sizes over which a mean is taken.
    pub(crate) const SIZES_OF_MEAN: usize = 24;
    /// Sizes over which an interval is taken, on a logarithmic scale.
    pub(crate) const SIZES_OF_INTERVAL: usize = 40;
    /// The least of them. Below it the density is taken for that at none.
    pub(crate) const LEAST_OF_INTERVAL: f64 = 0.02;
    /// Most probable size below which an error is next to nothing: its interval starts at zero.
    pub(crate) const NEXT_TO_NOTHING: f64 = 0.01;
}

/// Where sensors sit and hammers strike.
pub(crate) mod strikes {
    /// Step of the differences by which residues move with that, m.
    pub(crate) const STEP: f64 = 1e-5;
}

/// What errors of a structure's model leave, however large they are.
pub(crate) mod structural {
    /// Deviations of ln ω and ln ζ of modes in the band about those of the free fit: as good as unknown.
    pub(crate) const UNKNOWN_POLE: f64 = 1.0;
}
