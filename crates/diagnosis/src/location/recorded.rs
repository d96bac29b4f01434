//! A recording line after line, as scalars are eliminated from it.

use crate::Observation;
use crate::fitter::Fitter;
use crate::settings::Settings;
use num_complex::Complex64;

/// The FRFs of an observation, line after line, FRF after FRF.
pub(super) struct Recorded<'a> {
    pub observation: &'a Observation,
    pub settings: &'a Settings,
    pub measured: Vec<Complex64>,
    /// 2/σ² by value.
    pub weights: Vec<f64>,
    /// rad/s.
    pub omegas: Vec<f64>,
}

impl<'a> Recorded<'a> {
    pub(super) fn of(fitter: Fitter<'a>) -> Self {
        let Fitter { observation, settings, .. } = fitter;
        let (lines, frfs) = (observation.lines().len(), observation.pairs().len());
        let indices = || (0..lines).flat_map(move |line| (0..frfs).map(move |k| k * lines + line));
        Recorded {
            observation,
            settings,
            measured: indices().map(|index| observation.values()[index]).collect(),
            weights: indices().map(|index| observation.weights()[index]).collect(),
            omegas: observation.lines().omegas().collect(),
        }
    }

    pub(super) fn frfs(&self) -> usize {
        self.observation.pairs().len()
    }

    pub(super) fn lines(&self) -> usize {
        self.omegas.len()
    }

    /// Values of one line among those of all.
    pub(super) fn places(&self, line: usize) -> std::ops::Range<usize> {
        line * self.frfs()..(line + 1) * self.frfs()
    }

    /// The weights when a share `epsilon` of the values counts as noise.
    pub(super) fn inflated(&self, epsilon: f64, modelled: &[Complex64]) -> Vec<f64> {
        if epsilon == 0.0 {
            return self.weights.clone();
        }
        let (lines, frfs) = (self.lines(), self.frfs());
        let mut all = Vec::with_capacity(lines * frfs);
        for line in 0..lines {
            for k in 0..frfs {
                all.push(self.observation.inflated(k * lines + line, modelled[line * frfs + k], epsilon));
            }
        }
        all
    }
}

/// An observation on about `count` lines: evenly thinned ones, and as many of those with the largest signal
/// against noise, which are the peaks. `None` where it has no more than that.
pub(super) fn most_informative(observation: &Observation, count: usize) -> Option<Observation> {
    let n = observation.lines().len();
    if n <= count {
        return None;
    }
    let signal = |line: usize| -> f64 {
        let places = (0..observation.pairs().len()).map(|k| k * n + line);
        places.map(|at| observation.weights()[at] * observation.values()[at].norm_sqr()).sum()
    };
    let signals: Vec<f64> = (0..n).map(signal).collect();
    let mut sorted = signals.clone();
    sorted.sort_by(f64::total_cmp);
    let loud = sorted[n - count / 2];
    let every = n.div_ceil(count.div_ceil(2));
    let hz = observation.lines().hz();
    let kept = |frequency: f64| {
        let line = hz.partition_point(|f| *f < frequency).min(n - 1);
        line % every == 0 || signals[line] >= loud
    };
    observation.reduced(kept, |_| true)
}
