//! Stepped-sine FRFs at several levels: frequency and damping by level, and the joint's law against the
//! amplitude of its motion.

mod balance;
pub(crate) mod course;
pub(crate) mod diagnosis;
mod forms;
mod least_squares;
pub(crate) mod level;
mod location;
pub(crate) mod naming;
pub(crate) mod pooled;
mod problem;
pub(crate) mod resonance;
mod tolerances;
