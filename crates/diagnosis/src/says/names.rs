//! Effects by name: kind and place in a few words, with the size that matters.

use super::NOTABLE;
use crate::diagnosis::Finding;
use jointscope_fixture::{Dof, Effect, EffectKind, Place};

/// An effect's kind and place in a few words.
pub(super) fn name(effect: &Effect) -> String {
    let place = &effect.place;
    match effect.kind {
        EffectKind::AddedMass => format!("added mass on body {place}"),
        EffectKind::Support => format!("support of body {place}"),
        EffectKind::AttachedResonator => format!("resonator on body {place}"),
        EffectKind::BodyFlexibility => format!("bending of body {place}"),
        EffectKind::InterfaceCompliance => {
            format!(
                "interface compliance at point {place} in {}",
                effect.dof.map_or("translation", Dof::name)
            )
        }
        EffectKind::ShearDeformation => format!("shear deformation of {}", owner(place)),
        EffectKind::JointMass => format!("mass of joint {place}"),
        EffectKind::StiffnessChange => format!("stiffness change of {}", owner(place)),
        EffectKind::LossFactor => format!("structural damping of joint {place}"),
        EffectKind::Relaxation => format!("relaxation of joint {place}"),
        EffectKind::PointOffset => format!("offset of point {place}"),
        EffectKind::JointLength => format!("length of joint {place}"),
        EffectKind::ChannelGain => format!("gain of {place}"),
        EffectKind::ChannelDelay => format!("delay of {place}"),
        EffectKind::SensorMass => format!("sensor mass at {place}"),
        EffectKind::ExponentialWindow => "exponential window".to_owned(),
        EffectKind::CubicStiffness | EffectKind::Friction | EffectKind::Gap => {
            format!("{} in joint {place}", effect.kind.name().replace('_', " "))
        }
    }
}

/// A joint or a body with the word for it.
pub(super) fn owner(place: &Place) -> String {
    match place {
        Place::Body(name) => format!("body {name}"),
        _ => format!("joint {place}"),
    }
}

pub(super) fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), rest.as_str()))
}

/// `added mass on body B (49.8 g)`.
pub(super) fn named_with_size(finding: &Finding) -> String {
    let main = match finding.effect.kind {
        EffectKind::AddedMass
        | EffectKind::AttachedResonator
        | EffectKind::JointMass
        | EffectKind::SensorMass => "mass",
        EffectKind::Support | EffectKind::InterfaceCompliance => "stiffness",
        EffectKind::BodyFlexibility => "frequency",
        EffectKind::ShearDeformation => "shear_stiffness",
        EffectKind::StiffnessChange | EffectKind::ChannelGain => "factor",
        EffectKind::LossFactor => "loss_factor",
        EffectKind::Relaxation => "ratio",
        EffectKind::PointOffset | EffectKind::JointLength => "dx",
        EffectKind::ChannelDelay => "seconds",
        EffectKind::ExponentialWindow => "decay",
        EffectKind::CubicStiffness | EffectKind::Friction | EffectKind::Gap => "stiffness",
    };
    let size = finding.estimate(main).map_or_else(String::new, |estimate| {
        let what = match main {
            "factor" | "loss_factor" | "ratio" => format!("{} ", main.replace('_', " ")),
            _ => String::new(),
        };
        format!(" ({what}{})", estimate.rounded_value())
    });
    let rest = finding.alternatives.iter().filter(|(_, probability)| *probability >= NOTABLE).count();
    let or = match rest {
        0 => "",
        1 => " or its look-alike",
        _ => " or one of its look-alikes",
    };
    format!("{}{size}{or}", name(&finding.effect))
}
