//! Every tuned number of what the crate simulates and diagnoses, with the reason for it where there is one to
//! state, by the step that it decides.
//!
//! Guards against rounding and steps of difference quotients of the fixture's quantities, which decide
//! nothing, stand where they are used; so do sizes of arrays.

/// Steps over time.
pub(crate) mod simulation {
    /// Steps within a sampling interval to begin with.
    pub(crate) const FEWEST_STEPS: usize = 4;
    /// The same at the most.
    pub(crate) const MOST_STEPS: usize = 256;
    /// Halvings of a step with an event.
    pub(crate) const HALVINGS: usize = 12;
    /// Error below which steps are not refined, relative to a response's rms.
    pub(crate) const ENOUGH: f64 = 1e-5;
    /// Points for each sample of a signal that is shifted by a part of one: between two of them it is read
    /// from a straight line.
    pub(crate) const FINE_SAMPLES: usize = 64;
    /// Share of an element's largest participation below which a mode does not move it.
    pub(crate) const UNFELT_MODE: f64 = 1e-9;
}

/// Force–state maps.
pub(crate) mod map {
    /// Multiple of the highest elastic frequency up to which a force–state map goes.
    pub(crate) const HARMONIC: f64 = 3.5;
    /// Share of the sampling rate that this is at the most.
    pub(crate) const SAMPLED_SHARE: f64 = 0.45;
    /// Share of the lowest elastic frequency from which motion is taken from the sensors.
    pub(crate) const FROM_LOWEST: f64 = 0.5;
    /// Share of the lowest frequency of that band at which the sensors begin to count, fully at the frequency
    /// itself.
    pub(crate) const RISES_FROM: f64 = 0.5;
    /// Share of the highest frequency from which what is shown falls, to nothing at the frequency itself.
    pub(crate) const FALLS_FROM: f64 = 0.8;
    /// Share of its largest d below which motion is no longer shown.
    pub(crate) const DIED_DOWN: f64 = 0.1;
    /// Share of the peak force at which a blow begins.
    pub(crate) const ONSET: f64 = 0.02;
    /// Largest condition number, squared, of equations that determine their unknowns.
    pub(crate) const DETERMINED: f64 = 1e7;
}

/// Records of hits.
pub(crate) mod hits {
    /// Fewest samples of a hit.
    pub(crate) const FEWEST_SAMPLES: usize = 256;
    /// Share of the peak force at which a blow begins.
    pub(crate) const BLOW_BEGINS: f64 = 0.05;
    /// Samples before that from which on a record counts.
    pub(crate) const BEFORE_BLOW: usize = 8;
    /// Noise of a signal over its rms, at the least: one without any (of a simulation) still is not known
    /// beyond its rounding.
    pub(crate) const LEAST_NOISE: f64 = 1e-6;
    /// Part of a record at its end in which noise is looked for, a quarter: a hit's force is over, its
    /// response has mostly died away.
    pub(crate) const TAIL_PARTS: usize = 4;
    /// Fewest samples of a tail.
    pub(crate) const FEWEST_IN_TAIL: usize = 32;
    /// Ratio of peak forces from which two neighbours belong to different levels.
    pub(crate) const LEVELS_APART: f64 = 1.35;
    /// Ratio of the strongest to the weakest hit below which amplitude cannot be judged.
    pub(crate) const TELLING: f64 = 1.5;
    /// Levels into which hits are parted whose strengths have no gaps.
    pub(crate) const LEVELS_WITHOUT_GAPS: usize = 3;
    /// Hits from which some are held out where none are alike.
    pub(crate) const FEWEST_TO_HOLD_OUT: usize = 6;
    /// One of so many is then held out.
    pub(crate) const HELD_OUT_EVERY: usize = 3;
}

