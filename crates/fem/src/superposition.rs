//! FRFs of a solid by the superposition of its modes, with what effects attach to it.

use crate::FemError;
use crate::twin::{ModeKind, Twin, read};
use jointscope_damping::{DampingLaw, ModeDamping};
use jointscope_fixture::Damping;
use jointscope_linalg::LuWorkspace;
use jointscope_spectra::{Channel, Dof, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Which modes a superposition is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Superposition {
    /// All that were found, and what lies beyond them as a power series in ω² (residual flexibility).
    Complete,
    /// The rigid motions and the first so many transverse modes, as in the paper; nothing for the rest.
    First(usize),
}

/// Terms of the residual's power series: with modes up to twice the last line the next would be a
/// sixty-fourth of the first.
const RESIDUAL_TERMS: usize = 3;

/// Accelerances stand in for their limit at 0 Hz by their value this close to it.
const NEARLY_ZERO_HZ: f64 = 1e-5;

/// A change of the dynamic stiffness on one functional: s²·mass + s·damping + stiffness.
struct Attachment {
    functional: usize,
    stiffness: f64,
    damping: f64,
    mass: f64,
}

/// Functionals in use, each once, and what is attached to some of them.
#[derive(Default)]
struct Functionals {
    rows: Vec<Vec<(usize, f64)>>,
    attached: Vec<Attachment>,
}

impl Functionals {
    fn index(&mut self, row: Vec<(usize, f64)>) -> usize {
        self.rows.iter().position(|known| *known == row).unwrap_or_else(|| {
            self.rows.push(row);
            self.rows.len() - 1
        })
    }
}

impl Twin {
    /// Accelerances between the channels of `pairs` by mode superposition, with the fixture's damping,
    /// supports and point masses.
    ///
    /// Modal damping ratios belong to the transverse modes in ascending frequency; other modes take the ratio
    /// of the transverse one before them. At 0 Hz the value is the limit.
    ///
    /// # Errors
    /// Unknown points, or an undamped resonance on a line.
    pub fn frfs(
        &self,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        superposition: Superposition,
    ) -> Result<FrfSet, FemError> {
        let last = lines.hz()[lines.len() - 1];
        if superposition == Superposition::Complete && self.complete_to < last {
            return Err(FemError::ModesEndBelow { modes: self.complete_to, last });
        }
        let mut functionals = Functionals::default();
        let mut wanted = Vec::with_capacity(pairs.len());
        for pair in pairs {
            let row = |channel: &Channel| self.channel(pair, channel);
            wanted.push((functionals.index(row(&pair.response)?), functionals.index(row(&pair.reference)?)));
        }
        self.attach(&mut functionals)?;
        let system = ModalSystem::of(self, &functionals.rows, superposition);
        let count = lines.len();
        let mut values = vec![Complex64::ZERO; pairs.len() * count];
        let mut lu = LuWorkspace::new();
        for (line, &hz) in lines.hz().iter().enumerate() {
            let s = Complex64::new(0.0, TAU * hz.max(NEARLY_ZERO_HZ));
            let mut receptance = system.at(s);
            attach(&mut receptance, &functionals, s, &mut lu).ok_or(FemError::Unbounded { frequency: hz })?;
            for (frf, (response, reference)) in wanted.iter().enumerate() {
                let value = s * s * receptance[response * functionals.rows.len() + reference];
                if !value.is_finite() {
                    return Err(FemError::Unbounded { frequency: hz });
                }
                values[frf * count + line] = value;
            }
        }
        Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?)
    }

    /// Static transverse displacements (m) of bodies at abscissae under transverse forces (N) that are in
    /// equilibrium, each at a body and an abscissa; without supports and point masses, and but for a rigid
    /// motion.
    ///
    /// Forces in equilibrium move no rigid motion, so that u = Σ φ(φᵀf)/λ over the elastic modes, those
    /// beyond the ones that were found included.
    ///
    /// # Errors
    /// A fixture without `geometry`.
    pub fn deflections(
        &self,
        forces: &[(usize, f64, f64)],
        at: &[(usize, f64)],
    ) -> Result<Vec<f64>, FemError> {
        let places = forces.iter().map(|(body, x, _)| (*body, *x)).chain(at.iter().copied());
        let rows: Vec<_> = places.map(|(body, x)| self.on_body(body, x, false)).collect::<Result<_, _>>()?;
        let mut system = ModalSystem::of(self, &rows, Superposition::Complete);
        system.modes.retain(|(eigenvalue, ..)| *eigenvalue > 0.0);
        let flexibility = system.at(Complex64::ZERO);
        let deflection = |place: usize| -> f64 {
            let own = flexibility[place * rows.len()..].iter().zip(forces);
            own.map(|(flexibility, (.., force))| flexibility.re * force).sum()
        };
        Ok((forces.len()..rows.len()).map(deflection).collect())
    }

    fn channel(&self, pair: &FrfPair, channel: &Channel) -> Result<Vec<(usize, f64)>, FemError> {
        let points = self.fixture.points();
        let index =
            points.iter().position(|p| p.name == channel.point).ok_or_else(|| FemError::UnknownPoint {
                frf: pair.to_string(),
                point: channel.point.clone(),
                known: points.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", "),
            })?;
        self.point(index, channel.dof == Dof::Rotation)
    }

    /// Supports and point masses, which the modes do not know.
    fn attach(&self, functionals: &mut Functionals) -> Result<(), FemError> {
        for support in self.fixture.supports() {
            let (body, x) = self.fixture.support_place(support);
            let value = |q: &Option<jointscope_fixture::Quantity>| q.as_ref().map_or(0.0, |q| q.value);
            let sides = [
                (false, support.stiffness.value, value(&support.damping)),
                (true, value(&support.rotational_stiffness), value(&support.rotational_damping)),
            ];
            for (slope, stiffness, damping) in sides {
                if stiffness != 0.0 || damping != 0.0 {
                    let functional = functionals.index(self.on_body(body, x, slope)?);
                    functionals.attached.push(Attachment { functional, stiffness, damping, mass: 0.0 });
                }
            }
        }
        for (body, entry) in self.fixture.bodies().iter().enumerate() {
            for point in entry.masses.iter().filter(|point| point.mass.value != 0.0) {
                let functional = functionals.index(self.on_body(body, point.x.value, false)?);
                functionals.attached.push(Attachment {
                    functional,
                    stiffness: 0.0,
                    damping: 0.0,
                    mass: point.mass.value,
                });
            }
        }
        Ok(())
    }

    /// Damping of the elastic modes.
    fn damping(&self) -> Vec<ModeDamping> {
        let law = match self.fixture.damping() {
            Damping::Undamped => DampingLaw::Undamped,
            Damping::ModalRatios { ratios, .. } => {
                // The list counts transverse modes; the others go with the one before them.
                let ratio = |at: usize| ratios.get(at).or(ratios.last()).map_or(0.0, |ratio| ratio.value);
                let mut following = 0;
                let of_mode = self.kinds.iter().map(|kind| match kind {
                    ModeKind::Transverse => {
                        following += 1;
                        ratio(following - 1)
                    }
                    ModeKind::Other => ratio(following.saturating_sub(1)),
                });
                DampingLaw::ModalRatios(of_mode.collect())
            }
            Damping::Rayleigh { mass, stiffness } => {
                DampingLaw::Rayleigh { mass: mass.value, stiffness: stiffness.value }
            }
            Damping::LossFactor(factor) => DampingLaw::LossFactor(factor.value),
        };
        law.of_modes(&self.modes.eigenvalues)
    }
}

