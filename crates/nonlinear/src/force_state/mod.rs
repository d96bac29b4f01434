//! The force–state map: what a joint bears against how far and how fast it is moved, from measured motion.

mod bodies;
mod map;
mod sides;
mod signals;

pub use bodies::MotionSource;
pub use map::{ForceState, ForceStateMap};
pub(crate) use signals::Lines;
