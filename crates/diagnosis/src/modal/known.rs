//! What a search of a part of a recording may choose from.

use crate::candidate::Candidate;
use jointscope_fixture::Effect;

/// Effects that were found in more than what is searched.
#[derive(Debug, Clone, Default)]
pub(crate) struct Known {
    /// Those that were found, one beside the other.
    pub found: Vec<Effect>,
    /// Those that were the most probable by themselves.
    pub probable: Vec<Effect>,
}

impl Known {
    /// All of them, what was found first.
    pub(super) fn all(&self) -> impl Iterator<Item = &Effect> {
        self.found.iter().chain(&self.probable)
    }

    /// The effect that goes by this name.
    pub(super) fn of(&self, candidate: &Candidate) -> Option<&Effect> {
        self.all().find(|effect| candidate.names(effect))
    }
}
