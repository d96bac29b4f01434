//! Findings: one sentence each.

use crate::effects::{effect_name, meaning};
use crate::estimate::rounded_value;
use crate::format::{quantity_in, significant};
use crate::numbers::{listed, plain};
use crate::unit::Scale;
use crate::{Says, amplitude};
use jointscope_diagnosis::{Diagnosis, Elsewhere, Finding as FrfFinding};
use jointscope_findings::{Estimate, Finding};
use jointscope_fixture::{Dof, Effect, Motion};
use jointscope_nonlinear::{HitFinding, LevelFinding};

/// Names of alternatives that a sentence holds at the most.
const NAMES: usize = 3;

/// `; these FRFs cannot tell it from gain of response 3 (12 %)`, or nothing where no other name is likely.
fn look_alikes<E>(finding: &Finding<E>, data: &str) -> String {
    let named: Vec<String> = finding
        .look_alikes()
        .map(|(effect, p)| format!("{} ({:.0} %)", effect_name(effect), 100.0 * p))
        .collect();
    let more = named.len().saturating_sub(NAMES);
    let listed = listed(&named[..named.len() - more]);
    match (named.is_empty(), more) {
        (true, _) => String::new(),
        (false, 0) => format!("; these {data} cannot tell it from {listed}"),
        (false, _) => format!("; these {data} cannot tell it from {listed} and {more} more"),
    }
}

/// `at x = 72.0 mm (mass −7.14 g)`: a place and what the effect would be there.
pub fn place_and_sizes(place: &Elsewhere) -> String {
    let known = |estimate: &&Estimate| estimate.std.is_some();
    let (along, sizes): (Vec<&Estimate>, Vec<&Estimate>) =
        place.estimates.iter().filter(known).partition(|e| e.parameter.motion == Motion::AlongBody);
    let at: Vec<String> =
        along.iter().map(|e| format!("{} = {}", e.parameter.name, rounded_value(e))).collect();
    let sizes: Vec<String> = sizes
        .iter()
        .map(|e| format!("{} {}", e.parameter.name.replace('_', " "), rounded_value(e)))
        .collect();
    format!("at {} ({})", listed(&at), listed(&sizes))
}

/// `; it may also sit at x = 72.0 mm (mass −7.14 g), 27 % of its probability`, or nothing where every other
/// place is refuted.
fn other_places(finding: &FrfFinding) -> String {
    let places: Vec<String> = finding
        .evidence
        .likely_places()
        .take(NAMES)
        .map(|place| format!("{}, {:.0} % of its probability", place_and_sizes(place), 100.0 * place.share))
        .collect();
    if places.is_empty() { String::new() } else { format!("; it may also sit {}", listed(&places)) }
}

/// ` or its look-alike`, where other names are likely.
pub(crate) fn or_look_alike<E>(finding: &Finding<E>) -> &'static str {
    match finding.look_alikes().count() {
        0 => "",
        1 => " or its look-alike",
        _ => " or one of its look-alikes",
    }
}

/// `added mass on body B (49.8 g) or its look-alike`.
fn named_with_size(finding: &FrfFinding) -> String {
    let size = finding.estimate(main_parameter(&finding.effect));
    let named = with_size(&finding.effect, size.map(rounded_value));
    format!("{named}{}", or_look_alike(finding))
}

/// The parameter by which what an effect does grows from nothing.
fn main_parameter(effect: &Effect) -> &'static str {
    let spec = effect.kind.spec();
    spec.parameters[spec.size.parameter].name
}

/// `added mass on body B (49.8 g)`.
fn with_size(effect: &Effect, size: Option<String>) -> String {
    let size = size.map_or_else(String::new, |size| {
        let what = match main_parameter(effect) {
            main @ ("factor" | "loss_factor" | "ratio") => format!("{} ", main.replace('_', " ")),
            _ => String::new(),
        };
        format!(" ({what}{size})")
    });
    format!("{}{size}", effect_name(effect))
}

/// `added mass on body B (49.8 g)`, of an effect of which no more is known than where a fit ended.
pub fn with_fitted_size(effect: &Effect) -> String {
    let index = effect.kind.spec().size.parameter;
    with_size(effect, Some(plain(effect.value(index), effect.unit(index))))
}

/// The effects found, with their sizes.
pub(crate) fn found(diagnosis: &Diagnosis) -> String {
    listed(&diagnosis.findings.iter().map(named_with_size).collect::<Vec<_>>())
}

/// `it` or `them`, the effects found.
pub(crate) fn it(diagnosis: &Diagnosis) -> &'static str {
    if diagnosis.findings.len() == 1 { "it" } else { "them" }
}

/// What, where, how much with its 95 % interval, what that means, and what the data cannot tell from it.
impl Says for FrfFinding {
    fn says(&self) -> String {
        let doubt = if self.is_doubtful() { "Doubtful, for something not listed is likelier: " } else { "" };
        let meaning = meaning(&self.effect, &self.estimates, "FRFs");
        format!("{doubt}{meaning}{}{}.", other_places(self), look_alikes(self, "FRFs"))
    }
}

