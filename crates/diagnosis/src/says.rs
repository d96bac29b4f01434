//! What a diagnosis comes to in words: one plain sentence a finding, one for the verdict.

mod meaning;
mod names;
mod numbers;
mod places;
mod quantities;
mod swapped;
mod verdict;

use crate::diagnosis::Finding;
use crate::estimates::Estimate;
use jointscope_fixture::ParameterRange;
use meaning::meaning;
use names::name;
use numbers::{decimals, listed, plain, prefixed, rounded};

/// Probability from which another name for a finding is told in its sentence.
const NOTABLE: f64 = 0.05;
/// Names of alternatives that a sentence holds at the most.
const NAMES: usize = 3;
/// Ratio of the interval's ends beyond which only the order of magnitude is known.
const VAGUE: f64 = 30.0;
/// Standard deviation of an abscissa, m, beyond which it is not told.
const UNPLACED: f64 = 0.1;

impl Finding {
    /// What was found, in a few words: `added mass on body B`.
    pub fn name(&self) -> String {
        name(&self.effect)
    }

    /// The other names for it in the same words, with their probabilities.
    pub fn other_names(&self) -> Vec<(String, f64)> {
        self.alternatives.iter().map(|(effect, probability)| (name(effect), *probability)).collect()
    }

    /// One plain sentence: what, where, how much with its 95 % interval, what that means, and what the data cannot tell from it.
    pub fn says(&self) -> String {
        let doubt = if self.is_doubtful() { "Doubtful, for something not listed is likelier: " } else { "" };
        let mut sentence = format!("{doubt}{}", meaning(self));
        let others = self.other_names();
        let notable = others.iter().filter(|(_, probability)| *probability >= NOTABLE);
        let named: Vec<String> = notable.map(|(name, p)| format!("{name} ({:.0} %)", 100.0 * p)).collect();
        if !named.is_empty() {
            let more = named.len().saturating_sub(NAMES);
            let listed = listed(&named[..named.len() - more]);
            sentence.push_str(&format!("; these FRFs cannot tell it from {listed}"));
            if more > 0 {
                sentence.push_str(&format!(" and {more} more"));
            }
        }
        sentence.push('.');
        sentence
    }

    /// Whether neither it nor any of its look-alikes is likelier than something that is not listed.
    pub fn is_doubtful(&self) -> bool {
        self.probability + self.alternatives.iter().map(|(_, probability)| probability).sum::<f64>() < 0.5
    }

    fn estimate(&self, parameter: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter.name == parameter)
    }

    /// Size of a parameter with its interval, or nothing where the finding does not have it.
    fn size(&self, parameter: &str) -> String {
        self.estimate(parameter).map_or_else(String::new, Estimate::says)
    }

    /// The same of a negative parameter whose sign the sentence tells in words.
    fn size_unsigned(&self, parameter: &str) -> String {
        let unsigned = |estimate: &Estimate| Estimate {
            value: -estimate.value,
            interval: estimate.interval.map(|[low, high]| [-high, -low]),
            ..*estimate
        };
        self.estimate(parameter).map_or_else(String::new, |estimate| {
            if estimate.value < 0.0 { unsigned(estimate).says() } else { estimate.says() }
        })
    }

    /// Whether a parameter that may be zero is beyond doubt not.
    fn certainly(&self, parameter: &str) -> bool {
        self.estimate(parameter).and_then(|e| e.interval).is_some_and(|[low, _]| low > 0.0)
    }

    /// ` at x = 110.2 mm (95 %: …)`, where the abscissa means anything.
    fn at_x(&self) -> String {
        match self.estimate("x") {
            Some(x) if x.std.is_some_and(|std| std > UNPLACED) => {
                " at an abscissa that is not determined".to_owned()
            }
            Some(x) if x.interval.is_some() => format!(" at x = {}", x.says()),
            _ => String::new(),
        }
    }
}

