//! Where a joint acts.

use jointscope_fixture::{Fixture, Joint};
use serde::Serialize;

/// Where a joint's K and C act: on d = u_to − R·u_from over `length`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEnds {
    /// L, m.
    pub length: f64,
    /// The near end.
    pub from: JointEnd,
    /// The far end.
    pub to: JointEnd,
}

/// One end of a joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEnd {
    /// The point's name.
    pub point: String,
    /// Its body's name.
    pub body: String,
    /// Its abscissa, m.
    pub x: f64,
}

impl JointEnds {
    pub(crate) fn of(fixture: &Fixture, joint: &Joint) -> Self {
        let end = |point: usize| {
            let point = &fixture.points()[point];
            let body = fixture.bodies()[point.body].name.clone();
            JointEnd { point: point.name.clone(), body, x: point.x.value }
        };
        JointEnds { length: fixture.joint_length(joint), from: end(joint.from), to: end(joint.to) }
    }
}
