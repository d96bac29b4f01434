//! Every tuned number of a decomposition, with the reason for it where there is one to state, by the step
//! that it decides.
//!
//! Steps of differences inside a law and the grid of a quadrature, which decide nothing, stand where they are
//! used; so do sizes of arrays.

/// Line by line.
pub(crate) mod spectra {
    /// H41 beyond this balanced condition number counts as singular: its inverse is rounding.
    pub(crate) const SINGULAR_CONDITION: f64 = 1e12;
    /// Share of noise in an element above which its interval is only indicative: the propagation is of first
    /// order.
    pub(crate) const INDICATIVE_NOISE: f64 = 0.3;
}

/// Interfaces by line.
pub(crate) mod interfaces {
    /// Share of noise in the determinant of the matrix that a line inverts above which it tells nothing:
    /// errors of the inverse are of first order below.
    pub(crate) const HIDDEN_BY_NOISE: f64 = 0.1;
    /// Standard deviation of a compliance's parts, as a share of the real part that the lines beside it show,
    /// above which a line tells no stiffness: at a fifth first-order 95 % intervals of one over a compliance
    /// cover in 93.4 %, at a tenth in 94.9 %.
    pub(crate) const STATED_SHARE: f64 = 0.2;
    /// Lines on either side that are taken as beside it.
    pub(crate) const NEIGHBOURS: usize = 25;
    /// Deviations that a compliance itself has to be above zero; fewer would make one over it anything.
    pub(crate) const BEYOND_NOISE: f64 = 2.0;
}

/// What is said of figures.
pub(crate) mod estimates {
    /// Relative uncertainty above which a figure counts as not determined.
    pub(crate) const NOT_DETERMINED: f64 = 0.5;
    /// Share of √(k_ii k_jj) by which fit and means may differ before neither is of use.
    pub(crate) const CONTRADICTED: f64 = 0.5;
    /// χ² per degree of freedom above which blocks are said not to have moved rigidly.
    pub(crate) const NOT_RIGID: f64 = 2.0;
    /// Standard deviations beyond which fit and means contradict each other.
    pub(crate) const BEYOND_CHANCE: f64 = 3.0;
    /// A determinant of c this small against c₁₁·c₂₂ lies on the boundary of what is passive.
    pub(crate) const ON_THE_BOUNDARY: f64 = 1e-9;
}

/// Noise of the FRFs, and what a model leaves beyond it.
pub(crate) mod noise {
    /// Relative standard deviation of a value without a variance.
    pub(crate) const UNKNOWN_NOISE: f64 = 1e-3;
    /// χ² per degree of freedom up to which a joint counts as explaining the FRFs, so that noise is taken as
    /// it is stated: variances from few averages are themselves known to a few per cent.
    pub(crate) const EXPLAINED: f64 = 1.2;
    /// Blocks of neighbouring lines that the jackknife leaves out in turn.
    pub(crate) const JACKKNIFE_BLOCKS: usize = 8;
}

/// Steps of differences.
pub(crate) mod differences {
    /// Share of a standard deviation that a quantity is moved by.
    pub(crate) const TOLERANCE_STEP: f64 = 1e-3;
    /// Steps of differences of the gradient, in standard deviations of each parameter.
    pub(crate) const GRADIENT_STEP: f64 = 1e-3;
    /// Step of forward differences by a quantity, in standard deviations: resonances bend within a tenth of
    /// one. What a thousandth got wrong was a hundred times as much as FRFs of little noise tell of the joint
    /// along its valley, and passed for knowledge.
    pub(crate) const QUANTITY_STEP: f64 = 1e-6;
}

/// The fit of a constant joint to the FRFs across it.
pub(crate) mod constant_joint {
    use jointscope_inference::StepDamping;

