//! What a finding means: a sentence for every kind.

use super::names::{capitalised, owner};
use super::numbers::plain;
use crate::diagnosis::Finding;
use jointscope_fixture::{Dof, EffectKind};

/// The sentence without its look-alikes and full stop.
pub(super) fn meaning(finding: &Finding) -> String {
    let place = &finding.effect.place;
    let first = finding.effect.parameters.first().map_or(0.0, |p| p.value);
    let value = |name: &str| finding.estimate(name).map_or(0.0, |e| e.value);
    let size = |name: &str| finding.size(name);
    let at_x = finding.at_x();
    match finding.effect.kind {
        EffectKind::AddedMass if value("mass") < 0.0 => format!(
            "Body {place}{at_x} lacks mass that the fixture counts, {}: something was taken off, or drilled out",
            finding.size_unsigned("mass")
        ),
        EffectKind::AddedMass => format!(
            "Body {place} carries a mass that the fixture leaves out, {}{at_x}, such as a sensor, a bracket or a bolt",
            size("mass")
        ),
        EffectKind::Support => support(finding, &at_x),
        EffectKind::AttachedResonator => format!(
            "Something of {} hangs elastically on body {place}{at_x} and resonates at {}, with a damping ratio of {}: a loose part, a cable or \
             an absorber",
            size("mass"),
            size("frequency"),
            size("damping_ratio")
        ),
        EffectKind::BodyFlexibility => format!(
            "Body {place} is not rigid: its first free-free bending mode lies at {} and is felt in this band",
            size("frequency")
        ),
        EffectKind::InterfaceCompliance if finding.effect.dof == Some(Dof::Rotation) => format!(
            "The joint's end at point {place} is not clamped but turns on a rotational spring of {}{}: the weld, glue or bolts there give way in \
             bending",
            size("stiffness"),
            dashpot(finding)
        ),
        EffectKind::InterfaceCompliance => format!(
            "The joint's end at point {place} slides on a spring of {} in series{}: the weld, glue or bolts there give way in shear",
            size("stiffness"),
            dashpot(finding)
        ),
        EffectKind::ShearDeformation => {
            let inertia = if finding.certainly("rotary_inertia") {
                format!(" and a rotary inertia of {}", size("rotary_inertia"))
            } else {
                String::new()
            };
            let owner = capitalised(&owner(place));
            format!(
                "{owner} also deforms in shear, with a shear stiffness κGA of {}{inertia}: it is too stocky for an Euler–Bernoulli beam",
                size("shear_stiffness")
            )
        }
        EffectKind::JointMass => {
            format!(
                "Joint {place} has a mass of its own, {}, where the fixture takes it as massless",
                size("mass")
            )
        }
        EffectKind::StiffnessChange => format!(
            "{} is {} than stated and its tolerance allows, by a factor of {}",
            capitalised(&owner(place)),
            if first < 1.0 { "softer" } else { "stiffer" },
            size("factor")
        ),
        EffectKind::LossFactor => format!(
            "Joint {place} dissipates more than stated, in the same measure at every rate: a structural loss factor of {}",
            size("loss_factor")
        ),
        EffectKind::Relaxation => format!(
            "Joint {place} is viscoelastic: it stiffens with frequency by a ratio of {}, about {} (relaxation time {}), as adhesives do",
            size("ratio"),
            plain(1.0 / (std::f64::consts::TAU * value("time").max(f64::MIN_POSITIVE)), "Hz"),
            size("time")
        ),
        EffectKind::PointOffset => format!(
            "The sensor or impact at point {place} is not where the fixture says, but off by dx = {} along x",
            size("dx")
        ),
        EffectKind::JointLength => format!(
            "The free length of joint {place} is {} than its points say, dx = {}",
            if first < 0.0 { "shorter" } else { "longer" },
            size("dx")
        ),
        EffectKind::ChannelGain if (first + 1.0).abs() < 0.2 => {
            format!(
                "The channel of {place} has the wrong sign, a gain of {}: it is wired, or its sensor mounted, the other way round",
                size("factor")
            )
        }
        EffectKind::ChannelGain => format!(
            "The channel of {place} reads {}, by a factor of {}: its calibration is off",
            if first.abs() < 1.0 { "low" } else { "high" },
            size("factor")
        ),
        EffectKind::ChannelDelay => format!(
            "The channel of {place} {} the others by {}: a filter, a converter or a wireless link delays one of them",
            if first < 0.0 { "runs ahead of" } else { "lags behind" },
            finding.size_unsigned("seconds")
        ),
        EffectKind::SensorMass if first < 0.0 => {
            format!(
                "The FRFs of {place} lack mass that is there in the others, {}",
                finding.size_unsigned("mass")
            )
        }
        EffectKind::SensorMass => format!(
            "The accelerometer of {place} loads the structure with {} while it sits there: it was moved from point to point",
            size("mass")
        ),
        EffectKind::ExponentialWindow => format!(
            "The responses carry an exponential window that was not corrected for, of decay {}: all FRFs look more damped than they are",
            size("decay")
        ),
        EffectKind::CubicStiffness | EffectKind::Friction | EffectKind::Gap => {
            format!(
                "Joint {place} does not behave linearly: {}",
                finding.effect.kind.name().replace('_', " ")
            )
        }
    }
}

pub(super) fn support(finding: &Finding, at_x: &str) -> String {
    let place = &finding.effect.place;
    let (spring, dashpot) = (finding.certainly("stiffness"), finding.certainly("damping"));
    let by = match (spring, dashpot) {
        (false, true) => format!("a dashpot of {}", finding.size("damping")),
        (_, true) => {
            format!("a spring of {} and a dashpot of {}", finding.size("stiffness"), finding.size("damping"))
        }
        _ => format!("a spring of {}", finding.size("stiffness")),
    };
    format!(
        "Body {place} is held to ground{at_x} by {by}: a suspension, a cable or something that touches it"
    )
}

pub(super) fn dashpot(finding: &Finding) -> String {
    if finding.certainly("damping") {
        format!(" with a dashpot of {}", finding.size("damping"))
    } else {
        String::new()
    }
}
