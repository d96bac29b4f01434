//! What the analyst chooses of an estimation: estimator, weights, baseline, windows, and hits to keep or
//! leave out.

/// How an FRF follows from the spectra of force and response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// S_yx/S_xx: right where only the responses are noisy; the force's noise makes it read low.
    #[default]
    H1,
    /// S_yy/S_xy: right where only the force is noisy; the responses' noise makes it read high.
    H2,
    /// √(H1·H2), the magnitude between the two and their common phase.
    Hv,
}

impl Estimator {
    /// `H1`, `H2` or `Hv`.
    pub fn name(self) -> &'static str {
        match self {
            Estimator::H1 => "H1",
            Estimator::H2 => "H2",
            Estimator::Hv => "Hv",
        }
    }
}

/// How much each hit counts in an average.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weighting {
    /// As its force, which is the textbook's average, unless the hits' noise differs: then each spectrum
    /// counts inversely to the power of its noise, as their scatter about the average shows it. Three hits
    /// are needed to tell.
    #[default]
    Auto,
    /// As its force.
    Plain,
}

/// What is taken off every signal beside mains hum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Baseline {
    /// A constant: the mean before the hit, or, without enough samples there, of those that neither hit nor
    /// ringing moves far.
    #[default]
    Offset,
    /// A straight line through the samples that neither the hit nor the ringing moves far.
    Drift,
    /// Nothing, and no hum either.
    Keep,
}

/// The window over the force: 1 up to its length after the hit's onset, then a quarter of that as half a
/// cosine to 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ForceWindow {
    /// None.
    #[default]
    None,
    /// Ten widths of the pulse after it.
    Auto,
    /// So many seconds after the hit's onset.
    Length(f64),
}

/// The exponential window over all signals of a hit, e^(−decay·t) from the hit's onset.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ResponseWindow {
    /// None.
    #[default]
    None,
    /// One that lets the slowest response fall to 10⁻⁴ of its loudest part, where it does not by itself.
    Auto,
    /// One of this decay, 1/s.
    Decay(f64),
}

impl EstimateOptions {
    /// FRFs that a model is held against: H1 without the bias of the force's noise, under an exponential
    /// window where a record ends before the motion does.
    pub fn for_models() -> Self {
        EstimateOptions {
            response_window: ResponseWindow::Auto,
            zero_padding: 1,
            unbiased: true,
            ..EstimateOptions::default()
        }
    }
}

/// How FRFs are made of hits. The default is the textbook's: H1, no windows, no zero padding, constants taken
/// off.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EstimateOptions {
    /// H1, H2 or Hv.
    pub estimator: Estimator,
    /// How much each hit counts.
    pub weighting: Weighting,
    /// What is taken off every signal.
    pub baseline: Baseline,
    /// Window over the force.
    pub force_window: ForceWindow,
    /// Window over all signals.
    pub response_window: ResponseWindow,
    /// Records are filled with zeros to so many times their length; 0 and 1 are none.
    pub zero_padding: u32,
    /// Whether the power that the force's noise adds to the denominator of H1 is taken off, as the samples
    /// apart from the blow show it: H1 is then right with noise on both channels.
    pub unbiased: bool,
    /// Numbers of hits to use whatever is wrong with them.
    pub keep: Vec<u32>,
    /// Numbers of hits to leave out.
    pub reject: Vec<u32>,
}