    /// χ² per degree of freedom above which a constant joint does not explain the FRFs within their noise.
    pub(crate) const POOR_FIT: f64 = 1.3;
    /// Damping of the steps. Near the optimum χ² is nearly quadratic: undamped steps converge within a few.
    pub(crate) const STEP_DAMPING: StepDamping =
        StepDamping { initial: 1e-6, decrease: 0.03, least: 1e-15, raised: 0.0, most: 1e8 };
    /// c/k of the start, s: a loss factor of 0.6 % at 300 Hz.
    pub(crate) const START_DAMPING_TIME: f64 = 3e-6;
    /// Rounds of the linear fit that finds the start.
    pub(crate) const LINEAR_ROUNDS: usize = 12;
    /// Change of k in a round, in units of √(k_ii k_jj), below which further rounds are not worth while.
    pub(crate) const LINEAR_SETTLED: f64 = 1e-6;
}

/// Where the fit to all FRFs sets out from.
pub(crate) mod starts {
    /// χ² per degree of freedom above which another start is tried.
    pub(crate) const DOUBTFUL_FIT: f64 = 1.3;
    /// Damping of a start without any, as a loss factor.
    pub(crate) const START_LOSS: f64 = 3e-3;
    /// Weighted squared change by one standard deviation of a quantity below which the FRFs do not depend on
    /// it.
    pub(crate) const NO_DEPENDENCE: f64 = 1e-9;
    /// Share of what the FRFs weigh that a fit may leave of them: one that leaves more has found no joint.
    pub(crate) const ASTRAY: f64 = 0.5;
    /// Mean square departure of the quantities, in standard deviations, above which another start is tried.
    pub(crate) const PLAUSIBLE_DEPARTURE: f64 = 4.0;
}

/// The fit to all FRFs.
pub(crate) mod fit {
    /// Steps of a fit at the most.
    pub(crate) const MOST_STEPS: usize = 80;
    /// Share of a promised decrease below which a step follows a curved valley: resonances tie the joint to
    /// the blocks along one.
    pub(crate) const CURVED_VALLEY: f64 = 0.5;
    /// Change of χ² below which a fit has converged: a thousandth of what one standard deviation makes.
    pub(crate) const CONVERGED: f64 = 1e-3;
    /// The same as a share of what χ² exceeds noise by: what the model gets wrong is counted as noise anyway.
    pub(crate) const CONVERGED_SHARE: f64 = 1e-4;
    /// Differences by quantities serve for as long as steps gain this share of the first one's.
    pub(crate) const REUSE: f64 = 0.02;
    /// Shares of the signal that count as noise in the stages of a fit from afar.
    pub(crate) const SIGNAL_AS_NOISE: [f64; 4] = [1.0, 0.3, 0.06, 0.01];
    /// Decrease of χ² that an optimum may promise by derivatives taken there: as much as one standard
    /// deviation makes. Of a joint of 1 % structural damping the fit of its own law promised 9 where it
    /// ended, and was 3.4 standard deviations off in k22.
    pub(crate) const CREEPS: f64 = 1.0;
    /// Times that an optimum is gone on from with derivatives taken there.
    pub(crate) const MOST_RESUMPTIONS: usize = 3;
}

/// What is known of a joint beforehand: standard deviations.
pub(crate) mod priors {
    /// Of an element of K, in units of the diagonal of a joint nearby.
    pub(crate) const STIFFNESS: f64 = 2.0;
    /// Of a loss factor in the middle of the band, and of the change of stiffness up to there as a share.
    pub(crate) const LOSS: f64 = 0.1;
    /// Of ln(ωτ) in the middle of the band.
    pub(crate) const LN_TIME: f64 = 1.5;
    /// Of the exponent about ½: that of a uniform distribution.
    pub(crate) const EXPONENT: f64 = 0.29;
    /// The exponent stays this far from 0 and 1, where a springpot is a spring or a dashpot.
    pub(crate) const EXPONENT_MARGIN: f64 = 0.02;
    /// Of the joint's mass as a share of the lighter side's.
    pub(crate) const MASS: f64 = 0.02;
    /// Variance of what nothing is known of, the same for every law.
    pub(crate) const UNKNOWN_VARIANCE: f64 = 1e4;
    /// Least and largest of a loss factor, where the deviation itself is unknown.
    pub(crate) const LOSS_RANGE: [f64; 2] = [1e-4, 0.3];
    /// Of the change of stiffness up to the middle of the band, as a share.
    pub(crate) const CHANGE_RANGE: [f64; 2] = [3e-4, 0.3];
    /// Of the mass in units of its coordinate, that is of a fiftieth of the lighter side's: 0.06 to 5 % of
    /// that side.
    pub(crate) const MASS_RANGE: [f64; 2] = [0.03, 2.5];
    /// Widths tried of each.
    pub(crate) const WIDTHS: usize = 9;
}

