//! What a fit of several joints finds.

use super::super::{JointFit, JointLikelihood};
use crate::{JointEnds, SidesError};
use jointscope_frf::RigidMotionError;
use jointscope_linalg::RealMatrix2;
use serde::Serialize;

/// Several joints from all FRFs.
#[derive(Debug, Clone, PartialEq)]
pub struct JointsFit {
    /// One a joint, in the order that they were asked for or stand in the fixture.
    pub joints: Vec<FoundJoint>,
    /// Names of the numbers that [`covariance`](Self::covariance) is of: `J1/k11` and so on, one joint's
    /// after the other's.
    pub elements: Vec<String>,
    /// Posterior covariance of the numbers of all joints, SI, the fixture's quantities integrated out; with
    /// what the model's error and the laws compared add.
    pub covariance: Vec<Vec<f64>>,
    /// What of it comes from a model that does not explain the FRFs.
    pub model_covariance: Vec<Vec<f64>>,
    /// What the FRFs alone tell of all joints and of the fixture's quantities; nothing where that is
    /// undetermined.
    pub likelihood: Option<JointLikelihood>,
    /// Numbers of lines recorded and left, where they were merged.
    pub merged: Option<(usize, usize)>,
}

/// One of several joints.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundJoint {
    /// Its name in the fixture.
    pub name: String,
    /// Where its K and C act.
    pub ends: JointEnds,
    /// Whether its ends hold together without it, so that it has no two sides and eq (7) does not apply.
    pub is_in_a_loop: bool,
    /// The fixture's stiffness of it.
    pub nominal: RealMatrix2,
    /// What was found; quantities, FRFs and χ² are those of the fit as a whole. The p-value of reciprocity is
    /// of first order; no nearest admissible joint is sought.
    pub fit: JointFit,
}

/// Why several joints cannot be found at once.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeveralError {
    /// An effect of the measuring chain that cannot be taken out of FRFs.
    #[error(transparent)]
    Instrument(#[from] SidesError),
    /// The fixture has no joint at all.
    #[error("the fixture has no joint to find; state those that are looked for under `joints`")]
    NoJoint,
    /// There is no such joint.
    #[error("the fixture has no joint `{name}`; choose among {} with --joint", names.join(", "))]
    NoSuchJoint {
        /// The name asked for.
        name: String,
        /// The joints there are.
        names: Vec<String>,
    },
    /// More joints than are found at once.
    #[error("the fixture has {} joints ({}) and at most {most} are found at once: choose one with --joint", names.len(), names.join(", "))]
    TooMany {
        /// Most joints.
        most: usize,
        /// The joints there are.
        names: Vec<String>,
    },
    /// A joint between a body that rotates and one that does not.
    #[error(
        "joint `{joint}` connects a body that rotates and one that does not; it has no stiffness on d = u_to − R·u_from"
    )]
    Mixed {
        /// The joint.
        joint: String,
    },
    /// Two joints between the same two rigid bodies.
    #[error(
        "joints `{}` and `{}` connect the same two rigid bodies `{}` and `{}`: FRFs tell only the sum of both; choose the one that is looked for with --joint, the other is then taken as the fixture states it, within its tolerances",
        joints[0], joints[1], bodies[0], bodies[1]
    )]
    Parallel {
        /// Their names.
        joints: [String; 2],
        /// The bodies that both connect.
        bodies: [String; 2],
    },
    /// The FRFs' noise cannot be estimated.
    #[error(transparent)]
    Noise(#[from] RigidMotionError),
    /// No FRF can be used.
    #[error("no FRF has both of its channels in the fixture and a value in the band")]
    NothingRecorded,
    /// No start leads anywhere.
    #[error("no start of the fit gives finite FRFs")]
    NoStart,
    /// What was found leaves half of the FRFs.
    #[error(
        "no joints of the fixture come near the FRFs, from 0.4 to 2.5 times as stiff as they are stated; correct the fixture's bodies and points (jointscope check helps), or state joints that are about right"
    )]
    Astray,
    /// The FRFs do not determine all numbers.
    #[error(
        "the FRFs leave an element of k or c of joint {} undetermined: measure FRFs across it with two points on each of its bodies, or choose the joints to be found with --joint",
        joints.join(", ")
    )]
    Undetermined {
        /// Names of the joints that this is true of.
        joints: Vec<String>,
    },
}

/// The covariance of all joints, by the names of its rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointsCovariance<'a> {
    /// Names of rows and columns.
    pub elements: &'a [String],
    /// SI.
    pub matrix: &'a [Vec<f64>],
    /// What of it comes from a model that does not explain the FRFs.
    pub model: &'a [Vec<f64>],
}

impl JointsFit {
    /// Whether noise and tolerances explain the FRFs, and physics allows every joint found.
    pub fn is_sound(&self) -> bool {
        self.joints.iter().all(|joint| joint.fit.explains() && joint.fit.tests.failed().is_empty())
    }

    /// The covariance of all joints with the names of its rows.
    pub fn covariance_of_all(&self) -> JointsCovariance<'_> {
        JointsCovariance { elements: &self.elements, matrix: &self.covariance, model: &self.model_covariance }
    }
}
