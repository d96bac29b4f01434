//! The page of an answer, by the way taken to it.

use jointscope_pipeline::{Answer, Outcome};

use crate::context::PageContext;
use crate::diagnosis_page::diagnosis_report;
use crate::error::PageError;
use crate::hits_page::hits_report;
use crate::report::Report;
use crate::stepped_page::stepped_report;

/// The page of what a fixture leaves out of a test.
///
/// # Errors
/// An answer whose lists do not fit its spectral lines.
pub fn answer_page(answer: &Answer, context: &PageContext) -> Result<String, PageError> {
    answer_report(answer, context).html()
}

/// The same with its tables, curves and figures to be had apart.
pub fn answer_report(answer: &Answer, context: &PageContext) -> Report {
    match &answer.outcome {
        Outcome::Linear(diagnosis) => diagnosis_report(diagnosis, &answer.fixture, context),
        Outcome::Hits(diagnosis) => hits_report(diagnosis, &answer.fixture, context),
        Outcome::Levels(diagnosis) => stepped_report(diagnosis, &answer.fixture, context),
    }
}
