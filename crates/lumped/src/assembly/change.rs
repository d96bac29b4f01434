//! How the modes of an assembly of rigid bodies change with its fixture, to first order.
//!
//! With dM and dK of a change and mass-normalised shapes, for a mode r and any other one k (Fox and Kapoor
//! 1968):
//!
//! dλ_r = φ_rᵀ (dK − λ_r dM) φ_r,
//! dφ_r = Σ_k c_kr φ_k, c_kr = φ_kᵀ (dK − λ_r dM) φ_r / (λ_r − λ_k), c_rr = −½ φ_rᵀ dM φ_r.
//!
//! All modes are known, so the sum is complete and nothing is solved for. Motions as rigid may turn among
//! each other; what they answer together does not depend on it, and c_kr = −½ φ_kᵀ dM φ_r keeps them
//! orthonormal. dM, dK and the rows that read stations are differences between two fixtures: these matrices
//! are smooth where FRFs are not, and a step far too small for FRFs leaves them eight digits.

use super::coordinates::{Coordinates, coordinates};
use super::matrices::Matrices;
use super::{Assembly, damping_law};
use crate::Station;
use crate::held::{held_by_modes, in_the_modes};
use jointscope_damping::{HeldMode, ModeDamping, elastic_modes};
use jointscope_fixture::Fixture;
use jointscope_linalg::dot;

/// Changes of an assembly, divided by the step from one fixture to the other.
#[derive(Debug, Clone)]
pub(crate) struct AssemblyChange {
    step: f64,
    /// Where coordinates stand after the step.
    places: Vec<Coordinates>,
    /// c_kr, a row over r for each k; nothing where neither mass nor stiffness changes.
    mixing: Vec<f64>,
    /// dλ of each mode.
    pub eigenvalues: Vec<f64>,
    pub damping: Vec<ModeDamping>,
}

/// Whether a fixture has meshed bodies, of whose modes not all are known.
pub(crate) fn has_meshed_bodies(fixture: &Fixture) -> bool {
    fixture.bodies().iter().any(|body| body.kind.is_beam())
}

impl Assembly {
    /// What a `step` changes that leads from `fixture`, whose assembly this is, to `moved`, a fixture of the
    /// same bodies, joints and supports; `None` for meshed bodies, and where the change has no derivative.
    pub(crate) fn change(&self, fixture: &Fixture, moved: &Fixture, step: f64) -> Option<AssemblyChange> {
        if has_meshed_bodies(moved) || in_the_modes(fixture) != in_the_modes(moved) {
            return None;
        }
        let places = coordinates(moved, 0.0).ok()?;
        let there = Matrices::of(moved, &places, self.order, false);
        let mass = self.projected(&self.mass, &there.mass, step);
        let stiffness = self.projected(&self.stiffness, &there.stiffness, step);
        let (eigenvalues, mixing) = self.mixed(mass, stiffness)?;
        let still = AssemblyChange { step, places, mixing, eigenvalues, damping: Vec::new() };
        let damping = self.damping_change(&still, fixture, moved)?;
        Some(AssemblyChange { damping, ..still })
    }

    /// Ξᵀ (after − before) Ξ/step; `None` where nothing differs.
    fn projected(&self, before: &[f64], after: &[f64], step: f64) -> Option<Vec<f64>> {
        let n = self.order;
        let mut all: Option<Vec<f64>> = None;
        for (i, (before, after)) in before.chunks_exact(n).zip(after.chunks_exact(n)).enumerate() {
            if before == after {
                continue;
            }
            let row: Vec<f64> = before.iter().zip(after).map(|(b, a)| (a - b) / step).collect();
            let through: Vec<f64> = (0..n).map(|s| dot(&row, self.basis.shape(s))).collect();
            let all = all.get_or_insert_with(|| vec![0.0; n * n]);
            for (k, sums) in all.chunks_exact_mut(n).enumerate() {
                let amplitude = self.basis.shape(k)[i];
                sums.iter_mut().zip(&through).for_each(|(sum, t)| *sum += amplitude * t);
            }
        }
        all
    }

