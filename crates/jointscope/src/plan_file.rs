//! `plan.json`: what is asked, and each measurement with what is expected of it.

use crate::file::value;
use jointscope_plan::{Plan, Weighed};
use serde_json::Value;

/// The contents of `plan.json`: the question, suggestions with what each would bring, the best first.
pub fn plan_file(plan: &Plan) -> Value {
    value(plan)
}

/// The contents of `plan.json` of two tests: the names, each with its probability by both and by the first
/// alone, the most probable first.
pub fn weighed_file(weighed: &Weighed) -> Value {
    value(weighed)
}
