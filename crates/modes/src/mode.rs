//! A mode: natural frequency, damping ratio, shape with deviations; how alike two shapes are.

use jointscope_spectra::{Channel, FrfPair};
use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::likelihood::Likelihood;
use crate::observed::Observed;
use crate::scatter::{DriftingMode, Scatter, deviations};
use crate::selection::{is_inside, worth};
use crate::settings::quality::VAGUE_DAMPING;

/// A mode, with the standard deviations of its numbers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Mode {
    /// Natural frequency |λ|/2π, Hz.
    pub frequency: f64,
    /// Its standard deviation, Hz.
    pub frequency_std: f64,
    /// Damping ratio −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Its standard deviation.
    pub damping_std: f64,
    /// The pole λ of the model that all FRFs share, rad/s. Where the mode drifts, frequency and damping ratio
    /// are those of the FRFs one by one.
    pub pole: Complex64,
    /// Correlation of the errors of frequency and damping ratio.
    pub correlation: f64,
    /// How far the mode moves from FRF to FRF, where that is more than noise.
    pub drift: Option<DriftingMode>,
    /// Residue ρ of the receptance in each FRF, α = Σ ρ/(s − λ) + …: 1/(kg·rad/s) for transverse channels.
    pub residues: Vec<Complex64>,
    /// Standard deviation of each residue's real and of its imaginary part.
    pub residue_std: Vec<f64>,
    /// The shape over the responses; empty where the matrix of FRFs has gaps. Its largest entry is one, or
    /// that of responses and references together where a driving point tells what one is against the other.
    pub responses: Vec<(Channel, Complex64)>,
    /// The shape over the references, by reciprocity the same one.
    pub references: Vec<(Channel, Complex64)>,
    /// Modal mass for this shape, kg; told by driving points only, of shapes that are nearly real.
    pub modal_mass: Option<f64>,
    /// Modal phase collinearity: 1 where all residues are in phase or in opposition, as those of a
    /// proportionally damped structure are.
    pub phase_collinearity: f64,
    /// Rise of χ² without the mode over the rise that it takes to be told from noise.
    pub worth: f64,
}

impl Mode {
    /// Whether the FRFs cannot be explained as well without it.
    pub fn stands_out(&self) -> bool {
        self.worth >= 1.0
    }

    /// Takes a window's decay (1/s) off the mode's damping.
    pub(crate) fn take_off(&mut self, decay: f64) {
        self.pole += decay;
        let under_window = TAU * self.frequency;
        let damping = self.damping_ratio * under_window;
        let own =
            f64::hypot((under_window * under_window - damping * damping).max(0.0).sqrt(), damping - decay);
        self.frequency = own / TAU;
        self.damping_ratio = (damping - decay) / own;
    }

    /// Whether the damping ratio is known by its order of magnitude only.
    pub fn is_vaguely_damped(&self) -> bool {
        self.damping_std > VAGUE_DAMPING * self.damping_ratio
    }
}

/// Modal assurance criterion |aᴴb|²/(aᴴa·bᴴb) of two vectors, 0 where one of them is nothing.
pub fn mac(a: &[Complex64], b: &[Complex64]) -> f64 {
    let dot: Complex64 = a.iter().zip(b).map(|(x, y)| x.conj() * y).sum();
    let size = |v: &[Complex64]| v.iter().map(|x| x.norm_sqr()).sum::<f64>();
    let sizes = size(a) * size(b);
    if sizes > 0.0 { dot.norm_sqr() / sizes } else { 0.0 }
}

/// The modes inside the band and those outside of it, each by ascending frequency.
pub(crate) fn modes_of(
    observed: &Observed,
    fit: &Likelihood,
    scatter: &[Scatter],
    pairs: &[FrfPair],
) -> (Vec<Mode>, Vec<Mode>) {
    let worth = worth(observed, fit);
    let covariance = fit.pole_covariance();
    // What the model does not explain is counted as noise.
    let inflation = fit.chi2_per_dof(observed).max(1.0);
    let mut all: Vec<Mode> = (0..fit.poles.poles.len())
        .map(|r| {
            let pole = fit.poles.poles[r];
            let [frequency, ratio] = deviations(pole, covariance[r]);
            let drift = scatter[r].drift.clone();
            let (frequency_value, damping_value, frequency_std, damping_std) = match &scatter[r].means {
                Some([f, z]) => (f.value, z.value, f.std, z.std),
                None => {
                    let root = inflation.sqrt();
                    (pole.norm() / TAU, -pole.re / pole.norm(), frequency.0 * root, ratio.0 * root)
                }
            };
            let (residues, residue_std) = residues(observed, fit, r);
            let (responses, references) = shapes(observed, fit, r, pairs);
            Mode {
                frequency: frequency_value,
                frequency_std,
                damping_ratio: damping_value,
                damping_std,
                pole,
                correlation: ratio.1,
                drift,
                modal_mass: modal_mass(&residues, pairs, pole, &responses),
                phase_collinearity: phase_collinearity(&residues),
                residues,
                residue_std: residue_std.iter().map(|s| s * inflation.sqrt()).collect(),
                responses,
                references,
                worth: worth[r],
            }
        })
        .collect();
    all.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    all.into_iter().partition(|mode| is_inside(&mode.pole, observed))
}

