//! What is said of each hit and each excitation after an estimation: faults, use, and force.

use jointscope_spectra::Channel;

use crate::Fault;

/// What became of one hit.
#[derive(Debug, Clone, PartialEq)]
pub struct HitReport {
    /// Its number.
    pub number: u32,
    /// Where the hammer struck.
    pub struck: Channel,
    /// Its largest force, with its sign, N.
    pub peak_force: f64,
    /// How long the force was above a twentieth of its peak, s.
    pub width: f64,
    /// What is wrong with it.
    pub faults: Vec<Fault>,
    /// Whether the analyst asked for it to be left out.
    pub rejected_by_hand: bool,
    /// Whether it was used.
    pub used: bool,
}

impl HitReport {
    /// Why it was not used, or is wrong though it was, in words; `None` of a hit without fault.
    pub fn why(&self) -> Option<String> {
        if self.rejected_by_hand {
            return Some("left out by `--reject`".to_owned());
        }
        let mut faults: Vec<String> = self.faults.iter().map(Fault::to_string).collect();
        // One overload is like another.
        faults.dedup();
        (!faults.is_empty()).then(|| faults.join("; "))
    }
}

/// What the hammer put in at one struck point.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Where it struck.
    pub struck: Channel,
    /// The hits used, by number.
    pub hits: Vec<u32>,
    /// Root mean square over those hits of the force's spectrum |F(ω)| = |∫ f e^(−iωt) dt| by line, N·s.
    pub spectrum: Vec<f64>,
    /// Root mean square of what the force's noise contributes to it, N·s.
    pub noise: f64,
    /// Highest frequency up to which the spectrum stays within 20 dB of its largest, and within 0.8 of half
    /// the sampling rate, Hz.
    pub usable_to: f64,
    /// Largest relative amount, over the lines from there down, by which H1 reads low for the force's noise.
    pub h1_bias: f64,
}
