//! How the FRFs feel a complex stiffness across one component of a joint.

use super::level::SteppedLevel;
use crate::SteppedError;
use crate::settings::level_model::{BESIDE, STATIC, UNMOVED_JOINT};
use crate::time::structure::station;
use jointscope_fixture::{Fixture, Joint, Side};
use jointscope_lumped::{LumpedError, Model, Station};
use jointscope_spectra::Dof;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Accelerances on one line, a complex stiffness δ across the joint still to be added: H = G_oi − G_od δ
/// G_di/(1 + δ G_dd).
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
    pub(super) fn accelerance(&self, frf: usize, delta: Complex64) -> Complex64 {
        let (plain, from_joint) = self.frfs[frf];
        plain - from_joint * delta * self.across[frf] / (1.0 + delta * self.own)
    }

    /// δ that gives the accelerance `value`.
    pub(super) fn delta(&self, frf: usize, value: Complex64) -> Complex64 {
        let (plain, from_joint) = self.frfs[frf];
        let lacking = plain - value;
        lacking / (from_joint * self.across[frf] - lacking * self.own)
    }

    /// Relative motion d over the acceleration of the FRF's response.
    pub(super) fn motion_per_response(&self, frf: usize, delta: Complex64) -> f64 {
        (self.across[frf] / (1.0 + delta * self.own) / self.accelerance(frf, delta)).norm()
    }
}

/// A joint's component in the fixture, at all levels.
#[derive(Debug, Clone)]
pub(crate) struct Location {
    pub joint: String,
    pub dof: Dof,
    /// By level and line.
    pub lines: Vec<Vec<LineModel>>,
    /// Static relative displacement by a force of 1 across the joint, m/N or rad/(N·m).
    pub yields: f64,
}

/// One component of one joint in a fixture; `None` where the fixture lacks it or cannot be modelled.
pub(crate) fn location_of(
    fixture: &Fixture,
    (joint, dof): (&str, Dof),
    levels: &[&SteppedLevel],
) -> Option<Location> {
    let model = Model::new(fixture, highest_hz(levels)).ok()?;
    location(fixture, &model, fixture.joint(joint)?, dof, levels).ok()
}

/// Every component of every joint that the levels move.
pub(crate) fn locations(fixture: &Fixture, levels: &[&SteppedLevel]) -> Result<Vec<Location>, SteppedError> {
    let highest = highest_hz(levels);
    let model = Model::new(fixture, highest)?;
    let mut all = Vec::new();
    for joint in fixture.joints() {
        for dof in [Dof::Translation, Dof::Rotation] {
            let location = location(fixture, &model, joint, dof, levels)?;
            let moved = |line: &LineModel| {
                line.own.norm() > 0.0
                    && line.motion_per_response(0, Complex64::ZERO) * omega2(highest) > UNMOVED_JOINT
            };
            if location.yields.is_finite() && location.lines.iter().flatten().all(moved) {
                all.push(location);
            }
        }
    }
    Ok(all)
}

fn highest_hz(levels: &[&SteppedLevel]) -> f64 {
    levels.iter().flat_map(|l| l.frfs.lines().hz()).fold(0.0, |most: f64, hz| hz.max(most))
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

fn location(
    fixture: &Fixture,
    model: &Model,
    joint: &Joint,
    dof: Dof,
    levels: &[&SteppedLevel],
) -> Result<Location, SteppedError> {
    let weights = weights(dof, fixture.joint_length(joint));
    let ends: Vec<Station> = [joint.from, joint.to]
        .iter()
        .map(|&point| &fixture.points()[point])
        .flat_map(|point| Station::both(point.body, point.x.value))
        .collect();
    let mut location = Location { joint: joint.name.clone(), dof, lines: Vec::new(), yields: f64::NAN };
    for level in levels {
        let pairs = level.frfs.pairs();
        let (mut outputs, mut inputs) = (ends.clone(), ends.clone());
        for pair in pairs {
            outputs.push(station(fixture, &pair.response, Side::Response)?);
            inputs.push(station(fixture, &pair.reference, Side::Reference)?);
        }
        let columns = inputs.len();
        let mut receptances = model.receptances(&outputs, &inputs);
        let mut values = vec![Complex64::ZERO; receptances.count()];
        let mut read = |hz: f64| {
            // On an undamped resonance of the fixture only the sum with δ is finite: it is read as close by
            // as numbers allow.
            let finite = [hz, hz * (1.0 + BESIDE)]
                .iter()
                .any(|hz| receptances.at(Complex64::new(0.0, TAU * hz), &mut values));
            if !finite {
                return Err(LumpedError::Unbounded { frequency: hz });
            }
            let at = |output: usize, input: usize| values[output * columns + input];
            let from_joint = |output: usize| (0..4).map(|e| at(output, e) * weights[e]).sum::<Complex64>();
            let to_joint = |input: usize| (0..4).map(|e| at(e, input) * weights[e]).sum();
            let accelerances = |k: usize| (-omega2(hz) * at(k, k), -omega2(hz) * from_joint(k));
            let own = |e: usize| (0..4).map(move |f| at(e, f) * weights[e] * weights[f]);
            Ok(LineModel {
                frfs: (4..columns).map(accelerances).collect(),
                across: (4..columns).map(to_joint).collect(),
                own: (0..4).flat_map(own).sum(),
            })
        };
        let hz = level.frfs.lines().hz();
        location.lines.push(hz.iter().map(|hz| read(*hz)).collect::<Result<_, _>>()?);
        if !location.yields.is_finite() {
            location.yields = read(STATIC * hz[0])?.own.re;
        }
    }
    Ok(location)
}
