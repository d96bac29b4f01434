//! FRFs of a fixture without several of its joints, and what these make of them.
//!
//! Each joint acts on its own d_j = u_to − R_j·u_from. With all d_j one below the other, G of the fixture without the joints and Z = diag(Z_j),
//!
//! H_oi = G_oi − G_od (I + Z G_dd)⁻¹ Z G_di, and δH_oi = −G_od (I + Z G_dd)⁻¹ δZ (I + G_dd Z)⁻¹ G_di:
//!
//! it does not matter whether the joints form a chain or loops. Joints on one body, or on bodies that others connect, meet in G_dd.

use super::super::law::{MOST, Placed};
use super::super::recorded::Recorded;
use crate::sides::with_effects_of;
use jointscope_fixture::{Fixture, Place};
use jointscope_linalg::LuWorkspace;
use jointscope_lumped::{Instrument, MeasuringChain, Model, Station};
use num_complex::Complex64;

/// The fixture without its joints on all lines, line after line.
#[derive(Debug)]
pub(super) struct Free {
    /// Coordinates of all d_j: two a joint.
    order: usize,
    /// Recorded accelerance per receptance, by FRF.
    factors: Vec<Complex64>,
    /// Between channels, by FRF.
    between: Vec<Complex64>,
    /// From loads on d to the responses, row-major.
    from: Vec<Complex64>,
    /// From the references to d, row-major.
    to: Vec<Complex64>,
    /// G_dd, row-major.
    at: Vec<Complex64>,
}

/// Stations of a joint's ends: y and θ of the near one, then of the far one.
const ENDS: usize = 4;

impl Free {
    /// `None` where the fixture without its joints has no finite receptances.
    pub fn of(recorded: &Recorded, fixture: &Fixture, joints: &[usize]) -> Option<Self> {
        let rest = with_effects_of(fixture, fixture.without_joints(joints));
        let chain = MeasuringChain::of(fixture, &recorded.pairs, Instrument::AsRecorded).ok()?;
        let model = Model::new(&rest, recorded.highest).ok()?;
        let joints: Vec<&jointscope_fixture::Joint> = joints.iter().map(|&j| &fixture.joints()[j]).collect();
        let ends = joints.iter().flat_map(|joint| [joint.from, joint.to]).flat_map(|point| {
            let point = &fixture.points()[point];
            Station::both(point.body, point.x.value)
        });
        let outputs = recorded.responses.iter().map(|&frf| chain.readings[frf].output);
        let inputs = recorded.references.iter().map(|&frf| chain.readings[frf].input);
        let responding: Vec<Station> = ends.clone().chain(outputs).collect();
        let loaded: Vec<Station> = ends.chain(inputs).collect();
        let own = ENDS * joints.len();
        let pieces = connected(&rest);
        let meet = |(o, i): &(usize, usize)| pieces[responding[*o].body] == pieces[loaded[*i].body];
        let all = (0..responding.len()).flat_map(|o| (0..loaded.len()).map(move |i| (o, i)));
        let wanted =
            |(o, i): &(usize, usize)| *o < own || *i < own || recorded.channels.contains(&(o - own, i - own));
        let pairs: Vec<(usize, usize)> = all.filter(wanted).filter(meet).collect();
        let n = recorded.s.len();
        let mut values = vec![Complex64::ZERO; pairs.len() * n];
        model.receptances_of(&responding, &loaded, pairs.clone()).on_lines(&recorded.s, &mut values).ok()?;
        let lengths: Vec<f64> = joints.iter().map(|joint| fixture.joint_length(joint)).collect();
        let factors = (0..recorded.pairs.len())
            .flat_map(|frf| recorded.s.iter().map(move |s| (frf, s.im)))
            .map(|(frf, omega)| chain.factor(frf, omega));
        let order = 2 * joints.len();
        let (responses, references) = (responding.len() - own, loaded.len() - own);
        let mut free = Free {
            order,
            factors: factors.collect(),
            between: vec![Complex64::ZERO; recorded.pairs.len() * n],
            from: vec![Complex64::ZERO; responses * order * n],
            to: vec![Complex64::ZERO; order * references * n],
            at: vec![Complex64::ZERO; order * order * n],
        };
        for (&(o, i), values) in pairs.iter().zip(values.chunks_exact(n)) {
            free.add((o, i), values, &lengths, recorded);
        }
        Some(free)
    }

