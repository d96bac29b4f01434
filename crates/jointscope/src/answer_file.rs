//! `diagnosis.json`, whichever way led to the answer.

use crate::diagnosis_file;
use crate::nonlinear_file::nonlinear_file;
use crate::stepped_file::stepped_file;
use jointscope_pipeline::{Answer, Outcome};
use serde_json::Value;

/// The contents of `diagnosis.json`, by the way taken to the answer.
pub fn answer_file(answer: &Answer) -> Value {
    match &answer.outcome {
        Outcome::Linear(diagnosis) => diagnosis_file(diagnosis),
        Outcome::Hits(diagnosis) => nonlinear_file(diagnosis),
        Outcome::Levels(diagnosis) => stepped_file(diagnosis),
    }
}
