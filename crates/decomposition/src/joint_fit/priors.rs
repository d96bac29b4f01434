//! What is known of a joint before any FRF: how its coordinates move in a fit.

use super::law::{Dynamics, LawKind};
use crate::settings::priors::{EXPONENT, EXPONENT_MARGIN, LN_TIME, LOSS, STIFFNESS};
use jointscope_inference::{Parameter, Transform};

/// How a joint's mass moves in a fit.
pub(super) fn mass_parameter() -> Parameter {
    Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 })
        .with_precision(1.0)
        .between(0.0, f64::INFINITY)
}

/// A law's own coordinates with what is known of them beforehand.
pub(super) fn own_parameters(law: &Dynamics) -> Vec<Parameter> {
    let own = |std: f64| {
        Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 }).with_precision(1.0 / (std * std))
    };
    let mut all = vec![own(STIFFNESS); law.stiffness.count()];
    all.extend(std::iter::repeat_n(own(LOSS), law.damping.count() + law.change.count()));
    all.extend(shape_parameter(law));
    all
}

/// The same with nothing known of the matrices beforehand: a time or an exponent that no loss shows would
/// else be anywhere.
pub(super) fn open_parameters(law: &Dynamics) -> Vec<Parameter> {
    let open = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
    let mut all = vec![open; law.count() - law.shapes()];
    all.extend(shape_parameter(law));
    all
}

fn shape_parameter(law: &Dynamics) -> Option<Parameter> {
    let own = |std: f64| {
        Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 }).with_precision(1.0 / (std * std))
    };
    match law.kind {
        LawKind::Fractional => Some(own(EXPONENT).between(EXPONENT_MARGIN - 0.5, 0.5 - EXPONENT_MARGIN)),
        LawKind::StandardLinearSolid => Some(own(LN_TIME)),
        _ => None,
    }
}
