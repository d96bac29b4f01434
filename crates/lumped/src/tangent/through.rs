//! What supports and effects pass on: R and g of every channel, by block of lines.

use super::rows::{Rows, sums};
use crate::ModelledTest;
use crate::lanes::Lanes;
use crate::motions::Motions;
use crate::receptances::divided;
use crate::terms::Terms;
use jointscope_linalg::{Field, LuWorkspace};

/// On each block R_o, a row over the stations of the change for each output; R_i the same for each input;
/// then g_o and g_i.
#[derive(Debug, Clone)]
pub(super) struct Through {
    outputs: usize,
    inputs: usize,
    rank: usize,
    table: Vec<Lanes>,
}

/// Memory for one block: what each output multiplies R_i and g_i of the inputs by.
#[derive(Debug, Clone)]
pub(super) struct Memory {
    by_passing: Vec<Lanes>,
    by_motion: Vec<Lanes>,
}

impl Through {
    /// `None` where a line has no solution.
    pub(super) fn new(test: &ModelledTest, motions: &Motions, rows: &Rows, blocks: &[Lanes]) -> Option<Self> {
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || Through::solved(test, motions, rows, blocks),
        )
    }

    #[inline(always)]
    fn solved(test: &ModelledTest, motions: &Motions, rows: &Rows, blocks: &[Lanes]) -> Option<Self> {
        let (outputs, inputs, rank) = (motions.outputs.len(), motions.inputs.len(), motions.change.len());
        let mut through = Through { outputs, inputs, rank, table: Vec::new() };
        if rank == 0 {
            return Some(through);
        }
        let (terms, elements) = (test.model.terms(), test.model.terms().elements());
        let coefficients = rows.of_receptances(&motions.all(), &motions.entries(&[]));
        let mut entries = vec![Lanes::ZERO; coefficients.padded()];
        let (mut delta, mut lu) = (vec![Lanes::ZERO; rank * rank], LuWorkspace::new());
        let channels = outputs + inputs;
        let mut passed = vec![Lanes::ZERO; rank * channels];
        for (block, &s) in blocks.iter().enumerate() {
            sums(&coefficients, rows.on_block(block), &mut entries);
            terms.write(s, &mut delta);
            let (left, rest) = entries.split_at(outputs * rank);
            let (middle, right) = rest.split_at(rank * rank);
            // G is symmetric: outputs are pushed as inputs are.
            let at = |v: usize, channel: usize| match channel.checked_sub(outputs) {
                Some(input) => right[v * inputs + input],
                None => left[channel * rank + v],
            };
            passed.fill(Lanes::ZERO);
            for &(row, column) in &elements {
                for channel in 0..channels {
                    let to = &mut passed[row * channels + channel];
                    *to = *to + delta[row * rank + column] * at(column, channel);
                }
            }
            if !divided(&elements, &delta, middle, (&mut passed, channels), &mut lu) {
                return None;
            }
            let turned = (0..channels).flat_map(|c| (0..rank).map(move |v| (c, v)));
            through.table.extend(turned.clone().map(|(c, v)| passed[v * channels + c]));
            let motion = |(c, v): (usize, usize)| {
                (0..rank).fold(at(v, c), |sum, w| sum - middle[v * rank + w] * passed[w * channels + c])
            };
            through.table.extend(turned.map(motion));
        }
        Some(through)
    }

    pub(super) fn memory(&self) -> Memory {
        let none = vec![Lanes::ZERO; self.outputs * self.rank];
        Memory { by_passing: none.clone(), by_motion: none }
    }

    /// (Δ after − Δ)/step by block; empty where nothing of it changes.
    pub(super) fn changes_of_delta(
        &self,
        before: &Terms,
        after: &Terms,
        blocks: &[Lanes],
        step: f64,
    ) -> Vec<Lanes> {
        let (before, after) = before.where_they_differ(after);
        if after.terms.is_empty() {
            return Vec::new();
        }
        let elements = self.rank * self.rank;
        let mut all = vec![Lanes::ZERO; elements * blocks.len()];
        let mut here = vec![Lanes::ZERO; elements];
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                for (there, &s) in all.chunks_exact_mut(elements).zip(blocks) {
                    after.write(s, there);
                    before.write(s, &mut here);
                    there
                        .iter_mut()
                        .zip(&here)
                        .for_each(|(there, here)| *there = (*there - *here) * (1.0 / step));
                }
            },
        );
        all
    }

    /// Makes dH of the dG of the wanted pairs, the first of the entries on one block.
    #[inline(always)]
    pub(super) fn combine(
        &self,
        block: usize,
        wanted: &[(usize, usize)],
        entries: &mut [Lanes],
        delta: &[Lanes],
        memory: &mut Memory,
    ) {
        let &Through { outputs, inputs, rank, .. } = self;
        if rank == 0 {
            return;
        }
        let (pairs, rest) = entries.split_at_mut(wanted.len());
        let (left, rest) = rest.split_at(outputs * rank);
        let (middle, right) = rest.split_at(rank * rank);
        let channels = (outputs + inputs) * rank;
        let (passed, motion) =
            self.table[2 * block * channels..2 * (block + 1) * channels].split_at(channels);
        for output in 0..outputs {
            for w in 0..rank {
                let passes = |v: usize| passed[output * rank + v] * middle[v * rank + w];
                memory.by_passing[output * rank + w] =
                    (0..rank).fold(left[output * rank + w], |sum, v| sum - passes(v));
                if !delta.is_empty() {
                    let delta = &delta[block * rank * rank..];
                    let moves = |v: usize| motion[output * rank + v] * delta[v * rank + w];
                    memory.by_motion[output * rank + w] =
                        (0..rank).fold(Lanes::ZERO, |sum, v| sum + moves(v));
                }
            }
        }
        for (pair, &(o, i)) in pairs.iter_mut().zip(wanted) {
            for v in 0..rank {
                let (from, to) = (o * rank + v, (outputs + i) * rank + v);
                *pair = *pair - memory.by_passing[from] * passed[to] - passed[from] * right[v * inputs + i];
                if !delta.is_empty() {
                    *pair = *pair - memory.by_motion[from] * motion[to];
                }
            }
        }
    }
}
