//! Effects: the name and the sentence that the table of effects has for every kind, with what was found
//! filled in.

use crate::estimate::size_of;
use crate::numbers::plain;
use jointscope_findings::Estimate;
use jointscope_fixture::{Case, Dof, Effect, Motion, ParameterRange, Place};
use std::f64::consts::TAU;

/// Standard deviation of an abscissa, m, beyond which it is not told.
const UNPLACED: f64 = 0.1;

/// An effect's kind and place in a few words: `added mass on body B`.
pub fn effect_name(effect: &Effect) -> String {
    filled(effect.kind.spec().words.name, |key| word(effect, key), |_| true)
}

/// The sentence of an effect without its look-alikes and full stop, its parameters as the `data` know them.
pub(crate) fn meaning(effect: &Effect, estimates: &[Estimate], data: &str) -> String {
    let words_of = Sized { effect, estimates, data };
    let words = effect.kind.spec().words;
    let case = words.cases.iter().find(|(case, _)| words_of.is_case(*case));
    let sentence = case.map_or(words.otherwise, |(_, sentence)| sentence);
    filled(sentence, |key| words_of.stands_for(key), |parameter| words_of.is_sure(parameter))
}

/// What to look for on the structure, or to measure, once an effect is found.
pub fn advice(effect: &Effect) -> &'static str {
    let words = effect.kind.spec().words;
    let of_effect = Sized { effect, estimates: &[], data: "" };
    let case = words.advised.iter().find(|(case, _)| of_effect.is_case(*case));
    case.map_or(words.advice, |(_, advice)| advice)
}

/// What is told of an effect.
struct Sized<'a> {
    effect: &'a Effect,
    estimates: &'a [Estimate],
    data: &'a str,
}

impl Sized<'_> {
    fn estimate(&self, parameter: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter.name == parameter)
    }

    /// Whether a parameter that may be zero is beyond doubt not, or has been given another value.
    fn is_sure(&self, parameter: &str) -> bool {
        let is_given = |e: &Estimate| e.parameter.motion == Motion::None && e.value > 0.0;
        self.estimate(parameter).is_some_and(|estimate| estimate.is_positive() || is_given(estimate))
    }

    fn is_case(&self, case: Case) -> bool {
        let spec = self.effect.kind.spec();
        let leading = self.effect.value(spec.size.parameter);
        match case {
            Case::Below(limit) => leading < limit,
            Case::Within(low, high) => low < leading && leading < high,
            Case::Rotation => self.effect.dof == Some(Dof::Rotation),
            Case::Record => matches!(self.effect.place, Place::Record(_)),
            Case::Force => self.effect.place == Place::Force,
            Case::Responses => self.effect.place == Place::Responses,
            Case::Response => matches!(self.effect.place, Place::Response(_)),
            Case::Reference => matches!(self.effect.place, Place::Reference(_)),
            Case::OnlySure(parameter) => {
                let mut may_be_zero =
                    spec.parameters.iter().filter(|p| p.range == ParameterRange::NonNegative);
                may_be_zero.all(|p| self.is_sure(p.name) == (p.name == parameter))
            }
            _ => false,
        }
    }

    /// What a sentence's key stands for: a parameter with its interval, or a word.
    fn stands_for(&self, key: &str) -> String {
        if key == "at_x" {
            return self.at_x();
        }
        if let Some(time) = key.strip_prefix("corner of ") {
            let time = self.estimate(time).map_or(0.0, |estimate| estimate.value);
            return plain(1.0 / (TAU * time.max(f64::MIN_POSITIVE)), "Hz");
        }
        if let Some(parameter) = key.strip_prefix('-') {
            return self.estimate(parameter).map_or_else(String::new, |e| size_of(&unsigned(e), self.data));
        }
        match self.estimate(key) {
            Some(estimate) => size_of(estimate, self.data),
            None => word(self.effect, key),
        }
    }

    /// ` at x = 110.2 mm (95 %: …)`, where the abscissa means anything.
    fn at_x(&self) -> String {
        match self.estimate("x") {
            Some(x) if x.std.is_some_and(|std| std > UNPLACED) => {
                " at an abscissa that is not determined".to_owned()
            }
            Some(x) if x.interval.is_some() => format!(" at x = {}", size_of(x, self.data)),
            _ => String::new(),
        }
    }
}

/// A negative parameter whose sign the sentence tells in words.
fn unsigned(estimate: &Estimate) -> Estimate {
    Estimate {
        value: estimate.value.abs(),
        interval: match estimate.interval {
            Some([low, high]) if estimate.value < 0.0 => Some([-high, -low]),
            interval => interval,
        },
        ..*estimate
    }
}

/// What a key of the table's words stands for, parameters apart.
fn word(effect: &Effect, key: &str) -> String {
    let place = &effect.place;
    let (owner, at_the_start) = match place {
        Place::Body(_) => ("body", "Body"),
        _ => ("joint", "Joint"),
    };
    match key {
        "place" if *place == Place::Force => "the force of all references".to_owned(),
        "place" if *place == Place::Responses => "all responses".to_owned(),
        "place" => place.to_string(),
        "where it sits" if matches!(place, Place::Point(_)) => format!("point {place}"),
        "where it sits" => place.to_string(),
        "against rotation" if effect.dof == Some(Dof::Rotation) => " against rotation".to_owned(),
        "owner" => format!("{owner} {place}"),
        "Owner" => format!("{at_the_start} {place}"),
        "dof" => effect.dof.map_or("translation", Dof::name).to_owned(),
        _ => String::new(),
    }
}

/// A template with its keys, in braces, replaced by what they stand for; what is in brackets only where each
/// of its parameters `is_sure`.
fn filled(template: &str, stands_for: impl Fn(&str) -> String, is_sure: impl Fn(&str) -> bool) -> String {
    let mut text = String::new();
    for (index, part) in template.split(['[', ']']).enumerate() {
        let mut keys = part.split(['{', '}']).skip(1).step_by(2);
        if index % 2 == 1 && !keys.all(&is_sure) {
            continue;
        }
        for (index, piece) in part.split(['{', '}']).enumerate() {
            match index % 2 {
                1 => text.push_str(&stands_for(piece)),
                _ => text.push_str(piece),
            }
        }
    }
    text
}
