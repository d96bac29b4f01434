//! A case: what the diagnosis is given, and apart from it what is true.

use crate::generate::recorded_lines;
use crate::{Filed, GenerationError, Sealable};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_rig::universal_file::{FileError, Precision, to_bytes};
use jointscope_rig::{HammerTest, Instrument, Outside, StructureError, frfs};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::fmt;

/// What the diagnosis is given: the analyst's fixture and the recording, FRFs or hits.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<R = FrfSet> {
    /// The fixture as the analyst believes it.
    pub believed: Fixture,
    /// The measured accelerances with coherence, or force and accelerations of every hit.
    pub recorded: R,
}

impl Case {
    /// The recording as a universal file (58b), FRFs with coherence and averages.
    ///
    /// # Errors
    /// A point whose name is no node number.
    pub fn recording(&self, precision: Precision) -> Result<Vec<u8>, FileError> {
        to_bytes("hammer test", &self.recorded, precision)
    }
}

/// How much was hidden in a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Nothing beyond quantities drawn within their tolerances.
    Null,
    /// One effect.
    Single,
    /// Two effects.
    Double,
    /// Physics that no effect describes.
    Outside,
    /// One effect made just so strong that it ought to show a little.
    Graded,
}

impl Role {
    /// Every role.
    pub const ALL: [Role; 5] = [Role::Null, Role::Single, Role::Double, Role::Outside, Role::Graded];

    /// Whether one effect was hidden.
    pub fn is_of_one(self) -> bool {
        matches!(self, Role::Single | Role::Graded)
    }

    /// The role in a word.
    pub fn name(self) -> &'static str {
        match self {
            Role::Null => "null",
            Role::Single => "single",
            Role::Double => "double",
            Role::Outside => "outside",
            Role::Graded => "graded",
        }
    }
}

/// What is true of a case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Truth {
    /// The case's number.
    #[serde(rename = "case")]
    pub index: usize,
    /// What its random numbers were seeded with: the seed, or the text of fresh cases.
    pub source: String,
    /// Whether it is one of the fresh cases.
    pub fresh: bool,
    /// How much was hidden.
    pub role: Role,
    /// The fixture with its true quantities, the hidden effects as its `physics`.
    pub fixture: Fixture,
    /// Hidden physics that no effect describes.
    pub outside: Option<Outside>,
    /// How it was measured.
    pub hammer: HammerTest,
    /// FRFs that nobody recorded.
    #[serde(deserialize_with = "filed_pairs")]
    pub unseen: Vec<FrfPair>,
}

/// FRFs by their names, `4/1`.
pub(crate) fn filed_pairs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FrfPair>, D::Error> {
    let names = Vec::<String>::deserialize(deserializer)?;
    let pair = |name: &String| name.split_once('/').map(|(to, from)| FrfPair::transverse(to, from));
    names.iter().map(pair).collect::<Option<_>>().ok_or_else(|| D::Error::custom("no FRF has such a name"))
}

impl Truth {
    /// The hidden effects.
    pub fn effects(&self) -> &[Effect] {
        self.fixture.physics()
    }

    /// What was hidden, in words.
    pub fn hidden(&self) -> String {
        let effects = self.effects().iter().map(describe);
        let all: Vec<String> = effects.chain(self.outside.iter().map(|o| o.to_string())).collect();
        if all.is_empty() { "nothing".to_owned() } else { all.join(" and ") }
    }

