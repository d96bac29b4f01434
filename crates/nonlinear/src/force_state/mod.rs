//! The force–state map: what a joint bears against how far and how fast it is moved, from measured motion.

mod bodies;
mod map;
mod sides;

pub use bodies::MotionSource;
pub use map::{ForceState, ForceStateMap};
