//! The pulse of a hit: where it begins and ends, and what the channel shows apart from it.

use crate::settings::pulse::{EDGE, FILTER_RINGING, WIDTHS_BEFORE};

/// The main pulse of a force without offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pulse {
    /// First sample above a twentieth of the peak.
    pub begin: usize,
    /// First sample after the pulse.
    pub end: usize,
    /// The peak's sample.
    pub peak_at: usize,
    /// The peak, N, with its sign.
    pub peak: f64,
    /// Standard deviation of the force away from the pulse, N, by the median of what is there.
    pub noise: f64,
}

impl Pulse {
    /// The pulse about the largest value; `None` where all samples are zero.
    pub(crate) fn of(force: &[f64]) -> Option<Self> {
        let largest = |best: usize, i: usize| if force[i].abs() > force[best].abs() { i } else { best };
        let peak_at = (0..force.len()).fold(0, largest);
        let peak = *force.get(peak_at)?;
        if peak == 0.0 {
            return None;
        }
        let above = |i: &usize| force[*i] * peak.signum() > EDGE * peak.abs();
        let begin = (0..peak_at).rev().take_while(above).last().unwrap_or(peak_at);
        let end = (peak_at..force.len()).take_while(above).last().unwrap_or(peak_at) + 1;
        let after = (end + FILTER_RINGING).min(force.len());
        let mut rest: Vec<f64> = force[after..].iter().map(|f| f.abs()).collect();
        Some(Pulse { begin, end, peak_at, peak, noise: spread(&mut rest) })
    }

    /// Samples from begin to end.
    pub(crate) fn width(&self) -> usize {
        self.end - self.begin
    }

    /// Samples before the hit that neither it nor a filter's ringing reaches.
    pub(crate) fn before(&self) -> usize {
        self.begin.saturating_sub(FILTER_RINGING.max(WIDTHS_BEFORE * self.width()))
    }
}

/// Standard deviation of normal values whose magnitudes are given, from their median.
pub(crate) fn spread(magnitudes: &mut [f64]) -> f64 {
    if magnitudes.is_empty() {
        return 0.0;
    }
    let middle = magnitudes.len() / 2;
    1.4826 * *magnitudes.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pulse_runs_from_a_twentieth_of_its_peak_to_a_twentieth() {
        let mut force = vec![0.01; 100];
        force[50..55].copy_from_slice(&[-2.0, -40.0, -100.0, -30.0, -4.0]);
        let pulse = Pulse::of(&force).unwrap();
        assert_eq!((pulse.begin, pulse.end, pulse.peak_at, pulse.peak), (51, 54, 52, -100.0));
        assert!((pulse.noise - 0.014826).abs() < 1e-9);
        assert_eq!(Pulse::of(&[0.0; 8]), None);
    }
}
