//! What was concealed in a case.

use crate::effect_file::effect_value;
use crate::name::describe;
use crate::{Name, Sealable};
use jointscope_fixture::Effect;
use serde_json::{Value, json};

/// How something is concealed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ConcealmentKind {
    /// An entry of the fixture is deleted: an effect of its `physics`, a known point mass, a support.
    Entry,
    /// A point mass is stated that is not there.
    Mass,
    /// The stiffness of a joint or of a beam body is stated wrong by a factor, its relative deviation as it
    /// was.
    Stiffness,
    /// A point is stated where it is not.
    Point,
    /// A channel of the recording is scaled.
    Gain,
    /// A channel of the recording is turned round.
    Sign,
    /// A channel of the recording is delayed.
    Delay,
    /// Two responses or two references of the recording are exchanged.
    Exchange,
}

impl ConcealmentKind {
    /// Every kind.
    pub const ALL: [ConcealmentKind; 8] = [
        ConcealmentKind::Entry,
        ConcealmentKind::Gain,
        ConcealmentKind::Point,
        ConcealmentKind::Mass,
        ConcealmentKind::Delay,
        ConcealmentKind::Stiffness,
        ConcealmentKind::Sign,
        ConcealmentKind::Exchange,
    ];

    /// The kind in a word.
    pub fn name(self) -> &'static str {
        match self {
            ConcealmentKind::Entry => "entry",
            ConcealmentKind::Mass => "mass",
            ConcealmentKind::Stiffness => "stiffness",
            ConcealmentKind::Point => "point",
            ConcealmentKind::Gain => "gain",
            ConcealmentKind::Sign => "sign",
            ConcealmentKind::Delay => "delay",
            ConcealmentKind::Exchange => "exchange",
        }
    }

    /// Whether the size of what is concealed is known apart from the recording: that of a deleted entry may
    /// itself have been found in it.
    pub(crate) fn is_planted(self) -> bool {
        self != ConcealmentKind::Entry
    }
}

/// An effect that undoes a concealment, or a part of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// The effect with its true parameters.
    pub effect: Effect,
    /// Effects elsewhere that do the same to every recorded FRF, so that nobody could tell them from it.
    pub same: Vec<Effect>,
}

impl Expected {
    /// The expected effect, or one that is the same in this recording, of this name.
    pub(crate) fn named(&self, name: &Name) -> Option<&Effect> {
        std::iter::once(&self.effect).chain(&self.same).find(|effect| Name::of(effect) == *name)
    }
}

/// What is true of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Concealed {
    /// The case's number.
    pub index: usize,
    /// How something was concealed; `None` of a control.
    pub kind: Option<ConcealmentKind>,
    /// What was done, in words.
    pub what: String,
    /// The effects that undo it, all of which are needed; none of a control, and none where no effect
    /// describes it.
    pub expected: Vec<Expected>,
}

impl Concealed {
    /// Whether nothing was concealed.
    pub fn is_control(&self) -> bool {
        self.kind.is_none()
    }
}

impl Sealable for Concealed {
    fn to_value(&self) -> Value {
        let expected = |expected: &Expected| {
            json!({
                "effect": effect_value(&expected.effect),
                "in_words": describe(&expected.effect),
                "same_in_this_recording": expected.same.iter().map(effect_value).collect::<Vec<_>>(),
            })
        };
        json!({
            "case": self.index,
            "concealment": self.kind.map_or("none", ConcealmentKind::name),
            "what": self.what,
            "expected": self.expected.iter().map(expected).collect::<Vec<_>>(),
        })
    }
}
