//! The modes of an assembly that differs next to nothing from one at hand, to first order.
//!
//! For derivatives by differences alone: a step of a thousandth of a standard deviation moves the matrices by
//! so little that a whole eigenproblem tells no more than first-order perturbation (Fox and Kapoor 1968),
//! with dM and dK between the two assemblies themselves:
//!
//! dλ_r = φ_rᵀ (dK − λ_r dM) φ_r,
//! dφ_r = Σ_k c_kr φ_k, c_kr = φ_kᵀ (dK − λ_r dM) φ_r / (λ_r − λ_k), c_rr = −½ φ_rᵀ dM φ_r.
//!
//! Condensed modes are as many as coordinates, and orthogonal but for a little inertia that is left out of
//! them anyway, so the sums are complete. Two modes far above the band may have one eigenvalue, as equal
//! stretches of a beam do; what they yield together statically is all that the band sees of them, and
//! c_kr = −φ_kᵀ dK φ_r / (λ_k + λ_r) for both orders of k and r gives exactly that. Shapes are not written
//! out: the participation of a motion changes by cᵀ times itself.

use super::coordinates::{Coordinates, coordinates};
use super::matrices::Matrices;
use super::turned::Turned;
use super::{Assembly, has_meshed_bodies, is_one_free_body, rebuilds, rebuilt_damping};
use crate::held::in_the_modes;
use jointscope_fixture::Fixture;
use jointscope_linalg::ModalBasis;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A mode is far above the band from so many times its highest line.
const FAR: f64 = 10.0;
/// Share of another mode that a mode takes on at most: the second order is then this share of the first.
const TURNED: f64 = 2e-3;
/// Rounding of a node's place as a share of the length. One that moves along with what turns the beam there
/// leaves shapes behind that have their kinks elsewhere.
const ROUNDING: f64 = 1e-12;

impl Assembly {
    /// Whether the modes were found beside another assembly's.
    pub(crate) fn is_first_order(&self) -> bool {
        self.turned.is_some()
    }

    /// Whether assemblies of fixtures next to this one may take their modes from its own: there is an
    /// eigenproblem to be saved.
    pub(crate) fn has_neighbours(fixture: &Fixture) -> bool {
        has_meshed_bodies(fixture) && !is_one_free_body(fixture)
    }

    /// The amplitudes of all modes coordinate after coordinate: its own, and those of what it is rebuilt
    /// from.
    pub(crate) fn rows(&self) -> Rows {
        let plain = self.plain.as_ref().map(|plain| by_coordinate(&plain.assembly.basis));
        Rows { own: by_coordinate(&self.basis), plain }
    }

    /// The assembly of `moved`, which differs next to nothing from `fixture`, whose assembly this is: modes
    /// to first order from those at hand, of which these are the `rows`. `None` where there is more to solve
    /// than that: fixtures that differ by more or in kind, beams whose modes cost little anyway, modes too
    /// close to each other.
    ///
    /// Of a beam that effects rebuild these are less sharp: condensed modes leave a little inertia out, more
    /// of it where sections resist being turned (derivatives by the rotary inertia are off by a hundredth),
    /// and how the viscosity of the modes before is shared among the rebuilt ones stays as it is.
    pub(crate) fn beside(
        &self,
        (fixture, rows): (&Fixture, &Rows),
        moved: &Fixture,
        highest_hz: f64,
    ) -> Option<Self> {
        if !Assembly::has_neighbours(moved) || rebuilds(moved) != self.plain.is_some() {
            return None;
        }
        let mut assembly = self.turned((fixture, &rows.own), moved, highest_hz)?;
        match self.plain.as_deref().zip(rows.plain.as_deref()) {
            None => assembly.damp_by_modes(moved),
            Some((plain, rows)) => {
                let mut before = plain.assembly.turned((fixture, rows), moved, highest_hz)?;
                before.damp_by_modes(moved);
                let viscous = plain.viscous_diagonal(&before.damping);
                assembly.damping = rebuilt_damping(&assembly.law, viscous, assembly.eigenvalues());
                assembly.elastic = before.elastic;
            }
        }
        // Ratios that pass to other modes are no small change.
        (assembly.elastic == self.elastic).then_some(assembly)
    }

    /// Matrices of a fixture `moved`, with the effects that rebuild beams if this assembly has them, and
    /// modes to first order; not damped yet.
    fn turned(&self, (fixture, rows): (&Fixture, &[f64]), moved: &Fixture, highest_hz: f64) -> Option<Self> {
        if self.turned.is_some() || in_the_modes(fixture) != in_the_modes(moved) {
            return None;
        }
        let values = self.basis.eigenvalues();
        // What moves as rigid does so after any change, unless that is one of the springs among the matrices.
        if in_the_modes(moved) && values.contains(&0.0) {
            return None;
        }
        let places = coordinates(moved, highest_hz).ok()?;
        if places.len() != self.places.len() || !places.iter().zip(&self.places).all(|(a, b)| a.is_beside(b))
        {
            return None;
        }
        let there = Matrices::of(moved, &places, self.order, self.plain.is_some());
        let far = (FAR * TAU * highest_hz).powi(2);
        let scales: Vec<f64> = places.iter().zip(&self.places).flat_map(|(a, b)| a.scales(b)).collect();
        let mass = projected(rows, &scales, &self.mass, &there.mass);
        let stiffness = projected(rows, &scales, &self.stiffness, &there.stiffness);
        let (eigenvalues, mixing) = turned(values, mass.as_deref(), stiffness.as_deref(), far)?;
        Some(Assembly {
            order: self.order,
            places,
            mass: there.mass,
            stiffness: there.stiffness,
            basis: Arc::clone(&self.basis),
            turned: Some(Turned { eigenvalues, scales, mixing }),
            damping: Vec::new(),
            elastic: Vec::new(),
            law: super::damping_law(moved.damping()),
            plain: None,
        })
    }
}

