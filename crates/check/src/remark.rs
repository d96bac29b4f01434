//! What is odd, and how much it matters.

use serde::Serialize;

/// How much something odd matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weight {
    /// It cannot be meant as it stands: a diagnosis refuses it, or puts it right.
    Wrong,
    /// It may be right, but is to be looked at.
    Odd,
}

/// Something odd, in one plain sentence without a full stop.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Remark {
    /// Where: a path in the fixture file, an FRF such as `4/1`, a channel such as `response 3`.
    pub place: String,
    /// How much it matters.
    pub weight: Weight,
    /// What is odd, and what may be done.
    pub says: String,
}

impl Remark {
    pub(crate) fn wrong(place: impl Into<String>, says: impl Into<String>) -> Self {
        Remark { place: place.into(), weight: Weight::Wrong, says: says.into() }
    }

    pub(crate) fn odd(place: impl Into<String>, says: impl Into<String>) -> Self {
        Remark { place: place.into(), weight: Weight::Odd, says: says.into() }
    }
}
