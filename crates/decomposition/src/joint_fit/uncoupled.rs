//! FRFs of the fixture without the joints that are looked for, and what these make of them.
//!
//! Each joint acts on its own d_j = u_to − R_j·u_from. With all d_j one below the other, G of the fixture without the joints and Z = diag(Z_j),
//!
//! H_oi = G_oi − G_od (I + Z G_dd)⁻¹ Z G_di, and δH_oi = −G_od (I + Z G_dd)⁻¹ δZ (I + G_dd Z)⁻¹ G_di:
//!
//! whatever the joints, G stays; it does not matter whether they form a chain or loops. Without them the fixture falls into pieces, of which a quantity moves but the one that it belongs to.

use super::law::{MOST, Placed};
use super::problem::Setup;
use super::recorded::Recorded;
use crate::sides::with_effects_of;
use jointscope_beam::{Matrix4, mass_of_ends};
use jointscope_fixture::Fixture;
use jointscope_linalg::{ComplexMatrix2, LuWorkspace, Matrix2};
use jointscope_lumped::{Instrument, MeasuringChain, Model, Station};
use num_complex::Complex64;
use std::sync::Arc;

/// Most joints that are found at once.
pub(super) const MOST_JOINTS: usize = 8;
/// Stations of a joint's ends: y and θ of the near one, then of the far one.
const ENDS: usize = 4;

/// The fixture without its joints on all lines, line after line.
#[derive(Debug)]
pub(super) struct Uncoupled {
    pieces: Vec<Arc<Piece>>,
    chain: MeasuringChain,
    /// Recorded accelerance per receptance, by FRF.
    factors: Arc<Vec<Complex64>>,
    /// Coordinates of all d_j, two a joint; with those of the first joint's mass.
    order: usize,
    width: usize,
    /// Between channels, by FRF.
    between: Vec<Complex64>,
    /// From loads on d to the responses, row-major.
    from: Vec<Complex64>,
    /// From the references to d, row-major.
    to: Vec<Complex64>,
    /// G_dd, row-major.
    at: Vec<Complex64>,
}

/// Receptances of bodies that hold together without the joints.
#[derive(Debug)]
struct Piece {
    fixture: Fixture,
    outputs: Vec<Station>,
    inputs: Vec<Station>,
    /// Output and input of each receptance, among those of the whole.
    pairs: Vec<(usize, usize)>,
    /// Receptance after receptance.
    values: Vec<Complex64>,
}

impl Uncoupled {
    /// A fixture without its joints but with the mass (kg, uniform) of the first of them. Pieces that `before` has already are taken from there.
    ///
    /// `None` where a piece has no finite receptances.
    pub fn of(setup: &Setup, fixture: &Fixture, mass: f64, before: Option<&Uncoupled>) -> Option<Self> {
        let recorded = setup.recorded;
        let chain = MeasuringChain::of(fixture, &recorded.pairs, Instrument::AsRecorded).ok()?;
        let joints: Vec<_> = setup.joints.iter().map(|&joint| &fixture.joints()[joint]).collect();
        let ends = joints.iter().flat_map(|joint| [joint.from, joint.to]).flat_map(|point| {
            let point = &fixture.points()[point];
            Station::both(point.body, point.x.value)
        });
        let outputs = recorded.responses.iter().map(|&frf| chain.readings[frf].output);
        let inputs = recorded.references.iter().map(|&frf| chain.readings[frf].input);
        let responding: Vec<Station> = ends.clone().chain(outputs).collect();
        let loaded: Vec<Station> = ends.chain(inputs).collect();
        let count = setup.pieces.iter().max().map_or(0, |last| last + 1);
        let piece = |piece: usize| {
            let known = before.map(|before| &before.pieces[piece]);
            Piece::of(setup, fixture, (&responding, &loaded), piece, known)
        };
        let pieces = (0..count).map(piece).collect::<Option<Vec<_>>>()?;
        let same = before.filter(|before| {
            let readings = before.chain.readings.iter().zip(&chain.readings);
            before.chain.decay() == chain.decay() && readings.into_iter().all(|(a, b)| a.has_signals_of(b))
        });
        let factors = same.map_or_else(
            || {
                let values = (0..recorded.pairs.len())
                    .flat_map(|frf| recorded.s.iter().map(move |s| (frf, s.im)))
                    .map(|(frf, omega)| chain.factor(frf, omega));
                Arc::new(values.collect())
            },
            |before| Arc::clone(&before.factors),
        );
        let lengths: Vec<f64> = joints.iter().map(|joint| fixture.joint_length(joint)).collect();
        let masses =
            if mass > 0.0 { square_root(&mass_of_ends(mass, lengths[0])).to_vec() } else { Vec::new() };
        let order = 2 * joints.len();
        let width = order + masses.len();
        let (n, zero) = (recorded.s.len(), Complex64::ZERO);
        let mut all = Uncoupled {
            pieces,
            chain,
            factors,
            order,
            width,
            between: vec![zero; recorded.pairs.len() * n],
            from: vec![zero; recorded.responses.len() * width * n],
            to: vec![zero; width * recorded.references.len() * n],
            at: vec![zero; width * width * n],
        };
        let on: Vec<_> = (0..ENDS * joints.len()).map(|end| on_relative(end, &lengths, &masses)).collect();
        for piece in all.pieces.clone() {
            for (pair, values) in piece.pairs.iter().zip(piece.values.chunks_exact(n)) {
                all.add(*pair, values, &on, recorded);
            }
        }
        all.put_in_the_mass(recorded);
        Some(all)
    }