/// Whether FRFs change with level.
pub(crate) mod homogeneity {
    /// p-value below which FRFs are said to change with level.
    pub(crate) const CHANGED: f64 = 2e-3;
    /// e^{−aT} of the window over the record, as an exponent.
    pub(crate) const WINDOW: f64 = 10.0;
    /// Error of every spectral value relative to itself, beside its noise: what sampling and the end of the
    /// record leave of a hit's exact instant. It is alike on many lines, and no difference as small tells
    /// anything of a joint.
    pub(crate) const SAMPLING_ERROR: f64 = 3e-3;
    /// Force lines below this share of the strongest are left out.
    pub(crate) const WEAK_FORCE: f64 = 0.03;
    /// Degrees of freedom within levels from which they tell the noise.
    pub(crate) const FEWEST_WITHIN: f64 = 8.0;
    /// Independent lines of a block.
    pub(crate) const INDEPENDENT_IN_BLOCK: f64 = 4.0;
    /// Blocks on each side over which the scatter of hits alike is taken.
    pub(crate) const BLOCKS_AROUND: usize = 3;
    /// How far the noise at a record's end may be from that of all of it.
    pub(crate) const NOISE_DOUBT: f64 = 1.25;
}

/// Frequencies that are compared.
pub(crate) mod band {
    /// Share of its largest line at which a force's spectrum ends.
    pub(crate) const FORCE_ENDS: f64 = 0.03;
    /// Share of half the sampling rate up to which lines are compared.
    pub(crate) const SAMPLING_ENDS: f64 = 0.8;
    /// Multiple of the highest elastic frequency up to which they are where all bodies are rigid.
    pub(crate) const BEYOND_ELASTIC: f64 = 2.0;
    /// Multiple of the highest line compared up to which the fixture's modes are in a model of it.
    pub(crate) const BEYOND_BAND: f64 = 2.0;
}

/// What a model leaves of a record.
pub(crate) mod misfit {
    /// Departure of every line that is not held against a model: what sampling, sensors and steps leave of
    /// it, relative to the line.
    pub(crate) const LINE_ERROR: f64 = 2e-3;
    /// Departure of every line that is not held against a model whose quantities are known within tolerances,
    /// relative to the line.
    pub(crate) const LINE_ERROR_WITHIN_TOLERANCES: f64 = 0.03;
    /// e^{−at} at which a windowed record is cut off, as an exponent.
    pub(crate) const CUT: f64 = 6.0;
    /// Last share of the way from the blow to the end of what is compared in which it fades.
    pub(crate) const FADING_SHARE: f64 = 0.2;
    /// Samples together that have sunk into noise, or have not.
    pub(crate) const DECAY_BLOCK: usize = 64;
    /// Power over that of the noise from which they have not.
    pub(crate) const ABOVE_NOISE: f64 = 1.5;
    /// Power of a force line over its noise from which the FRF that the hit itself shows there is believed.
    pub(crate) const FORCE_ABOVE_NOISE: f64 = 25.0;
}

