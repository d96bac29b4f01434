//! How a statement is meant to be taken.

use jointscope_diagnosis::Verdict;

/// How a statement is meant to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// As it should be.
    Ok,
    /// To be looked at.
    Attention,
    /// Not usable as it is.
    Problem,
}

impl Tone {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Tone::Ok => "ok",
            Tone::Attention => "attention",
            Tone::Problem => "problem",
        }
    }

    /// The tone in one character, so that it does not hang on the colour alone.
    pub(crate) fn sign(self) -> &'static str {
        match self {
            Tone::Ok => "✓",
            Tone::Attention => "!",
            Tone::Problem => "✕",
        }
    }
}

impl From<Verdict> for Tone {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Consistent => Tone::Ok,
            Verdict::Explained => Tone::Attention,
            Verdict::PartlyExplained | Verdict::Unexplained => Tone::Problem,
        }
    }
}
