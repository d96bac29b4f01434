//! What errors of a model's modes make of the lines.
//!
//! Where a natural frequency is off by more than its peak is wide, the lines of the peak say that it is, and
//! next to nothing else: a factor that all lines ask for alike may make them worse, for two peaks that miss
//! each other are the nearer the smaller one of them is. What a line says beside such errors is told by how
//! much they make of it. To first order an error of all natural frequencies by a share moves an FRF along its
//! lines by that share.

use crate::Observation;
use crate::modal::sizes::ModelError;
use num_complex::Complex64;

/// What a recording's lines say beside their noise and what errors of a model's modes make of them.
pub(crate) struct LinesBesideErrors<'a> {
    observation: &'a Observation,
    /// By value, the inverse of the covariance of its real and imaginary part: the entries of its lower
    /// triangle. Nothing of values that do not count.
    precisions: Vec<[f64; 3]>,
}

impl LinesBesideErrors<'_> {
    /// χ² of modelled values.
    pub(crate) fn chi2(&self, modelled: &[Complex64]) -> f64 {
        let left =
            self.observation.values().iter().zip(modelled).map(|(measured, modelled)| measured - modelled);
        let squares = left.zip(&self.precisions).map(|(left, [re, both, im])| {
            re * left.re * left.re + 2.0 * both * left.re * left.im + im * left.im * left.im
        });
        squares.sum()
    }
}

impl ModelError {
    /// The lines of a recording beside what these errors make of each value, as a model tells it that predicts
    /// the values `about`. An error of frequencies moves a value along its slope over frequency, of what was
    /// recorded and of the model alike, for both have peaks where the other may have none; one of shapes makes it
    /// larger or smaller. What turns its phase is neither, away from peaks.
    pub(crate) fn beside_lines<'a>(
        &self,
        observation: &'a Observation,
        about: &[Complex64],
    ) -> LinesBesideErrors<'a> {
        let hz = observation.lines().hz();
        let lines = hz.len();
        let slope = |values: &[Complex64], at: usize| {
            let (line, first) = (at % lines, at - at % lines);
            let (from, to) = (line.saturating_sub(1), (line + 1).min(lines - 1));
            let change = values[first + to] - values[first + from];
            if to > from { change / (hz[to] / hz[from]).ln() } else { Complex64::ZERO }
        };
        let precision = |(at, weight): (usize, &f64)| {
            if *weight == 0.0 {
                return [0.0; 3];
            }
            let moved = |of: &[Complex64]| [self.frequency * slope(of, at), self.residue * of[at]];
            // The noise of either part has the inverse of the weight for its variance.
            let mut covariance = [weight.recip(), 0.0, weight.recip()];
            for error in [observation.values(), about].map(moved).as_flattened() {
                let share = [error.re * error.re, error.re * error.im, error.im * error.im];
                covariance.iter_mut().zip(share).for_each(|(sum, part)| *sum += 0.5 * part);
            }
            let [re, both, im] = covariance;
            [im, -both, re].map(|entry| entry / (re * im - both * both))
        };
        let precisions = observation.weights().iter().enumerate().map(precision).collect();
        LinesBesideErrors { observation, precisions }
    }

    /// The share of the recorded squares that is met by modelled ones within twice the error of natural
    /// frequencies: all of it where peaks are no farther off, none where there are no peaks.
    pub(crate) fn squares_met(&self, observation: &Observation, modelled: &[Complex64]) -> f64 {
        let hz = observation.lines().hz();
        let reach = (2.0 * self.frequency).exp();
        let near: Vec<(usize, usize)> = hz
            .iter()
            .map(|at| (hz.partition_point(|hz| *hz < at / reach), hz.partition_point(|hz| *hz <= at * reach)))
            .collect();
        let (mut met, mut all) = (0.0, 0.0);
        for (measured, modelled) in observation.values().chunks(hz.len()).zip(modelled.chunks(hz.len())) {
            let [measured, modelled] = [measured, modelled].map(sums_of_squares);
            for &(from, to) in &near {
                let [own, other] =
                    [&measured, &modelled].map(|sums| (sums[to] - sums[from]) / (to - from) as f64);
                met += own.min(other);
                all += own;
            }
        }
        if all > 0.0 { met / all } else { 1.0 }
    }
}

/// Sums of the squares of the first values, from none to all.
fn sums_of_squares(values: &[Complex64]) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = values.iter().map(|value| {
        sum += value.norm_sqr();
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::simulated::simulated;
    use jointscope_fixture::Fixture;
    use jointscope_lumped::{Instrument, synthesize};
    use jointscope_spectra::{FrfPair, SpectralLines};

    /// A mass of 2 kg on a spring: 200 Hz, or as many times as much.
    fn oscillator(times: f64) -> Fixture {
        let stiffness = 2.0 * (std::f64::consts::TAU * 200.0 * times).powi(2);
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }} }}, "points": {{ "1": {{ "body": "A", "x": 0 }} }},
                 "joints": {{}}, "supports": {{ "ground": {{ "point": "1", "stiffness": {stiffness} }} }},
                 "damping": {{ "modal_ratios": [0.003] }} }}"#
        ))
        .unwrap()
    }

    #[test]
    fn errors_of_shapes_hide_a_gain_as_small_as_they_are_and_no_delay() {
        let pairs = [FrfPair::transverse("1", "1")];
        let lines = SpectralLines::even(100.0, 0.5, 400).unwrap();
        let observation = simulated(&oscillator(1.0), &pairs, &lines, 1e-8);
        let values = observation.values().to_vec();
        let times = |factor: Complex64| values.iter().map(|value| factor * value).collect::<Vec<_>>();
        let chi2 = |errors: &ModelError, modelled: &[Complex64]| {
            errors.beside_lines(&observation, &values).chi2(modelled)
        };
        let none = ModelError::default();
        let of_shapes = ModelError { residue: 0.005, ..none };
        let [larger, turned] = [Complex64::new(1.005, 0.0), Complex64::new(1.0, 0.005)].map(times);
        let plain = observation.chi2(&larger);
        for modelled in [&larger, &turned] {
            assert!((chi2(&none, modelled) / plain - 1.0).abs() < 1e-9, "without errors that of the noise");
        }
        // In every one of 400 lines as much as its deviation, and noise makes it a little wider.
        assert!((380.0..=400.0).contains(&chi2(&of_shapes, &larger)), "{}", chi2(&of_shapes, &larger));
        assert!((chi2(&of_shapes, &turned) / plain - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_peak_beside_its_place_is_met_and_one_that_is_not_there_is_not() {
        let pairs = [FrfPair::transverse("1", "1")];
        let lines = SpectralLines::even(100.0, 0.5, 400).unwrap();
        let observation = simulated(&oscillator(1.0), &pairs, &lines, 1e-8);
        let met = |times: f64, frequency: f64| {
            let frfs = synthesize(&oscillator(times), &pairs, &lines, Instrument::AsRecorded).unwrap();
            let errors = ModelError { frequency, ..ModelError::default() };
            errors.squares_met(&observation, frfs.all_values())
        };
        assert!((met(1.0, 0.0) - 1.0).abs() < 1e-12 && (met(1.0, 0.01) - 1.0).abs() < 1e-12);
        assert!(met(1.01, 0.0) < 0.4, "{:.3} without errors", met(1.01, 0.0));
        assert!(met(1.01, 0.01) > 0.7, "{:.3} beside them", met(1.01, 0.01));
        assert!(met(5.0, 0.01) < 0.1, "{:.3} where the peak is out of the band", met(5.0, 0.01));
    }
}