    /// Noise-free accelerances of the true structure.
    ///
    /// # Errors
    /// As [`jointscope_rig::frfs`].
    pub fn frfs(
        &self,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Result<FrfSet, StructureError> {
        match &self.outside {
            Some(outside) => outside.frfs(&self.fixture, pairs, lines, instrument),
            None => frfs(&self.fixture, pairs, lines, instrument),
        }
    }

    /// The FRFs that nobody recorded, as a perfect instrument would read them, without noise.
    ///
    /// # Errors
    /// As [`Truth::frfs`].
    pub fn unseen(&self) -> Result<FrfSet, GenerationError> {
        Ok(self.frfs(&self.unseen, &recorded_lines()?, Instrument::Perfect)?)
    }
}

impl Sealable for Truth {
    fn to_value(&self) -> Value {
        let mut outside = json!(self.outside);
        // What was sealed once has its kind last.
        if let Some(kind) = outside.as_object_mut().and_then(|entries| entries.shift_remove("kind")) {
            outside["kind"] = kind;
        }
        json!({
            "case": self.index,
            "source": self.source,
            "fresh": self.fresh,
            "role": self.role,
            "hidden": self.hidden(),
            "fixture": self.fixture,
            "outside": outside,
            "hammer": self.hammer,
            "unseen": self.unseen,
        })
    }
}

impl Filed for Truth {
    fn from_value(value: &Value) -> Option<Self> {
        Truth::deserialize(value).ok()
    }
}

/// What an effect is called: kind, place and degree of freedom.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Name {
    /// What it is.
    pub kind: EffectKind,
    /// Where it sits.
    pub place: Place,
    /// In which degree of freedom.
    pub dof: Option<Dof>,
}

impl Name {
    /// The name of an effect.
    pub fn of(effect: &Effect) -> Self {
        Name { kind: effect.kind, place: effect.place.clone(), dof: effect.dof }
    }
}

impl Serialize for Name {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind.name(), self.place)?;
        match self.dof {
            Some(dof) => write!(f, " {}", dof.name()),
            None => Ok(()),
        }
    }
}

/// An effect with its parameters, in one line.
pub fn describe(effect: &Effect) -> String {
    let parameters = effect.kind.spec().parameters.iter().zip(&effect.parameters);
    let values: Vec<String> = parameters.map(|(spec, q)| format!("{}={:.4e}", spec.name, q.value)).collect();
    format!("{} ({})", Name::of(effect), values.join(" "))
}

/// As [`effect_value`], for `serde(serialize_with)`.
pub(crate) fn in_file<S: Serializer>(effect: &Effect, serializer: S) -> Result<S::Ok, S::Error> {
    effect_value(effect).serialize(serializer)
}

/// Effects as [`effect_value`] has written them, of a fixture that was filed beside them; `None` of anything else.
pub(crate) fn filed_effects(fixture: &Value, effects: &Value) -> Option<Vec<Effect>> {
    let mut with_effects = fixture.clone();
    with_effects["physics"] = effects.clone();
    Some(Fixture::from_value(&with_effects).ok()?.physics().to_vec())
}

/// An effect as JSON, keys as in a fixture's `physics`.
pub(crate) fn effect_value(effect: &Effect) -> Value {
    let mut entry = Map::new();
    entry.insert("kind".into(), json!(effect.kind.name()));
    entry.insert("place".into(), json!(effect.place.to_string()));
    if let Some(dof) = effect.dof {
        entry.insert("dof".into(), json!(dof.name()));
    }
    for (spec, quantity) in effect.kind.spec().parameters.iter().zip(&effect.parameters) {
        entry.insert(spec.name.into(), json!(quantity.value));
    }
    Value::Object(entry)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{Answers, NoAnswer, Plan};

    #[test]
    fn a_truth_reads_back_as_it_was_written() {
        let plan = Plan { cases: 40, graded: 1, seed: 6, ..Plan::default() };
        let (cases, sealed) = plan.draw().unwrap();
        let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
        let truths = sealed.open(&silent).unwrap();
        let kinds: std::collections::BTreeSet<_> =
            truths.iter().filter_map(|t| t.outside.as_ref()).map(Outside::kind).collect();
        assert_eq!(kinds.len(), Outside::KINDS, "every kind of unknown physics is among them: {kinds:?}");
        for truth in truths {
            let text = truth.to_value().to_string();
            let read = Truth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
            assert_eq!(read.to_value().to_string(), text);
            assert_eq!(read.unseen().unwrap(), truth.unseen().unwrap(), "case {}", truth.index);
        }
    }
}