    /// Adds the receptances between two stations to all entries that they are a part of; `on` says of each end what it is in which coordinates.
    fn add(
        &mut self,
        (o, i): (usize, usize),
        values: &[Complex64],
        on: &[Vec<(usize, f64)>],
        recorded: &Recorded,
    ) {
        let own = on.len();
        let (width, references) = (self.width, recorded.references.len());
        let add = |to: &mut [Complex64], by_line: usize, place: usize, weight: f64| {
            let entries = to[place..].iter_mut().step_by(by_line);
            entries.zip(values).for_each(|(entry, value)| *entry += value * weight);
        };
        match (on.get(o), on.get(i)) {
            (Some(responding), Some(loaded)) => {
                for (a, left) in responding {
                    for (b, right) in loaded {
                        add(&mut self.at, width * width, a * width + b, left * right);
                    }
                }
            }
            (None, Some(loaded)) => {
                for (b, weight) in loaded {
                    add(&mut self.from, recorded.responses.len() * width, (o - own) * width + b, *weight);
                }
            }
            (Some(responding), None) => {
                for (a, weight) in responding {
                    add(&mut self.to, width * references, a * references + i - own, *weight);
                }
            }
            (None, None) => {
                let frfs = recorded.channels.iter().enumerate();
                for (frf, _) in frfs.filter(|(_, channel)| **channel == (o - own, i - own)) {
                    add(&mut self.between, recorded.pairs.len(), frf, 1.0);
                }
            }
        }
    }

    /// Puts the joint's mass in: each of its coordinates, those from `order` on, is loaded by s², a change of rank one.
    fn put_in_the_mass(&mut self, recorded: &Recorded) {
        let width = self.width;
        let (frfs, outputs, inputs) =
            (recorded.pairs.len(), recorded.responses.len(), recorded.references.len());
        for (line, s) in recorded.s.iter().enumerate() {
            let at = &mut self.at[line * width * width..(line + 1) * width * width];
            let from = &mut self.from[line * outputs * width..(line + 1) * outputs * width];
            let to = &mut self.to[line * width * inputs..(line + 1) * width * inputs];
            let between = &mut self.between[line * frfs..(line + 1) * frfs];
            for own in (self.order..width).rev() {
                let (rest, row) = at.split_at_mut(own * width);
                let (to_rest, to_own) = to.split_at_mut(own * inputs);
                let share = (s * s) / (s * s * row[own] + 1.0);
                for (value, &(o, i)) in between.iter_mut().zip(&recorded.channels) {
                    *value -= share * from[o * width + own] * to_own[i];
                }
                for from in from.chunks_exact_mut(width) {
                    let by = share * from[own];
                    from[..own].iter_mut().zip(&*row).for_each(|(value, other)| *value -= by * other);
                }
                for (at, to) in rest.chunks_exact_mut(width).zip(to_rest.chunks_exact_mut(inputs)) {
                    let by = share * at[own];
                    to.iter_mut().zip(&*to_own).for_each(|(value, other)| *value -= by * other);
                    at[..own].iter_mut().zip(&*row).for_each(|(value, other)| *value -= by * other);
                }
            }
        }
    }

