//! Where amplitude-dependent laws may act.

use super::records::Record;
use crate::time::kernel::{Stepper, Steps};
use crate::time::oversampling::oversampled_for_lines;
use crate::time::structure::Structure;
use jointscope_fixture::{Dof, Fixture, Joint};
use jointscope_lumped::nominal_stiffness;

/// One joint's component that an amplitude-dependent law may act on.
#[derive(Debug, Clone)]
pub(crate) struct Seat {
    pub joint: String,
    pub dof: Dof,
    /// Stiffness of the joint on this component alone, N/m or N·m/rad.
    pub stiffness: f64,
    /// Largest relative motion that the linear fixture shows under the hits, m or rad.
    pub reach: f64,
}

/// The components of all joints, with what the hits move them by.
pub(crate) fn seats(fixture: &Fixture, records: &[&Record], highest_hz: f64) -> Vec<Seat> {
    let mut all: Vec<Seat> = Vec::new();
    for joint in fixture.joints() {
        let nominal = nominal_stiffness(&joint.law, fixture.joint_length(joint));
        for (index, dof) in [Dof::Translation, Dof::Rotation].into_iter().enumerate() {
            if nominal.at(index, index) > 0.0 && turns(fixture, joint, dof) {
                all.push(Seat {
                    joint: joint.name.clone(),
                    dof,
                    stiffness: nominal.at(index, index),
                    reach: 0.0,
                });
            }
        }
    }
    for record in records {
        for (seat, reach) in all.iter_mut().zip(reaches(fixture, record, highest_hz).unwrap_or_default()) {
            seat.reach = seat.reach.max(reach);
        }
    }
    all.retain(|seat| seat.reach > 0.0 && seat.reach.is_finite());
    all
}

fn turns(fixture: &Fixture, joint: &Joint, dof: Dof) -> bool {
    let body = |p: usize| &fixture.bodies()[fixture.points()[p].body].kind;
    let rigid = |p: usize| matches!(body(p), jointscope_fixture::BodyKind::Rigid(r) if !r.rotates);
    dof == Dof::Translation || !(rigid(joint.from) && rigid(joint.to))
}

/// Largest relative motion of every joint's components, in the order of [`seats`] without its omissions.
fn reaches(fixture: &Fixture, record: &Record, highest_hz: f64) -> Option<Vec<f64>> {
    const WITHIN: usize = 4;
    let structure = Structure::new(fixture, highest_hz).ok()?;
    let motions = fixture.joints().iter().filter_map(|joint| {
        let rows = structure.across(&joint.name)?;
        let nominal = nominal_stiffness(&joint.law, fixture.joint_length(joint));
        let dofs = [Dof::Translation, Dof::Rotation].into_iter().zip(rows).enumerate();
        let used = dofs.filter(|(i, (dof, _))| nominal.at(*i, *i) > 0.0 && turns(fixture, joint, *dof));
        Some(used.map(|(_, (_, (row, _)))| row).collect::<Vec<_>>())
    });
    let rows: Vec<Vec<f64>> = motions.flatten().collect();
    let system = structure.system_with(record.struck(), &[], &rows).ok()?;
    let steps = Steps { interval: record.hit.interval(), within: WITHIN, halvings: 0 };
    let run = Stepper::new(&system, steps)?
        .run(&oversampled_for_lines(record.hit.force(), WITHIN), record.hit.samples());
    Some(run.outputs.iter().map(|d| d.iter().fold(0.0, |most: f64, d| d.abs().max(most))).collect())
}