/// Receptances between functionals as sums over modes: (eigenvalue, damping, value of each functional), and
/// the residual's terms.
struct ModalSystem {
    size: usize,
    modes: Vec<(f64, ModeDamping, Vec<f64>)>,
    residual: Vec<Vec<f64>>,
    shift: f64,
}

impl ModalSystem {
    fn of(twin: &Twin, rows: &[Vec<(usize, f64)>], superposition: Superposition) -> Self {
        // Half a model carries half of a force on the plane of symmetry: its modes weigh half as much as the
        // whole's.
        let half = if twin.mesh.whole { 1.0 } else { 0.5_f64.sqrt() };
        let of_shape = |shape: &[f64]| rows.iter().map(|row| half * read(row, shape)).collect::<Vec<f64>>();
        let rigid_damping = match twin.fixture.damping() {
            Damping::Rayleigh { mass, .. } => ModeDamping { viscous: mass.value, structural: 0.0 },
            _ => ModeDamping::default(),
        };
        let mut modes: Vec<_> =
            twin.modes.rigid.iter().map(|shape| (0.0, rigid_damping, of_shape(shape))).collect();
        let mut left = match superposition {
            Superposition::Complete => usize::MAX,
            Superposition::First(count) => count,
        };
        for (index, damping) in twin.damping().into_iter().enumerate() {
            let transverse = twin.kinds[index] == ModeKind::Transverse;
            if left > 0 && (transverse || superposition == Superposition::Complete) {
                modes.push((twin.modes.eigenvalues[index], damping, of_shape(&twin.modes.shapes[index])));
                left -= 1;
            }
        }
        let residual = match superposition {
            Superposition::Complete => residual(twin, rows),
            Superposition::First(_) => Vec::new(),
        };
        ModalSystem { size: rows.len(), modes, residual, shift: twin.modes.shift }
    }

