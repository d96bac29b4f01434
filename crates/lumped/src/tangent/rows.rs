//! Functions of the line that receptances and their derivatives are real combinations of.

use crate::Model;
use crate::denominator::Denominator;
use crate::lanes::{Lanes, Lines};
use crate::receptances::merge;
use jointscope_damping::DampingLaw;
use jointscope_linalg::Field;
use num_complex::Complex64;

/// Entries that are summed together, by the first of these numbers that leaves the fewest places of the last
/// tile empty: each function that is fetched serves in several sums. A change of rank one between two outputs
/// and two inputs has nine.
const TILES: [usize; 2] = [4, 3];
/// A change of damping beside that by its law is none below these shares of the latter and of the damping
/// itself: what differences leave of it.
const ROUNDING: (f64, f64) = (1e-5, 1e-9);

/// On each block of lines: 1/D of every distinct denominator; (1 + iη/λ + s τ)/D² of every mode that is not
/// rigid, what its λ changes; s/D², or i/D² for structural damping, of every distinct denominator, what
/// damping changes by itself.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// Each mode's place among the distinct denominators.
    group: Vec<usize>,
    groups: usize,
    /// Each mode's place among those that are not rigid.
    elastic: Vec<Option<usize>>,
    /// What each mode's damping does by its law for a change of λ, and what it is.
    laws: Vec<ByLaw>,
    count: usize,
    table: Vec<Lanes>,
}

#[derive(Debug, Clone, Copy)]
struct ByLaw {
    slope: f64,
    size: f64,
    is_structural: bool,
}

/// Coefficients of the first functions for each of several entries, a tile of entries side by side.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    entries: usize,
    rows: usize,
    /// Entries of a tile.
    tile: usize,
    /// A row of a tile's entries for each function, tile after tile.
    values: Vec<f64>,
}

impl Coefficients {
    fn zero(entries: usize, rows: usize) -> Self {
        let fewer = |tile: usize, other: usize| {
            if entries.next_multiple_of(other) < entries.next_multiple_of(tile) { other } else { tile }
        };
        let tile = TILES.into_iter().reduce(fewer).unwrap_or(1);
        Coefficients { entries, rows, tile, values: vec![0.0; entries.next_multiple_of(tile) * rows] }
    }

    fn add(&mut self, entry: usize, row: usize, value: f64) {
        self.values[(entry / self.tile * self.rows + row) * self.tile + entry % self.tile] += value;
    }

    /// The number of entries, as many as fill the last tile.
    pub(super) fn padded(&self) -> usize {
        self.entries.next_multiple_of(self.tile)
    }
}

/// Writes every entry on one block of lines over `entries`.
#[inline(always)]
pub(super) fn sums(coefficients: &Coefficients, functions: &[Lanes], entries: &mut [Lanes]) {
    match coefficients.tile {
        3 => sums_by::<3>(coefficients, functions, entries),
        _ => sums_by::<4>(coefficients, functions, entries),
    }
}

#[inline(always)]
fn sums_by<const TILE: usize>(coefficients: &Coefficients, functions: &[Lanes], entries: &mut [Lanes]) {
    let functions = &functions[..coefficients.rows];
    let tiles = coefficients.values.as_chunks::<TILE>().0.chunks_exact(coefficients.rows);
    for (tile, entries) in tiles.zip(entries.chunks_exact_mut(TILE)) {
        let mut sums = [Lanes::ZERO; TILE];
        for (function, coefficients) in functions.iter().zip(tile) {
            for entry in 0..TILE {
                sums[entry] = sums[entry] + *function * coefficients[entry];
            }
        }
        entries.copy_from_slice(&sums);
    }
}

impl Rows {
    pub(super) fn new(model: &Model, blocks: &[Lanes]) -> Self {
        let modes = model.denominators();
        let (distinct, group, _) = merge(&modes, |_| false);
        let mut next = 0;
        let is_elastic = |mode: &Denominator| mode.stiffness.re != 0.0;
        let elastic: Vec<Option<usize>> = modes
            .iter()
            .map(|mode| {
                next += usize::from(is_elastic(mode));
                is_elastic(mode).then(|| next - 1)
            })
            .collect();
        let laws = laws(model, &modes);
        let count = 2 * distinct.len() + next;
        let mut rows = Rows { group, groups: distinct.len(), elastic, laws, count, table: Vec::new() };
        rows.table = pulp::Arch::new().dispatch(
            #[inline(always)]
            || rows.functions(&modes, &distinct, blocks),
        );
        rows
    }

