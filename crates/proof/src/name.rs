//! What an effect is called.

use jointscope_fixture::{Dof, Effect, EffectKind, Place};
use serde::{Serialize, Serializer};
use std::fmt;

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
pub(crate) fn describe(effect: &Effect) -> String {
    let parameters = effect.kind.spec().parameters.iter().zip(&effect.parameters);
    let values: Vec<String> = parameters.map(|(spec, q)| format!("{}={:.4e}", spec.name, q.value)).collect();
    format!("{} ({})", Name::of(effect), values.join(" "))
}
