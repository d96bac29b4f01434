//! FRFs of the two sides without the joint, and what the joint makes of them.
//!
//! The joint acts on d = u_to − R·u_from alone, so with the uncoupled FRFs G
//!
//! H_oi = G_oi − G_od (I + Z G_dd)⁻¹ Z G_di, and δH_oi = −G_od (I + Z G_dd)⁻¹ δZ (I + G_dd Z)⁻¹ G_di:
//!
//! whatever the joint, G stays; whatever the FRF, one 2×2 matrix a line is inverted.

use super::law::{MOST, Placed};
use super::recorded::Recorded;
use crate::Sides;
use jointscope_beam::{Matrix4, consistent_mass};
use jointscope_fixture::Fixture;
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use jointscope_lumped::{Instrument, MeasuringChain, Model, Station};
use num_complex::Complex64;
use std::sync::Arc;

/// Receptances of one side: between the joint's end (y, θ) and the channels on it. FRF after FRF, in the order of [`OnSide::wanted`].
#[derive(Debug)]
struct SideFrfs {
    fixture: Fixture,
    end: [Station; 2],
    outputs: Vec<Station>,
    inputs: Vec<Station>,
    values: Vec<Complex64>,
}

/// The assembly without the joint, on all lines. Every list is entry after entry, each over all lines.
#[derive(Debug)]
pub(super) struct Uncoupled {
    alpha: Arc<SideFrfs>,
    beta: Arc<SideFrfs>,
    chain: MeasuringChain,
    /// Recorded accelerance per receptance.
    factors: Arc<Vec<Complex64>>,
    /// Between channels, by FRF.
    between: Vec<Complex64>,
    /// From a load on d to a response: two entries a response.
    from_joint: Vec<Complex64>,
    /// From a reference to d: two entries a reference.
    to_joint: Vec<Complex64>,
    /// Of d to a load on it: 11, 12, 21, 22.
    at_joint: Vec<Complex64>,
}

/// Which channels sit on a side, and which FRFs stay on it.
struct OnSide {
    outputs: Vec<usize>,
    inputs: Vec<usize>,
    frfs: Vec<usize>,
}

impl OnSide {
    /// (output, input) of each receptance; stations 0 and 1 are the joint's end.
    fn wanted(&self, recorded: &Recorded) -> Vec<(usize, usize)> {
        let ends = (0..2).flat_map(|o| (0..2).map(move |i| (o, i)));
        let outputs = (0..self.outputs.len()).flat_map(|o| (0..2).map(move |i| (2 + o, i)));
        let inputs = (0..self.inputs.len()).flat_map(|i| (0..2).map(move |o| (o, 2 + i)));
        let place = |all: &[usize], channel: usize| all.iter().position(|c| *c == channel).unwrap_or(0);
        let frfs = self.frfs.iter().map(|&frf| {
            let (response, reference) = recorded.channels[frf];
            (2 + place(&self.outputs, response), 2 + place(&self.inputs, reference))
        });
        ends.chain(outputs).chain(inputs).chain(frfs).collect()
    }
}

