//! What the files of all commands share.

use jointscope_fixture::NamedQuantity;
use serde::Serialize;
use serde_json::Value;

/// The contents of a file. Only maps whose keys are no strings fail, and there are none.
pub(crate) fn value(contents: impl Serialize) -> Value {
    serde_json::to_value(contents).unwrap_or_default()
}

/// A quantity that may move and where it ended, in its unit and in standard deviations of its prior.
#[derive(Serialize)]
pub(crate) struct Quantity<'a> {
    path: &'a str,
    nominal: f64,
    std: Option<f64>,
    value: f64,
    departure: Option<f64>,
    unit: &'static str,
}

impl<'a> Quantity<'a> {
    /// As stated, with the value and the deviations at which it ended.
    pub(crate) fn of(stated: &'a NamedQuantity, value: f64, deviations: f64) -> Self {
        Quantity {
            path: &stated.path,
            nominal: stated.value,
            std: stated.std,
            value,
            departure: stated.std.map(|_| deviations),
            unit: stated.key.unit(),
        }
    }
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
