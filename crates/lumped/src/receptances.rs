//! Receptances between fixed stations, several spectral lines at once.

use crate::Station;
use crate::denominator::Denominator;
use crate::far_modes::FarModes;
use crate::lanes::{Lanes, Lines, WIDTH};
use crate::modal_system::{FEW_MODES, ModalSystem};
use crate::model::Model;
use crate::motions::Motions;
use crate::terms::Terms;
use jointscope_linalg::{Field, LuWorkspace};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Receptances between fixed stations, evaluated without allocation.
#[derive(Debug, Clone)]
pub struct Receptances<'a> {
    prepared: Prepared<'a>,
    single: Memory<Complex64>,
    several: Memory<Lanes>,
}

/// What does not change from line to line.
#[derive(Debug, Clone)]
struct Prepared<'a> {
    terms: &'a Terms,
    /// (row, column) of the elements of Δ that are not zero on every line.
    elements: Vec<(usize, usize)>,
    denominators: Vec<Denominator>,
    /// (output, input) of each wanted receptance.
    pairs: Vec<(usize, usize)>,
    outputs: usize,
    inputs: usize,
    /// Products of participations, a row over the denominators for each needed entry of G.
    products: Vec<f64>,
    /// Number of those entries.
    entries: usize,
    /// Modes far above the band, the rows of their series, and how many of the denominators, the first ones,
    /// are not among them.
    far: Option<(FarModes, Vec<f64>)>,
    near: usize,
    /// In place of all that, where the modes are few and the change is of high rank.
    system: Option<ModalSystem>,
}

/// Memory for one line, or for several.
#[derive(Debug, Clone)]
struct Memory<T> {
    inverses: Vec<T>,
    sums: Vec<T>,
    delta: Vec<T>,
    right: Vec<T>,
    solution: Vec<T>,
    lu: LuWorkspace,
}

/// Blocks that are evaluated before any of them is read: few enough to stay in the processor's nearest
/// memory.
const BLOCKS: usize = 8;
/// Rank from which a change is solved for in the coordinates of few modes.
const HIGH_RANK: usize = 3;
/// How far beyond the highest line s may lie, the decay of a response window included.
const BEYOND: f64 = 1.1;

impl Model {
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
}

impl<'a> Receptances<'a> {
    fn new(model: &'a Model, outputs: &[Station], inputs: &[Station], pairs: Vec<(usize, usize)>) -> Self {
        let prepared = Prepared::new(model, outputs, inputs, pairs);
        Receptances { prepared, single: Memory::new(), several: Memory::new() }
    }

    /// Number of receptances per line.
    pub fn count(&self) -> usize {
        self.prepared.pairs.len()
    }

    /// Writes the receptances at `s` = iω (or decay + iω) over `values`, in the order of the pairs.
    ///
    /// Returns whether they are finite; they are not on an undamped resonance, nor at s = 0 of a free
    /// assembly.
    pub fn at(&mut self, s: Complex64, values: &mut [Complex64]) -> bool {
        self.prepared.evaluate(s, &mut self.single, values) && values.iter().all(|v| v.is_finite())
    }

    /// Hands the receptances at all of `s`, [`WIDTH`] lines at a time, to `read`, with the number of the
    /// first of them and their s.
    ///
    /// # Errors
    /// The number of the first line on which they are not finite.
    pub(crate) fn in_blocks(
        &mut self,
        s: &[Complex64],
        mut read: impl FnMut(usize, Lanes, &mut [Lanes]),
    ) -> Result<(), usize> {
        let count = self.count();
        let mut values = vec![Lanes::ZERO; count * BLOCKS];
        for (batch, s) in s.chunks(WIDTH * BLOCKS).enumerate() {
            let first = batch * WIDTH * BLOCKS;
            self.evaluate_blocks(s, &mut values).map_err(|line| first + line)?;
            pulp::Arch::new().dispatch(Read { first, s, values: &mut values, count, read: &mut read });
        }
        Ok(())
    }