impl Uncoupled {
    /// The fixture of `sides` without its joint but with the joint's mass (kg, uniform). Sides that `before` has already are taken from there.
    ///
    /// `None` where a side has no finite receptances.
    pub fn of(recorded: &Recorded, sides: &Sides, mass: f64, before: Option<&Uncoupled>) -> Option<Self> {
        let chain = MeasuringChain::of(sides.fixture(), &recorded.pairs, Instrument::AsRecorded).ok()?;
        let output = |channel: usize| chain.readings[recorded.responses[channel]].output;
        let input = |channel: usize| chain.readings[recorded.references[channel]].input;
        let is_on = |station: Station, alpha: bool| sides.is_on_alpha(station.body) == alpha;
        let [near, far] = [sides.joint().from, sides.joint().to].map(|p| &sides.fixture().points()[p]);
        let on = [true, false].map(|alpha| {
            let outputs: Vec<usize> =
                (0..recorded.responses.len()).filter(|&c| is_on(output(c), alpha)).collect();
            let inputs: Vec<usize> =
                (0..recorded.references.len()).filter(|&c| is_on(input(c), alpha)).collect();
            let stays = |frf: &usize| {
                let (response, reference) = recorded.channels[*frf];
                outputs.contains(&response) && inputs.contains(&reference)
            };
            let frfs = (0..recorded.pairs.len()).filter(stays).collect();
            OnSide { outputs, inputs, frfs }
        });
        let side = |alpha: bool, own: &OnSide, before: Option<&Arc<SideFrfs>>| {
            let point = if alpha { near } else { far };
            let own_station = |station: Station| sides.on_its_side(station);
            let end = Station::both(point.body, point.x.value).map(own_station);
            let outputs: Vec<Station> = own.outputs.iter().map(|&c| own_station(output(c))).collect();
            let inputs: Vec<Station> = own.inputs.iter().map(|&c| own_station(input(c))).collect();
            let fixture = sides.side(alpha);
            let same = before.filter(|b| {
                b.end == end && b.outputs == outputs && b.inputs == inputs && b.fixture == *fixture
            });
            match same {
                Some(before) => Some(Arc::clone(before)),
                None => SideFrfs::of(recorded, fixture, end, (outputs, inputs), own).map(Arc::new),
            }
        };
        let [on_alpha, on_beta] = &on;
        let alpha = side(true, on_alpha, before.map(|b| &b.alpha))?;
        let beta = side(false, on_beta, before.map(|b| &b.beta))?;
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
        let n = recorded.s.len();
        let mut all = Uncoupled {
            alpha,
            beta,
            chain,
            factors,
            between: vec![Complex64::ZERO; recorded.pairs.len() * n],
            from_joint: vec![Complex64::ZERO; 2 * recorded.responses.len() * n],
            to_joint: vec![Complex64::ZERO; 2 * recorded.references.len() * n],
            at_joint: vec![Complex64::ZERO; 4 * n],
        };
        all.place(&on, n);
        match mass {
            0.0 => all.onto_relative_motion(sides.length(), &on, n),
            mass => all.add_mass(recorded, mass, sides.length(), &on)?,
        }
        Some(all)
    }

    /// The entries as the sides have them; those of the joint still on the ends of the side that each channel is on.
    fn place(&mut self, on: &[OnSide; 2], n: usize) {
        for (own, side) in on.iter().zip([&self.alpha, &self.beta]) {
            let mut entries = side.values.chunks_exact(n).skip(4);
            let mut copy = |to: &mut [Complex64]| {
                if let Some(from) = entries.next() {
                    to.copy_from_slice(from);
                }
            };
            for &c in &own.outputs {
                copy(&mut self.from_joint[2 * c * n..(2 * c + 1) * n]);
                copy(&mut self.from_joint[(2 * c + 1) * n..(2 * c + 2) * n]);
            }
            for &c in &own.inputs {
                copy(&mut self.to_joint[2 * c * n..(2 * c + 1) * n]);
                copy(&mut self.to_joint[(2 * c + 1) * n..(2 * c + 2) * n]);
            }
            for &frf in &own.frfs {
                copy(&mut self.between[frf * n..(frf + 1) * n]);
            }
        }
    }

    /// From the motions of the ends to d = u_to − R·u_from.
    fn onto_relative_motion(&mut self, length: f64, [on_alpha, _]: &[OnSide; 2], n: usize) {
        let turn = |entries: &mut [Complex64], channel: usize| {
            let (y, theta) = entries[2 * channel * n..(2 * channel + 2) * n].split_at_mut(n);
            for (y, theta) in y.iter_mut().zip(theta) {
                (*y, *theta) = (-(*y + *theta * length), -*theta);
            }
        };
        on_alpha.outputs.iter().for_each(|&c| turn(&mut self.from_joint, c));
        on_alpha.inputs.iter().for_each(|&c| turn(&mut self.to_joint, c));
        let across = crate::Relation::Exact.transport(length);
        for line in 0..n {
            let at = |side: &SideFrfs| {
                let v = |e: usize| side.values[e * n + line];
                Matrix2::new(v(0), v(1), v(2), v(3))
            };
            let joint = at(&self.beta) + across * at(&self.alpha) * across.transpose();
            for (e, (i, j)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
                self.at_joint[e * n + line] = joint.at(i, j);
            }
        }
    }