/// Symmetric optima and joints that physics allows.
pub(crate) mod symmetry {
    /// Gain by freedom of symmetry from which it is asked whether the symmetric optimum is one: one time in
    /// twenty by chance.
    pub(crate) const LARGE_GAIN: f64 = 5.99;
    /// Decrease by which a symmetric optimum is another than the one before.
    pub(crate) const ANOTHER_OPTIMUM: f64 = 0.1;
    /// Times that it is asked.
    pub(crate) const MOST_ROUNDS: usize = 4;
    /// Rounds of Gauss and Newton's method to the nearest joint on the boundary, each as long as it comes
    /// nearer.
    pub(crate) const PROJECTION_ROUNDS: usize = 60;
}

/// Laws over frequency, compared.
pub(crate) mod laws {
    /// Probability from which a law, or the mass of a joint, is said to hold, rather than to be the most
    /// probable one.
    pub(crate) const CERTAIN: f64 = 0.95;
    /// Probability from which it is kept what FRFs tell under a law: that of the joint's own law is seldom
    /// lower.
    pub(crate) const KEPT_PROBABILITY: f64 = 1e-3;
    /// Most steps of a law's fit: one that needs more is far from the FRFs.
    pub(crate) const MOST_STEPS: usize = 40;
    /// Steps of a law that is [hopeless](HOPELESS), and of the one without damping, whose resonances are
    /// infinite: it is near at once or not at all.
    pub(crate) const FEW_STEPS: usize = 10;
    /// A law is hopeless that promises a χ² larger by so much than the best one.
    pub(crate) const HOPELESS: f64 = 1000.0;
    /// Laws without mass whose logarithm of the evidence is as near to that of the most probable one are
    /// fitted until they have converged and tried with mass: what a mass explains takes laws without it far
    /// from the FRFs, the true one too.
    pub(crate) const NEAR_LOG_EVIDENCE: f64 = 300.0;
    /// All laws are tried with mass if χ² of one of them falls as much by it.
    pub(crate) const MASS_GAIN: f64 = 10.0;
    /// Coordinate of the mass that they begin with.
    pub(crate) const FIRST_MASS: f64 = 0.05;
}

/// Laws of several joints at once.
pub(crate) mod several {
    use jointscope_inference::Limit;

    /// Shares of the fixture's stiffness at which each joint is tried before a fit begins.
    pub(crate) const GRID: [f64; 5] = [0.4, 0.63, 1.0, 1.6, 2.5];
    /// Places of the grid that are all tried; of more joints one is moved after the other.
    pub(crate) const MOST_ON_GRID: usize = 125;
    /// How often each joint is moved.
    pub(crate) const SWEEPS: usize = 4;
    /// Share of the signal that counts as noise on the grid.
    pub(crate) const SCAN: f64 = 0.3;
    /// Starts of the grid from which a fit is tried.
    pub(crate) const STARTS: usize = 3;
    /// Laws of a round that are gone on with, the nearest to the FRFs, however far the others.
    pub(crate) const NEAREST: usize = 2;
    /// When the fit of a law that competes with others is given up, the nearest being within reach.
    pub(crate) const LIMIT: Limit =
        Limit { objective: 0.0, promises: 3.0, gains: 30.0, patience: 3, reach: 0.0 };
    /// Steps of a law's fit: one that needs more is far from the FRFs.
    pub(crate) const MOST_STEPS: usize = 40;
    /// Of the law without damping, whose resonances are infinite: it is near at once or not at all.
    pub(crate) const FEW_STEPS: usize = 8;
}
