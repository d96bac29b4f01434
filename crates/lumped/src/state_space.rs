//! The assembly over time: ẋ = A x + b f in modal coordinates, effects included.

use crate::joint::{JointDynamics, JointInTime};
use crate::point_law::PointLaw;
use crate::term_station::TermStation;
use crate::terms::Term;
use crate::{LumpedError, Model, Station};
use jointscope_fixture::Fixture;
use jointscope_linalg::{Cholesky, Matrix2, RealMatrix2};
use std::f64::consts::TAU;

/// The assembly with its supports and linear effects as a first-order system ẋ = A x + b f.
///
/// The states are modal coordinates z (of the free assembly, of bending blocks, and resonators' masses),
/// their rates ż, and states of joints that relax or slip. Modes far above the band are left out. Structural
/// damping of the fixture (`loss_factor`) is taken as the viscous damping that loses as much at each mode's
/// own frequency, ζ = η/2. Effects that depend on amplitude are not part of it: they act on
/// [`StateSpace::across`].
#[derive(Debug, Clone)]
pub struct StateSpace {
    model: Model,
    /// Modes of the model that are kept.
    kept: Vec<usize>,
    coordinates: usize,
    states: usize,
    matrix: Vec<f64>,
    inverse_mass: Vec<f64>,
    /// Length that each joint acts over, m.
    lengths: Vec<(String, f64)>,
    ends: Vec<[(usize, f64); 2]>,
}

/// Modes up to this multiple of the highest frequency are kept.
const KEPT: f64 = 2.5;

/// Mass, damping and stiffness under construction, and the rates of the states that are no coordinates.
struct Equations {
    n: usize,
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    joints: Vec<([Vec<f64>; 2], JointInTime)>,
}

impl StateSpace {
    /// The fixture's assembly with its linear structural effects, beams meshed for motions up to
    /// `highest_hz`.
    ///
    /// # Errors
    /// Modes that cannot be computed, an effect that is known by frequency only.
    pub fn new(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        let model = Model::linear_part(fixture, highest_hz)?;
        let denominators = model.denominators();
        let limit = (KEPT * TAU * highest_hz).powi(2);
        let few = denominators.len() <= crate::modal_system::FEW_MODES;
        let kept: Vec<usize> =
            (0..denominators.len()).filter(|&r| few || denominators[r].stiffness.re <= limit).collect();
        let resonators = model.terms().terms.iter().filter(|t| is_resonator(t)).count();
        let n = kept.len() + resonators;
        let mut equations = Equations::new(n);
        for (i, &r) in kept.iter().enumerate() {
            let (eigenvalue, structural) = (denominators[r].stiffness.re, denominators[r].stiffness.im);
            equations.mass[i * n + i] = 1.0;
            equations.stiffness[i * n + i] = eigenvalue;
            let equivalent = if structural > 0.0 { structural / eigenvalue.sqrt() } else { 0.0 };
            equations.damping[i * n + i] = denominators[r].viscous + equivalent;
        }
        let mut space = StateSpace {
            kept,
            coordinates: n,
            states: 2 * n,
            matrix: Vec::new(),
            inverse_mass: Vec::new(),
            lengths: fixture
                .joints()
                .iter()
                .map(|joint| (joint.name.clone(), JointDynamics::new(fixture, joint).lengths().0))
                .collect(),
            ends: fixture
                .joints()
                .iter()
                .map(|joint| {
                    [joint.from, joint.to].map(|p| &fixture.points()[p]).map(|p| (p.body, p.x.value))
                })
                .collect(),
            model,
        };
        space.add_terms(&mut equations)?;
        space.inverse_mass = Cholesky::of(n, &equations.mass).ok_or(LumpedError::SingularMass)?.inverse();
        space.assemble(&equations)?;
        Ok(space)
    }

    fn add_terms(&self, equations: &mut Equations) -> Result<(), LumpedError> {
        let terms = self.model.terms();
        let row = |station: usize| self.row(&terms.stations[station]);
        let mut resonator = self.kept.len();
        for term in &terms.terms {
            match term {
                Term::Point { station, law: PointLaw::Spring { stiffness, damping } } => {
                    let motion = row(*station);
                    equations.spring(&motion, *stiffness, *damping);
                }
                Term::Point { law: PointLaw::Springpot { .. }, .. } => {
                    return Err(LumpedError::NotInTime { kind: "springpot" });
                }
                Term::Point { station, law: PointLaw::Mass(mass) } => {
                    let motion = row(*station);
                    add_outer(&mut equations.mass, equations.n, &motion, &motion, *mass);
                }
                Term::Point { station, law: PointLaw::Resonator { mass, omega, ratio } } => {
                    let mut stretch: Vec<f64> = row(*station).iter().map(|t| -t).collect();
                    stretch[resonator] += 1.0;
                    equations.mass[resonator * equations.n + resonator] = *mass;
                    equations.spring(&stretch, mass * omega * omega, 2.0 * ratio * omega * mass);
                    resonator += 1;
                }
                Term::Relative { station, joint } | Term::Ends { station, joint, .. } => {
                    let law = joint.in_time().map_err(|kind| LumpedError::NotInTime { kind })?;
                    let motions = [row(*station), row(station + 1)];
                    if law.relaxations.is_empty() && law.slips.is_empty() {
                        let dashpots = law.dashpots.unwrap_or(Matrix2::zero());
                        equations.pair(&motions, &law.stiffness, &dashpots);
                    } else {
                        equations.joints.push((motions, law));
                    }
                }
                Term::TakenOut { station, stiffness } => {
                    let held = stiffness.map(|element| -element.re);
                    equations.pair(&[row(*station), row(station + 1)], &held, &Matrix2::zero());
                }
            }
        }
        Ok(())
    }

