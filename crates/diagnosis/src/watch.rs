//! What a diagnosis is doing, told to whoever waits for it.

use crate::candidate::Candidate;
use jointscope_fixture::{EffectKind, Place};
use std::fmt::{self, Debug, Display, Formatter};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a diagnosis is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<'a> {
    /// Something new begins.
    Stage(&'static str),
    /// An effect is tried.
    Trying {
        /// Its kind.
        kind: EffectKind,
        /// Its place.
        place: &'a Place,
        /// Its number among those that are tried, from 1.
        number: usize,
        /// How many are tried.
        of: usize,
    },
}

impl Display for Step<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Step::Stage(what) => f.write_str(what),
            Step::Trying { kind, place, number, of } => {
                write!(f, "trying {} on {place} ({number} of {of})", kind.name())
            }
        }
    }
}

/// Whom to tell what a diagnosis is doing: nobody, if not said otherwise. It is told from any thread, and
/// changes nothing.
#[derive(Clone, Copy, Default)]
pub struct Watch<'a>(Option<&'a (dyn Fn(Step) + Sync)>);

impl Debug for Watch<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Watch(somebody)" } else { "Watch(nobody)" })
    }
}

impl<'a> Watch<'a> {
    /// Tells `watcher`.
    pub fn by(watcher: &'a (dyn Fn(Step) + Sync)) -> Self {
        Watch(Some(watcher))
    }

    pub(crate) fn stage(&self, what: &'static str) {
        if let Some(watcher) = self.0 {
            watcher(Step::Stage(what));
        }
    }

    /// A count of `of` effects to be tried.
    pub(crate) fn count(self, of: usize) -> Count<'a> {
        Count { watch: self, of, begun: AtomicUsize::new(0) }
    }
}

/// How many of several effects were tried, over all threads.
pub(crate) struct Count<'a> {
    watch: Watch<'a>,
    of: usize,
    begun: AtomicUsize,
}

impl Count<'_> {
    /// One more is tried.
    pub(crate) fn trying(&self, candidate: &Candidate) {
        if let Some(watcher) = self.watch.0 {
            let number = self.begun.fetch_add(1, Ordering::Relaxed) + 1;
            watcher(Step::Trying { kind: candidate.kind, place: &candidate.place, number, of: self.of });
        }
    }
}