    /// Adds the receptances between two stations to all entries that they are a part of.
    fn add(&mut self, (o, i): (usize, usize), values: &[Complex64], lengths: &[f64], recorded: &Recorded) {
        let own = ENDS * lengths.len();
        let (order, references) = (self.order, recorded.references.len());
        let on = |station: usize| if station < own { on_relative(station, lengths) } else { [(0, 0.0); 2] };
        let add = |to: &mut [Complex64], width: usize, place: usize, weight: f64| {
            if weight != 0.0 {
                let entries = to[place..].iter_mut().step_by(width);
                entries.zip(values).for_each(|(entry, value)| *entry += value * weight);
            }
        };
        match (o < own, i < own) {
            (true, true) => {
                for (a, left) in on(o) {
                    for (b, right) in on(i) {
                        add(&mut self.at, order * order, a * order + b, left * right);
                    }
                }
            }
            (false, true) => {
                for (b, weight) in on(i) {
                    add(&mut self.from, recorded.responses.len() * order, (o - own) * order + b, weight);
                }
            }
            (true, false) => {
                for (a, weight) in on(o) {
                    add(&mut self.to, order * references, a * references + i - own, weight);
                }
            }
            (false, false) => {
                let frfs = recorded.channels.iter().enumerate();
                for (frf, _) in frfs.filter(|(_, channel)| **channel == (o - own, i - own)) {
                    add(&mut self.between, recorded.pairs.len(), frf, 1.0);
                }
            }
        }
    }

