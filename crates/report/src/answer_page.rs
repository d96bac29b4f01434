//! The page of an answer, by the way taken to it.

use jointscope_pipeline::{Answer, Outcome};

use crate::context::PageContext;
use crate::diagnosis_page::diagnosis_report;
use crate::hits_page::hits_report;
use crate::report::Report;
use crate::stepped_page::stepped_report;

/// The page of what a fixture leaves out of a test.
pub fn answer_report(answer: &Answer, context: &PageContext) -> Report {
    match &answer.outcome {
        Outcome::Linear(diagnosis) => diagnosis_report(diagnosis, &answer.fixture, context),
        Outcome::Hits(diagnosis) => hits_report(diagnosis, &answer.fixture, context),
        Outcome::Levels(diagnosis) => stepped_report(diagnosis, &answer.fixture, context),
    }
}
