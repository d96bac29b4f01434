//! One component of one joint's relative motion in the fixture: what changes there, and how the FRFs feel it.

use super::level::{Held, SteppedLevel};
use jointscope_fixture::{Fixture, Joint};
use jointscope_lumped::{LumpedError, Model, Station};
use jointscope_spectra::{Channel, Dof, FrfPair};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Accelerances on one line, a complex stiffness δ across the joint still to be added: H = G_oi − G_od δ G_di/(1 + δ G_dd).
#[derive(Debug, Clone, Default)]
pub(crate) struct LineModel {
    /// G_oi and G_od of every FRF, as accelerances.
    pub frfs: Vec<(Complex64, Complex64)>,
    /// G_di of every FRF, as receptances.
    pub across: Vec<Complex64>,
    /// G_dd.
    pub own: Complex64,
}

impl LineModel {
    pub fn accelerance(&self, frf: usize, delta: Complex64) -> Complex64 {
        let (plain, from_joint) = self.frfs[frf];
        plain - from_joint * delta * self.across[frf] / (1.0 + delta * self.own)
    }

    /// δ that gives the accelerance `value`.
    pub fn delta(&self, frf: usize, value: Complex64) -> Complex64 {
        let (plain, from_joint) = self.frfs[frf];
        let lacking = plain - value;
        lacking / (from_joint * self.across[frf] - lacking * self.own)
    }

    /// Relative motion d over the acceleration of the FRF's response.
    pub fn motion_per_response(&self, frf: usize, delta: Complex64) -> f64 {
        (self.across[frf] / (1.0 + delta * self.own) / self.accelerance(frf, delta)).norm()
    }
}

/// A joint's component in the fixture, at all levels.
#[derive(Debug, Clone)]
pub(crate) struct Seat {
    pub joint: String,
    pub dof: Dof,
    /// By level and line.
    pub lines: Vec<Vec<LineModel>>,
    /// Static relative displacement by a force of 1 across the joint, m/N or rad/(N·m).
    pub yields: f64,
}

/// Frequency at which statics are read, as a share of the lowest line.
const STATIC: f64 = 1e-3;
/// Step off a line on which the fixture's receptances are not finite, relative.
const BESIDE: f64 = 1e-7;
/// d's share in the driving-point motion below which a mode does not move the joint, in m or rad per m.
const UNMOVED: f64 = 1e-9;

/// One component of one joint in a fixture; `None` where the fixture lacks it or cannot be modelled.
pub(crate) fn seat_of(fixture: &Fixture, (joint, dof): (&str, Dof), levels: &[SteppedLevel]) -> Option<Seat> {
    let highest = levels.iter().flat_map(|l| l.frfs.lines().hz()).fold(0.0, |most: f64, hz| hz.max(most));
    let model = Model::new(fixture, highest).ok()?;
    seat(fixture, &model, fixture.joint(joint)?, dof, levels).ok()
}

/// Every component of every joint that the levels move.
pub(crate) fn seats(fixture: &Fixture, levels: &[SteppedLevel]) -> Result<Vec<Seat>, LumpedError> {
    let highest = levels.iter().flat_map(|l| l.frfs.lines().hz()).fold(0.0, |most: f64, hz| hz.max(most));
    let model = Model::new(fixture, highest)?;
    let mut all = Vec::new();
    for joint in fixture.joints() {
        for dof in [Dof::Translation, Dof::Rotation] {
            let seat = seat(fixture, &model, joint, dof, levels)?;
            let moved = |line: &LineModel| {
                line.own.norm() > 0.0
                    && line.motion_per_response(0, Complex64::ZERO) * omega2(highest) > UNMOVED
            };
            if seat.yields.is_finite() && seat.lines.iter().flatten().all(moved) {
                all.push(seat);
            }
        }
    }
    Ok(all)
}

fn omega2(hz: f64) -> f64 {
    (TAU * hz).powi(2)
}

/// Weights of the four ends' motions (y and θ of the near end, of the far one) in d = u_to − R·u_from.
fn weights(dof: Dof, length: f64) -> [f64; 4] {
    match dof {
        Dof::Translation => [-1.0, -length, 1.0, 0.0],
        Dof::Rotation => [0.0, -1.0, 0.0, 1.0],
    }
}

