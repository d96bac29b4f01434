//! What is known of a joint before any FRF: how its coordinates move in a fit.

use super::law::{Dynamics, LawKind};
use jointscope_inference::{Parameter, Transform};

/// Standard deviation beforehand of an element of K, in units of the diagonal of a joint nearby.
const STIFFNESS: f64 = 2.0;
/// Of a loss factor in the middle of the band, and of the change of stiffness up to there as a share.
const LOSS: f64 = 0.1;
/// Of ln(ωτ) in the middle of the band.
const TIME: f64 = 1.5;
/// Of the exponent about ½: that of a uniform distribution.
const EXPONENT: f64 = 0.29;
/// The exponent stays this far from 0 and 1, where a springpot is a spring or a dashpot.
const FROM_LIMITS: f64 = 0.02;

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

/// The same with nothing known of the matrices beforehand: a time or an exponent that no loss shows would else be anywhere.
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
        LawKind::Fractional => Some(own(EXPONENT).between(FROM_LIMITS - 0.5, 0.5 - FROM_LIMITS)),
        LawKind::StandardLinearSolid => Some(own(TIME)),
        _ => None,
    }
}
