//! Motion over time.

pub(crate) mod kernel;
pub(crate) mod law;
pub(crate) mod simulation;
pub(crate) mod structure;
