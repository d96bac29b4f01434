//! How much is hidden in a case.

use serde::{Deserialize, Serialize};

/// How much was hidden in a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Nothing beyond quantities drawn within their tolerances.
    Null,
    /// One effect.
    Single,
    /// Two effects.
    Double,
    /// Physics that no effect describes.
    Outside,
    /// One effect made just so strong that it ought to show a little.
    Graded,
}

impl Role {
    /// Every role.
    pub const ALL: [Role; 5] = [Role::Null, Role::Single, Role::Double, Role::Outside, Role::Graded];

    /// Whether one effect was hidden.
    pub fn is_of_one(self) -> bool {
        matches!(self, Role::Single | Role::Graded)
    }

    /// The role in a word.
    pub fn name(self) -> &'static str {
        match self {
            Role::Null => "null",
            Role::Single => "single",
            Role::Double => "double",
            Role::Outside => "outside",
            Role::Graded => "graded",
        }
    }
}
