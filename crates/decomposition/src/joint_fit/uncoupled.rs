//! FRFs of the fixture without the joints that are looked for.
//!
//! Each joint acts on its own d_j = u_to − R_j·u_from. With all d_j one below the other, G of the fixture
//! without the joints and Z = diag(Z_j),
//!
//! H_oi = G_oi − G_od (I + Z G_dd)⁻¹ Z G_di, and δH_oi = −G_od (I + Z G_dd)⁻¹ δZ (I + G_dd Z)⁻¹ G_di:
//!
//! whatever the joints, G stays; it does not matter whether they form a chain or loops. Without them the
//! fixture falls into pieces, of which a quantity moves but the one that it belongs to.

use super::recorded::Recorded;
use super::setup::Setup;
use crate::sides::with_effects_of;
use jointscope_beam::{Matrix4, mass_of_ends};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, MeasuringChain, Model, Station};
use num_complex::Complex64;
use std::array::from_fn;
use std::sync::Arc;

/// Most joints that are found at once.
pub(super) const MOST_JOINTS: usize = 8;
/// Stations of a joint's ends: y and θ of the near one, then of the far one.
const ENDS: usize = 4;

/// The fixture without its joints: each entry on all lines, entry after entry.
#[derive(Debug)]
pub(super) struct Uncoupled {
    pieces: Vec<Arc<Piece>>,
    chain: MeasuringChain,
    /// Recorded accelerance per receptance, by FRF.
    pub(super) factors: Arc<Vec<Complex64>>,
    /// Coordinates of all d_j, two a joint; with those of the first joint's mass.
    pub(super) order: usize,
    pub(super) width: usize,
    /// Between channels, by FRF.
    pub(super) between: Vec<Complex64>,
    /// From loads on d to the responses, row-major.
    pub(super) from: Vec<Complex64>,
    /// From the references to d, row-major.
    pub(super) to: Vec<Complex64>,
    /// G_dd, row-major.
    pub(super) at: Vec<Complex64>,
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
    /// A fixture without its joints but with the mass (kg, uniform) of the first of them. Pieces that
    /// `before` has already are taken from there.
    ///
    /// `None` where a piece has no finite receptances.
    pub(super) fn of(
        setup: &Setup,
        fixture: &Fixture,
        mass: f64,
        before: Option<&Uncoupled>,
    ) -> Option<Self> {
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
        let factors = match before.filter(|before| has_the_same_factors(&before.chain, &chain)) {
            Some(before) => Arc::clone(&before.factors),
            None => Arc::new(factors(&chain, recorded)),
        };
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

    /// Adds the receptances between two stations to all entries that they are a part of; `on` says of each
    /// end what it is in which coordinates.
    fn add(
        &mut self,
        (o, i): (usize, usize),
        values: &[Complex64],
        on: &[Vec<(usize, f64)>],
        recorded: &Recorded,
    ) {
        let own = on.len();
        let (width, references) = (self.width, recorded.references.len());
        let add = |to: &mut [Complex64], place: usize, weight: f64| {
            let entry = to[place * values.len()..].iter_mut();
            entry.zip(values).for_each(|(entry, value)| *entry += value * weight);
        };
        match (on.get(o), on.get(i)) {
            (Some(responding), Some(loaded)) => {
                for (a, left) in responding {
                    loaded.iter().for_each(|(b, right)| add(&mut self.at, a * width + b, left * right));
                }
            }
            (None, Some(loaded)) => {
                loaded.iter().for_each(|(b, weight)| add(&mut self.from, (o - own) * width + b, *weight));
            }
            (Some(responding), None) => {
                responding
                    .iter()
                    .for_each(|(a, weight)| add(&mut self.to, a * references + i - own, *weight));
            }
            (None, None) => {
                let frfs = recorded.channels.iter().enumerate();
                frfs.filter(|(_, channel)| **channel == (o - own, i - own))
                    .for_each(|(frf, _)| add(&mut self.between, frf, 1.0));
            }
        }
    }

    /// Puts the joint's mass in: each of its coordinates, those from `order` on, is loaded by s², a change of
    /// rank one.
    fn put_in_the_mass(&mut self, recorded: &Recorded) {
        let (width, n) = (self.width, recorded.s.len());
        let (outputs, inputs) = (recorded.responses.len(), recorded.references.len());
        let entry = |of: &[Complex64], place: usize| of[place * n..(place + 1) * n].to_vec();
        for own in (self.order..width).rev() {
            let at: Vec<_> = (0..=own).map(|b| entry(&self.at, own * width + b)).collect();
            let to: Vec<_> = (0..inputs).map(|i| entry(&self.to, own * inputs + i)).collect();
            let load = |(s, at): (&Complex64, &Complex64)| (s * s) / (s * s * at + 1.0);
            let share: Vec<Complex64> = recorded.s.iter().zip(&at[own]).map(load).collect();
            let loaded = |left: Vec<Complex64>| -> Vec<Complex64> {
                left.iter().zip(&share).map(|(left, share)| share * left).collect()
            };
            let subtract = |of: &mut [Complex64], place: usize, left: &[Complex64], right: &[Complex64]| {
                let products = left.iter().zip(right).map(|(left, right)| left * right);
                of[place * n..].iter_mut().zip(products).for_each(|(value, product)| *value -= product);
            };
            let from: Vec<_> = (0..outputs).map(|o| loaded(entry(&self.from, o * width + own))).collect();
            for (frf, &(o, i)) in recorded.channels.iter().enumerate() {
                subtract(&mut self.between, frf, &from[o], &to[i]);
            }
            for (o, from) in from.iter().enumerate() {
                (0..own).for_each(|b| subtract(&mut self.from, o * width + b, from, &at[b]));
            }
            for a in 0..own {
                let column = loaded(entry(&self.at, a * width + own));
                (0..inputs).for_each(|i| subtract(&mut self.to, a * inputs + i, &column, &to[i]));
                (0..own).for_each(|b| subtract(&mut self.at, a * width + b, &column, &at[b]));
            }
        }
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

/// Recorded accelerance per receptance, FRF after FRF.
fn factors(chain: &MeasuringChain, recorded: &Recorded) -> Vec<Complex64> {
    let values = (0..recorded.pairs.len()).flat_map(|frf| recorded.s.iter().map(move |s| (frf, s.im)));
    values.map(|(frf, omega)| chain.factor(frf, omega)).collect()
}

fn has_the_same_factors(one: &MeasuringChain, other: &MeasuringChain) -> bool {
    let mut readings = one.readings.iter().zip(&other.readings);
    one.decay() == other.decay() && readings.all(|(a, b)| a.has_signals_of(b))
}

/// What the motion of a joint's end is a part of, and with what weight: d_j = u_to − R·u_from, and for the
/// first joint the coordinates of its mass, which are those of all d followed by lᵀu of `masses`.
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
    from_fn(|k| {
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