/// From the refitted fixture to the law that explains what is left.
pub(crate) mod search {
    /// Periods of the slowest motion over which the weight of a short window falls by e.
    pub(crate) const SHORT: f64 = 2.0;
    /// The same of a medium one.
    pub(crate) const MEDIUM: f64 = 5.0;
    /// The same of a long one.
    pub(crate) const LONG: f64 = 30.0;
    /// The same of the windows from which a joint's force is reconstructed: the shorter, the less the
    /// fixture's errors add up; the longer, the more is seen.
    pub(crate) const RECONSTRUCTED: [f64; 3] = [2.0, 5.0, 12.0];
    /// Steps in a period of the fastest elastic motion.
    pub(crate) const STEPS_IN_PERIOD: f64 = 30.0;
    /// Steps within a sampling interval that this makes, least and most.
    pub(crate) const STEPS_IN_INTERVAL: (f64, f64) = (2.0, 16.0);
    /// Halvings of a step with an event while laws are looked for.
    pub(crate) const SEARCH_HALVINGS: usize = 3;
    /// What a longer window may cost a shorter one in χ² and priors.
    pub(crate) const CONTRADICTION: f64 = 40.0;
    /// And how large a part of them beside.
    pub(crate) const CONTRADICTION_SHARE: f64 = 3e-3;
    /// Share explained, relative to the best kind's, below which a kind is not fitted.
    pub(crate) const WEAK_KIND: f64 = 0.1;
    /// χ² over that of the best from which hypotheses are further from it than any longer window could bring
    /// them back.
    pub(crate) const BEHIND: f64 = 1.5;
    /// χ² that is allowed beside.
    pub(crate) const BEHIND_BESIDE: f64 = 50.0;
    /// And the same for each root of the degrees of freedom, as χ² scatters.
    pub(crate) const BEHIND_BY_CHANCE: f64 = 5.0;
    /// Kinds of law that are fitted.
    pub(crate) const CONTENDERS: usize = 4;
    /// Hypotheses that are fitted to whole records.
    pub(crate) const FINALISTS: usize = 3;
    /// Derivatives taken at the most for the fixture without any law in one window.
    pub(crate) const LINEAR_RENEWALS: usize = 5;
    /// The same for each start of a kind of law in the short window.
    pub(crate) const START_RENEWALS: usize = 4;
    /// Derivatives taken at the most for a hypothesis in one window: a fit that is cut short is carried into
    /// the next as a false minimum.
    pub(crate) const RENEWALS: usize = 20;
    /// χ² per degree of freedom above which a second law is looked for.
    pub(crate) const SEEK_MORE: f64 = 3.0;
    /// Error relative to the responses above which it is as well: both must be exceeded.
    pub(crate) const SEEK_MORE_ERROR: f64 = 0.05;
    /// Share of what is left of χ² beyond noise that the first law, and a second and last one, must explain
    /// to be named: a fit caught in a false minimum explains a part, and no name should be given for it.
    pub(crate) const WORTH: [f64; 2] = [0.75, 0.1];
    /// Fall of χ² and priors that a law must bring in any case.
    pub(crate) const LEAST_GAIN: f64 = 30.0;
    /// The same beside another law, as a share of what that one brings: no joint follows a law to a thousandth,
    /// and what is left of it is no law.
    pub(crate) const LEAST_SHARE: f64 = 1e-3;
}

/// The fit of a hypothesis. A simulation costs seconds, its derivatives many of them.
pub(crate) mod fit {
    use jointscope_inference::{Convergence, StepDamping};

    /// Steps at the most.
    pub(crate) const MOST_STEPS: usize = 100;
    /// Damping of the steps.
    pub(crate) const STEP_DAMPING: StepDamping =
        StepDamping { initial: 1e-3, decrease: 0.1, least: 1e-9, raised: 0.0, most: 1e3 };
    /// When it has converged: a tenth in χ² is no gain.
    pub(crate) const CONVERGED: Convergence = Convergence { gain: 0.1, share: 2e-5, floor: 0.0 };
    /// Derivatives are taken anew as seldom as a twentieth of their first gain allows.
    pub(crate) const REUSE: f64 = 0.05;
    /// Longest step of a coordinate: beyond it a linearised model says nothing.
    pub(crate) const LONGEST: f64 = 4.0;
    /// The same of an effect's, a logarithm or a part of where it began: a spring that no longer slips, or
    /// never touches, would not find back.
    pub(crate) const LONGEST_OF_EFFECT: f64 = 0.4;
}

/// Starts from a joint's reconstructed force.
pub(crate) mod suggestions {
    /// Where in the record a pulse is put to learn what a force pair of 1 does.
    pub(crate) const PULSE_AT: usize = 24;
    /// That pulse, of three samples: what is above half of the rate does not ring ahead of it.
    pub(crate) const PULSE: [f64; 3] = [0.25, 0.5, 0.25];
    /// Relative difference of all parameters below which a start is no other one.
    pub(crate) const ALIKE: f64 = 0.1;
    /// Sizes at which a shape is tried.
    pub(crate) const SIZES: usize = 36;
    /// How far down from the largest motion they go.
    pub(crate) const SMALLEST: f64 = 0.004;
    /// Share of the largest motion that they are measured by: what slips or touches only there is not seen.
    pub(crate) const LARGEST: f64 = 0.98;
    /// Weight of the window down to which motion counts for the largest.
    pub(crate) const SEEN_WEIGHT: f64 = 0.05;
    /// Shapes of a kind that are worth a fit.
    pub(crate) const SHAPES: usize = 2;
    /// Steps within a sampling interval of the motions across joints.
    pub(crate) const STEPS_OF_REACH: usize = 4;
}

