//! What joints make of the FRFs of the fixture without them, by the equations of
//! [`uncoupled`](super::uncoupled).

use super::law::{MOST, Placed};
use super::recorded::Recorded;
use super::uncoupled::{MOST_JOINTS, Uncoupled};
use jointscope_linalg::{LuWorkspace, Matrix2};
use jointscope_lumped::{Lanes, Lines};
use num_complex::Complex64;
use std::array::from_fn;
use std::ops::Range;

impl Uncoupled {
    /// What is recorded with joints of these laws, FRF after FRF; its derivatives by the coordinates of laws
    /// (these or others that take their places), one law's after the other's, over `columns`, if wanted.
    ///
    /// `None` where a line has no finite response.
    pub(super) fn coupled(
        &self,
        recorded: &Recorded,
        laws: &[Placed],
        columns: Option<Columns>,
    ) -> Option<Vec<Complex64>> {
        let mut values = vec![Complex64::ZERO; self.factors.len()];
        let lines = Coupled { uncoupled: self, recorded, laws, columns, values: &mut values };
        match self.order {
            2 => pulp::Arch::new().dispatch(lines),
            4 => lines.solved::<4>()?,
            6 => lines.solved::<6>()?,
            8 => lines.solved::<8>()?,
            10 => lines.solved::<10>()?,
            12 => lines.solved::<12>()?,
            14 => lines.solved::<14>()?,
            _ => lines.solved::<{ 2 * MOST_JOINTS }>()?,
        }
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

/// Laws whose coordinates derivatives are wanted by, and the columns to write them to.
pub(super) type Columns<'a> = (&'a [Placed<'a>], &'a mut [Vec<Complex64>]);

/// Joints on the fixture without them.
struct Coupled<'a> {
    uncoupled: &'a Uncoupled,
    recorded: &'a Recorded,
    laws: &'a [Placed<'a>],
    columns: Option<Columns<'a>>,
    values: &'a mut [Complex64],
}

/// One joint: several lines at once.
impl pulp::WithSimd for Coupled<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        // Where the matrix is singular, values are not finite.
        self.on_lines::<Lanes, 2>(|[[a, b], [c, d]]| Some(Matrix2::new(a, b, c, d).inverse_unchecked().0));
    }
}

impl Coupled<'_> {
    /// Several joints: line by line.
    fn solved<const ORDER: usize>(self) -> Option<()> {
        let mut lu = LuWorkspace::new();
        self.on_lines::<Complex64, ORDER>(|matrix| {
            lu.factorize(ORDER, |to| to.copy_from_slice(matrix.as_flattened())).ok()?;
            let mut inverse = identity();
            lu.solve_columns_in_place(inverse.as_flattened_mut(), ORDER);
            Some(inverse)
        })
    }

    /// `ORDER`, the number of coordinates, is one of the compiler's: loops over so few cost three times as
    /// much where it is not.
    #[inline(always)]
    fn on_lines<T: Lines, const ORDER: usize>(
        self,
        mut inverse: impl FnMut([[T; ORDER]; ORDER]) -> Option<[[T; ORDER]; ORDER]>,
    ) -> Option<()> {
        let Coupled { uncoupled, recorded, laws, mut columns, values } = self;
        let n = recorded.s.len();
        let mut joints = JointsOnLines::<T, ORDER>::of_size(recorded);
        let mut slots = [T::ZERO; MOST];
        let mut factors = [[T::ZERO; 3]; MOST_JOINTS];
        for first in (0..n).step_by(T::COUNT) {
            let part = Part { uncoupled, n, lines: first..(first + T::COUNT).min(n) };
            let s = &recorded.s[part.lines.clone()];
            // Motions of d are for derivatives only.
            joints.put(&part, (s, laws), &mut inverse, columns.is_some())?;
            if let Some((laws, _)) = &columns {
                factors.iter_mut().zip(*laws).for_each(|(factors, law)| *factors = law.factors(s));
            }
            for (frf, &channel) in recorded.channels.iter().enumerate() {
                let place = part.place(frf);
                let factor = part.entry(&uncoupled.factors, frf);
                joints.response(&part, (frf, channel), factor).write(&mut values[place.clone()]);
                if let Some((laws, columns)) = &mut columns {
                    let ends = joints.ends(channel);
                    derivatives((laws, &factors), ends, factor, &mut slots, (columns, place));
                }
            }
        }
        Some(())
    }
}

/// Entries of a fixture without its joints on some of `n` lines.
struct Part<'a> {
    uncoupled: &'a Uncoupled,
    n: usize,
    lines: Range<usize>,
}

impl Part<'_> {
    #[inline(always)]
    fn place(&self, entry: usize) -> Range<usize> {
        entry * self.n + self.lines.start..entry * self.n + self.lines.end
    }

    #[inline(always)]
    fn entry<T: Lines>(&self, of: &[Complex64], entry: usize) -> T {
        T::of(&of[self.place(entry)])
    }
}

/// What joints make of the fixture without them, on some lines at once.
struct JointsOnLines<T, const ORDER: usize> {
    /// Z_j.
    stiffness: [Matrix2<T>; MOST_JOINTS],
    /// G_od (I + Z G_dd)⁻¹, by response.
    rows: Vec<[T; ORDER]>,
    /// Z G_di, by reference.
    forces: Vec<[T; ORDER]>,
    /// (I + G_dd Z)⁻¹ G_di, by reference.
    motions: Vec<[T; ORDER]>,
}