fn residues(observed: &Observed, fit: &Likelihood, mode: usize) -> (Vec<Complex64>, Vec<f64>) {
    let mut residues = vec![Complex64::ZERO; observed.frfs()];
    let mut deviations = vec![0.0; observed.frfs()];
    for (row, frfs) in observed.grid.rows.iter().enumerate() {
        for (column, &frf) in frfs.iter().enumerate() {
            let factor = fit.poles.participations[mode][column];
            residues[frf] = fit.entries[mode][row] * factor;
            deviations[frf] = fit.entry_std[mode][row] * factor.norm();
        }
    }
    (residues, deviations)
}

type Shape = Vec<(Channel, Complex64)>;

/// The shape over responses and over references.
fn shapes(observed: &Observed, fit: &Likelihood, mode: usize, pairs: &[FrfPair]) -> (Shape, Shape) {
    let grid = &observed.grid;
    if grid.row_channels.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let named = |channels: &[Channel], entries: &[Complex64]| {
        channels.iter().cloned().zip(entries.iter().copied()).collect::<Shape>()
    };
    let mut rows = named(&grid.row_channels, &fit.entries[mode]);
    let mut columns = named(&grid.column_channels, &fit.poles.participations[mode]);
    // A driving point stands in both: it tells the factor between them.
    let (mut common, mut size) = (Complex64::ZERO, 0.0);
    for (channel, column) in &columns {
        if let Some((_, row)) = rows.iter().find(|(other, _)| other == channel) {
            common += column.conj() * row;
            size += column.norm_sqr();
        }
    }
    let all = if common.norm() > 0.0 {
        columns.iter_mut().for_each(|(_, value)| *value *= common / size);
        largest(rows.iter().chain(&columns))
    } else {
        let by = largest(&columns);
        scale(&mut columns, by);
        largest(&rows)
    };
    scale(&mut rows, all);
    if common.norm() > 0.0 {
        scale(&mut columns, all);
    }
    // Of a single FRF both are one channel.
    let rows_respond = grid
        .rows
        .first()
        .and_then(|frfs| frfs.first())
        .is_none_or(|&frf| grid.row_channels.first() == Some(&pairs[frf].response));
    if rows_respond { (rows, columns) } else { (columns, rows) }
}

fn largest<'a>(entries: impl IntoIterator<Item = &'a (Channel, Complex64)>) -> Complex64 {
    let values = entries.into_iter().map(|(_, value)| *value);
    values.fold(Complex64::ZERO, |best, value| if value.norm() > best.norm() { value } else { best })
}

fn scale(shape: &mut Shape, by: Complex64) {
    if by.norm() > 0.0 {
        shape.iter_mut().for_each(|(_, value)| *value /= by);
    }
}

/// m = φ_p²/(2i·ω_d·ρ_pp): what a driving point tells of the modal mass of a shape φ, the mean over them
/// weighted by φ_p⁴.
fn modal_mass(residues: &[Complex64], pairs: &[FrfPair], pole: Complex64, responses: &Shape) -> Option<f64> {
    let (mut inverse, mut weight) = (0.0, 0.0);
    for (residue, pair) in residues.iter().zip(pairs).filter(|(_, pair)| pair.response == pair.reference) {
        let (_, entry) = responses.iter().find(|(channel, _)| *channel == pair.response)?;
        let squared = entry.norm_sqr();
        inverse += squared * (Complex64::new(0.0, 2.0 * pole.im) * residue).re;
        weight += squared * squared;
    }
    let mass = weight / inverse;
    (weight > 0.0 && mass.is_finite() && mass > 0.0).then_some(mass)
}

/// ((λ₁ − λ₂)/(λ₁ + λ₂))² of the eigenvalues of the 2×2 scatter of real and imaginary parts.
fn phase_collinearity(values: &[Complex64]) -> f64 {
    let rr: f64 = values.iter().map(|v| v.re * v.re).sum();
    let ii: f64 = values.iter().map(|v| v.im * v.im).sum();
    let ri: f64 = values.iter().map(|v| v.re * v.im).sum();
    let sum = rr + ii;
    if sum > 0.0 { ((rr - ii).powi(2) + 4.0 * ri * ri) / (sum * sum) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mac_ignores_scale_and_phase_and_tells_orthogonal_shapes_apart() {
        let a = [Complex64::new(1.0, 0.2), Complex64::new(-0.5, 0.1)];
        let b: Vec<Complex64> = a.iter().map(|v| v * Complex64::from_polar(3.0, 1.0)).collect();
        assert!((mac(&a, &b) - 1.0).abs() < 1e-14);
        let c = [-a[1].conj(), a[0].conj()];
        assert!(mac(&a, &c) < 1e-28);
        assert_eq!(mac(&a, &[Complex64::ZERO; 2]), 0.0);
    }

    #[test]
    fn in_phase_residues_are_collinear_and_a_rotating_shape_is_not() {
        let turned = |phases: [f64; 4]| phases.map(|p| Complex64::from_polar(1.0, p));
        assert!((phase_collinearity(&turned([0.3, 0.3, 0.3 + TAU / 2.0, 0.3])) - 1.0).abs() < 1e-12);
        assert!(phase_collinearity(&turned([0.0, TAU / 4.0, TAU / 2.0, 3.0 * TAU / 4.0])) < 1e-12);
    }
}
