//! What a finite-element model cannot have as an element, and why.

use super::entry::FindingEntry;
use crate::numbers::short;
use crate::parts::Omitted;
use jointscope_fixture::{Damping, Effect, EffectKind as Kind};

/// Findings that are no effects: quantities of the fixture that are wrong.
pub(super) fn findings_beside_effects(findings: &[FindingEntry], effects: &[Effect]) -> Vec<Omitted> {
    let mut omitted = Vec::new();
    for finding in findings {
        let stands_for =
            |effect: &Effect| finding.kind == effect.kind.name() && finding.place == effect.place.to_string();
        if effects.iter().any(stands_for) {
            continue;
        }
        let value = finding.parameters.get("value").and_then(|parameter| parameter.value);
        let value = value.map_or(String::new(), |value| format!(" = {}", short(value)));
        omitted.push(Omitted {
            what: format!("{} of {}{value}", finding.kind.replace('_', " "), finding.place),
            why: "it is a quantity of your own model: correct it there; where it is a joint's or a support's, what is written here has it".to_owned(),
        });
    }
    omitted
}

/// The damping of the assembly, which belongs to no part; `None` where there is none.
pub(super) fn damping(damping: &Damping) -> Option<Omitted> {
    let (what, why) = match damping {
        Damping::Undamped => return None,
        Damping::LossFactor(factor) if factor.value == 0.0 => return None,
        Damping::ModalRatios { ratios, .. } => {
            let ratios: Vec<String> = ratios.iter().map(|ratio| short(ratio.value)).collect();
            (
                format!("modal damping of the assembly without what was found, ratios {}", ratios.join(", ")),
                "it belongs to no element: state it in the analysis (modal damping)",
            )
        }
        Damping::Rayleigh { mass, stiffness } => (
            format!("C = {} 1/s·M + {} s·K of bodies and joints", short(mass.value), short(stiffness.value)),
            "it belongs to all elements: state it in the analysis (proportional damping)",
        ),
        Damping::LossFactor(factor) => (
            format!("loss factor {} of the bodies", short(factor.value)),
            "only the joints are exported, and they have it: give the bodies' material the same",
        ),
    };
    Some(Omitted { what, why: why.to_owned() })
}

/// Why an effect is no element.
pub(super) fn why_not(effect: &Effect) -> &'static str {
    match effect.kind {
        Kind::BodyFlexibility => {
            "a meshed body bends by itself: check its first free bending frequency against this one"
        }
        Kind::ShearDeformation => "it belongs to the body's own elements: let them deform in shear",
        Kind::StiffnessChange => {
            "it belongs to the body's own elements: multiply their Young's modulus by the factor"
        }
        Kind::PointOffset => "a sensor or an impact sits elsewhere: move the node that you compare with",
        Kind::SensorMass => "the mass is there only while that response is measured",
        Kind::ChannelGain
        | Kind::ChannelDelay
        | Kind::ChannelHighpass
        | Kind::ChannelResonance
        | Kind::ExponentialWindow => "it is of the measuring chain, not of the structure",
        Kind::CubicStiffness | Kind::Friction | Kind::Gap => {
            "it depends on amplitude and has no constant matrix: model it as a nonlinear spring, a slider or a gap"
        }
        _ => "it has no counterpart",
    }
}