impl Estimate {
    /// Value and 95 % interval with unit, rounded to what is known: `49.8 g (95 %: 49.1 to 50.5 g)`.
    pub fn says(&self) -> String {
        let not_negative =
            matches!(self.parameter.range, ParameterRange::NonNegative | ParameterRange::Positive);
        let low_end = if not_negative { 0.0 } else { f64::NEG_INFINITY };
        let Some([low, high]) = self.interval.map(|[low, high]| [low.max(low_end), high]) else {
            return format!("{} (not determined by these FRFs)", plain(self.value, self.unit));
        };
        if !(low.is_finite() && high.is_finite()) || low > 0.0 && high / low > VAGUE {
            return format!("{} (order of magnitude only)", plain(self.value, self.unit));
        }
        let (factor, unit) = prefixed(self.value, self.unit);
        let decimals = decimals((high - low) * 0.5 * factor);
        let number = |value: f64| rounded(value * factor, decimals);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        format!("{}{unit} (95 %: {} to {}{unit})", number(self.value), number(low), number(high))
    }

    /// The value alone, with as many digits as its deviation leaves.
    fn rounded_value(&self) -> String {
        match self.std.filter(|std| *std > 0.0 && *std < self.value.abs()) {
            Some(std) => {
                let (factor, unit) = prefixed(self.value, self.unit);
                let number = rounded(self.value * factor, decimals(1.96 * std * factor));
                if unit.is_empty() { number } else { format!("{number} {unit}") }
            }
            None => plain(self.value, self.unit),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_fixture::{Dof, Effect, EffectKind, Place};

    fn finding(kind: EffectKind, place: Place, dof: Option<Dof>, values: &[f64], share: f64) -> Finding {
        let effect = Effect::new(kind, place, dof, values);
        let estimates = kind.spec().parameters.iter().zip(values).map(|(parameter, &value)| Estimate {
            parameter: *parameter,
            unit: parameter.unit_in(dof),
            value,
            std: Some(share * value.abs()),
            interval: Some([value - 1.96 * share * value.abs(), value + 1.96 * share * value.abs()]),
        });
        Finding {
            estimates: estimates.collect(),
            effect,
            probability: 0.9,
            alternatives: Vec::new(),
            gain: 100.0,
            measured: None,
        }
    }

    #[track_caller]
    fn says(finding: &Finding, parts: &[&str]) {
        let sentence = finding.says();
        assert!(sentence.ends_with('.') && !sentence.contains("NaN"), "{sentence}");
        parts
            .iter()
            .for_each(|part| assert!(sentence.contains(part), "`{part}` is missing from: {sentence}"));
    }

    #[test]
    fn every_linear_kind_says_what_where_and_how_much() {
        let body = || Place::Body("B".into());
        let joint = || Place::Joint("J".into());
        type Case<'a> = (EffectKind, Place, Option<Dof>, &'a [f64], &'a [&'a str]);
        let cases: [Case; 19] = [
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
            (EffectKind::ShearDeformation, joint(), None, &[1e7, 0.0], &["10.00 MN", "Euler–Bernoulli"]),
            (EffectKind::JointMass, joint(), None, &[0.077], &["77.0", "massless"]),
            (EffectKind::StiffnessChange, joint(), None, &[0.8], &["softer", "0.800"]),
            (EffectKind::LossFactor, joint(), None, &[0.02], &["0.0200"]),
            (EffectKind::Relaxation, joint(), None, &[0.3, 1e-3], &["viscoelastic", "159", "1.000 ms"]),
            (EffectKind::PointOffset, Place::Point("4".into()), None, &[-0.002], &["point 4", "−2.000 mm"]),
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
            (EffectKind::ChannelDelay, Place::Response("4".into()), None, &[22e-6], &["lags", "22.00 µs"]),
            (EffectKind::SensorMass, Place::Response("4".into()), None, &[0.012], &["12.00 g", "moved"]),
            (EffectKind::ExponentialWindow, Place::All, None, &[12.0], &["12.00 1/s", "damped"]),
        ];
        for (kind, place, dof, values, parts) in cases {
            says(&finding(kind, place, dof, values, 0.0103), parts);
        }
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