    /// Writes the receptances at up to [`BLOCKS`] times [`WIDTH`] of s over `values`, those of a block side
    /// by side. Compiled once: it holds every size of system for every instruction set that the processor may
    /// have.
    #[inline(never)]
    fn evaluate_blocks(&mut self, s: &[Complex64], values: &mut [Lanes]) -> Result<(), usize> {
        pulp::Arch::new().dispatch(Blocks { receptances: self, s, values })
    }

    /// Writes the receptances at all of `s` over `values`: those of the first pair on all lines, then of the
    /// second, …
    ///
    /// # Errors
    /// The number of the first line on which they are not finite.
    pub fn on_lines(&mut self, s: &[Complex64], values: &mut [Complex64]) -> Result<(), usize> {
        self.in_blocks(s, |first, _, block| {
            let last = (first + WIDTH).min(s.len());
            for (receptance, lanes) in values.chunks_exact_mut(s.len()).zip(block) {
                lanes.write(&mut receptance[first..last]);
            }
        })
    }

    #[inline(never)]
    fn line_by_line(&mut self, s: &[Complex64], values: &mut [Lanes]) -> Result<(), usize> {
        let mut single = vec![Complex64::ZERO; self.count()];
        for (line, &s) in s.iter().enumerate() {
            if !self.at(s, &mut single) {
                return Err(line);
            }
            values.iter_mut().zip(&single).for_each(|(to, value)| to.set_line(line, *value));
        }
        Ok(())
    }
}

/// Some blocks of lines, compiled once for each instruction set that the processor may have.
struct Blocks<'r, 'a, 's> {
    receptances: &'r mut Receptances<'a>,
    s: &'s [Complex64],
    values: &'s mut [Lanes],
}

impl pulp::WithSimd for Blocks<'_, '_, '_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let Blocks { receptances, s, values } = self;
        let count = receptances.count();
        for (block, s) in s.chunks(WIDTH).enumerate() {
            let values = &mut values[block * count..(block + 1) * count];
            let solved = receptances.prepared.evaluate(Lanes::of(s), &mut receptances.several, values);
            if !(solved && Lanes::all_finite(values)) {
                receptances.line_by_line(s, values).map_err(|line| block * WIDTH + line)?;
            }
        }
        Ok(())
    }
}

/// Hands blocks on, with the same instructions.
struct Read<'s, F> {
    first: usize,
    s: &'s [Complex64],
    values: &'s mut [Lanes],
    count: usize,
    read: &'s mut F,
}

impl<F: FnMut(usize, Lanes, &mut [Lanes])> pulp::WithSimd for Read<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        for (block, s) in self.s.chunks(WIDTH).enumerate() {
            let values = &mut self.values[block * self.count..(block + 1) * self.count];
            (self.read)(self.first + block * WIDTH, Lanes::of(s), values);
        }
    }
}

impl<'a> Prepared<'a> {
    fn new(model: &'a Model, outputs: &[Station], inputs: &[Station], pairs: Vec<(usize, usize)>) -> Self {
        let motions = Motions::of(model, outputs, inputs);
        let single = model.denominators();
        let mut prepared = Prepared {
            terms: model.terms(),
            elements: model.terms().elements(),
            denominators: Vec::new(),
            pairs,
            outputs: outputs.len(),
            inputs: inputs.len(),
            products: Vec::new(),
            entries: 0,
            far: None,
            near: 0,
            system: None,
        };
        if is_solved_by_modes(single.len(), motions.change.len()) {
            let Motions { outputs, inputs, change } = &motions;
            prepared.system = Some(ModalSystem::new(single, outputs, inputs, change));
        } else {
            prepared.sum_over_modes(model, &single, &motions);
        }
        prepared
    }

