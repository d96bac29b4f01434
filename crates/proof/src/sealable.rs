//! What can be sealed, and against what it is opened.

use serde_json::Value;

/// What can be sealed: a truth that says all of itself as JSON.
pub trait Sealable {
    /// The truth as JSON.
    fn to_value(&self) -> Value;
}

/// A truth that can be read back from what was sealed.
pub trait Filed: Sealable + Sized {
    /// The truth that [`Sealable::to_value`] has written; `None` of anything else.
    fn from_value(value: &Value) -> Option<Self>;
}

/// Answers against which truths are opened.
pub trait Given {
    /// Number of cases that were answered, refusals included.
    fn count(&self) -> usize;
}
