//! What the sections of the page are made from.

use jointscope_decomposition::{Analysis, JointEstimate, Relation};
use jointscope_fixture::{Fixture, Joint};

/// What the sections of the page are made from.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) analysis: &'a Analysis,
    pub(super) fixture: &'a Fixture,
    pub(super) best: &'a JointEstimate,
}

impl<'a> Subject<'a> {
    pub(super) fn joint(&self) -> Option<&'a Joint> {
        self.fixture.joint(&self.analysis.joint)
    }

    pub(super) fn is_paper(&self) -> bool {
        self.analysis.spectrum.relation == Relation::Paper
    }

    pub(super) fn is_scalar(&self) -> bool {
        self.analysis.spectrum.scalar
    }

    /// Whether the joint from all FRFs was found with nothing of the fixture moving.
    pub(super) fn is_exact(&self) -> bool {
        self.analysis.joint_fit.as_ref().is_ok_and(|fit| fit.quantities.is_empty())
    }

    /// What K by line is called in captions.
    pub(super) fn relation_words(&self) -> &'static str {
        if self.is_paper() { "eq (7)" } else { "the exact relation" }
    }
}