/// How far a record can be followed.
pub(crate) mod horizon {
    /// Samples over which departures are averaged.
    pub(crate) const BLOCK: usize = 64;
    /// Disturbances of the force in its noise's deviations: to either side, and so large that contacts which
    /// are nearly made are made.
    pub(crate) const DISTURBANCES: [f64; 2] = [3.0, -3.0];
    /// Departure, in deviations of the response's noise, from which on a record is not followed.
    pub(crate) const TOLERATED: f64 = 1.0;
    /// Departures of the same noise in the linear model, which weights allow for, up to which nothing is
    /// amiss.
    pub(crate) const LINEAR_DEPARTURES: f64 = 4.0;
    /// Deviations of the effects' parameters, the fixture's quantities following them, that must not be felt:
    /// together all records are far more sensitive than one, so that in a record that can be followed they
    /// are not.
    pub(crate) const DEVIATIONS: f64 = 3.0;
    /// Variance of an effect's coordinate up to which it is moved so.
    pub(crate) const CERTAIN: f64 = 0.01;
}

/// What is said of the laws found.
pub(crate) mod judgement {
    /// χ² per degree of freedom above which a model leaves something unexplained.
    pub(crate) const LEFT_OVER: f64 = 1.5;
    /// How much finer the last fit steps than the search: what steps leave of bias must not exceed what noise
    /// leaves of doubt.
    pub(crate) const FINER: usize = 2;
    /// Halvings of a step with an event in that fit.
    pub(crate) const JUDGE_HALVINGS: usize = 4;
    /// Relative deviation that steps and sampling leave in a parameter beside noise, as measured on the
    /// simulated laboratory.
    pub(crate) const PARAMETER_ERROR: f64 = 2.5e-3;
    /// χ² that a law with a parameter more must gain for it to be as probable.
    pub(crate) const PARAMETER_COST: f64 = 7.0;
    /// Weight of something not listed beside the best law.
    pub(crate) const UNLISTED: f64 = 0.01;
    /// The same beside where the best law leaves much unexplained.
    pub(crate) const UNLISTED_LEFT_OVER: f64 = 0.3;
    /// χ² per degree of freedom beyond what may be left over that is so much.
    pub(crate) const MUCH_LEFT_OVER: f64 = 10.0;
    /// Probability above which an alternative is listed.
    pub(crate) const LEAST_PROBABILITY: f64 = 1e-6;
    /// Deviation of a logarithm beyond which a parameter is not determined.
    pub(crate) const VAGUE: f64 = 1.5;
}

/// Sine tests at levels: what is read from them.
pub(crate) mod levels {
    /// Strengths of levels at the least, as a ratio: closer ones say nothing of amplitude.
    pub(crate) const LEAST_RATIO: f64 = 1.2;
    /// Fewest lines of a level about the resonance.
    pub(crate) const FEWEST_LINES: usize = 8;
    /// Where the other levels' peaks are looked for, in units of the lowest level's.
    pub(crate) const ABOUT_PEAK: (f64, f64) = (0.85, 1.15);
    /// Half-power widths about the resonances that are used.
    pub(crate) const WIDTHS: f64 = 10.0;
    /// By how much variances about a resonance, read from the scatter of the lines, may be too small against
    /// those beside it.
    pub(crate) const SCATTER_DOUBT: f64 = 1.25;
    /// Share of the narrowest spacing of lines up to which lines of several levels are one.
    pub(crate) const SAME_LINE: f64 = 0.01;
    /// Damping ratios that the fit of a resonance begins with, in units of its width over its frequency.
    pub(crate) const DAMPING_STARTS: [f64; 3] = [0.2, 0.5, 1.5];
    /// Standard deviations of the difference of two fitted frequencies beyond which they differ.
    pub(crate) const FREQUENCIES_DIFFER: f64 = 5.0;
    /// The same of damping ratios.
    pub(crate) const DAMPING_DIFFERS: f64 = 3.0;
}

