//! Effects as the files of cases and answers hold them.

use jointscope_fixture::{Effect, Fixture};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// As [`effect_value`], for `serde(serialize_with)`.
pub(crate) fn in_file<S: Serializer>(effect: &Effect, serializer: S) -> Result<S::Ok, S::Error> {
    effect_value(effect).serialize(serializer)
}

/// Effects as [`effect_value`] has written them, of a fixture that was filed beside them; `None` of anything
/// else.
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