    fn assemble(&mut self, equations: &Equations) -> Result<(), LumpedError> {
        let n = self.coordinates;
        self.states = 2 * n
            + equations
                .joints
                .iter()
                .map(|(_, law)| law.slips.len() + 2 * law.relaxations.len())
                .sum::<usize>();
        let size = self.states;
        let mut matrix = vec![0.0; size * size];
        // Forces on the coordinates by state, before the mass matrix is divided out.
        let mut forces = vec![0.0; n * size];
        for i in 0..n {
            matrix[i * size + n + i] = 1.0;
            for j in 0..n {
                forces[i * size + j] = -equations.stiffness[i * n + j];
                forces[i * size + n + j] = -equations.damping[i * n + j];
            }
        }
        let mut first = 2 * n;
        for (motions, law) in &equations.joints {
            let local = LocalLaw::of(law, motions, size, n, first).ok_or(LumpedError::SingularMass)?;
            for (offset, rate) in local.rates.iter().enumerate() {
                matrix[(first + offset) * size..(first + offset + 1) * size].copy_from_slice(rate);
            }
            for (motion, force) in motions.iter().zip(&local.force) {
                add_outer(&mut forces, size, motion, force, -1.0);
            }
            first += local.rates.len();
        }
        for i in 0..n {
            for k in 0..n {
                let factor = self.inverse_mass[i * n + k];
                if factor != 0.0 {
                    for j in 0..size {
                        matrix[(n + i) * size + j] += factor * forces[k * size + j];
                    }
                }
            }
        }
        self.matrix = matrix;
        Ok(())
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Number of coordinates z; the states are z, ż and what joints add.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// A, row-major.
    pub fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// b of a force (or moment) of 1 at the station.
    pub fn load(&self, station: &Station) -> Vec<f64> {
        self.loaded(&self.row(&TermStation::single(*station)))
    }

    /// The row that reads the displacement (rotation) at the station from the states.
    pub fn displacement(&self, station: &Station) -> Vec<f64> {
        self.padded(&self.row(&TermStation::single(*station)), 0)
    }

    /// The row that reads the velocity at the station from the states.
    pub fn velocity(&self, station: &Station) -> Vec<f64> {
        self.padded(&self.row(&TermStation::single(*station)), self.coordinates)
    }

    /// The relative motion across a joint, d = u_to − R·u_from, deflection then rotation: for each the row
    /// that reads it, and the load b of a force pair of 1 that drives it. `None` for a joint that does not
    /// exist.
    pub fn across(&self, joint: &str) -> Option<[(Vec<f64>, Vec<f64>); 2]> {
        let index = self.lengths.iter().position(|(name, _)| name == joint)?;
        let [from, to] = self.ends[index];
        let motions =
            TermStation::relative(from, to, self.lengths[index].1, false).map(|station| self.row(&station));
        Some(motions.map(|row| (self.padded(&row, 0), self.loaded(&row))))
    }

    fn row(&self, station: &TermStation) -> Vec<f64> {
        let all = self.model.participation(station);
        let mut row: Vec<f64> = self.kept.iter().map(|&r| all[r]).collect();
        row.resize(self.coordinates, 0.0);
        row
    }

    fn padded(&self, row: &[f64], offset: usize) -> Vec<f64> {
        let mut all = vec![0.0; self.states];
        all[offset..offset + row.len()].copy_from_slice(row);
        all
    }

    fn loaded(&self, row: &[f64]) -> Vec<f64> {
        let n = self.coordinates;
        let rates: Vec<f64> =
            self.inverse_mass.chunks_exact(n).map(|m| m.iter().zip(row).map(|(m, t)| m * t).sum()).collect();
        self.padded(&rates, n)
    }
}

impl Equations {
    fn new(n: usize) -> Self {
        let zero = || vec![0.0; n * n];
        Equations { n, mass: zero(), damping: zero(), stiffness: zero(), joints: Vec::new() }
    }

    fn spring(&mut self, motion: &[f64], stiffness: f64, damping: f64) {
        add_outer(&mut self.stiffness, self.n, motion, motion, stiffness);
        add_outer(&mut self.damping, self.n, motion, motion, damping);
    }