/// The fixture at the levels, with a change at one joint.
pub(crate) mod level_model {
    /// Frequency at which statics are read, as a share of the lowest line.
    pub(crate) const STATIC: f64 = 1e-3;
    /// Step off a line on which the fixture's receptances are not finite, relative.
    pub(crate) const BESIDE: f64 = 1e-7;
    /// d's share in the driving-point motion below which a mode does not move the joint, in m or rad per m.
    pub(crate) const UNMOVED_JOINT: f64 = 1e-9;
    /// Turns of the loop from d to the joint's stiffness and back, at the most.
    pub(crate) const TURNS: usize = 12;
    /// Change of d, relative, at which it is found.
    pub(crate) const FOUND: f64 = 1e-7;
    /// Turns of the loop from the levels' stiffnesses to the gain common to all and back, at the most.
    pub(crate) const GAIN_TURNS: usize = 12;
    /// Change of the logarithm of the gain at which it is found.
    pub(crate) const GAIN_FOUND: f64 = 1e-7;
    /// Newton steps to the mean of d; the function is monotonic and convex, four are usual.
    pub(crate) const CONTACT_STEPS: usize = 40;
}

/// Laws fitted to the levels.
pub(crate) mod level_fit {
    use jointscope_inference::StepDamping;

    /// Damping of the steps.
    pub(crate) const STEP_DAMPING: StepDamping =
        StepDamping { initial: 1e-3, decrease: 0.2, least: 1e-12, raised: 0.0, most: 1e8 };
    /// Step of the differences, relative to each parameter's scale.
    pub(crate) const DIFFERENCE: f64 = 1e-5;
    /// Scale of the logarithm of the gain.
    pub(crate) const GAIN_SCALE: f64 = 0.05;
    /// Scale of the logarithm of a law's parameter.
    pub(crate) const LAW_SCALE: f64 = 0.3;
    /// Starts that are followed to their minimum, the motions those of the levels' own stiffnesses.
    pub(crate) const FOLLOWED: usize = 5;
    /// Minima that are followed on, the motions those of the law itself.
    pub(crate) const POLISHED: usize = 2;
    /// Onsets of slip or contact to begin with.
    pub(crate) const ONSETS: u32 = 8;
    /// The first of them, as a share of the lowest level's motion.
    pub(crate) const ONSET_FROM: f64 = 0.3;
    /// The last of them, as a share of the highest level's: beyond it nothing slips or touches.
    pub(crate) const ONSET_TO: f64 = 0.95;
    /// Stiffnesses of friction to begin with, in units of how much the levels' own differ.
    pub(crate) const FRICTION_STARTS: [f64; 3] = [0.5, 1.5, 5.0];
    /// The same of a stop.
    pub(crate) const GAP_STARTS: [f64; 3] = [1.0, 3.0, 10.0];
    /// Share of a start that a second law begins with beside the best fit of the first.
    pub(crate) const SLIGHTLY: f64 = 0.01;
}

/// Laws as they are named.
pub(crate) mod naming {
    /// Share of the change with level that a law must explain to be named.
    pub(crate) const NAMED: f64 = 0.75;
    /// The same for two laws together, which follow more by chance.
    pub(crate) const NAMED_TWO: f64 = 0.95;
    /// Share of the change with level from which a law leaves nothing worth a word.
    pub(crate) const LEAVES_NOTHING: f64 = 0.95;
    /// Share of the change with level from which two laws together would explain it.
    pub(crate) const EXPLAINED_BY_TWO: f64 = 0.9;
    /// Levels at the least for a law: two tell a shift from no shift, three whether a law follows it.
    pub(crate) const LEVELS_FOR_ONE: usize = 3;
    /// The same for two laws together.
    pub(crate) const LEVELS_FOR_TWO: usize = 6;
    /// Relative deviation of a law's parameters from what the balance of one harmonic leaves out: against the
    /// laboratory's nine harmonics, a tenth of the usual noise and a fixture that is exact, they err by 0.1
    /// to 0.7 %.
    pub(crate) const HARMONIC_BALANCE_ERROR: f64 = 5e-3;
    /// Relative error of FRFs that the same balance leaves of the right law: up to 0.011 of friction that shifts
    /// a resonance by 6 %.
    pub(crate) const LAW_ERROR: f64 = 0.01;
    /// Probability from which an alternative is listed.
    pub(crate) const LEAST_SHOWN: f64 = 5e-4;
}
