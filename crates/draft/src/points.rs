//! Points that a recording has: at the places of its geometry, or to be filled in.

use crate::value::{known, rounded, unknown};
use crate::{Draft, DraftError};
use serde_json::{Map, Value, json};

/// Spreads named points evenly over bodies (name, from, to; m), in their order; places are placeholders that
/// a fit leaves free.
pub(crate) fn spread(
    names: &[String],
    bodies: &[(String, f64, f64)],
    points: &mut Map<String, Value>,
) -> String {
    let share = names.len().div_ceil(bodies.len().max(1)).max(1);
    for ((body, from, to), names) in bodies.iter().zip(names.chunks(share)) {
        for (index, name) in names.iter().enumerate() {
            let x = from + (to - from) * (index as f64 + 0.5) / names.len() as f64;
            points.insert(name.clone(), json!({ "body": body, "x": unknown(x) }));
        }
    }
    format!(
        "FILL IN: the recording has points {}; which body each is on and its x are placeholders (\"std\": \"unknown\"): put the body, and x in metres with its deviation, such as {{\"value\": 0.031, \"std\": 0.0005}}",
        names.join(", ")
    )
}

/// How far beyond an end a point still counts as on it, in deviations of the ruler: geometries are rounded.
const BEYOND: f64 = 5.0;

/// Puts points at their places on bodies (name, from, to; m); what is to be said of it.
///
/// # Errors
/// Points that do not lie on the structure.
pub(crate) fn put(
    draft: &Draft,
    bodies: &[(String, f64, f64)],
    points: &mut Map<String, Value>,
) -> Result<Vec<String>, DraftError> {
    let placed = &draft.placed;
    let ends = |values: &mut dyn Iterator<Item = (f64, f64)>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)))
    };
    let (from, to) = ends(&mut bodies.iter().map(|(_, from, to)| (*from, *to)));
    let (first, last) = ends(&mut placed.iter().map(|(_, x)| (*x, *x)));
    let beyond = BEYOND * draft.ruler;
    if last - first > to - from + 2.0 * beyond {
        return Err(DraftError::Span { points: 1e3 * (last - first), structure: 1e3 * (to - from) });
    }
    let fits = first >= from - beyond && last <= to + beyond;
    let middle = |a: f64, b: f64| 0.5 * (a + b);
    let origin = match draft.origin {
        Some(origin) => origin,
        None if fits => 0.0,
        None => middle(first, last) - middle(from, to),
    };
    let mut notes = vec![format!(
        "points lie where the recording's geometry has them, x = 0 being {} mm there{}; known to {} mm: state better where you know better",
        1e3 * rounded(origin),
        match (draft.origin, fits) {
            (None, false) =>
                ": CHECK, their middle was put at the middle of the structure for want of a better origin (`--origin`)",
            _ => "",
        },
        1e3 * rounded(draft.ruler)
    )];
    let mut between = Vec::new();
    for (name, there) in placed {
        let x = there - origin;
        if x < from - beyond || x > to + beyond {
            return Err(DraftError::Off { point: name.clone(), x: 1e3 * x, from: 1e3 * from, to: 1e3 * to });
        }
        let on = bodies.iter().find(|(_, from, to)| x >= from - beyond && x <= to + beyond);
        let Some((body, from, to)) = on else {
            between.push(name.as_str());
            continue;
        };
        // A length that no body has, for the fixture to refuse, has ends in the wrong order, which `clamp`
        // does not take.
        let x = x.max(*from).min(*to);
        // A point at an end lies on it, however long the body is.
        let std = if x == *from || x == *to { 0.0 } else { draft.ruler };
        points.insert(name.clone(), json!({ "body": body, "x": known(x, std) }));
    }
    if !between.is_empty() {
        notes.push(format!(
            "points {} lie between the bodies, on what is taken as massless, and were left out",
            between.join(", ")
        ));
    }
    Ok(notes)
}