    fn pair(&mut self, motions: &[Vec<f64>; 2], stiffness: &RealMatrix2, damping: &RealMatrix2) {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            add_outer(&mut self.stiffness, self.n, &motions[i], &motions[j], stiffness.at(i, j));
            add_outer(&mut self.damping, self.n, &motions[i], &motions[j], damping.at(i, j));
        }
    }
}

/// Force and rates of a joint with states of its own, as rows over all states.
struct LocalLaw {
    force: [Vec<f64>; 2],
    /// Slips, then two states a relaxation.
    rates: Vec<Vec<f64>>,
}

/// Forces that resist each slip's rate by the rate of each: those of the joint's dashpots along them, and
/// each one's own.
fn slip_damping(law: &JointInTime, dashpots: &RealMatrix2) -> Vec<f64> {
    let along = |direction: &[f64; 2], other: &[f64; 2]| -> f64 {
        (0..2).map(|a| (0..2).map(|b| direction[a] * dashpots.at(a, b) * other[b]).sum::<f64>()).sum()
    };
    let slips = law.slips.len();
    let mut matrix = vec![0.0; slips * slips];
    for (i, (r, _, damping)) in law.slips.iter().enumerate() {
        for (j, (other, ..)) in law.slips.iter().enumerate() {
            matrix[i * slips + j] = along(r, other) + if i == j { *damping } else { 0.0 };
        }
    }
    matrix
}

impl LocalLaw {
    fn of(law: &JointInTime, motions: &[Vec<f64>; 2], states: usize, n: usize, first: usize) -> Option<Self> {
        let slips = law.slips.len();
        let dashpots = law.dashpots.unwrap_or(Matrix2::zero());
        let whole = 1.0 + law.relaxations.iter().map(|(ratio, _)| ratio).sum::<f64>();
        // δ = d − Σ r e, and the part of δ̇ that does not hold ė.
        let mut delta = [vec![0.0; states], vec![0.0; states]];
        let mut rate = delta.clone();
        for a in 0..2 {
            delta[a][..n].copy_from_slice(&motions[a]);
            rate[a][n..2 * n].copy_from_slice(&motions[a]);
            for (i, (direction, ..)) in law.slips.iter().enumerate() {
                delta[a][first + i] -= direction[a];
            }
        }
        let relaxing = |j: usize, a: usize| first + slips + 2 * j + a;
        let mut strain = [0, 1].map(|a| delta[a].iter().map(|d| whole * d).collect::<Vec<f64>>());
        for (j, (ratio, _)) in law.relaxations.iter().enumerate() {
            (0..2).for_each(|a| strain[a][relaxing(j, a)] -= ratio);
        }
        let mut force = [0, 1].map(|a| {
            let mut row = vec![0.0; states];
            for b in 0..2 {
                for s in 0..states {
                    row[s] += law.stiffness.at(a, b) * strain[b][s] + dashpots.at(a, b) * rate[b][s];
                }
            }
            row
        });
        let inverted = Cholesky::of(slips, &slip_damping(law, &dashpots))?.inverse();
        let right: Vec<Vec<f64>> = law
            .slips
            .iter()
            .enumerate()
            .map(|(i, (r, stiffness, _))| {
                let mut row: Vec<f64> =
                    (0..states).map(|s| r[0] * force[0][s] + r[1] * force[1][s]).collect();
                row[first + i] -= stiffness;
                row
            })
            .collect();
        let mut rates: Vec<Vec<f64>> = (0..slips)
            .map(|i| {
                (0..states).map(|s| (0..slips).map(|j| inverted[i * slips + j] * right[j][s]).sum()).collect()
            })
            .collect();
        for (i, (r, ..)) in law.slips.iter().enumerate() {
            for a in 0..2 {
                let share: f64 = (0..2).map(|b| dashpots.at(a, b) * r[b]).sum();
                (0..states).for_each(|s| force[a][s] -= share * rates[i][s]);
            }
        }
        for (j, (_, time)) in law.relaxations.iter().enumerate() {
            for a in 0..2 {
                let mut row: Vec<f64> = delta[a].iter().map(|d| d / time).collect();
                row[relaxing(j, a)] -= 1.0 / time;
                rates.push(row);
            }
        }
        Some(LocalLaw { force, rates })
    }
}

fn is_resonator(term: &Term) -> bool {
    matches!(term, Term::Point { law: PointLaw::Resonator { .. }, .. })
}

/// Adds factor·a·bᵀ to a matrix of `columns` columns.
fn add_outer(matrix: &mut [f64], columns: usize, a: &[f64], b: &[f64], factor: f64) {
    for (row, a) in matrix.chunks_exact_mut(columns).zip(a).filter(|(_, a)| **a != 0.0) {
        row.iter_mut().zip(b).for_each(|(element, b)| *element += factor * a * b);
    }
}
