//! Points that a recording has, and whose places nobody has told yet.

use crate::value::unknown;
use serde_json::{Map, Value, json};

/// Spreads named points evenly over bodies (name, from, to; m), in their order; places are placeholders that a fit leaves free.
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