impl<T: Lines, const ORDER: usize> JointsOnLines<T, ORDER> {
    fn of_size(recorded: &Recorded) -> Self {
        let none = [T::ZERO; ORDER];
        JointsOnLines {
            stiffness: [Matrix2::zero(); MOST_JOINTS],
            rows: vec![none; recorded.responses.len()],
            forces: vec![none; recorded.references.len()],
            motions: vec![none; recorded.references.len()],
        }
    }

    /// Puts joints of these laws in, on the lines of a part; `None` where I + Z G_dd has no `inverse`.
    #[inline(always)]
    fn put(
        &mut self,
        part: &Part,
        (s, laws): (&[Complex64], &[Placed]),
        inverse: &mut impl FnMut([[T; ORDER]; ORDER]) -> Option<[[T; ORDER]; ORDER]>,
        with_motions: bool,
    ) -> Option<()> {
        let (uncoupled, width, inputs) = (part.uncoupled, part.uncoupled.width, self.forces.len());
        self.stiffness.iter_mut().zip(laws).for_each(|(stiffness, law)| *stiffness = law.stiffness(s));
        let stiffness = &self.stiffness;
        let at: [[T; ORDER]; ORDER] = from_fn(|d| from_fn(|e| part.entry(&uncoupled.at, d * width + e)));
        let mut matrix: [[T; ORDER]; ORDER] = from_fn(|d| from_fn(|e| loaded(stiffness, d, |d| at[d][e])));
        (0..ORDER).for_each(|d| matrix[d][d] = matrix[d][d] + T::ONE);
        let inverse = inverse(matrix)?;
        for (o, row) in self.rows.iter_mut().enumerate() {
            let from: [T; ORDER] = from_fn(|d| part.entry(&uncoupled.from, o * width + d));
            *row = from_fn(|e| sum::<T, ORDER>(|d| from[d] * inverse[d][e]));
        }
        for (i, (force, motion)) in self.forces.iter_mut().zip(&mut self.motions).enumerate() {
            let to: [T; ORDER] = from_fn(|d| part.entry(&uncoupled.to, d * inputs + i));
            *force = from_fn(|d| loaded(stiffness, d, |e| to[e]));
            if with_motions {
                let through: [T; ORDER] = from_fn(|d| sum::<T, ORDER>(|e| inverse[d][e] * force[e]));
                *motion = from_fn(|d| to[d] - sum::<T, ORDER>(|e| through[e] * at[d][e]));
            }
        }
        Some(())
    }

    /// H_oi of an FRF, in the form in which it is recorded.
    #[inline(always)]
    fn response(&self, part: &Part, (frf, (o, i)): (usize, (usize, usize)), factor: T) -> T {
        let (row, force) = (&self.rows[o], &self.forces[i]);
        let between: T = part.entry(&part.uncoupled.between, frf);
        factor * (between - sum::<T, ORDER>(|d| row[d] * force[d]))
    }

    /// By joint, the row of a response and the motions by a reference.
    #[inline(always)]
    fn ends(&self, (o, i): (usize, usize)) -> impl Iterator<Item = (&[T], &[T])> {
        self.rows[o].chunks_exact(2).zip(self.motions[i].chunks_exact(2))
    }
}

/// An entry of Z times a column.
#[inline(always)]
fn loaded<T: Lines>(stiffness: &[Matrix2<T>; MOST_JOINTS], d: usize, column: impl Fn(usize) -> T) -> T {
    let (z, first) = (&stiffness[d / 2], d - d % 2);
    z.at(d % 2, 0) * column(first) + z.at(d % 2, 1) * column(first + 1)
}

/// Writes an FRF's derivatives by the coordinates of all laws to their columns, at its place in these.
#[inline(always)]
fn derivatives<'t, T: Lines + 't>(
    (laws, factors): (&[Placed], &[[T; 3]; MOST_JOINTS]),
    ends: impl Iterator<Item = (&'t [T], &'t [T])>,
    factor: T,
    slots: &mut [T; MOST],
    (columns, place): (&mut [Vec<Complex64>], Range<usize>),
) {
    let mut rest = columns;
    for ((law, factors), (row, motion)) in laws.iter().zip(factors).zip(ends) {
        let [a, b] = [-(factor * row[0]), -(factor * row[1])];
        let by = [a * motion[0], a * motion[1], b * motion[0], b * motion[1]];
        let (own, others) = rest.split_at_mut(law.count());
        let slots = &mut slots[..law.count()];
        law.chain(by, *factors, slots);
        own.iter_mut().zip(&*slots).for_each(|(column, slot)| slot.write(&mut column[place.clone()]));
        rest = others;
    }
}

#[inline(always)]
fn sum<T: Lines, const N: usize>(term: impl Fn(usize) -> T) -> T {
    (1..N).fold(term(0), |sum, n| sum + term(n))
}

fn identity<const N: usize>() -> [[Complex64; N]; N] {
    from_fn(|d| from_fn(|e| if d == e { Complex64::ONE } else { Complex64::ZERO }))
}
