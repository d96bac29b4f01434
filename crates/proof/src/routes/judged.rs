//! Truths and answers of all routes beside the laboratory's, side by side.

use super::{
    AsIsJudged, LumpedJudged, ModalErrorsJudged, Opened, Questions, Replies, SolidJudged, StruckJudged,
};
use crate::Judged;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The judged cases of the routes beside the laboratory's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JudgedRoutes {
    /// Solids.
    pub solid: Vec<SolidJudged>,
    /// Hits over time.
    pub struck: Vec<StruckJudged>,
    /// Solids as they are.
    pub as_is: Vec<AsIsJudged>,
    /// Structures with errors in every mode.
    pub modal_errors: Vec<ModalErrorsJudged>,
    /// Lumped structures that hide one thing of a route's own.
    pub lumped: Vec<LumpedJudged>,
}

impl JudgedRoutes {
    /// Judges all cases on `threads` workers; `told` hears the number of cases of FRFs judged so far.
    pub fn all(
        cases: &Questions,
        truths: Opened,
        answers: &Replies,
        threads: usize,
        told: impl Fn(usize) + Sync,
    ) -> Self {
        let done = AtomicUsize::new(0);
        let told = |_: usize| told(done.fetch_add(1, Ordering::Relaxed) + 1);
        let Opened { laboratory: _, solid, struck, as_is, modal_errors, lumped } = truths;
        JudgedRoutes {
            solid: Judged::all(&cases.solid, solid, &answers.solid, threads, told),
            struck: StruckJudged::all(struck, &answers.struck),
            as_is: Judged::all(&cases.as_is, as_is, &answers.as_is, threads, told),
            modal_errors: Judged::all(
                &cases.modal_errors,
                modal_errors,
                &answers.modal_errors,
                threads,
                told,
            ),
            lumped: Judged::all(&cases.lumped, lumped, &answers.lumped, threads, told),
        }
    }

    /// How many of the cases are FRFs.
    pub fn count_of_frfs(cases: &Questions) -> usize {
        cases.solid.len() + cases.as_is.len() + cases.modal_errors.len() + cases.lumped.len()
    }
}
