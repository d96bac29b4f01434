//! What the files of all commands share.

use serde::Serialize;
use serde_json::Value;

/// The contents of a file. Only maps whose keys are no strings fail, and there are none.
pub(crate) fn value(contents: impl Serialize) -> Value {
    serde_json::to_value(contents).unwrap_or_default()
}

/// A finding with its sentence, which stands before its alternatives.
pub(crate) fn with_sentence(finding: impl Serialize, says: String) -> Value {
    let mut entry = value(finding);
    if let Value::Object(entry) = &mut entry {
        let place = entry.keys().position(|key| key == "alternatives").unwrap_or(entry.len());
        entry.shift_insert(place, "says".to_owned(), Value::String(says));
    }
    entry
}
