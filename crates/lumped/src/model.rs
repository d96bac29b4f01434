use crate::bar::BarShape;
use crate::far_modes::FarModes;
use crate::modal_system::{FEW_MODES, ModalSystem};
use crate::terms::{TermStation, Terms};
use crate::{Assembly, LumpedError, Station};
use jointscope_fixture::{BodyKind, EffectKind, Fixture, Place};
use jointscope_linalg::LuWorkspace;
use jointscope_spectra::{Dof, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The assembly with its supports and structural effects, ready to give receptances.
///
/// Effects of the measuring chain are not in it: they belong to a recording, see [`crate::synthesize`].
#[derive(Debug, Clone)]
pub struct Model {
    assembly: Assembly,
    bending: Vec<BendingCoordinate>,
    terms: Terms,
    highest_hz: f64,
}

/// The first bending mode of a block that was taken as rigid.
#[derive(Debug, Clone)]
struct BendingCoordinate {
    body: usize,
    shape: BarShape,
    modal_mass: f64,
    eigenvalue: f64,
    viscous: f64,
}

/// A mode's denominator λ + i·structural + s·viscous + s², shared by modes that have the same one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Denominator {
    pub stiffness: Complex64,
    pub viscous: f64,
}

impl Model {
    /// Models the fixture with its structural effects, beams meshed for lines up to `highest_hz`.
    ///
    /// # Errors
    /// Modes that cannot be computed; an effect that depends on amplitude.
    pub fn new(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        if let Some((index, effect)) =
            fixture.physics().iter().enumerate().find(|(_, e)| e.kind.is_nonlinear())
        {
            return Err(LumpedError::NonLinear { index, kind: effect.kind.name() });
        }
        let bending = bending_coordinates(fixture);
        let flexible: Vec<bool> =
            (0..fixture.bodies().len()).map(|body| bending.iter().any(|b| b.body == body)).collect();
        Ok(Model {
            assembly: Assembly::new(fixture, highest_hz)?,
            bending,
            terms: Terms::of(fixture, &flexible),
            highest_hz,
        })
    }

    /// The free assembly inside.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// Prepares the receptances from every one of `inputs` to every one of `outputs`.
    pub fn receptances(&self, outputs: &[Station], inputs: &[Station]) -> Receptances<'_> {
        let pairs = (0..outputs.len()).flat_map(|o| (0..inputs.len()).map(move |i| (o, i))).collect();
        self.receptances_of(outputs, inputs, pairs)
    }

    /// Prepares the receptances of `pairs` of indices (output, input).
    pub fn receptances_of(
        &self,
        outputs: &[Station],
        inputs: &[Station],
        pairs: Vec<(usize, usize)>,
    ) -> Receptances<'_> {
        Receptances::new(self, outputs, inputs, pairs)
    }

    fn participation(&self, station: &TermStation) -> Vec<f64> {
        let mut all = vec![0.0; self.assembly.order() + self.bending.len()];
        for (weight, part) in station.parts() {
            let (modes, bending) = all.split_at_mut(self.assembly.order());
            self.assembly.add_participation(part, *weight, modes);
            for (value, mode) in bending.iter_mut().zip(&self.bending) {
                if station.rigid_only || mode.body != part.body {
                    continue;
                }
                let (deflection, slope) = mode.shape.at(part.x);
                let motion = if part.dof == Dof::Translation { deflection } else { slope };
                *value += weight * motion / mode.modal_mass.sqrt();
            }
        }
        all
    }

    fn denominators(&self) -> Vec<Denominator> {
        let assembly = self.assembly.modes().eigenvalues().iter().zip(self.assembly.mode_damping());
        let assembly = assembly.map(|(&eigenvalue, damping)| Denominator {
            stiffness: Complex64::new(eigenvalue, damping.structural),
            viscous: damping.viscous,
        });
        let bending = self
            .bending
            .iter()
            .map(|b| Denominator { stiffness: Complex64::new(b.eigenvalue, 0.0), viscous: b.viscous });
        assembly.chain(bending).collect()
    }
}

fn bending_coordinates(fixture: &Fixture) -> Vec<BendingCoordinate> {
    let mut all = Vec::new();
    for effect in fixture.physics().iter().filter(|e| e.kind == EffectKind::BodyFlexibility) {
        let Place::Body(name) = &effect.place else { continue };
        let Some(body) = fixture.bodies().iter().position(|b| b.name == *name) else { continue };
        let BodyKind::Rigid(rigid) = &fixture.bodies()[body].kind else { continue };
        let omega = TAU * effect.value(0);
        let inertia = rigid.inertia.map_or(0.0, |q| q.value);
        all.push(BendingCoordinate {
            body,
            shape: BarShape::new(rigid.mass.value, inertia, rigid.x_cg.map_or(0.0, |q| q.value)),
            modal_mass: rigid.mass.value,
            eigenvalue: omega * omega,
            viscous: 2.0 * effect.value(1) * omega,
        });
    }
    all
}

