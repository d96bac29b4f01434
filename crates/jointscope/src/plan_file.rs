//! `plan.json`: what is asked, and each measurement with what is expected of it.

use crate::file::value;
use jointscope_plan::Plan;
use serde_json::Value;

/// The contents of `plan.json`: the question, suggestions with what each would bring, the best first.
pub fn plan_file(plan: &Plan) -> Value {
    value(plan)
}
