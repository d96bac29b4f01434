//! Stepped-sine FRFs at several levels: frequency and damping by level, and the joint's law against the amplitude of its motion.

pub(crate) mod balance;
pub(crate) mod diagnosis;
pub(crate) mod judge;
pub(crate) mod least_squares;
pub(crate) mod level;
pub(crate) mod model;
pub(crate) mod naming;
pub(crate) mod pooled;
pub(crate) mod resonance;
pub(crate) mod says;
pub(crate) mod seat;
pub(crate) mod tolerances;
