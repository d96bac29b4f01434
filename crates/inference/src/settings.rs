//! How a descent goes: its damping, when it has converged, and when it is given up.

/// Damping of the steps, relative to each coordinate's own curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepDamping {
    /// To begin with.
    pub initial: f64,
    /// Factor after a step that lowered the objective.
    pub decrease: f64,
    /// Never less.
    pub least: f64,
    /// At least this after a step that did not; tenfold otherwise.
    pub raised: f64,
    /// Beyond this no step is expected to lower the objective.
    pub most: f64,
}

/// Decrease of the objective below which a fit has converged: the larger of the two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Absolute decrease.
    pub gain: f64,
    /// Decrease as a share of what the objective exceeds `floor` by.
    pub share: f64,
    /// Objective of a perfect model: its degrees of freedom where noise is known, else zero.
    pub floor: f64,
}

impl Convergence {
    pub(crate) fn needed(&self, objective: f64) -> f64 {
        self.gain.max(self.share * (objective - self.floor).max(0.0))
    }
}

/// When a fit that competes with others is given up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Objective that it has to reach.
    pub objective: f64,
    /// Given up where this many times what its derivatives promise would not reach it.
    pub promises: f64,
    /// Given up where it is farther away than this many gains like that of its last derivatives…
    pub gains: f64,
    /// … from this many sets of derivatives on …
    pub patience: usize,
    /// … and farther than this. Within it, derivatives are exact.
    pub reach: f64,
}

impl Limit {
    /// Whether a fit that stands at `objective` will not reach the limit by what its derivatives promise.
    /// Along a curved valley they promise little of what there is, so within reach no promise is too small.
    pub(crate) fn is_out_of_reach(&self, objective: f64, promised: f64) -> bool {
        objective - self.promises * promised > self.objective && objective - self.objective > self.reach
    }
}

/// How a descent goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Steps at the most.
    pub steps: usize,
    /// Sets of derivatives at the most.
    pub derivatives: usize,
    /// Damping of the steps.
    pub damping: StepDamping,
    /// When it has converged.
    pub convergence: Convergence,
    /// Derivatives serve for as long as a step gains this share of their first one's gain; `None` takes them
    /// anew for every step.
    pub reuse: Option<f64>,
    /// Whether derivatives that a descent is given pass for those of its start: taken there, or so near that
    /// a step by them is as good.
    pub fresh: bool,
    /// Whether a fit may be called converged by derivatives that were taken elsewhere.
    pub trust_old: bool,
    /// Whether the last steps use [`DerivativePrecision::Exact`](crate::DerivativePrecision::Exact)
    /// derivatives.
    pub exact_at_end: bool,
    /// Objective to be reached, for one fit among many.
    pub limit: Option<Limit>,
    /// Share of what an undamped step promises below which a step with new derivatives follows a curved
    /// valley: then shares of the undamped step are tried, which goes along the valley where damping goes
    /// hardly anywhere. Zero tries none.
    pub curved_valley: f64,
    /// How often an undamped step is tried where the damped ones gain little of what is promised, as along a
    /// flat valley.
    pub valleys: usize,
}

impl Default for Settings {
    /// Derivatives anew for every step, to convergence at a relative decrease of 1e-9.
    fn default() -> Self {
        Settings {
            steps: 60,
            derivatives: usize::MAX,
            damping: StepDamping { initial: 1e-6, decrease: 0.1, least: 1e-15, raised: 0.0, most: 1e8 },
            convergence: Convergence { gain: 0.0, share: 1e-9, floor: 0.0 },
            reuse: None,
            fresh: false,
            trust_old: false,
            exact_at_end: false,
            limit: None,
            curved_valley: 0.0,
            valleys: 0,
        }
    }
}
