//! A case: what the diagnosis is given, and apart from it what is true.

use crate::truth_file::{hammer_value, outside_value};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_rig::universal_file::{FileError, Precision, to_bytes};
use jointscope_rig::{HammerTest, Outside};
use jointscope_spectra::FrfSet;
use serde_json::{Map, Value, json};
use std::fmt;

/// What the diagnosis is given: the analyst's fixture and the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The fixture as the analyst believes it.
    pub believed: Fixture,
    /// The measured accelerances with coherence.
    pub recorded: FrfSet,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
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

    /// The role of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Role::ALL.into_iter().find(|role| role.name() == name)
    }

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
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// The case's number.
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
    /// FRFs that nobody recorded, as a perfect instrument would read them, without noise.
    pub unseen: FrfSet,
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

    /// The truth as JSON.
    pub fn to_value(&self) -> Value {
        json!({
            "case": self.index,
            "source": self.source,
            "fresh": self.fresh,
            "role": self.role.name(),
            "hidden": self.hidden(),
            "fixture": self.fixture.to_value(),
            "outside": self.outside.as_ref().map(outside_value),
            "hammer": hammer_value(&self.hammer),
            "unseen": self.unseen.pairs().iter().map(ToString::to_string).collect::<Vec<_>>(),
        })
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
