//! A fixture with a joint of which nothing is known beforehand.

use super::wanted::Wanted;
use crate::PlanError;
use jointscope_fixture::{Fixture, Joint, JointLaw};
use jointscope_lumped::nominal_stiffness;
use serde_json::{Value, json};

/// The fixture with the elements of a joint free, those that are zero apart.
pub(super) fn with_free_joint(fixture: &Fixture, wanted: &Wanted) -> Result<Fixture, PlanError> {
    let known = || fixture.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>().join(", ");
    let joint = fixture
        .joint(&wanted.joint)
        .ok_or_else(|| PlanError::UnknownJoint { joint: wanted.joint.clone(), known: known() })?;
    let stiffness = nominal_stiffness(&joint.law, fixture.joint_length(joint));
    let free = |value: f64| match value {
        0.0 => json!({ "value": 0.0, "std": 0.0 }),
        value => json!({ "value": value, "std": "unknown" }),
    };
    let matrix = |at: &dyn Fn(usize, usize) -> f64| {
        json!([[free(at(0, 0)), free(at(0, 1))], [free(at(0, 1)), free(at(1, 1))]])
    };
    let stiffness_entry = matrix(&|i, j| stiffness.at(i, j));
    let dashpots = dashpots(joint);
    let (which, row, column) = wanted.element;
    let element = match (which, dashpots) {
        ('k', _) => stiffness.at(row - 1, column - 1),
        (_, Some(damping)) => damping[row + column - 2],
        (_, None) => return Err(PlanError::NoDashpot(wanted.joint.clone())),
    };
    if element == 0.0 {
        return Err(PlanError::NoElement(wanted.says()));
    }
    let mut value = fixture.to_value();
    let entry: &mut Value = &mut value["joints"][&wanted.joint];
    let ends = [entry["from"].clone(), entry["to"].clone()];
    let [from, to] = ends;
    *entry = json!({ "from": from, "to": to, "stiffness": stiffness_entry });
    if let Some(damping) = dashpots {
        entry["damping"] = matrix(&|i, j| damping[i + j]);
    }
    Fixture::from_value(&value).map_err(|error| PlanError::Prediction(error.into()))
}

fn dashpots(joint: &Joint) -> Option<[f64; 3]> {
    match &joint.law {
        JointLaw::Stiffness { damping: Some(damping), .. } => Some(damping.map(|quantity| quantity.value)),
        _ => None,
    }
}
