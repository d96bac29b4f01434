//! Where amplitude-dependent laws may act.

use super::records::Record;
use crate::settings::suggestions::STEPS_OF_REACH;
use crate::spectra::oversampled_for_lines;
use crate::time::kernel::{Stepper, Steps};
use crate::time::structure::Structure;
use jointscope_fixture::{Dof, Effect, Fixture, Place};
use jointscope_lumped::nominal_stiffness;

/// One joint's component that an amplitude-dependent law may act on.
#[derive(Debug, Clone)]
pub(crate) struct JointLocation {
    pub joint: String,
    pub dof: Dof,
    /// Stiffness of the joint on this component alone, N/m or N·m/rad.
    pub stiffness: f64,
    /// Largest relative motion that the fixture shows under the hits, m or rad.
    pub reach: f64,
}

impl JointLocation {
    /// Whether an effect acts here.
    pub(super) fn is_of(&self, effect: &Effect) -> bool {
        effect.dof == Some(self.dof) && matches!(&effect.place, Place::Joint(joint) if *joint == self.joint)
    }
}

/// The components of all joints that the hits move, with how far.
pub(crate) fn locations(fixture: &Fixture, records: &[&Record], highest_hz: f64) -> Vec<JointLocation> {
    let Ok(structure) = Structure::new(fixture, highest_hz) else { return Vec::new() };
    let rotates = |point: usize| fixture.bodies()[fixture.points()[point].body].kind.rotates();
    let (mut all, mut rows) = (Vec::new(), Vec::new());
    for joint in fixture.joints() {
        let nominal = nominal_stiffness(&joint.law, fixture.joint_length(joint));
        for (index, dof) in [Dof::Translation, Dof::Rotation].into_iter().enumerate() {
            let stiffness = nominal.at(index, index);
            let moves = dof == Dof::Translation || rotates(joint.from) || rotates(joint.to);
            if stiffness > 0.0
                && moves
                && let Some((row, _)) = structure.across(&joint.name, dof)
            {
                rows.push(row);
                all.push(JointLocation { joint: joint.name.clone(), dof, stiffness, reach: 0.0 });
            }
        }
    }
    for record in records {
        let motions = motions(&structure, record, &rows).unwrap_or_default();
        for (location, motion) in all.iter_mut().zip(motions) {
            location.reach = motion.iter().fold(location.reach, |most, d| d.abs().max(most));
        }
    }
    all.retain(|location| location.reach > 0.0 && location.reach.is_finite());
    all
}

/// What `rows` read under the force of a hit.
fn motions(structure: &Structure, record: &Record, rows: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let system = structure.system(structure.load(record.struck()).ok()?, &[], rows).ok()?;
    let steps = Steps { interval: record.hit.interval(), within: STEPS_OF_REACH, halvings: 0 };
    let force = oversampled_for_lines(record.hit.force(), STEPS_OF_REACH);
    Some(Stepper::new(&system, steps)?.run(&force, record.hit.samples()))
}