    /// Adds the joint's mass at its ends, s²M with M consistent, of rank four, and goes on to d: what is left of the joint acts on d alone.
    fn add_mass(
        &mut self,
        recorded: &Recorded,
        mass: f64,
        length: f64,
        [on_alpha, _]: &[OnSide; 2],
    ) -> Option<()> {
        let n = recorded.s.len();
        let mass = if length > 0.0 {
            consistent_mass(mass / length, length)
        } else {
            let mut halves = [[0.0; 4]; 4];
            (halves[0][0], halves[2][2]) = (0.5 * mass, 0.5 * mass);
            halves
        };
        let first = |alpha: bool| if alpha { 0 } else { 2 };
        let outputs: Vec<usize> =
            (0..recorded.responses.len()).map(|c| first(on_alpha.outputs.contains(&c))).collect();
        let inputs: Vec<usize> =
            (0..recorded.references.len()).map(|c| first(on_alpha.inputs.contains(&c))).collect();
        let factor = square_root(&mass);
        // Rows: motions of the ends, then responses; columns: loads on the ends, then references.
        let (height, width) = (4 + outputs.len(), 4 + inputs.len());
        let mut all = vec![Complex64::ZERO; height * width];
        let mut row = vec![Complex64::ZERO; width];
        let mut column = vec![Complex64::ZERO; height];
        for line in 0..n {
            let squared = recorded.s[line] * recorded.s[line];
            all.fill(Complex64::ZERO);
            for i in 0..2 {
                for j in 0..2 {
                    all[i * width + j] = self.alpha.values[(2 * i + j) * n + line];
                    all[(i + 2) * width + j + 2] = self.beta.values[(2 * i + j) * n + line];
                }
                for (c, &at) in inputs.iter().enumerate() {
                    all[(at + i) * width + 4 + c] = self.to_joint[(2 * c + i) * n + line];
                }
                for (c, &at) in outputs.iter().enumerate() {
                    all[(4 + c) * width + at + i] = self.from_joint[(2 * c + i) * n + line];
                }
            }
            for (frf, &(response, reference)) in recorded.channels.iter().enumerate() {
                all[(4 + response) * width + 4 + reference] = self.between[frf * n + line];
            }
            // M = Σ l lᵀ: four changes of rank one.
            for l in &factor {
                for (c, value) in row.iter_mut().enumerate() {
                    *value = (0..4).map(|k| all[k * width + c] * l[k]).sum();
                }
                for (r, value) in column.iter_mut().enumerate() {
                    *value = (0..4).map(|k| all[r * width + k] * l[k]).sum();
                }
                let own: Complex64 = (0..4).map(|k| row[k] * l[k]).sum();
                let share = squared / (squared * own + 1.0);
                for (r, value) in column.iter().enumerate() {
                    let scaled = share * value;
                    let changed = all[r * width..(r + 1) * width].iter_mut();
                    changed.zip(&row).for_each(|(entry, by)| *entry -= scaled * by);
                }
            }
            // d = [−R, I] on (near, far).
            let relative = |v: [Complex64; 4]| [v[2] - v[0] - v[1] * length, v[3] - v[1]];
            let end = |r: usize, c: usize| all[r * width + c];
            let by_ends: [[Complex64; 2]; 4] =
                std::array::from_fn(|i| relative(std::array::from_fn(|j| end(i, j))));
            for j in 0..2 {
                let [y, theta] = relative(std::array::from_fn(|i| by_ends[i][j]));
                self.at_joint[j * n + line] = y;
                self.at_joint[(2 + j) * n + line] = theta;
            }
            for (frf, &(response, reference)) in recorded.channels.iter().enumerate() {
                self.between[frf * n + line] = end(4 + response, 4 + reference);
            }
            for c in 0..outputs.len() {
                let moved = relative(std::array::from_fn(|e| end(4 + c, e)));
                (0..2).for_each(|i| self.from_joint[(2 * c + i) * n + line] = moved[i]);
            }
            for c in 0..inputs.len() {
                let moved = relative(std::array::from_fn(|e| end(e, 4 + c)));
                (0..2).for_each(|i| self.to_joint[(2 * c + i) * n + line] = moved[i]);
            }
        }
        all.iter().all(|value| value.is_finite()).then_some(())
    }

