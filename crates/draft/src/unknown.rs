//! A structure of which only points are known: a frame to be filled in.

use crate::value::{rounded, unknown};
use crate::{Draft, DraftError, points};
use serde_json::{Map, Value, json};

/// Mass to begin with, kg; a fit finds its own.
const MASS: f64 = 1.0;
/// Reach of the points below which an inertia has nothing to go by, m.
const SHORTEST: f64 = 0.01;

pub(crate) fn file(draft: &Draft) -> Result<Value, DraftError> {
    let places = || draft.placed.iter().map(|(_, x)| *x);
    let (first, last) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
    if draft.placed.is_empty() {
        return Err(DraftError::Nothing);
    }
    let origin = draft.origin.unwrap_or(0.0);
    let body = ("body".to_owned(), first - origin, last - origin);
    let mut all = Map::new();
    let mut notes = points::put(&Draft { origin: Some(origin), ..draft.clone() }, &[body], &mut all)?;
    // The ends of the points are no ends of a body.
    for point in all.values_mut() {
        point["x"]["std"] = json!(rounded(draft.ruler));
    }
    let length = (last - first).max(SHORTEST);
    notes.push(
        "FILL IN: one rigid body stands for the whole structure; put the bodies that there are, each with mass, inertia and x_cg (or a beam), say of each point which body it is on, and add the joints between them"
            .to_owned(),
    );
    notes.push(
        "mass, inertia and x_cg are placeholders that a fit leaves free (\"std\": \"unknown\"): weigh and measure, and put value and deviation"
            .to_owned(),
    );
    Ok(json!({
        "name": "structure of a recording",
        "notes": notes,
        "bodies": { "body": {
            "mass": unknown(MASS),
            "inertia": unknown(MASS * length * length / 12.0),
            "x_cg": unknown(0.5 * (first + last) - origin)
        } },
        "points": all
    }))
}
