//! What errors of a structure's model could explain in a recording, however large they are.
//!
//! A free fit explains filters, delays and sensors that load what they measure by residual terms of any
//! phase. A structure has no such terms at low frequencies: below its modes it moves as rigid bodies do, in
//! phase or in opposite phase with the force. So mass lines, and what modes below the band add, are real
//! here. Modes in the band have any frequency, damping and complex residue, and what modes above the band add
//! has any phase, for these are damped. Where dashpots hold the structure these add what falls with frequency
//! a quarter of a turn away from the mass line; a high-pass does the same to one channel, and is not told
//! from them there.

use crate::basis::{Pole, power_of_term, row};
use crate::recorded::RecordedModes;
use crate::recording::WeightedFrfs;
use crate::settings::structural::UNKNOWN_POLE;
use jointscope_linalg::{Cholesky, dot};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// What modes and residual terms of a structure leave of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Structural {
    /// χ² of the lines that count.
    pub chi2: f64,
    /// Number of real unknowns that were fitted.
    pub unknowns: usize,
    /// Lowest line that counts, Hz.
    pub from: f64,
}

/// Real columns, orthonormal, of which complex values of one FRF are combined, weighted.
struct Basis<'a> {
    weights: &'a [f64],
    columns: Vec<Vec<f64>>,
}

impl Basis<'_> {
    fn weighted(&self, values: impl Iterator<Item = Complex64>) -> Vec<f64> {
        values.zip(self.weights).flat_map(|(v, w)| [v.re * w.sqrt(), v.im * w.sqrt()]).collect()
    }

    /// What the columns leave of values.
    fn left(&self, values: impl Iterator<Item = Complex64>) -> Vec<f64> {
        let mut left = self.weighted(values);
        // Twice is enough.
        for _ in 0..2 {
            for column in &self.columns {
                let along = dot(column, &left);
                left.iter_mut().zip(column).for_each(|(value, q)| *value -= along * q);
            }
        }
        left
    }

    /// Adds a column, if the others do not make it up.
    fn add(&mut self, values: impl Iterator<Item = Complex64> + Clone) {
        let size = dot(&self.weighted(values.clone()), &self.weighted(values.clone())).sqrt();
        let mut left = self.left(values);
        let norm = dot(&left, &left).sqrt();
        if norm > 1e-10 * size {
            left.iter_mut().for_each(|value| *value /= norm);
            self.columns.push(left);
        }
    }
}

impl RecordedModes {
    /// What errors of a structure's model, however large, leave of the `recording` that these modes are from,
    /// to first order about the poles of its free fit; of a structure that is `held_by_dashpots` or not.
    pub fn structural(&self, recording: WeightedFrfs, held_by_dashpots: bool) -> Option<Structural> {
        let hz = recording.frfs.lines().hz();
        let first = hz.partition_point(|hz| *hz < self.band.0);
        let omegas: Vec<f64> = hz[first..].iter().map(|hz| TAU * hz).collect();
        let (lowest, highest) = (*omegas.first()?, *omegas.last()?);
        let (outside, terms) = &self.surroundings;
        let inside = self.modes.len();
        let poles: Vec<Pole> =
            self.modes.iter().map(|mode| mode.pole).chain(outside.iter().copied()).collect();
        let rows: Vec<Vec<Complex64>> =
            omegas.iter().map(|omega| row(&poles, *terms, *omega, highest).collect()).collect();
        // Whether what a column adds is in phase with the force, or of any phase, or nothing that a structure
        // has.
        let phases: Vec<&[Complex64]> = (0..poles.len() + terms)
            .map(|index| -> &[Complex64] {
                match index.checked_sub(poles.len()).map(power_of_term) {
                    None if poles[index].omega < lowest => &[Complex64::ONE],
                    None => &[Complex64::ONE, Complex64::I],
                    Some(power) if power % 2 != 0 => &[],
                    Some(power) if power <= 0 => &[Complex64::ONE],
                    Some(_) => &[Complex64::ONE, Complex64::I],
                }
            })
            .collect();
        let order = 2 * inside;
        let (mut chi2, mut unknowns) = (0.0, order);
        let (mut information, mut right) = (vec![0.0; order * order], vec![0.0; order]);
        for frf in 0..self.frfs() {
            let weights = &recording.weights[frf * hz.len()..(frf + 1) * hz.len()][first..];
            let mut basis = Basis { weights, columns: Vec::new() };
            for (index, phases) in phases.iter().enumerate() {
                phases.iter().for_each(|phase| basis.add(rows.iter().map(|row| row[index] * phase)));
            }
            if held_by_dashpots {
                basis.add(omegas.iter().map(|omega| Complex64::new(0.0, lowest / omega)));
            }
            unknowns += basis.columns.len();
            let left = basis.left(recording.frfs.values(frf)[first..].iter().copied());
            chi2 += dot(&left, &left);
            let slope = |k: usize| {
                let mode = &self.modes[k / 2];
                let by = if k.is_multiple_of(2) { Pole::by_frequency } else { Pole::by_damping };
                let at = |omega: &f64| by(&mode.pole, Complex64::new(0.0, *omega)) * mode.residues[frf];
                basis.left(omegas.iter().map(at))
            };
            let slopes: Vec<Vec<f64>> = (0..order).map(slope).collect();
            for (i, slope) in slopes.iter().enumerate() {
                right[i] += dot(slope, &left);
                slopes
                    .iter()
                    .enumerate()
                    .for_each(|(j, other)| information[i * order + j] += dot(slope, other));
            }
        }
        (0..order).for_each(|k| information[k * (order + 1)] += UNKNOWN_POLE.powi(-2));
        let mut step = right.clone();
        Cholesky::of(order, &information)?.solve_in_place(&mut step);
        Some(Structural { chi2: chi2 - dot(&step, &right), unknowns, from: self.band.0 })
    }
}