    /// All functions on all blocks.
    #[inline(always)]
    fn functions(&self, modes: &[Denominator], distinct: &[Denominator], blocks: &[Lanes]) -> Vec<Lanes> {
        let is_structural =
            |g: usize| self.group.iter().zip(&self.laws).any(|(own, law)| *own == g && law.is_structural);
        let structural: Vec<bool> = (0..self.groups).map(is_structural).collect();
        let mut table = Vec::with_capacity(self.count * blocks.len());
        for &s in blocks {
            let first = table.len();
            for mode in distinct {
                let value = Lanes::constant(mode.stiffness) + s * mode.viscous + s * s;
                table.push(value.reciprocal());
            }
            for (r, mode) in modes.iter().enumerate().filter(|(r, _)| self.elastic[*r].is_some()) {
                let inverse: Lanes = table[first + self.group[r]];
                let follows = if self.laws[r].is_structural { 0.0 } else { self.laws[r].slope };
                let factor = Complex64::new(1.0, mode.stiffness.im / mode.stiffness.re);
                table.push((Lanes::constant(factor) + s * follows) * (inverse * inverse));
            }
            for (g, structural) in structural.iter().enumerate() {
                let inverse = table[first + g];
                let by = if *structural { Lanes::constant(Complex64::I) } else { s };
                table.push(by * (inverse * inverse));
            }
        }
        table
    }

    /// The functions on one block.
    #[inline(always)]
    pub(super) fn on_block(&self, block: usize) -> &[Lanes] {
        &self.table[block * self.count..(block + 1) * self.count]
    }

    /// G of each pair of motions.
    pub(super) fn of_receptances(&self, motions: &[&[f64]], entries: &[[usize; 2]]) -> Coefficients {
        let mut all = Coefficients::zero(entries.len(), self.groups);
        for (entry, &[p, q]) in entries.iter().enumerate() {
            for (r, (a, b)) in motions[p].iter().zip(motions[q]).enumerate() {
                all.add(entry, self.group[r], a * b);
            }
        }
        all
    }

    /// dG of each pair of motions, with the changes of these and of the denominators.
    pub(super) fn of_change(
        &self,
        motions: &[&[f64]],
        changes: &[&[f64]],
        entries: &[[usize; 2]],
        denominators: &[Denominator],
    ) -> Coefficients {
        let own = self.changes_of_damping(denominators);
        let own_rows = self.count - self.groups;
        let rows = if own.iter().any(|change| *change != 0.0) { self.count } else { own_rows };
        let mut all = Coefficients::zero(entries.len(), rows);
        for (entry, &[p, q]) in entries.iter().enumerate() {
            for r in 0..self.group.len() {
                let (a, b) = (motions[p][r], motions[q][r]);
                all.add(entry, self.group[r], changes[p][r] * b + a * changes[q][r]);
                if let Some(row) = self.elastic[r] {
                    all.add(entry, self.groups + row, -a * b * denominators[r].stiffness.re);
                }
                if own[r] != 0.0 {
                    all.add(entry, own_rows + self.group[r], -a * b * own[r]);
                }
            }
        }
        all
    }

    /// How each mode's damping changes beside what its law makes of the change of λ.
    fn changes_of_damping(&self, denominators: &[Denominator]) -> Vec<f64> {
        let of = |(law, change): (&ByLaw, &Denominator)| {
            let whole = if law.is_structural { change.stiffness.im } else { change.viscous };
            let by_law = law.slope * change.stiffness.re;
            let own = whole - by_law;
            let (share, least) = ROUNDING;
            if own.abs() <= share * by_law.abs() + least * law.size { 0.0 } else { own }
        };
        self.laws.iter().zip(denominators).map(of).collect()
    }
}

/// What each mode's damping does for a change of λ: it grows as √λ where ratios are known, in proportion
/// where structural damping is.
fn laws(model: &Model, modes: &[Denominator]) -> Vec<ByLaw> {
    let (law, own) = (model.damping_law(), model.assembly_modes());
    let of = |(r, mode): (usize, &Denominator)| {
        let is_structural = r < own && matches!(law, DampingLaw::LossFactor(_));
        let (eigenvalue, size) =
            (mode.stiffness.re, if is_structural { mode.stiffness.im } else { mode.viscous });
        let slope = match law {
            DampingLaw::Rayleigh { stiffness, .. } if r < own => *stiffness,
            _ if eigenvalue == 0.0 => 0.0,
            _ if is_structural => size / eigenvalue,
            _ => 0.5 * size / eigenvalue,
        };
        ByLaw { slope, size: size.abs(), is_structural }
    };
    modes.iter().enumerate().map(of).collect()
}