/// Receptances between fixed stations, evaluated line by line without allocation.
#[derive(Debug, Clone)]
pub struct Receptances<'a> {
    terms: &'a Terms,
    denominators: Vec<Denominator>,
    /// (output, input) of each wanted receptance.
    pairs: Vec<(usize, usize)>,
    outputs: usize,
    inputs: usize,
    /// Products of participations, one row over the needed entries of G for each denominator.
    products: Vec<f64>,
    /// Real and imaginary parts of the sums, as contiguous rows that the processor adds two or four at a time.
    parts: [Vec<f64>; 2],
    sums: Vec<Complex64>,
    delta: Vec<Complex64>,
    right: Vec<Complex64>,
    lu: LuWorkspace,
    /// Modes far above the band, the rows of their series, and how many of the denominators, the first ones, are not among them.
    far: Option<(FarModes, Vec<f64>)>,
    near: usize,
    /// In place of all that, where the modes are few and the change is of high rank.
    system: Option<ModalSystem>,
}

/// Rank from which a change is solved for in the coordinates of few modes.
const HIGH_RANK: usize = 3;
/// How far beyond the highest line s may lie, the decay of a response window included.
const BEYOND: f64 = 1.1;

impl<'a> Receptances<'a> {
    fn new(model: &'a Model, outputs: &[Station], inputs: &[Station], pairs: Vec<(usize, usize)>) -> Self {
        let with_bending = |s: &Station| model.participation(&TermStation::single(*s));
        let out: Vec<Vec<f64>> = outputs.iter().map(with_bending).collect();
        let input: Vec<Vec<f64>> = inputs.iter().map(with_bending).collect();
        let change: Vec<Vec<f64>> = model.terms.stations.iter().map(|s| model.participation(s)).collect();
        let single = model.denominators();
        let system = (single.len() <= FEW_MODES && change.len() >= HIGH_RANK)
            .then(|| ModalSystem::new(single.clone(), &out, &input, &change));
        let far = FarModes::of(&single, BEYOND * TAU * model.highest_hz);
        let is_far = |mode: usize| far.as_ref().is_some_and(|far| far.contain(mode));
        let (denominators, group, near) = merge(&single, is_far);
        let count = pairs.len() + change.len() * (out.len() + change.len() + input.len());
        let mut products = vec![0.0; count * denominators.len()];
        let mut by_mode = vec![0.0; if far.is_some() { count * single.len() } else { 0 }];
        let mut next = 0;
        let mut entry = |a: &[f64], b: &[f64]| {
            for (mode, (x, y)) in a.iter().zip(b).enumerate() {
                products[group[mode] * count + next] += x * y;
                if let Some(product) = by_mode.get_mut(mode * count + next) {
                    *product = x * y;
                }
            }
            next += 1;
        };
        // The order of the entries: wanted pairs, then G_oV, G_VV, G_Vi where there is a change.
        pairs.iter().for_each(|&(o, i)| entry(&out[o], &input[i]));
        if !change.is_empty() {
            out.iter().for_each(|o| change.iter().for_each(|v| entry(o, v)));
            change.iter().for_each(|v| change.iter().for_each(|w| entry(v, w)));
            change.iter().for_each(|v| input.iter().for_each(|i| entry(v, i)));
        }
        let rank = change.len();
        let far = far.map(|far| {
            let rows = far.rows(&by_mode, count);
            (far, rows)
        });
        Receptances {
            terms: &model.terms,
            far,
            near,
            parts: [vec![0.0; count], vec![0.0; count]],
            sums: vec![Complex64::ZERO; count],
            delta: vec![Complex64::ZERO; rank * rank],
            right: vec![Complex64::ZERO; rank * inputs.len()],
            lu: LuWorkspace::new(),
            outputs: outputs.len(),
            inputs: inputs.len(),
            denominators,
            pairs,
            products,
            system,
        }
    }

    /// Number of receptances per line.
    pub fn count(&self) -> usize {
        self.pairs.len()
    }

    /// Writes the receptances at `s` = iω (or decay + iω) over `values`, in the order of the pairs.
    ///
    /// Returns whether they are finite; they are not on an undamped resonance, nor at s = 0 of a free assembly.
    pub fn at(&mut self, s: Complex64, values: &mut [Complex64]) -> bool {
        if let Some(system) = &mut self.system {
            return system.at(s, self.terms, &self.pairs, values) && values.iter().all(|v| v.is_finite());
        }
        let squared = s * s;
        let [re, im] = &mut self.parts;
        re.fill(0.0);
        im.fill(0.0);
        let series = self.far.as_ref().filter(|(far, _)| far.hold(s));
        let single = if series.is_some() { &self.denominators[..self.near] } else { &self.denominators[..] };
        for (row, denominator) in self.products.chunks_exact(re.len()).zip(single) {
            let value = denominator.stiffness + s * denominator.viscous + squared;
            let inverse = value.conj() * (1.0 / value.norm_sqr());
            for ((re, im), product) in re.iter_mut().zip(im.iter_mut()).zip(row) {
                *re += product * inverse.re;
                *im += product * inverse.im;
            }
        }
        if let Some((_, rows)) = series {
            FarModes::add(s, rows, re, im);
        }
        for ((sum, re), im) in self.sums.iter_mut().zip(re).zip(im) {
            *sum = Complex64::new(*re, *im);
        }
        values.copy_from_slice(&self.sums[..self.pairs.len()]);
        self.subtract_change(s, values) && values.iter().all(|v| v.is_finite())
    }