    /// What is recorded with joints of these laws, FRF after FRF; its derivatives by the coordinates of laws (these or others that take their places), one law's after the
    /// other's, over `columns`, if wanted.
    ///
    /// `None` where a line has no finite response.
    pub fn coupled(
        &self,
        recorded: &Recorded,
        laws: &[Placed],
        mut columns: Option<(&[Placed], &mut [Vec<Complex64>])>,
    ) -> Option<Vec<Complex64>> {
        let (n, order, width) = (recorded.s.len(), self.order, self.width);
        let (frfs, outputs, inputs) =
            (recorded.pairs.len(), recorded.responses.len(), recorded.references.len());
        let zero = Complex64::ZERO;
        let mut values = vec![zero; frfs * n];
        let (mut lu, mut slots) = (LuWorkspace::new(), [zero; MOST]);
        let mut inverse = vec![zero; order * order];
        let (mut rows, mut forces, mut motions) =
            (vec![zero; outputs * order], vec![zero; inputs * order], vec![zero; inputs * order]);
        let mut through = vec![zero; order];
        let mut stiffness = [ComplexMatrix2::zero(); MOST_JOINTS];
        let mut factors = [[zero; 3]; MOST_JOINTS];
        for (line, &s) in recorded.s.iter().enumerate() {
            let at = &self.at[line * width * width..(line + 1) * width * width];
            let from = &self.from[line * outputs * width..(line + 1) * outputs * width];
            let to = &self.to[line * width * inputs..(line + 1) * width * inputs];
            stiffness.iter_mut().zip(laws).for_each(|(stiffness, law)| *stiffness = law.stiffness(s));
            if let ([z, ..], 2) = (&stiffness, order) {
                let own = Matrix2::new(at[0], at[1], at[width], at[width + 1]);
                let closed = (ComplexMatrix2::identity() + *z * own).inverse()?;
                inverse.copy_from_slice(closed.0.as_flattened());
            } else {
                lu.factorize(order, |matrix| {
                    for (d, row) in matrix.chunks_exact_mut(order).enumerate() {
                        for (column, entry) in row.iter_mut().enumerate() {
                            let one = f64::from(u8::from(d == column));
                            *entry = loaded(&stiffness, d, |e| at[e * width + column]) + one;
                        }
                    }
                })
                .ok()?;
                inverse.fill(zero);
                (0..order).for_each(|d| inverse[d * order + d] = Complex64::ONE);
                lu.solve_columns_in_place(&mut inverse, order);
            }
            for (row, from) in rows.chunks_exact_mut(order).zip(from.chunks_exact(width)) {
                for (column, entry) in row.iter_mut().enumerate() {
                    *entry = (0..order).map(|d| from[d] * inverse[d * order + column]).sum();
                }
            }
            for (i, force) in forces.chunks_exact_mut(order).enumerate() {
                for (d, entry) in force.iter_mut().enumerate() {
                    *entry = loaded(&stiffness, d, |e| to[e * inputs + i]);
                }
            }
            // Motions of d are for derivatives only.
            if let Some((laws, _)) = &columns {
                factors.iter_mut().zip(*laws).for_each(|(factors, law)| *factors = law.factors(s));
                let all = motions.chunks_exact_mut(order).zip(forces.chunks_exact(order));
                for (i, (motion, force)) in all.enumerate() {
                    for (row, entry) in inverse.chunks_exact(order).zip(&mut through) {
                        *entry = row.iter().zip(force).map(|(a, f)| a * f).sum();
                    }
                    for (d, entry) in motion.iter_mut().enumerate() {
                        let lost: Complex64 = through.iter().zip(&at[d * width..]).map(|(t, a)| a * t).sum();
                        *entry = to[d * inputs + i] - lost;
                    }
                }
            }
            for (frf, &(response, reference)) in recorded.channels.iter().enumerate() {
                let place = frf * n + line;
                let row = &rows[response * order..(response + 1) * order];
                let force = &forces[reference * order..(reference + 1) * order];
                let factor = self.factors[place];
                let passed: Complex64 = row.iter().zip(force).map(|(r, f)| r * f).sum();
                values[place] = factor * (self.between[line * frfs + frf] - passed);
                let Some((laws, columns)) = &mut columns else { continue };
                let motion = &motions[reference * order..(reference + 1) * order];
                let mut rest = &mut **columns;
                let ends = row.chunks_exact(2).zip(motion.chunks_exact(2));
                for ((law, factors), (row, motion)) in laws.iter().zip(&factors).zip(ends) {
                    let [a, b] = [-factor * row[0], -factor * row[1]];
                    let by = [a * motion[0], a * motion[1], b * motion[0], b * motion[1]];
                    let (own, others) = rest.split_at_mut(law.count());
                    let slots = &mut slots[..law.count()];
                    law.chain(by, *factors, slots);
                    own.iter_mut().zip(&*slots).for_each(|(column, value)| column[place] = *value);
                    rest = others;
                }
            }
        }
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

impl Piece {
    /// The piece of this number, or the one `known` where that is the same.
    fn of(
        setup: &Setup,
        whole: &Fixture,
        (responding, loaded): (&[Station], &[Station]),
        number: usize,
        known: Option<&Arc<Piece>>,
    ) -> Option<Arc<Self>> {
        let is_on = |body: usize| setup.pieces[body] == number;
        let fixture = with_effects_of(whole, whole.part(is_on, setup.joints));
        // Places among the whole's stations, and the stations by the piece's own bodies.
        let own = |all: &[Station]| -> (Vec<usize>, Vec<Station>) {
            let index = |body: usize| (0..body).filter(|&other| is_on(other)).count();
            let own = all.iter().enumerate().filter(|(_, station)| is_on(station.body));
            own.map(|(place, station)| (place, Station { body: index(station.body), ..*station })).unzip()
        };
        let ((rows, outputs), (columns, inputs)) = (own(responding), own(loaded));
        if let Some(known) = known
            && known.outputs == outputs
            && known.inputs == inputs
            && known.fixture == fixture
        {
            return Some(Arc::clone(known));
        }
        let (ends, recorded) = (ENDS * setup.joints.len(), setup.recorded);
        let is_wanted =
            |o: usize, i: usize| o < ends || i < ends || recorded.channels.contains(&(o - ends, i - ends));
        let all = rows.iter().enumerate().flat_map(|o| columns.iter().enumerate().map(move |i| (o, i)));
        let (wanted, pairs): (Vec<_>, Vec<_>) = all
            .filter(|((_, o), (_, i))| is_wanted(**o, **i))
            .map(|((row, o), (column, i))| ((row, column), (*o, *i)))
            .unzip();
        let mut values = vec![Complex64::ZERO; pairs.len() * recorded.s.len()];
        let model = Model::new(&fixture, recorded.highest).ok()?;
        model.receptances_of(&outputs, &inputs, wanted).on_lines(&recorded.s, &mut values).ok()?;
        Some(Arc::new(Piece { fixture, outputs, inputs, pairs, values }))
    }
}

/// An entry of Z times a column, Z being made of these stiffnesses.
fn loaded(stiffness: &[ComplexMatrix2], d: usize, column: impl Fn(usize) -> Complex64) -> Complex64 {
    let (z, first) = (&stiffness[d / 2], d - d % 2);
    z.at(d % 2, 0) * column(first) + z.at(d % 2, 1) * column(first + 1)
}

/// What the motion of a joint's end is a part of, and with what weight: d_j = u_to − R·u_from, and for the first joint the coordinates of its mass, which are those of all d
/// followed by lᵀu of `masses`.
fn on_relative(station: usize, lengths: &[f64], masses: &[[f64; 4]]) -> Vec<(usize, f64)> {
    let (joint, end) = (station / ENDS, station % ENDS);
    let (y, theta) = (2 * joint, 2 * joint + 1);
    let mut on = match end {
        0 => vec![(y, -1.0)],
        1 => vec![(y, -lengths[joint]), (theta, -1.0)],
        2 => vec![(y, 1.0)],
        _ => vec![(theta, 1.0)],
    };
    if joint == 0 {
        let own = masses.iter().enumerate().map(|(k, l)| (2 * lengths.len() + k, l[end]));
        on.extend(own.filter(|(_, weight)| *weight != 0.0));
    }
    on
}

/// Columns l of a lower triangular factor, M = Σ l lᵀ, of a matrix that is positive semidefinite.
fn square_root(matrix: &Matrix4) -> [[f64; 4]; 4] {
    let mut rest = *matrix;
    std::array::from_fn(|k| {
        let pivot = rest[k][k];
        let mut column = [0.0; 4];
        if pivot > 0.0 {
            (k..4).for_each(|i| column[i] = rest[i][k] / pivot.sqrt());
            for i in k..4 {
                (k..4).for_each(|j| rest[i][j] -= column[i] * column[j]);
            }
        }
        column
    })
}