    fn at(&self, s: Complex64) -> Vec<Complex64> {
        let size = self.size;
        let mut receptance = vec![Complex64::ZERO; size * size];
        for (eigenvalue, damping, shape) in &self.modes {
            let stiffness = s * s + s * damping.viscous + Complex64::new(*eigenvalue, damping.structural);
            let weight = stiffness.inv();
            for (i, a) in shape.iter().enumerate() {
                for (k, b) in shape.iter().enumerate() {
                    receptance[i * size + k] += weight * (a * b);
                }
            }
        }
        // 1/(λ + s²) = 1/((λ + σ) − (σ − s²)): powers of σ − s².
        let mut power = Complex64::ONE;
        for term in &self.residual {
            receptance.iter_mut().zip(term).for_each(|(r, t)| *r += power * t);
            power *= self.shift - s * s;
        }
        receptance
    }
}

/// What the modes that were not found contribute, Σ φφᵀ/(λ + σ)ⁿ for n = 1, 2, 3, between the functionals.
fn residual(twin: &Twin, rows: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
    let order = twin.matrices.order();
    let half = if twin.mesh.whole { 1.0 } else { 0.5 };
    let mut loads = vec![0.0; order * rows.len()];
    for (column, row) in rows.iter().enumerate() {
        row.iter().for_each(|(equation, weight)| loads[column * order + equation] += weight);
    }
    let mut terms = Vec::with_capacity(RESIDUAL_TERMS);
    for _ in 0..RESIDUAL_TERMS {
        twin.modes.factor.solve_in_place(&mut loads);
        for column in loads.chunks_mut(order) {
            for shape in twin.modes.rigid.iter().chain(&twin.modes.shapes) {
                let image: f64 =
                    twin.matrices.mass.multiply(column).iter().zip(shape).map(|(a, b)| a * b).sum();
                column.iter_mut().zip(shape).for_each(|(c, p)| *c -= image * p);
            }
        }
        let mut term = vec![0.0; rows.len() * rows.len()];
        for (i, row) in rows.iter().enumerate() {
            for (k, column) in loads.chunks(order).enumerate() {
                term[i * rows.len() + k] = half * read(row, column);
            }
        }
        terms.push(term);
        let images: Vec<f64> =
            loads.chunks(order).flat_map(|column| twin.matrices.mass.multiply(column)).collect();
        loads = images;
    }
    terms
}

/// H − H V (Δ⁻¹ + Vᵀ H V)⁻¹ Vᵀ H as (I + Δ G_VV)⁻¹ Δ G_V; `None` where it has no inverse.
fn attach(h: &mut [Complex64], functionals: &Functionals, s: Complex64, lu: &mut LuWorkspace) -> Option<()> {
    let (size, attached) = (functionals.rows.len(), &functionals.attached);
    if attached.is_empty() {
        return Some(());
    }
    let delta: Vec<Complex64> =
        attached.iter().map(|a| s * s * a.mass + s * a.damping + a.stiffness).collect();
    let count = attached.len();
    lu.factorize(count, |matrix| {
        for i in 0..count {
            for k in 0..count {
                let unit = if i == k { Complex64::ONE } else { Complex64::ZERO };
                matrix[i * count + k] =
                    unit + delta[i] * h[attached[i].functional * size + attached[k].functional];
            }
        }
    })
    .ok()?;
    let mut forces = vec![Complex64::ZERO; count * size];
    for (i, a) in attached.iter().enumerate() {
        for k in 0..size {
            forces[i * size + k] = delta[i] * h[a.functional * size + k];
        }
    }
    lu.solve_columns_in_place(&mut forces, size);
    let free = h.to_vec();
    for i in 0..size {
        for k in 0..size {
            let change: Complex64 =
                (0..count).map(|a| free[i * size + attached[a].functional] * forces[a * size + k]).sum();
            h[i * size + k] -= change;
        }
    }
    Some(())
}