    /// dλ_r and c_kr of changes in the modes' coordinates; `None` where two modes that are not rigid have one
    /// eigenvalue.
    fn mixed(&self, mass: Option<Vec<f64>>, stiffness: Option<Vec<f64>>) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = self.order;
        if mass.is_none() && stiffness.is_none() {
            return Some((vec![0.0; n], Vec::new()));
        }
        let [mass, stiffness] = [mass, stiffness].map(|all| all.unwrap_or_else(|| vec![0.0; n * n]));
        let values = self.basis.eigenvalues();
        let mut mixing = vec![0.0; n * n];
        for (k, row) in mixing.chunks_exact_mut(n).enumerate() {
            for (r, entry) in row.iter_mut().enumerate() {
                let at = k * n + r;
                *entry = if k == r || (values[k] == 0.0 && values[r] == 0.0) {
                    -0.5 * mass[at]
                } else if values[k] == values[r] {
                    return None;
                } else {
                    (stiffness[at] - values[r] * mass[at]) / (values[r] - values[k])
                };
            }
        }
        let change = |r: usize| match values[r] {
            0.0 => 0.0,
            value => stiffness[r * n + r] - value * mass[r * n + r],
        };
        Some(((0..n).map(change).collect(), mixing))
    }

    /// The change of each mode's damping by that of its eigenvalue, of its motion at supports and of the law;
    /// `None` where ratios pass to other modes.
    fn damping_change(
        &self,
        change: &AssemblyChange,
        fixture: &Fixture,
        moved: &Fixture,
    ) -> Option<Vec<ModeDamping>> {
        let step = change.step;
        let eigenvalues = self.basis.eigenvalues().iter().zip(&change.eigenvalues);
        let mut modes: Vec<HeldMode> = eigenvalues
            .map(|(value, change)| HeldMode {
                eigenvalue: value + step * change,
                in_supports: 0.0,
                dashpots: 0.0,
            })
            .collect();
        for (before, after) in held_by_modes(fixture).zip(held_by_modes(moved)) {
            let motions = self.participation(&before.station);
            let parts = [[(1.0, before.station)], [(1.0, after.station)]];
            let changes = self.participation_change(change, &motions, &parts[0], &parts[1]);
            for ((mode, motion), change) in modes.iter_mut().zip(&motions).zip(&changes) {
                let squared = (motion + step * change).powi(2);
                mode.in_supports += after.stiffness * squared / mode.eigenvalue.max(f64::MIN_POSITIVE);
                mode.dashpots += after.damping * squared;
            }
        }
        if elastic_modes(&modes) != self.elastic {
            return None;
        }
        let after = damping_law(moved.damping()).of_held_modes(&modes);
        let slope = |(after, before): (&ModeDamping, &ModeDamping)| ModeDamping {
            viscous: (after.viscous - before.viscous) / step,
            structural: (after.structural - before.structural) / step,
        };
        Some(after.iter().zip(&self.damping).map(slope).collect())
    }

    /// The change of `participation` in each mode: of weighted motions that are `before`, and `after` the
    /// step.
    pub(crate) fn participation_change<'s>(
        &self,
        change: &AssemblyChange,
        participation: &[f64],
        before: impl IntoIterator<Item = &'s (f64, Station)>,
        after: impl IntoIterator<Item = &'s (f64, Station)>,
    ) -> Vec<f64> {
        let n = self.order;
        let mut all = vec![0.0; n];
        for (row, motion) in change.mixing.chunks_exact(n).zip(participation) {
            all.iter_mut().zip(row).for_each(|(all, share)| *all += share * motion);
        }
        let here = read(&self.places, before);
        let there = read(&change.places, after);
        let at =
            |row: &[(usize, f64)], i: usize| row.iter().find(|(at, _)| *at == i).map_or(0.0, |(_, t)| *t);
        let mut places: Vec<usize> = here.iter().chain(&there).map(|(i, _)| *i).collect();
        places.sort_unstable();
        places.dedup();
        for i in places {
            // Sums before differences: what stays the same leaves exactly nothing, which stiff joints would
            // multiply.
            let t = (at(&there, i) - at(&here, i)) / change.step;
            if t != 0.0 {
                all.iter_mut().enumerate().for_each(|(r, all)| *all += self.basis.shape(r)[i] * t);
            }
        }
        all
    }
}

/// The row that reads weighted motions where coordinates stand at `places`: its few entries by their place.
fn read<'s>(
    places: &[Coordinates],
    parts: impl IntoIterator<Item = &'s (f64, Station)>,
) -> Vec<(usize, f64)> {
    let (mut row, mut of_part): (Vec<(usize, f64)>, _) = (Vec::new(), Vec::with_capacity(2));
    for (weight, part) in parts {
        of_part.clear();
        places[part.body].add_entries(part.x, part.dof, &mut of_part);
        for &(i, t) in &of_part {
            match row.iter_mut().find(|(at, _)| *at == i) {
                Some((_, sum)) => *sum += weight * t,
                None => row.push((i, weight * t)),
            }
        }
    }
    row
}