    /// Subtracts G_oV (I + Δ G_VV)⁻¹ Δ G_Vi.
    fn subtract_change(&mut self, s: Complex64, values: &mut [Complex64]) -> bool {
        let rank = self.terms.stations.len();
        if rank == 0 {
            return true;
        }
        self.terms.write(s, &mut self.delta);
        let after_pairs = &self.sums[self.pairs.len()..];
        let (left, rest) = after_pairs.split_at(self.outputs * rank);
        let (middle, right) = rest.split_at(rank * rank);
        self.right.fill(Complex64::ZERO);
        add_product(&self.delta, rank, right, &mut self.right);
        if rank <= 2 {
            divide_small(&self.delta, middle, &mut self.right);
        } else {
            let solvable = self.lu.factorize(rank, |matrix| {
                add_product(&self.delta, rank, middle, matrix);
                (0..rank).for_each(|i| matrix[i * rank + i] += 1.0);
            });
            if solvable.is_err() {
                return false;
            }
            self.lu.solve_columns_in_place(&mut self.right, self.inputs);
        }
        for (value, &(o, i)) in values.iter_mut().zip(&self.pairs) {
            let change: Complex64 =
                (0..rank).map(|k| left[o * rank + k] * self.right[k * self.inputs + i]).sum();
            *value -= change;
        }
        true
    }

    /// The receptances on all `lines`, line after line, at s = iω.
    ///
    /// # Errors
    /// [`LumpedError::Unbounded`] on an undamped resonance.
    pub fn on_lines(&mut self, lines: &SpectralLines) -> Result<Vec<Complex64>, LumpedError> {
        let count = self.count();
        let mut values = vec![Complex64::ZERO; count * lines.len()];
        for (line, block) in values.chunks_exact_mut(count).enumerate() {
            if !self.at(Complex64::new(0.0, lines.omega(line)), block) {
                return Err(LumpedError::Unbounded { frequency: lines.hz()[line] });
            }
        }
        Ok(values)
    }
}

/// Adds Δ G to `to`, both of `rank` rows. Most of Δ is zero: each effect acts on its own few stations.
fn add_product(delta: &[Complex64], rank: usize, g: &[Complex64], to: &mut [Complex64]) {
    let columns = g.len() / rank;
    for (to, delta) in to.chunks_exact_mut(columns).zip(delta.chunks_exact(rank)) {
        for (&factor, g) in delta.iter().zip(g.chunks_exact(columns)).filter(|(d, _)| **d != Complex64::ZERO)
        {
            to.iter_mut().zip(g).for_each(|(to, g)| *to += factor * g);
        }
    }
}

/// Overwrites `right` (rank rows) with (I + ΔG)⁻¹·right in closed form, for a rank of one or two.
fn divide_small(delta: &[Complex64], g: &[Complex64], right: &mut [Complex64]) {
    if let ([delta], [g]) = (delta, g) {
        let factor = (1.0 + delta * g).inv();
        right.iter_mut().for_each(|value| *value *= factor);
    } else if let ([d00, d01, d10, d11], [g00, g01, g10, g11]) = (delta, g) {
        let (a, b) = (1.0 + d00 * g00 + d01 * g10, d00 * g01 + d01 * g11);
        let (c, d) = (d10 * g00 + d11 * g10, 1.0 + d10 * g01 + d11 * g11);
        let factor = (a * d - b * c).inv();
        let (first, second) = right.split_at_mut(right.len() / 2);
        for (x, y) in first.iter_mut().zip(second) {
            (*x, *y) = ((d * *x - b * *y) * factor, (a * *y - c * *x) * factor);
        }
    }
}

/// Modes with one denominator (all rigid motions, above all) share one term of the sum: the distinct denominators, those of far modes
/// last, each mode's place among them, and the number of those before the far ones.
fn merge(all: &[Denominator], is_far: impl Fn(usize) -> bool) -> (Vec<Denominator>, Vec<usize>, usize) {
    let mut distinct: Vec<Denominator> = Vec::new();
    let mut group = vec![0; all.len()];
    let mut near = 0;
    for far in [false, true] {
        for (mode, d) in all.iter().enumerate().filter(|(mode, _)| is_far(*mode) == far) {
            group[mode] = distinct.iter().position(|e| e == d).unwrap_or_else(|| {
                distinct.push(*d);
                distinct.len() - 1
            });
        }
        if !far {
            near = distinct.len();
        }
    }
    (distinct, group, near)
}