    /// Prepares modal sums between stations, the change's among them; far modes as a power series.
    fn sum_over_modes(&mut self, model: &Model, single: &[Denominator], motions: &Motions) {
        let far = FarModes::of(single, BEYOND * TAU * model.highest_hz);
        let is_far = |mode: usize| far.as_ref().is_some_and(|far| far.contain(mode));
        let (denominators, group, near) = merge(single, is_far);
        let (all, entries) = (motions.all(), motions.entries(&self.pairs));
        let (count, distinct) = (entries.len(), denominators.len());
        let mut products = vec![0.0; count * distinct];
        let mut by_mode = vec![0.0; if far.is_some() { count * single.len() } else { 0 }];
        for (entry, [p, q]) in entries.into_iter().enumerate() {
            for (mode, (x, y)) in all[p].iter().zip(all[q]).enumerate() {
                products[entry * distinct + group[mode]] += x * y;
                if let Some(product) = by_mode.get_mut(mode * count + entry) {
                    *product = x * y;
                }
            }
        }
        self.far = far.map(|far| {
            let rows = far.rows(&by_mode, count);
            (far, rows)
        });
        (self.denominators, self.products, self.entries, self.near) = (denominators, products, count, near);
    }

    /// Writes the receptances over `values`; `false` where a line has no solution.
    #[inline(always)]
    fn evaluate<T: Lines>(&self, s: T, memory: &mut Memory<T>, values: &mut [T]) -> bool {
        let rank = self.terms.stations.len();
        memory.delta.resize(rank * rank, T::ZERO);
        if rank > 0 {
            self.terms.write(s, &mut memory.delta);
        }
        if let Some(system) = &self.system {
            let change = (&memory.delta[..], &self.elements[..]);
            return system.at(s, change, (&mut memory.solution, &mut memory.lu), &self.pairs, values);
        }
        memory.sums.resize(self.entries, T::ZERO);
        memory.inverses.resize(self.denominators.len(), T::ZERO);
        self.sum(s, &mut memory.inverses, &mut memory.sums);
        for (value, sum) in values.iter_mut().zip(&memory.sums) {
            *value = *sum;
        }
        match rank {
            0 => true,
            _ => self.subtract_change(memory, values),
        }
    }

    /// Writes each entry of G, the sum of what the modes contribute.
    #[inline(always)]
    fn sum<T: Lines>(&self, s: T, inverses: &mut [T], sums: &mut [T]) {
        let squared = s * s;
        let series = self.far.as_ref().filter(|(far, _)| (0..T::COUNT).all(|line| far.hold(s.line(line))));
        let single = if series.is_some() { self.near } else { self.denominators.len() };
        let inverses = &mut inverses[..single];
        for (inverse, denominator) in inverses.iter_mut().zip(&self.denominators) {
            let value = T::constant(denominator.stiffness) + s * denominator.viscous + squared;
            *inverse = value.reciprocal();
        }
        for (sum, products) in sums.iter_mut().zip(self.products.chunks_exact(self.denominators.len())) {
            let mut total = T::ZERO;
            for (inverse, product) in inverses.iter().zip(products) {
                total = total + *inverse * *product;
            }
            *sum = total;
        }
        if let Some((far, rows)) = series {
            far.add(s, rows, sums);
        }
    }

    /// Subtracts G_oV (I + Δ G_VV)⁻¹ Δ G_Vi.
    #[inline(always)]
    fn subtract_change<T: Lines>(&self, memory: &mut Memory<T>, values: &mut [T]) -> bool {
        let rank = self.terms.stations.len();
        let after_pairs = &memory.sums[self.pairs.len()..];
        let (left, rest) = after_pairs.split_at(self.outputs * rank);
        let (middle, right) = rest.split_at(rank * rank);
        memory.right.resize(rank * self.inputs, T::ZERO);
        memory.right.iter_mut().for_each(|value| *value = T::ZERO);
        for &(row, column) in &self.elements {
            let factor = memory.delta[row * rank + column];
            for input in 0..self.inputs {
                let to = &mut memory.right[row * self.inputs + input];
                *to = *to + factor * right[column * self.inputs + input];
            }
        }
        let columns = (&mut memory.right[..], self.inputs);
        if !divided(&self.elements, &memory.delta, middle, columns, &mut memory.lu) {
            return false;
        }
        for (value, &(o, i)) in values.iter_mut().zip(&self.pairs) {
            for k in 0..rank {
                *value = *value - left[o * rank + k] * memory.right[k * self.inputs + i];
            }
        }
        true
    }
}

