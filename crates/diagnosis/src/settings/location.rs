//! Numbers of the map of places with no law assumed: what a caller may set, and what each of its steps needs
//! besides.

use jointscope_inference::{Convergence, StepDamping};

/// The map of places with no law assumed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LocationSettings {
    /// A recording with more lines than this is thinned for the map.
    pub most_lines: usize,
    /// Lines on which places and laws find their way: half of them peaks.
    pub few_lines: usize,
    /// Noise inflation of the stages from a start.
    pub inflation: [f64; 3],
    /// Stages after which every start, and after which every place, is compared with the best.
    pub compared: usize,
    /// The last stage before places are dropped.
    pub dropped_after: usize,
    /// Steps of a stage, and of a fit without inflation on all lines.
    pub steps: (usize, usize),
    /// Starts that leave more than this many times what the best leaves are not followed.
    pub followed: f64,
    /// Convergence on the way.
    pub near: Convergence,
    /// Convergence at the end.
    pub end: Convergence,
    /// Damping of the steps.
    pub damping: StepDamping,
    /// Places that leave more than the first times the best and the second besides, with inflated noise, are
    /// fitted no further …
    pub promising: (f64, f64),
    /// … and come after all others: what they leave counts this many times.
    pub hopeless: f64,
    /// Places that leave up to this many times what the best leaves on the few lines are fitted on all lines.
    pub rival: f64,
    /// Bands by which a place's misfit is stated.
    pub bands: usize,
    /// Best places whose δ and laws are stated, and what they may leave as a multiple of what the best
    /// leaves.
    pub stated: (usize, f64),
    /// Gain in χ² for which a free scalar sets out again from where a law has led.
    pub elsewhere: f64,
    /// Share of what the refitted fixture leaves that a place, and then its law, may leave for a search to
    /// set out from it.
    pub part: f64,
    /// 1 − γ·bᵀZ⁻¹b, and the compliance of what is in series, must be known to this share of themselves for δ
    /// to be stated.
    pub known: f64,
    /// Laws over frequency.
    pub law: LawSettings,
}

/// Laws over frequency, fitted at a place.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LawSettings {
    /// Starts of a guess that are improved, and steps of each.
    pub guesses: (usize, usize),
    /// Share of their size that counts as noise of the scalars while laws are guessed: δ is never known
    /// better, near resonances least.
    pub relative_noise: f64,
    /// Laws fitted to the FRFs, and how many times what the closest guess leaves the others may leave.
    pub fitted: (usize, f64),
    /// On fewer lines: what the closest law leaves times this is worth another look on all of them.
    pub close: f64,
    /// What each parameter must gain in χ² for a law to be called closer.
    pub penalty: f64,
    /// Noise inflation of the stages.
    pub inflation: [f64; 3],
    /// Steps without inflation on the few lines, and on all.
    pub steps: (usize, usize),
}

impl Default for LocationSettings {
    fn default() -> Self {
        LocationSettings {
            most_lines: 2000,
            few_lines: 72,
            inflation: [0.3, 0.1, 0.02],
            compared: 1,
            dropped_after: 2,
            steps: (3, 4),
            followed: 3.0,
            near: Convergence { gain: 1.0, share: 0.03, floor: 0.0 },
            end: Convergence { gain: 0.1, share: 3e-4, floor: 0.0 },
            damping: StepDamping { initial: 1e-6, decrease: 0.1, least: 1e-9, raised: 1e-3, most: 1e3 },
            promising: (300.0, 1000.0),
            hopeless: 1e6,
            rival: 1.5,
            bands: 12,
            stated: (3, 1.2),
            elsewhere: 1.0,
            part: 0.1,
            known: 1.0 / 3.0,
            law: LawSettings {
                guesses: (2, 12),
                relative_noise: 0.1,
                fitted: (3, 20.0),
                close: 1.5,
                penalty: 3.0,
                inflation: [0.1, 0.03, 0.01],
                steps: (3, 6),
            },
        }
    }
}

/// Places that are tried.
pub(crate) mod sites {
    /// Abscissae of an even grid on each rigid body, its ends included.
    pub(crate) const GRID: usize = 5;
    /// The same on a beam: between two nodes of a bending mode there are several places.
    pub(crate) const GRID_OF_BEAM: usize = 20;
    /// Share of a body's extent within which two abscissae are the same place.
    pub(crate) const SAME_PLACE: f64 = 0.02;
    /// Abscissae of one stretch of a body: each stretch is sought through by itself, for between them a
    /// search does not find the way.
    pub(crate) const STRETCH: usize = 3;
}

/// A line's scalar that does not enter linearly.
pub(crate) mod scalar {
    use jointscope_inference::StepDamping;

    /// Damping of the steps: none but after one that has failed.
    pub(crate) const DAMPING: StepDamping =
        StepDamping { initial: 0.0, decrease: 0.0, least: 0.0, raised: 1.0, most: 1e2 };
    /// Newton steps from a start, at most.
    pub(crate) const MOST_STEPS: usize = 12;
    /// Starts besides its neighbour's and zero.
    pub(crate) const STARTS: [f64; 3] = [-0.3, 0.5, 2.0];
    /// A start that leaves this much per real value needs no others beside it.
    pub(crate) const ENOUGH: f64 = 4.0;
}

/// Laws guessed from the scalars of all lines.
pub(crate) mod guess {
    use jointscope_inference::Convergence;

    /// Decrease of χ² below which a guess is improved no further.
    pub(crate) const CONVERGENCE: Convergence = Convergence { gain: 1e-4, share: 0.0, floor: 0.0 };
}

/// Derivatives by differences.
pub(crate) mod differences {
    /// Relative step of a law's parameters.
    pub(crate) const PARAMETER_STEP: f64 = 1e-5;
}