fn station(fixture: &Fixture, pair: &FrfPair, channel: &Channel) -> Result<Station, LumpedError> {
    let known = || fixture.points().iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
    let point = fixture.point(&channel.point).ok_or_else(|| LumpedError::UnknownPoint {
        frf: pair.to_string(),
        point: channel.point.clone(),
        known: known(),
    })?;
    Ok(Station { body: point.body, x: point.x.value, dof: channel.dof })
}

fn seat(
    fixture: &Fixture,
    model: &Model,
    joint: &Joint,
    dof: Dof,
    levels: &[SteppedLevel],
) -> Result<Seat, LumpedError> {
    let weights = weights(dof, fixture.joint_length(joint));
    let ends: Vec<Station> = [joint.from, joint.to]
        .iter()
        .map(|&point| &fixture.points()[point])
        .flat_map(|point| Station::both(point.body, point.x.value))
        .collect();
    let mut seat = Seat { joint: joint.name.clone(), dof, lines: Vec::new(), yields: f64::NAN };
    for level in levels {
        let pairs = level.frfs.pairs();
        let (mut outputs, mut inputs) = (ends.clone(), ends.clone());
        for pair in pairs {
            outputs.push(station(fixture, pair, &pair.response)?);
            inputs.push(station(fixture, pair, &pair.reference)?);
        }
        let columns = inputs.len();
        let mut receptances = model.receptances(&outputs, &inputs);
        let mut values = vec![Complex64::ZERO; receptances.count()];
        let mut read = |hz: f64| {
            // On an undamped resonance of the fixture only the sum with δ is finite: it is read as close by as numbers allow.
            let finite = [hz, hz * (1.0 + BESIDE)]
                .iter()
                .any(|hz| receptances.at(Complex64::new(0.0, TAU * hz), &mut values));
            let at = |output: usize, input: usize| values[output * columns + input];
            let mut line = LineModel::default();
            for k in 0..pairs.len() {
                let from_joint: Complex64 = (0..4).map(|e| at(4 + k, e) * weights[e]).sum();
                let to_joint: Complex64 = (0..4).map(|e| at(e, 4 + k) * weights[e]).sum();
                line.frfs.push((-omega2(hz) * at(4 + k, 4 + k), -omega2(hz) * from_joint));
                line.across.push(to_joint);
            }
            line.own = (0..4)
                .flat_map(|e| (0..4).map(move |f| (e, f)))
                .map(|(e, f)| at(e, f) * weights[e] * weights[f])
                .sum();
            if finite { Ok(line) } else { Err(LumpedError::Unbounded { frequency: hz }) }
        };
        let hz = level.frfs.lines().hz();
        seat.lines.push(hz.iter().map(|hz| read(*hz)).collect::<Result<_, _>>()?);
        if !seat.yields.is_finite() {
            seat.yields = read(STATIC * hz[0])?.own.re;
        }
    }
    Ok(seat)
}

/// Turns of the loop from d to the joint's stiffness and back, at the most.
const TURNS: usize = 12;
/// Change of d, relative, at which it is found.
const FOUND: f64 = 1e-7;

impl Seat {
    /// Amplitude of d on a line of a level from the amplitude measured at the watched response, and the complex stiffness δ beyond the
    /// fixture's there; `delta` is δ by d, `near` where d is looked for.
    pub fn motion(
        &self,
        (index, line): (usize, usize),
        level: &SteppedLevel,
        near: f64,
        delta: &dyn Fn(f64) -> Complex64,
    ) -> (f64, Complex64) {
        let watched = level.watched();
        let response = match level.held {
            Held::Response(amplitude) => amplitude,
            Held::Force(amplitude) => amplitude * level.frfs.values(watched)[line].norm(),
        };
        let (mut motion, mut found) = (near, delta(near));
        // ln of the motion before and of what δ there made of it: from the second turn on the secant through the last two.
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..TURNS {
            let made = response * self.lines[index][line].motion_per_response(watched, found);
            if motion <= 0.0 {
                (motion, found) = (made, delta(made));
                continue;
            }
            let off = (made / motion).ln();
            let step = match last {
                Some((before, off_before)) if off != off_before && off.is_finite() => {
                    off * (before - motion.ln()) / (off - off_before)
                }
                _ => off,
            };
            last = Some((motion.ln(), off));
            motion *= step.clamp(-1.0, 1.0).exp();
            found = delta(motion);
            if step.abs() <= FOUND {
                break;
            }
        }
        (motion, found)
    }
}