    /// What is recorded with joints of these laws, FRF after FRF; its derivatives by the laws' coordinates, one law's after the other's, over `columns`, if wanted.
    ///
    /// `None` where a line has no finite response.
    pub fn coupled(
        &self,
        recorded: &Recorded,
        laws: &[Placed],
        mut columns: Option<&mut [Vec<Complex64>]>,
    ) -> Option<Vec<Complex64>> {
        let (n, order) = (recorded.s.len(), self.order);
        let (outputs, inputs) = (recorded.responses.len(), recorded.references.len());
        let zero = Complex64::ZERO;
        let mut values = vec![zero; recorded.pairs.len() * n];
        let (mut lu, mut slots) = (LuWorkspace::new(), [zero; MOST]);
        let mut inverse = vec![zero; order * order];
        let (mut rows, mut forces, mut motions) =
            (vec![zero; outputs * order], vec![zero; inputs * order], vec![zero; inputs * order]);
        let mut through = vec![zero; order];
        for (line, &s) in recorded.s.iter().enumerate() {
            let at = &self.at[line * order * order..(line + 1) * order * order];
            let from = &self.from[line * outputs * order..(line + 1) * outputs * order];
            let to = &self.to[line * order * inputs..(line + 1) * order * inputs];
            let stiffness: [_; 8] = std::array::from_fn(|j| laws.get(j).map(|law| law.stiffness(s)));
            let z = |j: usize, a: usize, b: usize| stiffness[j].map_or(zero, |z| z.at(a, b));
            lu.factorize(order, |matrix| {
                for row in 0..order {
                    let (j, a) = (row / 2, row % 2);
                    for column in 0..order {
                        let product: Complex64 =
                            (0..2).map(|b| z(j, a, b) * at[(2 * j + b) * order + column]).sum();
                        matrix[row * order + column] = product + f64::from(u8::from(row == column));
                    }
                }
            })
            .ok()?;
            inverse.fill(zero);
            (0..order).for_each(|d| inverse[d * order + d] = Complex64::ONE);
            lu.solve_columns_in_place(&mut inverse, order);
            for (row, from) in rows.chunks_exact_mut(order).zip(from.chunks_exact(order)) {
                for (column, entry) in row.iter_mut().enumerate() {
                    *entry = (0..order).map(|d| from[d] * inverse[d * order + column]).sum();
                }
            }
            for i in 0..inputs {
                let force = &mut forces[i * order..(i + 1) * order];
                for (row, entry) in force.iter_mut().enumerate() {
                    let (j, a) = (row / 2, row % 2);
                    *entry = (0..2).map(|b| z(j, a, b) * to[(2 * j + b) * inputs + i]).sum();
                }
                if columns.is_none() {
                    continue;
                }
                for (row, entry) in through.iter_mut().enumerate() {
                    *entry = (0..order).map(|d| inverse[row * order + d] * force[d]).sum();
                }
                for d in 0..order {
                    let lost: Complex64 = (0..order).map(|e| at[d * order + e] * through[e]).sum();
                    motions[i * order + d] = to[d * inputs + i] - lost;
                }
            }
            for (frf, &(response, reference)) in recorded.channels.iter().enumerate() {
                let place = frf * n + line;
                let row = &rows[response * order..(response + 1) * order];
                let force = &forces[reference * order..(reference + 1) * order];
                let factor = self.factors[place];
                let passed: Complex64 = row.iter().zip(force).map(|(r, f)| r * f).sum();
                values[place] = factor * (self.between[line * recorded.pairs.len() + frf] - passed);
                let Some(columns) = columns.as_deref_mut() else { continue };
                let motion = &motions[reference * order..(reference + 1) * order];
                let mut first = 0;
                for (j, law) in laws.iter().enumerate() {
                    let [a, b] = [-factor * row[2 * j], -factor * row[2 * j + 1]];
                    let [y, theta] = [motion[2 * j], motion[2 * j + 1]];
                    let slots = &mut slots[..law.count()];
                    law.chain([a * y, a * theta, b * y, b * theta], law.factors(s), slots);
                    for (column, value) in columns[first..].iter_mut().zip(&*slots) {
                        column[place] = *value;
                    }
                    first += law.count();
                }
            }
        }
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

/// Most joints that are found at once.
pub(super) const MOST_JOINTS: usize = 8;

/// What the motion of a joint's end is in d_j = u_to − R·u_from: two coordinates of all d with their weights.
fn on_relative(station: usize, lengths: &[f64]) -> [(usize, f64); 2] {
    let joint = station / ENDS;
    let (y, theta) = (2 * joint, 2 * joint + 1);
    match station % ENDS {
        0 => [(y, -1.0), (y, 0.0)],
        1 => [(y, -lengths[joint]), (theta, -1.0)],
        2 => [(y, 1.0), (y, 0.0)],
        _ => [(theta, 1.0), (theta, 0.0)],
    }
}

/// Which piece of the fixture each body is in: joints and springs from body to body hold pieces together.
pub(super) fn connected(fixture: &Fixture) -> Vec<usize> {
    let joints =
        fixture.joints().iter().map(|joint| [joint.from, joint.to].map(|p| fixture.points()[p].body));
    let place = |name: &str| fixture.bodies().iter().position(|body| body.name == name);
    let springs = fixture.physics().iter().filter_map(|effect| match &effect.place {
        Place::Between(one, other) => Some([place(one)?, place(other)?]),
        _ => None,
    });
    let mut pieces: Vec<usize> = (0..fixture.bodies().len()).collect();
    for [a, b] in joints.chain(springs) {
        let [a, b] = [pieces[a], pieces[b]];
        pieces.iter_mut().filter(|piece| **piece == b).for_each(|piece| *piece = a);
    }
    pieces
}