/// Whether a change of this rank is solved for in the coordinates of so many modes.
pub(crate) fn is_solved_by_modes(modes: usize, rank: usize) -> bool {
    modes <= FEW_MODES && rank >= HIGH_RANK
}

/// Overwrites `right`, a row over its columns for each station of the change, with (I + ΔG)⁻¹·right; `false`
/// where a line has no solution.
#[inline(always)]
pub(crate) fn divided<T: Lines>(
    elements: &[(usize, usize)],
    delta: &[T],
    g: &[T],
    (right, columns): (&mut [T], usize),
    lu: &mut LuWorkspace,
) -> bool {
    if delta.len() <= 4 {
        divide_small(delta, g, right);
        return true;
    }
    divide(elements, delta, g, (right, columns), lu)
}

/// The same line by line.
fn divide<T: Lines>(
    elements: &[(usize, usize)],
    delta: &[T],
    g: &[T],
    (right, columns): (&mut [T], usize),
    lu: &mut LuWorkspace,
) -> bool {
    let rank = right.len() / columns;
    let mut single: Vec<Complex64> = vec![Complex64::ZERO; right.len()];
    (0..T::COUNT).all(|line| {
        let factorized = lu.factorize(rank, |matrix| {
            for &(row, inner) in elements {
                let factor = delta[row * rank + inner].line(line);
                for column in 0..rank {
                    matrix[row * rank + column] += factor * g[inner * rank + column].line(line);
                }
            }
            (0..rank).for_each(|i| matrix[i * rank + i] += 1.0);
        });
        if factorized.is_err() {
            return false;
        }
        single.iter_mut().zip(right.iter()).for_each(|(to, value)| *to = value.line(line));
        lu.solve_columns_in_place(&mut single, columns);
        right.iter_mut().zip(&single).for_each(|(to, value)| to.set_line(line, *value));
        true
    })
}

impl<T> Memory<T> {
    fn new() -> Self {
        Memory {
            inverses: Vec::new(),
            sums: Vec::new(),
            delta: Vec::new(),
            right: Vec::new(),
            solution: Vec::new(),
            lu: LuWorkspace::new(),
        }
    }
}

/// Overwrites `right` (rank rows) with (I + ΔG)⁻¹·right in closed form, for a rank of one or two.
#[inline(always)]
fn divide_small<T: Lines>(delta: &[T], g: &[T], right: &mut [T]) {
    if let (&[delta], &[g]) = (delta, g) {
        let factor = (T::ONE + delta * g).reciprocal();
        right.iter_mut().for_each(|value| *value = *value * factor);
    } else if let (&[d00, d01, d10, d11], &[g00, g01, g10, g11]) = (delta, g) {
        let (a, b) = (T::ONE + d00 * g00 + d01 * g10, d00 * g01 + d01 * g11);
        let (c, d) = (d10 * g00 + d11 * g10, T::ONE + d10 * g01 + d11 * g11);
        let factor = (a * d - b * c).reciprocal();
        let (first, second) = right.split_at_mut(right.len() / 2);
        for (x, y) in first.iter_mut().zip(second) {
            (*x, *y) = ((d * *x - b * *y) * factor, (a * *y - c * *x) * factor);
        }
    }
}

/// Neighbours with one denominator (all rigid motions, above all) share one term of the sum: the distinct
/// denominators, those of far modes last, each mode's place among them, and the number of those before the
/// far ones.
pub(crate) fn merge(
    all: &[Denominator],
    is_far: impl Fn(usize) -> bool,
) -> (Vec<Denominator>, Vec<usize>, usize) {
    let mut distinct: Vec<Denominator> = Vec::new();
    let mut group = vec![0; all.len()];
    let mut near = 0;
    for far in [false, true] {
        for (mode, d) in all.iter().enumerate().filter(|(mode, _)| is_far(*mode) == far) {
            if distinct.last() != Some(d) {
                distinct.push(*d);
            }
            group[mode] = distinct.len() - 1;
        }
        if !far {
            near = distinct.len();
        }
    }
    (distinct, group, near)
}