    /// What is recorded with a joint of this law, FRF after FRF; its derivatives by the coordinates of a law (this one or another that takes its place)
    /// over `columns`, if wanted.
    ///
    /// `None` where a line has no finite response.
    pub fn coupled(
        &self,
        recorded: &Recorded,
        law: &Placed,
        mut columns: Option<(&Placed, &mut [Vec<Complex64>])>,
    ) -> Option<Vec<Complex64>> {
        let n = recorded.s.len();
        let mut values = vec![Complex64::ZERO; recorded.pairs.len() * n];
        let pair = |entries: &[Complex64], c: usize, line: usize| {
            [entries[2 * c * n + line], entries[(2 * c + 1) * n + line]]
        };
        let (outputs, inputs) = (recorded.responses.len(), recorded.references.len());
        let mut from = vec![[Complex64::ZERO; 2]; outputs];
        let mut to = vec![([Complex64::ZERO; 2], [Complex64::ZERO; 2]); inputs];
        let mut slots = [Complex64::ZERO; MOST];
        for (line, &s) in recorded.s.iter().enumerate() {
            let g = |e: usize| self.at_joint[e * n + line];
            let joint: ComplexMatrix2 = Matrix2::new(g(0), g(1), g(2), g(3));
            let stiffness = law.stiffness(s);
            let inverse = (ComplexMatrix2::identity() + stiffness * joint).inverse()?;
            // Motions of d are for derivatives only.
            let back = match columns {
                Some(_) => ComplexMatrix2::identity() - joint * (inverse * stiffness),
                None => ComplexMatrix2::zero(),
            };
            for (c, row) in from.iter_mut().enumerate() {
                let [a, b] = pair(&self.from_joint, c, line);
                *row = [0, 1].map(|j| a * inverse.at(0, j) + b * inverse.at(1, j));
            }
            for (c, column) in to.iter_mut().enumerate() {
                let [a, b] = pair(&self.to_joint, c, line);
                let times = |m: &ComplexMatrix2| [0, 1].map(|i| m.at(i, 0) * a + m.at(i, 1) * b);
                let motion = if columns.is_some() { times(&back) } else { [Complex64::ZERO; 2] };
                *column = (times(&stiffness), motion);
            }
            let factors = columns.as_ref().map_or([Complex64::ZERO; 3], |(law, _)| law.factors(s));
            for (frf, &(response, reference)) in recorded.channels.iter().enumerate() {
                let (at, row) = (frf * n + line, &from[response]);
                let (force, motion) = &to[reference];
                let factor = self.factors[at];
                values[at] = factor * (self.between[at] - row[0] * force[0] - row[1] * force[1]);
                if let Some((law, columns)) = &mut columns {
                    let [a, b] = row.map(|r| -factor * r);
                    let by = [a * motion[0], a * motion[1], b * motion[0], b * motion[1]];
                    let slots = &mut slots[..columns.len()];
                    law.chain(by, factors, slots);
                    columns.iter_mut().zip(&*slots).for_each(|(column, value)| column[at] = *value);
                }
            }
        }
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

impl SideFrfs {
    fn of(
        recorded: &Recorded,
        fixture: &Fixture,
        end: [Station; 2],
        (outputs, inputs): (Vec<Station>, Vec<Station>),
        own: &OnSide,
    ) -> Option<Self> {
        let model = Model::new(fixture, recorded.highest).ok()?;
        let all = |channels: &[Station]| end.iter().chain(channels).copied().collect::<Vec<_>>();
        let wanted = own.wanted(recorded);
        let mut values = vec![Complex64::ZERO; wanted.len() * recorded.s.len()];
        let mut receptances = model.receptances_of(&all(&outputs), &all(&inputs), wanted);
        receptances.on_lines(&recorded.s, &mut values).ok()?;
        Some(SideFrfs { fixture: fixture.clone(), end, outputs, inputs, values })
    }
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