/// The same, with the range of motion that it was seen in.
impl Says for HitFinding {
    fn says(&self) -> String {
        let (motion, _) = amplitude::units(self.effect.dof.unwrap_or(Dof::Translation));
        format!(
            "{}; the hits move it by up to {} {motion}{}.",
            meaning(&self.effect, &self.estimates, "hits"),
            significant(self.evidence.reach, 4),
            look_alikes(self, "hits")
        )
    }
}

impl Says for LevelFinding {
    fn says(&self) -> String {
        let (motion, _) = amplitude::units(self.effect.dof.unwrap_or(Dof::Translation));
        let (least, most) = self.evidence.motions;
        let scale = Scale::for_values([least, most], motion);
        format!(
            "{}; seen at relative motions of {} to {}{}.",
            meaning(&self.effect, &self.estimates, "levels"),
            quantity_in(least, None, &scale),
            quantity_in(most, None, &scale),
            look_alikes(self, "levels")
        )
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::advice;
    use jointscope_diagnosis::FrfEvidence;
    use jointscope_fixture::{Effect, EffectKind, Place};

    fn finding(kind: EffectKind, place: Place, dof: Option<Dof>, values: &[f64], share: f64) -> FrfFinding {
        let effect = Effect::new(kind, place, dof, values);
        let estimates = kind
            .spec()
            .parameters
            .iter()
            .zip(values)
            .map(|(parameter, &value)| Estimate::of(*parameter, dof, value).within(share * value.abs()));
        FrfFinding {
            estimates: estimates.collect(),
            effect,
            probability: 0.9,
            alternatives: Vec::new(),
            evidence: FrfEvidence { gain: 100.0, elsewhere: Vec::new(), measured: None },
        }
    }

    #[track_caller]
    fn says(finding: &FrfFinding, parts: &[&str]) {
        let sentence = finding.says();
        assert!(sentence.ends_with('.') && !sentence.contains("NaN"), "{sentence}");
        parts
            .iter()
            .for_each(|part| assert!(sentence.contains(part), "`{part}` is missing from: {sentence}"));
    }

    #[test]
    fn another_place_on_the_body_is_said_with_its_size_and_share() {
        let at = |x: f64, mass: f64| {
            finding(EffectKind::AddedMass, Place::Body("beam".into()), None, &[x, mass], 0.02)
        };
        let elsewhere = |x: f64, mass: f64, share: f64| Elsewhere { estimates: at(x, mass).estimates, share };
        let mut found = at(0.306, -0.0224);
        assert!(!found.says().contains("also"));
        found.evidence.elsewhere = vec![elsewhere(0.072, -0.00714, 0.27), elsewhere(0.2, -0.001, 0.01)];
        says(&found, &["lacks", "; it may also sit at x = 72.0 mm (mass −7.14 g), 27 % of its probability."]);
        assert!(!found.says().contains("200"), "{}", found.says());
    }

    #[test]
    fn every_linear_kind_says_what_where_and_how_much() {
        let body = || Place::Body("B".into());
        let joint = || Place::Joint("J".into());
        type Case<'a> = (EffectKind, Place, Option<Dof>, &'a [f64], &'a [&'a str]);
        let cases: [Case; 27] = [
            (
                EffectKind::AddedMass,
                body(),
                None,
                &[0.11, 0.05],
                &["Body B", "50.0 g (95 %: 49.0 to 51.0 g)", "x = 110"],
            ),
            (
                EffectKind::AddedMass,
                body(),
                None,
                &[0.11, -0.05],
                &["lacks", "50.0 g (95 %: 49.0 to 51.0 g)"],
            ),
            (EffectKind::Support, body(), None, &[0.1, 12e3, 3.0], &["12.00 kN/m", "3.000 N·s/m", "ground"]),
            (
                EffectKind::AttachedResonator,
                body(),
                None,
                &[0.1, 0.02, 312.0, 0.01],
                &["20.00 g", "312.0 Hz"],
            ),
            (EffectKind::BodyFlexibility, body(), None, &[1500.0, 0.01], &["not rigid", "1500 Hz"]),
            (
                EffectKind::InterfaceCompliance,
                Place::Point("3".into()),
                Some(Dof::Translation),
                &[9e6, 0.0],
                &["point 3", "9.00 MN/m", "shear"],
            ),
            (
                EffectKind::InterfaceCompliance,
                Place::Point("3".into()),
                Some(Dof::Rotation),
                &[12e3, 0.0],
                &["12.00 kN·m/rad", "bending"],
            ),
            (
                EffectKind::InterfaceCompliance,
                Place::Point("3".into()),
                Some(Dof::Rotation),
                &[12e3, 0.0, 1.0],
                &["12.00 kN·m/rad", "spread along its foot", "(spread 1.000"],
            ),
            (EffectKind::ShearDeformation, joint(), None, &[1e7, 0.0], &["10.00 MN", "Euler–Bernoulli"]),
            (EffectKind::JointMass, joint(), None, &[0.077], &["77.0", "massless"]),
            (EffectKind::StiffnessChange, joint(), None, &[0.8], &["softer", "0.800"]),
            (EffectKind::LossFactor, joint(), None, &[0.02], &["0.0200"]),
            (EffectKind::Relaxation, joint(), None, &[0.3, 1e-3], &["viscoelastic", "159", "1.000 ms"]),
            (EffectKind::PointOffset, Place::Point("4".into()), None, &[-0.002], &["point 4", "−2.000 mm"]),
            (EffectKind::PointOffset, Place::Response("4".into()), None, &[0.002], &["sensor of response 4"]),
            (
                EffectKind::PointOffset,
                Place::Reference("4".into()),
                None,
                &[0.002],
                &["impacts of reference 4"],
            ),
            (EffectKind::JointLength, joint(), None, &[0.001], &["longer", "1.000 mm"]),
            (
                EffectKind::ChannelGain,
                Place::Response("3".into()),
                None,
                &[0.8],
                &["response 3", "low", "0.800"],
            ),
            (
                EffectKind::ChannelGain,
                Place::Reference("1".into()),
                None,
                &[-1.0],
                &["reference 1", "wrong sign"],
            ),
            (
                EffectKind::ChannelGain,
                Place::Force,
                None,
                &[1.03],
                &["force", "1.03", "sensors that stay on"],
            ),
            (EffectKind::ChannelGain, Place::Force, None, &[9.8062], &["force", "9.81", "as g is from m/s²"]),
            (EffectKind::ChannelDelay, Place::Response("4".into()), None, &[22e-6], &["lags", "22.00 µs"]),
            (
                EffectKind::SensorMass,
                Place::Responses,
                None,
                &[0.012],
                &["12.00 g", "from response to response"],
            ),
            (EffectKind::SensorMass, Place::Response("4".into()), None, &[0.012], &["12.00 g", "moved"]),
            (EffectKind::ExponentialWindow, Place::All, None, &[12.0], &["12.00 1/s", "damped"]),
            (
                EffectKind::ParallelStiffness,
                joint(),
                Some(Dof::Rotation),
                &[2e3, 0.0],
                &["Beside joint J", "2.000 kN·m/rad", "rotation"],
            ),
            (EffectKind::Footing, joint(), None, &[7e3, 0.0], &["Both ends of joint J", "7.00 kN·m/rad"]),
        ];
        for (kind, place, dof, values, parts) in cases {
            says(&finding(kind, place, dof, values, 0.0103), parts);
        }
    }

    #[test]
    fn a_wrong_sign_or_unit_asks_for_something_else_than_calibration() {
        let advised = |factor: f64| {
            advice(&Effect::new(EffectKind::ChannelGain, Place::Response("3".into()), None, &[factor]))
        };
        assert!(advised(0.9).contains("calibrate") && advised(10.0).contains("calibrate"));
        assert!(advised(-1.01).contains("direction"), "{}", advised(-1.01));
        assert!([9.81, 0.102].iter().all(|factor| advised(*factor).contains("unit")));
    }

    #[test]
    fn look_alikes_are_told_with_their_probabilities_and_unlikely_ones_are_not() {
        let mut found =
            finding(EffectKind::ShearDeformation, Place::Joint("J".into()), None, &[1e7, 0.0], 0.01);
        let compliance = |point: &str| {
            Effect::new(
                EffectKind::InterfaceCompliance,
                Place::Point(point.into()),
                Some(Dof::Translation),
                &[1e8, 0.0],
            )
        };
        found.alternatives = vec![(compliance("2"), 0.31), (compliance("3"), 0.01)];
        says(&found, &["cannot tell it from interface compliance at point 2 in translation (31 %)."]);
        assert!(!found.says().contains("point 3"));
    }

    #[test]
    fn a_finding_that_is_likelier_something_else_is_told_with_doubt() {
        let mut found = finding(EffectKind::JointMass, Place::Joint("J".into()), None, &[0.077], 0.01);
        assert!(!found.says().contains("Doubtful"));
        found.probability = 0.1;
        says(&found, &["Doubtful", "Joint J has a mass"]);
    }

    #[test]
    fn what_the_data_do_not_determine_is_said_and_not_printed_with_digits() {
        let mut found = finding(EffectKind::JointMass, Place::Joint("J".into()), None, &[0.077], 0.01);
        found.estimates[0].interval = None;
        says(&found, &["77.0 g (not determined"]);
        found.estimates[0].interval = Some([1e-9, 1e9]);
        says(&found, &["order of magnitude"]);
        found.estimates[0].interval = Some([f64::NAN, f64::NAN]);
        says(&found, &["77.0 g (order"]);
    }
}
