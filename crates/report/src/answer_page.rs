//! The page of an answer, by the way taken to it.

use jointscope_pipeline::{Answer, Outcome};

use crate::context::PageContext;
use crate::diagnosis_page::diagnosis_page;
use crate::error::PageError;
use crate::hits_page::hits_page;
use crate::stepped_page::stepped_page;

/// The page of what a fixture leaves out of a test.
///
/// # Errors
/// An answer whose lists do not fit its spectral lines.
pub fn answer_page(answer: &Answer, context: &PageContext) -> Result<String, PageError> {
    match &answer.outcome {
        Outcome::Linear(diagnosis) => diagnosis_page(diagnosis, &answer.fixture, context),
        Outcome::Hits(diagnosis) => hits_page(diagnosis, &answer.fixture, context),
        Outcome::Levels(diagnosis) => stepped_page(diagnosis, &answer.fixture, context),
    }
}