impl Coordinates {
    /// Whether coordinates are of the same body, meshed alike.
    fn is_beside(&self, other: &Coordinates) -> bool {
        match (self, other) {
            (Coordinates::Rigid { first: a, .. }, Coordinates::Rigid { first: b, .. })
            | (Coordinates::Translating { first: a }, Coordinates::Translating { first: b }) => a == b,
            (Coordinates::Beam { first: a, mesh }, Coordinates::Beam { first: b, mesh: other }) => {
                a == b
                    && mesh.unit.len() == other.unit.len()
                    && mesh.unit.iter().zip(&other.unit).all(|(a, b)| (a - b).abs() <= ROUNDING)
            }
            _ => false,
        }
    }

    /// What a shape is multiplied by, coordinate by coordinate, to be that of the same motion after a change
    /// from `before`: where a beam gets longer deflections stay and slopes get less. Slopes that do not go
    /// with their deflections are no motion of the band; condensed modes know little of those.
    fn scales(&self, before: &Coordinates) -> Vec<f64> {
        let slope = match (self, before) {
            (Coordinates::Beam { mesh, .. }, Coordinates::Beam { mesh: before, .. }) => {
                before.length() / mesh.length()
            }
            _ => 1.0,
        };
        (0..self.count()).map(|i| if i % 2 == 0 { 1.0 } else { slope }).collect()
    }
}

/// The amplitudes of all modes at each coordinate: of an assembly, and of what it is rebuilt from, if it is.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    own: Vec<f64>,
    plain: Option<Vec<f64>>,
}

/// A basis coordinate after coordinate: the amplitudes of all modes there.
fn by_coordinate(basis: &ModalBasis) -> Vec<f64> {
    let (n, shapes) = (basis.order(), basis.shapes());
    (0..n * n).map(|k| shapes[k % n * n + k / n]).collect()
}

/// The lower triangle of Ξᵀ (S·after·S − before) Ξ with S diagonal; `None` where nothing differs.
fn projected(rows: &[f64], scales: &[f64], before: &[f64], after: &[f64]) -> Option<Vec<f64>> {
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || row_by_row(rows, scales, before, after),
    )
}

#[inline(always)]
fn row_by_row(rows: &[f64], scales: &[f64], before: &[f64], after: &[f64]) -> Option<Vec<f64>> {
    let n = scales.len();
    let mut all: Option<Vec<f64>> = None;
    let mut through = vec![0.0; n];
    let amplitudes = |i: usize| &rows[i * n..(i + 1) * n];
    for (i, (before, after)) in before.chunks_exact(n).zip(after.chunks_exact(n)).enumerate() {
        // A row of a mesh reaches as far as its elements.
        let scaled = after.iter().zip(scales).map(|(a, scale)| a * scale * scales[i]);
        let change = before.iter().zip(scaled).map(|(b, a)| a - b).enumerate();
        let mut changes = change.filter(|(_, change)| *change != 0.0).peekable();
        if changes.peek().is_none() {
            continue;
        }
        through.fill(0.0);
        for (j, change) in changes {
            through.iter_mut().zip(amplitudes(j)).for_each(|(sum, value)| *sum += change * value);
        }
        let all = all.get_or_insert_with(|| vec![0.0; n * n]);
        // The product is symmetric once all rows are in it.
        for (k, (sums, amplitude)) in all.chunks_exact_mut(n).zip(amplitudes(i)).enumerate() {
            sums[..=k].iter_mut().zip(&through).for_each(|(sum, value)| *sum += amplitude * value);
        }
    }
    all
}

/// λ + dλ and c of a change, of which lower triangles are given; `None` where that is not small to modes in
/// or near the band.
fn turned(
    values: &[f64],
    mass: Option<&[f64]>,
    stiffness: Option<&[f64]>,
    far: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = values.len();
    if mass.is_none() && stiffness.is_none() {
        return Some((values.to_vec(), Vec::new()));
    }
    let at = |matrix: Option<&[f64]>, at: usize| matrix.map_or(0.0, |matrix| matrix[at]);
    let mut mixing = vec![0.0; n * n];
    let mut eigenvalues = values.to_vec();
    let mut largest = 0.0_f64;
    for k in 0..n {
        let (own_mass, own_stiffness) = (at(mass, k * n + k), at(stiffness, k * n + k));
        mixing[k * n + k] = -0.5 * own_mass;
        if values[k] != 0.0 {
            eigenvalues[k] += own_stiffness - values[k] * own_mass;
        }
        for r in 0..k {
            let (mass, stiffness) = (at(mass, k * n + r), at(stiffness, k * n + r));
            let (of_k, of_r) = if values[k] == 0.0 && values[r] == 0.0 {
                (-0.5 * mass, -0.5 * mass)
            } else if values[r] > far && values[k] > far {
                let both = -stiffness / (values[k] + values[r]);
                (both, both)
            } else {
                let apart = (values[k] - values[r]).recip();
                ((values[r] * mass - stiffness) * apart, (stiffness - values[k] * mass) * apart)
            };
            mixing[k * n + r] = of_k;
            mixing[r * n + k] = of_r;
            largest = largest.max(of_k.abs()).max(of_r.abs());
        }
    }
    (largest <= TURNED).then_some((eigenvalues, mixing))
}
