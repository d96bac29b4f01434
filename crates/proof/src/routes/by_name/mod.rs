//! What cases have in common that are judged by the names given: those that are true, the first of them,
//! their scores.
//!
//! Where a model is a little wrong everywhere, what is hidden has to be told from the model's own error, and
//! whatever is named has to be true of the structure. Where a fixture is right to the noise, what is hidden
//! is named first and alone.

mod judged;
mod names;
mod score;

pub use names::TrueName;
pub(super) use score::{ONE_OR_NONE, UNLISTED, WRONG_EVERYWHERE, score};

use crate::{IndependentFits, Judgeable, Judged};
use jointscope_fixture::Effect;

/// What is true of a case that is judged by the names given.
pub trait Nameable: Judgeable + Sized {
    /// What is hidden, sizes in closed form; nothing or one thing.
    fn concealed(&self) -> Option<&Effect> {
        self.effects().first()
    }
    /// Whether physics that everybody knows of was left unstated.
    fn is_gap(&self) -> bool {
        false
    }
    /// Whether an effect by another name says the same of the recording as what is hidden.
    fn stands_for(&self, found: &Effect, fits: &IndependentFits) -> bool;
    /// Whether an effect by another name is exactly the same thing as what is hidden, whatever the recording.
    fn is_the_same(&self, _: &Effect) -> bool {
        false
    }
    /// Whether an effect that was found is in the structure although it is not hidden.
    fn is_true(&self, _: &Effect) -> bool {
        false
    }
    /// Whether what is hidden is asked for.
    fn shows(judged: &Judged<Self>) -> bool {
        judged.is_visible()
    }
}
